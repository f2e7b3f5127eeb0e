"""Columns on a graphics card: a thread for every joint and lane, the records of a block of lanes in shared memory.

No mechanics stands here: what joints, bodies and lanes do is in ``laws.py``. A column stands on faces, without links: drum
j + 1 has the loads j under it and j + 1 above it, the last of which is idle.

What a column sums up, joints and drums add for themselves in ``sums``; it goes into the record of the lane at every look.
Motion, forces and peaks have the bits of the loop over lanes where the compiler contracts products and sums alike; sums of
work have another order of the same terms. A lane whose run is over stays as it was when it ended.

Legend (``l`` lane, ``j`` joint of a thread; records: ``plane/records.py``, ``dem3d/records.py``)::

    site[b, i]   body joint load sums   of block b: body i, the joint and the load over it, and what they sum up
    lane[b]  feed[b]  watch[b]          of its lanes
    hold         what links hold: nothing
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import numpy as np
from numba import cuda, from_dtype, int64

from ..jit import law
from ..run_codes import CHUNK
from ..shared.frame import end_run, go_on, goes_on
from .kinds import AHEAD, ARGUMENTS, ENTRY, OLDEST, site_type
from .laws import Laws, laws_for


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


def kernel_for(types: Mapping[str, np.dtype]):
    """The kernel for columns of any number of drums; ``types`` as for :func:`site_type`."""
    return _kernel_on(site_type(types), types["ground"], types["watch"]["status"].shape[0], laws_for(types))


def compiled(types: Mapping[str, np.dtype], registers: int = 0) -> str:
    """The same as PTX for cards from :data:`OLDEST` upwards, none of which need be there, under the name :data:`ENTRY`.

    Its threads have so many registers at most; 0 leaves that to the compiler of the driver.
    """
    site = from_dtype(site_type(types))[:, ::1]
    own = (from_dtype(types[name])[::1] for name in ARGUMENTS)
    text = cuda.compile_ptx(kernel_for(types).py_func, (site, *own, int64), cc=OLDEST)[0]
    head, entry, body = text.replace(text.split(".entry", 1)[1].split("(", 1)[0].strip(), ENTRY).partition(".entry")
    return head + entry + (body.replace("\n)\n", f"\n)\n.maxnreg {registers}\n", 1) if registers else body)


@cache
def _kernel_on(site_of_types: np.dtype, ground: np.dtype, lanes: int, laws: Laws):
    """The kernel for records of these types.

    Launched with ``lanes × drums`` threads for each block and shared memory for a row of sites; takes the records of the
    legend, in its order, and the most chunks of steps by which it advances them.
    """
    joint_force, move, no_momentum, add_work, ground_at, look = laws[:6]
    site_record, ground_record = from_dtype(site_of_types), from_dtype(ground)
    rows = AHEAD + 1

    @cuda.jit
    def advance(site, lane, feed, watch, hold, chunks):
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
            for first in range(0, CHUNK, AHEAD):
                for k in range(j, rows, drums):
                    ground_at(g[k], f, own, first + k, l)
                for k in range(AHEAD):
                    cuda.syncthreads()
                    if own:
                        joint_force(u, v, e, under, o, sums, l)
                    cuda.syncthreads()
                    if own:
                        no_momentum(sums, l)
                        move(u, under, above, o, sums, g[k], l)
                        add_work(o, sums, g[k], g[k + 1], l)
                cuda.syncthreads()
            if own and j == 0:
                for i in range(drums):
                    add_sums(o, s[i]["sums"], l)
                go_on(f, w, l)
                look(s["body"], s["joint"][:drums], o, f, w, hold, l)
                end_run(o, f, w, l)
            cuda.syncthreads()
        for i in range(cuda.threadIdx.x, bodies, lanes * drums):
            site[b][i] = s[i]

    return advance
