"""Commands and public names of other packages: there where they are installed, one sentence where they are not."""

import json
import tomllib
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest

import stylobate
from stylobate import added, plots
from stylobate.cli.main import call, commands


@pytest.fixture
def installed(monkeypatch):
    """What is installed of the group, by name and object, for one test."""

    def have(**entries):
        entry_points = [EntryPoint(name, value, added.COMMANDS) for name, value in entries.items()]
        monkeypatch.setattr(added, "entry_points", lambda group: entry_points if group == added.COMMANDS else [])
        commands.cache_clear()

    yield have
    commands.cache_clear()


ROOT = Path(__file__).parents[2]
COMMANDS = [(package, name) for package in added.PACKAGES for name in package.commands]
NAMES = [(package, path) for package in added.PACKAGES for path in package.names]


@pytest.mark.parametrize(("package", "name"), COMMANDS)
def test_a_command_that_is_not_installed_is_said_to_be_elsewhere(installed, capsys, package, name):
    installed()
    assert call([name, "--quick"]) == 2
    message = capsys.readouterr().err
    assert message.startswith(f"stylobate: {name} is a command of {package.name}, which is not installed here;")
    assert "make install" in message
    assert call(["--help"]) == 0
    assert f"\n  {name} " not in capsys.readouterr().out


def test_packages_of_this_checkout_add_what_the_core_says_of_them():
    """The list by which a missing command or name is explained is that of the packages' own entry points."""
    assert {ROOT / package.folder for package in added.PACKAGES} | {ROOT / "compas"} == {
        path.parent for place in ("*", "packages/*") for path in ROOT.glob(f"{place}/pyproject.toml")
    }
    for package in added.PACKAGES:
        project = tomllib.loads((ROOT / package.folder / "pyproject.toml").read_text())["project"]
        points = project.get("entry-points", {})
        assert project["name"] == package.name
        assert set(points.get(added.COMMANDS, {})) == set(package.commands)
        assert set(points.get(added.NAMES, {})) == set(package.names)
        assert set(points.get(added.DEVICES, {})) == set(package.devices)
        assert set(points.get(added.RECORDS, {})) == set(package.records)
        assert set(points.get(added.SCHEMAS, {})) == set(package.schemas)
        assert set(package.commands) <= set(commands().commands)


@pytest.mark.parametrize(("package", "path"), NAMES)
def test_a_public_name_is_that_of_the_package_or_said_to_be_elsewhere(monkeypatch, package, path):
    room, _, name = path.rpartition(".")
    module = plots if room == "plots" else stylobate
    assert name in dir(module)
    assert name in module.__all__
    assert getattr(module, name) is not None
    monkeypatch.setattr(added, "entry_points", lambda group: [])
    assert name not in dir(module)
    with pytest.raises(
        AttributeError, match=f"{name} is of {package.name}, which is not installed here;.*make install"
    ):
        getattr(module, name)


def test_a_name_that_nobody_has_is_refused_as_of_any_module():
    with pytest.raises(AttributeError, match="module 'stylobate' has no attribute 'no_such_name'"):
        _ = stylobate.no_such_name
    assert not hasattr(plots, "draw_nothing")
    assert not hasattr(stylobate, "__wrapped__")


def test_a_package_adds_a_command(installed, capsys):
    installed(measures="stylobate.cli.columns:columns")
    assert call(["measures", "paper-monolithic", "--json"]) == 0
    added_says = json.loads(capsys.readouterr().out)
    assert call(["columns", "paper-monolithic", "--json"]) == 0
    assert added_says == json.loads(capsys.readouterr().out)
    assert call(["measures", "nonsense"]) == 2


@pytest.mark.parametrize(
    ("name", "value", "why"),
    [
        ("broken", "stylobate.cli.nowhere:broken", "No module named 'stylobate.cli.nowhere'"),
        ("broken", "stylobate.cli.columns:nothing", "has no attribute 'nothing'"),
        ("broken", "broken_package:command", "not today"),
        ("run", "stylobate.cli.columns:columns", "there is a command of this name already"),
    ],
)
def test_a_command_that_cannot_be_had_is_left_out_with_a_warning(
    installed, capsys, tmp_path, monkeypatch, name, value, why
):
    (tmp_path / "broken_package.py").write_text("raise RuntimeError('not today')")
    monkeypatch.syspath_prepend(tmp_path)
    installed(**{name: value})
    assert call(["columns"]) == 0
    warnings = capsys.readouterr().err.splitlines()
    assert warnings[0].startswith(f"stylobate: warning: the command {name} is left out: ")
    assert why in warnings[0]
    assert len(warnings) == 1
