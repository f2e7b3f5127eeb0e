"""A problem of compas_dem as an assembly in space, shaken; its response as results of compas_dem and as a moved model."""

from __future__ import annotations

import dataclasses
import json
import math
from pathlib import Path
from typing import Any

import compas
import numpy as np
from compas.geometry import Transformation
from compas_dem.interactions import MohrCoulomb
from compas_dem.models import BlockModel
from compas_dem.problem import Problem
from compas_dem.problem.results import Results

import stylobate as st
from stylobate.column.shapes import matrix_of
from stylobate.errors import check_kind
from stylobate_exchange.compas_files import Block, compas_blocks
from stylobate_exchange.convert import Reading, body_of, parts_of, stand_up
from stylobate_exchange.recording import Recording


def assembly_of(problem: Problem, material: str, joint: st.Joint | None = None) -> st.SpatialAssembly:
    """The blocks of a problem's model as an assembly in space.

    Blocks keep their names; of several of one name each has its number behind it. Supports move with the ground; a model
    without supports stands on a ground at its lowest point. Faces that touch are joints, whether or not the model's contacts
    have been computed.

    Parameters
    ----------
    problem : compas_dem.problem.Problem
        Its contact model tells the friction.
    material : str
        Name of a stone: density of blocks whose material tells none, stiffness of the joints, and friction if the problem
        has no contact model.
    joint : stylobate.Joint, optional
        Law of all joints, in place of that of the material.

    Raises
    ------
    stylobate.InputError
        What this solver does not compute: loads, prescribed displacements, strength in tension, cohesion and stiffness in
        units that compas_dem does not tell; another friction than that of ``joint``; contacts between blocks that do not
        touch; blocks that are no convex solids.
    """
    check_kind("problem", problem, Problem)
    loaded = next((group.name for group in problem.boundary_conditions if _acts(group)), None)
    if loaded is not None:
        raise st.InputError(
            f"boundary condition {loaded!r} holds loads or displacements; ground motion and weight are what is computed "
            "here: leave it out."
        )
    name, blocks = _blocks(problem.model)
    structure, *_ = stand_up(name, parts_of(blocks), Reading(material), "the model", Path())
    assembly = structure.must_be("assembly in space")
    assembly = dataclasses.replace(assembly, joint=_law(problem, joint, assembly.joint))
    _refuse_apart(problem.model, blocks, assembly)
    return assembly


def shake(
    problem: Problem,
    motion: st.Motion,
    material: str,
    engine: st.DistinctElement3D | None = None,
    *,
    joint: st.Joint | None = None,
    **options: Any,
) -> st.Response:
    """Shake a problem's model once.

    Parameters
    ----------
    problem, material, joint
        As of :func:`assembly_of`.
    motion : stylobate.Motion
        Its x, y and z are those of the model.
    engine : stylobate.DistinctElement3D, optional
    **options
        Of :func:`stylobate.simulate`: ``tail``, ``until_rest`` …

    Raises
    ------
    stylobate.InputError
    """
    engine = st.DistinctElement3D() if engine is None else engine
    return st.simulate(assembly_of(problem, material, joint), motion, engine, **options)


def results_of(response: st.Response, problem: Problem, at: float | None = None) -> Results:
    """Where the blocks are, as compas_dem keeps results.

    Parameters
    ----------
    response : stylobate.Response
        Of :func:`shake` with the same problem.
    problem : compas_dem.problem.Problem
    at : float, optional
        Instant [s]; the end of the run if left out.

    Returns
    -------
    compas_dem.problem.results.Results
        Of every block the rigid ``transformation`` from where the model has it, relative to the moving ground. In
        ``metadata``: ``time`` [s], and ``summary``, which tells whether it has collapsed.

    Raises
    ------
    stylobate.InputError
        Another model, or an instant that is not recorded.
    """
    recording = Recording.instant(response, float(response.time[-1]) if at is None else at)
    index = int(recording.instants[0])
    motions = {"ground": np.eye(4)}
    for number, body in enumerate(response.structure.bodies[response.structure.first :]):
        if isinstance(body, st.Stone):
            drawn = _rigid(matrix_of(body.orientation), np.array(body.position))
            stands = _rigid(recording.axes[index, number], recording.position[index, number])
            motions[body.name] = stands @ np.linalg.inv(drawn)
    _, blocks = _blocks(problem.model)
    names = {block.key: body_of(block.part.name) for block in blocks}
    if not set(names.values()) <= motions.keys():
        raise st.InputError(f"the response is of {response.structure.name!r} and not of the model of this problem.")
    results = Results(str(problem.model.guid), str(problem.guid))
    for element in problem.model.elements():
        if str(element.guid) in names:
            moved = motions[names[str(element.guid)]].tolist()
            results.set_node(element.graphnode, "transformation", Transformation.from_matrix(moved))
    results.metadata = {"solver": "stylobate", "time": float(recording.time[0]), "summary": response.summary()}
    return results


