"""The page's own words: what its fields are called, and messages about parameters and options in terms of these."""

from __future__ import annotations

import math
import re
import threading
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from stylobate.column import tables
from stylobate.constants import g
from stylobate.errors import reworded

from .forms import FORMS

#: Label of a field of the page, by the option of the command line that it stands for; the scripts of the page take
#: them from here.
LABELS = {
    "harmonic": "Harmonic",
    "across": "a second sine along y",
    "pulse": "Pulse",
    "synthetic": "Simulated",
    "motion": "Record",
    "unit": "Unit",
    "dt": "Step",
    "columns": "Columns",
    "component": "Component as x",
    "azimuth": "Azimuth",
    "pga": "Scale to a peak of",
    "vertical": "vertical component acts",
    "model": "Model",
    "replicates": "Others like this one",
    "tail": "Tail after the motion",
    "from": "From",
    "to": "to",
    "step": "steps of",
    "duration": "Each for",
    "im": "Intensity",
    "runs": "Runs of a record",
    "state": "Limit state",
    "hazard": "Hazard curve",
}

#: The same with the fields of analyses.
ALL_LABELS = {box.option: box.label.partition(" [")[0] for form in FORMS.values() for box in form.boxes} | LABELS

#: Parameters that are not called after the option that gives them.
_OPTIONS = {"files": "motion", "hazards": "hazard"}

#: Keys of a column file of several words, which are so many words on the page.
_TABLES = [var for var in vars(tables).values() if isinstance(var, type) and issubclass(var, tables.Table)]
_KEYS = re.compile(rf"\b(?:{'|'.join({key for table in _TABLES for key in table.model_fields if '_' in key})})\b")

_OPTION = re.compile(r"(?<![\w-])--([a-z](?:[a-z-]*[a-z])?)(?: [A-Z]{2,}(?:\.\w+)?\b)?")
#: Where the command line explains itself.
_HELP = re.compile(r"; see 'stylobate[^']*'")

#: A quantity and what is allowed of it, in units that no field of the page has; those of its fields, in the same.
_QUANTITY = re.compile(
    r"(?<!gravity is )(?<![\d.])(?P<value>-?[\d.]+(?:e[+-]\d+)?) (?P<unit>m/s²|rad); "
    r"allowed is (?P<open>[\[(])(?P<low>\S+), (?P<high>\S+)(?P<close>[\])]) (?P=unit)"
)
_UNITS = {"m/s²": (g, " g"), "rad": (math.pi / 180.0, "°")}

_ASIDE = re.compile(r"\s*\(([^()]*(?<![\w-])--[a-z][^()]*)\)")


def in_page_words(said: Any, of_text: bool = False) -> Any:
    """Sentences for somebody who sees fields, not parameters or options; in lists and in values of tables as well.

    What the page has a field for becomes the field's name; an aside about any other is left out.

    Parameters
    ----------
    said : text, list, dict, or anything else, which stays as it is
    of_text : bool
        It is about the text of a file, in which keys are written as they are.
    """
    if isinstance(said, str):
        said = reworded(said, lambda name: "--" + _OPTIONS.get(name, name).replace("_", "-"))
        if "--" in said:
            said = _OPTION.sub(_named, _ASIDE.sub(_kept, _HELP.sub("", said))).replace("'“", "“").replace("”'", "”")
        if of_text:
            return said
        return _KEYS.sub(lambda key: key[0].replace("_", " "), _QUANTITY.sub(_in_units_of_fields, said))
    if isinstance(said, dict):
        return {key: in_page_words(value, of_text) for key, value in said.items()}
    if isinstance(said, (list, tuple)):
        return [in_page_words(value, of_text) for value in said]
    return said


#: Python keeps one list of filters for all threads: one request at a time listens to its warnings, or they would be those of
#: another one, or nobody's.
_LISTENING = threading.Lock()


@contextmanager
def doubted() -> Iterator[list[warnings.WarningMessage]]:
    """Warnings of this thread, for :func:`warned`."""
    with _LISTENING, warnings.catch_warnings(record=True) as doubts:
        warnings.simplefilter("always")
        yield doubts


def warned(doubts: Sequence[warnings.WarningMessage]) -> list[str]:
    """Warnings for the page, each once."""
    return list(dict.fromkeys(in_page_words(str(doubt.message)) for doubt in doubts))


def _in_units_of_fields(said: re.Match[str]) -> str:
    size, unit = _UNITS[said["unit"]]
    value, low, high = (f"{float(said[key]) / size:.6g}" for key in ("value", "low", "high"))
    return f"{value}{unit}; allowed is {said['open']}{low}, {high}{said['close']}{unit}"


def _kept(aside: re.Match[str]) -> str:
    return aside[0] if all(option in ALL_LABELS for option in _OPTION.findall(aside[1])) else ""


def _named(option: re.Match[str]) -> str:
    return f"“{ALL_LABELS.get(option[1], option[1].replace('-', ' '))}”"
