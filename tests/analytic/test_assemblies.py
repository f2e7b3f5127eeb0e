"""Assemblies with a known end: a dropped block, a tower, dominoes, an incline, a portal, Milankovitch's arch."""

import math
from itertools import pairwise

import numpy as np
import pytest

from stylobate.column import Joint, preset
from stylobate.column.assembly import Assembly, Block
from stylobate.constants import g
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.plane.loose import SETTLED
from stylobate.motion import Motion, harmonic
from stylobate.response.mechanism import Mechanism
from stylobate.simulate import simulate

JOINT = Joint(1e9, 5e8, friction_coefficient=0.7)
DENSITY = 2000.0


def still(duration):
    return Motion(0.01, np.zeros(int(duration / 0.01) + 1))


def box(x, z, width, height, name, angle=0.0, **fields):
    """A block by the middle of its lower face and its angle."""
    c, s = math.cos(angle), math.sin(angle)
    local = np.array([[-width / 2, 0.0], [width / 2, 0.0], [width / 2, height], [-width / 2, height]])
    corners = local @ np.array([[c, s], [-s, c]]) + (x, z)
    return Block(tuple((float(p), float(q)) for p, q in corners), DENSITY, name, **fields)


def falls(assembly, motion, model, **options):
    """A run of an assembly that is not in equilibrium as drawn, which is said."""
    with pytest.warns(UserWarning, match="is not in equilibrium as drawn; it moves from the start"):
        response = simulate(assembly, motion, model, **options)
    assert response.summary()["in_equilibrium_as_drawn"] is False
    return response


def static_depth(height):
    """Closure of a bed under a block of that height [m]."""
    return DENSITY * height * g / JOINT.normal_stiffness


@pytest.mark.parametrize(("restitution", "rests"), [(0.3, True), (1.0, False)])
def test_block_dropped_on_a_corner(restitution, rests):
    with pytest.warns(UserWarning, match="'b' touches nothing"):
        assembly = Assembly((box(0.0, 2.0, 1.0, 0.6, "b", 0.6),), JOINT)
    model = DistinctElement2D(restitution=restitution)
    response = falls(assembly, still(4.0), model, until_rest=rests)
    assert response.energy_imbalance < 0.01
    if rests:
        assert response.at_rest
        upright = math.sin(response.rotation[-1, 1] + 0.6)  # lies on one of its faces
        assert min(abs(upright), abs(abs(upright) - 1.0)) < 2e-4
        height = 0.3 if abs(upright) < 0.5 else 0.5
        assert height - response.z[-1, 1] < 1.5 * static_depth(2.0 * height) + 1e-4


def test_fall_before_the_impact_is_free():
    with pytest.warns(UserWarning, match="touches nothing"):
        assembly = Assembly((box(0.0, 2.0, 1.0, 0.6, "b"),), JOINT)
    response = falls(assembly, still(0.6), DistinctElement2D(), output_interval=0.05)
    assert response.z[:, 1] == pytest.approx(2.3 - 0.5 * g * response.time**2, abs=1e-6)


@pytest.mark.processor
def test_tower_of_twenty_stands_a_minute():
    tower = Assembly(tuple(box(0.0, 0.5 * i, 1.0, 0.5, f"b{i}") for i in range(20)), JOINT)
    response = simulate(tower, still(60.0), DistinctElement2D(start="settle"), output_interval=0.5)
    assert response.at_rest
    assert np.abs(response.x).max() < 1e-12
    # Settled means that no block would accelerate by more than SETTLED. Without damping the tower then swings about its
    # equilibrium by up to that over ω², to both sides: at worst 20 blocks' worth in its lowest mode, that of a chain of
    # n masses m on springs k, ω = 2 √(k/m) sin(π / (4n + 2)).
    n, k, m = 20, JOINT.normal_stiffness * 1.0, DENSITY * 0.5
    slowest = 4.0 * k / m * math.sin(0.5 * math.pi / (2 * n + 1)) ** 2
    assert np.abs(response.z - response.z[0]).max() < 2.0 * math.sqrt(n) * SETTLED / slowest
    assert np.abs(response.rotation).max() < 1e-12