def placed(model: BlockModel, results: Results) -> BlockModel:
    """A copy of a model with its blocks where results have them.

    Parameters
    ----------
    model : compas_dem.models.BlockModel
    results : compas_dem.problem.results.Results
    """
    copy: BlockModel = model.copy()
    stands = {}
    for element in copy.elements():
        moved = results.transformation(element.graphnode)
        stands[element.guid] = element.modeltransformation if moved is None else moved * element.modeltransformation
    for element in copy.elements():
        parent = element.parent
        above = copy.transformation if parent is None else stands[parent.guid]
        own = stands[element.guid]
        element.transformation = own if above is None else above.inverse() * own
    return copy


def _blocks(model: BlockModel) -> tuple[str, list[Block]]:
    return compas_blocks(json.loads(compas.json_dumps(model)), "the model", "model")


def _rigid(turn: np.ndarray, place: np.ndarray) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, place
    return matrix


def _acts(group: Any) -> bool:
    return bool(group.point_loads or group.surface_loads or group.body_forces or group.displacements)


def _law(problem: Problem, joint: st.Joint | None, usual: st.Joint) -> st.Joint:
    """The law of all joints: as given, or that of the stone with the problem's friction."""
    contact, stiffness = problem.contact_properties.contact_model, problem.contact_properties.joint_model
    if stiffness is not None and joint is None:
        raise st.InputError(
            "the problem has a joint model in N/m, and stiffnesses here are per area, in N/m³; give them as "
            "`joint`, a stylobate.Joint."
        )
    if contact is None:
        return usual if joint is None else joint
    if not isinstance(contact, MohrCoulomb):
        raise st.InputError(f"the contact model is a {type(contact).__name__}; allowed is MohrCoulomb.")
    if contact.t_c:
        raise st.InputError(
            f"the contact model has a tension cutoff of {contact.t_c:g}; joints here bear none: give 0."
        )
    if contact.c and joint is None:
        raise st.InputError(
            f"the contact model has a cohesion of {contact.c:g} without a unit; give it in Pa in `joint`, a stylobate.Joint."
        )
    if joint is None:
        return usual.changed(friction_coefficient=contact.mu)
    if not math.isclose(joint.tan_phi, contact.mu, rel_tol=1e-6, abs_tol=1e-9):
        raise st.InputError(
            f"friction is {joint.tan_phi:g} in `joint` and {contact.mu:g} in the contact model; give the same in both."
        )
    return joint


def _refuse_apart(model: BlockModel, blocks: list[Block], assembly: st.SpatialAssembly) -> None:
    """Refuse contacts of the model between blocks that do not touch: its tolerance is wider than that of joints."""
    numbers = {body.name: i for i, body in enumerate(assembly.bodies)}
    names = {block.key: body_of(block.part.name) for block in blocks}
    nodes: dict[Any, str] = {element.graphnode: names.get(str(element.guid), "") for element in model.elements()}
    touching = {frozenset(pair) for pair in assembly.touching}
    for edge in model.graph.edges():
        if not model.graph.edge_attribute(edge, "contacts"):
            continue
        block, other = (nodes[node] for node in edge)
        if block != other and frozenset((numbers[block], numbers[other])) not in touching:
            raise st.InputError(
                f"the model has a contact between {block!r} and {other!r}, whose faces do not touch; move them together, or "
                "compute contacts with a smaller tolerance."
            )
