"""Portals that rock, under pulses, and round columns that wobble under a slab."""

import math
import re
from functools import cache

import numpy as np
from bodies_in_space import G, Lane, box, cylinder, disc_face, faces_joined, portal, quarter, square_face, turn

import stylobate as st

from .limits import square_portal
from .row import MET, MISSED, Judged, Rows, both_sides, family, near

#: Stiffness of the joints of portals that rock [N/m³], their step [s], and tan α of the columns.
STIFF, STEP, SLENDER = 5e11, 2e-5, 0.2


def equivalent() -> float:
    """Frequency parameter of the equivalent block, of the bodies as the engine has them [rad/s]."""
    column, _, beam = square_portal().stones
    arm = math.hypot(0.4, 2.0)
    p2 = column.mass * G * arm / (column.inertia_tensor[1, 1] + column.mass * arm**2)
    share = beam.mass / (2.0 * column.mass)
    return math.sqrt(p2 * (1.0 + 2.0 * share) / (1.0 + 3.0 * share))


def impact_ratio() -> float:
    """Share of its velocity that the portal keeps in the first impact, from how far it leans before and after it."""
    slender = math.atan(SLENDER)
    lane = portal(0.5 * slender, STIFF, STEP)
    _, seen = lane.run(1.8, lambda: lane.axes(1)[0, 2])
    swings = [0.5 * slender, math.asin(-min(seen))]
    before, after = (math.cos(slender - swing) - math.cos(slender) for swing in swings)
    return math.sqrt(after / before)


@family("portal_rocking")
def portal_rocking(rows: Rows):
    """The equivalent block of Makris and Vassiliou (2013)."""
    yield near(rows[0], equivalent(), spread=1e-7 * float(rows[0]["value"]))
    kept, expected = impact_ratio(), float(rows[1]["value"])
    more = "a largest value: elastic contacts without damping keep more, as the row says"
    yield Judged(
        f"{kept:.4f}", f"{100.0 * (kept / expected - 1.0):+.2g} %", MET if kept >= expected - 5e-3 else MISSED, more
    )
    for row in rows[2:]:
        share, exact = float(re.search(r"at (\S+) of", row["params"])[1]), float(row["value"])
        lane = portal(share * math.atan(SLENDER), STIFF, STEP)
        times, lean = lane.run(1.05 * exact, lambda current=lane: current.axes(1)[0, 2])
        yield near(row, quarter(times, lean))


def pulse(share: float, duration: float, cycles: float) -> st.Motion:
    """Half a sine along the beam, or a whole one, in shares of gravity."""
    t = np.arange(0.0, duration + 1e-9, duration / 400.0)
    return st.Motion(duration / 400.0, share * G * np.sin(2.0 * np.pi * cycles * t / duration))


@cache
def under_pulse(share: float, duration: float, cycles: float) -> tuple[bool, float]:
    """Whether a portal falls, and the first peak of its rotation [rad]."""
    response = st.simulate(square_portal(), pulse(share, duration, cycles), st.DistinctElement3D(), tail=6.0)
    assert response.measures.outcome != st.Outcome.FAILED
    lean = np.abs(response.histories.poses.axis[:, 1, 0])
    peak = (
        (lean[1:-1] > np.maximum.accumulate(lean)[:-2] - 1e-12) & (lean[1:-1] > lean[2:] + 1e-9) & (lean[1:-1] > 1e-3)
    )
    first = int(np.argmax(peak)) + 1
    return bool(response.measures.blocks.fell_at), math.asin(lean[first])


@family("portal_pulse")
def portal_pulse(rows: Rows):
    """Verdicts, first peaks, and least amplitudes that overturn, on stiff joints that hold."""
    for row in rows:
        cycles = 0.5 if "half-sine" in row["params"] else 1.0
        if "least amplitude" in row["quantity"]:
            duration, expected = float(re.search(r"of (\S+) s", row["params"])[1]), float(row["value"])
            sides = [under_pulse(share * expected * SLENDER, duration, cycles)[0] for share in (0.99, 1.01)]
            yield both_sides(row, not sides[0], not sides[1], "0.99|1.01")
            continue
        share, duration = (float(number) for number in re.search(r"beam (\S+) g, (\S+) s", row["params"]).groups())
        falls, peak = under_pulse(share, duration, cycles)
        if row["quantity"] == "verdict":
            mine = "collapses" if falls else "stands"
            yield Judged(mine, "", MET if mine == row["value"] else MISSED)
        else:
            yield near(row, peak)


