"""A line that names columns of numbers: the one reading of its words that fits the numbers, or a refusal of the line."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, cached_property

from ...errors import InputError
from ..specs import ACCELERATION_UNITS
from .names import EXAMPLE, Doubt, Name, Unlikely, checked, with_units
from .vocabulary import Meaning, folded, languages, meanings, unit_kind

#: Marks of a comment, before the words of a line.
MARKS = "#%!;*/'\" \t"
#: Words of one column, with its unit; readings that are tried of one line.
MOST_WORDS, MOST_READINGS = 8, 3_000

_PIECES = re.compile(r"[;|\t,]")
_TOKENS = re.compile(r"[(\[{<]\s*(?P<inside>[^)\]}>]*?)\s*[)\]}>]|(?P<word>[^\s(\[{<]+)")
_PER_SECOND = re.compile(r"\b(?P<length>mm|cm|m|in|ft)[ ·.*]?s(?:ec)?\s*\^?\s*[({]?[-−⁻](?:2|²)[)}]?", re.IGNORECASE)
_SERIES = re.compile(r"\btime[ -](?:series|history|histories)\b", re.IGNORECASE)
#: Letters that stand for volts, amperes … in brackets, and are no direction there.
_NOT_IN_BRACKETS = frozenset("vutdalrhwb")
_PAIRS = {
    ("N", "S"): "NS",
    ("S", "N"): "SN",
    ("E", "W"): "EW",
    ("W", "E"): "WE",
    ("UP", "DOWN"): "UD",
    ("U", "D"): "UD",
}
_POINTS = ("NORTH", "SOUTH", "EAST", "WEST")
_UP = ("Z", "V", "U", "UP", "UD", "VERTICAL")
#: Warnings that a column gets at most once.
_ONCE = ("time", "quantity", "sign", "unit")


@dataclass(frozen=True)
class Header:
    """A line above the numbers, as names of columns.

    Parameters
    ----------
    line : str
        As written.
    """

    line: str

    @property
    def _key(self) -> tuple[str, str]:
        """Text before a colon, and the rest."""
        key, _, rest = self.line.strip().lstrip(MARKS).strip().replace("=", ":").rpartition(":")
        return key.strip(), rest.strip()

    @property
    def _keyed(self) -> bool:
        """Whether a word before a colon says that names follow."""
        return is_filler(self._key[0]) and self._key[0] != ""

    @cached_property
    def words(self) -> list[tuple[str, bool, bool]]:
        """Words, whether a separator stands before each, and whether it stands in brackets."""
        key, text = self._key
        text = f"{key} ; {text}" if key and not self._keyed else text
        text = f"{text}°" if self._keyed and re.fullmatch(r"\d{1,2}", text) and "chan" not in key.lower() else text
        text = _SERIES.sub("series", _PER_SECOND.sub(r"\g<length>/s2", text.replace("²", "2")))
        words: list[tuple[str, bool, bool]] = []
        for piece in _PIECES.split(text):
            first = True
            for one in _TOKENS.finditer(piece):
                inside = one["inside"]
                word = (inside if inside is not None else one["word"]).strip("\"'")
                if not word.strip("/.:=-_") and (inside is None or word not in ("+", "-")):
                    continue
                for part in [word] if unit_kind(word) else word.split():
                    words.append((part, first, inside is not None))
                    first = False
        return words

    @cached_property
    def _meanings(self) -> list[list[tuple[Meaning, ...]]]:
        """Meanings of each word."""
        parts = [part for word, *_ in self.words for part in re.split(r"[_\-–/.:+]", word)]
        spoken = set().union(*(languages(part) for part in parts if len(part) > 2)) - {"en"}
        return [_meanings_of(word, spoken, inside) for word, _, inside in self.words]

    @cached_property
    def unknown(self) -> str | None:
        """The first word that is not known, or None."""
        return next((word for (word, *_), meaning in zip(self.words, self._meanings) if not meaning), None)

    @property
    def seems_to_name(self) -> bool:
        """Whether most of its words are known, and one is a time, a quantity or a direction."""
        kinds = {one[0] for meaning in self._meanings for some in meaning for one in some}
        return 2 * sum(map(bool, self._meanings)) >= len(self.words) and bool(kinds & {"time", "quantity", "direction"})

    @property
    def speaks_of_all(self) -> Name | None:
        """The acceleration, with its unit, of which all columns are, where the line names no direction and no time."""
        found = [reading[0] for reading in self.readings(1)] if self.unknown is None else []
        return found[0] if [(one.kind, one.direction) for one in found] == [("acceleration", "")] else None

    @property
    def units(self) -> list[str] | None:
        """The units, where the line holds nothing else."""
        found = [[some[0][1] for some in many if some[0][0] == "unit"] for many in self._meanings]
        return [one[0].partition(":")[2] for one in found] if found and all(found) else None

    def readings(self, fields: int) -> list[tuple[Name, ...]]:
        """All ways to read the words as that many names of columns; none where they are too many to be told apart."""
        words, found, tried = self._meanings, {}, 0

        @cache
        def named(start: int, end: int) -> list[Name]:
            return _names(words[start:end])

        def below(start: int, left: int) -> Iterator[tuple[Name, ...]]:
            nonlocal tried
            if left == 0 and start == len(words):
                yield ()
            if not left <= len(words) - start <= MOST_WORDS * left:
                return
            for end in range(start + 1, min(len(words), start + MOST_WORDS) + 1):
                # A column does not begin within brackets; beyond a separator only a unit goes on with it.
                if end < len(words) and self.words[end][2]:
                    continue
                if any(self.words[i][1] and not _only_units(words[i]) for i in range(start + 1, end)):
                    return
                for name in named(start, end):
                    tried += 1
                    if tried > MOST_READINGS:
                        return
                    for rest in below(end, left - 1):
                        yield (name, *rest)

        for reading in below(0, fields):
            found[reading] = None
        return list(found) if tried <= MOST_READINGS else []

    def names(self, grows: Sequence[bool], steady: bool, units: Sequence[str] | None, place: str) -> tuple[Name, ...]:
        """The one reading of the line that fits the numbers.

        Parameters
        ----------
        grows : sequence of bool
            Of each column, whether its numbers grow.
        steady : bool
            The first column grows in equal steps, as only times do.
        units : sequence of str, optional
            Of each column, where the line below this one states them.
        place : str
            File and line, for messages.

        Raises
        ------
        InputError
            A word is not known, a quantity is not an acceleration, or no reading or several fit.
        """
        shown = f"{place}: {self.line.strip()!r}"
        if self.unknown is not None:
            raise InputError(
                f"{shown} holds {self.unknown!r}, which is neither the name of a column nor a unit that is known here (of "
                f"acceleration, allowed are {', '.join(ACCELERATION_UNITS)}); {EXAMPLE}, or take the line out."
            )
        columns, doubts = len(grows), []
        fitting: dict[tuple[Name, ...], None] = {}
        readings = self.readings(columns)
        whole = set(readings)
        if columns > 1 and grows[0]:
            shorter = [one for one in self.readings(columns - 1) if all(name.kind != "time" for name in one)]
            readings += [(Name("time"), *one) for one in shorter]
        for reading in readings:
            try:
                if steady and all(one.kind != "time" for one in reading):
                    raise Doubt("names no time, and yet the first column grows in equal steps; name that column time_s")
                fitting[checked(reading if units is None else with_units(reading, units), self._keyed)] = None
            except Doubt as doubt:
                doubts.append(doubt)
        found = list(fitting)
        if len(found) > 1:  # a name for every column goes before a time that is not named
            found = [one for one in found if one in whole] or found
            times = [[one.kind == "time" for one in reading] for reading in found]
            found = [one for one, timed in zip(found, times) if timed == list(grows)] or found
        if len(found) == 1:
            return found[0]
        if found:
            raise InputError(f"{shown} can be read in more than one way; {EXAMPLE}.")
        if doubts:
            raise InputError(f"{shown} {min(doubts, key=lambda doubt: isinstance(doubt, Unlikely))}.")
        ways = [one for fields in range(1, min(len(self.words), MOST_WORDS) + 1) for one in self.readings(fields)]
        found = min(ways, key=lambda way: sum(name.kind not in ("time", "acceleration") for name in way), default=())
        labels = ", ".join(one.direction or one.kind for one in found) or "in no order that makes sense"
        count = len(found) or len(self.words)
        if columns == 2 * count:
            raise InputError(
                f"{shown} names {count} columns, the rows hold {columns} numbers; if a comma is the sign of decimals, "
                "separate the columns by semicolons."
            )
        raise InputError(
            f"{shown} names {count} columns ({labels}), the rows hold {columns} numbers ({columns} numbers under {count} "
            f"column names); {EXAMPLE}."
        )


def is_filler(text: str) -> bool:
    """Whether a text is words that say nothing about which column is which, as before a colon."""
    return all((("filler", ""),) in meanings(word, set()) for word in text.split())


def _only_units(found: list[tuple[Meaning, ...]]) -> bool:
    return any(some[0][0] == "unit" for some in found)


def _names(words: Sequence[list[tuple[Meaning, ...]]]) -> list[Name]:
    """All columns that some words may name together."""
    ways: list[tuple[Meaning, ...]] = [()]
    for word in words:
        ways = [(*way, *some) for way in ways for some in word]
        ways = [way for way in ways if max(Counter(kind for kind, _ in way if kind in _ONCE).values(), default=0) < 2]
    return list(dict.fromkeys(name for way in ways if (name := _name(way)) is not None))


def _name(atoms: tuple[Meaning, ...]) -> Name | None:
    """The column that some meanings name together, or None where they do not go together."""

    def of(kind: str) -> list[str]:
        return [value for one, value in atoms if one == kind]

    units, signs, quantities = of("unit"), of("sign"), of("quantity")
    measured, _, unit = units[0].partition(":") if units else ("", "", None)
    label = _together(of("direction"))
    if label is None or not (of("time") or quantities or label):
        return None
    sign = -1.0 if signs == ["-"] else 1.0
    if of("time"):
        wrong = quantities or label or signs or measured not in ("", "time")
        return None if wrong else Name("time", unit=unit)
    kind = quantities[0] if quantities else "acceleration"
    if measured == "time" or (quantities and kind == "acceleration" and measured not in ("", "acceleration")):
        return None
    if not quantities and measured:
        kind = measured
    return Name(kind, label, sign, unit)


def _pair(labels: Sequence[str]) -> str | None:
    """Two opposite directions as one: north and south."""
    short = tuple(label[0] if label in _POINTS else label for label in labels)
    return next((pair for ends, pair in _PAIRS.items() if ends == short), None)


def _together(labels: list[str]) -> str | None:
    """One direction out of the words of one column; None where they contradict one another."""
    if len(labels) < 2:
        return None if labels and labels[0] in ("1", "2") else "".join(labels)
    first, *others = labels
    if pair := _pair(labels):
        return pair
    rest = _together(others)
    if rest is None:
        return {"1": "H1", "2": "H2"}.get(others[0]) if first == "H" and len(labels) == 2 else None
    if first in ("V", "Z", "VERTICAL"):
        return rest if rest in (*_UP, "DOWN") else None
    return rest if first == "H" and rest not in (*_UP, "DOWN", "H") else None


def _meanings_of(word: str, spoken: set[str], inside: bool) -> list[tuple[Meaning, ...]]:
    """Meanings of a word; of its parts too, where signs or strokes join them."""
    if inside and word == "t":
        return [(("filler", ""),)]  # a(t)
    if inside and len(folded(word)) == 1 and folded(word) in _NOT_IN_BRACKETS:
        return []
    if word in ("+", "-"):
        return [(("sign", word),)]
    if inside and (kind := unit_kind(word)):
        return [(("unit", f"{kind}:{word}"),)]
    if word in ("1", "2"):
        return [(("direction", word),)]
    if found := meanings(word, spoken):
        return found
    text = word.strip(".:=/")
    if text != word and (found := meanings(text, spoken)):
        return found
    if text[:1] in "+-" or text[-1:] in "+-":
        rest = text.strip("+-")
        signs = text.replace(rest, "", 1) if rest else ""
        return [(*some, ("sign", signs)) for some in _meanings_of(rest, spoken, inside)] if len(signs) == 1 else []
    for mark in re.finditer(r"[_/.]", text):  # a unit behind the name: ax_m_s2, t/s
        head, tail = text[: mark.start()], text[mark.end() :]
        kind = unit_kind(tail)
        if head and kind and (before := _meanings_of(head, spoken, inside)):
            return [(*some, ("unit", f"{kind}:{tail}")) for some in before]
    parts = [part for part in re.split(r"[_\-–/.]", text) if part]
    if len(parts) < 2:
        numbered = re.fullmatch(r"(?P<word>[^\W\d]{3,})(?P<number>[12])", text)
        parts = [numbered["word"], numbered["number"]] if numbered else []
    ways: list[tuple[Meaning, ...]] = [()] if parts else []
    for part in parts:
        ways = [(*way, *some) for way in ways for some in _meanings_of(part, spoken, inside)]
    pairs = [way for way in ways if _pair([value for _, value in way])]
    return pairs or ways
