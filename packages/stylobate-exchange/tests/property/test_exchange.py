"""What is written for other tools is read back by their own libraries: glTF, VTK, OBJ and tables of a response."""

import base64
import builtins
import csv
import functools
import http.server
import io
import math
import shutil
import subprocess
import threading
import zlib
from xml.etree import ElementTree

import matplotlib.image
import meshio
import numpy as np
import pygltflib
import pytest
import trimesh
from chromium import browser

import stylobate as st
from stylobate.column.assembly_files import load_structure
from stylobate.column.catalogue import preset
from stylobate.response import Histories, Measures, Response
from stylobate.response.links import LinkHistories, LinkMeasures
from stylobate_exchange.export import export_response

TIME = np.array([0.0, 0.5, 1.0, 1.5, 2.0])
LAW = st.Joint(1e9, 1e9, 35.0)

TWO = """
name = "two"
[joint]
normal_stiffness = 1e9
shear_stiffness = 1e9
friction_angle = 35.0
[[block]]
name = "plinth"
box = [1.0, 1.0, 0.4]
at = [0.0, 0.0, 0.0]
density = 2500.0
[[block]]
name = "statue"
density = 2500.0
at = [0.0, 0.0, 0.4]
parts = [{ box = [0.4, 0.4, 1.0] }, { box = [0.6, 0.6, 0.2] }]
[[link]]
kind = "dowel"
between = ["plinth", "statue"]
at = [0.0, 0.0, 0.4]
shear_stiffness = 1e8
shear_capacity = 1e4
"""


def measures(**others):
    return Measures(
        outcome=st.Outcome.AT_REST, decided=True, collapse_time=math.nan, peak_top_displacement=0.0,
        residual_top_displacement=0.0, peak_rotation=0.0, peak_joint_opening=0.0, residual_joint_slip=0.0,
        energy_imbalance=0.0, time_step=1e-4, steps=1, reason="", **others,
    )  # fmt: skip


@pytest.fixture
def in_space(tmp_path):
    """A statue on its plinth that turns about the vertical by half a right angle a second and drifts along y by 0.1 m/s."""
    (tmp_path / "two.toml").write_text(TWO)
    two = load_structure(tmp_path / "two.toml")
    bodies, joints = len(two.bodies), len(two.space_joints)
    place = [np.zeros(3), *(np.array(stone.position) for stone in two.stones)]
    position = np.repeat(np.array(place)[None], len(TIME), axis=0)
    position[:, -1, 1] += 0.1 * TIME
    turn = np.zeros((len(TIME), bodies, 4))
    turn[..., 0] = 1.0
    half = 0.125 * math.pi * TIME
    turn[:, -1, 0], turn[:, -1, 3] = np.cos(half), np.sin(half)
    velocity = np.gradient(position, TIME, axis=0)
    zero = np.zeros((len(TIME), joints))
    opening = zero + np.arange(joints) * 1e-3
    slip = np.zeros((len(TIME), joints, 2))
    slip[:, -1, 1] = 0.1 * TIME
    histories = Histories.in_space(
        TIME, position, turn, opening, slip, zero, None, None, np.zeros((len(TIME), 3)), np.zeros((len(TIME), 3)),
        {"input": np.zeros(len(TIME))}, velocity=velocity, spin=np.zeros_like(velocity),
    )  # fmt: skip
    force = np.arange(len(TIME))[:, None] * 100.0
    histories = _with(histories, links=LinkHistories(force, 0.0 * force, 0.0 * force, 0.0 * force))
    name = two.placed_links[0].name
    link = LinkMeasures(name, "dowel", 0, math.nan, 400.0, 0.0, 0.0, 0.0, 1e4, math.inf)
    return Response(two, histories, measures(links=(link,)), "dem3d", {})


@pytest.fixture
def in_plane():
    """Twelve drums of which drum i goes i mm to the right and turns by i mrad, counter-clockwise, in two seconds."""
    column = preset("paper-12-drums")
    share = (TIME / TIME[-1])[:, None] * np.arange(1, column.n + 1) * 1e-3
    zero, line = 0.0 * share, np.zeros(len(TIME))
    histories = Histories.of_drums(TIME, share, zero, share, zero, zero, line, line, line, line, {"input": line})
    return Response(column, histories, measures(), "dem2d", {})


