"""Ground motion for the models: sampled by the kernels' own law, and integrated to the displacement of the base."""

from __future__ import annotations

import math

import numpy as np

from ...column import Column
from ...column.structure import Structure
from ...motion import Motion
from ..base import Case, RunOptions

#: Which of the two values at the end of a record is meant, as in ``kernels/ground.py``.
BEFORE, AFTER = -1, 1


def value_at(samples: np.ndarray, position: float, side: int = BEFORE) -> float:
    """Value of a record at a position, in samples from the first one; see ``kernels/ground.py``.

    Parameters
    ----------
    samples : array of float64, shape (n,)
        n of at least 2.
    position : float
    side : int
        What the last sample is: ``BEFORE`` itself, ``AFTER`` zero.
    """
    from ...kernels.ground import sample_one

    return sample_one(samples.ctypes.data, len(samples) - 1, position, side)


def values_at(samples: np.ndarray, positions: np.ndarray, side: int = BEFORE) -> np.ndarray:
    """Values of a record at many positions, as :func:`value_at`, shape of ``positions``."""
    from ...kernels.ground import sample_all

    out = np.empty(len(positions))
    sample_all(samples.ctypes.data, len(samples) - 1, np.ascontiguousarray(positions, dtype=float), side, out)
    return out


def ground_history(motion: Motion, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Acceleration and displacement of the base along x at given times, from rest [m/s²], [m], shape of ``time``.

    The displacement is exact for an acceleration that is linear between samples; after the motion the base keeps its
    velocity.
    """
    a, dt = motion.acceleration, motion.dt
    v = np.concatenate(([0.0], np.cumsum(0.5 * dt * (a[1:] + a[:-1]))))
    u = np.concatenate(([0.0], np.cumsum(v[:-1] * dt + (2.0 * a[:-1] + a[1:]) * (dt * dt / 6.0))))
    i = np.minimum((time / dt).astype(np.int64), len(a) - 1)
    rest = time - i * dt
    start, jerk = np.append(a[:-1], 0.0)[i], np.append(np.diff(a), 0.0)[i] / dt
    displacement = u[i] + v[i] * rest + 0.5 * start * rest**2 + jerk * rest**3 / 6.0
    return values_at(motion.samples, time / dt) * motion.factor, displacement


def ground_histories(motion: Motion, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Acceleration and displacement of the base along x, y and z, from rest [m/s²], [m], shape (T, 3)."""
    histories = np.zeros((2, len(time), 3))
    for axis, values in enumerate((motion.acceleration, motion.lateral, motion.vertical)):
        if values is not None:
            histories[:, :, axis] = ground_history(Motion(motion.dt, values), time)
    return histories[0], histories[1]


# Quiet of a record: before the shaking, and between and after shocks once all lies at rest.
#
# A joint opens, or slides, at the earliest where the horizontal acceleration a reaches what a static one needs, less what
# the vertical one takes off the weight. The *level* of a motion is its share of that,
#
#     level(t) = |a_h(t)| / a_0 + |a_z(t)| / g ,    a_0 = min(a_uplift, g tan φ),
#
# below 1 nothing moves but the springs of the joints. What stays below a small share of that is quiet.

#: Share of what opens a joint below which shaking is quiet [-].
QUIET = 0.1

#: Kept of the quiet before the shaking, so that the springs of the joints move as if they had all of it [s].
QUIET_BEFORE = 1.0

#: Time between two looks whether a column lies at rest [s].
LOOK = 0.5

#: Shorter stretches below the share belong to the shaking [s].
GAP = 3.0

#: A column lies at rest with less energy than this share of its lowest barrier [-]: it then rocks through less than a four
#: hundredth of its slenderness. Undamped springs of soft joints go on holding a thousandth.
AT_REST = 5e-3


def level(motion: Motion, column: Structure) -> np.ndarray:
    """Share of what opens a joint that a motion reaches at each sample [-], shape (steps,).

    Infinite on a joint without friction, which any shaking moves.
    """
    if motion.factor == 0.0:
        return np.zeros(motion.steps)
    flat = np.abs(motion.samples) if motion.y_samples is None else np.hypot(motion.samples, motion.y_samples)
    opens = column.moving_acceleration
    assert opens is not None
    share = flat / opens if opens > 0.0 else np.where(flat > 0.0, math.inf, 0.0)
    if motion.z_samples is not None:
        share += np.abs(motion.z_samples) / column.gravity
    return share * abs(motion.factor)


def shaking(motion: Motion, column: Column, share: float) -> np.ndarray:
    """Times from and to which a motion is not quiet [s], shape (stretches, 2).

    From the first to the last time that it reaches the share, without what lies for longer than :data:`GAP` below it. Of a
    motion that never reaches it, the time of its peak.
    """
    reached = level(motion, column)
    loud = np.flatnonzero(reached >= min(share, float(reached.max())))
    breaks = np.flatnonzero(np.diff(loud) * motion.dt > GAP)
    first, last = loud[np.append(0, breaks + 1)], loud[np.append(breaks, len(loud) - 1)]
    # it may already be louder between the sample before and the first loud one, and until the one after the last
    return np.stack((np.maximum(first - 1, 0), np.minimum(last + 1, motion.steps - 1)), axis=1) * motion.dt


def share_of(motion: Motion, whole: bool = False) -> float:
    """The share below which a motion is quiet [-]: of a record; 0 for a computed motion, which has no quiet to speak of."""
    recorded = "format" in motion.metadata and motion.metadata.get("stage") != "computed"
    return QUIET if recorded and not whole else 0.0


def is_cut(case: Case, options: RunOptions) -> bool:
    """Whether the quiet of a case is left out: what starts from a pose moves at once, what falls is followed to the end."""
    cut = options.quiet > 0.0 and not options.until_end and options.start is None
    return cut and case.column.moving_acceleration is not None


def expected_length(case: Case, options: RunOptions) -> float:
    """For how long a case is stepped at least, if its column comes to rest as soon as the shaking ends [s]."""
    whole = case.motion.duration + options.tail
    if not is_cut(case, options):
        return whole
    stretches = shaking(case.motion, case.column, options.quiet)
    return min(whole, float(np.diff(stretches).sum()) + len(stretches) * (QUIET_BEFORE + LOOK))


class Spans:
    """Which steps the lanes of a block take: all, or those of the shaking and until the column lies at rest.

    Parameters
    ----------
    lanes : int
    options : RunOptions
    chunk : int
        Spans are multiples of so many steps.
    """

    def __init__(self, lanes: int, options: RunOptions, chunk: int) -> None:
        self.options, self.chunk = options, chunk
        self.first = np.zeros(lanes, dtype=np.int64)
        self.left_out = np.zeros(lanes, dtype=np.int64)
        self.look = np.zeros(lanes, dtype=np.int64)
        self.cut = np.zeros(lanes, dtype=bool)
        self.stretches: list[list[tuple[int, int]]] = [[] for _ in range(lanes)]

    def begin(self, lane: int, case: Case, dt: float, steps: int) -> tuple[int, int]:
        """First step of a lane, and the one at which it is looked at: of a run of so many steps of dt [s]."""
        self.stretches[lane] = []
        self.cut[lane] = is_cut(case, self.options)
        first, end = 0, steps
        if self.cut[lane]:
            piece = self.chunk * dt
            self.look[lane] = self.chunk * max(1, math.ceil(LOOK / piece))
            for begin, still in shaking(case.motion, case.column, self.options.quiet):
                from_step = self.chunk * max(0, math.floor((begin - QUIET_BEFORE) / piece))
                to_step = self.chunk * math.ceil(still / piece) + int(self.look[lane])
                self.stretches[lane].append((from_step, min(steps, to_step)))
            first, end = self.stretches[lane].pop(0)
        self.first[lane] = self.left_out[lane] = first
        return first, end

    def onward(self, lane: int, now: int, steps: int, rest: bool) -> tuple[int, int]:
        """From where, and to where, a lane goes on that has come to a step; to the same step where its run is over.

        A column that is not at rest goes on through the quiet, one that is goes on with the next shaking.
        """
        if not rest:
            end = min(steps, now + int(self.look[lane]))
            if self.stretches[lane] and end > self.stretches[lane][0][0]:
                end = self.stretches[lane].pop(0)[1]
            return now, end
        if not self.stretches[lane]:
            return now, now
        first, end = self.stretches[lane].pop(0)
        self.left_out[lane] += max(0, first - now)
        return max(first, now), end

    def stepped(self, lane: int, now: int, dt: float) -> tuple[float, float, float] | None:
        """Times from and to which a lane was stepped, and how much of it [s]; None where all of it was."""
        if not self.cut[lane]:
            return None
        return float(self.first[lane] * dt), float(now * dt), float((now - self.left_out[lane]) * dt)