def test_dominoes_fall_in_their_order():
    first = box(0.0, 0.2 * math.sin(0.3) / 2, 0.2, 1.0, "d0", -0.3)
    row = (first, *(box(0.6 * i, 0.0, 0.2, 1.0, f"d{i}") for i in range(1, 6)))
    response = falls(
        Assembly(row, JOINT), still(3.0), DistinctElement2D(restitution=0.3), until_rest=True, output_interval=0.005
    )
    assert set(response.fallen) == {f"d{i}" for i in range(6)}
    # the first leans from the start, and has fallen when it has turned by 45° more than that
    assert [name for name in response.fallen if name != "d0"] == [f"d{i}" for i in range(1, 6)]
    turned = np.abs(response.rotation[:, 1:] - response.rotation[0, 1:]) > 0.1
    when = response.time[turned.argmax(axis=0)]
    assert (np.diff(when) > 0.05).all()
    assert (response.rotation[-1, 1:] <= 0.0).all()  # all of them to the right
    assert response.at_rest
    assert response.energy_imbalance < 0.01


@pytest.mark.parametrize("gap", [0.0, 1e-4])  # 0: a joint; otherwise the bed from the start
@pytest.mark.parametrize("friction", [19.0, 21.5, 22.5, 30.0])
def test_inclined_plane_at_22_degrees(friction, gap):
    slope = math.radians(22.0)
    c, s = math.cos(slope), math.sin(slope)
    turn = np.array([[c, s], [-s, c]])
    plane = np.array([[-20.0, -1.0], [20.0, -1.0], [20.0, 0.0], [-20.0, 0.0]]) @ turn
    stone = (np.array([[-0.5, 0.0], [0.5, 0.0], [0.5, 0.4], [-0.5, 0.4]]) + np.array([0.0, gap])) @ turn
    blocks = (
        Block(tuple(map(tuple, plane)), 0.0, "plane", fixed=True),
        Block(tuple(map(tuple, stone)), DENSITY, "stone"),
    )
    joint = Joint(1e9, 5e8, friction_angle=friction)
    if gap:
        with pytest.warns(UserWarning, match="will fall"):
            assembly = Assembly(blocks, joint, ground=None)
    else:
        assembly = Assembly(blocks, joint, ground=None)
    assert len(assembly.joints) == (0 if gap else 1)
    model = DistinctElement2D(restitution=0.1, stiffness_damping=1e-4)
    run = falls if friction < 22.0 else simulate
    response = run(assembly, still(1.2), model)
    down = -((response.x[:, -1] - response.x[0, -1]) * c + (response.z[:, -1] - response.z[0, -1]) * s)
    late = response.time > 0.3
    acceleration = 2.0 * np.polyfit(response.time[late], down[late], 2)[0]
    expected = g * (s - c * math.tan(math.radians(friction)))
    if friction < 22.0:
        assert acceleration == pytest.approx(expected, rel=2e-3)
    else:
        assert acceleration == pytest.approx(0.0, abs=1e-3)
        assert down[-1] < 2e-3


def portal(joint=JOINT):
    blocks = []
    for side, name in ((-1.5, "left"), (1.5, "right")):
        blocks += [box(side, 1.0 * i, 0.8, 1.0, f"{name} {i + 1}") for i in range(4)]
    return Assembly((*blocks, box(0.0, 4.0, 3.8, 0.7, "architrave")), joint, "portal")


def test_two_columns_with_an_architrave():
    assert len(portal().joints) == 10
    resting = simulate(portal(), still(2.0), DistinctElement2D(start="settle"))
    assert np.abs(resting.x - resting.x[0]).max() < 1e-9
    # mirror image: both columns carry the same
    assert resting.z[-1, 1:5] == pytest.approx(resting.z[-1, 5:9], abs=1e-12)
    assert resting.outcome.label == "at_rest"
    assert resting.decided
    brought_down = simulate(portal(), harmonic(0.5, 0.6 * g, 6.0), DistinctElement2D(), until_rest=True)
    assert "architrave" in brought_down.fallen
    assert brought_down.at_rest
    assert brought_down.energy_imbalance < 0.01


@pytest.mark.parametrize("stiffness", [1e9, 5e10])
def test_a_portal_shaken_hard_comes_to_rest_without_damping(stiffness):
    """It rocks and stands; once the shaking is over the impacts of its joints take what is left."""
    joint = Joint(stiffness, 0.5 * stiffness, friction_coefficient=0.7)
    response = simulate(portal(joint), harmonic(1.5, 0.5 * g, 4.0), DistinctElement2D(), until_rest=True)
    assert response.outcome.label == "displaced"
    assert response.at_rest
    assert response.joint_opening.max() > 0.02
    assert response.energy_imbalance < 0.01
    late = response.time > response.time[-1] - 0.5
    assert np.ptp(response.x[late], axis=0).max() < 2e-4 * 3.8  # the definition of rest
    # a dashpot can only take energy; where the step is too long for it, it gives some back and the blocks chatter
    taken = response.energy["viscous"]
    assert np.diff(taken).min() > -1e-4 * taken[-1]


