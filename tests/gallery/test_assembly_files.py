"""Every assembly file of the gallery runs on the command line, and does what its first lines say."""

import json
import re
import runpy
from pathlib import Path

import pytest

from stylobate.cli.main import call
from stylobate.column.assembly_files import is_assembly, load_structure, read_assembly
from stylobate.column.catalogue import ASSEMBLIES

FOLDER = Path(__file__).parents[2] / "gallery" / "assemblies"

PLANE = ("arch", "clamped", "dominoes", "leaning_drum", "portal", "two_columns")

#: Of assemblies in space: bodies, a direction, the multiplier there [g] and its tolerance.
SPACE = {
    "portal_in_space": (3, 90, 0.15805, 1e-4),  # all as one body
    "arch_in_space": (15, 90, 0.20951, 1e-3),  # an independent programme: half its width over its centroid's height
    "colonnade": (23, 90, 0.155, 0.01),  # below that of a column alone
    "temple_corner": (22, 90, 0.1356, 0.01),
    "statue": (3, 90, 0.257366, 1e-5),  # overturns over the edge of its plinth
    "wall_corner": (36, 0, 0.4896, 0.01),
}


@pytest.fixture
def run(capsys):
    """JSON object of a run of a file, and what is said on standard error."""

    def command(name, *options):
        arguments = ["run", str(FOLDER / f"{name}.toml"), "--model", "dem2d", *options, "--until-rest", "--json"]
        assert call(arguments) == 0
        out, err = capsys.readouterr()
        return json.loads(out), err

    return command


def test_every_file_says_how_it_is_run():
    names = sorted(path.stem for path in FOLDER.glob("*.toml") if is_assembly(path))
    assert names == sorted([*PLANE, *SPACE])
    for name in names:
        command = (
            r"limit gallery/assemblies/(\w+)\.toml" if name in SPACE else r"run gallery/assemblies/(\w+)\.toml --model"
        )
        text = (FOLDER / f"{name}.toml").read_text()
        assert re.search(f"stylobate {command}", text)[1] == name
        assert name not in SPACE or f"stylobate run gallery/assemblies/{name}.toml --model dem3d --pulse" in text


