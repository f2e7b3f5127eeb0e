"""Files of assemblies in space: what is read, and what is refused with one sentence that says what and what to do."""

import math
import re
import time
from pathlib import Path

import numpy as np
import pytest

import stylobate as st
from stylobate.column.assembly_files import FROM_DICT
from stylobate.column.spatial.stone import read_stones

HEAD = """
density = 2500.0
[joint]
normal_stiffness = 5e9
shear_stiffness = 2.5e9
friction_angle = 35.0
"""

COLUMN = """
name = "shaft"
section = "circular"
density = 2400.0
[tapered]
height = 4.0
bottom_width = 0.8
top_width = 0.7
drums = 4
[joint]
normal_stiffness = 5e9
shear_stiffness = 2.5e9
friction_angle = 30.0
"""

TWO = """
name = "two"
[[column]]
file = "shaft.toml"
at = [[0.0, 0.0], [1.5, 2.0]]
turn = 30.0
[[beam]]
between = ["column 1", "column 2"]
section = [0.6, 0.5]
overhang = [0.3, 0.2]
"""

CUBE = """
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
"""


@pytest.fixture
def read(tmp_path):
    (tmp_path / "shaft.toml").write_text(COLUMN)
    (tmp_path / "cube.obj").write_text(CUBE)

    def file(text):
        (tmp_path / "scene.toml").write_text(text)
        return st.read_assembly(tmp_path / "scene.toml")

    return file


def block(more, name="a"):
    return f'[[block]]\nname = "{name}"\n{more}\n'


def test_columns_and_a_beam_from_axis_to_axis(read):
    """Places, turns, densities and laws come with the columns; the beam lies along the line of their axes, 2.5 m apart."""
    assembly = read(TWO)
    names = [f"column {i}, drum {k}" for i in (1, 2) for k in (1, 2, 3, 4)]
    assert [stone.name for stone in assembly.stones] == [*names, "architrave"]
    beam = assembly.stones[-1]
    assert (beam.mass, beam.density) == (pytest.approx(2400.0 * 3.0 * 0.6 * 0.5), 2400.0)
    way = np.array([0.6, 0.8])
    assert beam.position[:2] == pytest.approx(way * (0.5 * 3.0 - 0.3), abs=1e-12)
    assert beam.position[2] == pytest.approx(4.25)
    assert beam.axes[:2, 0] == pytest.approx(way, abs=1e-12)
    assert assembly.stones[4].position[:2] == pytest.approx((1.5, 2.0))
    assert assembly.stones[0].axes[:2, 0] == pytest.approx([math.cos(math.pi / 6.0), 0.5])
    pairs = {(assembly.bodies[joint.lower].name, assembly.bodies[joint.upper].name) for joint in assembly.space_joints}
    assert ("column 1, drum 4", "architrave") in pairs
    assert ("column 2, drum 4", "architrave") in pairs
    assert len(pairs) == 10
    assert {joint.law.friction_angle for joint in assembly.space_joints} == {30.0}
    assert FROM_DICT[assembly.kind](assembly.to_dict()).digest == assembly.digest


