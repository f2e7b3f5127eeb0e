"""How runs in lanes begin, and what their ends come to, as compiled code: what Python does around the loop of the plane.

The loop itself is ``stylobate.kernels.plane.step.advance``. What is here follows ``models/drums/runs.py`` line by line, and
takes every law from where it is; ``tests/live/test_live.py`` compares both.

Legend (records and lanes as in ``kernels/plane/records.py``)::

    kept       step           time step that the column wants [s]
               dt sample      time step of the run, interval of the samples of its motion [s]
               start[6]       ledger at the start [J]
               barrier narrow lowest energy that overturns the column [J], width of its narrowest joint [m]
               gravity        [m/s²]
               shown          for how long a run goes on after its verdict [s]
               longest        step after which a verdict is not waited for any more
               outcome        one of ``stylobate.outcome.Outcome``, −1 while there is none;  decided  1: it is certain
"""

import math

import numpy as np

from stylobate.constants import LONGEST_WAIT
from stylobate.kernels.ground import BEFORE
from stylobate.kernels.jit import law, strict
from stylobate.kernels.plane.look import base_acceleration
from stylobate.kernels.plane.look import joint_state as joint_state_of
from stylobate.kernels.plane.standing import stands
from stylobate.kernels.plane.step import gather, ledgers
from stylobate.kernels.run_codes import CHUNK, COLLAPSED, ENDED, FAILED, LANES, RUNNING
from stylobate.kernels.shared.records import (
    BODY,
    BOND,
    FEED,
    GROUND,
    HOLD,
    JOINT,
    LANE,
    LINK,
    LOAD,
    PAIR,
    SPAN,
    STACK,
    TOUCH,
    WATCH,
)  # fmt: skip
from stylobate.models.drums.runs import WAIT
from stylobate.models.shared import ledger
from stylobate.models.shared.ground import AT_REST
from stylobate.models.shared.stable_step import chunks_in
from stylobate.outcome import Outcome, classify

KEPT_TYPE = np.dtype(
    [(name, np.float64, (LANES,)) for name in ("step", "dt", "sample")]
    + [("start", np.float64, (6, LANES))]
    + [(name, np.float64, (LANES,)) for name in ("barrier", "narrow", "gravity", "shown")]
    + [(name, np.int64, (LANES,)) for name in ("longest", "outcome", "decided")]
)

chunks_in, classify = law(chunks_in), law(classify)
unaccounted, released, imbalance = law(ledger.unaccounted), law(ledger.released), law(ledger.imbalance)
LARGEST_IMBALANCE = ledger.LARGEST_IMBALANCE
NO_VERDICT, STOOD, FELL = int(Outcome.FAILED), int(Outcome.DISPLACED), int(Outcome.COLLAPSED)


@law
def copied(words, copy):
    """Copies records, word by word."""
    for i in range(words.shape[0]):
        copy[i] = words[i]


@strict
def energies(state, kept, copies, words, base, dt, lanes, out):
    """Ledgers of some lanes now [J], shape (lanes, 6), as ``LaneRecords.energies`` gives them: on copies of what changes."""
    copied(words[0], words[2])
    copied(words[1], words[3])
    f = state[FEED][0]
    for k in range(lanes.shape[0]):
        l = lanes[k]
        dt[k] = kept[0].dt[l]
        copies[1][0].dt[l] = dt[k]
        base[k, 0], base[k, 1] = base_acceleration(f, l, f.step[l] * dt[k] / kept[0].sample[l], BEFORE)
    now = (
        state[BODY], copies[0], state[LOAD], state[LINK], state[BOND], copies[1], state[GROUND],
        state[FEED], state[WATCH], state[HOLD], state[PAIR], state[SPAN], state[TOUCH], state[STACK],
    )  # fmt: skip
    gather(now)
    ledgers(now, base, dt, lanes, out)


@law
def goes_on(state, k, time, l):
    """A run goes on for a time, in whole chunks of steps."""
    f, w = state[FEED][0], state[WATCH][0]
    f.end[l] = f.step[l] + CHUNK * math.ceil(time / (CHUNK * k.dt[l]))
    w.status[l] = RUNNING
    state[LANE][0].dt[l] = k.dt[l]


