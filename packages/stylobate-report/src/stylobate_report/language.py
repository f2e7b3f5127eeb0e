"""The language of a report: a catalogue (``.po``) of what its messages are in it, and how its readers write numbers.

Catalogues are read as they stand, by few lines, and none is compiled: those of readers lie beside their project file, where
nothing compiles them, and one that is corrected holds at once.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import replace
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from stylobate.atomic import replacing
from stylobate.errors import InputError
from stylobate.messages import Message, filled, joined, say
from stylobate.probability.states import NO_MEASURE
from stylobate.text_tables import printable, read_bytes

from .numbers import BETWEEN, IN_JOINT, SPANNING, TURNED
from .page import Code, Exact, Facts, Item, Note, Picture, Points, Section

#: Languages whose catalogues come with the package; a report is written in English and needs none.
LANGUAGES = ("it", "el")

#: Largest catalogue that is read [bytes].
MOST = 10_000_000

#: A word of a text, and a field of a template with its format.
WORD, FIELD = re.compile(r"(?<![\w./-])[^\W\d_]{2,}(?![\w]|\.\w)"), re.compile(r"\{([^{}:!]+)[^{}]*\}")

#: Headers of a catalogue: marks before the decimals of a number, and between groups of three digits.
DECIMAL, GROUPS = "X-Decimal", "X-Groups"

#: Names that the program gives to parts of what stands, of which the nouns are translated.
NUMBERED = re.compile(r"(ground|column|drum|capital|architrave|block|tie|dowel|clamp|layer|core|bar)( \d+)?")


#: Symbols of units, which are alike in all languages, and the most words that a name has: more are a sentence.
UNITS, MOST_IN_A_NAME = {"mm", "kg", "kN", "Hz", "rad", "MPa", "Pa", "ms", "kJ"}, 4


def has_words(template: str) -> bool:
    """Whether a template has anything to translate beside its fields, units and names of the program."""
    return any(word not in UNITS for word in WORD.findall(FIELD.sub("", template)))


class Language:
    """A catalogue, and what of a report is not in it.

    Parameters
    ----------
    tag : str
        Of the language (BCP 47).
    catalogue : dict
        From templates in English to those in this language, with the same fields; empty for English.
    own : iterable of str
        Names that belong to the reader, such as those of columns and motions: they are in no language.
    decimal, groups : str
        Mark before the decimals of a number, and between groups of three digits.

    Attributes
    ----------
    foreign : bool
        Whether it is another language than English.
    english : dict
        Sections of which a part stayed English, in their order, as keys.
    missing : dict
        Templates and texts that stayed English, as keys.
    """

    def __init__(
        self,
        tag: str = "en",
        catalogue: dict[str, str] | None = None,
        own: Iterable[str] = (),
        decimal: str = ".",
        groups: str = ",",
    ) -> None:
        self.tag, self.catalogue, self.own, self.foreign = tag, catalogue or {}, set(own), tag != "en"
        self.marks = str.maketrans({".": decimal, ",": groups})
        self.english: dict[str, None] = {}
        self.missing: dict[str, None] = {}

    def say(self, text: str) -> str:
        """A text in this language as far as it is known, with its numbers as readers write them."""
        if not self.foreign or isinstance(text, Exact):
            return text
        if not isinstance(text, Message):
            return self._name(text)
        if text.parts:
            return "".join(map(self.say, text.parts))
        return (
            filled(self._template(text.template), text.values, self._written) if text.values else self._template(text)
        )

    def _template(self, template: str) -> str:
        translation = self.catalogue.get(template)
        if translation is None and template not in self.own and has_words(template):
            self.missing.setdefault(str(template))
        return template if translation is None else translation

    def _name(self, text: str) -> str:
        """A name as it is; nouns of one that the program has given in this language."""
        if link := SPANNING.fullmatch(text):
            known = {name: value for name, value in link.groupdict().items() if value is not None}
            start = "drum {lower}" if "lower" in known else "the base"
            return self.say(say(f"{{kind}} from {start} to drum {{upper}}", **known | {"kind": say(known["kind"])}))
        if link := IN_JOINT.fullmatch(text):
            return self.say(say("{kind} in joint {joint}", kind=say(link[1]), joint=link[2])) + link[3]
        if link := BETWEEN.fullmatch(text):
            words = say("{kind} between {one} and {other}", kind=say(link[1]), one=link[2], other=link[3])
            return self.say(words) + link[4]
        if (motion := TURNED.fullmatch(text)) and any(motion.groups()[1:]):
            record, azimuth, back, peak = motion.groups()
            turned = say("at {azimuth:g}°", azimuth=float(azimuth)) if azimuth else ""
            scaled = say("scaled to {peak:g} g", peak=float(peak)) if peak else ""
            return self.say(joined(", ", [joined(" ", [record, turned, say("reversed") if back else ""]), scaled]))
        if text in self.own or not WORD.search(text):
            return text
        if len(pair := text.split(" – ")) == 2:  # a joint, by what it lies between
            return " – ".join(map(self.say, pair))
        if text in NO_MEASURE:  # a state of a column that the program names
            return self._template(text)
        if parts := numbered(text):
            return ", ".join(self._template(noun) + number for noun, number in parts)
        if len(WORD.findall(text)) > MOST_IN_A_NAME:
            self.missing.setdefault(text)
        return text

    def _written(self, value: Any, form: str) -> str:
        """A value of a message: numbers with the marks of this language."""
        if isinstance(value, str):
            text = self.say(value)
            return text[:1].upper() + text[1:] if form == "capital" else format(text, form)
        text = format(value, form)
        return text.translate(self.marks) if isinstance(value, (int, float)) or hasattr(value, "dtype") else text

    def numbers(self, text: str) -> str:
        """A text of numbers alone, such as those of an axis, with the marks of this language."""
        return text.translate(self.marks)

    def section(self, section: Section) -> Section:
        """A section in this language; that a part of it stayed English is kept in mind."""
        before = len(self.missing)
        title = self.say(section.title)
        items = [self.item(item) for item in section.items]
        if len(self.missing) > before:
            self.english.setdefault(title)
        return Section(title, items)

    def item(self, item: Item) -> Item:
        """An item in this language."""
        if isinstance(item, (str, Code)):
            return item if isinstance(item, Code) else self.say(item)
        if isinstance(item, (Points, Note)):
            return replace(item, texts=list(map(self.say, item.texts)))
        if isinstance(item, Picture):
            if item.english and self.foreign:
                self.missing.setdefault(str(item.caption))
            return replace(item, caption=self.say(item.caption))
        if isinstance(item, Facts):
            pairs = [(self.say(name), self.say(value)) for name, value in item.pairs]
            return replace(item, pairs=pairs, caption=self.say(item.caption))
        body = [list(map(self.say, row)) for row in item.body]
        looks = {self.say(text): look for text, look in item.looks.items()}
        return replace(
            item, header=list(map(self.say, item.header)), body=body, caption=self.say(item.caption), looks=looks
        )


def numbered(name: str) -> list[tuple[str, str]]:
    """Nouns and numbers of a name that the program has given, such as column 1, drum 3; none of a name of the reader's."""
    parts = [NUMBERED.fullmatch(part) for part in name.split(", ")]
    return [(part[1], part[2] or "") for part in parts if part] if all(parts) else []


