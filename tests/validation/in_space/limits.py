"""Collapse multipliers: the static programme beside closed forms and beside an independent one, and pushes beside them."""

import re
from functools import cache

import numpy as np
from references import assembly, scenes

import stylobate as st
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.engine import engine_for
from stylobate.models.space.loose import engine_of, step_for
from stylobate.statics.limit import AssemblyProgramme

from .row import MET, MISSED, NONE, Judged, Rows, both_sides, family, near

#: Multipliers of blocks are met to this share, as are those of the independent programme [-].
CLOSE = 5e-3

#: What the scenes are called, and how they are made.
SCENES = {
    "limit3d_portal_square": lambda s: s.portal("box", drums=1),
    "limit3d_portal_round_3_drums": lambda s: s.portal("cyl", drums=3),
    "limit3d_podium_square": lambda s: s.podium("box"),
    "limit3d_podium_round_3_drums": lambda s: s.podium("cyl", drums=3),
    "limit3d_colonnade_4": lambda s: s.colonnade(4, gap=0),
    "limit3d_temple_corner": lambda s: s.corner(gap=0),
    "limit3d_arch": lambda s: s.arch(15, 3.0, 0.6, 0.8),
    "limit3d_wall": lambda s: s.wall(8, 5),
    "limit3d_wall_corner": lambda s: s.wall_corner(8, 4, 4),
}

#: Stiffness of what is pushed [N/m³], local damping while it is [-], how long, and the way beyond which it is on its way
#: down, in shares of the smallest body.
PUSHED, DAMPING, HELD, LOST = 5e10, 0.5, (1.0, 2.0), 0.05


def law(stiffness: float, friction: float = 0.7) -> st.Joint:
    """Law of all joints."""
    return st.Joint(stiffness, 0.5 * stiffness, friction_coefficient=friction)


def stiffer(structure: st.SpatialAssembly, stiffness: float, friction: float = 0.7) -> st.SpatialAssembly:
    """The same bodies on other joints."""
    return st.SpatialAssembly(structure.stones, law(stiffness, friction), structure.name)


def stands(structure: st.SpatialAssembly, azimuth: float, share: float) -> bool:
    """Whether bodies stand a push in proportion to their mass [g]: damped while it comes, then a while without."""
    model = DistinctElement3D()
    engine = engine_of(structure, engine_for(model, structure).acting, 1.0)
    engine.start(step_for(engine, structure, engine_for(model, structure).acting))
    first = engine.places
    angle = np.radians(azimuth)
    engine.body["local"] = DAMPING
    parts = 20
    for part in range(1, parts + 1):  # it grows in the first half of the time
        grown = min(1.0, 2.0 * part / parts)
        engine.now["g"] = 9.81 * np.array([-share * grown * np.cos(angle), -share * grown * np.sin(angle), 1.0])
        engine.advance(round(HELD[0] / parts / engine.dt / 32))
    engine.body["local"] = 0.0
    engine.advance(round(HELD[1] / engine.dt / 32))
    assert not engine.failed
    return bool(np.abs(engine.places - first).max() < LOST * engine.smallest)


def multiplier(structure: st.SpatialAssembly, azimuth: float) -> float:
    """Collapse multiplier of the static programme [g]."""
    return float(st.limit_directions(structure, [azimuth]).limits[0].multiplier)


@cache
def scene(name: str) -> st.SpatialAssembly:
    """A scene of the independent programme."""
    return assembly(SCENES[name](scenes()), name)


#: Shares of the multiplier that are pushed with, below and above; of round joints that twist, and of what slides, the lower
#: one is no claim of the rows.
PUSHES = (0.96, 1.05)


@family("limit3d_")
def independent_programme(rows: Rows):
    """The multiplier to half a per cent, and pushes on either side of it."""
    for row in rows:
        azimuth = float(re.search(r"along (\S+) deg", row["params"])[1])
        structure, expected = scene(row["case"]), float(row["value"])
        limit = st.limit_directions(structure, [azimuth]).limits[0]
        below, above = (stands(stiffer(structure, PUSHED), azimuth, share * expected) for share in PUSHES)
        sure = "stands at 0.96" in row["spread"]
        bound = "" if not limit.upper_bound else "an upper bound; "
        words = {True: "stands", False: "falls"}
        remark = f"{bound}pushed with {PUSHES[0]:g}: {words[below]}, {PUSHES[1]:g}: {words[above]}"
        if sure and not below:  # bodies on soft joints lean before they lose their stand
            below = stands(stiffer(structure, 10.0 * PUSHED), azimuth, PUSHES[0] * expected)
            remark += f"; on joints ten times as stiff {PUSHES[0]:g}: {words[below]}"
        judged = near(row, limit.multiplier, why=remark, spread=CLOSE * expected)
        wrong = above or (sure and not below)
        yield Judged(judged.ours, judged.difference, MISSED if wrong else judged.verdict, remark)


def columns(kind: str, feet, height: float = 4.0) -> list[st.Stone]:
    """Monoliths of 0.8 m on the ground."""
    if kind == "box":
        return [st.Stone.box((0.8, 0.8, height), (x, y, 0.0), 2700.0, name=f"column {x:g} {y:g}") for x, y in feet]
    return [st.Stone.drum(0.8, 0.8, height, (x, y, 0.0), 2700.0, name=f"column {x:g} {y:g}") for x, y in feet]


