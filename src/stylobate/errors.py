"""Errors, as types: bad input, a failure of ours, a model beyond its declared limits."""

import math
import re
import sys
import unicodedata
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

#: Categories of characters that no name holds: control characters and ends of lines and paragraphs.
NOT_IN_NAMES = ("Cc", "Zl", "Zp")

#: A longer word is cut in messages.
_ENDLESS = re.compile(r"\S{400,}")


def _cut(message: str) -> str:
    return _ENDLESS.sub(lambda word: f"{word[0][:100]}…", message)


class StylobateError(Exception):
    """Base of every error that this package raises on purpose."""


class Quantity(NamedTuple):
    """A number that is not allowed, and the interval that is."""

    value: float
    low: float
    high: float
    open_low: bool = False
    open_high: bool = False
    unit: str = ""

    def words(self, unit: str = "", size: float = 1.0) -> tuple[str, str]:
        """Value and interval as messages say them, in another ``unit`` of that ``size`` if need be: "-1 m", "[0, 2] m"."""
        unit = unit or (f" {self.unit}" if self.unit else "")
        ends = "(" if self.open_low else "[", ")" if self.open_high or math.isinf(self.high) else "]"
        return f"{self.value / size:g}{unit}", f"{ends[0]}{self.low / size:g}, {self.high / size:g}{ends[1]}{unit}"


class InputError(StylobateError, ValueError):
    """Input that cannot be used. The message holds the value, the allowed range and the remedy.

    Parameters
    ----------
    message : str
        Parameters stand in backticks, with a value where one is advised: :func:`reworded`.
    field : str, optional
        Path of what is wrong, such as ``frequency``, ``drum.3.height`` or ``link.1.at``: drums, joints and links by number.
    value, allowed, remedy : optional
        What the message says of it, as far as they are known one by one.
    """

    #: The number that is not allowed; words of the message that say where in a file it is, which the field says as well.
    quantity: Quantity | None = None
    places: tuple[str, ...] = ()

    def __init__(
        self, message: str = "", field: str | None = None, *, value: Any = None, allowed: str = "", remedy: str = ""
    ) -> None:
        super().__init__(_cut(message))
        self.field, self.value, self.allowed, self.remedy = field, value, allowed, remedy

    def place(self, place: str, *path: object) -> None:
        """Say where the error is, as :func:`within`."""
        if place:  # a key of a table, a part of a file
            self.args = (_cut(f"{place}: {reworded(str(self), str)}"),)
            self.places = (f"{place}: ", *self.places)
        self.field = ".".join(map(str, (*path, *([self.field] if self.field else [])))) or None

    def without(self, place: str) -> None:
        """Say it without a place that its reader does not know."""
        self.args = (str(self).replace(place, ""),)


@contextmanager
def within(place: str = "", *path: object) -> Iterator[None]:
    """Put the place before what an :class:`InputError` inside says, and the path of that place before its field.

    Parameters
    ----------
    place : str
        In words: ``my-column.toml``, ``[[drum]] number 3``; parameters are keys there, and lose their marks.
    *path
        Such as ``"drum", 3``.
    """
    try:
        yield
    except InputError as error:
        error.place(place, *path)
        raise


#: A parameter in a sentence: `scale`, `dt=0.01`, `unit='g'`.
PARAMETER = re.compile(r"(?<!`)`([a-z][a-z0-9_]*)(?:=([^`]*))?`(?!`)")

#: Units with which a person types the value of a parameter.
UNITS = {"dt": "s", "tail": "s"}


def reworded(sentence: str, called: Callable[[str], str]) -> str:
    """A message whose parameters are called as its reader knows them: options, fields of a page, keys of a file.

    Parameters
    ----------
    sentence : str
        Parameters stand in backticks.
    called : callable
        From the name of a parameter to what the reader calls it.
    """

    def word(match: re.Match[str]) -> str:
        name, value = match.groups()
        text = (value or "").strip("'") + UNITS.get(name, "")
        return " ".join([called(name), *([f'"{text}"' if " " in text else text] if value else [])])

    return PARAMETER.sub(word, sentence)


