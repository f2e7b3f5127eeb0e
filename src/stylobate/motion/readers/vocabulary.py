"""The words that name columns of numbers, in the languages that are known here, and what each of them may mean."""

from __future__ import annotations

import re
import unicodedata
from functools import cache

from ...errors import InputError
from ..specs import TIME_UNITS, VELOCITY_UNITS, acceleration_unit

#: Meanings of words, by the codes of their languages: a time, a quantity, or a direction by the label that readers of
#: networks give it.
_WORDS = {
    "en": {
        "time": "time",
        "acceleration": "acceleration accelerations accel acc",
        "velocity": "velocity velocities vel",
        "displacement": "displacement displacements displ disp dis",
        "NORTH": "north", "SOUTH": "south", "EAST": "east", "WEST": "west",
        "VERTICAL": "vertical vert ver vrt", "UP": "up upward upwards", "DOWN": "down downward downwards dn",
        "LONG": "longitudinal long", "TRAN": "transverse transversal tran trans lateral tangential",
        "R": "radial", "H": "horizontal horiz hor",
    },
    "de": {
        "time": "zeit",
        "acceleration": "beschleunigung beschl",
        "velocity": "geschwindigkeit geschw",
        "displacement": "verschiebung auslenkung weg",
        "NORTH": "nord norden", "SOUTH": "süd süden sued sueden", "EAST": "ost osten", "WEST": "west westen",
        "VERTICAL": "vertikal vertikale lotrecht", "UP": "oben aufwärts aufwaerts", "DOWN": "unten abwärts abwaerts",
        "LONG": "längs laengs längsrichtung longitudinal", "TRAN": "quer querrichtung transversal",
        "R": "radial", "H": "horizontal",
    },
    "fr": {
        "time": "temps",
        "acceleration": "accélération accélérations",
        "velocity": "vitesse",
        "displacement": "déplacement",
        "NORTH": "nord", "SOUTH": "sud", "EAST": "est", "WEST": "ouest",
        "VERTICAL": "vertical verticale", "UP": "haut", "DOWN": "bas",
        "LONG": "longitudinal longitudinale", "TRAN": "transversal transversale",
        "R": "radial radiale", "H": "horizontal horizontale",
    },
    "it": {
        "time": "tempo",
        "acceleration": "accelerazione accelerazioni",
        "velocity": "velocità",
        "displacement": "spostamento",
        "NORTH": "nord", "SOUTH": "sud", "EAST": "est", "WEST": "ovest",
        "VERTICAL": "verticale", "UP": "alto", "DOWN": "basso",
        "LONG": "longitudinale", "TRAN": "trasversale", "R": "radiale", "H": "orizzontale",
    },
    "el": {
        "time": "χρόνος",
        "acceleration": "επιτάχυνση",
        "velocity": "ταχύτητα",
        "displacement": "μετατόπιση μετακίνηση",
        "NORTH": "βορράς βορρά", "SOUTH": "νότος νότου", "EAST": "ανατολή", "WEST": "δύση",
        "VERTICAL": "κατακόρυφη κατακόρυφος κατακόρυφο", "UP": "πάνω άνω", "DOWN": "κάτω",
        "LONG": "διαμήκης", "TRAN": "εγκάρσια εγκάρσιος", "H": "οριζόντια",
    },
    "es": {
        "time": "tiempo",
        "acceleration": "aceleración acel",
        "velocity": "velocidad",
        "displacement": "desplazamiento",
        "NORTH": "norte", "SOUTH": "sur", "EAST": "este", "WEST": "oeste",
        "VERTICAL": "vertical", "UP": "arriba", "DOWN": "abajo",
        "LONG": "longitudinal", "TRAN": "transversal", "R": "radial", "H": "horizontal",
    },
    "tr": {
        "time": "zaman",
        "acceleration": "ivme",
        "velocity": "hız",
        "displacement": "yerdeğiştirme değiştirme deplasman",
        "NORTH": "kuzey", "SOUTH": "güney", "EAST": "doğu", "WEST": "batı",
        "VERTICAL": "düşey dikey", "UP": "yukarı", "DOWN": "aşağı",
        "LONG": "boyuna", "TRAN": "enine", "H": "yatay",
    },
}  # fmt: skip

#: Signs of every language. A letter with several meanings counts only where one of them alone makes sense of the line.
_SIGNS = {
    "time": "t sec secs seconds",
    "acceleration": "a",
    "velocity": "v",
    "displacement": "d u w",
    "N": "n β", "S": "s ν", "E": "e α", "W": "w δ", "NS": "ns", "SN": "sn", "EW": "ew", "WE": "we",
    "UD": "ud updown", "U": "u", "V": "v", "Z": "z", "D": "d",
    "L": "l", "T": "t", "R": "r", "X": "x", "Y": "y", "H": "h", "H1": "h1", "H2": "h2",
}  # fmt: skip

