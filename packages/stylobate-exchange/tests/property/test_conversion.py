"""Models of other tools become stones here, and go back: round trips, fits, COMPAS JSON, surveys, what is refused."""

import csv
import io
import json
import math
import re
from contextlib import nullcontext
from datetime import datetime
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import openpyxl
import pytest
import trimesh
from hypothesis import given, settings, strategies

import stylobate as st
from stylobate.column.as_found import AsFound, FoundDrum
from stylobate.column.assembly_files import FROM_DICT, load_structure
from stylobate.column.catalogue import preset
from stylobate.column.files import write_column
from stylobate.column.found_geometry import space_geometry
from stylobate.column.links import Dowel
from stylobate.column.projection import project
from stylobate.column.tables import made_of
from stylobate_exchange.convert import Reading, convert, read_model
from stylobate_exchange.survey import survey_tables, survey_text

GALLERY = Path(__file__).parents[4] / "gallery" / "assemblies"
COMPAS = Path(__file__).parent / "compas"
MARBLE = Reading("marble")
ENDINGS = (".obj", ".ply", ".stl", ".glb", ".json")

#: Note on a survey that states no section.
ROUND = "taken as round: no line `# section: rectangular` says otherwise"


def volumes(structure):
    return sorted(
        sum(trimesh.Trimesh(*_triangles(part.mesh(48))).volume for part in body.placed)
        for body in structure.bodies
        if not body.fixed
    )


def _triangles(mesh):
    return mesh.vertices, [(face[0], face[i], face[i + 1]) for face in mesh.faces for i in range(1, len(face) - 1)]


@pytest.mark.parametrize("ending", ENDINGS)
@pytest.mark.parametrize("name", ["doric", "leaning_drum", "wall_corner", "two_columns"])
def test_there_and_back(name, ending, tmp_path):
    """As many bodies and joints, drums as drums, the same volumes: single precision of metres in .glb, 1e-6."""
    first = load_structure(GALLERY / f"{name}.toml")
    convert(str(GALLERY / f"{name}.toml"), tmp_path / f"a{ending}", Reading())
    convert(str(tmp_path / f"a{ending}"), tmp_path / "b.toml", MARBLE)
    second = load_structure(tmp_path / "b.toml")
    joints = first.face_pairs if first.space_joints is None else first.space_joints
    assert len(second.space_joints) == len(joints)
    assert volumes(second) == pytest.approx(volumes(first), rel=3e-6)
    if ending in (".obj", ".glb", ".json"):
        assert [body.name for body in second.bodies] == [body.name for body in first.bodies]
    if name == "doric":
        shapes = [stone.shape for stone in second.stones]
        if ending == ".ply":
            shapes.sort(key=lambda shape: -shape.bottom)
        for drum, shape in zip(first.drums, shapes, strict=True):
            fits = (shape.bottom, shape.top, shape.height)
            assert fits == pytest.approx((drum.bottom_width, drum.top_width, drum.height), abs=1e-6)


@pytest.mark.parametrize("ending", [".obj", ".stl", ".glb", ".json"])
def test_a_body_of_several_parts_stays_one(ending, tmp_path):
    first = load_structure(GALLERY / "statue.toml")
    convert(str(GALLERY / "statue.toml"), tmp_path / f"a{ending}", Reading())
    fixed = () if ending == ".json" else ("step",)  # COMPAS knows supports, meshes do not
    second, *_ = read_model(tmp_path / f"a{ending}", Reading("marble", ground=0.0, fixed=fixed))
    assert [len(stone.parts) for stone in second.stones] == [len(stone.parts) for stone in first.stones]
    assert [stone.fixed for stone in second.stones] == [True, False, False]
    assert volumes(second) == pytest.approx(volumes(first), rel=3e-6)