def test_blocks_of_every_shape(read):
    """A box, a drum, a hull, a mesh in mm, a capital of two parts; turned, tilted, oriented, thrown, fixed."""
    assembly = read(
        HEAD.replace("density", "settle = false\ndensity")
        + block("box = [0.6, 0.4, 1.8]\nat = [1.0, 2.0, 0.0]\nturn = 90.0", "box")
        + block("drum = { bottom_diameter = 1.1, top_diameter = 1, height = 0.8 }\nat = [4, 0, 0]\nfixed = true", "drum")
        + block("vertices = [[6,0,0],[7,0,0],[7,1,0],[6,1,0],[6.5,0.5,1]]\nvelocity = [1.0, 0.0, 0.0]", "hull")
        + block('mesh = "cube.obj"\nat = [9.0, 0.0, 0.0]\nsurface = { friction_angle = 20.0, normal_stiffness = 1e9, '
                "shear_stiffness = 1e9 }", "mesh")
        + block("at = [12.0, 0.0, 0.0]\nparts = [{ drum = { bottom_diameter = 0.7, top_diameter = 1.0, height = 0.3 } }, "
                "{ box = [1.0, 1.0, 0.2] }]", "capital")
        + block("box = [1.0, 1.0, 1.0]\nat = [15.0, 0.0, 1.0]\ntilt = 10.0\ntowards = 90.0", "tilted")
        + block("box = [1.0, 1.0, 1.0]\nat = [18.0, 0.0, 1.0]\norientation = [0.6, 0.8, 0.0, 0.0]", "oriented")
    )  # fmt: skip
    box, drum, hull, mesh, capital, tilted, oriented = assembly.stones
    assert np.ptp(box.vertices, axis=0) == pytest.approx([0.4, 0.6, 1.8])
    assert box.position == pytest.approx((1.0, 2.0, 0.9))
    assert (drum.fixed, drum.vertices[:, 2].min()) == (True, pytest.approx(0.0, abs=1e-12))
    assert hull.mass == pytest.approx(2500.0 / 3.0)
    assert hull.position == pytest.approx((6.5, 0.5, 0.25))
    assert hull.velocity == (1.0, 0.0, 0.0)
    assert mesh.position == pytest.approx((9.5, 0.5, 0.5))
    assert mesh.surface.friction_angle == 20.0
    assert np.ptp(capital.vertices[:, 2]) == pytest.approx(0.5)
    assert len(capital.parts) == 2
    assert capital.position[:2] == (12.0, 0.0)
    # tilted towards y: its axis leans there; at stays the middle of the lower face before it is turned
    assert tilted.axes[:, 2] == pytest.approx([0.0, math.sin(math.radians(10.0)), math.cos(math.radians(10.0))])
    assert tilted.position == pytest.approx((15.0, 0.0, 1.5))
    assert oriented.orientation == (0.6, 0.8, 0.0, 0.0)
    assert FROM_DICT[assembly.kind](assembly.to_dict()).digest == assembly.digest


def test_parts_are_told_from_the_middle_of_the_lower_face(read):
    """An L of two boxes: at is the origin of its parts, and the centroid, of 1 : 0.5, is aside of it."""
    assembly = read(HEAD + block("at = [5.0, 1.0, 0.0]\nparts = [{ box = [1.0, 1.0, 1.0] }, "
                              "{ box = [1.0, 1.0, 0.5], at = [1.0, 0.0, 0.0] }]"))  # fmt: skip
    (stone,) = assembly.stones
    assert stone.position == pytest.approx((5.0 + 1.0 / 3.0, 1.0, (0.5 + 0.125) / 1.5))
    assert stone.vertices.min(axis=0) == pytest.approx((4.5, 0.5, 0.0), abs=1e-12)
    assert stone.vertices.max(axis=0) == pytest.approx((6.5, 1.5, 1.0))


def test_a_mesh_in_millimetres(read, tmp_path):
    scaled = re.sub(r"\b1\b(?=.*)", "1", CUBE).replace("v ", "v ").splitlines()
    lines = [
        " ".join(["v", *(str(1000 * int(x)) for x in line.split()[1:])]) if line[:1] == "v" else line for line in scaled
    ]
    (tmp_path / "mm.obj").write_text("\n".join(lines))
    with pytest.raises(st.InputError, match=r"mm.obj is 1000 m, and stones have 0.05 to 60 m: check .*unit = "):
        read(HEAD + block('mesh = "mm.obj"'))
    assert read(HEAD + block('mesh = "mm.obj"\nunit = "mm"')).stones[0].mass == pytest.approx(2500.0)


def test_a_mesh_is_refused_where_no_part_of_it_has_the_size_of_a_stone(tmp_path):
    """A colonnade of cubes 70 m long is one; a single cube of 40 m, thick in every direction, is none."""
    corners = [line.split()[1:] for line in CUBE.splitlines() if line[:1] == "v"]
    faces = [[int(index) for index in line.split()[1:]] for line in CUBE.splitlines() if line[:1] == "f"]
    lines = []
    for number in range(2):
        lines += [f"o cube{number}", *(f"v {int(x) + 70 * number} {y} {z}" for x, y, z in corners)]
        lines += [" ".join(["f", *(str(index + 8 * number) for index in face)]) for face in faces]
    (tmp_path / "long.obj").write_text("\n".join(lines))
    assert len(read_stones(tmp_path / "long.obj")) == 2
    forty = [" ".join(["v", *(str(40 * int(x)) for x in line.split()[1:])]) if line[:1] == "v" else line
             for line in CUBE.splitlines()]  # fmt: skip
    (tmp_path / "forty.obj").write_text("\n".join(forty))
    with pytest.raises(st.InputError, match=r"forty.obj is 40 m, and stones have at their thinnest 0 to 10 m: check"):
        read_stones(tmp_path / "forty.obj")


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("section = [0.6, 0.5]", "section = [90, 70]", r"size of block 'architrave' is 90 m, and stones have"),
        ("section = [0.6, 0.5]", "section = [0.6, 0.5]\ndensity = 2.5", r"density of block 'architrave' is 2.5 kg/m³"),
        (
            "section = [0.6, 0.5]",
            "section = [35, 28]",
            r"size of block 'architrave' across is 28 m, and stones have 0.005 to 10 m",
        ),
    ],
)
def test_beams_are_doubted_as_blocks_are(old, new, says, read):
    with pytest.warns(st.OutOfRangeWarning, match=says):
        read(TWO.replace(old, new))


