"""Scenes of two physics engines: who falls, how many, the largest tilt, as they say at several steps and sizes."""

import re
import warnings
from functools import cache
from typing import NamedTuple

import numpy as np
from references import assembly, scenes

import stylobate as st
from stylobate.models.engine import engine_for

from .row import MET, MISSED, NONE, Judged, Rows, family

#: Joints of the scenes [N/m³], and how long they were followed [s].
STIFFNESS, FOLLOWED = 1e10, 8.0

#: The engines lose all that an impact can lose, and joints as much as damping takes [s]: the largest of these with which a
#: step is no shorter than this [s].
DAMPINGS, SHORTEST = (1e-3, 3e-4, 1e-4), 2e-5


class Found(NamedTuple):
    """What became of a scene: bodies fallen, and the largest tilt of any from the vertical [deg]."""

    fallen: int
    tilt: float
    failed: str


def bodies_of(text: str):
    """Bodies of a scene as its row writes it, such as ``scenes.portal('cyl', 3)``."""
    call = re.match(r"scenes\.(\w+)\(([^)]*)\)", text)
    arguments, named = [], {}
    for argument in filter(None, (part.strip() for part in call[2].split(","))):
        name, _, value = argument.rpartition("=")
        made = value.strip("'") if value.startswith("'") else float(value) if "." in value else int(value)
        named.update({name: made}) if name else arguments.append(made)
    return getattr(scenes(), call[1])(*arguments, **named)


def motion_of(text: str) -> st.Motion:
    """The ground of a scene as its row writes it."""
    s = scenes()
    single_sine = re.search(r"one full sine (\S+) g, period (\S+) s, azimuth (\S+) deg", text)
    two_sines = re.search(r"(?:= |two_sines)\(([\d., ]+)\)", text)
    if single_sine:
        size, period, azimuth = map(float, single_sine.groups())
        ground, length = s.one_sine(size, period, azimuth), 0.2 + period
    elif two_sines:
        ax, fx, ay, fy = (float(part) for part in two_sines[1].split(","))
        ground, length = s.two_sines(ax, fx, ay, fy), 0.2 + 5.0 / min(fx, fy)
    else:
        ground, length = s.quiet, 0.2
    rows = np.array([ground(t) for t in np.arange(0.0, length + 0.01, 0.002)])
    return st.Motion(0.002, rows[:, 0], lateral=rows[:, 1])


@cache
def run_of(text: str, share: float = 1.0) -> Found:
    """One run of a scene, its motion as it is or a share of it."""
    structure = assembly(bodies_of(text), "scene")
    joint = st.Joint(STIFFNESS, 0.5 * STIFFNESS, friction_coefficient=0.7)
    structure = st.SpatialAssembly(structure.stones, joint, "scene")
    motion = motion_of(text).scaled(share)
    models = [st.DistinctElement3D(stiffness_damping=damping) for damping in DAMPINGS]
    model = next(
        (candidate for candidate in models if engine_for(candidate, structure).expected_step(motion)[0] >= SHORTEST),
        models[-1],
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", st.OutOfRangeWarning)  # a monolith that leans begins as drawn
        response = st.simulate(structure, motion, model, tail=FOLLOWED - motion.duration, until_end=True)
    axes = response.poses.axis
    hull = "arch" in text
    upright = np.abs(axes[..., 2]) if not hull else np.einsum("nk,tnk->tn", axes[0], axes)
    tilt = float(np.degrees(np.arccos(np.clip(upright, -1.0, 1.0))).max())
    return Found(len(response.measures.blocks.fell_at), tilt, response.measures.reason)


@family(
    "engines_portal",
    "engines_podium",
    "engines_colonnade",
    "engines_temple_corner",
    "engines_row",
    "engines_arch",
    "engines_wall",
)
def engines(rows: Rows):
    """Verdict and number fallen; tilts within the range of the engines."""
    for row in rows:
        scene = run_of(row["params"])
        why = f"no verdict: {scene.failed}" if scene.failed else ""
        if row["quantity"] == "verdict":
            mine = "collapses" if scene.fallen else "stands"
            shown = f"{mine} ({scene.fallen} fallen, {scene.tilt:.3g}°)"
            same = mine == row["value"] and not why
            yield Judged(shown, "", MET if same else MISSED, why or ("" if same else nearby(row)))
        elif row["quantity"] == "bodies fallen":
            off = scene.fallen - int(row["value"])
            last = "the same verdict; how many of the last stones come down hangs on what impacts leave" if off else ""
            yield Judged(str(scene.fallen), f"{off:+d}" if off else "", MISSED if off or why else MET, why or last)
        elif row["quantity"] == "largest tilt of any body":
            low, high = (float(bound) for bound in row["spread"].split(" to "))
            off = scene.tilt / float(row["value"]) - 1.0
            inside = low <= scene.tilt <= high and not why
            reason = why or ("" if inside else beyond(row, rows, scene.tilt))
            yield Judged(f"{scene.tilt:.3g}", f"{100.0 * off:+.2g} %", MET if inside else MISSED, reason)
        else:
            shown = f"{scene.fallen} fallen, {scene.tilt:.3g}°"
            yield Judged(shown, "", NONE, "the engines disagree: no verdict to be met")


def nearby(row: dict[str, str]) -> str:
    """What a scene with another verdict does when it is shaken a little more or less."""
    runs = [(share, run_of(row["params"], share)) for share in (0.97, 1.03, 1.1)]
    summary = ", ".join(f"{share:g}: {run.fallen} fallen ({run.tilt:.3g}°)" for share, run in runs)
    return f"near its limit in the engines too; here with so much of the amplitude {summary}"


def beyond(row: dict[str, str], rows: Rows, tilt: float) -> str:
    """Why a tilt is outside the range of the engines."""
    verdict = next(
        candidate for candidate in rows if candidate["case"] == row["case"] and candidate["quantity"] == "verdict"
    )
    seen = [float(angle) for angle in re.findall(r"([\d.]+) deg", verdict["spread"])]
    low, high = min(seen), max(seen)
    if low <= tilt <= high:
        return f"inside what 3 % more or less of the amplitude make of it in the engines ({low:g} to {high:g})"
    lossy = "joints give way where bodies rock on edges, and lose other shares at impacts"
    return f"outside {low:g} to {high:g}, what 3 % of the amplitude make of it in the engines: {lossy}"
