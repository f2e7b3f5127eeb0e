"""What decides a case, as a digest: column as it stands, samples and factor of the motion, model, tail, quiet, laws."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from ..column import Column
from ..kernels.jit import source_digest
from ..models.base import Case, Model
from ..motion import Motion
from ..version import __version__

#: Bytes of a digest.
LENGTH = 16


class Hasher:
    """Digests of cases of one model.

    Parameters
    ----------
    model : Model
    tail : float
        Time to go on after each motion [s].
    """

    def __init__(self, model: Model, tail: float) -> None:
        law = [model.name, model.parameters(), tail, __version__, source_digest()]
        self._head = json.dumps(law, sort_keys=True, default=str)
        self._samples: dict[tuple, tuple[Motion, str]] = {}

    def of_column(self, column: Column) -> Any:
        """The part of a digest that is the column's, to be ended with that of its motion."""
        return hashlib.sha256(f"{self._head} {column.digest} ".encode())

    @staticmethod
    def of_motion(samples: str, size: float, quiet: float) -> bytes:
        """The part of a digest that is the motion's: digest of its samples, factor, and share of it that is quiet."""
        return f"{samples} {quiet!r} {size!r}".encode()

    @staticmethod
    def ended(column: Any, motion: bytes) -> bytes:
        """The digest of a case from its two parts."""
        found = column.copy()
        found.update(motion)
        return found.digest()[:LENGTH]

    def of_cases(self, cases: Sequence[Case], quiet: float) -> np.ndarray:
        """Digests of cases one by one, shape (cases, 16); samples that motions share are read once."""
        found = np.empty((len(cases), LENGTH), dtype=np.uint8)
        for number, (column, motion) in enumerate(cases):
            key = samples_of(motion)
            if key not in self._samples:
                self._samples[key] = motion, digest_of_samples(motion)
            end = self.of_motion(self._samples[key][1], motion.factor, quiet)
            found[number] = np.frombuffer(self.ended(self.of_column(column), end), np.uint8)
        return found


def digest_of_samples(motion: Motion) -> str:
    """The digest of a motion without its factor."""
    return motion.replace(factor=1.0).digest


def samples_of(motion: Motion) -> tuple:
    """What scaled copies of a motion share, as long as one of them lives."""
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

    @cached_property
    def keys(self) -> np.ndarray:
        """Numbers of the cases in the ledger, from their digests, shape (cases,)."""
        first = np.ascontiguousarray(self.digests[:, :8]).view(">u8")[:, 0]
        return (first >> np.uint64(5)).astype(np.int64)  # 59 bits: 18 decimal digits hold them

    def numbers(self, key: int) -> list[int]:
        """Cases with that number in the ledger: one, or several that are the same."""
        order, keys = self._order
        first, last = np.searchsorted(keys, [key, key + 1])
        return order[first:last].tolist()

    @cached_property
    def doubles(self) -> np.ndarray:
        """Cases that are the same as one before them, as numbers."""
        order, keys = self._order
        return order[1:][keys[1:] == keys[:-1]]

    @cached_property
    def _order(self) -> tuple[np.ndarray, np.ndarray]:
        order = np.argsort(self.keys, kind="stable")
        return order, self.keys[order]
