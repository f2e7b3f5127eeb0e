"""Whole collapses, to the ground and to rest: the ledger closes, and nothing lies deeper than its weight presses it."""

import numpy as np
import pytest

from stylobate.column import Joint, preset
from stylobate.column.assembly import Assembly, Block
from stylobate.column.standing import of_column
from stylobate.constants import g
from stylobate.kernels.plane import clip as near
from stylobate.kernels.plane.records import LOCAL
from stylobate.kernels.run_codes import CHUNK
from stylobate.models.base import RESTITUTION, RunOptions
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.plane.loose import Loose, follow, stable_step_of
from stylobate.motion import harmonic
from stylobate.response.assemblies import recorded_blocks
from stylobate.simulate import simulate


def box(x, z, width, height, name):
    corners = ((x, z), (x + width, z), (x + width, z + height), (x, z + height))
    return Block(tuple((p - 0.5 * width, q) for p, q in corners), 2000.0, name)


def portal():
    columns = [box(side, 1.0 * i, 0.8, 1.0, f"{side:+g}, {i + 1}") for side in (-1.5, 1.5) for i in range(4)]
    return Assembly((*columns, box(0.0, 4.0, 3.8, 0.7, "architrave")), Joint(1e9, 5e8, friction_coefficient=0.7))


#: By which what lies still, undamped, goes on ringing [m].
RINGING = 1e-5

CASES = {
    "monolith": (lambda: of_column(preset("paper-monolithic")), harmonic(0.5, 0.3 * g, 6.0)),
    "12 drums": (lambda: of_column(preset("paper-12-drums")), harmonic(0.5, 0.5 * g, 6.0)),
    "12 drums, φ = 10°": (
        lambda: of_column(preset("paper-12-drums").with_joint(friction_angle=10.0)),
        harmonic(0.25, 0.7 * g, 8.0),
    ),
    "portal": (portal, harmonic(0.5, 0.5 * g, 4.0)),
}


def contacts(engine):
    """Depth [m], width [m] and stiffness [N/m³ · m] of every overlap, and the force with which its bed presses [N]."""
    x, z, rotation = (engine.records.body[name][None, :, 0] for name in ("x", "z", "th"))
    recorded = recorded_blocks(
        engine.structure, np.zeros(1), x, z, rotation, {}, np.zeros(1), np.zeros(1), at_rest=True, failed=False,
        in_equilibrium=True, energy_imbalance=0.0, time_step=1.0, steps=1, model="dem2d", provenance={},
    )  # fmt: skip
    n, pairs = len(engine.records.body), {}
    outlines = [np.ascontiguousarray(recorded.outline(0, i).T) for i in range(n)]
    px, pz, qx, qz = (np.zeros(near.MOST) for _ in range(4))
    from_b, q_from = (np.zeros(near.MOST, dtype=np.int64) for _ in range(2))
    for i in range(n):
        for j in range(i + 1, n):
            (xa, za), (xb, zb) = outlines[i], outlines[j]
            count = near.clip(xb, zb, len(xb), xa, za, len(xa), px, pz, from_b, qx, qz, q_from)
            if count:
                area, _, _, gx, gz = near.measure(px, pz, from_b, count)
                width = float(np.hypot(gx, gz))
                depth = float(np.ptp((px[:count] * -gz + pz[:count] * gx) / width))
                thick = min(engine.shape["depth"][i], engine.shape["depth"][j])
                stiffness = engine.law[i, j, 0] * thick
                pairs[i, j] = (depth, width, stiffness, stiffness * area)
    return pairs


@pytest.mark.parametrize("name", CASES)
def test_at_rest_nothing_is_deeper_than_static(name):
    """At rest every contact carries what it carries in the static state next to it, to 5 %, and is as deep.

    What lies still goes on ringing by micrometres, about its static state: forces are means over a second. The static state
    is found from there with local damping. A force on a whole face of width L goes in by F/(k L); on an edge or corner its
    overlap is a triangle, at most 2 F/(k L) deep, with L the width of that overlap.
    """
    make, motion = CASES[name]
    engine = Loose(make(), DistinctElement2D(), motion, motion.duration, RESTITUTION)
    engine.start(0.4 * stable_step_of(engine))
    assert engine.settle()
    _, rests = follow(engine, RunOptions(until_rest=True, output_interval=0.05))
    assert rests
    lying, forces = contacts(engine), []
    for _ in range(50):
        engine.advance(max(1, round(0.02 / (CHUNK * engine.dt))))
        forces.append({pair: force for pair, (*_, force) in contacts(engine).items()})
    body, feed = engine.records.body, engine.records.feed
    before = body.copy()
    engine.records.lane["damp"][0, LOCAL] = 0.8
    feed["x"] = feed["z"] = 0
    for _ in range(100):
        engine.advance(100)
        if engine.residual_acceleration() < 1e-3:
            break
    assert engine.residual_acceleration() < 1e-3
    way = np.hypot(body["x"] - before["x"], body["z"] - before["z"])[:, 0]
    assert (way + engine.shape["r"] * np.abs(body["th"] - before["th"])[:, 0]).max() < 2e-4
    static = contacts(engine)
    assert set(lying) == set(static)
    for pair, (depth, width, stiffness, _) in lying.items():
        carried = static[pair][3]
        assert np.mean([sample.get(pair, 0.0) for sample in forces]) == pytest.approx(carried, rel=0.05)
        assert depth <= 1.05 * 2.0 * carried / (stiffness * width) + RINGING
    deepest, static_deepest = (max(depth for depth, *_ in state.values()) for state in (lying, static))
    assert deepest <= 1.05 * static_deepest + RINGING


@pytest.mark.parametrize("name", CASES)
def test_the_ledger_closes_through_a_whole_collapse(name):
    """Below 1 % of the potential energy that the fall released; measured 0.1 %, 0.03 %, 0.004 % and 0.06 %."""
    make, motion = CASES[name]
    response = simulate(make(), motion, DistinctElement2D(), until_rest=True, output_interval=0.02)
    assert response.at_rest
    assert response.collapsed
    released = -float(response.energy["gravitational"].min())
    assert released > 1e5
    assert abs(response.imbalance).max() < 0.01 * released
    for term in ("friction", "viscous"):  # a slip and a dashpot can only take energy
        taken = response.energy[term]
        assert np.diff(taken).min() > -1e-3 * taken.max()
