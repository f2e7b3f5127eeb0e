"""Links of assemblies: the ledger closes with every kind, one law with the columns', and links that do nothing."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

import stylobate as st
from stylobate.column.assembly import Assembly, Block
from stylobate.column.assembly_files import assembly_from_dict
from stylobate.column.links import block_link
from stylobate.models.engine import engine_for
from stylobate.simulate import simulate

JOINT = st.Joint(normal_stiffness=5e9, shear_stiffness=2.5e9, friction_coefficient=0.5)
MOTION = st.harmonic(frequency=2.0, amplitude=4.5, duration=1.2)


def box(left: float, right: float, low: float, high: float, name: str) -> Block:
    return Block(((left, low), (right, low), (right, high), (left, high)), 2500.0, name)


BLOCKS = (
    box(0.0, 0.4, 0.0, 1.6, "west"),
    box(1.6, 2.0, 0.0, 1.6, "middle"),
    box(3.2, 3.6, 0.0, 1.6, "east"),
    box(-0.1, 1.8, 1.6, 2.0, "one"),
    box(1.8, 3.7, 1.6, 2.0, "two"),
)
PORTAL = Assembly(BLOCKS, JOINT, "portal")
CLAMP: dict[str, Any] = {"kind": "clamp", "between": ("one", "two"), "at": (1.7, 1.9), "to": (1.9, 1.9)}
DOWEL: dict[str, Any] = {"kind": "dowel", "shear_stiffness": 1e7}
KINDS: dict[str, list[dict[str, Any]]] = {
    "elastic clamp": [CLAMP | {"axial_stiffness": 3e7, "shear_stiffness": 1e7, "clearance": 1e-4}],
    "yielding clamp": [CLAMP | {"axial_stiffness": 3e7, "axial_capacity": 4e3, "shear_stiffness": 1e7,
                                "shear_capacity": 2e3}],
    "crushing clamp": [CLAMP | {"axial_stiffness": 3e7, "axial_capacity": 4e3, "shear_stiffness": 1e7,
                                "shear_capacity": 2e3, "failure": "crushing"}],
    "brittle clamp": [CLAMP | {"axial_stiffness": 3e7, "axial_capacity": 4e3, "shear_stiffness": 1e7,
                               "failure": "brittle"}],
    "dowels": [DOWEL | {"between": ("west", "one"), "shear_capacity": 2e3}, DOWEL | {"between": ("two", "east")},
               DOWEL | {"between": ("ground", "middle"), "embedment": 1e-2, "clearance": 1e-4}],
    "bar and layer": [
        {"kind": "bar", "between": ("ground", "west"), "at": (0.1, 0.0), "shear_stiffness": 1e7, "axial_stiffness": 2e7,
         "axial_capacity": 2e3},
        {"kind": "layer", "between": ("ground", "east"), "friction_coefficient": 0.1, "shear_stiffness": 1e5,
         "damping": 3e3},
    ],
    "tie and core": [
        {"kind": "tie", "between": ("ground", "one"), "at": (-0.2, 0.0), "to": (-0.2, 1.8), "axial_stiffness": 3e6,
         "axial_capacity": 3e3, "pretension": 5e2},
        {"kind": "core", "between": ("ground", "two"), "at": (3.4, 0.0), "to": (3.4, 2.0), "axial_stiffness": 5e6,
         "pretension": 4e3},
    ],
}  # fmt: skip


def linked(kind: str) -> Assembly:
    return dataclasses.replace(PORTAL, links=tuple(block_link(**fields) for fields in KINDS[kind]))


@pytest.mark.parametrize("kind", KINDS)
def test_the_ledger_closes_with_every_kind_of_link(kind, tmp_path) -> None:
    """To 0.2 % of the energy at stake, in a quarter of the usual step: the bare portal leaves as much."""
    response = simulate(linked(kind), MOTION, st.DistinctElement2D(step_factor=0.1))
    links = response.measures.links
    assert response.energy_imbalance < 2e-3
    assert min(max(link.peak_shear, link.peak_tension) for link in links) > 100.0
    if kind == "yielding clamp":
        assert links[0].peak_tension == pytest.approx(4e3, rel=1e-9)
        assert links[0].peak_elongation > 3.0 * 4e3 / 3e7
    if kind == "brittle clamp":
        assert links[0].broken
        summary = response.summary()
        assert summary["links_broken"] == 1
        assert summary["links"][0]["broken_s"] == links[0].broken_at
        after = response.time > links[0].broken_at
        assert not response.links.tension[after].any()
        assert not response.links.shear[after].any()
    if kind == "tie and core":
        assert response.links.tension[0] == pytest.approx([5e2, 4e3])
        again = st.load_response(response.save(tmp_path / "run.nc"))
        assert again.measures == response.measures
        assert again.assembly == response.assembly
        assert np.array_equal(again.links.tension, response.links.tension)


def test_links_without_stiffness_are_none_to_the_bit() -> None:
    idle: dict[str, Any] = {**CLAMP, "axial_stiffness": 0.0, "shear_stiffness": 0.0}
    nothing = (block_link(**idle),)
    motion = st.harmonic(frequency=2.0, amplitude=4.5, duration=0.3)
    model = st.DistinctElement2D()
    bare, other = (simulate(dataclasses.replace(PORTAL, links=links), motion, model) for links in ((), nothing))
    assert np.array_equal(bare.x, other.x)
    assert np.array_equal(bare.rotation, other.rotation)
    assert bare.measures == other.measures
    assert "links" not in PORTAL.to_dict()


def test_links_come_back_from_descriptions() -> None:
    for kind in KINDS:
        assembly = linked(kind)
        again = assembly_from_dict(assembly.to_dict())
        assert again == assembly
        assert again.digest == assembly.digest != PORTAL.digest


def test_a_column_in_an_assembly_takes_its_links_along(tmp_path) -> None:
    """Dowels, a bar, a tie and a core of a column do in an assembly what they do in ``dem2d``.

    To 1 % until its joints slip: the lanes begin closed by formula, an assembly by settling to 10⁻⁴ m/s² of residual.
    """
    (tmp_path / "column.toml").write_text(
        "density = 2500.0\n[tapered]\nheight = 1.8\nbottom_width = 0.5\ntop_width = 0.4\ndrums = 3\n"
        "[joint]\nnormal_stiffness = 5e9\nshear_stiffness = 2.5e9\nfriction_coefficient = 0.5\n"
        '[[link]]\nkind = "dowel"\njoints = "all"\nat = [0.1, 0.0]\nshear_stiffness = 1e7\n'
        '[[link]]\nkind = "bar"\njoint = 1\nat = [-0.1, 0.0]\nshear_stiffness = 1e7\naxial_stiffness = 2e7\n'
        '[[link]]\nkind = "tie"\nat = [0.3, 0.0]\nto = [0.25, 0.0]\nto_height = 1.7\naxial_stiffness = 3e6\n'
        "pretension = 500.0\n"
        '[[link]]\nkind = "core"\naxial_stiffness = 5e6\npretension = 4e3\n'
    )
    (tmp_path / "alone.toml").write_text('[[column]]\nfile = "column.toml"\nat = [1.0]\n')
    column, assembly = st.read_column(tmp_path / "column.toml"), st.read_assembly(tmp_path / "alone.toml")
    assert assembly.placed_links[-1].name == "column 1, core from the base to drum 3"
    step = 0.5 * engine_for(st.DistinctElement2D(), column).step
    model = st.DistinctElement2D(time_step=step)
    motion = st.harmonic(frequency=2.0, amplitude=4.0, duration=0.25)
    plane, blocks = st.simulate(column, motion, model), simulate(assembly, motion, model)
    way, other = plane.drum_x[:, -1], blocks.x[:, -1] - blocks.x[0, -1]
    assert np.abs(way).max() > 1e-5
    assert other == pytest.approx(way, abs=0.01 * np.abs(way).max())
    for name in ("shear", "tension", "slip"):
        expected, actual = getattr(plane.links, name), getattr(blocks.links, name)
        assert actual == pytest.approx(expected, abs=0.01 * np.abs(expected).max())