#: Letters that are directions only beside a word of their language: O is east in German and west elsewhere.
_LETTERS = {
    "de": {"E": "o"},
    "fr": {"W": "o"},
    "it": {"W": "o"},
    "es": {"W": "o"},
    "tr": {"N": "k", "S": "g", "E": "d", "W": "b"},
}

#: Words that say nothing about which column is which.
_FILLERS = (
    "component components comp direction dir orientation channel stream axis in of the and record data value values ground "
    "motion base corrected uncorrected raw corr dcoffset series history column columns col unit units sequence "
    "datasequence order header fields names komponente richtung spalten composante colonnes componente colonne columnas "
    "bileşen bileşeni yön yönü yer sütunlar συνιστώσα διεύθυνση στήλες"
)

_TIME_SPELLINGS = {
    "secs": "s",
    "seconds": "s",
    "second": "s",
    "sek": "s",
    "sn": "s",
    "msec": "ms",
    "milliseconds": "ms",
}
_LENGTHS = ("m", "cm", "mm", "in", "inch", "ft")
#: Quantities that touch their direction, as in ``accZ``.
_PREFIXES = {
    "a": "acceleration", "acc": "acceleration", "accel": "acceleration", "acceleration": "acceleration",
    "v": "velocity", "vel": "velocity", "velocity": "velocity",
    "d": "displacement", "u": "displacement", "dis": "displacement", "disp": "displacement",
}  # fmt: skip
_CODE = re.compile(r"[bhec][nlg][nez12]")
_AZIMUTH = re.compile(r"[ns]\d{1,3}(?:°|deg)?[ew]|\d{3}(?:°|deg)?|\d{1,2}(?:°|deg)")

#: Meaning of a word: its kind (``time``, ``quantity``, ``direction``, ``unit``, ``filler``) and which one.
Meaning = tuple[str, str]


def folded(text: str) -> str:
    """A word in small letters without accents; a dot on a short symbol (a derivative in time) stays."""
    bare = "".join(one for one in unicodedata.normalize("NFKD", text.casefold()) if not unicodedata.combining(one))
    plain = unicodedata.normalize("NFKC", text).casefold()
    return plain if len(bare) < 3 and len(unicodedata.normalize("NFKD", plain)) > len(bare) else bare.replace("ı", "i")


def _kind(meaning: str) -> Meaning:
    if meaning == "time":
        return "time", meaning
    return ("quantity" if meaning.islower() else "direction"), meaning


@cache
def _table() -> dict[str, tuple[dict[Meaning, None], set[str]]]:
    """Meanings of every folded word, and its languages."""
    table: dict[str, tuple[dict[Meaning, None], set[str]]] = {}
    for language, meanings in (*_WORDS.items(), ("", _SIGNS), ("", {"": _FILLERS})):
        for meaning, words in meanings.items():
            for word in words.split():
                entry = table.setdefault(folded(word), ({}, set()))
                entry[0][_kind(meaning) if meaning else ("filler", "")] = None
                entry[1].update([language] * (language != ""))
    return table


def languages(word: str) -> set[str]:
    """Languages of a word; none of a sign."""
    return _table()[folded(word)][1] if folded(word) in _table() else set()


def meanings(word: str, spoken: set[str]) -> list[tuple[Meaning, ...]]:
    """Meanings of a word without separators, each time one or more together; empty where it is unknown.

    Parameters
    ----------
    word : str
        As written.
    spoken : set of str
        Languages of the whole line.
    """
    key = folded(word)
    found: list[tuple[Meaning, ...]] = [(one,) for one in (_table()[key][0] if key in _table() else {})]
    if kind := unit_kind(word):
        found.append((("unit", f"{kind}:{word}"),))
    for language in sorted(spoken):
        found += [((("direction", label)),) for label, letter in _LETTERS.get(language, {}).items() if letter == key]
    if _CODE.fullmatch(key) or _AZIMUTH.fullmatch(key):
        found.append((("direction", key.upper()),))
    if not found:
        for prefix, quantity in _PREFIXES.items():
            rest = key.removeprefix(prefix)
            capital = word[len(prefix) :].isupper() and word[len(prefix) - 1 : len(prefix)].islower()
            if rest == key or not (rest in ("x", "y", "z") or (len(prefix) > 1 and (capital or len(rest) > 1))):
                continue
            found += [
                (("quantity", quantity), one) for one in _table().get(rest, ({}, set()))[0] if one[0] == "direction"
            ]
    return list(dict.fromkeys(found))


def unit_kind(text: str) -> str:
    """Dimension of a unit: ``acceleration``, ``time``, ``velocity``, ``displacement``, or nothing where it is none."""
    key = time_unit(text)
    if key is not None:
        return "time"
    try:
        acceleration_unit(text)
        return "acceleration"
    except InputError:
        key = text.strip().lower().replace("sec", "s")
        return "velocity" if key in VELOCITY_UNITS else "displacement" if key in _LENGTHS else ""


def time_unit(text: str) -> float | None:
    """Size of a unit of time as headers spell it [s], or None."""
    key = text.strip().lower().rstrip(".")
    return TIME_UNITS.get(_TIME_SPELLINGS.get(key, key))