def test_what_was_exported_from_a_run_can_be_stood_up_again(tmp_path):
    """A part called ``ground`` tells the level of the ground, and is no stone."""
    part = trimesh.creation.box((4.0, 4.0, 0.1), trimesh.transformations.translation_matrix([0.0, 0.0, 1.95]))
    stone = trimesh.creation.box((1.0, 1.0, 1.0), trimesh.transformations.translation_matrix([0.0, 0.0, 2.5]))
    step = trimesh.creation.box((1.0, 1.0, 1.0), trimesh.transformations.translation_matrix([3.0, 0.0, 2.5]))
    write(tmp_path / "a.obj", {"ground": part, "stone": stone})
    write(tmp_path / "b.obj", {"ground": part, "stone": stone, "step": step})
    structure, tables, _ = read_model(tmp_path / "a.obj", MARBLE)
    assert tables["ground"] == pytest.approx(2.0)
    assert [stone.name for stone in structure.stones] == ["stone"]
    moved, *_ = read_model(tmp_path / "b.obj", Reading("marble", fixed=("step",)))
    assert moved.ground == pytest.approx(2.0)  # it stays where there are supports, too


def write(path, meshes):
    """An OBJ file of meshes by name, as other programs write it."""
    lines, first = [], 1
    for name, mesh in meshes.items():
        lines.append(f"o {name}")
        lines += ["v {:.10g} {:.10g} {:.10g}".format(*point) for point in mesh.vertices]
        lines += ["f {} {} {}".format(*(face + first)) for face in mesh.faces]
        first += len(mesh.vertices)
    path.write_text("\n".join(lines))


def scanned(bottom, top, height, noise, seed=0):
    """A frustum as a scan has it: its sides and faces in small triangles, every vertex off by up to the noise [m]."""
    mesh = trimesh.creation.cylinder(0.5, height, sections=64)
    mesh = mesh.subdivide().subdivide()
    share = mesh.vertices[:, 2] / height + 0.5
    mesh.vertices[:, :2] *= (bottom + (top - bottom) * share)[:, None]
    radius = np.hypot(mesh.vertices[:, 0], mesh.vertices[:, 1])
    edge = radius > 0.48 * min(bottom, top)  # what subdividing leaves on chords goes out to the circle
    mesh.vertices[edge, :2] *= (0.5 * (bottom + (top - bottom) * share) / np.where(radius > 0, radius, 1.0))[edge, None]
    random = np.random.default_rng(seed)
    way = random.standard_normal(mesh.vertices.shape)
    mesh.vertices += noise * way / np.linalg.norm(way, axis=1)[:, None]
    return mesh


def test_a_drum_is_fitted_to_a_scan(tmp_path):
    """Diameters, height and axis within the noise of 2 mm: hundreds of vertices tell them better than each is."""
    mesh = scanned(1.0, 0.9, 0.7, 0.002)
    lean = trimesh.transformations.rotation_matrix(math.radians(3.0), [0.0, 1.0, 0.0])
    mesh.apply_transform(trimesh.transformations.translation_matrix([5.0, -2.0, 1.0]) @ lean)
    write(tmp_path / "a.obj", {"drum": mesh})
    with pytest.raises(st.InputError, match=r"'drum' is not convex: .* and a drum does not fit it by [12]\.\d+ mm"):
        read_model(tmp_path / "a.obj", MARBLE)
    _, tables, words = read_model(tmp_path / "a.obj", Reading("marble", tolerance=0.003, becomes="column"))
    (row,) = tables["drum"]
    assert (row["bottom_width"], row["top_width"], row["height"]) == pytest.approx((1.0, 0.9, 0.7), abs=0.002)
    (found_drum,) = tables["as_found"]["drum"]
    assert found_drum["tilt"] == pytest.approx(-3.0, abs=0.2)
    assert found_drum["tilt_azimuth"] == pytest.approx(0.0, abs=5.0)
    assert "drum: drum ⌀" in words[0]


