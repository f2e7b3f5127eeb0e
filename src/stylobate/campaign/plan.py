"""The plan of a study on disk: its axes as plain data, and the digest of every case."""

from __future__ import annotations

import io
import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..atomic import replacing
from ..errors import InputError
from ..response.rows import Rows
from .ledger import rows_in

if TYPE_CHECKING:
    import pandas

#: Files in the folder of a study: its plan, and its finished runs.
PLAN_FILE, RUNS_FILE = "plan.npz", "runs.sqlite"

#: One ledger takes the runs of any study: what tells them apart is the digest of each case.
KEY = {"keyed by": "digest of the case"}


@dataclass(frozen=True, eq=False)
class Plan:
    """What a study runs.

    Parameters
    ----------
    axes : dict
        Models, columns, motions, levels, factors and realisations as plain values.
    digests : array of uint8
        Of each case, in the order (model, column, motion, level, realisation), shape (cases, 16).
    """

    axes: dict[str, Any]
    digests: np.ndarray

    def __len__(self) -> int:
        return len(self.digests)

    @property
    def shape(self) -> tuple[int, ...]:
        """Numbers of models, columns, motions, levels and realisations (1 without scatter)."""
        sizes = [len(self.axes[name]) for name in ("models", "columns", "motions", "levels")]
        return (*sizes, max(1, self.axes["realisations"]))

    def digest(self, number: int) -> str:
        """Digest of a case, 32 hexadecimal digits."""
        return self.digests[number].tobytes().hex()

    @cached_property
    def keys(self) -> np.ndarray:
        """Numbers of the cases in the ledger, from their digests, shape (cases,)."""
        first = np.ascontiguousarray(self.digests[:, :8]).view(">u8")[:, 0]
        return (first >> np.uint64(5)).astype(np.int64)  # 59 bits: 18 decimal digits hold them

    @cached_property
    def _order(self) -> tuple[np.ndarray, np.ndarray]:
        order = np.argsort(self.keys, kind="stable")
        return order, self.keys[order]

    def numbers(self, key: int) -> list[int]:
        """Cases with that number in the ledger: one, or several that are the same."""
        order, keys = self._order
        first, last = np.searchsorted(keys, [key, key + 1])
        return order[first:last].tolist()

    def known(self, ledger: Path) -> Rows:
        """Rows of the cases that a ledger holds; those of other studies and other laws in it are passed over."""
        found = Rows(len(self))
        for key, row in rows_in(ledger, KEY):
            digest = row.pop("case", None)
            for number in self.numbers(key):
                if digest == self.digest(number):
                    found[number] = row
        return found

    def labels(self) -> pandas.DataFrame:
        """What each case is: column, record, direction, level, factor, model and realisation."""
        import pandas

        axes = self.axes
        model, column, motion, level, realisation = np.unravel_index(np.arange(len(self)), self.shape)

        def picked(values: list[Any], index: np.ndarray) -> Any:
            kept = pandas.Series(values)
            return kept.to_numpy()[index]

        table = {"column": picked([one["column"] for one in axes["columns"]], column)}
        for name in ("record", "motion", "azimuth_deg", "reversed"):
            table[name] = picked([one[name] for one in axes["motions"]], motion)
        factor = np.array(axes["factors"])[motion, level]
        table |= {"measure": axes["measure"], "im": np.array(axes["levels"])[level], "factor": factor}
        for name in ("pga_g", "pgv_m_s"):
            table[name] = np.array([one[name] for one in axes["motions"]])[motion] * factor
        table |= {"model": picked([one["model"] for one in axes["models"]], model)}
        table |= {"realisation": realisation + 1 if axes["realisations"] else np.zeros(len(self), dtype=np.int64)}
        return pandas.DataFrame(table)

    def save(self, folder: Path) -> Path:
        """Write it into the folder of the study, whole or not at all."""
        content = io.BytesIO()
        np.savez(
            content, axes=np.frombuffer(json.dumps(self.axes, default=str).encode(), np.uint8), digests=self.digests
        )
        target = folder / PLAN_FILE
        with replacing(target) as partial:
            partial.write_bytes(content.getvalue())
        return target

    @classmethod
    def load(cls, folder: str | Path) -> Plan:
        """Read the plan of a study's folder.

        Raises
        ------
        InputError
            The folder is not that of a study, or its plan is damaged.
        """
        place = Path(folder) / PLAN_FILE
        if not place.is_file():
            raise InputError(f"{folder} is no folder of a study: it has no {PLAN_FILE}; give that of study run --out.")
        try:
            with np.load(place, allow_pickle=False) as found:
                return cls(json.loads(found["axes"].tobytes()), found["digests"])
        except Exception:  # whatever a damaged archive makes of it
            raise InputError(f"{place} is damaged; run the study again, which finds its finished runs there.") from None
