"""Assembly files and imperfect columns: what is read, and what is refused with one sentence that names the block."""

import math
import re

import numpy as np
import pytest

from stylobate.column import Joint
from stylobate.column.assembly import Assembly, Block
from stylobate.column.assembly_files import is_assembly, read_assembly
from stylobate.errors import InputError
from stylobate.motion import Motion

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
        ("density = 2000.0", "densty = 2000.0", "did you mean density"),
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
