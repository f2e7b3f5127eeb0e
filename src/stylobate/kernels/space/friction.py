"""Friction of a contact of bodies in space: its memory, in axes of space that turn with the contact, and its work.

The law is that of ``shared/friction.py``; legend of what is remembered: ``pair`` in ``records.py``.
"""

from ..jit import kernel, long_law
from ..shared.friction import dragged, friction, stored
from ..shared.vectors import along, cross, dot, length, minus, of, put, scaled


@long_law
def late(before, after, now):
    """Work of the last force that is not counted yet [J], from its powers before and after it acted [W].

    A force acts for half of the parts of the step before and after it; half the one before was counted at once.
    """
    return 0.25 * (now.earlier + now.last) * (before + after) - 0.5 * now.earlier * before


@long_law
def tell(q, past, past_spin, now):
    """Count what the last force of friction has done since it was told, with the velocity and the spin after it."""
    now.shear -= late(q.pf, dot(of(q.f), past) + q.t * past_spin, now)
    now.visc -= late(q.pd, dot(of(q.d), past) + q.dt * past_spin, now)


@long_law
def at_centroid(face, n, slip, spin):
    """Slip at the centroid of what touches, from that at the middle of pressure."""
    return along(slip, spin, cross(n, minus(face[2], face[3])))


@long_law
def about_middle(face, n, force, torsion):
    """Torsion about the middle of pressure of a force at the centroid and a torsion about it."""
    return torsion + dot(cross(minus(face[2], face[3]), force), n)


@kernel
def rub(q, at, n, slip, rolling, spin, past, past_spin, face, limits, push, velocity, now):
    """Friction at t_n; brings its memory from t_{n−1} to t_n.

    Parameters
    ----------
    q : record
        What remembers, of a pair or of a joint.
    at : vector
        Place of the core, from the centroid of the first body.
    n : vector
        Normal of the contact.
    slip, rolling, spin : vector, float, float
        Velocity of the second body over the first one across n at the middle of pressure; mean and difference of the spins
        about n.
    past, past_spin : vector, float
        Velocity and spin after the last force, where it acted, against which it does the second half of its work.
    face, limits : tuple
        As of :func:`~stylobate.kernels.shared.friction.friction`.
    push, velocity : vector, vector
        What dissipates besides in pressure, and the velocity against which it does.

    Returns
    -------
    force, twist : vector, float
        On the second body, with ``push``, at the middle of pressure: shear force and torsion moment about n.
    at : vector
        Place of the core now.
    """
    dt = now.last
    tell(q, past, past_spin, now)
    core = turned(of(q.s), n, rolling * dt), q.st, q.kc, q.jc, at
    fresh = turned(of(q.fs), n, rolling * dt), q.ft, q.kf, q.jf
    there = at_centroid(face, n, slip, spin)
    core, fresh, f, torsion = friction(core, fresh, face, n, there, spin, dt, limits)
    g, more = (0.0, 0.0, 0.0), 0.0
    if now.beta > 0.0:
        g, more = dragged(f, torsion, face, n, there, spin, now.beta, limits)
    twist, more = about_middle(face, n, f, torsion), about_middle(face, n, g, more)
    g = along(g, 1.0, push)
    q.pf = dot(f, slip) + twist * spin
    now.shear -= 0.5 * dt * q.pf
    q.pd = dot(g, velocity) + more * spin
    now.visc -= 0.5 * dt * q.pd
    put(q.s, core[0])
    put(q.fs, fresh[0])
    q.st, q.kc, q.jc, q.ft, q.kf, q.jf = core[1], core[2], core[3], fresh[1], fresh[2], fresh[3]
    put(q.f, f)
    put(q.d, g)
    q.t = twist
    q.dt = more
    return along(f, 1.0, g), twist + more, core[4]


@long_law
def turned(f, n, angle):
    """A shear force a step ago, turned into the tangent plane of now, and about its normal by a small angle."""
    size = length(f)
    f = along(f, -dot(f, n), n)
    f = scaled(size / max(length(f), 1e-300), f)
    return along(f, angle, cross(n, f))


@long_law
def spring_energy_of(q):
    """Energy that the friction springs of a contact hold [J]."""
    shear, torsion = stored((of(q.s), q.st, q.kc, q.jc), (of(q.fs), q.ft, q.kf, q.jf))
    return shear + torsion


@kernel
def relax(q):
    """Nothing is remembered any more."""
    q.t = q.dt = q.kc = q.jc = q.st = q.ft = q.kf = q.jf = q.en = q.pf = q.pd = 0.0
    for c in range(3):
        q.f[c] = q.d[c] = q.s[c] = q.fs[c] = 0.0