@pytest.mark.parametrize(
    "shape",
    [
        "box = [120.0, 80.0, 60.0]",
        "box = [40.0, 40.0, 40.0]",
        "drum = { bottom_diameter = 95.0, top_diameter = 90.0, height = 80.0 }",
        "drum = { bottom_diameter = 40.0, top_diameter = 40.0, height = 0.8 }",
        "vertices = [[0.0, 0.0, 0.0], [80.0, 0.0, 0.0], [0.0, 60.0, 0.0], [0.0, 0.0, 90.0]]",
    ],
)
def test_stones_drawn_in_cm_are_doubted(shape, read):
    with pytest.warns(st.OutOfRangeWarning, match=r"size of block 'a'.*stones have.*check it and its unit"):
        read(HEAD + f"[[block]]\nname = 'a'\nat = [0.0, 0.0, 0.0]\n{shape}\n")


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("f 4 3 2 1\n", "", r"cube.obj has a hole at the edge of vertices 1 and 2 \(face on line 11\); close the mesh"),
        ("f 4 3 2 1", "f 1 2 3 4", "cube.obj has faces of opposite directions at the edge of vertices"),
        (
            "v 1 1 1",
            "v 0.4 0.4 0.6",
            r"cube.obj is not convex at the face on line \d+: vertex \d stands 0.\d+ out",
        ),
        (
            "f 4 3 2 1",
            "o one\nf 4 3 2 1\no two",
            r"cube.obj holds 2 parts \(one, two\); give each in a file of its own",
        ),
        ("v 0 0 0", "v 0 zero 0", "line 2 of .*cube.obj is 'v 0 zero 0', which is no line of an OBJ file"),
        ("f 4 3 2 1", "f 4 3 2 99", "line 10 of .*cube.obj is 'f 4 3 2 99'"),
        ("v 0 0 0", "v 0 0 nan", "cube.obj has a vertex that is not finite"),
        (CUBE, "hello", "cube.obj holds 0 vertices and 0 faces; a solid has four of each at least"),
    ],
)
def test_a_mesh_that_is_no_convex_stone(read, tmp_path, old, new, says):
    (tmp_path / "cube.obj").write_text(CUBE.replace(old, new))
    with pytest.raises(st.InputError, match=says):
        read(HEAD + block('mesh = "cube.obj"'))


