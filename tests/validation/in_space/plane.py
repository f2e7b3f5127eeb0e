"""Plane assemblies of the gallery as bodies in space, against the plane model: first swing, and verdicts under pulses.

Motions along x and bodies that are alike on both sides stay in the plane by themselves. The joint of a face a long in
the plane and b deep resists bending with (3 b + a)/(a + b) k_n J, the two corners of the plane with 3 k_n J: the deeper,
the nearer.
"""

import warnings
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import stylobate as st
from stylobate.column.assembly_files import read_assembly
from stylobate.column.spatial.assembly import as_prisms

GALLERY = Path(__file__).resolve().parents[3] / "gallery" / "assemblies"

#: Of the plane: depth of the bodies in space [m], and one at which they are nearly plane.
DEPTH, DEEP = 1.0, 20.0

#: Half sines of which the first swing is compared, and whole ones whose verdicts are [g, s].
SWINGS = {"portal": (0.35, 0.8), "arch": (0.3, 0.25)}
PULSES = {
    "portal": [(a, t) for t in (0.5, 1.0) for a in (0.3, 0.45, 0.6, 0.9)],
    "arch": [(a, t) for t in (0.3, 0.6) for a in (0.4, 0.6, 0.9, 1.3)],
}

#: Friction over which nothing slides, for the first swing: what slides is another law in space, where shear is one force.
NO_SLIP = 3.0


class Swing(NamedTuple):
    """First swing: the largest rotation of any body [rad], and when [s]; largest way out of the plane [m]."""

    peak: float
    time: float
    aside: float


@cache
def plane_assembly(name: str, sliding: bool) -> st.Assembly:
    """An assembly of the gallery, with its own friction or with one that holds."""
    assembly: Any = read_assembly(GALLERY / f"{name}.toml")
    if sliding:
        return assembly
    joint = assembly.joint
    no_slip_joint = st.Joint(joint.normal_stiffness, joint.shear_stiffness, friction_coefficient=NO_SLIP)
    return st.Assembly(assembly.blocks, no_slip_joint, name, ground=assembly.ground)


@cache
def space_assembly(name: str, depth: float, sliding: bool) -> st.SpatialAssembly:
    """The same blocks as prisms of a depth."""
    return as_prisms(plane_assembly(name, sliding), depth)


def pulse(share: float, duration: float, cycles: float) -> st.Motion:
    """Half a sine or a whole one along x."""
    t = np.linspace(0.0, duration, 401)
    return st.Motion(duration / 400.0, share * 9.81 * np.sin(2.0 * np.pi * cycles * t / duration))


@cache
def swing(name: str, depth: float | None) -> Swing:
    """The first swing after half a sine; None is the plane."""
    share, duration = SWINGS[name]
    structure = plane_assembly(name, False) if depth is None else space_assembly(name, depth, False)
    model = st.DistinctElement2D() if depth is None else st.DistinctElement3D()
    response = st.simulate(structure, pulse(share, duration, 0.5), model, tail=0.6, output_interval=0.002)
    axis = response.body_axis
    turned = np.arccos(np.clip(np.einsum("nk,tnk->tn", axis[0], axis), -1.0, 1.0)).max(axis=1)
    aside = (
        0.0 if depth is None else float(np.abs(response.body_position[..., 1] - response.body_position[0, :, 1]).max())
    )
    # the first time that it turns back, from a rotation that is none of the springs'
    back = np.flatnonzero((turned[1:-1] >= turned[:-2]) & (turned[1:-1] > turned[2:]) & (turned[1:-1] > 2e-3))
    k = int(back[0]) + 1 if len(back) else int(np.argmax(turned))
    return Swing(float(turned[k]), float(response.time[k]), aside)


@cache
def falls(name: str, depth: float | None, share: float, duration: float) -> bool:
    """Whether anything falls under a whole sine."""
    structure = plane_assembly(name, True) if depth is None else space_assembly(name, depth, True)
    model = st.DistinctElement2D() if depth is None else st.DistinctElement3D()
    response = st.simulate(structure, pulse(share, duration, 1.0), model, tail=3.0)
    assert response.measures.outcome != st.Outcome.FAILED, response.measures.reason
    return bool(response.measures.blocks.fell_at)


@cache
def toppling(depth: float | None) -> np.ndarray:
    """Times at which the slabs of the gallery's dominoes lean by 0.1 rad [s]."""
    structure = plane_assembly("dominoes", True) if depth is None else space_assembly("dominoes", depth, True)
    model = st.DistinctElement2D(restitution=0.3) if depth is None else st.DistinctElement3D(restitution=0.3)
    still = st.Motion(0.01, np.zeros(301))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", st.OutOfRangeWarning)  # the first slab falls from the start
        response = st.simulate(structure, still, model, output_interval=0.002)
    axis = response.body_axis
    turned = np.arccos(np.clip(np.einsum("nk,tnk->tn", axis[0], axis), -1.0, 1.0)) > 0.1
    return np.sort(response.time[turned.argmax(axis=0)[turned.any(axis=0)]])


def computed() -> dict:
    """All of it, as plain values."""
    depths = {"plane": None, "1 m": DEPTH, "20 m": DEEP}
    swings = {name: {label: swing(name, depth)._asdict() for label, depth in depths.items()} for name in SWINGS}
    verdicts = {
        name: [[share, time, falls(name, None, share, time), falls(name, DEPTH, share, time)] for share, time in each]
        for name, each in PULSES.items()
    }
    slabs = {label: [round(float(time), 4) for time in toppling(depths[label])] for label in ("plane", "1 m")}
    return {"swings": swings, "verdicts": verdicts, "dominoes": slabs}


def tables(kept: dict) -> str:
    """First swings, verdicts and dominoes, in Markdown."""
    lines = ["| first swing | plane | 1 m deep | 20 m deep |", "| --- | --- | --- | --- |"]
    for name, swings in kept["swings"].items():
        base = swings["plane"]
        for key, unit, words in (("peak", "rad", "largest rotation"), ("time", "s", "when")):
            cells = [f"{base[key]:.4f} {unit}"]
            for label in ("1 m", "20 m"):
                cells.append(
                    f"{swings[label][key]:.4f} {unit} ({100.0 * (swings[label][key] / base[key] - 1.0):+.1f} %)"
                )
            lines.append(f"| {name}, {words} | {' | '.join(cells)} |")
    lines += ["", "| pulses | cases | same verdict | fall in the plane, in space |", "| --- | --- | --- | --- |"]
    for name, each in kept["verdicts"].items():
        same = sum(flat == deep for *_, flat, deep in each)
        falls = ", ".join(str(sum(bool(case[k]) for case in each)) for k in (2, 3))
        lines.append(f"| {name} | {len(each)} | {same} | {falls} |")
    lines += ["", "| dominoes | leans by 0.1 rad after [s] |", "| --- | --- |"]
    for label, times in kept["dominoes"].items():
        lines.append(
            f"| {'plane' if label == 'plane' else 'in space, 1 m deep'} | {', '.join(f'{time:.3f}' for time in times)} |"
        )
    return "\n".join(lines) + "\n"
