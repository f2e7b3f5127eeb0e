"""Columns in the plane on a graphics card: a thread for every joint and lane, the records of a block in shared memory.

No mechanics stands here: the laws are those of ``kernels/plane``. A column stands on points, without links: drum j + 1 has
the loads j under it and j + 1 above it, the last of which is idle.

What a column sums up, joints and drums add for themselves in ``sums``; it goes into the record of the lane at every look.
Motion, forces and peaks have the bits of the loop over lanes where the compiler contracts products and sums alike; sums of
work have another order of the same terms. A lane whose run is over stays as it was when it ended.

Legend (``l`` lane, ``j`` joint of a thread; records: ``plane/records.py``)::

    site[b, i]   body joint load sums   of block b: body i, the joint and the load over it, and what they sum up
    lane[b]  feed[b]  watch[b]          of its lanes
"""

from collections.abc import Mapping
from functools import cache

import numpy as np
from numba import cuda, from_dtype, int64

from ..jit import law
from ..plane.look import ground_at, keep_peaks, look_at_drum, look_at_joint, look_at_top, lose, straighten_one
from ..plane.motion import add_work, move_between, no_momentum
from ..plane.point_joint import joint_force
from ..run_codes import CHUNK, RUNNING
from ..shared.frame import end_run, go_on


@law
def goes_on(w, l):
    """Whether the run of a lane goes on."""
    return w.status[l] == RUNNING


@law
def nothing_yet(sums, l):
    """Nothing is summed up yet."""
    sums.work[l] = 0.0
    sums.shear[l] = 0.0
    sums.visc[l] = 0.0


@law
def add_sums(o, sums, l):
    """Adds to a lane what one of its joints and its drum have summed up, and lets them begin anew."""
    o.work[l] += sums.work[l]
    o.shear[l] += sums.shear[l]
    o.visc[l] += sums.visc[l]
    nothing_yet(sums, l)


def site_type(types: Mapping[str, np.dtype]) -> np.dtype:
    """Record of a body, with the joint and the load over it and what they sum up, from the types of ``plane/records.py``."""
    lanes = types["watch"]["status"].shape
    sums = np.dtype([(name, np.float64, lanes) for name in ("work", "shear", "visc", "px", "pz")])
    return np.dtype([(name, types[name]) for name in ("body", "joint", "load")] + [("sums", sums)])


def kernel_for(types: Mapping[str, np.dtype]):
    """The kernel for columns of any number of drums; ``types`` as for :func:`site_type`."""
    return _kernel_on(site_type(types), types["ground"], types["watch"]["status"].shape[0])


def compiled(types: Mapping[str, np.dtype], capability: tuple[int, int]) -> str:
    """The same as PTX for cards of a compute capability, which need not be there."""
    site = from_dtype(site_type(types))[:, ::1]
    own = (from_dtype(types[name])[::1] for name in ("lane", "feed", "watch"))
    return cuda.compile_ptx(kernel_for(types).py_func, (site, *own, int64), cc=capability)[0]


@cache
def _kernel_on(site_of_types: np.dtype, ground: np.dtype, lanes: int):
    """The kernel for records of these types.

    Launched with ``lanes × drums`` threads for each block and shared memory for a row of sites; takes the records of the
    legend, in its order, and the most chunks of steps by which it advances them.
    """
    site_record, ground_record = from_dtype(site_of_types), from_dtype(ground)
    rows = CHUNK + 1

    @cuda.jit
    def advance(site, lane, feed, watch, chunks):
        b = cuda.blockIdx.x
        l = cuda.threadIdx.x % lanes
        j = cuda.threadIdx.x // lanes
        bodies = site.shape[1]
        drums = bodies - 1
        s = cuda.shared.array(0, site_record)
        g = cuda.shared.array(rows, ground_record)
        o = lane[b]
        f = feed[b]
        w = watch[b]
        for i in range(cuda.threadIdx.x, bodies, lanes * drums):
            s[i] = site[b][i]
        cuda.syncthreads()
        v = s[j]["body"]
        u = s[j + 1]["body"]
        e = s[j]["joint"]
        under = s[j]["load"]
        above = s[j + 1]["load"]
        sums = s[j]["sums"]
        nothing_yet(sums, l)
        for _ in range(chunks):
            going = 0
            for i in range(lanes):
                going += goes_on(w, i)
            own = goes_on(w, l)
            if going == 0:
                break
            for k in range(j, rows, drums):
                ground_at(g[k], f, w, k, l)
            for k in range(CHUNK):
                cuda.syncthreads()
                if own:
                    joint_force(u, v, e, under, o, sums, l)
                cuda.syncthreads()
                if own:
                    no_momentum(sums, l)
                    move_between(u, under, above, o, sums, g[k], l)
                    add_work(o, sums, g[k], g[k + 1], l)
            cuda.syncthreads()
            if own and j == 0:
                for i in range(drums):
                    add_sums(o, s[i]["sums"], l)
                go_on(f, w, l)
                for i in range(1, bodies):
                    lose(s[i]["body"], w, l)
                look_at_top(s[drums]["body"], o, w, l)
                for i in range(1, bodies):
                    straighten_one(s[i]["body"], l)
                for i in range(1, bodies):
                    look_at_drum(s[i]["body"], w, l)
                for i in range(drums):
                    look_at_joint(s[i + 1]["body"], s[i]["body"], s[i]["joint"], o, f, w, i, l)
                keep_peaks(w, l)
                end_run(o, f, w, l)
            cuda.syncthreads()
        for i in range(cuda.threadIdx.x, bodies, lanes * drums):
            site[b][i] = s[i]

    return advance