def square_portal() -> st.SpatialAssembly:
    """Two square monoliths under a beam."""
    beam = st.Stone.box((3.2, 0.8, 0.6), (0.0, 0.0, 4.0), 2700.0, name="beam")
    return st.SpatialAssembly([*columns("box", [(-1.2, 0.0), (1.2, 0.0)]), beam], law(5e11, 5.0), "portal")


def pushed(row, structure: st.SpatialAssembly, azimuth: float, spread: float) -> Judged:
    """The multiplier, and that it stands and falls on either side of it."""
    expected = float(row["value"])
    below, above = (stands(structure, azimuth, share * expected) for share in (0.97, 1.03))
    sides = both_sides(row, below, above, "0.97|1.03")
    judged = near(row, multiplier(structure, azimuth), why=f"pushed: {sides.ours}", spread=spread * expected)
    return judged if sides.verdict == MET else Judged(judged.ours, judged.difference, MISSED, judged.why)


@family("portal_push")
def portal_push(rows: Rows):
    """Along the beam and across it."""
    for row, azimuth in zip(rows, (0.0, 90.0), strict=True):
        yield pushed(row, square_portal(), azimuth, 0.01)


@family("podium_push")
def podium_push(rows: Rows):
    """Four columns under a slab, pushed at 30°."""
    feet = [(x, y) for x in (-1.2, 1.2) for y in (-1.2, 1.2)]
    for row in rows:
        kind = "box" if "square" in row["params"] else "drum"
        slab = st.Stone.box((3.4, 3.4, 0.3), (0.0, 0.0, 4.0), 2700.0, name="slab")
        structure = st.SpatialAssembly([*columns(kind, feet), slab], law(5e11), "podium")
        yield pushed(row, structure, 30.0, 0.02 if kind == "box" else 0.01)


@family("single_push")
def single_push(rows: Rows):
    """A square block pushed at 30°, and where a round one falls to."""
    yield pushed(rows[0], st.SpatialAssembly(columns("box", [(0.0, 0.0)]), law(5e11), "block"), 30.0, 0.01)
    round_one = st.SpatialAssembly(columns("drum", [(0.0, 0.0)]), law(5e11), "block")
    t = np.arange(0.0, 6.0, 0.005)
    push = -9.81 * 0.044 * np.minimum(t, 5.2)
    c, s = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    response = st.simulate(round_one, st.Motion(0.005, push * c, lateral=push * s), DistinctElement3D())
    lean = response.poses.axis[-1, 1]
    assert np.hypot(lean[0], lean[1]) > 0.1
    yield near(rows[1], np.degrees(np.arctan2(lean[1], lean[0])))


def arch(share: float, stones: int = 31, radius: float = 3.0) -> st.SpatialAssembly:
    """A semicircular arch of voussoirs, a share of its radius thick."""
    bodies = scenes().arch(stones, radius, share * radius, 0.8)
    return assembly(bodies, "arch")


@family("arch_thickness")
def arch_thickness(rows: Rows):
    """31 stones stand and fall on either side of Milankovitch's thickness by the static programme."""

    def stands_alone(share: float) -> bool:
        try:
            AssemblyProgramme(arch(share * float(rows[0]["value"])))
        except st.InputError:
            return False
        return True

    yield both_sides(rows[0], stands_alone(1.02), stands_alone(0.98), "1.02|0.98", "31 stones, statics")


@family("arch_across")
def arch_across(rows: Rows):
    """Fifteen voussoirs between chords, whose centroid lies a little lower than that of the smooth arch."""
    expected = float(rows[0]["value"])
    structure = assembly(scenes().arch(15, 3.0, 0.6, 0.8), "arch")
    why = "half a per cent, as for all multipliers: voussoirs between chords lie lower than the smooth arch"
    yield near(rows[0], multiplier(structure, 90.0), why=why, spread=CLOSE * expected)


@family("wall_mid_push")
def wall_mid_push(rows: Rows):
    """Two halves of a wall that hinge; measured walls are weaker as they are pushed out, by the share of their thickness."""
    thick, high, wide, stop = 0.11, 1.5, 0.95, 1e-4
    stones = [
        st.Stone.box((thick, wide, 0.5 * high), (0, 0, 0), 1800.0, name="lower"),
        st.Stone.box((thick, wide, 0.5 * high), (0, 0, 0.5 * high), 1800.0, name="upper"),
        st.Stone.box((0.2, wide, stop), (0.5 * thick + 0.1, 0, high - stop), name="stop", fixed=True),
    ]
    smooth = ("upper", "stop", law(5e9, 0.0))
    structure = st.SpatialAssembly(stones, law(5e9), "wall", overrides=[smooth])
    rigid = 0.5 * multiplier(structure, 0.0)  # a load over the height does half the work of one in its middle
    yield near(rows[0], rigid, spread=CLOSE * float(rows[0]["value"]))
    for row in rows[1:]:
        pushed_out = float(re.search(r"d/t (\S+)", row["spread"])[1])
        why = "a measurement without a spread; the rigid mechanism at the same deflection"
        judged = near(row, rigid * (1.0 - pushed_out))
        yield Judged(judged.ours, judged.difference, NONE, why)
