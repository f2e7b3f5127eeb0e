"""Drums that roll, skid, spin and lie, what leans and what reaches out, against closed forms."""

import math
from functools import cache

import numpy as np
from bodies_in_space import RADIUS, G, Lane, box, ground, lying, turn

from .row import Rows, both_sides, family, near


@family("drum_rolls_down")
def rolls_down(rows: Rows):
    """Speed and spin of a drum from rest over a second and a half, on a slope: gravity is turned instead.

    It begins to press all at once; restitution lets what rings then fade.
    """
    slope = math.radians(10.0)
    lane = Lane(ground(), lying(), gravity=(-G * math.sin(slope), 0.0, G * math.cos(slope)), restitution=0.5)
    times, seen = lane.run(1.5, lambda: (lane.velocity(1)[0], lane.spin(1)[1]))
    speed, spin = np.array(seen).T
    yield near(rows[0], np.polyfit(times, speed, 1)[0])
    yield near(rows[1], 1.5 * np.polyfit(times, spin, 1)[0])


@family("drum_coasts")
def coasts(rows: Rows):
    """Ten seconds on the level."""
    lane = Lane(ground(), lying(velocity=(1.0, 0.0, 0.0), spin=(0.0, 1.0 / RADIUS, 0.0)))
    lane.run(10.0)
    yield near(rows[0], lane.velocity(1)[0])


@family("skid_to_roll")
def skids(rows: Rows):
    """A drum that is thrown along without spin."""
    lane = Lane(ground(), lying(velocity=(2.0, 0.0, 0.0)), mu=0.3)
    times, seen = lane.run(0.3, lambda: (lane.velocity(1)[0], RADIUS * lane.spin(1)[1]))
    forward, rolling = np.array(seen).T
    yield near(rows[0], times[np.argmax(rolling > 0.9999 * forward)])
    yield near(rows[1], forward[-1])


@family("lying_drum_spins")
def spins(rows: Rows):
    """A drum on its side that turns about the vertical until it stops."""
    lane = Lane(ground(), lying(spin=(0.0, 0.0, 5.0)), restitution=0.5)
    times, seen = lane.run(0.42, lambda: lane.spin(1)[2])
    yield near(rows[0], times[np.argmax(np.array(seen) < 0.05)])
    yield near(rows[1], math.atan2(lane.axes(1)[1, 0], lane.axes(1)[0, 0]))


@family("drum_over_edge")
def over_edge(rows: Rows):
    """A drum that rolls over the edge of a block, leaves it and lands."""
    block = box((2.0, 3.0, 2.0), (-1.0, 0.0, 1.0), fixed=True)
    drum = lying((-0.01, 0.0, 2.0 + RADIUS), velocity=(0.3, 0.0, 0.0), spin=(0.0, 0.75, 0.0))
    lane = Lane(ground(), block, drum, step=8e-6, kn=5e12, restitution=0.5)
    _, seen = lane.run(1.4, lambda: (lane.contact(1, 2), *lane.place(2), *lane.velocity(2), *lane.spin(2)))
    area, x, _, z, *v, _, spin, _ = np.array(seen).T
    speed = np.hypot(v[0], v[2])
    departure = int(np.argmax((area == 0.0) & (x > 0.05)))
    angle = np.degrees(np.arctan2(x, z - 2.0))
    slips = int(np.argmax((x > 0.0) & (speed - RADIUS * spin > 0.002 * speed)))
    landed = x[np.argmax(z < RADIUS + 1e-3)]
    for row, ours in zip(
        rows, (angle[departure], speed[departure], spin[departure], landed, angle[slips]), strict=True
    ):
        why = (
            "the row gives no spread; taken where the edge slips by 0.2 % of the speed" if ours == angle[slips] else ""
        )
        yield near(row, ours, why=why)


@cache
def three_drums_stand(mu: float) -> bool:
    """Whether a lying drum stays on two."""
    law = np.empty((4, 4, 3))
    law[...] = 5e10, 2.5e10, mu
    law[0, :, 2] = 0.7
    height = RADIUS + 2.0 * RADIUS * math.sin(math.pi / 3.0)
    feet = [lying((x, 0.0, RADIUS)) for x in (-RADIUS, RADIUS)]
    lane = Lane(ground(), *feet, lying((0.0, 0.0, height)), law=law, restitution=0.3)
    lane.run(0.6)
    return bool(lane.place(3)[2] > height - 1e-3)


@family("three_lying_drums")
def three_drums(rows: Rows):
    """Friction between the drums on either side of the closed form."""
    yield both_sides(rows[0], three_drums_stand(0.29), three_drums_stand(0.25), "0.29|0.25")


@family("beam_leans_on_wall")
def beam_leans(rows: Rows):
    """Inclinations on either side of the closed form."""

    def holds(degrees: float) -> bool:
        turned = turn(0.0, -math.radians(degrees), 0.0)
        reach = np.abs(turned) @ np.array([2.0, 0.0, 0.4])
        wall = box((2.0, 4.0, 8.0), (1.0, 0.0, 4.0), fixed=True)
        lane = Lane(ground(), wall, box((4.0, 0.8, 0.8), (-reach[0], 0.0, reach[2]), turned), mu=0.4, restitution=0.3)
        lane.run(0.8)
        return bool(lane.place(2)[2] > reach[2] - 0.02)

    yield both_sides(rows[0], holds(40.6), holds(37.6), "40.6°|37.6°")


def slabs_stand(share: float, across: float) -> bool:
    """Whether five slabs that reach out stand; ``across`` 1 shifts them along y as well."""
    slabs, x = [], -0.5
    for k in range(5, 0, -1):
        x += share / (2.0 * k)
        slabs.append(box((1.0, 1.0, 0.2), (x, across * (x + 0.5), 0.1 + 0.2 * (5 - k))))
    block = box((4.0, 4.0, 1.0), (-2.0, -2.0 * across, -0.5), fixed=True)
    if across:  # a corner of the block carries, half a slab inside
        slabs = [slab._replace(place=slab.place - [0.0, 0.5, 0.0]) for slab in slabs]
    lane = Lane(block, *slabs, kn=5e12, step=1e-5, restitution=0.3)
    lane.run(0.5)
    return bool(lane.place(5)[2] > 0.899)


@family("overhang")
def overhang(rows: Rows):
    """The harmonic series."""
    yield both_sides(rows[0], slabs_stand(0.97, 0.0), slabs_stand(1.03, 0.0), "0.97|1.03")


@family("overhang_diagonal")
def overhang_diagonal(rows: Rows):
    """The same along both sides at once."""
    yield both_sides(rows[0], slabs_stand(0.96, 1.0), slabs_stand(1.03, 1.0), "0.96|1.03")
