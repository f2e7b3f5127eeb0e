"""Links between bodies in space of which any two may touch: the laws of links of columns between any two bodies, and clamps.

Those laws (``dem3d/links.py``) see the lower drum of a joint with its third axis across the joint. A seat is that: the lower
body in the axes of the link. Records and legend: ``shared/records.py``, and ``ties`` in ``records.py``.
"""

from ..dem3d.links import across, against_opening, at_place, clear, ends, put, slowed, straight
from ..jit import kernel, long_law
from ..shared.links import begun, clamped, handed_over, note_break, note_peaks
from ..shared.vectors import of, outward


@long_law
def sit(s, v, b):
    """Brings a seat to where the lower body is."""
    s.x[0], s.y[0], s.z[0] = v.x[0], v.y[0], v.z[0]
    s.vx[0], s.vy[0], s.vz[0] = v.vx[0], v.vy[0], v.vz[0]
    s.wx[0], s.wy[0], s.wz[0] = v.wx[0], v.wy[0], v.wz[0]
    s.ix[0], s.iy[0], s.iz[0] = outward(v, of(b.i))
    s.jx[0], s.jy[0], s.jz[0] = outward(v, of(b.j))
    s.kx[0], s.ky[0], s.kz[0] = outward(v, of(b.k))


@long_law
def along_itself(k, b, f, u, v, l):
    """Adds what a clamp holds along itself, in both senses."""
    _, _, lift, ax, ay, az, bx, by, bz = at_place(u, v, k, l)
    pull = clamped(k, b, l, lift)
    put(f, l, -pull * v.kx[l], -pull * v.ky[l], -pull * v.kz[l], ax, ay, az, bx, by, bz)


@kernel
def add_links(body, ties, dt):
    """Forces of all links at t_n, on their bodies; brings their memory from t_{n−1}, ``dt`` before, to t_n."""
    link, bond, seat, load = ties
    for m in range(link.shape[0]):
        k, b, s, f = link[m], bond[m], seat[m], load[m]
        u = body[b.upper]
        v = body[b.lower]
        k.dt[0] = dt
        clear(k, b, f, u, s, 0)
        if b.line != 0:
            straight(k, b, f, u, v, 0)
        else:
            sit(s, v, b)
            if b.ks > 0.0 or b.both != 0:
                across(k, b, f, u, s, 0)
            if b.c > 0.0:
                slowed(k, b, f, u, s, 0)
            if b.both != 0:
                along_itself(k, b, f, u, s, 0)
            elif b.ten != 0:
                against_opening(k, b, f, u, s, 0)
        for c in range(3):
            u.f[c] += f.f[c, 0]
            u.mo[c] += f.up[c, 0]
            v.f[c] -= f.f[c, 0]
            v.mo[c] += f.lo[c, 0]


@kernel
def look_at_links(ties, now, step):
    """Between chunks of steps: peaks, links that have broken, what they have made heat of."""
    link, bond, _, _ = ties
    for m in range(link.shape[0]):
        note_peaks(link, bond, m)
        lost, drag = handed_over(link[m], 0)
        now.shear += lost
        now.visc += drag
        note_break(link[m], 0, step)


@kernel
def begin(body, ties):
    """Lets all links begin where the bodies are now: whole, free of force but for what they are pretensioned by, ``ft``."""
    link, bond, seat, _ = ties
    for m in range(link.shape[0]):
        k, b, s = link[m], bond[m], seat[m]
        u = body[b.upper]
        v = body[b.lower]
        sit(s, v, b)
        along, aside, lift, _, _, _, _, _, _ = at_place(u, s, k, 0)
        _, _, _, _, _, _, _, _, _, length = ends(u, v, k, 0)
        k.sx[0] = k.px[0] = along
        k.sy[0] = k.py[0] = aside
        begun(k, b, 0, length if b.line != 0 else lift)
