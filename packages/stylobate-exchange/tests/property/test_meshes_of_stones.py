"""Meshes as surveys and drawings have them: chips in two rings of corners, rounding, maps, axes, layouts of COMPAS."""

import json
import math
import re

import numpy as np
import pytest
import trimesh

import stylobate as st
from stylobate.column.shapes import ConvexSolid, Mesh, cut
from stylobate.column.spatial.stone import mesh_moments
from stylobate.statics.limit import limit_directions
from stylobate_exchange.compas_files import compas_json
from stylobate_exchange.convert import Reading, convert, read_model
from stylobate_exchange.mesh_writers import TEXTS, Named

MARBLE = Reading("marble")


def ring(sides):
    """Corners of a circle of radius 1, shape (sides, 2)."""
    angle = np.arange(sides) * 2.0 * math.pi / sides
    return np.column_stack((np.cos(angle), np.sin(angle)))


def prism(outline, height, radius=0.5, level=0.0, top=1.0):
    """The solid between two rings of corners, the upper one a share of the lower."""
    n = len(outline)
    lower = np.column_stack((radius * outline, np.full(n, level)))
    upper = np.column_stack((top * radius * outline, np.full(n, level + height)))
    sides = [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    return Mesh(np.concatenate((lower, upper)), (tuple(range(n - 1, -1, -1)), tuple(range(n, 2 * n)), *sides))


def moved_in(outline, deep):
    """Corners within a chip moved onto its chord, a share of the radius deep, towards x."""
    return np.column_stack((np.minimum(outline[:, 0], 1.0 - deep), outline[:, 1]))


def cut_off(outline, deep):
    """The chip cut off, with corners of its own where the chord meets the outline."""
    return cut(outline, np.array([1.0, 0.0]), 1.0 - deep)


def write(path, meshes, digits=12):
    """OBJ of meshes by name, with so many decimals."""
    lines, first = [], 1
    for name, mesh in meshes.items():
        lines.append(f"o {name}")
        lines += [" ".join(["v", *(f"{coordinate:.{digits}f}" for coordinate in point)]) for point in mesh.vertices]
        lines += [" ".join(["f", *(str(i + first) for i in face)]) for face in mesh.faces]
        first += len(mesh.vertices)
    path.write_text("\n".join(lines))
    return path


# -- drums ---------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("damage", [moved_in, cut_off])
@pytest.mark.parametrize("sides", [24, 72])
def test_a_chip_in_two_rings_of_corners_stays(damage, sides, tmp_path):
    """A chip of 5 cm of a drum of 1 m: the block tips at the distance of its edge from the centroid over half the height.

    By the polygon of its own corners, in closed form; the largest ring through all of them stood for it before.
    """
    outline = damage(ring(sides), 0.1)
    x, y = 0.5 * outline.T
    cross = x * np.roll(y, -1) - y * np.roll(x, -1)
    area = 0.5 * cross.sum()
    centroid = ((x + np.roll(x, -1)) * cross).sum() / (6.0 * area)
    path = write(tmp_path / "a.obj", {"drum": prism(outline, 4.0)})
    structure, _, words = read_model(path, MARBLE)
    (stone,) = structure.stones
    assert isinstance(stone.shape, ConvexSolid)
    assert stone.mass == pytest.approx(2700.0 * 4.0 * area, rel=1e-9)
    (limit,) = limit_directions(structure, [0.0]).limits
    assert limit.multiplier == pytest.approx((x.max() - centroid) / 2.0, rel=1e-6)
    assert "(no round drum within" in words[0]
    drum, _, words = read_model(path, Reading("marble", tolerance=0.06))
    price = float(re.search(r"limit analysis tells up to ([\d.]+) % too much", words[0])[1])
    (drum_limit,) = limit_directions(drum, [0.0]).limits
    assert drum_limit.multiplier > limit.multiplier > (1.0 - 0.01 * price - 0.001) * drum_limit.multiplier


@pytest.mark.parametrize("sides", [12, 16, 24, 64])
@pytest.mark.parametrize("top", [1.0, 0.85])
def test_a_whole_drum_goes_through_its_corners(sides, top, tmp_path):
    """Its circles go through even corners, and the words say how far its sides are within them and what that makes of it."""
    path = write(tmp_path / "a.obj", {"drum": prism(ring(sides), 0.8, top=top)})
    structure, tables, words = read_model(path, Reading("marble", "column"))
    (row,) = tables["drum"]
    assert (row["bottom_width"], row["top_width"], row["height"]) == pytest.approx((1.0, top, 0.8), abs=1e-8)
    drawn = mesh_moments(prism(ring(sides), 0.8, top=top), 1.0).mass
    more = 100.0 * (structure.drums[0].mass / 2700.0 / drawn - 1.0)
    assert f"volume is {more:+.2g} % off the mesh" in words[0]
    assert "within rounding" in words[0]


def test_errors_and_tolerance_decide_what_is_a_drum(tmp_path):
    """Corners off by up to 3 mm: no drum at 1 mm, and the tolerance that the refusal advises makes one."""
    random = np.random.default_rng(5)
    mesh = prism(ring(48), 0.8, top=0.9)
    noisy = Mesh(mesh.vertices + random.uniform(-0.003, 0.003, mesh.vertices.shape), mesh.faces)
    path = write(tmp_path / "a.obj", {"drum": noisy})
    with pytest.raises(st.InputError, match=r"`tolerance=[\d.]+`") as refusal:
        read_model(path, Reading("marble", "column"))
    advised = float(re.search(r"`tolerance=([\d.]+)`", str(refusal.value))[1])
    column, *_ = read_model(path, Reading("marble", "column", tolerance=advised))
    assert column.drums[0].bottom_width == pytest.approx(1.0, abs=0.003)


def test_flutes_are_no_drum(tmp_path):
    """Twenty flutes of 20 mm: refused by how deep they are."""
    outline = ring(80) * np.tile([1.0, 0.97, 0.96, 0.97], 20)[:, None]
    mesh = prism(outline, 0.8)
    vertices = np.concatenate((mesh.vertices, [[0.0, 0.0, 0.0], [0.0, 0.0, 0.8]]))
    ends = [
        (a, b, 160 + k) for k, end in enumerate(mesh.faces[:2]) for a, b in zip(end, (*end[1:], end[0]), strict=True)
    ]
    path = write(tmp_path / "a.obj", {"drum": Mesh(vertices, (*ends, *mesh.faces[2:]))})
    with pytest.raises(
        st.InputError, match=r"lies \d+\.\d mm within its hull, and a drum does not fit it by \d+\.\d mm"
    ):
        read_model(path, MARBLE)


def test_points_within_a_flat_face_take_no_volume_away():
    """The middle of a face that rounding puts 1e-8 out of it was a corner of its outline: 7 % of a mass were gone."""
    box = np.array([(x, y, z) for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    middles = np.array([(0.5, 0.5, -1e-8), (0.5, 0.5, 1.0 + 1e-8), (1.0 + 1e-8, 0.5, 0.5), (0.5, -1e-8, 0.5)])
    made = ConvexSolid(np.concatenate((box, middles)))
    assert mesh_moments(made.mesh(), 1.0).mass == pytest.approx(1.0, rel=1e-7)


def test_a_scan_of_many_corners_is_thinned(tmp_path):
    """A boulder of 642 corners on an ellipsoid, of which 160 remain; the words say what is lost."""
    ball = trimesh.creation.icosphere(3, 0.5)
    ball.vertices *= (1.0, 0.8, 0.6)
    flat = trimesh.convex.convex_hull(np.maximum(ball.vertices, (-1.0, -1.0, -0.2)))
    path = write(
        tmp_path / "a.obj", {"boulder": Mesh(np.asarray(flat.vertices), tuple(map(tuple, flat.faces.tolist())))}
    )
    with pytest.raises(st.InputError, match=r"lies [\d.]+ mm within its hull.*`tolerance=[\d.]+`"):
        read_model(path, MARBLE)
    structure, _, words = read_model(path, Reading("marble", tolerance=0.02))
    less = 100.0 * (structure.stones[0].mass / (2700.0 * flat.volume) - 1.0)
    assert -4.0 < less < -1.0
    assert f"block of 160 corners, within 8.28 mm; its volume is {less:+.2g} % off the mesh" in words[0]


# -- stones that touch ---------------------------------------------------------------------------------------------------


def arch(turn, shift=(0.0, 0.0, 0.0), number=15, radius=3.0, thick=0.6, wide=0.8):
    """Voussoirs of a semicircular arch that stands askew to the axes, whose faces are shared exactly."""
    c, s = math.cos(turn), math.sin(turn)
    stones = {}
    for k in range(number):
        angles = [k * math.pi / number, (k + 1) * math.pi / number]
        around = [
            (radius + out * thick, a) for out, a in zip((-0.5, 0.5, 0.5, -0.5), np.repeat(angles, 2), strict=True)
        ]
        points = [(r * math.cos(a), y * wide, r * math.sin(a)) for y in (-0.5, 0.5) for r, a in around]
        turned = np.array([(c * x - s * y, s * x + c * y, z) for x, y, z in points]) + shift
        sides = [(i, 4 + i, 4 + (i + 1) % 4, (i + 1) % 4) for i in range(4)]
        stones[f"voussoir {k + 1}"] = Mesh(turned, ((0, 1, 2, 3), (7, 6, 5, 4), *sides))
    return stones


@pytest.mark.parametrize(("digits", "shift"), [(3, (0, 0, 0)), (4, (0, 0, 0)), (3, (478123.5, 4205344.5, 12.0))])
def test_what_rounding_leaves_between_stones_is_closed(digits, shift, tmp_path):
    """An arch askew to the axes in OBJ of few decimals: one joint a face, and what it bears, as of the exact one.

    It bears as much within twice the rounding over the smallest thickness that a hinge line passes, 0.6 m.
    """
    exact, *_ = read_model(write(tmp_path / "a.obj", arch(0.5)), MARBLE)
    structure, _, words = read_model(write(tmp_path / "b.obj", arch(0.5, shift), digits), MARBLE)
    assert len(exact.space_joints) == len(structure.space_joints) == 16
    assert any(re.search(r"brought into common planes: corners moved by up to 0\.\d+ mm", word) for word in words)
    assert sum(stone.mass for stone in structure.stones) == pytest.approx(
        sum(stone.mass for stone in exact.stones), rel=1e-3
    )
    azimuth = [math.degrees(0.5)]
    exact_multiplier, other = (limit_directions(each, azimuth).limits[0].multiplier for each in (exact, structure))
    assert other == pytest.approx(exact_multiplier, rel=2.0 * 10.0**-digits / 0.6)


def test_gaps_and_overlaps_up_to_the_tolerance_are_closed(tmp_path):
    """Two boxes 0.4 mm apart, and 0.4 mm in one another, become two that touch; at 0.1 mm they are refused."""
    box = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    for gap in (0.0004, -0.0004):
        path = write(tmp_path / f"{gap}.obj", {"a": prism(box, 0.8), "b": prism(box, 0.8, level=0.8 + gap)})
        structure, *_ = read_model(path, MARBLE)
        assert len(structure.space_joints) == 2
        assert sum(stone.mass for stone in structure.stones) == pytest.approx(2700.0 * (1.6 + gap), rel=1e-9)
        with pytest.raises(st.InputError, match=r"(hangs in the air|overlap by).* allow more with `tolerance=0\.002`"):
            read_model(path, Reading("marble", tolerance=1e-4))


def test_a_ground_alone_is_no_model(tmp_path):
    box = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    with pytest.raises(st.InputError, match="holds a ground and no stones"):
        read_model(write(tmp_path / "a.obj", {"ground": prism(box, 0.8)}), MARBLE)


# -- where and how it stands ---------------------------------------------------------------------------------------------


def test_a_place_on_a_map_is_taken_off_and_stated(tmp_path):
    """UTM in double precision: the same column; in single precision it is refused by how much that rounds."""
    shift = np.array([478123.25, 4205344.25, 152.5])
    drum = prism(ring(72), 0.8)
    there = Mesh(drum.vertices + shift, drum.faces)
    structure, _, words = read_model(write(tmp_path / "a.obj", {"drum": there}), MARBLE)
    assert "its place was taken off: coordinates count from x = 478122 m, y = 4205343 m" in words
    assert structure.stones[0].position == pytest.approx((1.25, 1.25, 152.9), abs=1e-6)
    faces = [(face[0], face[i], face[i + 1]) for face in drum.faces for i in range(1, len(face) - 1)]
    trimesh.Trimesh(there.vertices.astype("f4"), faces, process=False).export(tmp_path / "a.ply")
    with pytest.raises(st.InputError, match="of single precision, are rounded by up to 250 mm"):
        read_model(tmp_path / "a.ply", MARBLE)


@pytest.mark.parametrize("ending", [".obj", ".ply", ".stl"])
def test_the_axis_upward_is_stated(ending, tmp_path):
    """Two boxes on one another, y upward as Blender writes it: side by side with z upward, a stack with ``up``."""
    box = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    named = []
    for name, level in (("a", 0.0), ("b", 0.8)):
        x, y, z = prism(box, 0.8, level=level).vertices.T
        named.append(Named(name, Mesh(np.stack((x, z, -y), axis=1), prism(box, 0.8).faces)))
    (tmp_path / f"a{ending}").write_text(TEXTS[ending](named))
    beside, _, words = read_model(tmp_path / f"a{ending}", MARBLE)
    assert "z is taken as upward; `up` says otherwise" in words
    assert np.ptp([stone.position[2] for stone in beside.stones]) == pytest.approx(0.0)
    stacked, *_ = read_model(tmp_path / f"a{ending}", Reading("marble", up="y"))
    assert sorted(stone.position[2] for stone in stacked.stones) == pytest.approx([0.4, 1.2])
    with pytest.raises(st.InputError, match="`up` is 'x'; allowed are y, z"):
        Reading("marble", up="x")


def test_what_a_format_does_not_hold_is_stated(tmp_path):
    """PLY has no names, by which parts of one body are known; of supports meshes know nothing."""
    (tmp_path / "a.toml").write_text(
        """
        material = "marble"
        [[block]]
        name = "base"
        box = [2.0, 2.0, 0.5]
        at = [0.0, 0.0, 0.0]
        fixed = true
        [[block]]
        name = "statue"
        parts = [{ box = [0.6, 0.4, 0.5] }, { box = [0.4, 0.4, 1.0], at = [0.0, 0.0, 0.5] }]
        at = [0.0, 0.0, 0.5]
        """
    )
    for ending, glued in ((".ply", True), (".obj", False), (".stl", False), (".glb", False)):
        _, words, _ = convert(str(tmp_path / "a.toml"), tmp_path / f"b{ending}", Reading())
        assert any("the parts of 'statue' come loose" in word for word in words) == glued
        assert any("supports are not kept: 'base'" in word for word in words)


# -- COMPAS --------------------------------------------------------------------------------------------------------------


def plain_meshes():
    """Two boxes on one another as COMPAS keeps meshes."""
    box = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    blocks = [("a", prism(box, 0.8), True, 0.0), ("b", prism(box, 0.8, level=0.8), False, 0.0)]
    model, assembly = (json.loads(compas_json("pair", blocks, layout)) for layout in ("dem", "assembly"))
    meshes = [element["data"]["geometry"] for element in model["data"]["elements"].values()]
    return meshes, model, assembly


def test_layouts_of_compas_in_use(tmp_path):
    """A list of meshes, one mesh, a model with its elements in a list, an assembly of compas_cra."""
    meshes, model, assembly = plain_meshes()
    model["data"]["elements"] = list(model["data"]["elements"].values())
    assembly["dtype"] = "compas_cra.datastructures/CRA_Assembly"
    for content, fixed in (
        (meshes, [False, False]),
        (meshes[0], [False]),
        (model, [True, False]),
        (assembly, [True, False]),
    ):
        (tmp_path / "a.json").write_text(json.dumps(content))
        structure, *_ = read_model(tmp_path / "a.json", MARBLE)
        assert [stone.fixed for stone in structure.stones] == fixed
        assert structure.stones[0].mass == pytest.approx(2700.0 * 0.8)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ([{"dtype": "compas.geometry/Box"}] * 2, r"holds a list of 2 \(compas.geometry/Box\)"),
        ({"datatype": "compas_assembly.datastructures/Assembly"}, r"holds an object of COMPAS 1 \(compas_assembly"),
        ({"a": 1}, "holds JSON of another program"),
        ([], "holds a list of 0"),
        (None, "holds no object"),
    ],
)
def test_what_json_holds_is_stated_and_the_remedy_works(content, says, tmp_path):
    """Refused with what it holds; its blocks as closed meshes, as advised, are read."""
    (tmp_path / "a.json").write_text(json.dumps(content))
    with pytest.raises(st.InputError, match=says + ".*write its blocks as closed meshes, in OBJ"):
        read_model(tmp_path / "a.json", MARBLE)
    box = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    read_model(write(tmp_path / "a.obj", {"a": prism(box, 0.8)}), MARBLE)


def test_a_mesh_of_compas_with_a_hole_is_refused(tmp_path):
    meshes, *_ = plain_meshes()
    meshes[0]["data"]["face"].pop("0")
    (tmp_path / "a.json").write_text(json.dumps(meshes))
    with pytest.raises(st.InputError, match=r"block 'a' of .* has a hole at the edge"):
        read_model(tmp_path / "a.json", MARBLE)
