"""Models made by compas_dem's own classes are shaken and come back: names, places, what is refused."""

import math

import numpy as np
import pytest

import stylobate as st

compas = pytest.importorskip("compas", reason="compas_dem is not installed here (it has no wheels for this machine)")
pytest.importorskip("compas_dem", reason="compas_dem is not installed here (it has no wheels for this machine)")
from compas.geometry import Box, Frame, Translation  # noqa: E402
from compas_dem.elements import Block  # noqa: E402
from compas_dem.material import Stone  # noqa: E402
from compas_dem.models import BlockModel  # noqa: E402
from compas_dem.problem import Problem  # noqa: E402
from compas_dem.templates import ArchTemplate  # noqa: E402
from compas_model.elements import Group  # noqa: E402

import stylobate_compas as sc  # noqa: E402

#: One strong pulse that the arch does not survive.
PULSE = st.harmonic(0.7, 6.0, 2.0)


def arch():
    """An arch of compas_dem's template: thirteen voussoirs, the outer two supports."""
    model = BlockModel()
    for mesh in ArchTemplate(rise=5, span=10, thickness=0.9, depth=1.0, n=13).blocks():
        model.add_block_from_mesh(mesh)
    model.add_supports([0, 12])
    model.compute_contacts()
    for number, block in enumerate(model.elements()):
        block.name = f"voussoir {number + 1}"
    problem = Problem(model)
    problem.set_contact_model("MohrCoulomb", mu=0.7)
    return problem


def tower(named=("base", "shaft")):
    """Two boxes, the lower one a support, the upper one in a group that is moved to its place."""
    model = BlockModel()
    base = Block.from_box(Box(1.0, 1.0, 0.5, Frame([0, 0, 0.25])), is_support=True, name=named[0])
    shaft = Block.from_box(Box(0.4, 0.4, 2.0, Frame([0, 0, 1.0])), name=named[1])
    group = Group(name="group")
    group.transformation = Translation.from_vector([0.0, 0.0, 0.2])
    shaft.transformation = Translation.from_vector([0.0, 0.0, 0.3])
    model.add_element(base)
    model.add_element(shaft, parent=model.add_element(group))
    return Problem(model)


def places(model):
    """Corners of every block in space [m], by name."""
    blocks = [element for element in model.elements() if isinstance(element, Block)]
    return {block.name: np.array(block.modelgeometry.to_vertices_and_faces()[0]) for block in blocks}


def test_an_arch_of_compas_is_shaken_and_returned():
    """Voussoirs are where the response has their solids, by name; supports stay; what comes back is JSON of COMPAS."""
    problem = arch()
    response = sc.shake(problem, PULSE, "limestone", tail=0.5)
    assert response.measures.collapsed
    results = compas.json_loads(compas.json_dumps(sc.results_of(response, problem)))
    assert results.metadata["summary"]["fallen"]
    assert results.metadata["time"] == pytest.approx(response.time[-1])
    first, last = places(problem.model), places(sc.placed(problem.model, results))
    assert list(last) == [f"voussoir {i}" for i in range(1, 14)]
    names = [body.name for body in response.structure.bodies]
    for name, corners in last.items():
        centre = response.poses.position[-1, names.index(name)]
        assert corners.mean(axis=0) == pytest.approx(centre, abs=0.02)  # corners of a wedge are not its mass
        lengths = [np.linalg.norm(each[:, None] - each[None], axis=2) for each in (first[name], corners)]
        assert lengths[1] == pytest.approx(lengths[0], abs=1e-9)
    assert last["voussoir 1"] == pytest.approx(first["voussoir 1"], abs=1e-12)
    assert max(np.abs(last[name] - first[name]).max() for name in last) > 1.0
    before = places(sc.placed(problem.model, sc.results_of(response, problem, at=0.0)))
    assert before["voussoir 7"] == pytest.approx(first["voussoir 7"], abs=1e-3)  # it has settled under its weight