def _with(histories, **changes):
    import dataclasses

    return dataclasses.replace(histories, **changes)


def accessor(file, number):
    """Numbers of an accessor as the specification of glTF 2.0 lays them out."""
    entry = file.accessors[number]
    view = file.bufferViews[entry.bufferView]
    kind = {5126: "<f4", 5125: "<u4"}[entry.componentType]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[entry.type]
    data = file.binary_blob()[view.byteOffset : view.byteOffset + view.byteLength]
    return np.frombuffer(data, kind).reshape(entry.count, width)


def test_gltf_moves_as_the_response_does(in_space, tmp_path):
    """Node by name, its translation and rotation at the recorded times; single precision of lengths near 1 m: 1e-6."""
    (path,) = export_response(in_space, tmp_path / "a.glb", rate=2.0)
    file = pygltflib.GLTF2().load(str(path))
    names = [node.name for node in file.nodes]
    assert names == ["two", "plinth", "statue", "ground"]
    (animation,) = file.animations
    of = {
        (names[channel.target.node], channel.target.path): animation.samplers[channel.sampler]
        for channel in animation.channels
    }
    assert {node for node, _ in of} == {"plinth", "statue"}
    statue = of["statue", "translation"]
    assert accessor(file, statue.input)[:, 0] == pytest.approx(TIME)
    moved = accessor(file, statue.output)
    assert moved == pytest.approx(in_space.poses.position[:, -1], abs=1e-6)
    turned = accessor(file, of["statue", "rotation"].output)
    assert 2.0 * np.arctan2(turned[:, 2], turned[:, 3]) == pytest.approx(0.25 * math.pi * TIME, abs=1e-6)
    times = file.accessors[statue.input]
    assert (times.min, times.max) == ([0.0], [2.0])  # which the specification asks for


def test_gltf_stands_upright(in_space, tmp_path):
    """y is upward there: trimesh finds the statue's top 1.6 m up, and volumes of closed bodies."""
    (path,) = export_response(in_space, tmp_path / "a.glb", at=0.0)
    scene = trimesh.load_scene(path)
    bounds = {name: trimesh.bounds.corners(scene.bounds) for name in scene.geometry}
    assert scene.bounds[1][1] == pytest.approx(1.6, abs=1e-6)
    assert set(bounds) == {"plinth", "statue", "ground"}
    statue, plinth = (scene.geometry[name] for name in ("statue", "plinth"))
    assert statue.volume == pytest.approx(0.4 * 0.4 * 1.0 + 0.6 * 0.6 * 0.2, rel=1e-6)
    assert plinth.volume == pytest.approx(0.4, rel=1e-6)


#: A page that plays a file with three.js: ``at(t)`` draws that second and tells where every surface reaches.
VIEWER = """
<script type="importmap">{"imports": {"three": "/node_modules/three/build/three.module.js"}}</script>
<body style="margin:0"><script type="module">
import * as THREE from "three";
import {GLTFLoader} from "/node_modules/three/examples/jsm/loaders/GLTFLoader.js";
const drawn = new THREE.WebGLRenderer({preserveDrawingBuffer: true}), scene = new THREE.Scene();
drawn.setSize(400, 400); document.body.append(drawn.domElement);
scene.background = new THREE.Color(0xffffff); scene.add(new THREE.AmbientLight(0xffffff, 3));
const file = await new GLTFLoader().loadAsync("a.glb"), mixer = new THREE.AnimationMixer(file.scene);
scene.add(file.scene); file.animations.forEach((one) => mixer.clipAction(one).play());
const camera = new THREE.PerspectiveCamera(40, 1, 0.1, 100);
camera.position.set(0, 1, 5); camera.lookAt(0, 0.8, 0);
window.at = (time) => {
  mixer.setTime(time); scene.updateMatrixWorld(true); drawn.render(scene, camera);
  const found = {};
  scene.traverse((one) => {
    const box = new THREE.Box3();
    if (one.isMesh) found[one.name] = [...box.setFromObject(one, true).min, ...box.max];
  });
  return found;
};
</script></body>
"""


