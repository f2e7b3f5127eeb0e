"""The step of bodies in space: forces of all contacts, motion, looks between chunks, and the ledger, each once.

What the bodies of an array stand on, and whether there are links, is told by the types of its records (``records.py``): the
functions chosen by them here are compiled with what they are chosen for. Each thing that bodies stand on has a loop over the
joints of all lanes.
"""

from ..jit import apart, chosen, kernel, law, long_law, strict
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
    TOUCH,
    WATCH,
    rows,
)  # fmt: skip
from . import vertices
from .bed import disc_beds, ring_beds
from .corner import on_corners
from .links import add_links, look_at_all, look_for_slack
from .look import bases, check_finite, column_state, fill_ground, look_at_column
from .move import gather_all, kinetic_and_gravitational, move_all, stored_in_faces
from .rim import chipped_rims, whole_rims
from .round_faces import on_face

#: The models read these here.
__all__ = ["advance", "bases", "forces", "gather", "joint_states", "ledgers"]


@law
def round_joints(pressure_of, body, joint, load, pair, lane):
    """All joints of round faces in all lanes, under a law of pressure."""
    o = lane[0]
    for q in range(joint.shape[0]):
        u = body[pair[q].upper]
        v = body[pair[q].lower]
        e = joint[q]
        f = load[q]
        for l in range(o.dt.shape[0]):
            on_face(pressure_of, e, f, o, o, u, v, l)


@apart
def whole_rim_joints(body, joint, load, pair, lane):
    """Joints of whole round faces on their rims."""
    round_joints(whole_rims, body, joint, load, pair, lane)


@apart
def chipped_rim_joints(body, joint, load, pair, lane):
    """Joints of chipped round faces on what is left of their rims."""
    round_joints(chipped_rims, body, joint, load, pair, lane)


@apart
def bed_joints(body, joint, load, pair, lane):
    """Joints of round faces on an elastic bed."""
    round_joints(disc_beds, body, joint, load, pair, lane)


@apart
def ring_joints(body, joint, load, pair, lane):
    """Joints of faces with sunken middles on an elastic bed."""
    round_joints(ring_beds, body, joint, load, pair, lane)


@apart
def corner_joints(body, joint, load, pair, lane):
    """Joints of rectangular faces on their corners."""
    for q in range(joint.shape[0]):
        on_corners(joint[q], load[q], lane[0], body[pair[q].upper], body[pair[q].lower])


@chosen
def joint_forces(body, joint, load, pair, lane):
    """Forces of all joints at t_n, as their records tell; brings the contact memory from t_{n−1} to t_n."""
    if rows(joint, "rest"):
        loop = vertices.on_vertices
    elif rows(joint, "w"):
        loop = corner_joints
    elif rows(joint, "ring"):
        loop = ring_joints if rows(joint, "ring") > 1 else bed_joints
    else:
        loop = chipped_rim_joints if rows(joint, "chip") > 1 else whole_rim_joints
    return lambda body, joint, load, pair, lane: loop(body, joint, load, pair, lane)


@chosen
def link_forces(body, load, link, bond, pair, joints):
    """Forces of all links at t_n, where there are some; brings their memory from t_{n−1} to t_n."""
    if rows(link, "none"):
        return lambda body, load, link, bond, pair, joints: None
    return lambda body, load, link, bond, pair, joints: add_links(body, load, link, bond, pair, joints)


@chosen
def may_hold(body, joint, load, link, bond, lane, watch, pair):
    """Which vertices, or which links, may act within the next chunk of steps."""
    if rows(joint, "rest"):
        near = vertices.mark_near
        return lambda body, joint, load, link, bond, lane, watch, pair: near(body, joint, lane, watch)
    if rows(link, "none"):
        return lambda body, joint, load, link, bond, lane, watch, pair: None
    return lambda body, joint, load, link, bond, lane, watch, pair: look_for_slack(
        body, load, link, bond, pair, joint.shape[0], watch
    )


@chosen
def look_at_links(joint, link, bond, lane, feed, watch, hold, pair):
    """Peaks and breaks of links, where there are some, and what the whole ones hold."""
    if rows(link, "none"):
        return lambda joint, link, bond, lane, feed, watch, hold, pair: None
    return lambda joint, link, bond, lane, feed, watch, hold, pair: look_at_all(
        link, bond, lane, feed, watch, hold, pair, joint.shape[0]
    )


