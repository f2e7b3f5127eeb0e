"""What stands is a structure, asked for what it is made of; nobody tells columns, assemblies and specimens apart."""

import ast
import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
from sources import sources

import stylobate as st
from stylobate.column.as_found import AsFound, FoundDrum
from stylobate.column.assembly_files import FROM_DICT
from stylobate.column.catalogue import preset
from stylobate.column.found_geometry import geometry
from stylobate.column.standing import of_column
from stylobate.column.structure import Structure

SOURCES = Path(st.__file__).parent
KINDS = {"Column", "Assembly", "Specimen", "SpatialAssembly"}
CUBE = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
LEANING = AsFound(drums=(FoundDrum(drum=2, offset=0.02), FoundDrum(drum=3, tilt=0.5)), base_tilt=0.2)


def portal_in_space():
    """Two round drums on a fixed step and a box on them, turned by 30 degrees."""
    law, turned = (
        st.Joint(5e9, 2.5e9, friction_coefficient=0.7),
        (math.cos(math.pi / 12.0), 0.0, 0.0, math.sin(math.pi / 12.0)),
    )
    sides = [np.array([x * math.cos(math.pi / 6.0), x * math.sin(math.pi / 6.0), 0.2]) for x in (-1.0, 1.0)]
    stones = [st.Stone.box((4.0, 3.0, 0.2), (0.0, 0.0, 0.0), name="step", fixed=True)]
    stones += [st.Stone.drum(0.8, 0.7, 3.0, at, 2500.0, name=name) for at, name in zip(sides, "ab", strict=True)]
    stones.append(st.Stone.box((2.8, 0.6, 0.5), (0.0, 0.0, 3.2), 2500.0, name="beam", orientation=turned))
    return st.SpatialAssembly(stones, law, "portal in space")


def standing():
    column = preset("paper-12-drums")
    leaning = column.replace(as_found=LEANING)
    return {
        "column": column,
        "as found": leaning,
        "blocks": of_column(column),
        "found blocks": of_column(leaning),
        "specimen": st.Specimen(100.0, [20.0, 20.0, 20.0], CUBE, name="cube"),
        "in space": portal_in_space(),
    }


STANDING = standing()


def names_of(node):
    """Last parts of all names in an expression."""
    for part in ast.walk(node):
        if isinstance(part, ast.Name | ast.Attribute):
            yield part.id if isinstance(part, ast.Name) else part.attr


def told_apart(tree):
    """Lines in which a kind of structure is asked for: by its class, or by the word for it."""
    asserted = {
        id(part) for assertion in ast.walk(tree) if isinstance(assertion, ast.Assert) for part in ast.walk(assertion)
    }
    for node in ast.walk(tree):
        if id(node) in asserted:  # it decides nothing
            continue
        if isinstance(node, ast.Call) and "isinstance" in names_of(node.func) and KINDS & set(names_of(node.args[1])):
            yield node.lineno
        if isinstance(node, ast.MatchClass) and KINDS & set(names_of(node.cls)):
            yield node.lineno
        if isinstance(node, ast.Compare):
            sides = (node.left, *node.comparators)
            words = {side.value for side in sides if isinstance(side, ast.Constant)} & {word.lower() for word in KINDS}
            asks = any(isinstance(side, ast.Attribute) and side.attr == "kind" for side in sides)
            typed = any(isinstance(side, ast.Call) and "type" in names_of(side.func) for side in sides)
            if (words and asks) or (typed and any(KINDS & set(names_of(side)) for side in sides)):
                yield node.lineno


@pytest.mark.parametrize("source", ["isinstance(x, Column)", "isinstance(x.y, (int, a.Assembly))", "x.kind == 'column'",
                                    "type(x) is Specimen", "match x:\n    case Column():\n        pass"])  # fmt: skip
def test_what_tells_kinds_apart_is_seen(source):
    assert list(told_apart(ast.parse(source)))


def test_nobody_below_tells_kinds_of_structures_apart():
    """Engines, statics, pictures and stores take a structure; only the room of structures knows which kinds there are."""
    files = [(name, path) for name, path in sources("py") if not name.startswith("stylobate/column/")]
    assert len(files) > 300
    lines = [(name, line) for name, path in files for line in told_apart(ast.parse(path.read_text("utf-8")))]
    assert [f"{name}:{line}" for name, line in lines] == []


@pytest.mark.parametrize("name", STANDING)
def test_a_structure_is_made_again_from_its_plain_values(name):
    structure = STANDING[name]
    assert isinstance(structure, Structure)
    again = FROM_DICT[structure.kind](structure.to_dict())
    assert again.digest == structure.digest
    assert again.described in ("a column", "an assembly", "a specimen", "an assembly in space")


@pytest.mark.parametrize("name", STANDING)
def test_bodies_stand_where_their_outlines_are(name):
    """The centroid of the outline of a prism is where the body stands; every body that moves has a mass and an inertia."""
    structure = STANDING[name]
    for body in structure.bodies:
        assert body.fixed == (body.mass == 0.0 or body.name in ("ground", "step"))
        if not body.fixed:
            assert body.mass > 0.0
            assert body.inertia > 0.0
            low, high = body.corners.min(axis=0), body.corners.max(axis=0)
            assert (low < body.place).all()
            assert (body.place < high).all()
    assert len(structure.shapes) == len(structure.bodies) - structure.first


