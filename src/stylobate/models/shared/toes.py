"""Energy of joints when the part above one of them stands on its edge: soft joints overturn with less than rigid ones.

Two numbers of each joint, shape (2, n): what it gives itself with its load on its edge, and what all others do under the
moments that they carry then.  # Eq. (V5)
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...column import Column

#: Turns of joints by shares of their largest moments [rad], and energies that they store by their turns [J]; shapes (n, k).
Bending = tuple[Callable[[np.ndarray], np.ndarray], Callable[[np.ndarray], np.ndarray]]

#: The toe's laws are those of a short arc: with this factor they bound what a true one gives.
SHORT_ARC = 1.05

#: Of the half width of a face that a chip leaves less of, this much is reckoned with [-]: its toe is beyond all barriers.
LEAST_LEFT = 0.1

#: Most rounds in which the moments of soft joints follow from their turns, and a change of one that is none any more [-].
ROUNDS, CLOSE = 300, 1e-6


def rim_toes(column: Column, kn: np.ndarray) -> np.ndarray:
    """By how much gravitational and elastic energy are less with the weight on the edge of each joint than rigidly [J].

    Beyond what the closed joint gives under the same weight; and by what the others do, shape (2, n). A toe on a spring of
    N ∝ eᵖ that is pressed by e lowers the energy by N e p/(p + 1). Here of joints that carry on their rim.

    Parameters
    ----------
    column : Column
    kn : array
        Normal stiffness per area [N/m³], shape (n,).
    """
    weight, radius = column.joint_weights, 0.5 * column.joint_widths
    height = column.parts_above[1]
    # N = 4/3 k_n (R/2) R √2 e^1.5 / √(R sin α)
    stiffness = (2.0 * np.sqrt(2.0) / 3.0) * kn * radius**2 / np.sqrt(radius * radius / np.hypot(radius, height))
    toes = SHORT_ARC * 0.6 * weight * (weight / stiffness) ** (2.0 / 3.0) - _closed(column, kn)
    return _with_others(column, toes, _of_discs(column, kn, on_rims()))


def bed_toes(column: Column, kn: np.ndarray) -> np.ndarray:
    """As :func:`rim_toes`, of joints on an elastic bed; of rings the toe is found from the law itself."""
    if column.on_rings:
        rings = np.array([_ring_toe(column, float(kn[j]), j) for j in range(column.n)])
        toes = rings - _closed(column, kn)
        return _with_others(column, toes, _by_square(column, toes))
    weight, radius = column.joint_weights, 0.5 * column.joint_widths
    # N = 8 √2/15 k_n √R e^2.5 / (tan α)^1.5
    steepness = (column.parts_above[1] / radius) ** 1.5
    stiffness = (8.0 * np.sqrt(2.0) / 15.0) * kn * np.sqrt(radius) * steepness
    toes = SHORT_ARC * 5.0 / 7.0 * weight * (weight / stiffness) ** 0.4 - _closed(column, kn)
    return _with_others(column, toes, _of_discs(column, kn, on_beds()))


def _ring_toe(column: Column, kn: float, j: int) -> float:
    """By how much the toe of a ring under the weight above lowers the energy [J]: its depth is found by bisection."""
    weight, outer = float(column.joint_weights[j]), 0.5 * float(column.joint_widths[j])
    inner, slope = 0.5 * max(column.sunken_widths(j)), outer / float(column.parts_above[1][j])

    def carried(toe: float) -> tuple[float, float]:
        force, stored = disc_on_bed(kn, outer, toe - slope * outer, slope)
        less = disc_on_bed(kn, inner, toe - slope * outer, slope) if inner > 0.0 else (0.0, 0.0)
        return force - less[0], stored - less[1]

    low, high = 0.0, 1e-9
    while carried(high)[0] < weight:
        high *= 2.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if carried(middle)[0] < weight else (low, middle)
    return SHORT_ARC * (weight * high - carried(high)[1])


def disc_on_bed(kn: float, radius: float, depth: float, slope: float) -> tuple[float, float]:
    """Force [N] and elastic energy [J] of a disc on an elastic bed without tension, in closed form.  # Eq. (E11)

    Parameters
    ----------
    kn : float
        Stiffness per area [N/m³].
    radius : float
        [m]
    depth : float
        Of the disc's middle [m]; negative above the bed.
    slope : float
        Change of depth along the steepest descent [-].
    """
    edge = slope * radius
    x = min(max(-depth / max(edge, 1e-300), -1.0), 1.0)
    w, angle = math.sqrt(1.0 - x * x), math.acos(x)
    area, first = angle - x * w, 2.0 / 3.0 * w**3
    second = 0.25 * (angle + x * w * (1.0 - 2.0 * x * x))
    force = kn * radius**2 * (depth * area + edge * first)
    return force, 0.5 * kn * radius**2 * (depth * depth * area + 2.0 * depth * edge * first + edge * edge * second)


def point_toes(
    column: Column, kn: np.ndarray, share: float | np.ndarray, crushed: float | np.ndarray = 0.0
) -> np.ndarray:
    """As :func:`rim_toes`, of joints whose edge has a share of the joint's stiffness: a corner, the last of some points.

    ``crushed`` is what crushing takes beside that [J].
    """
    closed = _closed(column, kn)
    toes = SHORT_ARC * closed / share - closed + crushed
    return _with_others(column, toes, _by_square(column, toes))


def _by_square(column: Column, toes: np.ndarray) -> Bending:
    """Joints give more than in proportion to the square of their moment: the toe's energy bounds it."""
    most, toes = (column.joint_weights * 0.5 * column.joint_widths)[:, None], toes[:, None]
    full = 2.0 * toes / most

    def storing(turn: np.ndarray) -> np.ndarray:
        return most * np.where(turn < full, 0.5 * turn**2 / np.maximum(full, 1e-300), turn - 0.5 * full)

    return lambda share: full * share, storing


