"""Static acceleration that rocks a column on soft joints: its toe lets the pivot in, and what has sunk there leans it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...column import Column


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
FARTHEST, STATES, ROUNDS, GOLDEN = 1e6, 50, 60, 0.6180339887498949


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
        found = np.where(closed, self.kern * size / self.first, lever)
        rate = np.where(closed, self.kern / self.first, np.where(beyond, 0.0, slope / np.maximum(size, 1e-300)))
        return sign * found, rate

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
        found: list[tuple[float, float, np.ndarray]] = []
        acceleration, turns = 0.5 * opens[0], 0.5 * opens[1]
        for top in steps:
            acceleration, turns = self._at(float(top), acceleration, turns, leaning)
            found.append((float(top), acceleration, turns))
            if acceleration < 0.98 * max(one[1] for one in found):
                break
        place = int(np.argmax([one[1] for one in found]))
        low, high = found[max(place - 1, 0)][0], found[min(place + 1, len(found) - 1)][0]
        best = found[place][1:]
        start = found[max(place - 1, 0)]
        for _ in range(40):  # the largest is between its neighbours: golden section
            one, other = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
            first = self._at(one, start[1], start[2], leaning)
            second = self._at(other, start[1], start[2], leaning)
            best = max((best, first, second), key=lambda state: state[0])
            low, high = (low, other) if first[0] > second[0] else (one, high)
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
        for _ in range(ROUNDS):
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