class OutOfRangeWarning(UserWarning):
    """A run is possible, but outside a limit that the model declares; the message names the limit."""


class DamagedFileWarning(UserWarning):
    """A file that this package keeps for itself was damaged; the message says what became of it."""


class LeftOutWarning(OutOfRangeWarning):
    """A component of the motion is one that the model does not take; the message names both."""


class PlaneOnlyWarning(LeftOutWarning):
    """A round column is computed in a plane, and the motion shakes it across as well: verdicts can be too favourable."""


#: Whose frames stand between a warning and the line that caused it: our own, and those that call for them.
_BETWEEN = (__package__, "functools", "contextlib")


def warn(message: str, category: type[Warning] = OutOfRangeWarning) -> None:
    """Warn at the line that called this package, however deep inside it the doubt arose."""
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] in _BETWEEN:
        frame, level = frame.f_back, level + 1
    warnings.warn(message, category, stacklevel=level)


def as_typed(value: Any) -> str:
    """A value as a person types it: numbers and texts of numpy, in lists too, without the names of their types."""
    return repr(_plain(value))


def _plain(value: Any) -> Any:
    if type(value) in (list, tuple):
        return type(value)(_plain(item) for item in value)
    return value.item() if getattr(value, "shape", None) == () and hasattr(value, "item") else value


def suggest(word: str, known: Iterable[str]) -> str:
    """The clause of a message about an unknown word: “did you mean dem2d?” and a blank; nothing if none is like it."""
    import difflib

    close = difflib.get_close_matches(word, list(known), 1)
    return f"did you mean {close[0]}? " if close else ""


def no_field(of: str, name: str, known: Iterable[str]) -> str:
    """The message about a field that something does not have."""
    fields = list(known)
    return f"{of} has no field {name!r}; {suggest(name, fields)}it has {', '.join(fields)}"


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
    of: str = "",
    field: str | None = None,
) -> float:
    """Return ``value`` as a float if it is finite and inside the interval, else raise :class:`InputError`.

    Parameters
    ----------
    name : str
        What the value is: the name of a parameter or a key, or what it is called.
    value : float
    low, high : float
        Ends of the allowed interval, closed unless ``open_low`` / ``open_high``.
    unit : str
        Shown behind the numbers.
    remedy : str
        One clause that says what to do instead.
    of : str
        What has it, such as “a drum”.
    field : str, optional
        Of the error; by default the name, where it is that of a parameter.
    """
    is_number = not isinstance(value, bool) and hasattr(value, "__float__")
    try:
        number = float(value) if is_number else math.nan
    except (TypeError, ValueError):
        number, is_number = math.nan, False
    too_low = number <= low if open_low else number < low
    too_high = number >= high if open_high else number > high
    if not math.isfinite(number) or too_low or too_high:
        quantity = Quantity(number, low, high, open_low, open_high, unit)
        shown, interval = quantity.words()
        shown = shown if is_number else f"{as_typed(value)}, not a number"
        error = _wrong(name, value, shown, f"is {interval}", remedy, of, field)
        error.quantity = quantity
        raise error
    return number


def check_whole(
    name: str,
    value: Any,
    low: int,
    high: int | None = None,
    *,
    of: str = "",
    remedy: str = "",
    field: str | None = None,
) -> int:
    """Return ``value`` if it is a whole number from ``low`` to ``high``, else raise :class:`InputError`.

    Parameters are those of :func:`check_range`; numbers of numpy are whole numbers as well.
    """
    whole = hasattr(value, "__index__") and not isinstance(value, bool)
    if not whole or value < low or (high is not None and value > high):
        allowed = f"is a whole number from {low}{'' if high is None else f' to {high}'}"
        raise _wrong(name, value, as_typed(value), allowed, remedy, of, field)
    return int(value)