def test_a_column_as_found_comes_back_from_its_mesh(tmp_path):
    """Offsets and leans with their azimuths; drums of 48 corners whose feet are off by less than a micrometre."""
    as_found = AsFound((FoundDrum(2, offset=0.03, offset_azimuth=120.0), FoundDrum(3, tilt=-1.2, tilt_azimuth=60.0)))
    drums = [st.Drum(0.8, 1.0 - 0.05 * i, 0.95 - 0.05 * i, 2700.0, "circular") for i in range(4)]
    column = st.Column.of_drums(drums, st.Joint(1e9, 1e9, 35.0), name="found").replace(as_found=as_found)
    write_column(column, tmp_path / "a.toml")
    convert(str(tmp_path / "a.toml"), tmp_path / "a.obj", Reading())
    again, _, words = read_model(tmp_path / "a.obj", Reading("marble", becomes="column"))
    original, other = (space_geometry(each) for each in (column, again))
    assert other.centroid == pytest.approx(original.centroid, abs=1e-6)
    second, third = again.as_found.of(2), again.as_found.of(3)
    assert (second.offset, second.offset_azimuth) == pytest.approx((0.03, 120.0), abs=1e-4)
    assert (third.tilt, third.tilt_azimuth) == pytest.approx((-1.2, 60.0), abs=1e-4)
    assert words[-1].startswith("its drums stand where the mesh has them within")


def test_a_stone_that_is_not_convex_is_refused_by_how_much(tmp_path):
    """An L of 1 m with a step of 0.5 m: its inner corner lies 0.25·√2 m within the hull."""
    polygon = [(0, 0), (1, 0), (1, 0.5), (0.5, 0.5), (0.5, 1), (0, 1)]
    faces = [(0, 3, 2), (0, 2, 1), (0, 5, 4), (0, 4, 3)]
    points = [(x, y, z) for z in (0.0, 1.0) for x, y in polygon]
    sides = [(i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i) for i in range(6)]
    every = [*faces, *(tuple(6 + i for i in reversed(face)) for face in faces)]
    every += [part for a, b, c, d in sides for part in ((a, b, c), (a, c, d))]
    write(tmp_path / "a.obj", {"L": trimesh.Trimesh(points, every, process=False)})
    with pytest.raises(st.InputError, match=r"part 'L' is not convex: it lies 354 mm within its hull"):
        read_model(tmp_path / "a.obj", MARBLE)


def test_boxes_and_prisms_are_no_drums(tmp_path):
    """The corners of a box lie on a circle; an octagonal pier is none either."""
    box = trimesh.creation.box((1.0, 1.0, 1.0))
    pier = trimesh.creation.cylinder(0.5, 2.0, sections=8)
    pier.apply_translation((3.0, 0.0, 0.5))
    write(tmp_path / "a.obj", {"box": box, "pier": pier})
    structure, *_ = read_model(tmp_path / "a.obj", MARBLE)
    assert [len(stone.shape.vertices) for stone in structure.stones] == [8, 16]
    with pytest.raises(st.InputError, match="part 'box' is no round drum; a column is made of such"):
        read_model(tmp_path / "a.obj", Reading("marble", becomes="column"))


@pytest.mark.parametrize("name", ["model", "assembly"])
def test_what_compas_writes_is_read(name):
    """Two boxes, the lower one a support; written by compas_dem 0.6.0 and compas_assembly 0.7.1 (compas 2.15.1)."""
    structure, *_ = read_model(COMPAS / f"{name}.json", MARBLE)
    assert [stone.fixed for stone in structure.stones] == [True, False]
    assert [stone.position for stone in structure.stones] == [pytest.approx((0, 0, 0.25)), pytest.approx((0, 0, 0.75))]
    assert structure.ground is None


def keys_of(plain):
    """Every path of keys in plain values; keys that are numbers or identifiers are one."""
    if isinstance(plain, list):
        return {(0, *path) for item in plain for path in keys_of(item)} | {()}
    if not isinstance(plain, dict):
        return {()}
    named = {key if key.isidentifier() and len(key) < 30 else "*": value for key, value in plain.items()}
    return {(key, *path) for key, value in named.items() for path in keys_of(value)} | {()}