def arch(ratio, stones=40, radius=10.0):
    """A semicircular arch of thickness t = ratio × mean radius on two fixed blocks, joints radial."""
    t = ratio * radius
    inner, outer = radius - 0.5 * t, radius + 0.5 * t
    angles = np.linspace(0.0, math.pi, stones + 1)
    blocks = []
    for k, (a, b) in enumerate(pairwise(angles)):
        corners = [(inner, a), (outer, a), (outer, b), (inner, b)]
        blocks.append(Block(tuple((r * math.cos(q), r * math.sin(q)) for r, q in corners), DENSITY, f"stone {k + 1}"))
    for side in (1.0, -1.0):
        x = side * radius
        blocks.append(
            Block(((x - t, -1.0), (x + t, -1.0), (x + t, 0.0), (x - t, 0.0)), 0.0, f"abutment {side:+g}", fixed=True)
        )
    # no sliding, as in Milankovitch's analysis
    return Assembly(tuple(blocks), Joint(5e10, 2.5e10, friction_coefficient=2.0), "arch", ground=None)


@pytest.mark.parametrize(("share", "stands"), [(1.02, True), (1.002, True), (0.998, False), (0.98, False)])
def test_semicircular_arch_at_the_edge_of_milankovitch_s_thickness(share, stands):
    run = simulate if stands else falls
    response = run(arch(0.1075 * share), still(1.25), DistinctElement2D(), output_interval=0.25)
    crown = response.z[:, 20] - response.z[0, 20]
    if stands:
        assert np.abs(crown).max() < 1e-6
        assert response.outcome.label == "at_rest"
    else:
        assert crown[-1] < (-0.3 if share < 0.99 else -0.03)
        assert np.diff(np.diff(crown) / np.diff(response.time)).max() < 0.0  # down, faster and faster


@pytest.mark.parametrize(
    ("name", "frequency", "amplitude"), [("paper-monolithic", 0.5, 0.3), ("paper-12-drums", 0.66, 0.5)]
)
def test_a_whole_collapse_keeps_its_energy_and_comes_to_rest(name, frequency, amplitude):
    column = preset(name)
    response = simulate(column, harmonic(frequency, amplitude * g, 6.0), DistinctElement2D(), until_rest=True)
    mechanism = response.mechanism
    assert response.collapsed
    assert mechanism.at_rest
    assert mechanism.fallen
    assert response.energy_imbalance < 0.01
    # a dashpot and a slip can only take energy
    for term in ("friction", "viscous"):
        taken = response.histories.energy[term]
        assert np.diff(taken).min() > -1e-3 * taken.max()


def test_standing_after_a_collapse_that_never_was():
    response = simulate(preset("paper-12-drums"), harmonic(1.0, 0.2 * g, 2.0), DistinctElement2D(), until_rest=True)
    mechanism = response.mechanism
    assert not mechanism.fallen
    assert mechanism.standing == tuple(range(1, 13))
    assert mechanism.describe().startswith("All 12 drums stand")


@pytest.mark.parametrize(
    ("fallen", "standing", "says"),
    [
        ((1,), (), "The column overturned as one body about joint 1. It fell to the left at 1.00 s."),
        ((2,), (1,), "1 of 2 drums fell (1 to the left), at 1.00 s. 1 stands, offset by up to 3 mm."),
        ((2, 3), (1,), "2 of 3 drums fell (2 to the left), the first at 1.00 s, the last at 1.00 s. 1 stands,"),
        ((), (1,), "The column stands; the largest residual offset is 3 mm."),
        ((), (1, 2), "All 2 drums stand; the largest residual offset is 3 mm."),
    ],
)
def test_a_mechanism_in_words(fallen, standing, says):
    joint = 1 if fallen == (1,) else 2 if fallen else 0
    n = len(standing)
    mechanism = Mechanism(
        fallen, (1.0,) * len(fallen), ("left",) * len(fallen), joint, False, True, standing, (0.003,) * n, (0.0,) * n
    )
    assert says in mechanism.describe()


def test_offsets_of_metres_are_given_in_metres():
    assert (
        "1 stands, offset by up to 8.76 m."
        in Mechanism((2,), (1.0,), ("left",), 2, False, True, (1,), (8.76,), (0.0,)).describe()
    )