@pytest.mark.parametrize(("column", "blocks"), [("column", "blocks"), ("as found", "found blocks")])
def test_a_column_and_its_drums_as_blocks_are_the_same_structure(column, blocks):
    """Mass, inertia, place, outline and faces; blocks are drawn in the axes of the base. To rounding: the sums differ."""
    column, blocks = STANDING[column], STANDING[blocks]
    assert len(column.bodies) == len(blocks.bodies)
    for drum, block in zip(column.bodies[1:], blocks.bodies[1:], strict=True):
        assert (drum.mass, drum.inertia) == (block.mass, block.inertia)
        np.testing.assert_allclose(drum.place, block.place, atol=1e-12)
    if not column.as_found:
        for drum, block in zip(column.bodies[1:], blocks.bodies[1:], strict=True):
            np.testing.assert_allclose(drum.corners, block.corners, atol=1e-12)
    assert len(column.face_pairs) == len(blocks.face_pairs)
    lean = [0.0, *geometry(column).lean]  # a drum's faces are in axes along its lower one
    for pair, other in zip(column.face_pairs, blocks.face_pairs, strict=True):
        assert pair[:2] == other[:2]
        assert pair.law == other.law
        for body, mine, its in ((pair.upper, pair.above, other.above), (pair.lower, pair.below, other.below)):
            assert mine.height == pytest.approx(its.height, abs=1e-12)
            assert math.atan2(*its.direction[::-1]) == pytest.approx(
                lean[body] + math.atan2(*mine.direction[::-1]), abs=1e-12
            )
            if body:  # the base has no ends
                assert (mine.left, mine.right) == pytest.approx((its.left, its.right), abs=1e-12)


def test_what_a_structure_has_not_is_none():
    for name in ("blocks", "specimen", "in space"):
        structure = STANDING[name]
        assert (
            structure.stack
            is structure.base_width
            is structure.slenderness
            is structure.uplift_acceleration
            is structure.moving_acceleration
            is None
        )
        assert set(structure.widths.values()) == {None}
    column = STANDING["column"]
    assert column.stack is column
    assert column.widths == {"base_width_m": column.base_width, "joint_width_m": float(column.joint_widths.min())}


def test_what_a_model_does_not_know_is_refused():
    still = st.Motion(0.01, np.zeros(11))
    with pytest.raises(st.InputError, match="'cube', which is a specimen; dem3d"):
        st.simulate(STANDING["specimen"], still, st.DistinctElement2D())
    with pytest.raises(st.InputError, match="is an assembly; dem2d"):
        st.simulate(STANDING["blocks"], still, st.DistinctElement3D())
    for model in (st.DistinctElement2D(), st.RigidBlock(), st.RigidBeam(), st.HousnerBlock()):
        with pytest.raises(st.InputError, match=r"cannot shake 'portal in space', .* an assembly in space; dem3d can"):
            st.simulate(STANDING["in space"], still, model)
    with pytest.raises(st.InputError, match=r"a start from a pose is for columns, and .* is an assembly"):
        st.simulate(STANDING["blocks"], still, st.DistinctElement2D(), start=st.Start(tilt=0.01))
    with pytest.raises(st.InputError, match="dem2d carries up to 0"):
        st.simulate(STANDING["blocks"], still, st.DistinctElement2D(), twins=(STANDING["column"],))


@pytest.mark.parametrize("name", ["", "  ", "a\nb", "a\tb", "a\x00", "a\x7f", "a\u2028b"], ids=ascii)
def test_a_name_is_one_line_of_text(name):
    """Of whatever stands, and of its parts: reports and files of other programs have a line for each."""
    for structure in STANDING.values():
        with pytest.raises(st.InputError, match=r"the name of an? \w+ is '.*'; write one line of text"):
            dataclasses.replace(structure, name=name)
    for make in (
        lambda: st.Stone.box((1.0, 1.0, 1.0), (0.0, 0.0, 0.0), 2500.0, name=name),
        lambda: dataclasses.replace(STANDING["blocks"].blocks[0], name=name),
        lambda: st.Dowel(joint=1, diameter=0.02, embedment=0.1, material="titanium", name=name or "\n"),
    ):
        with pytest.raises(st.InputError, match="write one line of text"):
            make()
    assert STANDING["column"].replace(name="στήλη №\xa04 «Α» 列").name.endswith("列")


def asked_of_the_package(path, tree):
    """Names that a file takes from the package itself, which stands above every room of it."""
    depth = len(path.relative_to(SOURCES).parts)
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.level == depth or node.module == "stylobate"):
            yield from (alias.name for alias in node.names if node.module in (None, "stylobate"))


def test_rooms_ask_the_package_itself_for_a_film_alone():
    """Or floors and circles would prove nothing: its names are those of all rooms. A response hands out films of itself."""
    rooms = {path.stem for path in SOURCES.iterdir()}
    imports = {
        (path.relative_to(SOURCES).as_posix(), name)
        for path in SOURCES.rglob("*.py")
        if path.relative_to(SOURCES).parts[0] != "cli"  # on top, whose commands are scripts themselves
        for name in asked_of_the_package(path, ast.parse(path.read_text("utf-8")))
        if name not in rooms
    }
    assert imports == {("response/response.py", "Film")}
