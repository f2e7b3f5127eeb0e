"""The engine in the plane over lanes: explicit central differences of rigid bodies on joints and links.

Records: ``records.py``; a state is a tuple of them in the order of ``shared/records.py``. Joints follow one of two laws,
``point_joint.py`` or ``interface_joint.py``, as the types of their records tell; everything else is the same.
"""

from ..jit import chosen, kernel, law, strict
from ..shared.frame import run_chunks
from ..shared.links import add_to_ledger
from ..shared.records import (
    BODY,
    BOND,
    FEED,
    GROUND,
    HOLD,
    JOINT,
    LANE,
    LINK,
    LOAD,
    PAIR,
    SPAN,
    STACK,
    TOUCH,
    WATCH,
    rows,
)  # fmt: skip
from . import interface_joint, look, point_joint
from . import links as ties
from .motion import gather as gather_loads
from .motion import kinetic_and_gravitational
from .motion import move as move_bodies

fill_base, bases = look.fill_ground, look.bases


@chosen
def joint_forces(body, joint, load, pair, lane):
    """Forces of all joints at t_n, as their records tell; brings their memory from t_{n−1} to t_n."""
    loop = point_joint.joint_forces if rows(joint, "over") else interface_joint.joint_forces
    return lambda body, joint, load, pair, lane: loop(body, joint, load, pair, lane)


@chosen
def look_at_gaps(joint, watch):
    """Of interfaces the peak of openings without the elastic gap at an edge that their law keeps closed."""
    if rows(joint, "over"):
        return lambda joint, watch: None
    return lambda joint, watch: interface_joint.look_at_gaps(joint, watch)


@chosen
def stored(joint, lane, l):
    """Energy that all joints hold in one lane by pressure, and by shear [J]."""
    of_one = point_joint.stored if rows(joint, "over") else interface_joint.stored

    def of_all(joint, lane, l):
        elastic = 0.0
        shear = 0.0
        for j in range(joint.shape[0]):
            elastic, shear = of_one(joint[j], lane[0], l, 1.0, elastic, shear)
        return elastic, shear

    return of_all


@law
def fill_ground(ground, feed, watch):
    """Acceleration of the base for the next chunk."""
    fill_base(ground, feed, watch)


@law
def look_ahead(state):
    """Which links may hold something within the next chunk of steps."""
    ties.look_ahead(state[BODY], state[JOINT], state[LOAD], state[LINK], state[BOND], state[PAIR], state[WATCH])


@law
def forces(state):
    """Forces of all joints and links at t_n."""
    joint_forces(state[BODY], state[JOINT], state[LOAD], state[PAIR], state[LANE])
    ties.link_forces(state[BODY], state[JOINT], state[LOAD], state[LINK], state[BOND], state[PAIR])


@law
def move(state, k):
    """Motion of all bodies from t_n to t_{n+1}."""
    move_bodies(state[BODY], state[LOAD], state[SPAN], state[TOUCH], state[LANE], state[GROUND], k)


@law
def look_at(state):
    """Look at the lanes between chunks of steps, at their links first."""
    watch = state[WATCH]
    look.check_finite(state[BODY], watch)
    ties.look_at_all(state[JOINT], state[LINK], state[BOND], state[LANE], state[FEED], watch, state[HOLD], state[PAIR])
    if state[STACK] > 0:
        look.observe(state[BODY], state[JOINT], state[LANE], state[FEED], watch, state[HOLD], state[STACK])
    else:
        look.straighten(state[BODY])
    look_at_gaps(state[JOINT], watch)


@law
def energies(state, elastic, shear, gx, gz, dt, l, out):
    """Ledger of one lane at t_n, with the forces there and velocities brought to the whole step.  # Eq. (D5)

    Writes input, kinetic, gravitational (absolute), elastic (absolute), friction, viscous [J]. ``elastic`` and ``shear`` are
    what contacts but links hold by pressure and by shear; ``dt`` is the step of the lane (its own is 0 once it stands
    still), ``gx`` and ``gz`` the acceleration of the base at t_n.
    """
    o = state[LANE][0]
    kinetic, height = kinetic_and_gravitational(state[BODY], state[SPAN], state[LANE], gx, gz, dt, l)
    out[0] = o.work[l]
    out[1] = kinetic
    out[2] = height
    out[3] = elastic + shear
    out[4] = o.shear[l] - shear
    out[5] = o.visc[l]
    add_to_ledger(state[LINK], state[BOND], l, out)


@kernel
def advance(state, chunks):
    """Advance all lanes: see :func:`run_chunks`."""
    run_chunks(fill_ground, look_ahead, forces, move, look_at, state, chunks)


@kernel
def gather(state):
    """Forces on all bodies at t_n; brings the memory of contacts to t_n."""
    forces(state)
    gather_loads(state[BODY], state[LOAD], state[SPAN], state[TOUCH])


@strict
def ledgers(state, base, dt, lanes, out):
    """Ledgers of bodies on joints and links in some lanes, shape (lanes, 6): see :func:`energies`.

    ``base`` is the acceleration of their bases, shape (lanes, 2), ``dt`` of shape (lanes,).
    """
    for k in range(lanes.shape[0]):
        elastic, shear = stored(state[JOINT], state[LANE], lanes[k])
        energies(state, elastic, shear, base[k, 0], base[k, 1], dt[k], lanes[k], out[k])


@kernel
def joint_states(state, lanes, opening, slip):
    """Opening and slip of every joint of some lanes [m], shapes (lanes, joints)."""
    for k in range(lanes.shape[0]):
        look.joint_state(state[BODY], state[JOINT], state[PAIR], lanes[k], opening[k], slip[k])
