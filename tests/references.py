"""Reference figures for assemblies in space from beside the project; tests that need them are skipped without."""

import csv
import importlib.util
from pathlib import Path

import numpy as np
import pytest

import stylobate as st

#: The folder beside the project.
FOLDER = Path(__file__).resolve().parents[2] / "shared" / "references"

needs_references = pytest.mark.skipif(
    not (FOLDER / "assemblies_in_space.csv").is_file(), reason="no folder ../shared/references with reference figures"
)

#: All joints of the references: no slip to speak of, and a stiffness that statics do not ask for.
LAW = st.Joint(5e9, 2.5e9, friction_coefficient=0.7)


def rows(case: str) -> list[dict[str, str]]:
    """Rows of the table whose case begins so."""
    with (FOLDER / "assemblies_in_space.csv").open(encoding="utf-8") as file:
        return [row for row in csv.DictReader(file) if row["case"].startswith(case)]


def scenes():
    """The module of the scenes."""
    spec = importlib.util.spec_from_file_location("reference_scenes", FOLDER / "scenes.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def assembly(bodies, name="reference") -> st.SpatialAssembly:
    """A scene of the references as an assembly."""
    return st.SpatialAssembly([_stone(body) for body in bodies], LAW, name)


def _stone(body) -> st.Stone:
    x, y, z = body["pos"]
    named = {"name": body["name"], "orientation": body["quat"]}
    if body["kind"] == "hull":
        return st.Stone.hull(np.array(body["vertices"]) + body["pos"], 2700.0, name=body["name"])
    if body["kind"] == "box":
        return st.Stone.box(body["size"], (x, y, z - 0.5 * body["size"][2]), 2700.0, **named)
    radius, height = body["size"]
    return st.Stone.drum(2.0 * radius, 2.0 * radius, height, (x, y, z - 0.5 * height), 2700.0, **named)