def _of_discs(column: Column, kn: np.ndarray, law: tuple[np.ndarray, np.ndarray]) -> Bending:
    """Discs by the force and the lever of their law."""
    turn, lever = (
        law[0][-1] / law[0][::-1],
        law[1][::-1],
    )  # over the turn at which a joint begins to open, and the radius
    stored = 0.5 * lever[0] + np.append(0.0, np.cumsum(0.5 * (lever[1:] + lever[:-1]) * np.diff(turn)))
    half = 0.5 * column.joint_widths
    most, first = column.joint_weights * half, column.joint_weights / (kn * column.joint_areas * half)
    most, first, edge = most[:, None], first[:, None], (half / column.parts_above[1])[:, None]

    def turning(share: np.ndarray) -> np.ndarray:
        over = np.where(share <= lever[0], share / lever[0], np.interp(share, lever, turn))
        return np.minimum(first * over, edge)  # none turns by more than puts the part above on its edge

    def storing(turned: np.ndarray) -> np.ndarray:
        over = turned / first
        beyond = np.interp(over, turn, stored) + lever[-1] * np.maximum(over - turn[-1], 0.0)
        return most * first * np.where(over <= 1.0, 0.5 * lever[0] * over**2, beyond)

    return turning, storing


def _with_others(column: Column, toes: np.ndarray, bending: Bending) -> np.ndarray:
    """What each joint gives, and what all others do with the part above it on its edge [J], shape (2, n).

    With moments M on the joints the parts above lean, and joints turn, by r = L⁻¹ M, L_ij = g B_max(i,j), B the mass above
    times the height of its centroid. The energy over rest is V = Σ U_i(r_i) − ½ Mᵀ r, of all M_j = W_j b_j least where the
    others bear these moments, M_i = U_i'(r_i). On rigid joints that is for M = L_j W_j b_j/L_jj; what is told here is how
    much less it is on these. What joints turn makes moments larger: they rise from those on rigid joints, as L less what
    holds M_j has no negative entry.  # Eq. (V5)
    """
    mass, height = column.parts_above
    most, order = column.joint_weights * 0.5 * column.joint_widths, np.arange(column.n)
    leaning = column.gravity * (mass * height)[np.maximum.outer(order, order)]
    least = _least(leaning, most, bending)
    others = SHORT_ARC * np.maximum(0.5 * most**2 / leaning.diagonal() - least, 0.0)
    # Faces that chips leave smaller give more: their largest moment is smaller as their smallest half width is, and their
    # area by no more than the square of that.
    chips = np.array([max(column.as_found.of(i + 1).chips) for i in range(column.n)])
    remaining = 1.0 - chips / np.array([0.5 * min(drum.bottom_width, drum.depth) for drum in column.drums])
    more = np.maximum(remaining, LEAST_LEFT) ** -4
    return np.stack((toes * more, others * more.max()))