BOX = "box = [1.0, 1.0, 1.0]\n"
HERE = BOX + "at = [0.0, 0.0, 0.0]\n"
TWICE = "at = [0.0, 0.0, 0.0]\nparts = [{ box = [1.0, 1.0, 1.0] }, { box = [1.0, 1.0, 1.0], at = [0.0, 0.0, %s] }]"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (HEAD + block(BOX), r"scene.toml: block 'a' has no at; give the middle of its lower face \[x, y, z\] in m"),
        (HEAD + block(BOX + "at = [0.0, 0.0]"), r"at of block 'a' is \[0.0, 0.0\]; give three numbers, x, y and z \[m\]"),
        (HEAD + block("at = [0.0, 0.0, 0.0]"), "block 'a' has no shape; give one of box, drum, vertices, mesh and parts"),
        (HEAD + block(BOX + 'mesh = "cube.obj"'), "block 'a' has box and mesh; give one of box, drum"),
        (HEAD + block("box = [1.0, 1.0, 0.0]\nat = [0.0, 0.0, 0.0]"), "a length of the box of block 'a' is 0 m; allowed is"),
        (HEAD + block("vertices = [[0,0,0],[1,0,0],[1,1,0],[0,1,0]]"), "lie in one plane, and it has no thickness"),
        (HEAD + block(HERE + "tilt = 3.0"), "block 'a' is tilted and has no towards"),
        (HEAD + block(HERE + "turn = 3.0\norientation = [1.0, 0.0, 0.0, 0.0]"), "an orientation and a turn"),
        (HEAD + block(HERE + "unit = 'mm'"), "block 'a' has a unit and no mesh; lengths are in m"),
        (HEAD + block(HERE + "parts = []"), "block 'a' has parts and a box; give one of the two"),
        (HEAD + block(TWICE % "0.5"),
         "parts 1 and 2 of block 'a' overlap by 500 mm, which would count twice"),
        (HEAD + block(TWICE % "2.0"),
         "part 2 of block 'a' touches no other part of it; make it a block of its own"),
        (HEAD.replace("2500.0", "2500.0\ndepth = 0.8") + block(BOX), "depth is of assemblies in the plane, and this"),
        (HEAD + block(HERE) + block("vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]", "b"),
         "block 'b' has vertices of two numbers, a polygon in the plane, among bodies in space; give x"),
        (TWO.replace("[[0.0, 0.0], [1.5, 2.0]]", "[0.0, 2.6]"), r"at of a \[\[column\]\] holds numbers, as in .* pairs"),
        (TWO.replace("[1.5, 2.0]", "[1.5]"), r"has a place \[1.5\] in at; give x and y of each axis"),
        (TWO.replace("section = [0.6, 0.5]", "height = 0.5"), "beam without a name has no section, as in the plane"),
        (TWO.replace("[0.6, 0.5]", "[0.6]"), r"section of beam 'architrave' is \[0.6\]; give \[across, height\] in m"),
        (TWO.replace('"column 2"]', '"column 3"]'), "beam 'architrave' lies between 'column 3'; did you mean column"),
        (TWO.replace("[0.3, 0.2]", "[0.3, -0.6]"), "beam 'architrave' ends in the air, 0.25 m from the top of 'column 2'"),
        (TWO + '[[link]]\nkind = "dowel"\nbetween = ["a", "b"]', "a dowel has neither material nor shear_stiffness"),
        (TWO + '[[joint_override]]\nbetween = ["a", "ground"]\nnormal_stiffness = 1e9\nshear_stiffness = 1e9\n'
         "friction_angle = 35.0",
         "a joint_override names block 'a', which does not exist"),
        (TWO.replace('file = "shaft.toml"', 'file = "shaft.toml"\nheight = 3.0'), "unknown key 'height'"),
        (TWO.replace("between = ", "on = [1, 2]\n# between = "), r"key 'on' in \[\[beam\]\] number 1; allowed"),
        ("ground = false\n" + TWO, "columns stand on the ground, and ground is false"),
        (TWO.replace('"column 2"]', '"column 1"]'), r"between of beam .* is \['column 1', 'column 1'\]; name two different"),
        (HEAD + block("vertices = [[0,0,0],[1,0,0],[0,1,0]]"), "block 'a' has 3 vertices; give four or more, those of"),
        (HEAD + block("vertices = [[0,0,0],[1,0,0],[0,1,0],[0,0,nan]]"), "z of vertex 4 of block 'a' is nan m; allowed"),
        (HEAD + block("box = [1.0, 1.0, 1.0]\nat = [0.0, inf, 0.0]"), "y of at of block 'a' is inf m; allowed is"),
        (HEAD + block(HERE + "density = -2500.0"), "density of block 'a' is -2500 kg/m³; allowed is"),
        (HEAD + block(HERE + "fixed = true"), "nothing of 'scene' can move; give a block that is not fixed"),
        ("settle = false\n" + HEAD, r"there is neither \[\[block\]\] nor \[\[column\]\]; add one of the two"),
        ("ground = false\n" + HEAD + block(HERE), "block 'a' hangs in the air; put it down, or let it fall with settle"),
        (HEAD + block(HERE) + '[[link]]\nkind = "clamp"\nbetween = ["ground", "a"]\nat = [0.4, 0.0, -0.1]\n'
         'to = [0.4, 0.0, 0.1]\ndiameter = 0.02\nmaterial = "titanium"',
         "a clamp of titanium has no embedment; give its length in each of the two stones"),
        (HEAD + block(HERE) + '[[link]]\nkind = "tie"\nbetween = ["ground", "a"]\nat = [2.0, 0.0, 0.0]\n'
         'to = [2.5, 0.0, 0.5]\ndiameter = 0.02\nmaterial = "titanium"',
         r"to of a tie is \[2.5, 0, 0.5\] m, 2 m outside block 'a'; its end must be within 1 m of it"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused(read, text, says):
    with pytest.raises(st.InputError, match=says):
        read(text)


def test_the_file_of_the_documentation_stands(tmp_path):
    root = Path(__file__).parents[2]
    page = (
        (root / "docs" / "reference" / "assembly_files.md")
        .read_text(encoding="utf-8")
        .partition("## Assemblies in space")[2]
    )
    (tmp_path / "scene.toml").write_text(re.search(r"```toml\n(.*?)```", page, re.DOTALL)[1])
    (tmp_path / "column5.toml").write_text((root / "gallery" / "assemblies" / "column5.toml").read_text())
    assembly = st.read_assembly(tmp_path / "scene.toml")
    assert [stone.name for stone in assembly.stones[-4:]] == [
        "architrave",
        "statue",
        "capital on the ground",
        "boulder",
    ]
    assert 0.1 < st.limit_directions(assembly, [0.0]).multipliers[0] < 0.3


def test_beams_that_meet_on_an_axis(read):
    """End to end they share the top; one that reaches beyond the axis is in the way of the other."""
    three = TWO.replace("[1.5, 2.0]]", "[2.6, 0.0], [5.2, 0.0]]").replace("overhang = [0.3, 0.2]\n", "")
    second = '[[beam]]\nbetween = ["column 2", "column 3"]\nsection = [0.6, 0.5]\n'
    assembly = read(three + second)
    names = [(assembly.bodies[joint.lower].name, assembly.bodies[joint.upper].name) for joint in assembly.space_joints]
    assert ("architrave 1", "architrave 2") in names
    with pytest.raises(
        st.InputError, match=r"'architrave 1' and 'architrave 2' reach beyond one another by 0\.1 m; end"
    ):
        read(three + second + "overhang = [0.1, 0.0]\n")
    with pytest.raises(st.InputError, match=r"reach beyond one another by 0\.7 m"):  # farther than a section is high
        read(three + second + "overhang = [0.7, 0.0]\n")


@pytest.mark.parametrize(
    ("more", "says"),
    [
        (
            "[as_found]\nbase_tilt = 1.0\n",
            "'shaft' stands on a base out of level",
        ),
        (
            "[[as_found.drum]]\nindex = 2\ntilt = 1.0\n",
            "drum 2 of 'shaft' is found tilted; an assembly in space",
        ),
    ],
)
def test_columns_that_assemblies_in_space_do_not_take(read, tmp_path, more, says):
    (tmp_path / "shaft.toml").write_text(COLUMN + more)
    with pytest.raises(st.InputError, match=says):
        read(TWO)


def test_a_column_as_found_enters_with_its_offsets_and_chips(read, tmp_path):
    """An offset moves a drum, a chip leaves less of its joint: the area of the face less its segment of 60 mm."""
    as_found = "[[as_found.drum]]\nindex = 2\noffset = 0.05\noffset_azimuth = 90.0\n"
    as_found += "[[as_found.drum]]\nindex = 1\nchip_left = 0.06\n"
    (tmp_path / "shaft.toml").write_text(COLUMN + as_found)
    assembly = read('[[column]]\nfile = "shaft.toml"\nat = [[0.0, 0.0]]\n')
    assert assembly.stones[1].position[1] == pytest.approx(0.05)
    half = math.acos(1.0 - 0.06 / 0.4)
    lost = 0.16 * (half - math.sin(half) * math.cos(half))
    assert assembly.space_joints[0].area == pytest.approx(0.16 * math.pi - lost, rel=1e-3)


def test_how_far_a_body_hangs_from_a_drum_is_found_in_a_moment(read):
    """From the edge of a box to a drum there is a ridge of directions, along which only the finest turns lead farther."""
    parts = "parts = [{ box = [0.5, 0.5, 0.5] }, { box = [0.855428, 0.4, 0.5] }]\nat = [-0.279554, -1.19506, 0.710368]"
    drum = "drum = { bottom_diameter = 0.613746, top_diameter = 0.730968, height = 1.0 }\nat = [0.0643682, -0.0358345, 0.0]"
    start = time.process_time()
    with pytest.raises(st.InputError, match="block 'a' hangs in the air, 549 mm from block 'b'"):
        read(HEAD + block(parts) + block(drum, "b"))
    assert time.process_time() - start < 5.0
