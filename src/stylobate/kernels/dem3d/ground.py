"""Acceleration of the base in space for a block of lanes."""

from ..ground import sample
from ..jit import kernel
from ..run_codes import CHUNK, LANES, RUNNING


@kernel
def fill_ground(ground, feed, watch):
    """Acceleration of the base for the next chunk in the axes of the base, each lane from its own motion."""
    f = feed[0]
    for l in range(LANES):
        running = watch[0].status[l] == RUNNING
        for k in range(CHUNK + 1):
            a = ground[k].a
            if running:
                place = (f.step[l] + k) * f.ratio[l]
                last, factor = f.last[l], f.factor[l]
                x = factor * sample(f.x[l], last, place)
                y = factor * sample(f.y[l], last, place) if f.y[l] != 0 else 0.0
                z = factor * sample(f.z[l], last, place) if f.z[l] != 0 else 0.0
                for c in range(3):
                    a[c, l] = f.r[3 * c, l] * x + f.r[3 * c + 1, l] * y + f.r[3 * c + 2, l] * z
            else:
                for c in range(3):
                    a[c, l] = 0.0