def _least(leaning: np.ndarray, most: np.ndarray, bending: Bending) -> np.ndarray:
    """Least V with each part on its edge, but for what that joint gives [J], shape (n,).

    Where another joint would come to its edge before, a column does not pass M_j = ϑ W_j b_j for less either, ϑ < 1: the
    largest ϑ that leaves the others closed enough is taken. Minus infinity where half of the moment does not.
    """
    order, ways = np.arange(len(most)), leaning / leaning.diagonal()  # column j: with part j on its edge
    shares = np.ones(len(most))
    while True:
        moments, turns = ways * (shares * most), np.zeros_like(leaning)
        for _ in range(ROUNDS):
            before, turns = turns, bending[0](np.minimum(moments / most[:, None], 1.0))
            turns[order, order] = 0.0
            borne = leaning @ turns
            moments = ways * (shares * most - borne.diagonal()) + borne
            if np.abs(turns - before).max() < CLOSE * np.abs(turns).max(initial=0.0):
                break
        beyond = (moments - np.diag(moments.diagonal()) >= most[:, None]).any(axis=0)
        shares = np.where(beyond, shares - 0.05, shares)
        if not beyond.any() or shares.min() < 0.5:
            break
    turns = np.linalg.solve(leaning, moments)
    stored = bending[1](np.abs(turns))
    stored[order, order] = shares * most * turns.diagonal()
    return np.where(beyond, -math.inf, (stored - 0.5 * moments * turns).sum(axis=0))


def _closed(column: Column, kn: np.ndarray) -> np.ndarray:
    return column.joint_weights**2 / (2.0 * kn * column.joint_areas)


# Static acceleration that rocks a column on soft joints: its toe lets the pivot in, and what has sunk there leans it.


class Opening(NamedTuple):
    """What rocks a column as built, joint by joint the least.

    Parameters
    ----------
    acceleration, rigid : float
        Largest static acceleration that it stands [m/s²], on its joints and if they were rigid.
    toe : float
        How far its pressed part reaches in from the edge then, over the joint's width [-].
    joint : int
        Which joint, from 1.
    """

    acceleration: float
    rigid: float
    toe: float
    joint: int


#: Half of the angle that the touching part of a round face's rim takes up [rad].
PRESSED = np.linspace(0.02, np.pi, 800)


def on_rims() -> tuple[np.ndarray, np.ndarray]:
    """Force over k_n R³ times the tilt, and its lever from the middle over R, of a rim pressed as far as ``PRESSED``.

    The rim carries k_n R/2 per length, its depth is R θ (cos φ − cos φ₀).  # Eqs. (E1), (E3)
    """
    s, c = np.sin(PRESSED), np.cos(PRESSED)
    return s - PRESSED * c, 0.5 * (PRESSED - s * c) / (s - PRESSED * c)


