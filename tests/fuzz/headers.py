"""Lines that name columns, in seven languages: x, y and z are read in their places and units, or refused."""

from __future__ import annotations

import random
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.motion import Motion, read_motion

from .target import Fault, Target, sentence

#: By language: time, acceleration, velocity, displacement, vertical, up, longitudinal, transverse, north, south, east, west.
WORDS = {
    "English": "time acceleration velocity displacement vertical up longitudinal transverse north south east west",
    "German": "Zeit Beschleunigung Geschwindigkeit Verschiebung vertikal oben längs quer Nord Süd Ost West",
    "French": "temps accélération vitesse déplacement vertical haut longitudinal transversal nord sud est ouest",
    "Italian": "tempo accelerazione velocità spostamento verticale alto longitudinale trasversale nord sud est ovest",
    "Greek": "χρόνος επιτάχυνση ταχύτητα μετατόπιση κατακόρυφη πάνω διαμήκης εγκάρσια βορράς νότος ανατολή δύση",
    "Spanish": "tiempo aceleración velocidad desplazamiento vertical arriba longitudinal transversal norte sur este oeste",
    "Turkish": "zaman ivme hız yerdeğiştirme düşey yukarı boyuna enine kuzey güney doğu batı",
}
MEANINGS = ["time", "acc", "vel", "disp", "V", "UP", "L", "T", "N", "S", "E", "W"]
#: Letters of pairs north-south, east-west where they differ from NS and EW.
PAIRS = {"Turkish": ("K-G", "D-B"), "Greek": ("Β-Ν", "Α-Δ"), "German": ("N-S", "O-W"), "Spanish": ("N-S", "E-O"),
         "Italian": ("N-S", "E-O"), "French": ("N-S", "E-O")}  # fmt: skip
UNITS = {"g": g, "m/s2": 1.0, "m/s^2": 1.0, "m/s²": 1.0, "cm/s2": 0.01, "cm/s/s": 0.01, "gal": 0.01, "Gal": 0.01,
         "mm/s^2": 1e-3, "m_s2": 1.0, "g/10": g / 10}  # fmt: skip
#: Words that no list of columns holds here, in other languages or of other things.
STRANGE = ("idő", "függőleges", "čas", "svisle", "ch1", "no", "index", "Sa", "theta", "pressure", "temperature", "counts",
           "ẋ", "ÿ", "jerk", "Athens", "foo", "x'", "BHZ", "strain", "rot", "aa", "acc4", "%g", "[V]", "время")  # fmt: skip
MARKS = ("", "", "", "# ", "#", "% ", "! ", "// ", "* ", "' ", "## ")
ABOVE = (
    "",
    "",
    "# station: Athens\n",
    "Record of a small earthquake\n",
    "# NPTS= 50\n",
    "title\n\n",
    "% made by hand, 1999\n",
)
BELOW = (
    "",
    "",
    "",
    "",
    "# station: North Bay\n",
    "# date: 1999-08-17\n",
    "# NPTS= 50, DT= 0.01 SEC\n",
    "-----------\n",
    "\n",
)
VERTICAL = ("V", "Z", "U", "UD", "az", "accZ", "up-down", "down", "Z(-)", "Vert.", "U-D", "HNZ")
ROWS = 50


@dataclass
class Column:
    """What a column is in truth: its role (``time``, ``x``, ``y``, ``z``, ``h1``, ``h2``, ``other``), sign and name."""

    role: str
    name: str
    sign: float = 1.0
    unit: str = ""


def horizontals(rng: random.Random, language: str, said: dict[str, str]) -> list[Column]:
    """One or two horizontal columns: by axes, or in the order in which they will stand (``h``)."""
    kind = rng.choice(
        ("axes", "axes", "words", "words", "pairs", "letters", "structure", "numbers", "azimuths", "radial")
    )
    if kind == "axes":
        form = rng.choice(("a{}", "{}", "acc{}", "acc_{}", "a_{}", "acc {}", said["acc"] + " {}", "{} " + said["acc"]))
        case = rng.choice((str.lower, str.upper))
        return [Column(axis, form.format(case(axis))) for axis in "xy"]
    names = {
        "words": [said[rng.choice("NS")], said[rng.choice("EW")]],
        "pairs": list(PAIRS.get(language, ("NS", "EW")) if rng.random() < 0.5 else ("NS", "E-W")),
        "letters": ["N", "E"],
        "structure": rng.choice(([said["L"], said["T"]], ["L", "T"], ["long", "trans"])),
        "numbers": rng.choice((["H1", "H2"], ["h1", "h2"], ["HN1", "HN2"], ["horizontal 1", "horizontal 2"])),
        "azimuths": rng.choice((["N10E", "S80E"], ["360", "090"], ["045", "315"])),
        "radial": ["radial", "transverse"],
    }[kind]
    if rng.random() < 0.2 and kind in ("words", "pairs", "structure"):
        names = [f"{said['acc']} {name}" for name in names]
    return [Column("h", name) for name in names]