def test_blocks_in_groups_come_back_where_they_are():
    """A block of a group that is moved itself: its corners are where a rotation about x puts them."""
    problem = tower()
    model = problem.model
    assembly = sc.assembly_of(problem, "marble")
    assert [stone.name for stone in assembly.stones] == ["base", "shaft"]
    assert assembly.stones[1].position == pytest.approx((0.0, 0.0, 1.5))
    results = sc.results_of(sc.shake(problem, st.harmonic(2.0, 0.1, 0.5), "marble"), problem, at=0.0)
    turn = compas.geometry.Rotation.from_axis_and_angle([1.0, 0.0, 0.0], math.radians(30.0))
    results.set_node(model.find_element_with_name("shaft").graphnode, "transformation", turn)
    back = places(sc.placed(model, results))
    c, s = math.cos(math.radians(30.0)), math.sin(math.radians(30.0))
    expected = places(model)["shaft"] @ np.array([[1, 0, 0], [0, c, s], [0, -s, c]])
    assert back["shaft"] == pytest.approx(expected, abs=1e-12)


def test_density_and_friction_are_those_of_the_problem():
    problem = tower()
    stone = Stone(density=2345.0)
    problem.model.add_material(stone)
    problem.model.find_element_with_name("shaft").material = stone
    problem.set_contact_model("MohrCoulomb", phi=25.0)
    assembly = sc.assembly_of(problem, "marble")
    assert assembly.stones[1].density == 2345.0
    assert assembly.joint.friction_angle == pytest.approx(25.0)
    law = st.Joint(1e9, 5e8, friction_angle=25.0)
    assert sc.assembly_of(problem, "marble", law).joint == law


def test_blocks_of_one_name_get_numbers():
    assembly = sc.assembly_of(tower(("Block", "Block")), "marble")
    assert [stone.name for stone in assembly.stones] == ["Block 1", "Block 2"]


def loaded(problem):
    problem.add_boundary_condition("Live").add_point_load(1, [0.0, 0.0, -1.0])


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (loaded, "boundary condition 'Live' holds loads or displacements"),
        (lambda problem: problem.set_joint_model(1e9, 1e9), r"joint model in N/m, and stiffnesses here are per area"),
        (
            lambda problem: problem.set_contact_model("MohrCoulomb", mu=0.6, t_c=1.0),
            "tension cutoff of 1; joints here bear none",
        ),
        (lambda problem: problem.set_contact_model("MohrCoulomb", mu=0.6, c=2.0), "cohesion of 2 without a unit"),
    ],
)
def test_what_is_not_computed_is_refused(change, says):
    problem = tower()
    change(problem)
    with pytest.raises(st.InputError, match=says):
        sc.assembly_of(problem, "marble")


def test_a_contact_over_a_gap_is_refused():
    """Two boxes on a third, 5 mm apart: a contact where the model is told a tolerance of 10 mm."""
    model = BlockModel()
    model.add_element(Block.from_box(Box(2.0, 1.0, 0.5, Frame([0, 0, 0.25])), is_support=True, name="base"))
    for x, name in ((-0.2025, "left"), (0.2025, "right")):
        model.add_element(Block.from_box(Box(0.4, 0.4, 0.5, Frame([x, 0, 0.75])), name=name))
    model.compute_contacts()
    assert len(sc.assembly_of(Problem(model), "marble").space_joints) == 2
    model.compute_contacts(tolerance=0.01)
    with pytest.raises(st.InputError, match="a contact between 'left' and 'right', whose faces do not touch"):
        sc.assembly_of(Problem(model), "marble")


def test_a_friction_of_two_values_is_refused():
    problem = tower()
    problem.set_contact_model("MohrCoulomb", mu=0.6)
    with pytest.raises(st.InputError, match=r"friction is 0\.70\d* in `joint` and 0\.6 in the contact model"):
        sc.assembly_of(problem, "marble", st.Joint(1e9, 1e9, friction_angle=35.0))


def test_a_response_of_another_model_is_refused():
    response = sc.shake(tower(), st.harmonic(2.0, 0.1, 0.5), "marble")
    with pytest.raises(st.InputError, match="not of the model of this problem"):
        sc.results_of(response, tower(("base", "obelisk")))
