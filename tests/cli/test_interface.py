"""Names that people script against stay: commands and options, keys of files and of JSON objects, names in Python."""

import inspect
import json
import math
from pathlib import Path

import numpy as np
import pytest

import stylobate as st
from stylobate.cli.main import call, commands

COLUMN = """
name = "stele"
section = "circular"
density = 2500.0
[tapered]
height = 3.0
bottom_width = 0.5
top_width = 0.45
drums = 1
[joint]
normal_stiffness = 5.0e9
shear_stiffness = 2.5e9
friction_coefficient = 0.7
cohesion = 0.0
"""
LAW = COLUMN.partition("[joint]")[2].replace("cohesion = 0.0\n", "")
DRUMS = f"""
name = "two drums"
section = "rectangular"
depth = 1.0
[[drum]]
height = 0.8
bottom_width = 1.1
top_width = 1.0
density = 2600.0
[[drum]]
height = 0.8
bottom_width = 1.0
top_width = 0.9
density = 2600.0
[joint]{LAW}
[[joint_override]]
index = 2
friction_angle = 25.0
[[link]]
kind = "dowel"
joint = 2
at = [0.1, 0.0]
shear_stiffness = 1.0e8
shear_capacity = 1.0e5
clearance = 0.001
ultimate_slip = 0.02
[[link]]
kind = "bar"
joints = "all"
diameter = 0.02
embedment = 0.15
material = "titanium"
pretension = 1000.0
[[link]]
kind = "tie"
at = [0.6, 0.0]
axial_stiffness = 1.0e7
axial_capacity = 1.0e5
ultimate_elongation = 0.05
"""
BOX = f"""
name = "box"
density = 2500.0
settle = false
[joint]{LAW}
[[block]]
name = "box"
box = [0.5, 0.4, 1.0]
at = [0.0, 0.0, 0.0]
"""
SCENE = f"""
name = "two columns and an architrave"
density = 2500.0
[joint]{LAW}
[[column]]
file = "stele.toml"
at = [[0.0, 0.0], [2.6, 0.0]]
turn = 30
[[beam]]
between = ["column 1", "column 2"]
section = [0.4, 0.4]
overhang = 0.2
[[block]]
name = "statue"
box = [0.3, 0.3, 0.6]
at = [1.3, 0.0, 3.4]
turn = 15.0
[[block]]
name = "leaning"
box = [0.3, 0.3, 0.6]
at = [6.0, 0.0, 0.5]
tilt = 2.0
towards = 90.0
velocity = [0.0, 0.0, 0.0]
angular_velocity = [0.0, 0.0, 0.0]
[[block]]
name = "turned"
box = [0.3, 0.3, 0.6]
at = [8.0, 0.0, 0.5]
orientation = [1.0, 0.0, 0.0, 0.0]
[[block]]
name = "drum on the ground"
at = [4.0, 0.0, 0.0]
drum = {{ bottom_diameter = 1.1, top_diameter = 1.0, height = 0.8 }}
[[block]]
name = "rock"
fixed = true
vertices = [[9.0, 0.0, 0.0], [10.0, 0.0, 0.0], [9.0, 1.0, 0.0], [9.0, 0.0, 1.0]]
"""
SCENE = SCENE.replace("density = 2500.0", "density = 2500.0\nsettle = false", 1)
STUDY = """
column = "stele.toml"
models = ["housner"]
tail = "0.5s"
[motions]
files = ["r0.csv", "r1.csv"]
components = "x"
signs = "both"
[scale]
im = "pga"
levels = ["0.1g", "2g"]
[scatter]
realisations = 1
seed = 1
friction = 0.05
joint_stiffness = 0.1
density = 0.01
width = 0.01
height = 0.01
"""
RUIN = """
columns = ["stele.toml"]
simulations = 1000
seed = 1
[[observed]]
column = "stele"
state = "stands"
offsets = [[1, 0.01, 0.0, 0.01]]
twists = [[1, 1.0, 2.0]]
[prior]
pgv = [0.1, 2.0]
period = [0.3, 4.0]
azimuth = [0.0, 180.0]
"""
RECORDS = "record,im,collapsed\n" + "".join(
    f"r{k},{x},{int(x > 0.3 + 0.05 * k)}\n" for k in range(12) for x in (0.2, 0.5, 0.8, 1.2)
)
HAZARD = "im_g,annual_rate\n0.05,0.1\n0.2,0.02\n1,1e-3\n5,1e-5\n"

