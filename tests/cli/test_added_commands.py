"""Commands of other packages: there where they are installed, one sentence where they are not."""

import json
from importlib.metadata import EntryPoint

import pytest

from stylobate.cli import added
from stylobate.cli.main import call, commands


@pytest.fixture
def installed(monkeypatch):
    """What is installed of the group, by name and object, for one test."""

    def have(**entries):
        found = [EntryPoint(name, value, added.GROUP) for name, value in entries.items()]
        monkeypatch.setattr(added, "entry_points", lambda group: found if group == added.GROUP else [])
        commands.cache_clear()

    yield have
    commands.cache_clear()


@pytest.mark.parametrize("name", added.STUDIES)
def test_studies_that_are_not_installed_are_said_to_be_elsewhere(installed, capsys, name):
    installed()
    assert call([name, "--quick"]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"stylobate: {name} is a command of stylobate-studies, which is not installed here;")
    assert "make install" in said
    assert call(["--help"]) == 0
    assert f"\n  {name} " not in capsys.readouterr().out


def test_the_studies_of_this_checkout_are_installed():
    assert set(added.STUDIES) <= set(commands().commands)
    assert set(added.STUDIES).isdisjoint(added.added_commands(added.STUDIES))


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
    said = capsys.readouterr().err.splitlines()
    assert said[0].startswith(f"stylobate: warning: the command {name} is left out: ")
    assert why in said[0]
    assert len(said) == 1