@pytest.mark.parametrize("name", SPACE)
def test_assemblies_in_space(name, capsys):
    """Bodies and multipliers along x and y, by hand where a closed form is near; the arch and the statue by their ends."""
    bodies, azimuth, expected, tolerance = SPACE[name]
    assembly = read_assembly(FOLDER / f"{name}.toml")
    assert assembly.n == bodies
    assert call(["limit", str(FOLDER / f"{name}.toml"), "--directions", f"{azimuth}:{azimuth}:1", "--json"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert json.loads(out)["collapse_multiplier_g"] == pytest.approx(expected, rel=tolerance)


def test_files_of_many_stones_are_written_by_their_script():
    module = runpy.run_path(str(FOLDER / "write_in_space.py"))
    assert module["arch"]() == (FOLDER / "arch_in_space.toml").read_text(encoding="utf-8")
    assert module["wall_corner"]() == (FOLDER / "wall_corner.toml").read_text(encoding="utf-8")


def test_the_file_of_the_documentation(tmp_path):
    page = (FOLDER.parents[1] / "docs" / "reference" / "assembly_files.md").read_text(encoding="utf-8")
    (tmp_path / "portal.toml").write_text(re.search(r"```toml\n(.*?)```", page, re.DOTALL)[1])
    portal = read_assembly(tmp_path / "portal.toml")
    assert [block.name for block in portal.blocks] == ["left", "right", "architrave"]
    assert [joint.law.friction_angle for joint in portal.joints] == [35.0, 35.0, 35.0, 25.0]
    assert {block.depth for block in portal.blocks} == {0.8}


def test_portal(run):
    laws = {j.law.friction_angle for j in read_assembly(FOLDER / "portal.toml").joints}
    assert laws == {35.0, 25.0}
    # below the uplift of its columns, about g tan α with α of their width over height, 0.78/4.0 at the narrow end
    calm, messages = run("portal", "--harmonic", "2Hz,0.1g,1s")
    assert messages == ""
    assert calm["peak_displacement_m"] < 1e-3
    fallen, _ = run("portal", "--harmonic", "0.7Hz,0.4g,6s")
    assert "architrave" in fallen["fallen"]
    assert fallen["at_rest"]


def test_leaning_drum(run):
    """Smooth above, it would press there with 0.29 of its weight, and need a coefficient of 0.28 at its foot."""
    leaning = read_assembly(FOLDER / "leaning_drum.toml")
    assert [leaning.bodies[j.upper].name for j in leaning.joints] == ["standing drum"]
    holds, messages = run("leaning_drum", "--pulse", "sine,2Hz,0.3g")
    assert messages == ""
    assert holds["in_equilibrium_as_drawn"]
    assert not holds["fallen"]


def test_a_leaning_drum_slides_where_friction_is_too_small(run, tmp_path, capsys):
    slippery = (
        (FOLDER / "leaning_drum.toml").read_text().replace("friction_coefficient = 0.7", "friction_coefficient = 0.15")
    )
    (tmp_path / "slippery.toml").write_text(slippery)
    arguments = ["run", str(tmp_path / "slippery.toml"), "--model", "dem2d", "--harmonic", "1Hz,0g,1s", "--until-rest"]
    assert call([*arguments, "--json"]) == 0
    out, err = capsys.readouterr()
    assert "is not in equilibrium as drawn" in err
    assert json.loads(out)["fallen"] == ["leaning drum"]


def test_dominoes(run):
    fallen, messages = run("dominoes", "--harmonic", "1Hz,0g,3s")
    assert "'dominoes' is not in equilibrium as drawn; it moves from the start." in messages
    assert len(fallen["fallen"]) == 6
    assert fallen["at_rest"]


def test_arch(run):
    module = runpy.run_path(str(FOLDER / "write_arch.py"))
    assert module["arch"]() == (FOLDER / "arch.toml").read_text(encoding="utf-8")
    calm, messages = run("arch", "--harmonic", "2Hz,0.05g,2s")
    assert messages == ""
    assert calm["fallen"] == []
    fallen, _ = run("arch", "--harmonic", "2Hz,0.5g,4s")
    assert {"stone 10", "stone 11", "stone 12"} <= set(fallen["fallen"])  # the crown
    assert fallen["at_rest"]
    assert fallen["energy_imbalance"] < 0.01


def test_a_thinner_arch_falls_of_itself(tmp_path, capsys):
    module = runpy.run_path(str(FOLDER / "write_arch.py"))
    module["arch"].__globals__["THICKNESS"] = 0.10 * module["RADIUS"]
    (tmp_path / "thin.toml").write_text(module["arch"]())
    assert call(["run", str(tmp_path / "thin.toml"), "--model", "dem2d", "--harmonic", "1Hz,0g,3s", "--json"]) == 0
    out, err = capsys.readouterr()
    assert "is not in equilibrium as drawn" in err
    assert "stone 11" in json.loads(out)["fallen"]


def test_the_temple_of_evora_is_a_preset():
    """153 stones of 192.11 t, a sum over the faces of the data file; ends of architraves 24 to 46 mm apart do not touch."""
    temple = load_structure("evora")
    moving = [stone for stone in temple.stones if not stone.fixed]
    assert len(moving) == 153
    assert sum(stone.mass for stone in moving) == pytest.approx(192_110.36, rel=1e-3)
    names = {frozenset((temple.bodies[j.lower].name, temple.bodies[j.upper].name)) for j in temple.space_joints}
    assert len(names) == len(temple.space_joints) == 169
    assert frozenset(("Arch_North 2", "Arch_North 3")) not in names
    assert frozenset(("Arch_West 2", "Arch_West 3")) in names  # the gap of 0.86 mm that is closed
    assert "Copyright (c) 2021 Ali Nayeri" in ASSEMBLIES["evora"].read_text(encoding="utf-8")