def layout(rng: random.Random) -> tuple[list[Column], str, bool]:
    """Columns, the language, and whether they hold what must be refused."""
    language = rng.choice(list(WORDS))
    said = dict(zip(MEANINGS, WORDS[language].split()))
    time = Column("time", rng.choice((said["time"], said["time"], "t", "time", "Time")))
    draw, wrong = rng.random(), False
    if draw < 0.12:
        columns = [Column("h", rng.choice((said["acc"], "acc", "a", "accel.", "acceleration")))]
    else:
        columns = horizontals(rng, language, said)
        if rng.random() < 0.2:
            columns = columns[:1]
        if rng.random() < 0.7:
            name = rng.choice((said["V"], said["UP"], *VERTICAL))
            sign = -1 if name in ("down", "Z(-)") else 1
            columns.append(Column("z", name, sign))
        rng.shuffle(columns)
    if rng.random() < 0.08:  # a quantity that is none here
        wrong = True
        axes = any(one.role in "xy" for one in columns) or columns[0].name in ("acc", "a")
        unclear = ("v", "d", "u") if axes else ("d",)
        name = rng.choice((said["vel"], said["disp"], "vx", "dz", "velocity", "disp.", f"{said['vel']} Z", *unclear))
        columns.insert(rng.randrange(len(columns) + 1), Column("other", name))
    if rng.random() < 0.08:
        wrong = True
        columns.insert(rng.randrange(len(columns) + 1), Column("other", rng.choice(STRANGE)))
    place = 0 if rng.random() < 0.85 else rng.randrange(len(columns) + 1)
    if rng.random() < 0.95:
        columns.insert(place, time)
    return columns, language, wrong


def written(rng: random.Random, columns: list[Column]) -> tuple[str, str, bool]:
    """The text above the numbers, the separator of the numbers, and whether every unit is in it."""
    separator = rng.choice((" ", "  ", "\t", ", ", ",", ";", "; ", " | "))
    style = rng.choice(("none", "none", "(", "[", " (", " [", "_", "/", "row", "comment"))
    unit = rng.choice([one for one in UNITS if style not in ("_", "/") or "/" not in one or one == "g/10"])
    case = rng.choice((str, str, str, str.upper, str.lower, str.title))
    names, units = [], []
    for one in columns:
        one.unit = unit if rng.random() < 0.9 or style == "comment" else rng.choice(list(UNITS))
        if style in ("_", "/") and "/" in one.unit:
            one.unit = unit
        shown = rng.choice(("s", "s", "sec", "ms")) if one.role == "time" else one.unit
        if one.role == "other":
            shown = rng.choice(("m/s", "cm/s", "cm", "m"))
        if one.role == "time":
            one.unit = "s" if style in ("none", "comment") else shown
        name = case(one.name) if not (one.role == "other" or any(mark in one.name for mark in "ẋÿ")) else one.name
        if style in ("(", "["):
            name += f"{style}{shown}{')' if style == '(' else ']'}"
        elif style in (" (", " ["):
            name += f"{style}{shown}{')' if style == ' (' else ']'}"
        elif style in ("_", "/"):
            name += f"{style}{shown}"
        names.append(f'"{name}"' if rng.random() < 0.02 else name)
        units.append(shown)
    mark = rng.choice(MARKS)
    lines = [mark + separator.join(names)]
    if style == "row":
        lines.append(mark + separator.join(units))
    if style == "comment":
        lines.insert(0, f"# unit: {unit}")
    text = rng.choice(ABOVE) + "\n".join(lines) + "\n" + rng.choice(BELOW)
    numbers = rng.choice((separator.replace("|", " "), " "))
    return text, numbers, style != "none"


def truth(columns: list[Column], table: np.ndarray, unit: str | None) -> dict[str, np.ndarray]:
    """Accelerations by axis, as the rules of the documentation have it [m/s²]."""
    found = {}
    flat = iter("xy")
    for one, values in zip(columns, table.T):
        if one.role in ("time", "other"):
            continue
        axis = next(flat) if one.role == "h" else one.role
        found[axis] = values * one.sign * UNITS[unit or one.unit]
    return found


def one(rng: random.Random, folder: Path) -> str:
    """One layout."""
    columns, language, wrong = layout(rng)
    text, separator, stated = written(rng, columns)
    unit = None if stated else rng.choice(("g", "gal", "m/s2"))
    waves = np.round(np.array([[rng.gauss(0.0, 0.3) for _ in columns] for _ in range(ROWS)]), 4)
    step = next((0.01 if one.unit != "ms" else 10.0 for one in columns if one.role == "time"), None)
    for k, column in enumerate(columns):
        if column.role == "time":
            waves[:, k] = np.round(np.arange(ROWS) * step, 4)
    comma = rng.random() < 0.1 and "," not in separator
    rows = [separator.join(f"{value:.4f}" for value in row) for row in waves]
    rows = [row.replace(".", ",") for row in rows] if comma else rows
    path = folder / "record.txt"
    path.write_text(text + "\n".join(rows) + "\n", encoding="utf-8")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            motion = read_motion(path, unit, None if step is not None else 0.01)
    except InputError as error:
        sentence(error)
        return f"{language}: refused{', as it must be' if wrong else ''}"
    if wrong:
        raise Fault(f"{text!r} names what is no acceleration, and was read: {motion.metadata['labels']}")
    compare(motion, truth(columns, waves, unit), text)
    return f"{language}: right"


def compare(motion: Motion, wanted: dict[str, np.ndarray], text: str) -> None:
    """Raise a fault where an axis holds other numbers than those of its column."""
    if not np.isclose(motion.dt, 0.01, rtol=1e-9):
        raise Fault(f"{text!r}: the step is {motion.dt}")
    if set(motion.components) != set(wanted):
        raise Fault(f"{text!r} was read as {sorted(motion.components)}, it names {sorted(wanted)}")
    for axis, values in wanted.items():
        if not np.allclose(motion.components[axis], values, rtol=1e-9, atol=1e-12):
            raise Fault(
                f"{text!r}: {axis} holds the numbers of another column, sign or unit: {motion.metadata['labels']}"
            )


TARGET = Target("headers", 5_000, 150, one)
