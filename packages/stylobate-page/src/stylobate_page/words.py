"""The page's own words: what its fields are called, and messages about parameters in terms of these."""

from __future__ import annotations

import math
import threading
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from stylobate.constants import g
from stylobate.errors import InputError, reworded

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

#: Units of fields of the page, and their sizes, by those in which the same quantities are computed.
_UNITS = {"m/s²": (" g", g), "rad": ("°", math.pi / 180.0)}


def label(name: str) -> str:
    """What the page calls a parameter."""
    option = _OPTIONS.get(name, name).replace("_", "-")
    return f"“{ALL_LABELS.get(option, option.replace('-', ' '))}”"


def in_page_words(said: Any, of_text: bool = False) -> Any:
    """Sentences for somebody who sees fields, not parameters: errors, texts, also in lists and in values of tables.

    Parameters
    ----------
    said : error, text, list, dict, or anything else, which stays as it is
        Of an error, the number is in the unit of its field, and the key that it is about in words.
    of_text : bool
        It is about the text of a file, in which keys and numbers are written as they are.
    """
    if isinstance(said, InputError):
        sentence = str(said)
        if not of_text:
            for words in zip(*in_units(said), strict=True):
                sentence = sentence.replace(*words)
            key = (said.field or "").rpartition(".")[2]
            sentence = sentence.replace(key, key.replace("_", " ")) if "_" in key else sentence
        return reworded(sentence, label)
    if isinstance(said, Exception):
        return in_page_words(str(said))
    if isinstance(said, str):
        return reworded(said, label)
    if isinstance(said, dict):
        return {key: in_page_words(value) for key, value in said.items()}
    if isinstance(said, (list, tuple)):
        return [in_page_words(value) for value in said]
    return said


def in_units(error: InputError) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The number and the interval in the message of an error, as they stand there and in the unit of the page's field."""
    if error.quantity is None or error.quantity.unit not in _UNITS or error.field == "gravity":  # that of a column
        return (), ()
    return error.quantity.words(), error.quantity.words(*_UNITS[error.quantity.unit])


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
