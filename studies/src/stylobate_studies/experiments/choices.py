"""Choices fixed by argument, when, and why; read by the computations, the page and the command."""

from __future__ import annotations

import math
from typing import NamedTuple


class Choice(NamedTuple):
    """One choice: what, its value, since when, and the reason."""

    what: str
    value: str
    date: str
    reason: str


#: Friction of granite on the table [-], and its range.
FRICTION, FRICTIONS = 0.7, (0.5, 0.8)

#: Restitution of a vertex of granite [-], and its range.
RESTITUTION, RESTITUTIONS = 0.5, (0.2, 0.8)

#: Stiffness of the footprint [N/m³].
STIFFNESS = 5e10

#: Largest deviation of the shaking axis from x of the scan [rad].
AZIMUTH = math.radians(15.0)

#: Kept of a motion before anything happens, and after [s].
BEFORE, AFTER = 0.5, 2.0

#: A test is hard where a logistic fit in ln PGA and ln PGV/PGA gives this probability or more, and 1 less this or less.
HARD = 0.1

#: Friction and restitution of the cube as published [-]; stiffness of its face [N/m³].
CUBE_FRICTION, CUBE_RESTITUTION, CUBE_STIFFNESS = 0.18, 0.125, 4e9

#: Choices of a calibration.
FRICTION_GRID, RESTITUTION_GRID = (0.5, 0.65, 0.8), (0.2, 0.5, 0.8)
#: Radii to which edges may be worn [m].
EDGES = (0.03, 0.06, 0.1)
CUBE_FRICTION_GRID, CUBE_RESTITUTION_GRID = (0.12, 0.18, 0.24), (0.05, 0.125, 0.3)

DAY = "2026-11-22"

CHOICES = (
    Choice("body", "convex hull of the scan, uniform density", DAY, "as prepared; only the hull can touch a plane"),
    Choice(
        "motion", "along x of the scan's frame, azimuth 0", DAY, "what the authors simulate; not measured otherwise"
    ),
    Choice(
        "friction", "0.7", DAY, "granite on a hard plane, upper part of the likely 0.5 to 0.8; the trial run's value"
    ),
    Choice(
        "restitution of a vertex",
        "0.5",
        DAY,
        "middle of what can be; tables of rockfall give 0.53 for clean hard bedrock; not measured in these tests",
    ),
    Choice(
        "stiffness",
        "5e10 N/m³ of the resting triangle, half in shear",
        DAY,
        "that of the columns: 1 to 3e8 N/m a vertex, stiffer than a rough grain by Hertz (some 4e7 N/m): near rigid",
    ),
    Choice("toppled", "tilt beyond 45°", DAY, "as the experimenters count"),
    Choice("motion kept", "from 0.5 s before anything happens to 2 s after", DAY, "all that stand are then decided"),
    Choice(
        "footprint of a realisation",
        "mean of the three scans' support functions, with shares drawn evenly among all",
        DAY,
        "the scans are readings of one form; noise widens the face that a hull rests on, and a mean has less of it. "
        "Replaces relief of 1 mm on top of a scan, which had more; chosen when its probabilities were known to be too low",
    ),
    Choice("model's damping", "none besides restitution and friction", DAY, "one number for dissipation"),
)
