"""The frame of every run over lanes: chunks of steps, and the look at the lanes that follows each.

An engine gives its own functions; they are written into the loop where it is compiled, so that the loop is one of plain calls
and is kept on disk as every other.
"""

from ..jit import kernel, law
from ..run_codes import CHUNK, COLLAPSED, ENDED, RUNNING

#: Names of the records of an engine, in the order in which they are its state; the last is a number: how many drums the
#: column has that is looked at, bodies 1 … stack on joints 0 … stack − 1 (0: there is none).
STATE = (
    "body",
    "joint",
    "load",
    "link",
    "bond",
    "lane",
    "ground",
    "feed",
    "watch",
    "hold",
    "pair",
    "span",
    "touch",
    "stack",
)

#: Their places in it.
BODY, JOINT, LOAD, LINK, BOND, LANE, GROUND, FEED, WATCH, HOLD, PAIR, SPAN, TOUCH, STACK = range(len(STATE))


@law
def run_chunks(fill_ground, look_ahead, forces, move, look, state, chunks):
    """Advance all lanes by up to ``chunks`` × CHUNK steps; returns as soon as the run in some lane is over.

    ``state`` holds the records of the engine in the order of :data:`STATE`.
    """
    lane, ground, feed, watch = state[LANE], state[GROUND], state[FEED], state[WATCH]
    before = running_lanes(watch)
    for _ in range(chunks):
        if before == 0 or running_lanes(watch) < before:
            break
        fill_ground(ground, feed, watch)
        look_ahead(state)
        for k in range(CHUNK):
            forces(state)
            move(state, k)
        for l in range(watch[0].status.shape[0]):
            if watch[0].status[l] == RUNNING:
                feed[0].step[l] += CHUNK
        look(state)
        end_runs(lane, feed, watch)


@kernel
def end_runs(lane, feed, watch):
    """Runs end at their last step, or at their collapse; lanes that are over get dt = 0."""
    f = feed[0]
    w = watch[0]
    for l in range(w.status.shape[0]):
        if w.status[l] == RUNNING:
            if w.when[l] >= 0 and w.follow[l] == 0:
                w.status[l] = COLLAPSED
            elif f.step[l] >= f.end[l]:
                w.status[l] = COLLAPSED if w.when[l] >= 0 else ENDED
        if w.status[l] != RUNNING:
            lane[0].dt[l] = 0.0


@kernel
def running_lanes(watch):
    """Number of lanes whose run goes on."""
    count = 0
    for l in range(watch[0].status.shape[0]):
        count += watch[0].status[l] == RUNNING
    return count
