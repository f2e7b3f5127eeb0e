"""What a validation case is: a quantity, how it is computed, what it must be, and where that comes from.

The tests run over these cases, and the documentation's page on validation is written from them: no number stands twice.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

#: Kinds of evidence, in the order of the page.
KINDS = ("closed forms", "conservation", "convergence", "agreement", "paper", "other codes")


class Criterion(Protocol):
    """What a computed value must be."""

    def holds(self, values: ArrayLike) -> bool:
        """Whether the value is as it must be."""
        ...

    @property
    def expected(self) -> str:
        """The value that it must have, for people."""
        ...

    @property
    def tolerance(self) -> str:
        """How far it may be off, for people."""
        ...


@dataclass(frozen=True)
class Near:
    """Equal to a value, or to several one by one, within a relative or an absolute tolerance."""

    value: float | tuple[float, ...]
    rel: float = 0.0
    abs: float = 0.0

    def holds(self, values: ArrayLike) -> bool:
        """Whether every value is near its own."""
        value, seen = np.atleast_1d(self.value), np.atleast_1d(values)
        return seen.shape == value.shape and bool(np.all(np.abs(seen - value) <= self.rel * np.abs(value) + self.abs))

    @property
    def expected(self) -> str:
        """The value or values."""
        return texts(self.value)

    @property
    def tolerance(self) -> str:
        """``± 0.1 %``, ``± 0.01`` or both."""
        parts = [f"{100.0 * self.rel:.3g} %" if self.rel >= 1e-5 else f"{text(self.rel)} of it"] if self.rel else []
        parts += [text(self.abs)] if self.abs else []
        return "± " + ", ".join(parts)


@dataclass(frozen=True)
class AtMost:
    """Not above a limit in size: the largest error of many, a loss, a count of differences."""

    limit: float

    def holds(self, values: ArrayLike) -> bool:
        """Whether no value is larger."""
        return bool(np.all(np.abs(values) <= self.limit))

    @property
    def expected(self) -> str:
        """Nothing."""
        return "0"

    @property
    def tolerance(self) -> str:
        """The limit."""
        return f"≤ {text(self.limit)}" if self.limit else "none"


@dataclass(frozen=True)
class Between:
    """Inside an interval."""

    low: float
    high: float

    def holds(self, values: ArrayLike) -> bool:
        """Whether every value is inside."""
        seen = np.atleast_1d(values)
        return bool(np.all((self.low <= seen) & (seen <= self.high)))

    @property
    def expected(self) -> str:
        """The interval."""
        return f"{text(self.low)} to {text(self.high)}"

    @property
    def tolerance(self) -> str:
        """None: the interval is all."""
        return ""


@dataclass(frozen=True)
class Case:
    """One line of the validation page, and one test.

    Parameters
    ----------
    kind : str
        One of :data:`KINDS`.
    model : str
        Name of the model as on the command line, or of the analysis.
    quantity : str
        What is computed, with its unit (Markdown).
    compute : callable
        Gives the value, or several.
    criterion : Criterion
    source : str
        Where the value comes from (Markdown).
    reason : str
        Why the tolerance is what it is.
    slow : bool
        Takes more than about ten seconds.
    """

    kind: str
    model: str
    quantity: str
    compute: Callable[[], ArrayLike]
    criterion: Criterion
    source: str
    reason: str
    slow: bool = False

    @property
    def name(self) -> str:
        """Name of the test: model and function."""
        return f"{self.model}-{self.compute.__name__}"


def collected(kind: str, cases: list[Case]) -> Callable[..., Callable]:
    """A decorator that makes a case of the function that computes it and adds it to ``cases``.

    Its arguments are those of :class:`Case` from ``model`` on, without ``compute``. The function is computed once: the
    table, the figures and the test share its result.
    """

    def case(model: str, quantity: str, criterion: Criterion, *, source: str, reason: str, slow: bool = False):
        def add(compute: Callable[[], ArrayLike]) -> Callable[[], ArrayLike]:
            once = cache(compute)
            cases.append(Case(kind, model, quantity, once, criterion, source, reason, slow))
            return once

        return add

    return case


def text(value: float) -> str:
    """A number for people: five significant digits; very small and large ones as powers of ten."""
    if value == 0 or 1e-3 <= abs(value) < 1e5:
        return f"{value:.5g}"
    mantissa, exponent = f"{value:.1e}".split("e")
    size = "" if mantissa == "1.0" else f"{mantissa.removesuffix('.0')}·"
    return f"{size}10{str(int(exponent)).translate(SUPERSCRIPT)}"


def texts(values: ArrayLike) -> str:
    """Numbers for people, one after the other."""
    return ", ".join(text(float(value)) for value in np.atleast_1d(values))


SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