@pytest.mark.parametrize(("name", "layout"), [("model", "dem"), ("assembly", "assembly")])
def test_compas_finds_the_keys_that_it_writes(name, layout, tmp_path):
    """Every key of a file that COMPAS itself wrote, but what it may leave out, is in ours of the same model."""
    text = (COMPAS / f"{name}.json").read_text()
    convert(str(COMPAS / f"{name}.json"), tmp_path / "a.toml", MARBLE)
    convert(str(tmp_path / "a.toml"), tmp_path / "a.json", Reading(), layout)
    theirs, ours = keys_of(json.loads(text)), keys_of(json.loads((tmp_path / "a.json").read_text()))
    optional = ("inheritance", "transformation", "facedata", "edgedata", "attributes")
    missing = {path for path in theirs - ours if not any(key in optional for key in path)}
    assert missing == set()
    second, *_ = read_model(tmp_path / "a.json", MARBLE)
    assert [stone.name for stone in second.stones] == [block["name"] for block in _blocks(tmp_path / "a.toml")]


def _blocks(path):
    import tomllib

    return tomllib.loads(path.read_text())["block"]


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda text: "{", "is no JSON"),
        (lambda text: "[]", "holds a list of 0; allowed are objects of COMPAS 2"),
        (lambda text: text.replace("compas_dem.models/BlockModel", "compas.datastructures/Graph"), "holds compas.data"),
        (lambda text: text.replace('"tree"', '"wood"'), "is not laid out as COMPAS 2 writes it"),
        (
            lambda text: text.replace('"face"', '"facets"', 1),
            "is a compas.datastructures/Mesh; give blocks whose geometry",
        ),
        (lambda text: text.replace("-0.3", "NaN", 1), "is no solid"),
        (lambda text: text.replace('"features": []', '"features": [{}]', 1), "has features or modifiers"),
        (lambda text: text.replace('"children"', '"others"'), "holds no blocks"),
        (lambda text: text.replace("[[1.0, 0.0", "[[1.0"), "is not laid out as COMPAS 2"),
    ],
)
def test_what_is_no_model_of_compas(change, says, tmp_path):
    (tmp_path / "a.json").write_text(change((COMPAS / "model.json").read_text()))
    with pytest.raises(st.InputError, match=says):
        read_model(tmp_path / "a.json", MARBLE)


# -- surveys -------------------------------------------------------------------------------------------------------------


@pytest.mark.filterwarnings("ignore::stylobate.errors.OutOfRangeWarning")  # sizes at random are not plausible
@settings(max_examples=25, deadline=None)
@given(
    strategies.lists(
        strategies.tuples(*(strategies.floats(0.2, 2.0) for _ in range(3)), strategies.floats(1000.0, 3000.0)),
        min_size=1,
        max_size=5,
    ),
    strategies.booleans(),
    strategies.integers(0, 2**32),
)
def test_a_survey_is_the_column_to_the_last_digit(tmp_path_factory, sizes, round_, seed):
    random = np.random.default_rng(seed)
    section = "circular" if round_ else "rectangular"
    depth = {} if round_ else {"depth": 0.7, "top_depth": 0.6}
    drums = [st.Drum(h, max(b, t), min(b, t), density, section, **depth) for h, b, t, density in sizes]
    joints = [st.Joint(1e9 * (1.0 + random.random()), 1e9, friction_angle=30.0 + random.random()) for _ in drums]
    found_drums = [
        FoundDrum(i, offset=1e-3 * random.random(), turn=random.random(), chip_left=0.01) for i in range(2, len(drums))
    ]
    base = AsFound(tuple(found_drums), float(random.random()), 37.0)
    column = st.Column.of_fields(
        drums=tuple(drums), joints=tuple(joints), as_found=base, links=(), name="a, b", gravity=9.81, material=None
    )
    path = tmp_path_factory.mktemp("survey") / "a.csv"
    path.write_text(survey_text(column), encoding="utf-8")
    again = made_of(st.Column, survey_tables(path)[0])
    assert again.to_dict() == column.to_dict()


