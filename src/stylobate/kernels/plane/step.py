"""The engine in the plane over lanes: explicit central differences of rigid bodies on joints and links.

Records: ``records.py``; a state is a tuple of them in the order of ``shared/records.py``. Joints follow one of two laws,
``point_joint.py`` or ``interface_joint.py``; everything else is the same.
"""

from ..jit import kernel, law, strict
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
)  # fmt: skip
from . import interface_joint, look, point_joint
from . import links as ties
from .motion import gather, kinetic_and_gravitational
from .motion import move as move_bodies

fill_base, point_forces, interface_forces = look.fill_ground, point_joint.joint_forces, interface_joint.joint_forces
stored_by_points, stored_by_interface = point_joint.stored, interface_joint.stored


@law
def fill_ground(ground, feed, watch):
    """Acceleration of the base for the next chunk."""
    fill_base(ground, feed, watch)


@law
def look_ahead(state):
    """Which links may hold something within the next chunk of steps."""
    ties.look_ahead(state[BODY], state[JOINT], state[LOAD], state[LINK], state[BOND], state[PAIR], state[WATCH])


@law
def forces_of_points(state):
    """Forces of all joints with contact points, and of all links, at t_n."""
    point_forces(state[BODY], state[JOINT], state[LOAD], state[PAIR], state[LANE])
    ties.link_forces(state[BODY], state[JOINT], state[LOAD], state[LINK], state[BOND], state[PAIR])


@law
def forces_of_interfaces(state):
    """Forces of all joints that are interfaces, and of all links, at t_n."""
    interface_forces(state[BODY], state[JOINT], state[LOAD], state[PAIR], state[LANE])
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


@law
def look_at_interfaces(state):
    """As :func:`look_at`; the peak of openings without the elastic gap at an edge that the law keeps closed."""
    look_at(state)
    joint, w = state[JOINT], state[WATCH][0]
    for l in range(w.status.shape[0]):
        w.open[l] = 0.0
    for j in range(joint.shape[0]):
        e = joint[j]
        for l in range(w.status.shape[0]):
            w.open[l] = max(w.open[l], e.gap[l])


@law
def energies(state, elastic, held, gx, gz, dt, l, out):
    """Ledger of one lane at t_n, with the forces there and velocities brought to the whole step.  # Eq. (D5)

    Writes input, kinetic, gravitational (absolute), elastic (absolute), friction, viscous [J]. ``elastic`` and ``held`` are
    what contacts but links hold by pressure and by shear; ``dt`` is the step of the lane (its own is 0 once it stands
    still), ``gx`` and ``gz`` the acceleration of the base at t_n.
    """
    o = state[LANE][0]
    kinetic, height = kinetic_and_gravitational(state[BODY], state[SPAN], state[LANE], gx, gz, dt, l)
    out[0] = o.work[l]
    out[1] = kinetic
    out[2] = height
    out[3] = elastic + held
    out[4] = o.shear[l] - held
    out[5] = o.visc[l]
    add_to_ledger(state[LINK], state[BOND], l, out)


@kernel
def advance_points(state, chunks):
    """Advance all lanes of bodies on joints with contact points: see :func:`run_chunks`."""
    run_chunks(fill_ground, look_ahead, forces_of_points, move, look_at, state, chunks)


@kernel
def advance_interfaces(state, chunks):
    """Advance all lanes of bodies on interfaces: see :func:`run_chunks`."""
    run_chunks(fill_ground, look_ahead, forces_of_interfaces, move, look_at_interfaces, state, chunks)


@kernel
def gather_points(state):
    """Forces on all bodies at t_n, with joints that have contact points; brings the contact memory to t_n."""
    forces_of_points(state)
    gather(state[BODY], state[LOAD], state[SPAN], state[TOUCH])


@kernel
def gather_interfaces(state):
    """Forces on all bodies at t_n, with joints that are interfaces; brings their memory to t_n."""
    forces_of_interfaces(state)
    gather(state[BODY], state[LOAD], state[SPAN], state[TOUCH])


@strict
def ledger_points(state, gx, gz, dt, l, out):
    """Ledger of bodies on joints with contact points: see :func:`energies`."""
    elastic = 0.0
    held = 0.0
    for j in range(state[JOINT].shape[0]):
        elastic, held = stored_by_points(state[JOINT][j], state[LANE][0], l, 1.0, elastic, held)
    energies(state, elastic, held, gx, gz, dt, l, out)


@strict
def ledger_interfaces(state, gx, gz, dt, l, out):
    """Ledger of bodies on interfaces: see :func:`energies`."""
    elastic = 0.0
    held = 0.0
    for j in range(state[JOINT].shape[0]):
        elastic, held = stored_by_interface(state[JOINT][j], state[LANE][0], l, 1.0, elastic, held)
    energies(state, elastic, held, gx, gz, dt, l, out)


@kernel
def joint_state(state, l, opening, slip):
    """Opening and slip of every joint of one lane [m]."""
    look.joint_state(state[BODY], state[JOINT], state[PAIR], l, opening, slip)
