"""Rows of many runs, kept in columns: for each run the bytes of its numbers, not a dictionary."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any, overload

import numpy as np

if TYPE_CHECKING:
    import pandas

#: Value of a row under a name: nothing, None, or a value.
_NOTHING, _NONE, _VALUE = 0, 1, 2

#: Stored form of values of a type; texts as their place in a list of all texts.
_TYPES = {bool: np.int8, int: np.int64, float: np.float64, str: np.int32}

#: Kinds of values that are told by their type alone.
_PLAIN = {kind: (kind,) for kind in (bool, float, str)}

#: Most rows that wait until they are put into columns together, which costs a fifth of one after the other.
_WAITING = 512


class Rows(Sequence[Any]):
    """Rows (``Measures.row()``) by number; None where there is none.

    A sequence of dictionaries for whoever reads it. Numbers, short texts and lists of numbers take eight bytes a number, a
    text four and the text once, and one byte says whether there is a value; other values are kept as they are.

    Parameters
    ----------
    count : int
        Number of runs.
    """

    def __init__(self, count: int) -> None:
        self.made = np.zeros(count, dtype=bool)
        self._there: dict[str, _Column] = {}
        self._waiting: list[tuple[int, Mapping[str, Any]]] = []

    @classmethod
    def of(cls, rows: Iterable[Mapping[str, Any] | None]) -> Rows:
        """Rows that are given; as they are, if they are rows in columns already."""
        if isinstance(rows, Rows):
            return rows
        listed = list(rows)
        result = cls(len(listed))
        for number, row in enumerate(listed):
            if row is not None:
                result[number] = row
        return result

    @property
    def _columns(self) -> dict[str, _Column]:
        """All columns, with all rows."""
        if self._waiting:
            self._put_waiting()
        return self._there

    def _put_waiting(self) -> None:
        """Put the rows that wait into the columns, together where they have the same names."""
        waiting, self._waiting = self._waiting, []
        names = [tuple(row) for _, row in waiting]
        if len(set(names)) == 1:
            numbers, rows = zip(*waiting, strict=True)
            for name, *values in zip(names[0], *(row.values() for row in rows), strict=True):
                self._column(name).put_all(numbers, values)
        else:
            for number, row in waiting:
                for name, value in row.items():
                    self._column(name).put(number, value)

    def _column(self, name: str) -> _Column:
        if name not in self._there:
            self._there[name] = _Column(np.zeros(len(self), dtype=np.uint8))
        return self._there[name]

    @property
    def finished(self) -> int:
        """Number of rows that are there."""
        return int(np.count_nonzero(self.made))

    def floats(self, name: str) -> np.ndarray:
        """Numbers (or truths) under a name, shape (count,); NaN where there is none."""
        column = self._columns.get(name)
        return np.full(len(self), np.nan) if column is None else column.floats()

    def are(self, name: str, text: str) -> np.ndarray:
        """Rows whose value under a name is this text, shape (count,)."""
        column = self._columns.get(name)
        return np.zeros(len(self), dtype=bool) if column is None else column.are(text)

    def table(self) -> pandas.DataFrame:
        """The rows that are there, one after the other."""
        import pandas

        columns = {name: pandas.Series(column.listed(self.made)) for name, column in self._columns.items()}
        return pandas.DataFrame(columns, index=range(self.finished))

    def __len__(self) -> int:
        return len(self.made)

    def __setitem__(self, number: int, row: Mapping[str, Any]) -> None:
        self._waiting.append((number, dict(row)))  # whoever gave it may go on with it
        self.made[number] = True
        if len(self._waiting) >= _WAITING:
            self._put_waiting()

    @overload
    def __getitem__(self, index: int) -> dict[str, Any] | None: ...
    @overload
    def __getitem__(self, index: slice) -> Rows: ...
    def __getitem__(self, index: int | slice) -> dict[str, Any] | Rows | None:
        if isinstance(index, slice):
            part = Rows(0)
            part.made = self.made[index]
            part._there = {name: column.part(index) for name, column in self._columns.items()}
            return part
        if not self.made[index]:
            return None
        return {name: column.get(index) for name, column in self._columns.items() if column.state[index] != _NOTHING}

    def __eq__(self, other: object) -> bool:
        """Whether another sequence holds equal rows."""
        if not isinstance(other, Sequence):
            return NotImplemented
        return len(self) == len(other) and all(mine == theirs for mine, theirs in zip(self, other, strict=True))

    __hash__ = None  # type: ignore[assignment]  # rows can be put in


class _Column:
    """Values under one name: of one type in an array, else as they are in a list."""

    def __init__(self, state: np.ndarray) -> None:
        self.state = state
        self.kind: tuple | None = None  # of no value so far
        self.values: Any = None
        self.texts: list[str] = []
        self.codes: dict[str, int] = {}

    def put(self, number: int, value: Any) -> None:
        """Keep a value."""
        if value is None:
            self.state[number] = _NONE
            return
        if self.kind != (kind := _kind(value)):
            kind = self._take(kind)
        self.values[number] = self._coded(value) if kind == (str,) else value
        self.state[number] = _VALUE

    def put_all(self, numbers: Sequence[int], values: Sequence[Any]) -> None:
        """Keep values of many rows."""
        types, there = set(map(type, values)), list(numbers)
        kind = _kind(values[0])
        if types == {type(None)}:
            self.state[there] = _NONE
            return
        alike = len(types) == 1 and (kind in _PLAIN.values() or _all_alike(kind, values))
        if not alike or self.kind not in (None, kind):
            for number, value in zip(numbers, values, strict=True):
                self.put(number, value)
            return
        if self.kind is None:
            self._take(kind)
        self.values[there] = [self._coded(value) for value in values] if kind == (str,) else values
        self.state[there] = _VALUE

    def _coded(self, text: str) -> int:
        """Place of a text in the list of all."""
        code = self.codes.setdefault(text, len(self.texts))
        if code == len(self.texts):
            self.texts.append(text)
        return code

    def get(self, number: int) -> Any:
        """The value as it was given."""
        if self.state[number] != _VALUE:
            return None
        if self.kind == (object,):
            return self.values[number]
        if self.kind == (str,):
            return self.texts[self.values[number]]
        if self.kind == (bool,):
            return bool(self.values[number])
        return self.values[number].tolist()

    def part(self, which: slice) -> _Column:
        """Some of the values."""
        part = _Column(self.state[which])
        part.kind, part.texts, part.codes = self.kind, self.texts, self.codes
        part.values = None if self.values is None else self.values[which]
        return part

    def floats(self) -> np.ndarray:
        """As floats, NaN where there is no value."""
        if self.kind == (object,):
            return np.array([np.nan if value is None else float(value) for value in self.values])
        there = self.state == _VALUE
        return np.full(len(there), np.nan) if self.values is None else np.where(there, self.values, np.nan)

    def are(self, text: str) -> np.ndarray:
        """Rows whose value is this text."""
        if self.kind == (str,):
            return (self.state == _VALUE) & (self.values == self.codes.get(text, -1))
        return np.array([self.get(number) == text for number in range(len(self.state))], dtype=bool)

    def listed(self, which: np.ndarray) -> Any:
        """Values where ``which`` is true, as a column of a table: an array where there are numbers only."""
        there = self.state[which] == _VALUE
        if self.kind in (None, (float,)) or (self.kind == (int,) and not there.all()):
            return self.floats()[which]
        if self.kind in ((int,), (bool,)) and there.all():
            return self.values[which].astype(bool if self.kind == (bool,) else np.int64)
        if self.kind in ((str,), (object,)):
            numbers = np.flatnonzero(which).tolist()
            return np.fromiter((self.get(number) for number in numbers), dtype=object, count=len(numbers))
        given = self.values[which].astype(bool) if self.kind == (bool,) else self.values[which]
        values = (value if known else None for value, known in zip(given.tolist(), there.tolist(), strict=True))
        return np.fromiter(values, dtype=object, count=len(there))

    def _take(self, kind: tuple) -> tuple:
        if self.kind is None:
            self.kind = kind
            count = len(self.state)
            if kind == (object,):
                self.values = [None] * count
            else:
                self.values = np.zeros((count, *kind[1:]), dtype=_TYPES[kind[0]])
        elif self.kind != (object,):  # values of several types
            self.values = [self.get(number) for number in range(len(self.state))]
            self.kind = (object,)
        return self.kind


def _all_alike(kind: tuple, values: Sequence[Any]) -> bool:
    """Whether all values, of the type of the first, are of its kind: whole numbers, or lists of so many floats."""
    if kind == (int,):
        return all(-(2**63) <= value < 2**63 for value in values)
    return len(kind) == 2 and set(map(len, values)) == {kind[1]} and set(map(type, chain(*values))) <= {float}


def _kind(value: Any) -> tuple:
    """The type of a value, and the length of a list of floats; object for anything else."""
    if (kind := _PLAIN.get(type(value))) is not None:
        return kind
    for plain_type in (float, bool, int, str):
        if isinstance(value, plain_type):
            return (object,) if plain_type is int and not -(2**63) <= value < 2**63 else (plain_type,)
    if isinstance(value, list) and (
        set(map(type, value)) <= {float} or all(isinstance(number, float) for number in value)
    ):
        return float, len(value)
    return (object,)
