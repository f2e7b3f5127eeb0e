"""Digest of a case: what stands, samples and factor of the motion, model, tail, quiet, laws.

Names decide nothing, and neither do the components of a motion that the model leaves out.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from functools import cache, cached_property
from pathlib import Path
from typing import Any
from uuid import uuid4
from weakref import WeakKeyDictionary

import numpy as np

from ..atomic import digest as digest_of_file
from ..column.structure import Structure
from ..kernels.sources import source_digest
from ..models.base import Case, Model, RunOptions
from ..motion import Motion
from ..version import __version__ as PACKAGE_VERSION
from .campaign import DECIDED

#: Bytes of a digest.
LENGTH = 16

#: This package, whose sources are digested room by room.
PACKAGE = Path(__file__).parents[1]

#: Rooms of this package whose sources are the laws by which a run is made and measured.
ROOMS = ("column", "kernels", "models", "response")


@cache
def laws() -> tuple[str, ...]:
    """Digests of the sources by which runs are made: no run of other laws is ever taken for one of these."""
    return tuple(source_digest(PACKAGE / room) for room in ROOMS)


#: Marks of classes without a version, by which other processes do not know their runs again.
_MARKS: WeakKeyDictionary[type, str] = WeakKeyDictionary()


def version_of(kind: type[Model]) -> list[str]:
    """What tells the runs of a model of somebody else from those of other models: its name and its ``version``.

    Where its class states none, its runs are known again in this process alone. Nothing for a model of this package.
    """
    if kind.__module__.partition(".")[0] == __name__.partition(".")[0]:
        return []
    return [kind.__qualname__, vars(kind).get("version") or _MARKS.setdefault(kind, uuid4().hex)]


class Hasher:
    """Digests of cases of one model.

    Parameters
    ----------
    model : Model
    options : RunOptions
        How long runs go on; their quiet is told with each motion.
    """

    def __init__(self, model: Model, options: RunOptions = DECIDED) -> None:
        self.model, self.options = model, options
        length = [options.tail, options.until_rest, options.until_decided]
        law = [model.name, model.parameters(), length, PACKAGE_VERSION, *laws(), version_of(type(model))]
        self._head = json.dumps(law, sort_keys=True, default=str)
        self._samples: dict[tuple, tuple[Motion, str]] = {}

    def of_column(self, column: Structure) -> Any:
        """The part of a digest that is the column's, to be ended with that of its motion."""
        return hashlib.sha256(f"{self._head} {column.nameless_digest} ".encode())

    def of_motion(self, motion: Motion, size: float, quiet: float) -> bytes:
        """The part of a digest that is the motion's: digest of its samples, factor, and share of it that is quiet.

        Samples that motions share are read once.
        """
        key = samples_of(motion)
        if key not in self._samples:
            self._samples[key] = motion, self.model.taken(motion).replace(factor=1.0).digest
        return f"{self._samples[key][1]} {quiet!r} {size!r}".encode()

    def of_product(self, what: Any, maker: str) -> str:
        """The digest of what is made of a run besides its row: plain values that decide it, and the file that makes it."""
        description = json.dumps([what, digest_of_file(Path(maker))], sort_keys=True, default=str)
        return hashlib.sha256(f"{self._head} {description}".encode()).hexdigest()[: 2 * LENGTH]

    @staticmethod
    def ended(column: Any, motion: bytes) -> bytes:
        """The digest of a case from its two parts."""
        hash_state = column.copy()
        hash_state.update(motion)
        return hash_state.digest()[:LENGTH]

    def of_cases(self, cases: Sequence[Case], quiet: Sequence[float]) -> np.ndarray:
        """Digests of cases one by one, each with its share of quiet, shape (cases, 16)."""
        digests = np.empty((len(cases), LENGTH), dtype=np.uint8)
        for number, ((column, motion), share) in enumerate(zip(cases, quiet, strict=True)):
            end = self.of_motion(motion, motion.factor, share)
            digests[number] = np.frombuffer(self.ended(self.of_column(column), end), np.uint8)
        return digests


def samples_of(motion: Motion) -> tuple:
    """Common part of scaled copies of a motion, as long as one of them lives."""
    return id(motion.samples), id(motion.y_samples), id(motion.z_samples), motion.dt


class Digests:
    """Digests of many cases, and their numbers in a ledger.

    Parameters
    ----------
    digests : array of uint8
        Shape (cases, 16).
    """

    def __init__(self, digests: np.ndarray) -> None:
        self.digests = digests

    def __len__(self) -> int:
        return len(self.digests)

    def __getitem__(self, number: int) -> str:
        return self.digests[number].tobytes().hex()

    @classmethod
    def of(cls, each: Sequence[str]) -> Digests:
        """Digests that are given as texts."""
        return cls(np.array([list(bytes.fromhex(text)) for text in each], dtype=np.uint8).reshape(len(each), LENGTH))

    @cached_property
    def keys(self) -> np.ndarray:
        """Numbers of the cases in the ledger, from their digests, shape (cases,)."""
        first = np.ascontiguousarray(self.digests[:, :8]).view(">u8")[:, 0]
        return (first >> np.uint64(5)).astype(np.int64)  # 59 bits: 18 decimal digits hold them

    def numbers(self, key: int) -> list[int]:
        """Cases with that number in the ledger: one, or several that are the same."""
        first, last = np.searchsorted(self.keys, [key, key + 1], sorter=self.order)
        return self.order[first:last].tolist()

    @cached_property
    def doubles(self) -> np.ndarray:
        """Cases that are the same as one before them, as numbers."""
        keys = self.keys[self.order]
        return self.order[1:][keys[1:] == keys[:-1]]

    @cached_property
    def order(self) -> np.ndarray:
        """Cases by their numbers in the ledger, shape (cases,)."""
        return np.argsort(self.keys, kind="stable")