#: Of wobbling: stiffness [N/m³] and step [s]; tilt [rad] and first velocity [rad/s].
WOBBLING, WOBBLING_STEP, TILT, PUSH = 5e12, 1e-5, 0.1, 0.1


def wobbling(feet, slab: float, free: bool):
    """Round columns that lean and turn about their lower contacts, under a slab of so many masses of one column.

    A slab that is not free can only translate: its moments of inertia are without end.
    """
    turned = turn(0.0, TILT, 0.0)
    spin = np.array([PUSH, 0.0, 0.0])
    arm = turned @ np.array([-0.4, 0.0, 2.0])
    columns = [
        cylinder(0.4, 4.0, np.array([x + 0.4, y, 0.0]) + arm, turned, np.cross(spin, arm), spin) for x, y in feet
    ]
    base = box((30.0, 30.0, 1.0), (0.0, 0.0, -0.5), fixed=True)
    joints = [
        faces_joined(0, 1 + k, square_face(14.0, 0.5), disc_face(0.4, -2.0, up=False), WOBBLING, mu=50.0)
        for k in range(len(feet))
    ]
    bodies = [base, *columns]
    if slab:
        high = turned @ np.array([-0.8, 0.0, 4.0])
        middle = np.mean([[x + 0.4, y, 0.0] for x, y in feet], axis=0) + high
        sides = (3.4, 3.4, slab * columns[0].mass / (2700.0 * 3.4**2))
        slab_body = box(sides, middle + np.array([0.0, 0.0, 0.5 * sides[2]]), velocity=np.cross(spin, high))
        bodies.append(slab_body if free else slab_body._replace(inertia=1e12 * np.eye(3)))
        under = square_face(1.7, -0.5 * sides[2], up=False)
        joints += [
            faces_joined(1 + k, len(bodies) - 1, disc_face(0.4, 2.0), under, WOBBLING, mu=50.0)
            for k in range(len(feet))
        ]
    return Lane(*bodies, kn=WOBBLING, mu=50.0, joints=joints, step=WOBBLING_STEP)


@cache
def frame(slab: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Times [s], tilts and azimuths of the lean [rad], and the travel of the slab [m]."""
    lane = wobbling([(0.0, 0.0)], slab, free=False)
    start = lane.place(2) if slab else np.zeros(3)
    times, seen = lane.run(3.05, lambda: (*lane.axes(1)[:2, 2], *((lane.place(2) - start)[:2] if slab else (0.0, 0.0))))
    x, y, *travel = np.array(seen).T
    return times, np.arcsin(np.hypot(x, y)), np.unwrap(np.arctan2(y, x)), np.array(travel).T


@family("wobbling_frame")
def wobbling_frame(rows: Rows):
    """A column that rolls below and above under a slab that can only translate, with friction that holds."""
    for row in rows:
        slab = float(re.search(r"slab of (\S+) column", row["params"])[1])
        times, tilt, azimuth, travel = frame(slab)
        if "first least tilt" in row["quantity"]:
            least = 1 + int(np.argmax((tilt[1:-1] < tilt[:-2]) & (tilt[1:-1] < tilt[2:]) & (times[1:-1] > 0.3)))
            yield near(row, times[least] if row["quantity"].startswith("time") else tilt[least])
            continue
        when = float(re.search(r"at (\S+) s", row["quantity"])[1])
        k = int(np.argmin(np.abs(times - when)))
        yield near(row, travel[k] if "travel" in row["quantity"] else azimuth[k])


@family("wobbling_podium")
def wobbling_podium(rows: Rows):
    """Four such columns under a slab that is free."""
    lane = wobbling([(x, y) for x in (-1.2, 1.2) for y in (-1.2, 1.2)], 1.2, free=True)
    start = lane.place(5)
    lane.run(0.8)
    yield near(rows[0], (lane.place(5) - start)[:2])
