"""The language of a report: its sentences are looked up in one table per language, and what has no entry is told."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import replace
from functools import cache
from importlib.resources import files
from pathlib import Path

from stylobate.atomic import replacing
from stylobate.column.toml import Table, read_table
from stylobate.errors import InputError
from stylobate.reading import shown

from .page import Code, Facts, Item, Note, Own, Picture, Points, Section

#: Languages whose tables come with the package; a report is written in English and needs none.
LANGUAGES = ("it", "el")

#: A named placeholder of a sentence.
HOLE = re.compile(r"\{([a-z_]+)\}")

#: What stands before the full stop of a sentence (no initial of a name), and what begins the next one.
_LAST, _FIRST = r"[a-zα-ω\d)%”°’\]\s/][a-zα-ω\d)%”°’\]³²]", r"[A-Z“\d–]"

#: Placeholders that stand for a number and nothing else, and a number.
NUMBERS, _NUMBER = ("count", "open", "stood"), r"[<>]?\d[\d,.]*"

_END = re.compile(rf"(?<={_LAST})\. (?={_FIRST})")

#: What a placeholder may stand for: anything within one sentence.
_WITHIN = rf"(?:(?!(?<={_LAST})\. {_FIRST}).)+?"

#: A word; what holds an underscore or a digit is a name of the program.
_WORD = re.compile(r"(?<![\w./-])[A-Za-z]{2,}(?!\w|\.\w)")

#: A number of a text, with its groups and decimals; not what is typed, a version or a clause of a code.
_FIGURE = (
    r"(?<![\w./=:])(?<!\d,)(?<!-\d, )"
    r"(?:[1-9]\d{0,2}(?:,\d{3})+(?:\.\d+)?|\d+\.\d+)(?:e[+-]?\d+)?(?![\w]|[.,]\d)"
)

#: Letters of a sentence between its placeholders below which it fits almost anything: it counts where all of that is known.
_FEW = 12


class Translations(Table):
    """A file of translations: the tag of its language (BCP 47), marks of decimals and between groups of three digits, and
    English sentences with their translations."""

    language: str
    decimal: str = "."
    groups: str = ","
    sentences: dict[str, str]


class Language:
    """A table of sentences, and what of a report was not in it.

    Parameters
    ----------
    tag : str
        Of the language (BCP 47).
    table : mapping
        English sentences to translations, both with the same named placeholders; empty for English.
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
    """

    def __init__(
        self,
        tag: str = "en",
        table: Mapping[str, str] | None = None,
        own: Iterable[str] = (),
        decimal: str = ".",
        groups: str = ",",
    ) -> None:
        self.tag, self.table, self.own = tag, dict(table or {}), set(own)
        self.english: dict[str, None] = {}
        self._open = False
        patterns = sorted((one for one in self.table if HOLE.search(one)), key=_before, reverse=True)
        self._patterns = [(_pattern(one), self.table[one], _literal(one) < _FEW) for one in patterns]
        self.foreign = tag != "en"
        every = sentences_of(LANGUAGES[0]) if self.foreign else {}
        words = {word.lower() for one in every for word in _WORD.findall(HOLE.sub(" ", one))}
        self._words = words - {
            word.lower() for one in self.table.values() for word in _WORD.findall(HOLE.sub(" ", one))
        }
        self._said: Callable[[str], str] = cache(self._say)
        names = [re.escape(one) for one in sorted(self.own, key=len, reverse=True) if re.search(r"\d[.,]\d", one)]
        self._figures, self._marks = (
            re.compile("|".join([*names, f"(?P<figure>{_FIGURE})"])),
            {".": decimal, ",": groups},
        )

    def say(self, text: str) -> str:
        """A text in this language as far as it is known, sentence by sentence, with its numbers as readers write them."""
        return text if not self.foreign or text in self.own else self.figures(self._said(text))

    def figures(self, text: str) -> str:
        """A text with its numbers as readers of this language write them."""

        def written(found: re.Match[str]) -> str:
            return "".join(self._marks.get(one, one) for one in found[0]) if found["figure"] else found[0]

        return self._figures.sub(written, text)

    def _say(self, text: str) -> str:
        if text in self.own or not _WORD.search(text):
            return text
        if text not in self.table and self._may_be_list(text) and (found := self._listed(text, (", ",))) != text:
            return found  # an entry could hold all of a list in one of its placeholders
        if (found := self._whole(text)) is not None:
            return found
        parts = _END.split(text)
        ends = [f"{one}." for one in parts[:-1]] + parts[-1:]
        said, k = [], 0
        while k < len(ends):
            for last in range(len(ends), k, -1):
                found = self._whole(" ".join(ends[k:last])) if last - k < len(ends) else None
                if found is not None or last == k + 1:
                    said.append(self._listed(ends[k]) if found is None else found)
                    k = last
                    break
        return " ".join(said)

    def _may_be_list(self, text: str) -> bool:
        """Whether commas may part the entries of a list: not those in brackets and in names."""
        return "(" not in text and not any(", " in name and name in text for name in self.own)

    def _listed(self, text: str, separators: Sequence[str] = ("; ", ", ")) -> str:
        """A list of which every entry is known, in this language; any other text as it is."""
        for between in separators:
            parts = text.split(between)
            said = [part if not _WORD.search(part) else self._whole(part) for part in parts]
            if len(parts) > 1 and all(one is not None and not self.is_english(one, 1) for one in said):
                return between.join(filter(None, said))
        return text

    def _whole(self, text: str) -> str | None:
        """A text that an entry covers from end to end; None where none does."""
        if text in self.table:
            return self.table[text]
        partly = None
        for pattern, into, few in self._patterns:
            if found := pattern.fullmatch(text):
                held = {name: self._said(value) for name, value in found.groupdict().items()}
                said = into.format(**held)
                if "text" in held or not any(self.is_english(one, 1) for one in held.values()):
                    return said
                partly = partly or (None if few else said)
        return partly

    def is_english(self, text: str, least: int = 2) -> bool:
        """Whether a text of a page in this language still holds so many English words of the table, quotations left out."""
        if not self.foreign or text in self.own or isinstance(text, Own):
            return False
        plain = re.sub(r"“[^”]*”|‘[^’]*’|`[^`]*`", " ", text)
        for name in self.own:
            if len(name) > 3 and name in plain:
                plain = plain.replace(name, " ")
        return sum(word.lower() in self._words for word in _WORD.findall(plain)) >= least

    def _told(self, text: str, least: int = 2) -> str:
        if isinstance(text, Own):
            return text
        lines = [self.say(line) for line in text.split("\n")]
        self._open |= any(self.is_english(line, least) for line in lines)
        return "\n".join(lines)

    def section(self, section: Section) -> Section:
        """A section in this language; that a part of it stayed English is kept in mind."""
        self._open = False
        title = self._told(section.title, 1)
        items = [self.item(one) for one in section.items]
        if self._open:
            self.english.setdefault(title)
        return Section(title, items)

    def item(self, item: Item) -> Item:
        """An item in this language."""
        if isinstance(item, (str, Code)):
            return item if isinstance(item, Code) else self._told(item, 1)
        if isinstance(item, (Points, Note)):
            return replace(item, texts=[self._told(text, 1) for text in item.texts])
        if isinstance(item, Picture):
            self._open |= self.foreign and item.english
            return replace(item, caption=self._told(item.caption, 1))
        if isinstance(item, Facts):
            pairs = [(self._told(name, 1), self._told(value)) for name, value in item.pairs]
            return replace(item, pairs=pairs, caption=self._told(item.caption, 1))
        header = [self._told(name, 1) for name in item.header]
        body = [[self._told(cell) for cell in row] for row in item.body]
        looks = {self.say(text): look for text, look in item.looks.items()}
        return replace(item, header=header, body=body, caption=self._told(item.caption, 1), looks=looks)


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
    """A language by its tag, or by a file of translations.

    Raises
    ------
    InputError
        There is neither, or the file is no table of sentences with their placeholders.
    """
    if name == "en":
        return Language()
    if name in LANGUAGES:
        return _spoken(file_of(name), own)
    if not name.endswith(".toml"):
        known = ", ".join(f'"{one}"' for one in ("en", *LANGUAGES))
        raise InputError(
            f"language is {name!r}; it is one of {known}, or a file of translations such as de.toml, of which "
            "'stylobate report' writes a template.",
            "language",
        )
    found, known = read_table(name, Translations), sentences_of(LANGUAGES[0])
    for english, said in found.sentences.items():
        if english not in known:
            raise InputError(
                f"{shown(name)}: {english!r} is no sentence of a report of this version; write the template again and "
                "compare."
            )
        if said.strip() and sorted(HOLE.findall(said)) != sorted(HOLE.findall(english)):
            raise InputError(
                f"{shown(name)}: the translation of {english!r} must hold {', '.join(HOLE.findall(english)) or 'no'} "
                "in braces, as the sentence does."
            )
    return _spoken(found, own)


def _spoken(file: Translations, own: Iterable[str]) -> Language:
    table = {one: said for one, said in file.sentences.items() if said.strip()}
    return Language(file.language, table, own, file.decimal, file.groups)


@cache
def file_of(tag: str) -> Translations:
    """The file of a language that comes with the package."""
    return read_table(Path(str(files("stylobate_report") / "languages" / f"{tag}.toml")), Translations)


def sentences_of(tag: str) -> dict[str, str]:
    """Its table."""
    return file_of(tag).sentences


def write_template(path: Path) -> Path:
    """Write a file of all sentences of a report with empty translations."""
    import tomli_w

    text = tomli_w.dumps(
        {"language": "", "decimal": ".", "groups": ",", "sentences": dict.fromkeys(sentences_of(LANGUAGES[0]), "")}
    )
    head = (
        "# Sentences of a report. Give the tag of the language, such as de, the marks before decimals and between groups\n"
        "# of three digits, and write each translation behind its sentence, with the same names in braces. What stays\n"
        "# empty stays English in the report, which says so.\n"
    )
    with replacing(path) as partial:
        partial.write_text(head + text, encoding="utf-8")
    return path


def _literal(sentence: str) -> int:
    """Letters of a sentence between its placeholders."""
    return sum(map(str.isalpha, HOLE.sub("", sentence)))


def _before(sentence: str) -> tuple[bool, int, int]:
    """Place of a sentence among those that a text is compared with: what only stands before a text comes first."""
    return sentence.endswith(": {text}"), _literal(sentence), len(HOLE.sub("", sentence))


def _pattern(sentence: str) -> re.Pattern[str]:
    """What a sentence matches; a placeholder that stands twice is the same text both times."""
    seen: set[str] = set()
    parts = HOLE.split(sentence)
    text = ""
    for k, part in enumerate(parts):
        if not k % 2:
            text += re.escape(part)
        elif part in seen:
            text += f"(?P={part})"
        else:
            seen.add(part)
            text += f"(?P<{part}>{_NUMBER if part in NUMBERS else _WITHIN})"
    return re.compile(text)
