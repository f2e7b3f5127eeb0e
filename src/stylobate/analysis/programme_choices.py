"""Of the many answers of a programme of contacts: the gentlest mechanism, and the most that a holder may hold."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .contact_programme import MOST_WITHIN, Aim, ContactProgramme, EndlessError, Solved, pointing

#: By how much the work of a mechanism may differ from that of the multiplier [g].
SLACK = 1e-7

#: Directions at most in which the force of a holder is made as large as it can be.
DIRECTIONS = 32


def gentlest(programme: ContactProgramme, dead: np.ndarray, live: np.ndarray, found: Solved) -> np.ndarray:
    """Velocities of the mechanism of a multiplier in which joints slip and twist least, shape (n, 6).

    Where several do the same work the one that a solver hands out is any of them; of what holds bodies it is that one.
    """
    from scipy.optimize import linprog
    from scipy.sparse import csr_array, eye_array, hstack, vstack

    if programme.holders:
        return found.rates
    known, moves = programme.matrix().T, _moves(programme)
    count = 3 * len(programme.rims)
    each = eye_array(count)
    power = hstack((csr_array(-dead[None]), csr_array((1, count))))
    rows = vstack(
        (
            hstack((-known, csr_array((len(programme.rows), count)))),
            hstack((moves, -each)),
            hstack((-moves, -each)),
            power,
        )
    )
    bound = np.append(np.zeros(len(programme.rows) + 2 * count), found.multiplier + SLACK)
    size = 6 * programme.n
    solved = linprog(
        np.append(np.zeros(size), np.ones(count)),
        A_ub=rows.tocsr(),
        b_ub=bound,
        A_eq=hstack((csr_array(live[None]), csr_array((1, count))), "csr"),
        b_eq=[1.0],
        bounds=[(None, None)] * size + [(0.0, None)] * count,
        method="highs",
    )
    return solved.x[:size].reshape(-1, 6) if solved.status == 0 else found.rates


def largest_held(
    programme: ContactProgramme, dead: np.ndarray, live: np.ndarray, multiplier: float, k: int
) -> tuple[float, np.ndarray | None]:
    """The most that a holder holds in any answer at a multiplier [g] or more [N], and where it pulls its upper body.

    What it can hold in two directions makes a convex figure, which tangents enclose: in each direction the programme
    tells how far it reaches, and the farthest corner of the tangents is the next direction, until what is reached is as
    far but for :data:`MOST_WITHIN`. Infinite, without a direction, where nothing limits it.
    """
    one, capacity, first = programme.holders[k], programme.capacities, len(programme.rows)
    count = one.axes.shape[1]
    ways = [np.ones(1)] if count == 1 else [pointing(0.5 * math.pi * i) for i in range(4)]
    reach: list[tuple[np.ndarray, float]] = []
    best = np.zeros(count)
    try:
        while ways and len(reach) < DIRECTIONS:
            way = ways.pop()
            found = programme.converged(dead, live, capacity, aim=Aim(k, way, multiplier))
            force = programme.held_by(found.forces, k)
            programme.forget(first, found.forces)
            best = force if np.linalg.norm(force) > np.linalg.norm(best) else best
            reach.append((way, float(way @ force)))
            size = float(np.linalg.norm(best))
            if size >= one.capacity * (1.0 - MOST_WITHIN):
                break
            if not ways and count == 2:
                corner = max(_corners(reach), key=np.linalg.norm)
                far = float(np.linalg.norm(corner))
                ways = (
                    [corner / far] if far > size * (1.0 + MOST_WITHIN) + MOST_WITHIN * 1e-3 * programme.weight else []
                )
    except EndlessError:
        return math.inf, None
    size = float(np.linalg.norm(best))
    return size, one.axes @ best / size if size > 0.0 else None


def _moves(programme: ContactProgramme) -> Any:
    """What makes slips along both axes of the joints and twists at their edge of velocities, shape (3 joints, 6 n)."""
    from scipy.sparse import csr_array

    out = np.zeros((3 * len(programme.rims), 6 * programme.n))
    for j, rim in enumerate(programme.rims):
        for body, sign in ((rim.upper, 1.0), (rim.lower, -1.0)):
            if body < 0:
                continue
            part = slice(6 * body, 6 * body + 6)
            arm = rim.in_space(rim.middle) - programme.centroids[body]
            for k, way in enumerate(rim.frame.T[:2]):
                out[3 * j + k, part] = sign * np.append(way, np.cross(arm, way) / programme.length)
            out[3 * j + 2, 6 * body + 3 : 6 * body + 6] = sign * rim.half / programme.length * rim.frame[:, 2]
    return csr_array(out)


def _corners(reach: list[tuple[np.ndarray, float]]) -> list[np.ndarray]:
    """Corners of the figure that tangents enclose, each across a direction and so far along it."""
    turned = sorted(reach, key=lambda one: math.atan2(*one[0][::-1]))
    pairs = zip(turned, [*turned[1:], turned[0]], strict=True)
    return [np.linalg.solve(np.array([a, b]), (far, away)) for (a, far), (b, away) in pairs]
