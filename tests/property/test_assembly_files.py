"""Assembly files and imperfect columns: what is read, and what is refused with one sentence that names the block."""

import math
import re

import numpy as np
import pytest

from stylobate.column import Column, Joint, preset
from stylobate.column.as_found import Imperfections, imperfect
from stylobate.column.assembly import Assembly, Block, read_assembly
from stylobate.column.assembly_files import is_assembly
from stylobate.errors import InputError
from stylobate.models.distinct_element_2d import DistinctElement2D
from stylobate.motion import Motion
from stylobate.simulate import simulate_assembly

JOINT = Joint(1e9, 5e8, friction_coefficient=0.7)
SQUARE = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
STILL = Motion(0.01, np.zeros(51))

FILE = """
name = "portal"
density = 2400.0
[joint]
normal_stiffness = 1e9
shear_stiffness = 5e8
friction_angle = 30.0
[[block]]
name = "left"
vertices = [[-1.5, 0.0], [-0.5, 0.0], [-0.5, 2.0], [-1.5, 2.0]]
[[block]]
name = "right"
vertices = [[0.5, 0.0], [1.5, 0.0], [1.5, 2.0], [0.5, 2.0]]
[[block]]
name = "beam"
density = 2000.0
vertices = [[-1.5, 2.0], [1.5, 2.0], [1.5, 2.5], [-1.5, 2.5]]
[[joint_override]]
between = ["left", "beam"]
normal_stiffness = 2e9
shear_stiffness = 1e9
friction_angle = 20.0
"""


def test_a_file_is_read(tmp_path):
    path = tmp_path / "portal.toml"
    path.write_text(FILE)
    assert is_assembly(path)
    portal = read_assembly(path)
    assert [block.name for block in portal.bodies] == ["ground", "left", "right", "beam"]
    pairs = {(portal.bodies[j.lower].name, portal.bodies[j.upper].name): j.law for j in portal.joints}
    assert set(pairs) == {("ground", "left"), ("ground", "right"), ("left", "beam"), ("right", "beam")}
    assert pairs["left", "beam"].friction_angle == 20.0
    assert portal.blocks[2].properties == pytest.approx((3000.0, 3000.0 * (9.0 + 0.25) / 12.0, 0.0, 2.25))


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('name = "beam"', 'name = "left"', "two blocks are called 'left'"),
        ("[[-1.5, 2.0], [1.5, 2.0]", "[[-1.5, 1.9], [1.5, 1.9]", "block 'beam' and block 'left' overlap by 100 mm"),
        ("density = 2000.0", "densty = 2000.0", "did you mean 'density'"),
        ('"left", "beam"]', '"left", "bean"]', "'bean', which does not exist"),
        ("[[-1.5, 0.0], [-0.5, 0.0]", "[[-1.5, -0.01], [-0.5, -0.01]", "'left' lies in the ground by 10 mm"),
    ],
)
def test_a_bad_file_is_refused_in_one_sentence(tmp_path, old, new, says):
    path = tmp_path / "bad.toml"
    assert old in FILE
    path.write_text(FILE.replace(old, new, 1))
    with pytest.raises(InputError, match=re.escape(says)) as error:
        read_assembly(path)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("vertices", "says"),
    [
        (((0, 0), (1, 0), (0.3, 0.3), (0, 1)), "'b' is not convex at vertex (0.3, 0.3)"),
        (((0, 0), (1, 1), (1, 0), (0, 1)), "'b'"),  # crosses itself
        (((0, 0), (1, 0), (1, 0), (0, 1)), "'b' has vertex 2 twice"),
        (((0, 0), (1, 0), (2, 0)), "'b' has no area"),
        (((0, 0), (1, 0)), "'b' needs 3 to"),
        (((0, 0), (1, math.nan), (0, 1)), "'b' has a vertex that is not finite"),
    ],
)
def test_a_bad_block_is_refused_by_name(vertices, says):
    with pytest.raises(InputError, match=re.escape(says)):
        Block(vertices, 2000.0, "b")


def test_a_clockwise_block_is_turned_round_and_said():
    with pytest.warns(UserWarning, match="'b' run clockwise"):
        block = Block(SQUARE[::-1], 2000.0, "b")
    assert block.properties == pytest.approx((2000.0, 2000.0 / 6.0, 0.5, 0.5))


def test_a_block_in_the_air_is_allowed_and_said():
    raised = tuple((x, z + 1.0) for x, z in SQUARE)
    with pytest.warns(UserWarning, match="'b' touches nothing: it will fall"):
        Assembly((Block(raised, 2000.0, "b"),), JOINT)


def column():
    return Column.tapered(
        height=3.0, bottom_width=0.6, top_width=0.6, drums=3, density=2000.0, joint=JOINT, name="three drums"
    )


def test_offset_beyond_the_edge_is_refused_with_the_missing_moment():
    Imperfections(offsets={2: 0.29}).check(column())
    # drums 2 and 3 weigh 2 × 0.6 × 2000 × 9.81 N and stand 0.31 m off an edge at 0.30 m
    with pytest.raises(InputError, match="at joint 2 the weight above passes 10 mm beyond") as error:
        Imperfections(offsets={2: 0.31}).check(column())
    assert f"{2 * 0.6 * 2000.0 * 9.81 * 0.01:.4g} N m are missing" in str(error.value)


def test_tilt_of_the_base_is_refused_at_its_closed_form():
    limit = math.degrees(math.atan(0.3 / 1.5))  # half the width over the height of the centroid
    Imperfections(base_tilt=0.99 * limit).check(column())
    with pytest.raises(InputError, match="at joint 1 the weight above passes"):
        Imperfections(base_tilt=1.01 * limit).check(column())
    slippery = column().with_joint(friction_angle=5.0)
    Imperfections(base_tilt=4.9).check(slippery)
    with pytest.raises(InputError, match="joint 1 slides"):
        Imperfections(base_tilt=5.1).check(slippery)


@pytest.mark.parametrize(
    ("found", "stands"),
    [
        (Imperfections(offsets={2: 0.2}, chips={(1, "right"): 0.05}), True),
        (Imperfections(chips={(1, "left"): 0.25}, base_tilt=-1.5), True),
        (Imperfections(base_tilt=10.0), True),
    ],
)
def test_what_is_in_equilibrium_stands(found, stands):
    assembly = imperfect(column(), found)
    assert len(assembly.joints) == 3
    response = simulate_assembly(assembly, STILL, DistinctElement2D(start="settle"))
    assert (response.fallen == ()) is stands
    assert np.abs(response.x - response.x[0]).max() < 1e-7


def test_a_chip_shortens_the_contact():
    _, low, high = Imperfections(chips={(2, "left"): 0.1, (3, "right"): 0.2}).contacts(column())
    assert high - low == pytest.approx([0.6, 0.5, 0.4])


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Imperfections(offsets={4: 0.1}).check(column()), "drum 4"),
        (lambda: Imperfections(chips={(1, "top"): 0.1}), "side 'top'"),
        (lambda: Imperfections(chips={(2, "left"): 0.7}).check(column()), "joint 2 has no contact"),
    ],
)
def test_bad_imperfections(make, says):
    with pytest.raises(InputError, match=re.escape(says)):
        make()


def test_a_sound_column_is_the_preset():
    sound = imperfect(preset("paper-12-drums"), Imperfections())
    assert sum(block.properties[0] for block in sound.blocks if not block.fixed) == pytest.approx(
        preset("paper-12-drums").mass
    )
