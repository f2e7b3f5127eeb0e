"""What can go wrong, as types: bad input, a failure of ours, a model beyond its declared limits."""

import math
import re
from collections.abc import Iterable
from typing import Any

#: A longer word is cut in messages.
_ENDLESS = re.compile(r"\S{400,}")


class StylobateError(Exception):
    """Base of every error that this package raises on purpose."""


class InputError(StylobateError, ValueError):
    """Input that cannot be used. The message holds the value, the allowed range and the remedy."""

    def __init__(self, message: str = "") -> None:
        super().__init__(_ENDLESS.sub(lambda word: f"{word[0][:100]}…", message))


class OutOfRangeWarning(UserWarning):
    """A run is possible, but outside a limit that the model declares; the message names the limit."""


class DamagedFileWarning(UserWarning):
    """A file that this package keeps for itself was damaged; the message says what became of it."""


class LeftOutWarning(OutOfRangeWarning):
    """A component of the motion is one that the model does not take; the message names both."""


class PlaneOnlyWarning(LeftOutWarning):
    """A round column is computed in a plane, and the motion shakes it across as well: verdicts can be too favourable."""


def as_typed(value: Any) -> str:
    """A value as a person types it: numbers and texts of numpy, in lists too, without the names of their types."""
    return repr(_plain(value))


def _plain(value: Any) -> Any:
    if type(value) in (list, tuple):
        return type(value)(_plain(one) for one in value)
    return value.item() if getattr(value, "shape", None) == () and hasattr(value, "item") else value


def suggest(word: str, known: Iterable[str]) -> str:
    """The clause of a message about an unknown word: “did you mean dem2d?” and a blank; nothing if none is like it."""
    import difflib

    close = difflib.get_close_matches(word, list(known), 1)
    return f"did you mean {close[0]}? " if close else ""


def check_range(
    name: str,
    value: float,
    low: float,
    high: float,
    *,
    unit: str = "",
    open_low: bool = False,
    open_high: bool = False,
    remedy: str = "",
) -> float:
    """Return ``value`` as a float if it is finite and inside the interval, else raise :class:`InputError`.

    Parameters
    ----------
    name : str
        What the value is, as the person who typed it would say.
    value : float
    low, high : float
        Ends of the allowed interval, closed unless ``open_low`` / ``open_high``.
    unit : str
        Shown behind the numbers.
    remedy : str
        One clause that says what to do instead.
    """
    unit_text = f" {unit}" if unit else ""
    interval = f"{'(' if open_low else '['}{low:g}, {high:g}{')' if open_high or math.isinf(high) else ']'}{unit_text}"
    tail = f"; {remedy}" if remedy else ""
    if isinstance(value, bool) or not hasattr(value, "__float__"):
        raise InputError(f"{name} is {as_typed(value)}, not a number; allowed is {interval}{tail}.")
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{name} is {as_typed(value)}, not a number; allowed is {interval}{tail}.") from None
    too_low = number <= low if open_low else number < low
    too_high = number >= high if open_high else number > high
    if not math.isfinite(number) or too_low or too_high:
        raise InputError(f"{name} is {number:g}{unit_text}; allowed is {interval}{tail}.")
    return number
