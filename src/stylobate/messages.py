"""Messages: English templates with values, which are English as texts and which a report renders in its language."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from itertools import chain
from string import Formatter
from typing import Any, Self, SupportsIndex

_FORMATTER = Formatter()

#: Longest format of a value in a file: none of ours is longer, and a width of many digits would fill the memory.
LONGEST_FORMAT = 7

#: Key of a file of results under which it holds its messages by their places.
MESSAGES = "messages"


class Message(str):
    """A text that knows how it was made; wherever a text will do, it is the English one.

    Attributes
    ----------
    template : str
        English with fields as of :meth:`str.format`, which a catalogue translates; empty for a text of several messages.
    values : dict
        Of the fields, by what stands in them: numbers, messages, and texts that belong to the reader, such as names.
    parts : tuple of str
        Messages and other texts that it is put together from.
    """

    template: str
    values: Mapping[str, Any]
    parts: tuple[str, ...]

    def __new__(
        cls, text: str, template: str = "", values: Mapping[str, Any] | None = None, parts: Iterable[str] = ()
    ) -> Self:
        self = super().__new__(cls, text)
        self.template, self.values, self.parts = template, values or {}, tuple(parts)
        return self

    def __str__(self) -> str:
        return self

    def __add__(self, other: str) -> str:
        return joined("", (self, other))

    def __radd__(self, other: str) -> str:
        return joined("", (other, self))

    def __mul__(self, times: SupportsIndex) -> str:
        return joined("", (self,) * times.__index__())

    def __format__(self, spec: str) -> str:
        text = super().__str__()
        return text[:1].upper() + text[1:] if spec == "capital" else format(text, spec)

    def of(self, **values: Any) -> Message:
        """The message of its template with these values."""
        return say(self.template, **values)

    def changed(self, change: Callable[[str], str]) -> str:
        """The message with its texts changed, such as names of parameters to those of options."""
        if self.parts:
            return joined(
                "", (part.changed(change) if isinstance(part, Message) else change(part) for part in self.parts)
            )
        values = {
            key: value.changed(change)
            if isinstance(value, Message)
            else change(value)
            if isinstance(value, str)
            else value
            for key, value in self.values.items()
        }
        template = change(self.template)
        return Message(filled(template, values) if values else template, template, values)


def say(template: str, /, **values: Any) -> Message:
    """A message of a template and its values; without values the template is the text.

    A field may reach into a value, as ``{run.time:.2f}`` or ``{s[runs]}``: the message keeps what it finds there. A field
    ``{name:capital}`` begins with a capital letter, in every language.
    """
    if not values:
        return Message(template, template)
    names = {name for _, name, _, _ in _FORMATTER.parse(template) if name}
    return Message(
        template.format(**values), template, {name: _FORMATTER.get_field(name, (), values)[0] for name in names}
    )


def digits(value: Any, form: str = "") -> Message:
    """A number in a format, as readers of each language write it."""
    return say(f"{{value:{form}}}", value=value)


def joined(between: str, texts: Iterable[str]) -> str:
    """Texts one after another, those that are empty left out, with what they are made of."""
    each = [text for text in texts if text]
    parts = [piece for k, text in enumerate(each) for piece in (between * (k > 0), text) if piece]
    if not any(isinstance(part, Message) for part in parts):
        return "".join(parts)
    flat = chain.from_iterable(part.parts if isinstance(part, Message) and part.parts else (part,) for part in parts)
    return Message("".join(parts), parts=flat)


def filled(template: str, values: Mapping[str, Any], written: Callable[[Any, str], str] = format) -> str:
    """A template with what its fields hold, each written in its format."""
    texts = []
    for text, name, form, conversion in _FORMATTER.parse(template):
        texts.append(text)
        if name is not None:
            texts.append(written(_FORMATTER.convert_field(values[name], conversion), form or ""))
    return "".join(texts)


def messages_in(value: Any, place: str = "") -> dict[str, Any]:
    """All messages in the plain values of a result by their places, for the file that holds it."""
    if isinstance(value, Message):
        return {place: _plain(value)}
    each = value.items() if isinstance(value, Mapping) else enumerate(value) if isinstance(value, (list, tuple)) else ()
    return {key: message for name, inside in each for key, message in messages_in(inside, f"{place}/{name}").items()}


def restored(value: Any, messages: Mapping[str, Any], place: str = "") -> Any:
    """The plain values of a result with their messages, where their English texts are still those of the file."""
    if isinstance(value, str) and place in messages:
        message = _restored(messages[place])
        return message if message == value else value
    if isinstance(value, dict):
        return {key: restored(entry, messages, f"{place}/{key}") for key, entry in value.items()}
    return (
        [restored(entry, messages, f"{place}/{k}") for k, entry in enumerate(value)]
        if isinstance(value, list)
        else value
    )


def _plain(value: Any) -> Any:
    if not isinstance(value, Message):
        return value.item() if hasattr(value, "item") else value
    if not value.template:
        return {"parts": [_plain(part) for part in value.parts]}
    values = {key: _plain(entry) for key, entry in value.values.items()}
    return {"template": value.template, "values": values} if values else {"template": value.template}


def _restored(value: Any) -> Any:
    if not isinstance(value, dict):
        return value
    if "parts" in value:
        return joined("", map(_restored, value["parts"]))
    template, values = value["template"], {key: _restored(entry) for key, entry in value.get("values", {}).items()}
    if any(len(form or "") > LONGEST_FORMAT for _, _, form, _ in _FORMATTER.parse(template)):
        raise ValueError(f"a format of {template!r} is too long")
    return Message(filled(template, values) if values else template, template, values)


# Shares as percentages: the one rule of rounding for pages, reports, pictures and the command line.

#: Shares that differ by less are one: 0.575 is a little less in binary digits, and is rounded as it is written [%].
CLOSE = 1e-9


def whole_percent(share: float) -> str:
    """A share in whole per cent, the nearest to it, half of a per cent rounded up; a dash where there is none.

    What is not nothing is never written as 0, and what is not all never as 100.
    """
    if not math.isfinite(share):
        return "–"
    size = 100.0 * share
    if CLOSE < size < 0.5 - CLOSE:
        return "<1"
    return ">99" if 99.5 - CLOSE <= size < 100.0 - CLOSE else str(math.floor(size + 0.5 + CLOSE))


def percent(share: float) -> str:
    """A share as a percentage."""
    return f"{whole_percent(share)} %"


def percents(low: float, high: float) -> str:
    """From which share to which, as percentages; one where both are written alike."""
    if whole_percent(low) == whole_percent(high):
        return percent(low)
    return say("{low} to {high} %", low=whole_percent(low), high=whole_percent(high))
