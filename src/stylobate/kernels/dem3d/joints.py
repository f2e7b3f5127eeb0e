"""Loops over the joints of all lanes, one for each thing that bodies stand on, and which of them the records ask for."""

from ..jit import apart, chosen, law
from .beds import disc_beds, ring_beds
from .corners import on_corners
from .records import rows
from .rims import chipped_rims, whole_rims
from .round_faces import on_face
from .vertices import on_vertices


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
            on_face(pressure_of, e, f, o, u, v, l)


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
        loop = on_vertices
    elif rows(joint, "w"):
        loop = corner_joints
    elif rows(joint, "ring"):
        loop = ring_joints if rows(joint, "ring") > 1 else bed_joints
    else:
        loop = chipped_rim_joints if rows(joint, "chip") > 1 else whole_rim_joints
    return lambda body, joint, load, pair, lane: loop(body, joint, load, pair, lane)
