"""The frame of every run over lanes: chunks of steps, and the look at the lanes that follows each.

An engine gives its own functions; they are written into the loop where it is compiled, so that the loop is one of plain
calls and is kept on disk as every other.
"""

from ..jit import kernel, law
from ..run_codes import CHUNK, COLLAPSED, ENDED, RUNNING
from .records import FEED, GROUND, LANE, WATCH


@law
def goes_on(w, l):
    """Whether the run of a lane goes on."""
    return w.status[l] == RUNNING


@law
def go_on(f, w, l):
    """A run that goes on is a chunk further."""
    if w.status[l] == RUNNING:
        f.step[l] += CHUNK


@law
def end_run(o, f, w, l):
    """A run ends at its last step, or at its collapse; a lane that is over gets dt = 0."""
    if w.status[l] == RUNNING:
        if w.when[l] >= 0 and w.follow[l] == 0:
            w.status[l] = COLLAPSED
        elif f.step[l] >= f.end[l]:
            w.status[l] = COLLAPSED if w.when[l] >= 0 else ENDED
    if w.status[l] != RUNNING:
        o.dt[l] = 0.0


@law
def run_chunks(fill_ground, look_ahead, forces, move, look, state, chunks):
    """Advance all lanes by up to ``chunks`` × CHUNK steps; returns as soon as the run in some lane is over.

    ``state`` holds the records of the engine in the order of :data:`records.STATE`.
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
            go_on(feed[0], watch[0], l)
        look(state)
        end_runs(lane, feed, watch)


@kernel
def end_runs(lane, feed, watch):
    """Runs end at their last step, or at their collapse; lanes that are over get dt = 0."""
    f = feed[0]
    w = watch[0]
    for l in range(w.status.shape[0]):
        end_run(lane[0], f, w, l)


@kernel
def running_lanes(watch):
    """Number of lanes whose run goes on."""
    count = 0
    for l in range(watch[0].status.shape[0]):
        count += watch[0].status[l] == RUNNING
    return count
