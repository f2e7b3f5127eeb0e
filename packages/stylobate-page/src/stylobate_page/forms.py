"""Forms of analyses, all drawn and answered alike; and what the page calls its fields, in messages too."""

from __future__ import annotations

import math
import threading
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from stylobate.constants import g
from stylobate.errors import InputError, reworded
from stylobate.response.measures import MEASURES as DECLARED


@dataclass(frozen=True)
class Box:
    """A field of a form.

    Parameters
    ----------
    option : str
        Of the command line, which it gives.
    label : str
    start : str
        What it holds at first.
    unit : str
        Follows what is typed.
    choices : tuple of str
        One of these instead of what is typed; several of them where ``many``, separated by commas.
    hint : str
        What stands in it while it is empty.
    """

    option: str
    label: str
    start: str = ""
    unit: str = ""
    choices: tuple[str, ...] = ()
    many: bool = False
    hint: str = ""


@dataclass(frozen=True)
class Form:
    """An analysis.

    Parameters
    ----------
    command : str
        Of the command line, which does it.
    title, lead : str
        In the list of analyses, and under it.
    takes : tuple of str
        Of what is on the page: ``column`` (or assembly), ``model``, ``tail``, ``motion`` as it is or ``round`` the compass,
        ``motions`` in an order, ``source`` (a fragility, or a table of runs), ``hazard`` or ``hazards``, ``ruin`` (a file).
    boxes : tuple of Box
    fixed : dict
        Options that are always given, with their values.
    facts, columns : dict
        Labels of what its JSON object tells, and of the columns of its table, by their keys; points lead into an object.
    rows : str
        Key of the list, or of the object by names, of which that table has the rows.
    names : dict
        Labels of the rows of such an object.
    pictures : dict
        Captions by the names of its pictures.
    """

    command: str
    title: str
    lead: str
    takes: tuple[str, ...]
    boxes: tuple[Box, ...] = ()
    fixed: dict[str, bool] = field(default_factory=dict)
    facts: dict[str, str] = field(default_factory=dict)
    rows: str = ""
    columns: dict[str, str] = field(default_factory=dict)
    names: dict[str, str] = field(default_factory=dict)
    pictures: dict[str, str] = field(default_factory=dict)


MODELS = ("dem2d", "dem3d", "rigid-block", "rigid-beam", "housner")
STATES = ("collapse", "top:0.15d", "top:0.35d", "top:1d", "drums:0.005d", "drums:0.01d", "drums:0.02d")
UNITS = ("", "g", "m/s2", "cm/s2", "mm/s2", "mg", "in/s2", "ft/s2")

REPLICATES = Box("replicates", "Others like this one")
STATE = Box("state", "Limit state", "collapse", choices=STATES)
IM = Box("im", "Intensity", hint="that of the runs")

#: Measures of runs that are compared, by their keys.
MEASURES = {
    "outcome": "outcome",
    "decided": "decided",
    "collapse_time_s": "falls at [s]",
    "collapse_probability": "probability of collapse",
    **{measure.key: f"{measure.label} [{measure.unit}]" for measure in DECLARED if measure.label},
}

