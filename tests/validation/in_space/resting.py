"""Scenes in space under a push or a slope that lasts, at a share of what they bear: they lie still, or they go."""

import math
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np

import stylobate as st

from .plane import GALLERY
from .random_scenes import arch, colonnade, heap, pillar, portal

#: Scenes that are drawn, and the shares of what they bear under which nothing moves, and under which all go.
SCENES = 500
BELOW, ABOVE = (0.3, 0.98), (1.02, 1.2)

#: The load grows until RAISED; the mean places from SETTLED to HALFWAY and from there to LASTS are compared [s].
RAISED, SETTLED, HALFWAY, LASTS = 3.0, 4.0, 7.0, 10.0

#: What moves by more than this while the load stays as it is creeps [m].
CREEPS = 1e-4

DENSITY = 2500.0
STIFF = 5e9, 2.5e9


def single(rng):
    """One box."""
    b, d, h = rng.uniform(0.4, 0.8, 3) * (1.0, 1.0, rng.uniform(1.0, 3.0))
    return [st.Stone.box((b, d, h), (0.0, 0.0, 0.0), DENSITY, name="box")]


def drum(rng):
    """One drum."""
    wide = rng.uniform(0.4, 0.8)
    return [st.Stone.drum(wide, wide, wide * rng.uniform(1.0, 3.0), (0.0, 0.0, 0.0), DENSITY, name="drum")]


def pile(rng):
    """One to three stones of one kind."""
    return pillar(rng, (0.0, 0.0), rng.uniform(0.5, 0.8), rng.uniform(1.5, 3.0), "p")


def leaning_wall(rng):
    """Slabs on one another, each a little beyond the one below."""
    thick, high, out = rng.uniform(0.4, 0.6), rng.uniform(0.3, 0.5), rng.uniform(0.0, 0.04)
    return [
        st.Stone.box((thick, 1.2, high), (out * k, 0.0, high * k), DENSITY, name=f"slab {k}")
        for k in range(int(rng.integers(2, 5)))
    ]


def in_scene(stones, joint, name):
    """An assembly."""
    return st.SpatialAssembly(tuple(stones), joint, name=name)


def column(rng, joint, section, count, lean):
    """A column of so many drums, as found where it leans [degrees]."""
    wide = rng.uniform(0.5, 0.9)
    made = st.Column.tapered(
        height=wide * rng.uniform(2.0, 5.0), bottom_width=wide, top_width=wide * rng.uniform(0.7, 1.0), drums=count,
        density=DENSITY, joint=joint, section=section,
    )  # fmt: skip
    return made.replace(as_found=st.AsFound((st.FoundDrum(1, tilt=lean, tilt_azimuth=40.0),))) if lean else made


#: Kinds of scenes with how often they are drawn: the cheap ones more.
KINDS = {
    "box": (single, 6), "drum": (drum, 6), "pile": (pile, 4), "leaning wall": (leaning_wall, 2), "portal": (portal, 1),
    "heap": (heap, 1), "arch": (arch, 1), "colonnade": (lambda rng: colonnade(rng, 3), 1),
    "rim": ("circular", 4), "bed": ("circular", 2), "rectangular": ("rectangular", 2), "leaning column": ("circular", 2),
    "gallery": (("portal_in_space", "statue", "colonnade"), 1),
}  # fmt: skip


def drawn(number: int) -> tuple[str, Any, dict[str, Any], float, bool, bool]:
    """Kind, structure, options of the model, azimuth [degrees], whether it is a slope, and above what is borne."""
    rng = np.random.default_rng([47, number])
    weights = np.array([often for _, often in KINDS.values()], dtype=float)
    kind = str(rng.choice(list(KINDS), p=weights / weights.sum()))
    made, _ = KINDS[kind]
    joint = st.Joint(*STIFF, friction_coefficient=rng.choice([0.5, 0.7, 0.9]))
    options: dict[str, Any] = {"losses": str(rng.choice(["none", "stone"]))}
    if callable(made):
        structure: Any = in_scene(made(rng), joint, kind)
    elif kind == "gallery":
        structure = st.read_assembly(GALLERY / f"{rng.choice(made)}.toml")
    else:
        count = int(rng.choice([1, 1, 2, 3, 6]))
        structure = column(rng, joint, made, count, rng.uniform(0.3, 1.0) if kind == "leaning column" else 0.0)
        options |= {"law": "bed"} if kind == "bed" else {}
    azimuth = float(rng.choice([0.0, 30.0, 90.0, 200.0]))
    return kind, structure, options, azimuth, bool(rng.random() < 0.4), bool(rng.random() < 0.2)


def lasting(borne: float, azimuth: float, slope: bool, lasts: float = LASTS) -> st.Motion:
    """A push of so many g towards an azimuth, slowly raised and held; or a plane slowly tilted until it falls by as much."""
    time = np.arange(0.0, lasts, 0.01)
    raised = np.minimum(time / RAISED, 1.0)
    raised = raised * raised * (3.0 - 2.0 * raised)
    tilt = raised * math.atan(borne)
    along, up = (np.sin(tilt), np.cos(tilt) - 1.0) if slope else (raised * borne, np.zeros(len(time)))
    a = math.radians(azimuth)
    return st.Motion(
        0.01, -st.g * along * math.cos(a), lateral=-st.g * along * math.sin(a), vertical=st.g * up if slope else None
    )


def rests(number: int) -> dict[str, Any]:
    """What becomes of the scene of a number."""
    kind, structure, options, azimuth, slope, above = drawn(number)
    rng = np.random.default_rng([48, number])
    share = rng.uniform(*(ABOVE if above else BELOW))
    borne = st.limit_directions(structure, [azimuth]).limits[0].multiplier
    model = st.DistinctElement3D(**options)
    opens = model.opening(structure.stack) if structure.section == "circular" else None
    if opens is not None:  # what a column bears on joints as soft as these
        borne = min(borne, opens.acceleration / st.g)
    response = st.simulate(
        structure, lasting(share * borne, azimuth, slope), model, until_end=True, output_interval=0.1
    )
    place, time = response.body_position, response.time
    ends = bool(response.measures.collapsed or time[-1] < LASTS - 0.5)
    first, last = (
        place[(time >= a) & (time < b)].mean(axis=0) for a, b in ((SETTLED, HALFWAY), (HALFWAY, LASTS - 0.2))
    )
    way = math.inf if ends else float(np.linalg.norm(last - first, axis=1).max())
    return {
        "scene": number, "kind": kind, "losses": options["losses"], "slope": slope, "share": round(share, 3),
        "borne": round(float(borne), 4), "fell": ends, "crept": way, "outcome": str(response.measures.outcome),
    }  # fmt: skip


def resting() -> Iterator[dict[str, Any]]:
    """Of every scene what becomes of it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", st.OutOfRangeWarning)
        yield from map(rests, range(SCENES))


def counted_at_rest(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Of each kind: scenes that bear their load, those that crept and fell, the farthest way; those that do not bear it, and
    those of them that neither fell nor moved."""
    counts = {}
    for kind in dict.fromkeys(row["kind"] for row in rows):
        scenes = [row for row in rows if row["kind"] == kind]
        below, above = ([row for row in scenes if (row["share"] > 1.0) is far] for far in (False, True))
        crept = [row["crept"] for row in below if not row["fell"]]
        counts[kind] = {
            "below": len(below), "crept": sum(way > CREEPS for way in crept), "fell": sum(row["fell"] for row in below),
            "farthest": max(crept, default=0.0), "above": len(above),
            "stood": sum(not row["fell"] and row["crept"] < CREEPS for row in above),
        }  # fmt: skip
    return counts