@pytest.mark.slow
def test_a_viewer_in_a_browser_plays_it(in_space, tmp_path):
    """three.js has the statue upright, where and as large as recorded: its head of 0.6 m is √2 as wide after 45°."""
    playwright = pytest.importorskip("playwright.sync_api", reason="needs playwright")
    npm = shutil.which("npm")
    if browser() is None or npm is None:
        pytest.skip("needs Chromium and npm, which this machine does not have")
    got = [npm, "install", "--no-audit", "--no-fund", "--fetch-retries=0", "--prefix", str(tmp_path), "three@0.170"]
    if subprocess.run(got, capture_output=True, timeout=120, check=False).returncode:
        pytest.skip("needs the package three of npm, which cannot be had here")
    export_response(in_space, tmp_path / "a.glb", rate=2.0)
    (tmp_path / "index.html").write_text(VIEWER)
    handler = functools.partial(Quiet, directory=str(tmp_path))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server, playwright.sync_playwright() as engine:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        software = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
        page = engine.chromium.launch(executable_path=browser(), args=software).new_page()
        page.goto(f"http://127.0.0.1:{server.server_port}/")
        page.wait_for_function("window.at !== undefined")
        boxes, pictures = [], []
        for time in (0.0, 1.0):
            boxes.append(page.evaluate("at", time))
            pictures.append(page.locator("canvas").screenshot())
        server.shutdown()
    wide = 0.3 * math.sqrt(2.0)
    assert boxes[0]["plinth"] == pytest.approx([-0.5, 0.0, -0.5, 0.5, 0.4, 0.5], abs=1e-6)
    assert boxes[0]["statue"] == pytest.approx([-0.3, 0.4, -0.3, 0.3, 1.6, 0.3], abs=1e-6)
    assert boxes[1]["statue"] == pytest.approx([-wide, 0.4, -0.1 - wide, wide, 1.6, -0.1 + wide], abs=1e-6)
    seen = [
        np.asarray(matplotlib.image.imread(io.BytesIO(picture)))[..., :3].min(axis=2) < 0.95 for picture in pictures
    ]
    assert all(0.02 < mask.mean() < 0.9 for mask in seen)
    assert (seen[0] != seen[1]).sum() > 100  # the statue has grown wider


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def test_vtk_of_an_instant(in_space, tmp_path):
    """Bodies, joints and links of one instant in three files, read by meshio."""
    paths = export_response(in_space, tmp_path / "a.vtu", at=1.0)
    assert [path.name for path in paths] == ["a.vtu", "a-joints.vtu", "a-links.vtu"]
    bodies, joints, links = map(meshio.read, paths)
    assert bodies.cell_data["body"][0].tolist() == [1, 2, 2]  # the statue has two parts
    assert bodies.cell_data["displacement"][0][1] == pytest.approx([0.0, 0.1, 0.0])
    assert bodies.cell_data["velocity"][0][1] == pytest.approx([0.0, 0.1, 0.0])
    corner = bodies.points[8:16]  # of the shaft, turned by 45° about the axis that has drifted by 0.1 m
    assert np.hypot(corner[:, 0], corner[:, 1] - 0.1) == pytest.approx(0.2 * math.sqrt(2.0))
    assert sorted(np.abs(corner[:, 0]).round(9)) == pytest.approx([0.0] * 4 + [0.2 * math.sqrt(2.0)] * 4)
    assert joints.cell_data["opening"][0] == pytest.approx([0.0, 1e-3])
    assert joints.points == pytest.approx(np.array([[0.0, 0.0, 0.0], [0.0, 0.1, 0.4]]))
    assert joints.cell_data["slip"][0][1] == pytest.approx([0.0, 0.1, 0.0])
    assert links.cell_data["shear"][0] == pytest.approx([200.0])
    assert links.points[:, :2] == pytest.approx(np.zeros((2, 2)))  # a dowel stays in what is below its joint