def on_beds() -> tuple[np.ndarray, np.ndarray]:
    """The same of an elastic bed of a disc, pressed up to a chord.  # as disc_on_bed, Eq. (E11)"""
    s, c = np.sin(PRESSED), np.cos(PRESSED)
    area, first = PRESSED - c * s, 2.0 / 3.0 * s**3
    second = 0.25 * (PRESSED + c * s * (1.0 - 2.0 * c * c))
    force = first - c * area
    return force, (second - c * first) / force


def opening(column: Column, kn: np.ndarray, law: str) -> Opening | None:
    """What rocks a column, None where it is not as built or joints carry on rings.

    All joints yield: each turns by r_j under its moment, and the weight above leans with all that is below.  # Eq. (E28)

    Parameters
    ----------
    column : Column
    kn : array
        Stiffness per area of each joint [N/m³], shape (n,).
    law : {"rim", "bed", "corners"}

    Notes
    -----
    With B_j the mass above joint j times the height of its centroid over it, a joint bears N_j x(r_j) = a B_j + g Σ_k
    B_max(j,k) r_k. The path of these states is followed by the motion of the top; the largest a on it counts. Slips and the
    sinking of the joints are left out: they are a thousandth of it at the softest joints that columns are computed with.
    """
    if column.as_found or column.on_rings or column.links:
        return None
    half = 0.5 * column.joint_widths
    chain = _Chain.of(column, kn, law)
    acceleration, turns = chain.largest()
    lever = chain.lever(turns)[0]
    worst = int(np.argmax(lever / half))
    toe = 0.0 if law == "corners" else 0.5 * (1.0 - float(np.cos(chain.pressed(turns)[worst])))
    rigid = float((half / column.parts_above[1]).min())
    return Opening(acceleration, column.gravity * rigid, toe, worst + 1)


#: How far the top is followed, over where the first edge opens; states on the way, rounds of Newton's method for each,
#: and the golden section.
FARTHEST, STATES, SEARCHES, GOLDEN = 1e6, 50, 60, 0.6180339887498949