def test_a_survey_from_a_spreadsheet(tmp_path):
    """Semicolons, decimal commas, millimetres, a byte order mark, quotes that a spreadsheet puts around notes."""
    text = (
        '\ufeff"# name: north, 3";;;;\n# material: marble;;;;\nDrum;Height [mm];bottom width (mm);top_width_mm;offset_mm\n'
        "1;812,5;1000;980;\n2;790;980;960;12,5\n;;;;\n"
    )
    (tmp_path / "a.csv").write_text(text, encoding="utf-8")
    structure, files = convert(str(tmp_path / "a.csv"), tmp_path / "a.toml", Reading())[::2]
    column = load_structure(files[0])
    assert (column.name, column.section, column.material) == ("north, 3", "circular", "marble, dry")
    assert [drum.height for drum in column.drums] == [0.8125, 0.79]
    assert column.as_found.of(2).offset == pytest.approx(0.0125)
    assert structure.to_dict() == column.to_dict()
    convert(str(files[0]), tmp_path / "b.csv", Reading())
    again, *_ = read_model(tmp_path / "b.csv", Reading())
    assert again.to_dict() == column.to_dict()


def workbook(path, *sheets):
    """A workbook with sheets of rows of cells."""
    book = openpyxl.Workbook()
    book.remove(book.active)
    for rows in sheets:
        sheet = book.create_sheet()
        for row in rows:
            sheet.append(row)
    book.save(path)
    return str(path)


SHEET = [
    ["# name: north, 3"],
    ["# material: marble"],
    ["drum", "height_m", "bottom_width_m", "top_width_m", "offset_mm", "note"],
    [1, 0.8125, 1, 0.98, None, "cracked, at NE"],
    [2, 0.79, 0.98, 0.96, 12.5, None],
]


@pytest.mark.parametrize("beside", [[], [None, " "]], ids=["from A1", "from B2, and with a blank cell behind"])
def test_a_survey_in_a_workbook(beside, tmp_path):
    rows = [beside, *([*beside[:1], *row, *beside] for row in SHEET)]
    column, _, words = read_model(Path(workbook(tmp_path / "a.xlsx", rows, [])), Reading())
    (tmp_path / "a.csv").write_text(survey_text(column))
    assert read_model(tmp_path / "a.csv", Reading())[0].to_dict() == column.to_dict()
    assert (column.name, [drum.height for drum in column.drums]) == ("north, 3", [0.8125, 0.79])
    assert column.as_found.of(2).offset == 0.0125
    assert words[1:] == [ROUND, "drum 1: cracked, at NE"]


@pytest.mark.parametrize(
    ("cell", "says"),
    [
        ("#REF!", "has '#REF!' in E5, where a formula of the spreadsheet has failed"),
        ("#SPILL!", "has a cell '#SPILL!', where a formula of the spreadsheet has failed"),
        ("1_2", "offset in row 2 of .* is '1_2'; give a number"),
        ("=D4-0.02", "has a formula without a value in E5; open it in the spreadsheet"),
        ("12,5", "offset in row 2 of .* is '12,5'; give a number"),
        (datetime(2026, 5, 12), "offset in row 2 of .* is '2026-05-12 00:00:00'; give a number"),
    ],
)
def test_what_a_cell_of_a_workbook_cannot_be(cell, says, tmp_path):
    wrong = [*SHEET[:-1], [2, 0.79, 0.98, 0.96, cell]]
    with pytest.raises(st.InputError, match=says):
        convert(workbook(tmp_path / "a.xlsx", wrong), tmp_path / "b.toml", Reading())
    assert not (tmp_path / "b.toml").exists()


def test_a_workbook_of_several_surveys_or_of_none(tmp_path):
    with pytest.raises(st.InputError, match="has 2 sheets that hold something"):
        read_model(Path(workbook(tmp_path / "a.xlsx", SHEET, SHEET)), Reading())
    with pytest.raises(st.InputError, match="holds no row of a drum"):
        read_model(Path(workbook(tmp_path / "b.xlsx", [])), Reading())
    (tmp_path / "c.xlsx").write_bytes(b"PK\x03\x04\xff\xfe")
    with pytest.raises(st.InputError, match=r"is no workbook of a spreadsheet \(BadZipFile\); save the survey as CSV"):
        read_model(tmp_path / "c.xlsx", Reading())


def hide_row(sheet):
    sheet.row_dimensions[5].hidden = True


def hide_columns(sheet):
    sheet.column_dimensions.group("D", "E", hidden=True)