@strict
def begin(state, kept, copies, words, base, dt, lanes, out, l, x, z, last, sample, amax, vmax):
    """Begin a run in lane l, whose column stands there at rest.

    Parameters
    ----------
    state, kept, copies, words, base, dt, lanes, out
        Records of the lanes, and room to work in.
    l : int
    x, z : int
        Addresses of the samples of the motion along x and upward [m/s²]; 0 for none.
    last : int
        Index of the last sample.
    sample : float
        Interval of the samples [s].
    amax, vmax : float
        Peaks along x and upward [m/s²].
    """
    body, f, w, k = state[BODY], state[FEED][0], state[WATCH][0], kept[0]
    duration = last * sample
    chunks = chunks_in(duration, k.step[l])
    step = duration / (CHUNK * chunks)
    k.dt[l] = state[LANE][0].dt[l] = step
    k.sample[l] = sample
    k.longest[l] = math.ceil(CHUNK * chunks + LONGEST_WAIT / step)
    k.outcome[l] = -1
    k.decided[l] = 0
    f.x[l], f.z[l], f.last[l] = x, z, last
    f.step[l], f.end[l] = 0, CHUNK * chunks
    f.ratio[l], f.factor[l] = step / sample, 1.0
    w.amax[l], w.vmax[l] = amax, vmax
    w.status[l], w.follow[l] = RUNNING, 0
    ax, az = base_acceleration(f, l, 0.0, BEFORE)
    for i in range(1, body.shape[0]):  # velocities half a step before the start, of drums that do not move yet
        body[i].vx[l] += 0.5 * step * ax
        body[i].vz[l] += 0.5 * step * az
    lanes[0] = l
    energies(state, kept, copies, words, base, dt, lanes[:1], out[:1])
    for i in range(6):
        k.start[i, l] = out[0, i]


@strict
def judge(state, kept, copies, words, base, dt, lanes, out, stand, flat, offset, width, stood, opening, slip):
    """Look at the lanes whose runs have ended: the verdict of each, or how its run goes on.

    A run whose verdict could still change goes on; one that has its verdict is shown for a while.

    Parameters
    ----------
    state, kept, copies, words, base, dt, lanes, out
        As of :func:`begin`.
    stand, flat : array of STAND_TYPE, shape (lanes, n)
        Numbers of the columns for whether they stand for good; room for a copy of them.
    offset : array, shape (lanes + 1, n)
        Offsets as found [m]; the last row is room to work in.
    width, stood : array, shape (lanes, n)
        Widths of joints, where each drum stood along its joint [m].
    opening, slip : array, shape (n,)
        Room to work in.

    Returns
    -------
    int
        Number of lanes whose runs go on.
    """
    body, joint, f, w, k = state[BODY], state[JOINT], state[FEED][0], state[WATCH][0], kept[0]
    ended = 0
    for l in range(LANES):
        if k.outcome[l] < 0 and (w.status[l] == ENDED or w.status[l] == COLLAPSED or w.status[l] == FAILED):
            lanes[ended] = l
            ended += 1
    if ended > 0:
        energies(state, kept, copies, words, base, dt, lanes[:ended], out[:ended])
    for n in range(ended):
        l = lanes[n]
        row = out[n]
        for i in range(6):
            row[i] -= k.start[i, l]
        energy = row[1] + row[2] + row[3]
        share = imbalance(unaccounted(row), w.wmax[l], k.start[3, l], k.barrier[l], released(row))
        set_off = w.wmax[l] == 0.0 and released(row) > k.start[3, l]
        joint_state_of(body, joint, state[PAIR], l, opening, slip)
        shifted = 0.0
        for j in range(joint.shape[0]):
            slip[j] -= stood[l, j]
            shifted = max(shifted, abs(slip[j]) / width[l, j])
            offset[LANES, j] = offset[l, j] + slip[j]
        failed = w.status[l] == FAILED or set_off or not share <= LARGEST_IMBALANCE
        outcome = classify(w.status[l] == COLLAPSED, failed, w.open[l] / k.narrow[l], shifted).value
        sure = outcome == FELL
        if outcome != FELL and outcome != NO_VERDICT:
            for j in range(joint.shape[0]):
                flat[l, j] = stand[l, j]
            sure = stands(flat[l], offset[LANES], k.gravity[l], 0.0, energy, body, joint, l)
            rests = energy < AT_REST * k.barrier[l]
            if not sure and not rests and f.step[l] < k.longest[l]:
                goes_on(state, k, WAIT, l)
                continue
        k.outcome[l] = outcome
        k.decided[l] = 1 if sure else 0
        if k.shown[l] > 0.0 and w.status[l] != FAILED:
            w.follow[l] = 1
            goes_on(state, k, k.shown[l], l)
    running = 0
    for l in range(LANES):
        running += w.status[l] == RUNNING
    return running
