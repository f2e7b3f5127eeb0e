"""What a model of somebody's own does is in the digest of its runs, wherever it was written."""

import importlib
import json
import subprocess
import sys

import pytest

from stylobate.campaign.digests import Hasher

NOTEBOOK = """
import dataclasses
import numpy as np
import stylobate as st
from stylobate.campaign.digests import Hasher

GROUND = np.random.default_rng(1)

LIMIT = {"a": 1.5, "b": frozenset({"x", "y", "z"})}

def factor(x, power=2.0):
    try:
        return [x**power for _ in range(3)], LIMIT["a"], GROUND
    except ZeroDivisionError:
        return None

@dataclasses.dataclass(frozen=True)
class Mine(st.HousnerBlock):
    name = "mine"
    ratio = 0.5

    @property
    def size(self):
        return 3.0

    def run_many(self, cases, options, threads):
        factor(self.ratio)
        return super().run_many(cases, options, threads)
"""

CHANGES = {
    "a constant of a method": ("return 3.0", "return 3.5"),
    "a value of the class": ("ratio = 0.5", "ratio = 0.6"),
    "a default": ("power=2.0", "power=3.0"),
    "an inner loop": ("x**power for", "x*power for"),
    "a function beside it": ("return None", "return 0.0"),
    "a value beside it": ('"a": 1.5', '"a": 1.6'),
    "the state of an object beside it": ("default_rng(1)", "default_rng(2)"),
    "what is called": ("factor(self.ratio)", "abs(self.ratio)"),
}


def digest(text):
    room = {"__name__": "__main__"}
    exec(compile(text, "<cell>", "exec"), room)
    return room["Hasher"](room["Mine"]()).of_product("", __file__)


@pytest.mark.parametrize("change", CHANGES)
def test_a_class_of_a_notebook_that_has_changed_is_another(change):
    before, after = CHANGES[change]
    assert NOTEBOOK.count(before) == 1
    assert digest(NOTEBOOK) == digest(f"# moved\n\n{NOTEBOOK}")
    assert digest(NOTEBOOK.replace(before, after)) != digest(NOTEBOOK)


def test_a_class_of_a_notebook_is_the_same_in_every_process():
    script = f"exec(compile({NOTEBOOK!r}, '<cell>', 'exec'))\nprint(Hasher(Mine())._head)"
    told = [
        subprocess.run(
            [sys.executable, "-c", script], env={"PYTHONHASHSEED": seed}, capture_output=True, text=True, check=True
        ).stdout
        for seed in "12"
    ]
    assert told[0] == told[1]
    assert " at 0x" not in told[0]
    assert json.loads(told[0])


def test_a_module_beside_a_class_of_a_notebook_is_told_by_its_file(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    found = []
    for power in ("2", "3"):
        (tmp_path / "law_beside.py").write_text(f"def factor(x):\n    return x**{power}\n")
        monkeypatch.delitem(sys.modules, "law_beside", raising=False)
        importlib.invalidate_caches()
        found.append(digest(f"import law_beside\n{NOTEBOOK}".replace("factor(self", "law_beside.factor(self")))
    assert found[0] != found[1]


FILED = """
import law_beside
import stylobate as st

class Mine(st.HousnerBlock):
    name = "mine"

    def __init__(self, size=1.0):
        super().__init__()
        self.size = size

    def run_many(self, cases, options, threads):
        law_beside.factor(2)
        return super().run_many(cases, options, threads)
"""
BESIDE = "LIMIT = 2.0\n\n\ndef factor(x):\n    return x**2\n"


@pytest.fixture
def told(tmp_path, monkeypatch):
    """Writes a model's file and the one beside it, loads them (or not), and gives the digest of what is loaded."""
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def digest_of(text=FILED, beside=BESIDE, load=True, **settings):
        for name, content in (("own_law", text), ("law_beside", beside)):
            (tmp_path / f"{name}.py").write_text(content)
            if load:
                monkeypatch.delitem(sys.modules, name, raising=False)
        importlib.invalidate_caches()
        return Hasher(importlib.import_module("own_law").Mine(**settings)).of_product("", __file__)

    return digest_of


def test_a_class_of_a_file_is_told_with_the_files_that_it_imports(told):
    assert told() == told()
    assert told(beside=BESIDE.replace("x**2", "x**3")) != told()
    assert told(FILED.replace("factor(2)", "factor(3)")) != told()


def test_what_a_model_holds_besides_its_parameters_is_told(told):
    assert told(size=1.0) == told()
    assert told(size=2.0) != told()


@pytest.mark.parametrize("change", [("factor(2)", "factor(3)"), ("x**2", "x**3"), ("LIMIT = 2.0", "LIMIT = 3.0")])
def test_a_file_that_was_edited_but_not_loaded_again_is_not_taken_for_what_runs(told, change):
    """Its runs, by the law that is loaded, were kept as those of the law that the file holds now."""
    told()
    edited = FILED.replace(*change), BESIDE.replace(*change)
    assert told(*edited, load=False) != told(*edited)