MOTION = "harmonic across pulse motion scale pga unit azimuth azimuths signs"
MANY = "replicates seed tail dask device threads"
#: Commands of the first days take --json, --out and --threads; what each of all takes besides.
OPTIONS = {
    "run": f"{MOTION} model set tail replicates seed until-rest losses scatter",
    "critical": f"{MOTION.replace('scale pga ', '')} model set from to step {MANY} losses",
    "domain": "model frequencies amplitudes",
    "pushover": "",
    "limit": "directions",
    "compare": "models harmonic pulse motion",
    "animate": "",
    "motion": "samples unit",
    "columns": "",
    "reproduce": "quick",
    "bench": "device",
    "suite": f"model azimuths signs {MANY}",
    "ida": f"im model {MANY}",
    "fragility": "im state",
    "risk": "hazard im state",
    "survival": "age hazard",
    "infer": "",
    "sequence": "motion model",
    "experiments": "",
    "report": "",
    "study run": MANY.replace("replicates seed tail", ""),
    "study status": "",
    "study export": "to",
    "export": "to at",
    "convert": "to",
    "fetch": "",
    "calibrate": "",
}
OTHERS = {"serve": "port no-browser out", "draw": "out json threads"}


@pytest.fixture(scope="module")
def options():
    """Options of every command."""
    flags, waiting = {}, list(commands().commands.items())
    while waiting:
        name, command = waiting.pop()
        if hasattr(command, "commands"):
            waiting += [(f"{name} {inner}", part) for inner, part in command.commands.items()]
        else:
            flags[name] = {word for given in command.params for word in (*given.opts, *given.secondary_opts)}
    return flags