#: The language in which pictures of a report are drawn.
SPOKEN: ContextVar[Language | None] = ContextVar("SPOKEN", default=None)


@contextmanager
def speaking(language: Language) -> Iterator[None]:
    """Draw the pictures inside in this language."""
    token = SPOKEN.set(language)
    try:
        yield
    finally:
        SPOKEN.reset(token)


def language_of(name: str, own: Iterable[str] = ()) -> Language:
    """A language by its tag, or by a catalogue.

    Raises
    ------
    InputError
        There is neither, or a translation does not hold the fields of its message.
    """
    if name == "en":
        return Language()
    if name not in LANGUAGES and not name.endswith(".po"):
        known = ", ".join(f'"{tag}"' for tag in ("en", *LANGUAGES))
        raise InputError(
            f"language is {name!r}; it is one of {known}, or a catalogue such as de.po, of which 'stylobate report' writes "
            "a template.",
            "language",
        )
    catalogue = dict(catalogue_of(file_of(name) if name in LANGUAGES else Path(name)))
    head = dict(line.partition(": ")[::2] for line in catalogue.pop("", "").splitlines())
    if not head.get("Language"):
        raise InputError(
            f"{printable(name)} states no Language in its head; add it there, such as Language: de.", "language"
        )
    return Language(head["Language"], catalogue, own, head.get(DECIMAL, "."), head.get(GROUPS, ","))


def file_of(tag: str) -> Path:
    """The catalogue of a language that comes with the package."""
    return Path(str(files("stylobate_report") / "languages" / f"{tag}.po"))


@cache
def catalogue_of(path: Path) -> dict[str, str]:
    """Translations of a catalogue by their messages, its head under the empty one; none that is empty or in doubt (fuzzy).

    Raises
    ------
    InputError
        It is no catalogue, or a translation does not hold the fields of its message.
    """
    catalogue: dict[str, str] = {}
    for entry in re.split(r"\n\s*\n", read_bytes(path, MOST).decode("utf-8", "replace")):
        parts = {"msgid": "", "msgstr": ""}
        key = ""
        for line in entry.splitlines():
            start = re.match(r"(msgid|msgstr) ", line)
            key = start[1] if start else key
            if line.startswith("#") or not line.strip():
                continue
            try:
                parts[key] += ast.literal_eval(line[start.end() :] if start else line)
            except (KeyError, SyntaxError, TypeError, ValueError):
                raise InputError(f"{printable(path)} is no catalogue: {line[:60]!r} is not understood.") from None
        english, translation = parts["msgid"], parts["msgstr"]
        if not translation.strip() or re.search(r"^#,.*\bfuzzy\b", entry, re.MULTILINE):
            continue
        if set(FIELD.findall(translation)) != set(FIELD.findall(english)) and english:
            raise InputError(
                f"{printable(path)}: the translation of {english!r} must hold "
                f"{', '.join(FIELD.findall(english)) or 'no field'} in braces, as the message does."
            )
        catalogue[english] = translation
    return catalogue


def write_template(path: Path) -> Path:
    """Write a catalogue of all messages of a report without their translations."""
    text = re.sub(r"\nmsgstr .*\n(?:\".*\n)*", '\nmsgstr ""\n', file_of(LANGUAGES[0]).read_text(encoding="utf-8"))
    lines = ("Language: ", "Content-Type: text/plain; charset=utf-8", f"{DECIMAL}: .", f"{GROUPS}: ,")
    lines = ("Language: ", "Content-Type: text/plain; charset=utf-8", f"{DECIMAL}: .", f"{GROUPS}: ,")
    head = 'msgid ""\nmsgstr ""\n' + "".join(f'"{line}\\n"\n' for line in lines)
    with replacing(path) as partial:
        partial.write_text(head + text[text.index("\n\n") :], encoding="utf-8")
    return path
