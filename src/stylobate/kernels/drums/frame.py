"""The frame of every run over lanes: chunks of steps, and the look at the lanes that follows each.

A model gives its own functions; they are written into the loop where it is compiled, so that the loop is one of plain calls
and is kept on disk as every other.
"""

from ..jit import law
from ..run_codes import CHUNK, LANES, RUNNING
from .lanes import end_runs, running_lanes


@law
def run_chunks(fill_ground, prepare, forces, move, check_finite, observe, state, chunks):
    """Advance all lanes by up to ``chunks`` × CHUNK steps; returns as soon as the run in some lane is over.

    ``prepare`` is what else is done before a chunk, or None; ``state`` the records drum, joint, lane, ground, feed, watch.
    """
    drum, joint, lane, ground, feed, watch = state
    before = running_lanes(watch)
    for _ in range(chunks):
        if before == 0 or running_lanes(watch) < before:
            break
        fill_ground(ground, feed, watch)
        if prepare is not None:
            prepare(drum, joint, lane, watch)
        for k in range(CHUNK):
            forces(drum, joint, lane)
            move(drum, joint, lane, ground, k)
        for l in range(LANES):
            if watch[0].status[l] == RUNNING:
                feed[0].step[l] += CHUNK
        check_finite(drum, watch)
        observe(drum, joint, lane, feed, watch)
        end_runs(lane, feed, watch)