def format_far_cell(sheet):
    sheet.cell(1_048_576, 16_384).number_format = "0.00"


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (hide_row, "holds something in A5, which is hidden"),
        (hide_columns, "holds something in D3, which is hidden"),
        (lambda sheet: sheet.merge_cells("E4:E5"), "has merged cells in E4:E5"),
        (lambda sheet: sheet.cell(600_000, 1, "x"), "has cells in 600000 rows and 6 columns"),
        (lambda sheet: sheet.merge_cells("A1:F1"), ""),
        (format_far_cell, ""),
    ],
)
def test_nothing_of_a_sheet_is_left_out_unseen(change, says, tmp_path):
    path = Path(workbook(tmp_path / "a.xlsx", [*SHEET[:3], [1, 0.8125, 1, 0.98, 5, None], SHEET[4]]))
    book = openpyxl.load_workbook(path)
    change(book.active)
    book.save(path)
    with pytest.raises(st.InputError, match=says) if says else nullcontext():
        assert read_model(path, Reading())[0].n == 2


def test_a_formula_that_comes_to_no_text_leaves_its_cell_empty(tmp_path):
    path = Path(workbook(tmp_path / "a.xlsx", [*SHEET[:4], [*SHEET[4][:4], '=IF(1,"",2)']]))
    with ZipFile(path) as before:
        files = {name: before.read(name) for name in before.namelist()}
    sheet = files["xl/worksheets/sheet1.xml"]
    assert b'<c r="E5"><f>' in sheet
    files["xl/worksheets/sheet1.xml"] = sheet.replace(b'<c r="E5"><f>', b'<c r="E5" t="str"><f>')
    with ZipFile(path, "w") as after:
        for name, content in files.items():
            after.writestr(name, content)
    assert read_model(path, Reading())[0].as_found.of(2).offset == 0.0


def test_no_drum_is_lost_in_a_note(tmp_path):
    """Notes of several lines, that begin with #, that have every separator of lines; facts in two cells."""
    rows = [
        ["# name:", "north, 3"],
        ["# base_tilt:", 1.5],
        ["note", "height_m", "bottom_width_m", "top_width_m"],
        ["# replaced 1999", 1, 1, 0.98],
        ["cracks:\n# photo 3\n# name: Zeus", 1, 0.98, 0.96],
        ["a\u0085b\u2028c", 1, 0.96, 0.94],
        ["# top", 1, 0.94, 0.92],
    ]
    text = io.StringIO()
    csv.writer(text).writerows(rows)
    (tmp_path / "a.csv").write_text(text.getvalue(), encoding="utf-8", newline="")
    for path in (tmp_path / "a.csv", Path(workbook(tmp_path / "a.xlsx", rows))):
        column, _, words = read_model(path, MARBLE)
        assert (column.n, column.name, column.as_found.base_tilt) == (4, "north, 3", 1.5)
        assert words[1:] == [
            ROUND,
            "drum 1: # replaced 1999",
            "drum 2: cracks: # photo 3 # name: Zeus",
            "drum 3: a b c",
            "drum 4: # top",
        ]


