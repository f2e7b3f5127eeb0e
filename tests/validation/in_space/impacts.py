"""What falls and strikes: drums and a beam on the ground, a monolith on its twin, rows of dominoes."""

import math
from functools import cache

import numpy as np
from bodies_in_space import RADIUS, G, Lane, after_impact, box, cylinder, faces_joined, ground, square_face, turn

from .row import MET, MISSED, Judged, Rows, family, near

#: A base that holds an edge during a blow, and a contact that is struck [N/m³].
STIFF, SOFT = 5e12, 5e9


@family("drop_flat")
def drop_flat(rows: Rows):
    """First rebound, and when bouncing ends."""
    lane = Lane(ground(), cylinder(RADIUS, 0.5, (0.0, 0.0, 0.45)), restitution=0.5)
    times, seen = lane.run(0.7, lambda: (lane.place(1)[2] - 0.25, lane.velocity(1)[2]))
    z, v = np.array(seen).T
    first = np.argmax(v > 0.5)
    yield near(rows[0], z[first : first + 200].max())
    yield near(rows[1], times[np.nonzero(np.abs(v) > 0.02)[0][-1]])


@family("drop_on_rim")
def drop_on_rim(rows: Rows):
    """The rigid impulse on a rim."""
    turned = turn(0.0, math.radians(20.0), 0.0)
    low = (turned @ [0.5, 0.0, -0.25])[2]
    drum = cylinder(0.5, 0.5, (0.0, 0.0, 0.02 - low), turned, velocity=(0.0, 0.0, -math.sqrt(2.0 * G * 0.28)))
    lane = Lane(ground(), drum, kn=5e12, mu=1e-9, restitution=0.5, step=4e-6)
    spin, up = after_impact(lane, lambda: (np.linalg.norm(lane.spin(1)), lane.velocity(1)[2]))
    yield near(rows[0], spin)
    yield near(rows[1], up, of=math.sqrt(2.0 * G * 0.3))


@family("drop_on_corner")
def drop_on_corner(rows: Rows):
    """The rigid impulse on a corner, in three dimensions."""
    turned = turn(0.0, math.radians(12.0), 0.0) @ turn(math.radians(10.0), 0.0, 0.0)
    low = -(np.abs(turned) @ [1.6, 0.4, 0.3])[2]
    beam = box((3.2, 0.8, 0.6), (0.0, 0.0, 0.02 - low), turned, velocity=(0.0, 0.0, -math.sqrt(2.0 * G * 0.48)))
    lane = Lane(ground(), beam, kn=5e12, mu=1e-9, restitution=0.4, step=4e-6)
    spin, up = after_impact(lane, lambda: (lane.spin(1), lane.velocity(1)[2]))
    yield near(rows[0], spin)
    yield near(rows[1], up, of=math.sqrt(2.0 * G * 0.5))


def row_of_blocks(width, height, clear, count, tilt, bases, contact, restitution, step, spin=0.0, deep=0.8):
    """Blocks in a row whose bases hold, the first leaning towards the others; no friction between them."""
    lean = turn(0.0, tilt, 0.0)
    place = lean @ np.array([-0.5 * width, 0.0, 0.5 * height])
    law = np.full((count + 1, count + 1, 3), 50.0)
    law[:, :, :2] = contact, 0.5 * contact
    law[1:, 1:, 2] = 0.0
    law[0, :, :2] = bases, 0.5 * bases
    pitch = width + clear
    half = 0.5 * width
    blocks = [box((width, deep, height), place, lean, np.cross([0.0, spin, 0.0], place), (0.0, spin, 0.0))]
    blocks += [box((width, deep, height), (k * pitch - half, 0.0, 0.5 * height)) for k in range(1, count)]
    base = box((2.5 * count * pitch, 20.0 * width, 10.0 * height), (0.0, 0.0, -5.0 * height), fixed=True)
    face = square_face(half, -0.5 * height)
    face = face._replace(corners=face.corners * [1.0, deep / width])
    joints = [
        faces_joined(0, k + 1, square_face(2.0 * width, 5.0 * height, x=k * pitch - half), face, bases, mu=50.0)
        for k in range(1, count)
    ]
    return Lane(base, *blocks, joints=joints, law=law, restitution=restitution, step=step)