class _Chain(NamedTuple):
    """Joints of a column in a row: weights N [N] and B [kg m], half widths [m], turns at which they begin to open
    [rad], lever of their resistance then [m], the curve of larger turns over that one (logarithm, lever over the half
    width, pressed angle), and gravity [m/s²]."""

    weight: np.ndarray
    above: np.ndarray
    half: np.ndarray
    first: np.ndarray
    kern: np.ndarray
    curve: tuple[np.ndarray, np.ndarray, np.ndarray]
    gravity: float
    reach: np.ndarray

    @classmethod
    def of(cls, column: Column, kn: np.ndarray, law: str) -> _Chain:
        """Of a column on joints of a law."""
        weight, half = column.joint_weights, 0.5 * column.joint_widths
        first = weight / (kn * column.joint_areas * half)
        if law == "corners":  # nothing more once the farther points have opened  # Eq. (D4)
            curve = np.array([0.0, 1.0]), np.ones(2), np.zeros(2)
        else:
            force, lever = {"rim": on_rims, "bed": on_beds}[law]()
            curve = np.log(force[-1] / force[::-1]), lever[::-1], PRESSED[::-1]
        mass, height = column.parts_above
        reach = column.height - column.joint_heights
        return cls(weight, mass * height, half, first, half * float(curve[1][0]), curve, column.gravity, reach)

    def lever(self, turns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Lever of the resistance of every joint [m], and its derivative by the turn [m], shapes (n,)."""
        size, sign = np.abs(turns), np.where(turns < 0.0, -1.0, 1.0)
        far = np.log(np.maximum(size / self.first, 1.0))
        at = np.clip(np.searchsorted(self.curve[0], far) - 1, 0, len(self.curve[0]) - 2)
        low, high = self.curve[0][at], self.curve[0][at + 1]
        slope = self.half * (self.curve[1][at + 1] - self.curve[1][at]) / (high - low)
        beyond = far >= self.curve[0][-1]
        lever = self.half * self.curve[1][at] + slope * (far - low)
        lever = np.where(beyond, self.half * self.curve[1][-1], lever)
        closed = size <= self.first
        lever_size = np.where(closed, self.kern * size / self.first, lever)
        rate = np.where(closed, self.kern / self.first, np.where(beyond, 0.0, slope / np.maximum(size, 1e-300)))
        return sign * lever_size, rate

    def pressed(self, turns: np.ndarray) -> np.ndarray:
        """Half of the angle over which the rim of every joint is pressed [rad]."""
        return np.interp(np.log(np.maximum(np.abs(turns) / self.first, 1.0)), self.curve[0], self.curve[2])

    def largest(self) -> tuple[float, np.ndarray]:
        """Largest acceleration of all states in equilibrium [m/s²], and the turns there [rad], shape (n,)."""
        n = len(self.first)
        order = np.arange(n)
        leaning = self.gravity * self.above[np.maximum.outer(order, order)]
        opens = self._closed(leaning)
        if not self.curve[2].any():  # points: the first joint whose farther ones have opened bears no more
            return opens
        way = float(self.reach @ opens[1])
        steps = way * np.geomspace(1.0, FARTHEST, STATES)
        states: list[tuple[float, float, np.ndarray]] = []
        acceleration, turns = 0.5 * opens[0], 0.5 * opens[1]
        for top in steps:
            acceleration, turns = self._at(float(top), acceleration, turns, leaning)
            states.append((float(top), acceleration, turns))
            if acceleration < 0.98 * max(state[1] for state in states):
                break
        place = int(np.argmax([state[1] for state in states]))
        low, high = states[max(place - 1, 0)][0], states[min(place + 1, len(states) - 1)][0]
        best = states[place][1:]
        start = states[max(place - 1, 0)]
        for _ in range(40):  # the largest is between its neighbours: golden section
            nearer, farther = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
            first = self._at(nearer, start[1], start[2], leaning)
            second = self._at(farther, start[1], start[2], leaning)
            best = max((best, first, second), key=lambda state: state[0])
            low, high = (low, farther) if first[0] > second[0] else (nearer, high)
            if high - low < 1e-3 * high:
                break
        return best

    def _closed(self, leaning: np.ndarray) -> tuple[float, np.ndarray]:
        """Acceleration at which the first edge opens, and the turns then."""
        stiff = np.diag(self.weight * self.kern / self.first) - leaning
        turns = np.linalg.solve(stiff, self.above)
        least = float((self.first / np.abs(turns)).min())
        return least, least * turns

    def _at(self, top: float, acceleration: float, turns: np.ndarray, leaning: np.ndarray) -> tuple[float, np.ndarray]:
        """The state at a displacement of the top [m], from one nearby, by Newton's method with halved steps."""
        n = len(turns)
        unknown = np.concatenate((turns, [acceleration]))
        scale = self.weight * self.half

        def rest(now: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            lever, rate = self.lever(now[:n])
            missing = self.weight * lever - leaning @ now[:n] - now[n] * self.above
            return np.append(missing / scale, (self.reach @ now[:n] - top) / top), rate

        missing, rate = rest(unknown)
        for _ in range(SEARCHES):
            size = float(np.abs(missing).max())
            if size < 1e-12:
                break
            matrix = np.zeros((n + 1, n + 1))
            matrix[:n, :n] = (np.diag(self.weight * rate) - leaning) / scale[:, None]
            matrix[:n, n], matrix[n, :n] = -self.above / scale, self.reach / top
            step = np.linalg.solve(matrix, missing)
            share = 1.0
            while True:
                then, rate_then = rest(unknown - share * step)
                if float(np.abs(then).max()) < size or share < 1e-3:
                    break
                share *= 0.5
            unknown, missing, rate = unknown - share * step, then, rate_then
        return float(unknown[n]), unknown[:n]
