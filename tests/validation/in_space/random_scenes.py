"""Scenes of dry stones in space, each drawn by a number, with a motion; how they are turned; stones that tumble."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np

import stylobate as st
from stylobate.column.shapes import Placed, matrix_of, product
from stylobate.column.spatial.stone import box_shape, drum_shape

DENSITY = 2700.0


def support(rng, width, height, at, name, kinds="bdhc"):
    """A stone of a kind that is drawn: a box, a drum, a prism of six sides, or a shaft with a square abacus in one body."""
    kind, named = rng.choice(list(kinds)), {"density": DENSITY, "name": name}
    if kind == "b":
        return st.Stone.box((width, width * rng.uniform(0.9, 1.2), height), at, **named)
    if kind == "d":
        return st.Stone.drum(width * rng.uniform(1.0, 1.1), width, height, at, **named)
    if kind == "h":
        around = 0.5 * width * np.array([(math.cos(a), math.sin(a)) for a in np.arange(6) * math.pi / 3.0])
        return st.Stone.hull([(x + at[0], y + at[1], at[2] + z) for x, y in around for z in (0.0, height)], **named)
    shaft, abacus = drum_shape(width, width, 0.75 * height, name), box_shape((width, width, 0.25 * height), name)
    parts = Placed(shaft, (0.0, 0.0, 0.375 * height)), Placed(abacus, (0.0, 0.0, 0.875 * height))
    middle = st.Stone(parts, (0.0, 0.0, 0.0), DENSITY).moments.centroid
    return st.Stone(parts, tuple(float(c) for c in middle + at), **named)


def pillar(rng, at, width, height, tag):
    """One to three stones of one kind on one another."""
    count = int(rng.integers(1, 4))
    kind = str(rng.choice(list("bdh")))
    h = height / count
    stones = [support(rng, width, h, (*at, h * i), f"{tag}{i}", kind) for i in range(count - 1)]
    return [*stones, support(rng, width, h, (*at, h * (count - 1)), f"{tag}{count - 1}", kind + "c")]


def colonnade(rng, count):
    """Pillars in a row and beams from axis to axis."""
    width, height, span = rng.uniform(0.6, 0.9), rng.uniform(2.5, 4.0), rng.uniform(1.8, 2.6)
    stones = [stone for k in range(count) for stone in pillar(rng, (span * k, 0.0), width, height, f"{'abcd'[k]}")]
    for k in range(count - 1):
        low, high = (span * (k + side) for side in (0, 1))
        low, high = low - (0.4 * width if k == 0 else -0.001), high + (0.4 * width if k == count - 2 else -0.001)
        stones.append(
            st.Stone.box((high - low, 0.8 * width, 0.5), (0.5 * (low + high), 0, height), DENSITY, name=f"beam {k}")
        )
    return stones


def portal(rng):
    return colonnade(rng, 2)


def row_of_columns(rng):
    return colonnade(rng, int(rng.integers(3, 5)))


def dominoes(rng):
    """Stones in a row, some a little beside it."""
    width, height, gap = rng.uniform(0.4, 0.6), rng.uniform(2.0, 3.0), rng.uniform(0.3, 0.8)
    places = [((width + gap) * k, rng.uniform(-0.1, 0.1), 0.0) for k in range(int(rng.integers(3, 7)))]
    return [support(rng, width, height, at, f"stone {k}", "bbhc") for k, at in enumerate(places)]


def heap(rng):
    """Two or three cairns beside each other on one slab."""
    count, stones = int(rng.integers(2, 4)), []
    for k in range(count):
        x, y, z = 0.95 * (k - 0.5 * (count - 1)), 0.0, 0.4
        for i in range(int(rng.integers(2, 4))):
            tall, width = rng.uniform(0.3, 0.9), rng.uniform(0.5, 0.8) * 0.85**i
            stones.append(support(rng, width, tall, (x, y, z), f"cairn {k}.{i}"))
            x, y, z = x + rng.uniform(-0.06, 0.06), y + rng.uniform(-0.06, 0.06), z + tall
    return [st.Stone.box((0.95 * count + 0.3, 1.2, 0.4), (0, 0, 0), DENSITY, name="slab"), *stones]


def arch(rng):
    """A semicircular one of seven to eleven voussoirs."""
    count, radius, deep = int(rng.integers(7, 12)), rng.uniform(1.5, 3.0), rng.uniform(0.5, 1.0)
    thick = radius * rng.uniform(0.15, 0.25)
    return [
        st.Stone.hull(
            [
                (q * math.cos(a), y, q * math.sin(a))
                for q in (radius - 0.5 * thick, radius + 0.5 * thick)
                for a in (math.pi * k / count, math.pi * (k + 1) / count)
                for y in (-0.5 * deep, 0.5 * deep)
            ],
            DENSITY, name=f"voussoir {k}",
        )
        for k in range(count)
    ]  # fmt: skip


def wall(rng):
    """Running bond, with a drum beside it."""
    courses, bricks, long, thick, high = int(rng.integers(3, 6)), 3, rng.uniform(0.6, 0.8), 0.35, rng.uniform(0.25, 0.4)
    stones = []
    for course in range(courses):
        edges = [0.0, *(long * (k + 1 - 0.5 * (course % 2)) for k in range(bricks)), bricks * long]
        for low, end in pairwise(edges):
            if end > low + 1e-9:
                stones.append(
                    st.Stone.box(
                        (end - low, thick, high), (0.5 * (low + end), 0.0, course * high),
                        DENSITY, name=f"brick {course}.{len(stones)}",
                    )
                )  # fmt: skip
    return [*stones, st.Stone.drum(0.5, 0.45, 1.5, (0.5 * bricks * long, 0.9, 0.0), DENSITY, name="drum")]


FAMILIES = (portal, dominoes, heap, row_of_columns, arch, wall)

#: Range of the motion's size [g] for each.
SIZES = ((0.3, 0.7), (0.3, 0.7), (0.4, 1.0), (0.3, 0.7), (0.4, 1.2), (0.4, 1.0))


def scene(number):
    """Name, stones and motion of the scene of a number."""
    rng, which = np.random.default_rng([25, number]), number % len(FAMILIES)
    stones = FAMILIES[which](rng)
    size = rng.uniform(*SIZES[which])
    return FAMILIES[which].__name__, stones, motion(rng, size)


def motion(rng, size):
    """A pulse from any side, or two sines of other frequencies along x and y, with a cycle of ramp at either end."""
    dt = 0.004
    if rng.random() < 0.5:
        period, azimuth = rng.uniform(0.5, 1.2), rng.uniform(0.0, 2.0 * math.pi)
        t = np.arange(0.0, period + 0.5 * dt, dt)
        a = size * 9.81 * np.sin(2.0 * math.pi * t / period)
        return st.Motion(dt, math.cos(azimuth) * a, lateral=math.sin(azimuth) * a)
    first, second = rng.uniform(0.8, 2.0, 2)
    t = np.arange(0.0, 4.0 / min(first, second), dt)

    def sine(share, f):
        n = np.minimum(t * f, 4.0)
        return share * size * 9.81 * np.sin(2.0 * math.pi * n) * np.minimum(1.0, np.minimum(n, 4.0 - n))

    return st.Motion(dt, sine(1.0, first), lateral=sine(rng.uniform(0.4, 1.0), second))


def turned(stones, shaking, angle, order):
    """The same scene turned about the vertical by an angle [rad], and in another order."""
    spin = (math.cos(0.5 * angle), 0.0, 0.0, math.sin(0.5 * angle))
    axes, (c, s) = matrix_of(spin), (math.cos(angle), math.sin(angle))
    there = [
        replace(
            stones[i],
            position=tuple(float(x) for x in axes @ stones[i].position),
            orientation=product(spin, stones[i].orientation),
        )
        for i in order
    ]
    x, y = shaking.samples * shaking.factor, shaking.y_samples * shaking.factor
    return there, st.Motion(shaking.dt, c * x - s * y, lateral=s * x + c * y)


def tumble(number, count=10):
    """Stones of all kinds in the air, that move and turn, over one another."""
    rng, stones = np.random.default_rng([26, number]), []
    for i in range(count):
        stone = support(rng, rng.uniform(0.3, 0.6), rng.uniform(0.3, 0.8), (0.0, 0.0, 0.0), f"stone {i}")
        spin = rng.normal(size=4)
        stones.append(
            replace(
                stone,
                position=(*(float(x) for x in rng.uniform(-0.4, 0.4, 2)), 1.0 + 1.4 * i),
                orientation=tuple(float(x) for x in spin / np.linalg.norm(spin)),
                velocity=tuple(float(x) for x in rng.normal(size=3)),
                angular_velocity=tuple(float(x) for x in rng.normal(size=3)),
            )
        )
    return stones
