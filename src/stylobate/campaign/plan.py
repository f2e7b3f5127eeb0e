"""The plan of a study on disk: its axes as plain data, and the digest of every case."""

from __future__ import annotations

import io
import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..atomic import replacing
from ..errors import InputError
from ..response.rows import Rows
from .digests import Digests
from .runs import known
from .twins import LAW

if TYPE_CHECKING:
    import pandas

#: File in the folder of a study, beside its finished runs.
PLAN_FILE = "plan.npz"


@dataclass(frozen=True, eq=False)
class Plan:
    """Runs of a study.

    Parameters
    ----------
    axes : dict
        Models, columns, motions, levels, factors and realisations as plain values.
    digests : Digests
        Of each case, in the order (model, column, motion, level, realisation).
    """

    axes: dict[str, Any]
    digests: Digests

    def __len__(self) -> int:
        return len(self.digests)

    @property
    def shape(self) -> tuple[int, ...]:
        """Numbers of models, columns, motions, levels and realisations (1 without scatter)."""
        sizes = [len(self.axes[name]) for name in ("models", "columns", "motions", "levels")]
        return (*sizes, max(1, self.axes["realisations"]))

    def known(self, ledger: Path) -> Rows:
        """Rows of the cases that a ledger holds."""
        found = Rows(len(self))
        for number, row in known(ledger, self.digests):
            found[number] = row
        return found

    def labels(self) -> pandas.DataFrame:
        """Identity of each case: column, record, direction, level, factor, intensities as scaled, model and realisation."""
        import pandas

        axes = self.axes
        model, column, motion, level, realisation = np.unravel_index(np.arange(len(self)), self.shape)

        def picked(values: list[Any], index: np.ndarray) -> Any:
            kept = pandas.Series(values)
            return kept.to_numpy()[index]

        table = {name: picked([one[name] for one in axes["columns"]], column) for name in axes["columns"][0]}
        for name in ("record", "motion", "azimuth_deg", "reversed"):
            table[name] = picked([one[name] for one in axes["motions"]], motion)
        factor = np.array(axes["factors"])[motion, level]
        table |= {"measure": axes["measure"], "im": np.array(axes["levels"])[level], "factor": factor}
        for name, values in axes["intensities"].items():
            table[name] = np.array(values, dtype=float)[motion, column] * factor ** axes["powers"][name]
        table |= {"model": picked([one["model"] for one in axes["models"]], model)}
        table |= {"realisation": realisation + 1 if axes["realisations"] else np.zeros(len(self), dtype=np.int64)}
        laws = axes.get("laws") or []
        if any(of_column for of_model in laws for of_column in of_model):
            whole = [[of_column or [-1] * self.shape[4] for of_column in of_model] for of_model in laws]
            table[LAW] = np.array(whole)[model, column, realisation] + 1
        return pandas.DataFrame(table)

    def save(self, folder: Path) -> Path:
        """Write it into the folder of the study, whole or not at all."""
        content = io.BytesIO()
        np.savez(
            content,
            axes=np.frombuffer(json.dumps(self.axes, default=str).encode(), np.uint8),
            digests=self.digests.digests,
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
            raise InputError(
                f"{folder} is no folder of a study: it has no {PLAN_FILE}; give that in which a study keeps its runs."
            )
        try:
            with np.load(place, allow_pickle=False) as found:
                return cls(json.loads(found["axes"].tobytes()), Digests(found["digests"]))
        except Exception:  # whatever a damaged archive makes of it
            raise InputError(f"{place} is damaged; run the study again, which finds its finished runs there.") from None
