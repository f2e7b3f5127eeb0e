"""Friction of a contact: a shear force and a torsion moment that remember, in axes of space that turn with the contact.

The limit surface is that of faces in ``dem3d``; legend of what is remembered: ``pair`` in ``records.py``.
"""

from ..dem3d.friction import kept, returned
from ..jit import kernel, long_law
from .vectors import along, cross, dot, length, of, put, scaled


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


@kernel
def rub(q, n, slip, rolling, spin, past, past_spin, kf, kt, limit, arm, push, velocity, now):
    """Friction at t_n; brings its memory from t_{n−1} to t_n.

    Parameters
    ----------
    q : record
        What remembers, of a pair or of a joint.
    n : vector
        Normal of the contact.
    slip, rolling, spin : vector, float, float
        Velocity of the second body over the first one across n; mean and difference of the spins about n.
    past, past_spin : vector, float
        Velocity and spin after the last force, where it acted, against which it does the second half of its work.
    kf, kt, limit, arm : float
        Stiffness in shear and torsion, friction times pressure, and the arm of its torsion.
    push, velocity : vector, vector
        What dissipates besides in pressure, and the velocity against which it does.

    Returns
    -------
    force, twist : vector, float
        On the second body, with ``push``: shear force and torsion moment about n.
    """
    dt = now.last
    f, turn = of(q.f), q.t
    tell(q, past, past_spin, now)
    f, twist = sprung(f, turn, q.kf, q.kt, n, slip, rolling, spin, kf, kt, limit, arm, dt)
    g, more = slowed(f, twist, slip, spin, kf, kt, limit, arm, push, now.beta)
    q.pf = dot(f, slip) + twist * spin
    now.shear -= 0.5 * dt * q.pf
    q.pd = dot(g, velocity) + more * spin
    now.visc -= 0.5 * dt * q.pd
    put(q.f, f)
    put(q.d, g)
    q.t = twist
    q.dt = more
    q.kf = kf
    q.kt = kt
    return along(f, 1.0, g), twist + more


@long_law
def sprung(f, turn, soft, supple, n, slip, rolling, spin, kf, kt, limit, arm, dt):
    """Springs of friction at t_n, from a force f and a moment ``turn`` of stiffness ``soft`` and ``supple`` a step ago;
    others as of :func:`rub`.

    Returns the shear force and the torsion moment.
    """
    size = length(f)
    f = along(f, -dot(f, n), n)
    f = scaled(size / max(length(f), 1e-300), f)
    f = along(f, rolling * dt, cross(n, f))
    f = along(scaled(kept(kf, soft), f), -kf * dt, slip)
    twist = kept(kt, supple) * turn - kt * dt * spin
    keep, less = returned(dot(f, f), twist * twist, limit, limit * arm, kf, kt)
    return scaled(keep, f), twist * less


@long_law
def slowed(f, twist, slip, spin, kf, kt, limit, arm, push, beta):
    """Force and moment of dashpots parallel to the springs of friction; all of it in sum stays within Coulomb's limit."""
    g = along(f, -beta * kf, slip)
    more = twist - beta * kt * spin
    keep, less = returned(dot(g, g), more * more, limit, limit * arm, kf, kt)
    return along(along(push, keep, g), -1.0, f), more * less - twist


@kernel
def relax(q):
    """Nothing is remembered any more."""
    q.t = q.dt = q.kf = q.kt = q.en = q.pf = q.pd = 0.0
    for c in range(3):
        q.f[c] = q.d[c] = 0.0
