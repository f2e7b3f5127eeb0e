"""Layouts of columns of text: read as stated, or refused with a proposal that reads when it is typed."""

from __future__ import annotations

import random
import re
from pathlib import Path

import numpy as np

from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.motion import Motion, read_motion

from .target import Fault, Target, sentence

UNITS = {"g": g, "m/s2": 1.0, "cm/s2": 0.01, "gal": 0.01, "mm/s^2": 1e-3, "g/10": g / 10}
#: Words by what a column holds, as people write them.
WORDS = {
    "t": ("time", "t", "Time [s]", "Zeit", "χρόνος", "T(sec)"),
    "x": ("acc", "NS", "HNE", "x", "Ivme", "ch1", "EW (gal)"),
    "y": ("EW", "HNN", "y", "acc2", "090", "est"),
    "z": ("UD", "up", "Z", "HNZ", "vertical", "κατακόρυφη"),
    "-": ("velocity", "disp (cm)", "v", "T°", "index", "vel_x"),
}
ABOVE = ("", "# station: Athens\n", "Record of a small earthquake\n", "sep=;\n", "% made by hand, 1999\n\n")
END = ("", "", "*** End Data ***\n", "END\n", "\n\n")
ROWS = 40


def attempt(rng: random.Random, folder: Path) -> str:
    """One layout."""
    axes = ["x", *rng.sample(("y", "z", "-", "-"), rng.randrange(4))]
    rng.shuffle(axes)
    timed = rng.random() < 0.8
    axes = ["t"] * timed + axes
    units = [rng.choice(list(UNITS)) for _ in axes]
    table = np.round(np.array([[rng.gauss(0.0, 0.3) for _ in axes] for _ in range(ROWS)]), 4)
    if timed:
        table[:, 0] = 0.01 * np.arange(ROWS)
    own = rng.random() < 0.3 and "-" not in axes
    separator = rng.choice((" ", "\t", ";", ",", " ; "))
    if own:
        names = ["time_s" if axis == "t" else f"a{axis}_{unit}" for axis, unit in zip(axes, units)]
    else:
        names = [rng.choice(WORDS[axis]) for axis in axes]
    rows = [separator.join(f"{value:.4f}" for value in row) for row in table]
    if rng.random() < 0.2 and "," not in separator:
        rows = [row.replace(".", ",") for row in rows]
    head = rng.choice(("", "# ")) + separator.join(names)
    path = folder / "record.txt"
    path.write_text(f"{rng.choice(ABOVE)}{head}\n" + "\n".join(rows) + "\n" + rng.choice(END), encoding="utf-8")
    dt = None if timed else 0.01
    wanted = {axis: values * UNITS[unit] for axis, unit, values in zip(axes, units, table.T) if axis in "xyz"}
    if own:
        compare(read_motion(path, dt=dt), wanted, head)
        return "read by its header"
    stated = ", ".join(
        "t [s]" if axis == "t" else "-" if axis == "-" else f"{axis} [{unit}]" for axis, unit in zip(axes, units)
    )
    compare(read_motion(path, dt=dt, columns=stated), wanted, f"{head} as {stated}")
    try:
        motion = read_motion(path, rng.choice((None, "gal")), dt)
    except InputError as error:
        proposal = re.search(r"`columns='([^']+)'`", sentence(error))
        if proposal is None:
            raise Fault(f"{head!r} is refused without a proposal: {error}") from error
        read_motion(path, dt=None if proposal[1].startswith("t") else 0.01, columns=proposal[1])
        return "proposed"
    raise Fault(f"{head!r} was read: {motion.metadata['labels']}")


def compare(motion: Motion, wanted: dict[str, np.ndarray], what: str) -> None:
    """Raise a fault where an axis holds other numbers than those of its column."""
    if not np.isclose(motion.dt, 0.01, rtol=1e-9) or set(motion.components) != set(wanted):
        raise Fault(f"{what!r} was read as {sorted(motion.components)} at {motion.dt} s, it names {sorted(wanted)}")
    for axis, values in wanted.items():
        if not np.allclose(motion.components[axis], values, rtol=1e-9, atol=1e-12):
            raise Fault(f"{what!r}: {axis} holds the numbers of another column or unit")


TARGET = Target("layouts", 5_000, 150, attempt)