FORMS = {
    "directions": Form(
        "run",
        "From all directions",
        "The motion turned round the compass: from where it does most harm. A column is computed in space unless another "
        "model is chosen.",
        ("column", "model", "tail", "round"),
        (
            Box("azimuths", "Directions [°]", "0:330:12", hint="from:to:number"),
            Box("model", "Model", "dem3d", choices=MODELS),
            REPLICATES,
        ),
        {"pictures": False},
        rows="runs",
        columns={"azimuth_deg": "x towards [°]", **MEASURES},
        pictures={"directions": "By direction"},
    ),
    "compare": Form(
        "compare",
        "Models side by side",
        "What several models say of one motion: where they agree, the model does not decide.",
        ("column", "tail", "motion"),
        (Box("models", "Models", "dem2d,rigid-block,rigid-beam", choices=MODELS, many=True),),
        rows="runs",
        columns={"model": "model", **MEASURES},
        pictures={"comparison": "Histories side by side", "design": "Design values of links"},
    ),
    "sequence": Form(
        "sequence",
        "Earthquakes in sequence",
        "Each earthquake finds what the one before has left. The records ticked come in the order in which they were "
        "ticked; with none, the motion of the page comes again and again.",
        ("column", "model", "motions"),
        (
            Box("repeat", "All of them come, times", "2"),
            Box("rest", "Quiet after each [s]", "30", "s"),
            Box("factors", "A factor for each", hint="such as 1,0.6,0.4"),
            Box("unit", "Unit", choices=UNITS),
            Box("columns", "Columns", hint="such as t [s], x [g], -, z [g]"),
            REPLICATES,
        ),
        facts={"fell_in": "fell in earthquake", "collapse_probability": "probability of collapse"},
        rows="events",
        columns={
            "earthquake": "earthquake",
            "motion": "motion",
            "outcome": "outcome so far",
            "alone.peak_rotation_rad": "peak rotation [rad]",
            "alone.added_slip_m": "slip added [m]",
            "residual_joint_slip_m": "slip so far [m]",
            "alone.at_rest": "came to rest",
        },
        pictures={
            "sequence": "What each earthquake added",
            "ends": "How it stood after each",
            "histories": "Histories",
        },
    ),
    "risk": Form(
        "risk",
        "Risk",
        "How often a year it comes to a state at a site: a fragility and the hazard curve of the site.",
        ("source", "hazard"),
        (STATE, IM),
        facts={
            "annual_rate": "annual rate",
            "annual_rate_low": "at least (95 %)",
            "annual_rate_high": "at most (95 %)",
            "return_period_y": "once in [years]",
        },
        pictures={"risk": "Fragility, hazard, and which shaking the rate comes from"},
    ),
    "survival": Form(
        "survival",
        "Survival",
        "It still stands after so many years: what that says of hazard curves.",
        ("source", "hazards"),
        (Box("age", "Age [years]", "2400", "y"), STATE, IM),
        rows="hazards",
        columns={
            "hazard": "hazard curve",
            "return_period_y": "falls once in [years]",
            "survival_probability": "would still stand",
            "survival_probability_low": "at least (95 %)",
            "survival_probability_high": "at most (95 %)",
            "weight": "weight",
        },
        pictures={"survival": "Which hazard curves its age admits"},
    ),
    "infer": Form(
        "infer",
        "Ruin",
        "What shaking was it? Columns that still stand, have fallen or are out of place are shaken by motions drawn from a "
        "prior; those that leave what is seen tell.",
        ("column", "ruin"),
        rows="posterior",
        columns={
            "median": "median",
            "low": "5 %",
            "high": "95 %",
            "spread_over_prior": "spread over the prior's",
        },
        names={
            "pgv_m_s": "PGV [m/s]",
            "pga_g": "PGA [g]",
            "period_s": "period [s]",
            "azimuth_deg": "azimuth [°]",
        },
        pictures={
            "infer": "Posterior of the shaking; the prior is grey",
            "matches": "The ruin in plan beside draws that are nearest to it",
            "observations": "Which observation tells what",
        },
    ),
    "modes": Form(
        "modes",
        "Natural frequencies",
        "Small vibrations on closed joints: which joint each mode bends, and up to which motion of the top it holds. "
        "Measured frequencies of a column tell how stiff its joints are.",
        ("column", "model"),
        (
            Box("model", "Model", "dem3d", choices=("dem2d", "dem3d")),
            Box("number", "Of each kind", "3"),
            Box("measured", "Measured", hint="such as 1.27Hz±3%,6.5Hz±6%"),
            Box("ground", "On which ground", hint="rigid, or vs=200:400m/s,half_width=4m"),
        ),
        facts={
            "joint_bending_stiffness": "k_b/J_A [N/m³]",
            "joint_shear_stiffness": "k_s [N/m³]",
        },
        rows="modes",
        columns={
            "kind": "",
            "number": "",
            "azimuth_deg": "towards [°]",
            "frequency_hz": "frequency [Hz]",
            "bent_joint": "bends most",
            "holds_to_m": "holds to [m]",
            "holds_to_rad": "holds to [rad]",
            "limited_by": "where",
        },
        pictures={"modes": "Shapes of the lowest modes"},
    ),
}  # fmt: skip


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


def in_page_words(content: Any, of_text: bool = False) -> Any:
    """Sentences for somebody who sees fields, not parameters: errors, texts, also in lists and in values of tables.

    Parameters
    ----------
    content : error, text, list, dict, or anything else, which stays as it is
        Of an error, the number is in the unit of its field, and the key that it is about in words.
    of_text : bool
        It is about the text of a file, in which keys and numbers are written as they are.
    """
    if isinstance(content, InputError):
        sentence = str(content)
        if not of_text:
            for words in zip(*in_units(content), strict=True):
                sentence = sentence.replace(*words)
            key = (content.field or "").rpartition(".")[2]
            sentence = sentence.replace(key, key.replace("_", " ")) if "_" in key else sentence
        return reworded(sentence, label)
    if isinstance(content, Exception):
        return in_page_words(str(content))
    if isinstance(content, str):
        return reworded(content, label)
    if isinstance(content, dict):
        return {key: in_page_words(value) for key, value in content.items()}
    if isinstance(content, (list, tuple)):
        return [in_page_words(value) for value in content]
    return content


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