@cache
def falls_onto_twin() -> float:
    """Velocity of a monolith from rest just before it touches its twin [rad/s]."""
    lane = row_of_blocks(0.8, 4.0, 1.0, 2, 0.21, STIFF, SOFT, 0.0, 4e-6)
    before = math.nan
    while lane.contact(1, 2) == 0.0:
        before = float(lane.spin(1)[1])
        lane.advance(1)
    return before


@cache
def twin(restitution: float) -> float:
    """Share of the velocity of what comes that its twin has after the blow [-].

    It comes ten times as fast as it would fall, so that gravity has no part in the blow: the share is the same.
    """
    lane = row_of_blocks(0.8, 4.0, 1.0, 2, math.asin(0.25) - 0.004, STIFF, SOFT, restitution, 4e-6, spin=1.0)
    lane.run(0.034)
    return float(lane.spin(2)[1])


def twin_overturns(spin: float) -> bool:
    """Whether a monolith that turns about its edge with a velocity goes over [rad/s]."""
    lane = row_of_blocks(0.8, 4.0, 1.0, 1, 1e-4, STIFF, STIFF, 0.0, 4e-6, spin=spin)
    while 0.0 < lane.axes(1)[0, 2] < math.sin(0.25) and lane.time < 6.0:
        lane.advance(64)
    return bool(lane.axes(1)[0, 2] > 0.2)


@family("falling_hits_twin")
def falling_hits_twin(rows: Rows):
    """On bases that hold, a thousand times as stiff as the contact."""
    comes = falls_onto_twin()
    yield near(rows[0], comes)
    for row, restitution in zip(rows[1:3], (0.0, 0.5), strict=True):
        why = f"bases {STIFF / SOFT:.0f} times as stiff as the contact: softer ones give way during the blow"
        yield near(row, comes * twin(restitution), why=why)
    limit = float(rows[3]["value"])
    low, high = (twin_overturns(share * limit) for share in (0.99, 1.01))
    verdict = MET if high and not low else MISSED
    words = {True: "overturns", False: "comes back"}
    yield Judged(
        f"0.99: {words[low]}, 1.01: {words[high]}", "", verdict, "the row gives no spread; taken as one per cent"
    )


def impacts_of(lane, count: int, most: float) -> list[float]:
    """Times at which each block of a row is first struck by the one before it [s]."""
    struck: list[float] = []
    while len(struck) < count - 1 and lane.time < most:
        k = len(struck)
        if lane.contact(k + 1, k + 2) > 0.0:
            struck.append(lane.time)
            continue
        lane.advance(1)
    assert not lane.failed
    return struck


@cache
def dominoes(width: float, height: float, clear: float, count: int, steady: bool) -> list[float]:
    """Speeds from impact to impact [m/s]; for the steady one the first block begins with a velocity that spares time."""
    small = height / 4.0
    # a base that gives way lets the first step of the tall ones, the slowest, be faster: 1.5 % at a tenth of this stiffness
    bases = (1.0 if steady or small < 1.0 else 10.0) * STIFF * small / (width / 0.8)
    contact = bases * SOFT / STIFF
    tilt = math.atan(width / height) + 1e-3
    spin = 1.0 / math.sqrt(small) if steady else 0.0
    step = 4e-6 * math.sqrt(small * STIFF / bases)
    lane = row_of_blocks(width, height, clear, count, tilt, bases, contact, 0.0, step, spin=spin, deep=width)
    times = impacts_of(lane, count, 12.0 * math.sqrt(small))
    return [float(speed) for speed in (width + clear) / np.diff(times)]


@family("dominoes")
def rows_of_dominoes(rows: Rows):
    """Six blocks from rest, and twenty-four for the steady speed."""
    sizes = {"4.0": (0.8, 4.0, 1.2), "0.05": (0.0075, 0.05, 0.02)}
    for row in rows:
        size = next(dimensions for high, dimensions in sizes.items() if f"blocks {high} high" in row["params"])
        if "steady" in row["quantity"]:
            yield near(row, float(np.mean(dominoes(*size, 24, True)[-6:])), why="mean of the last six of 24 blocks")
        else:
            yield near(row, dominoes(*size, 6, False)[int(row["quantity"].split()[3]) - 1])
