"""Rigid blocks with links: the step of ``step.py``, and what dowels, bars, ties and layers add to its forces.

Records and legend of links: ``drums/link_records.py``. A column without links is computed by ``step.py``.
"""

from ..drums.body import move
from ..drums.frame import run_chunks
from ..drums.lanes import check_finite, fill_ground, joint_state
from ..drums.links import add_to_ledger, look_at_links
from ..drums.plane_links import add_links, look_ahead
from ..jit import kernel, strict
from . import step

#: The models read these here.
__all__ = ["advance", "forces", "joint_state", "ledger"]

forces_of_joints, ledger_of_joints, observe_drums = step.forces, step.ledger, step.observe


@kernel
def forces(drum, joint, lane):
    """Forces of all joints and links at t_n; brings their memory from t_{n−1} to t_n."""
    forces_of_joints(drum, joint, lane)
    add_links(drum, joint, lane)


@strict
def ledger(drum, joint, lane, ground, k, dt, l, out):
    """Ledger of one lane at t_n; see ``step.py``. What links hold is elastic."""
    ledger_of_joints(drum, joint, lane, ground, k, dt, l, out)
    add_to_ledger(lane, l, out)


@kernel
def observe(drum, joint, lane, feed, watch):
    """Look at the links, then at the drums."""
    look_at_links(lane, feed, watch)
    observe_drums(drum, joint, lane, feed, watch)


@kernel
def advance(drum, joint, lane, ground, feed, watch, chunks):
    """Advance all lanes: see :func:`run_chunks`."""
    state = drum, joint, lane, ground, feed, watch
    run_chunks(fill_ground, look_ahead, forces, move, check_finite, observe, state, chunks)
