"""When runs over lanes of drums in space end."""

from ..jit import kernel
from ..run_codes import COLLAPSED, ENDED, LANES, RUNNING

#: A lane whose positions are larger has failed [m].
FAR = 1.0e6


@kernel
def end_runs(lane, feed, watch):
    """Runs end at their last step, or at their collapse; lanes that are over get dt = 0."""
    f = feed[0]
    w = watch[0]
    for l in range(LANES):
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
    for l in range(LANES):
        count += watch[0].status[l] == RUNNING
    return count