HEAD = "drum,height_m,bottom_width_m,top_width_m"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "holds no row of a drum"),
        (HEAD, "holds no row of a drum"),
        (f"Colonna 4\n{HEAD}\n1,1,1,1", "has a line 'Colonna 4' above its table, .*; put a # before it"),
        ("drum,height_m,bottom_width_m\n1,1,1", "has no column 'top_width'"),
        (f"{HEAD},hight_m\n1,1,1,1,1", "has a column 'hight_m'; did you mean height"),
        (f"{HEAD},height_mm\n1,1,1,1,1", "has two columns of 'height'"),
        (f"{HEAD}\n1,1,1,one", "top_width in row 1 of .* is 'one'; give a number"),
        (f"{HEAD}\n1,1,1,", "row 1 of .* has no top_width"),
        (f"{HEAD}\n1,1,1,1,5", "row 1 of .* has 5 cells and the table 4"),
        (f"{HEAD}\n2,1,1,1\n1,1,1,1", "numbers its drums otherwise"),
        (f"{HEAD}\n1,1,1,1", "says nothing of its stone: .* `material='marble'`"),
        (f"# stone: marble\n{HEAD}\n1,1,1,1", "says 'stone' of the column; .*allowed are name, section"),
        (f"# gravity: g\n{HEAD}\n1,1,1,1", "gravity of .* is 'g'; give a number"),
        (
            f'# material: marble\n{HEAD},note\n1,1,1,.9,\n2,1,.9,.8,"open\n3,1,.8,.7,',
            "is no table: unexpected end of data",
        ),
        (f"# material: marble\n{HEAD},offset_m\n1,1,1,1,nan", "offset in row 1 of .* is 'nan'; give a number"),
        (f"# material: cheese\n{HEAD}\n1,1,1,1", "cheese"),
        (f"# material: marble\n{HEAD}\n1,-1,1,1", "height in row 1 of .* is -1 m; give a length above 0 m"),
        (
            "# material: marble\ndrum;height;bottom_width;top_width\n1;74,2;120,4;117,2\n2;73,1;117,2;114,1",
            r"height of drum 1 is 74.2 m, and drums have 0.005 to 30 m: check it and its unit. "
            r"Lengths in .* are in m unless .* height_cm",
        ),
        (f"# material: marble\n{HEAD}\n1,0.8,90,1", r"lower face of drum 1 is 90 m, and stones have"),
        (f"# material: marble\n{HEAD},tilt_deg\n1,1,1,1,80", "tilt"),
    ],
)
def test_what_is_no_survey(text, says, tmp_path):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(st.InputError, match=says):
        convert(str(tmp_path / "a.csv"), tmp_path / "b.toml", Reading())
    assert not (tmp_path / "b.toml").exists()


ITALIAN = "tamburo;altezza (cm);diametro inf (cm);diametro sup (cm);verità\n1;81,2;100;98,2;sì\n2;80;98,2;96;no\n"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1", "utf-16"])
@pytest.mark.parametrize("above", ["", "sep=;\n", '"sep=;"\r\n'])
def test_a_survey_whose_columns_are_stated(above, encoding, tmp_path):
    """Any row of names, or none; what a refusal proposes is read when it is typed."""
    path = tmp_path / "a.csv"
    path.write_bytes((above + ITALIAN).encode(encoding))
    with pytest.raises(st.InputError, match="column 'tamburo'; known are drum, density") as error:
        read_model(path, Reading("marble"))
    proposal = re.search(r"`columns='([^']+)'`", str(error.value))[1]
    assert proposal == "drum, height [cm], bottom_width [cm], top_width [cm], -"
    column, _, words = read_model(path, Reading("marble", columns=proposal))
    assert [drum.height for drum in column.drums] == pytest.approx([0.812, 0.8])
    assert words[1:] == [ROUND]
    noted = read_model(path, Reading("marble", columns=proposal.replace(", -", ", note")))
    assert noted[2][1:] == [ROUND, "drum 1: sì", "drum 2: no"]
    path.write_bytes((above + ITALIAN.partition("\n")[2]).encode(encoding))  # no names at all
    assert read_model(path, Reading("marble", columns=proposal))[0].digest == column.digest


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ("drum, height [km], -, -, -", r"'height \[km\]' is not understood.*allowed are lengths"),
        ("drum, hight [cm], -, -, -", "did you mean height"),
        ("drum, height, -, -, -", r"'height' is not understood; write it as height \[m\], for one; allowed"),
        ("drum, height [cm]", "`columns` names 2 columns, .* has 5"),
        ("drum, height [cm], height [cm], top_width [cm], -", "two columns of 'height'"),
        ("drum, height [cm], bottom_width [cm], -, -", "no column 'top_width'"),
        ("drum, height [cm], bottom_width [cm], top_width [cm], tilt", "tilt in row 1 .* is 'sì'"),
    ],
)
def test_stated_columns_of_a_survey_that_cannot_be(columns, message, tmp_path):
    (tmp_path / "a.csv").write_text(ITALIAN, encoding="utf-8")
    with pytest.raises(st.InputError, match=message):
        convert(str(tmp_path / "a.csv"), tmp_path / "b.toml", Reading("marble", columns=columns))
    assert not (tmp_path / "b.toml").exists()
    with pytest.raises(st.InputError, match="`columns` are those of a survey"):
        convert("paper-12-drums", tmp_path / "b.toml", Reading(columns=columns))