@pytest.mark.parametrize("command", [*OPTIONS, *OTHERS])
def test_every_command_has_its_options(options, command):
    wanted = OTHERS[command] if command in OTHERS else f"json out threads {OPTIONS[command]}"
    assert {f"--{option}" for option in wanted.split()} <= options[command]


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with files of every kind."""
    folder = tmp_path_factory.mktemp("interface")
    files = {"stele.toml": COLUMN, "drums.toml": DRUMS, "box.toml": BOX, "scene.toml": SCENE, "study.toml": STUDY}
    for name, text in (files | {"ruin.toml": RUIN, "runs.csv": RECORDS, "hazard.csv": HAZARD}).items():
        (folder / name).write_text(text)
    for k in range(2):
        rows = "".join(f"{0.01 * i:.2f},{3.0 * math.sin(0.06 * i * (k + 1)):.4f}\n" for i in range(105))
        (folder / f"r{k}.csv").write_text("time_s,ax_m_s2\n" + rows)
    return folder


RUN = (
    "outcome collapsed decided collapse_time_s peak_top_displacement_m residual_top_displacement_m peak_rotation_rad "
    "energy_imbalance time_step_s steps wall_s model version computed_by losses"
)
CHANCE = "collapse_probability collapse_interval_low collapse_interval_high replicates"
COUNTS = "cases finished failed undecided collapsed wall_s files"
HOUSNER = "--model=housner"
LEVELS = ("--from=0.1g", "--to=2g", "--step=0.5g")
#: A command line, and keys of its JSON object; behind a colon those of an object in it.
KEYS = [
    (f"run stele.toml {HOUSNER} --harmonic=1.0Hz,0.1g,0.3s --set=restitution=0.9 --tail=0.1s", RUN),
    (f"run stele.toml {HOUSNER} --pulse=half-sine,1Hz,0.1g --replicates=2 --seed=1", f"{RUN} {CHANCE}"),
    (f"run stele.toml {HOUSNER} --motion=r0.csv --signs=both", "runs"),
    (
        "run stele.toml --model=dem3d --harmonic=1Hz,0.1g,0.2s --across=1.0Hz,0.15g,90deg --replicates=0 --no-pictures "
        "--out=space",
        f"{RUN} peak_top_x_m peak_top_y_m peak_tilt_rad collapse_azimuth_deg residual_slip_per_joint_m "
        "residual_twist_per_joint_rad peak_twist_rad",
    ),
    (
        "run box.toml --model=dem3d --harmonic=1Hz,0.1g,0.1s",
        "outcome fallen displaced bodies bodies:box:peak_tilt_rad bodies:box:fell_at_s bodies:box:fall_azimuth_deg "
        "bodies:box:residual_displacement_m",
    ),
    (f"critical stele.toml {HOUSNER} --motion=r0.csv {' '.join(LEVELS)} --replicates=2",
     f"critical_g first_collapse_g all_collapse_above_g runs wall_s critical_factor {CHANCE}"),
    (f"critical stele.toml {HOUSNER} --harmonic=1.0Hz,?g,1s {' '.join(LEVELS)}", "critical_g runs"),
    (f"domain stele.toml {HOUSNER} --frequencies=1:2:2 --amplitudes=0.1g:0.2g:2 --out=domain",
     "cells collapsed runs wall_s files"),
    ("pushover stele.toml", "collapse_multiplier_g curve mechanism"),
    ("limit stele.toml", "collapse_multiplier_g mechanism"),
    ("compare stele.toml --models=housner,rigid-block --harmonic=1Hz,0.1g,0.2s", "runs models"),
    (f"suite stele.toml {HOUSNER} r0.csv r1.csv --replicates=2", "runs runs:0:" + CHANCE.replace(" ", " runs:0:")),
    (f"ida stele.toml {HOUSNER} r0.csv r1.csv --im=pga --runs=4", "im unit records runs"),
    ("fragility runs.csv --im=pga --state=collapse",
     "median median_low median_high beta beta_low beta_high im unit state records runs undecided failed"),
    ("risk runs.csv --im=pga --hazard=hazard.csv", "annual_rate return_period_y"),
    ("survival runs.csv --im=pga --age=2400y --hazard=hazard.csv", "survival_probability"),
    ("study run study.toml --out=study", COUNTS),
    ("study status study", COUNTS),
    ("study export study --to=study.csv", "files"),
    ("sequence stele.toml --model=dem2d --motion=r0.csv --motion=r1.csv --rest=0.2s --replicates=0", "events"),
    ("motion r0.csv", "format unit pga_g pgv_m_s psa_5_percent_g"),
    ("columns", "columns"),
]  # fmt: skip


@pytest.mark.parametrize(("line", "keys"), KEYS, ids=[line.partition(" --")[0] for line, _ in KEYS])
def test_every_json_object_has_its_keys(place, monkeypatch, capsys, line, keys):
    monkeypatch.chdir(place)
    assert call([*line.split(), "--json"]) == 0
    out = capsys.readouterr().out
    assert out.count("\n") == 1
    answer = json.loads(out)
    for path in keys.split():
        value = answer
        for part in path.split(":"):
            value = value[int(part) if isinstance(value, list) else part]


def test_files_may_say_what_they_may_say(place):
    """Every key of the files above is one of the interface: a file that could not hold it would be refused."""
    drums, scene = st.Column.from_toml(place / "drums.toml"), st.read_assembly(place / "scene.toml")
    assert {link.kind for link in drums.links} == {"dowel", "bar", "tie"}
    assert [stone.name for stone in scene.stones][-1] == "rock"
    assert st.read_ruin(place / "ruin.toml").simulations == 1000
    grid = 'column = "stele.toml"\nmodel = "housner"\nfrequencies = "0.33:4:24"\namplitudes = "0.05g:0.6g:32"\n'
    (place / "grid.toml").write_text(grid + 'duration = "10s"\n')
    assert call(["domain", str(place / "grid.toml"), "--json", "--out", str(place / "never"), "--threads", "0"]) == 2
    for kind in ("core", "layer"):
        text = COLUMN.replace("drums = 1", "drums = 2") + f'[[link]]\nkind = "{kind}"\njoint = 2\n'
        text += "friction_coefficient = 0.4\n" if kind == "layer" else "diameter = 0.02\nmaterial = 'titanium'\n"
        (place / f"{kind}.toml").write_text(text.replace("joint = 2\n", "") if kind == "core" else text)
        assert st.Column.from_toml(place / f"{kind}.toml").links[0].kind == kind
    assert st.read_hazard(place / "hazard.csv")
    for preset in ("paper-monolithic", "paper-12-drums"):
        assert st.preset(preset).n


def test_python_has_its_names(place):
    joint = st.Joint(normal_stiffness=5e10, shear_stiffness=2.5e10, friction_angle=35.0)
    column = st.Column.tapered(height=5.0, bottom_width=0.96, top_width=0.66, drums=1, density=1600.0, joint=joint)
    motion = st.harmonic(frequency=1.0, amplitude=0.3 * st.g, duration=0.2)
    response = st.simulate(column, motion, st.HousnerBlock(restitution=0.9))
    assert {outcome.name.lower() for outcome in st.Outcome} == {"at_rest", "rocked", "displaced", "collapsed", "failed"}
    assert response.outcome in st.Outcome
    assert response.peak_top_displacement >= 0.0
    assert response.to_xarray() is not None
    table = st.simulate_many(column, [motion, motion], st.HousnerBlock())
    assert {"outcome", "collapsed", "peak_top_displacement_m", "wall_s", "model", "version"} <= set(table.columns)
    assert st.collapse_domain(column, st.HousnerBlock(), [1.0], [1.0])
    for name in ("critical_amplitude", "pushover", "limit_analysis", "read_motion", "ricker", "gabor", "RigidBlock"):
        assert callable(getattr(st, name))
    assert st.Motion(0.01, acceleration=np.zeros(3)).steps == st.Motion(0.01, np.zeros(3), ay=None, az=None).steps
    assert {"across"} <= set(inspect.signature(st.harmonic).parameters)
    assert st.Column.of_drums([st.Drum(1.0, 0.5, 0.5, 2500.0)], joint).n == 1
    assert st.read_motion(place / "r0.csv", unit=None).steps == 105
    assert st.RigidBeam(moment_law="trilinear", xi=0.9).name == "rigid-beam"
    assert st.DistinctElement2D(points=2).name == "dem2d"
    for law in ("rim", "bed"):
        assert st.DistinctElement3D(law=law, pivot_friction=0.5, stiffness_damping=0.0, planar=False).name == "dem3d"
    assert {st.DistinctElement3D(losses=losses).losses for losses in ("stone", "none")} == {"stone", "none"}
    assert st.Start(tilt=0.1, azimuth=0.0, angular_velocity=(0.0, 0.0, 0.0)).tilt == 0.1
    assert st.Specimen(
        mass=1.0, inertia=[1.0, 1.0, 1.0], vertices=[[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    )


def test_a_response_in_space_has_its_histories(place):
    """Of the run above; shapes are T times, n bodies."""
    if not (place / "space" / "response.nc").is_file():
        assert (
            call(
                KEYS[3][0]
                .replace("stele.toml", str(place / "stele.toml"))
                .replace("=space", f"={place / 'space'}")
                .split()
            )
            == 0
        )
    response = st.Response.load(place / "space" / "response.nc")
    steps, n = response.tilt.shape
    assert response.body_position.shape == response.body_axis.shape == (steps, n, 3)
    assert response.body_orientation.shape == (steps, n, 4)
    assert response.top_displacement.shape == (steps, 2)
    assert response.tilt_azimuth.shape == (steps, n)
    for name in ("body_velocity", "body_angular_velocity"):
        assert hasattr(type(response), name)
    for ending in ("glb", "obj", "csv", "pvd"):
        to = place / f"result.{ending}"
        at = ["--at", "0.1s"] if ending == "obj" else []
        assert call(["export", str(place / "space" / "response.nc"), "--to", str(to), *at]) == 0
        assert Path(to).stat().st_size > 100