@chosen
def look_at_bodies(body, joint, lane, feed, watch, hold):
    """Peaks and certain collapses of a column, or of one body."""
    looks = vertices.look_at_body if rows(joint, "rest") else look_at_column
    return lambda body, joint, lane, feed, watch, hold: looks(body, joint, lane, feed, watch, hold)


@chosen
def state_of_joints(body, joint, watch, l, opening, slip, twist):
    """Opening, slip and twist of the joints of a column, or of the foot of one body."""
    state = vertices.body_state if rows(joint, "rest") else column_state
    return lambda body, joint, watch, l, opening, slip, twist: state(body, joint, watch, l, opening, slip, twist)


@chosen
def stored(joint, lane, l):
    """Energy that all joints hold in one lane by pressure, and by friction [J]."""
    if rows(joint, "rest"):
        return lambda joint, lane, l: (lane[0].en[l], lane[0].st[l])
    return lambda joint, lane, l: stored_in_faces(joint, lane, l)


@long_law
def look_ahead(state):
    """Search before a chunk of steps."""
    may_hold(state[BODY], state[JOINT], state[LOAD], state[LINK], state[BOND], state[LANE], state[WATCH], state[PAIR])


@kernel
def forces(state):
    """Loads of all contacts at t_n; brings their memory from t_{n−1} to t_n."""
    joint_forces(state[BODY], state[JOINT], state[LOAD], state[PAIR], state[LANE])
    link_forces(state[BODY], state[LOAD], state[LINK], state[BOND], state[PAIR], state[JOINT].shape[0])


@kernel
def gather(state):
    """Loads of all contacts at t_n, as :func:`forces`, and what they add up to on every body."""
    forces(state)
    gather_all(state[BODY], state[LOAD], state[SPAN], state[TOUCH])


@long_law
def move(state, k):
    """Motion of all bodies over step k of the chunk."""
    move_all(state[BODY], state[LOAD], state[SPAN], state[TOUCH], state[LANE], state[GROUND], k)


@long_law
def look(state):
    """Looks between chunks of steps."""
    check_finite(state[BODY], state[WATCH])
    look_at_links(
        state[JOINT], state[LINK], state[BOND], state[LANE], state[FEED], state[WATCH], state[HOLD], state[PAIR]
    )
    look_at_bodies(state[BODY], state[JOINT], state[LANE], state[FEED], state[WATCH], state[HOLD])


@strict
def ledgers(state, dt, lanes, out):
    """Ledgers of some lanes at t_n, after :func:`gather`, with velocities brought to the whole step.  # Eq. (D5)

    Writes input, kinetic, gravitational (absolute), elastic (absolute), friction, viscous [J], shape (lanes, 6). What links
    hold is elastic. ``dt`` is the step of each lane (its own is 0 once it stands still); the first row of ``ground`` holds
    t_n.
    """
    o = state[LANE][0]
    for k in range(lanes.shape[0]):
        l = lanes[k]
        kinetic, height = kinetic_and_gravitational(state[BODY], state[LANE], state[GROUND], 0, dt[k], l)
        elastic, shear_energy = stored(state[JOINT], state[LANE], l)
        out[k, 0] = o.work[l]
        out[k, 1] = kinetic
        out[k, 2] = height
        out[k, 3] = elastic + shear_energy
        out[k, 4] = o.shear[l] - shear_energy
        out[k, 5] = o.visc[l]
        add_to_ledger(state[LINK], state[BOND], l, out[k])


@strict
def joint_states(state, lanes, opening, slip, twist):
    """Opening of every joint of some lanes [m], its slip [m] and twist [rad] since the start.

    Shapes (lanes, n), (lanes, n, 2), (lanes, n).
    """
    for k in range(lanes.shape[0]):
        state_of_joints(state[BODY], state[JOINT], state[WATCH], lanes[k], opening[k], slip[k], twist[k])


@kernel
def advance(state, chunks):
    """Advance all lanes: see :func:`run_chunks`."""
    run_chunks(fill_ground, look_ahead, forces, move, look, state, chunks)