def test_a_note_on_a_drum_is_the_surveyors(tmp_path):
    (tmp_path / "a.csv").write_text(f"# material: marble\n{HEAD},Note\n1,0.8,1,0.9,cracked at NE\n2,0.3,0.9,1.1,\n")
    column, tables, words = read_model(tmp_path / "a.csv", Reading())
    assert column.n == 2
    assert "note" not in str(tables)
    assert words[1:] == [ROUND, "drum 1: cracked at NE"]
    convert(str(tmp_path / "a.csv"), tmp_path / "b.toml", Reading())
    written = (tmp_path / "b.toml").read_text()
    assert "# drum 1: cracked at NE\n" in written
    assert written.count("[[drum]]\n") == 2


BY_COMPASS = (
    "# section: circular\n# base_tilt: 0.5\n# base_bearing: 90\n"
    "height,bottom_width,top_width,density,normal_stiffness,shear_stiffness,friction_angle,offset_mm,offset_bearing_deg\n"
    "2,1.1,1.0,2600,5e10,2.5e10,35,0,\n2,1.0,0.9,2600,5e10,2.5e10,35,50,67\n"
)


def test_bearings_of_a_survey_ask_where_north_is(tmp_path):
    """Clockwise from north, where x points to 37°: 67° is 30° from x away from y, and east 53°."""
    path = tmp_path / "survey.csv"
    path.write_text(BY_COMPASS, encoding="utf-8")
    with pytest.raises(st.InputError, match="does not say where north is"):
        survey_tables(path)
    column, _, _ = read_model(path, Reading(north=37.0))
    as_found = column.as_found
    assert (column.north, as_found.of(2).offset_azimuth, as_found.base_azimuth) == (37.0, 330.0, 307.0)
    path.write_text(f"# north: 37\n{BY_COMPASS}", encoding="utf-8")
    assert read_model(path, Reading())[0] == column
    path.write_text(survey_text(column), encoding="utf-8")
    assert made_of(st.Column, survey_tables(path)[0]).replace(name=column.name) == column
    assert FROM_DICT["column"](column.to_dict()) == column
    assert project(column, 30.0).column.north == 7.0
    path.write_text(BY_COMPASS.replace("offset_bearing_deg", "offset_bearing_deg,offset_azimuth_deg")
                    .replace(",67\n", ",67,30\n"), encoding="utf-8")  # fmt: skip
    with pytest.raises(st.InputError, match="offset_bearing and offset_azimuth, which are one thing"):
        survey_tables(path, north=37.0)


def test_links_are_not_lost_in_a_survey():
    column = preset("paper-12-drums")
    linked = column.replace(links=(Dowel(joint=2, shear_stiffness=1e8, shear_capacity=1e4),))
    with pytest.raises(st.InputError, match="has 1 link, and a survey holds drums and joints only"):
        survey_text(linked)


def test_a_proposal_names_every_column_that_it_can(tmp_path):
    """Units behind names of ours (kg/m3, °) left their columns out; what is typed as proposed is read."""
    path = tmp_path / "a.csv"
    head = "No;H (cm);D inf (cm);D sup (cm);density (kg/m3);friction angle (°);remarks"
    path.write_text(f"{head}\n1;80;100;98;2700;35;whole\n", encoding="utf-8")
    with pytest.raises(st.InputError, match="state what each column") as refused:
        survey_tables(path, "marble")
    proposal = re.findall(r"`columns='(.*?)'`", str(refused.value))[0]
    assert proposal == "drum, height [cm], bottom_width [cm], top_width [cm], density, friction_angle, -"
    tables, notes = survey_tables(path, "marble", proposal)
    assert tables["drum"] == [{"height": 0.8, "bottom_width": 1.0, "top_width": 0.98, "density": 2700.0}]
    assert notes == [ROUND]
