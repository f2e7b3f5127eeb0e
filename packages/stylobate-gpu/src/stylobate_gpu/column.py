"""Columns on a graphics card: a thread for every joint and lane, the records of a block of lanes in shared memory.

No mechanics stands here: what joints, bodies and lanes do is in ``laws.py``. A column stands on faces, without links: drum
j + 1 has the loads j under it and j + 1 above it, the last of which is idle.

Where it has the registers for them (``Laws.own_records``), a thread steps records of one lane of its own: the joint, the
body on it and the body under it, the loads under and over that body, its lane, the ground. It leaves in shared memory what
the threads of the neighbouring joints ask for in every step, takes from there what they have left, and puts the rest there
whenever the column is looked at. Shared memory is what bounds the kernel otherwise: of 72 numbers a step that a thread in
the plane reads or writes there, 24 are left.

What a column sums up, joints and drums add for themselves in ``sums``; it goes into the record of the lane at every look.
Motion, forces and peaks have the bits of the loop over lanes where the compiler contracts products and sums alike; sums of
work have another order of the same terms. A lane whose run is over stays as it was when it ended.

Legend (``l`` lane, ``j`` joint of a thread; records: ``plane/records.py``, ``dem3d/records.py``)::

    site[b, i]   body joint load sums   of block b: body i, the joint and the load over it, and what they sum up
    lane[b]  feed[b]  watch[b]          of its lanes
    hold         what links hold: nothing
    s  g         sites of the block, and the ground ahead, in shared memory
    v u e under above o sums            of a thread: body under its joint and on it, the joint, the loads under and over the
                                        body on it, its lane, its sums; in lane m of records
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache

import numpy as np
from numba import cuda, from_dtype, int64

from stylobate.kernels.jit import law
from stylobate.kernels.run_codes import CHUNK
from stylobate.kernels.shared.frame import end_run, go_on, goes_on

from .kinds import AHEAD, ARGUMENTS, ENTRY, OLDEST, site_type, sums_type
from .laws import Laws, laws_for

#: Records of which a thread has its own.
OF_A_THREAD = ("body", "joint", "load", "lane", "sums", "ground")


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


@law
def nothing_to_copy(to, m, source, l):
    """The copy of no fields."""


@cache
def copy_of(record: np.dtype, names: tuple[str, ...]) -> Callable[..., None]:
    """A law that copies fields of a lane of a record of this type into lane m of another, ``copy(to, m, source, l)``.

    It is put together by halves: what the compiler writes into one another has the names of all of it, and it confuses
    those that are too long.
    """
    if not names:
        return nothing_to_copy
    name, half = names[0], len(names) // 2
    *rows, _ = record[name].shape
    if half:
        first_copy, others = copy_of(record, names[:half]), copy_of(record, names[half:])

        @law
        def copy(to, m, source, l):
            first_copy(to, m, source, l)
            others(to, m, source, l)

    elif rows:
        count = rows[0]

        @law
        def copy(to, m, source, l):
            for p in range(count):
                to[name][p, m] = source[name][p, l]

    else:

        @law
        def copy(to, m, source, l):
            to[name][m] = source[name][l]

    return copy


def of_one_lane(record: np.dtype) -> np.dtype:
    """The record of one lane."""
    return np.dtype([(name, record[name].base, (*record[name].shape[:-1], 1)) for name in record.names or ()])


def kernel_for(types: Mapping[str, np.dtype]):
    """The kernel for columns of any number of drums; ``types`` as for :func:`site_type`."""
    own = types | {"sums": sums_type(types)}
    return _kernel_on(site_type(types), tuple(own[name] for name in OF_A_THREAD), laws_for(types))


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
def _kernel_on(site_of_types: np.dtype, own: tuple[np.dtype, ...], laws: Laws):
    """The kernel for records of these types; ``own`` are those of :data:`OF_A_THREAD`.

    Launched with ``lanes × drums`` threads for each block and shared memory for a row of sites; takes the records of the
    legend, in its order, and the most chunks of steps by which it advances them.
    """
    joint_force, move, no_momentum, add_work, ground_at, look = laws[:6]
    of_body, of_joint, of_load, _, of_sums, of_ground = own
    lanes, rows, own_records = of_sums["work"].shape[0], AHEAD + 1, laws.own_records is not None
    site_record, ground_record = from_dtype(site_of_types), from_dtype(of_ground)
    body_record, joint_record, load_record, lane_record, sums_record, step_record = (
        from_dtype(of_one_lane(record)) for record in own
    )
    take_body, take_joint, _, take_lane, put_sums, take_ground = (copy_of(record, record.names or ()) for record in own)
    copy_body, copy_load, put_body, put_joint = (
        copy_of(record, tuple(name for name in names if name in (record.names or ())))
        for record, names in zip((of_body, of_load, of_body, of_joint), laws.own_records or ((),) * 4, strict=True)
    )

    @cuda.jit
    def advance(site, lane, feed, watch, hold, chunks):
        b = cuda.blockIdx.x
        l = cuda.threadIdx.x % lanes
        j = cuda.threadIdx.x // lanes
        bodies = site.shape[1]
        drums = bodies - 1
        s = cuda.shared.array(0, site_record)
        g = cuda.shared.array(rows, ground_record)
        f = feed[b]
        w = watch[b]
        for i in range(cuda.threadIdx.x, bodies, lanes * drums):
            s[i] = site[b][i]
        cuda.syncthreads()
        if own_records:
            m = 0
            own_bodies = cuda.local.array(2, body_record)
            own_loads = cuda.local.array(2, load_record)
            v, u, under, above = own_bodies[0], own_bodies[1], own_loads[0], own_loads[1]
            e = cuda.local.array(1, joint_record)[0]
            o = cuda.local.array(1, lane_record)[0]
            sums = cuda.local.array(1, sums_record)[0]
            own_ground = cuda.local.array(2, step_record)
        else:
            m = l
            v, u, under, above = s[j]["body"], s[j + 1]["body"], s[j]["load"], s[j + 1]["load"]
            e = s[j]["joint"]
            o = lane[b]
            sums = s[j]["sums"]
        for _ in range(chunks):
            going = 0
            for i in range(lanes):
                going += goes_on(w, i)
            own = goes_on(w, l)
            if going == 0:
                break
            if own_records:
                take_body(v, 0, s[j]["body"], l)
                take_body(u, 0, s[j + 1]["body"], l)
                take_joint(e, 0, s[j]["joint"], l)
                take_lane(o, 0, lane[b], l)
            nothing_yet(sums, m)
            for first in range(0, CHUNK, AHEAD):
                for k in range(j, rows, drums):
                    ground_at(g[k], f, own, first + k, l)
                for k in range(AHEAD):
                    cuda.syncthreads()
                    if own:
                        if own_records:
                            copy_body(v, 0, s[j]["body"], l)
                        joint_force(u, v, e, under, o, sums, m)
                        if own_records:
                            copy_load(s[j]["load"], l, under, 0)
                    cuda.syncthreads()
                    if own:
                        if own_records:
                            copy_load(above, 0, s[j + 1]["load"], l)
                            take_ground(own_ground[0], 0, g[k], l)
                            take_ground(own_ground[1], 0, g[k + 1], l)
                            now, then = own_ground[0], own_ground[1]
                        else:
                            now, then = g[k], g[k + 1]
                        no_momentum(sums, m)
                        move(u, under, above, o, sums, now, m)
                        add_work(o, sums, now, then, m)
                        if own_records:
                            copy_body(s[j + 1]["body"], l, u, 0)
                cuda.syncthreads()
            if own_records and own:
                put_body(s[j + 1]["body"], l, u, 0)
                put_joint(s[j]["joint"], l, e, 0)
                put_sums(s[j]["sums"], l, sums, 0)
            cuda.syncthreads()
            if own and j == 0:
                for i in range(drums):
                    add_sums(lane[b], s[i]["sums"], l)
                go_on(f, w, l)
                look(s["body"], s["joint"][:drums], lane[b], f, w, hold, l)
                end_run(lane[b], f, w, l)
            cuda.syncthreads()
        for i in range(cuda.threadIdx.x, bodies, lanes * drums):
            site[b][i] = s[i]

    return advance