def check_choice(
    name: str, value: Any, known: Iterable[Any], *, of: str = "", remedy: str = "", field: str | None = None
) -> None:
    """Raise :class:`InputError` if ``value`` is none of those that are ``known``; else as :func:`check_range`."""
    choices = list(known)
    if value not in choices:
        near = (
            suggest(value, [choice for choice in map(str, choices) if len(choice) > 2])
            if isinstance(value, str)
            else ""
        )
        raise _wrong(name, value, as_typed(value), f"are {', '.join(map(str, choices))}", remedy, of, field, near)


def check_kind(name: str, value: Any, kind: Any, *, allowed: str = "", optional: bool = False) -> Any:
    """Return ``value`` if it is of a kind, else raise :class:`InputError`.

    Parameters
    ----------
    name : str
        As in :func:`check_range`.
    value : object
    kind : type
        Its attribute ``wanted``, where it has one, is what a message calls it.
    allowed : str
        What a message calls it instead.
    optional : bool
        None is allowed as well.
    """
    if isinstance(value, kind) or (optional and value is None):
        return value
    is_class = isinstance(value, type) and issubclass(value, kind)
    remedy = f"write {value.__name__}() with brackets" if is_class else ""
    raise _wrong(name, value, _value_in_words(value), f"is {_expected_kind(kind, allowed)}", remedy, "", None)


def check_name(what: str, value: Any) -> str:
    """Return a name that is one line of text, else raise :class:`InputError`; ``what`` is what the message calls it."""
    if not check_kind(what, value, str).strip() or any(unicodedata.category(char) in NOT_IN_NAMES for char in value):
        raise InputError(
            f"{what} is {value!a}; write one line of text, without tabs and control characters.",
            "name",
        )
    return value


def check_all(name: str, values: Any, kind: Any, *, allowed: str = "") -> Sequence[Any]:
    """Return the values as a sequence if all of them are of a kind, else raise :class:`InputError`.

    Parameters are those of :func:`check_kind`; a single value of the kind is a list of one.
    """
    if isinstance(values, kind):
        return (values,)
    if isinstance(values, (str, bytes, Mapping, type)) or not hasattr(values, "__iter__"):
        raise _wrong(
            name, values, _value_in_words(values), f"is a list, each {_expected_kind(kind, allowed)}", "", "", None
        )
    sequence = values if isinstance(values, (list, tuple)) else tuple(values)
    for number, element in enumerate(sequence, 1):
        check_kind(f"number {number} of {name}", element, kind, allowed=allowed)
    return sequence


#: What a person calls the kinds of plain values.
_PLAIN = {
    "str": "text",
    "Path": "path",
    "PathLike": "path",
    "Real": "number",
    "Callable": "function",
    "Mapping": "mapping",
}


def _expected_kind(kind: Any, allowed: str) -> str:
    kinds = kind if isinstance(kind, tuple) else (kind,)
    called = (
        getattr(option, "wanted", None) or _with_article(str(_PLAIN.get(option.__name__, option.__name__)))
        for option in kinds
    )
    return allowed or " or ".join(called)


def _value_in_words(value: Any) -> str:
    """What came in place of something else, in few words: a plain value as it is typed, else what it is."""
    if isinstance(value, type):
        return f"the class {value.__name__}"
    plain = value is None or isinstance(value, (str, int, float))
    return as_typed(value) if plain else _with_article(type(value).__name__)


def _with_article(word: str) -> str:
    return f"{'an' if word[0] in 'AEIOaeio' else 'a'} {word}"


def _wrong(
    name: str, value: Any, shown: str, allowed: str, remedy: str, of: str, field: str | None, near: str = ""
) -> InputError:
    """The error about a value that is not allowed."""
    words = f"{name}{f' of {of}' if of else ''} is {shown}; {near}allowed {allowed}{f'; {remedy}' if remedy else ''}."
    path = field or (name.strip("`") if name.strip("`").isidentifier() else None)
    return InputError(words, path, value=value, allowed=allowed.partition(" ")[2], remedy=remedy)