def test_vtk_is_laid_out_as_its_manual_says(in_space, tmp_path):
    """By the standard library alone: polyhedra (42), their faces by number of corners, and offsets behind each cell."""
    (path, *_) = export_response(in_space, tmp_path / "a.vtu", at=1.0)
    root = ElementTree.parse(path).getroot()
    kinds = {"Int64": "<i8", "UInt8": "|u1", "Float64": "<f8"}

    def array(name):
        (element,) = [
            candidate
            for candidate in root.iter("DataArray")
            if candidate.get("Name") == name and candidate.get("NumberOfComponents") != "3"
        ]
        text = element.text.strip()
        count = int.from_bytes(base64.b64decode(text[:8])[:4], "little")  # of blocks; their sizes are behind it
        head = 4 * -(-4 * (3 + count) // 3)
        sizes = np.frombuffer(base64.b64decode(text[:head]), "<u4")
        data, blocks = base64.b64decode(text[head:]), []
        for size in sizes[3:].tolist():
            blocks.append(zlib.decompress(data[:size]))
            data = data[size:]
        return np.frombuffer(b"".join(blocks), kinds[element.get("type")]).tolist()

    assert root.get("type") == "UnstructuredGrid"
    assert array("types") == [42] * 3
    assert array("offsets") == [8, 16, 24]
    assert array("connectivity") == list(range(24))
    faces, ends = array("faces"), array("faceoffsets")
    assert len(faces) == ends[-1]
    assert [faces[start] for start in (0, *ends[:-1])] == [6, 6, 6]  # boxes
    assert array("body") == [1, 2, 2]


def test_vtk_over_time(in_plane, tmp_path):
    """A collection names every file with its time; drums of a plane column are whole drums, where plane poses have them."""
    paths = export_response(in_plane, tmp_path / "a.pvd", rate=2.0)
    text = paths[0].read_text()
    assert text.count("bodies-") == text.count("joints-") == len(TIME)
    assert all(
        (tmp_path / line.split('file="')[1].split('"')[0]).is_file() for line in text.splitlines() if "file=" in line
    )
    last = meshio.read(tmp_path / "a" / "bodies-0004.vtu")
    assert last.cell_data["displacement"][0][:, 0] == pytest.approx(np.arange(1, 13) * 1e-3)
    assert last.cell_data["velocity"][0][:, 0] == pytest.approx(np.arange(1, 13) * 0.5e-3)  # by differences
    assert last.cell_data["tilt"][0] == pytest.approx(np.arange(1, 13) * 1e-3)
    names = (tmp_path / "a" / "bodies.csv").read_text().splitlines()
    assert names[1] == "0,drum 1"
    drums = in_plane.column.drums
    assert np.ptp(last.points[:, 1]) == pytest.approx(max(drum.depth for drum in drums))


def test_joints_go_with_the_drum_above_them(in_plane, tmp_path):
    """Middle of the lower face of drum i: i mm to the right, and its centroid's height times the turn."""
    paths = export_response(in_plane, tmp_path / "a.vtu", at=2.0)
    column, points = in_plane.column, meshio.read(paths[1]).points
    number = np.arange(1, column.n + 1) * 1e-3
    high = np.array([drum.centroid_height for drum in column.drums])
    assert points[:, 0] == pytest.approx(number + high * np.sin(number))
    assert points[:, 2] == pytest.approx(column.joint_heights + high * (1.0 - np.cos(number)))


def test_obj_of_an_instant(in_plane, tmp_path):
    """trimesh finds twelve closed drums, which are objects with names, where they are then."""
    (path,) = export_response(in_plane, tmp_path / "a.obj", at=2.0)
    drums = trimesh.load_mesh(path, process=False, maintain_order=True).split()
    assert [line for line in path.read_text().splitlines() if line[:2] == "o "] == [f"o drum {i}" for i in range(1, 13)]
    built = sorted(drum.volume for drum in in_plane.column.drums)
    assert sorted(drum.volume for drum in drums) == pytest.approx(built, rel=1e-9)
    places = sorted(drum.center_mass[2] for drum in drums)
    assert places == pytest.approx([body.place[1] for body in in_plane.column.bodies[1:]])


def test_histories_as_a_table(in_space, tmp_path):
    (path,) = export_response(in_space, tmp_path / "a.csv")
    rows = list(csv.DictReader(io.StringIO(path.read_text())))
    assert [float(row["time_s"]) for row in rows] == pytest.approx(TIME)
    assert [float(row["statue: displacement_y_m"]) for row in rows] == pytest.approx(0.1 * TIME)
    assert [float(row["joint 2: slip_y_m"]) for row in rows] == pytest.approx(0.1 * TIME)
    link = in_space.measures.links[0].name
    assert [float(row[f"{link}: shear_n"]) for row in rows] == pytest.approx([0.0, 100.0, 200.0, 300.0, 400.0])
    assert not any(key.startswith("ground:") for key in rows[0])


def test_a_run_that_failed_is_written_as_far_as_it_is_finite(in_plane, tmp_path):
    in_plane.histories.poses.x[3:] = math.nan
    broken = Response(in_plane.structure, in_plane.histories, in_plane.measures, "dem2d", {})
    (path,) = export_response(broken, tmp_path / "a.glb", rate=2.0)
    file = pygltflib.GLTF2().load(str(path))
    assert accessor(file, file.animations[0].samplers[0].input)[-1, 0] == pytest.approx(1.0)
    with pytest.raises(st.InputError, match="the run is recorded from 0 to 1 s"):
        export_response(broken, tmp_path / "b.obj", at=2.0)


@pytest.mark.parametrize(
    ("name", "options", "says"),
    [
        ("a.stl", {}, "endings are .glb, .pvd, .vtu, .obj, .csv"),
        ("a", {}, "endings are"),
        ("a.obj", {}, "holds one instant; say which with `at=3.2s`"),
        ("a.vtu", {}, "holds one instant"),
        ("a.csv", {"at": 1.0}, "holds all instants; leave `at` out"),
        ("a.pvd", {"at": 1.0}, "holds all instants"),
        ("a.glb", {"at": 1.0, "rate": 3.0}, "`at` and `fps` are both given"),
        ("a.obj", {"at": 9.0}, "`at` is 9 s; the run is recorded from 0 to 2 s"),
        ("a.obj", {"at": -1.0}, "`at` is -1 s"),
        ("a.obj", {"at": math.nan}, "`at` is nan s"),
        ("a.glb", {"rate": 0.0}, "`fps`"),
        ("a.glb", {"rate": math.inf}, "`fps`"),
        ("a.pvd", {"rate": 1e4}, "`fps`"),
        ("no/a.glb", {}, "folder .* does not exist"),
        ("no/a.pvd", {}, "cannot be made"),
    ],
)
def test_what_cannot_be_written_is_refused_and_leaves_nothing(in_plane, tmp_path, name, options, says):
    with pytest.raises(st.InputError, match=says):
        export_response(in_plane, tmp_path / name, **options)
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_written_over(in_plane, tmp_path):
    for name in ("a.glb", "b", "c-joints.vtu"):
        (tmp_path / name).write_text("mine")
    for name, options in (("a.glb", {}), ("b.pvd", {}), ("c.vtu", {"at": 1.0})):
        with pytest.raises(st.InputError, match="is there already"):
            export_response(in_plane, tmp_path / name, **options)
    assert {path.read_text() for path in tmp_path.iterdir()} == {"mine"}


def test_without_trimesh_one_sentence_says_what_to_install(tmp_path, monkeypatch):
    from stylobate.column.spatial.stone import read_stones

    real = builtins.__import__

    def refusing(name, *rest):
        if name == "trimesh":
            raise ImportError(name)
        return real(name, *rest)

    (tmp_path / "a.stl").write_text("solid a\nendsolid a\n")
    monkeypatch.setattr(builtins, "__import__", refusing)
    with pytest.raises(st.InputError, match=r"is read by trimesh; install stylobate\[exchange\], or give an OBJ file"):
        read_stones(tmp_path / "a.stl")
