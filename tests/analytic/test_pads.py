"""Pads in joints against hand calculations: closure, frequencies, pushover, friction, moduli; and bad ones."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

import stylobate as st
from stylobate.column.assembly import Assembly, Block
from stylobate.column.assembly_files import assembly_from_dict
from stylobate.column.files import write_column
from stylobate.column.links import block_link
from stylobate.models.base import Case, RunOptions
from stylobate.models.drums.records import bed_laws
from stylobate.models.engine import engine_for
from stylobate.simulate import simulate
from stylobate.statics.limit import limit_analysis, limit_in_space
from stylobate.statics.pushover import pushover

MODELS = [st.DistinctElement2D(), st.RigidBlock(), st.DistinctElement3D()]
JOINT = st.Joint(normal_stiffness=2e9, shear_stiffness=1e9, friction_coefficient=2.0)
#: A flat block of 2 t: it slides to and fro on its pad, and hardly rocks.
FLAT = st.Column.of_drums([st.Drum(0.2, 2.0, 2.0, 2500.0, depth=2.0)], JOINT, name="flat")
SOFT = {"normal_stiffness": 1e8, "shear_stiffness": 2e6}
AREA, WEIGHT = 4.0, FLAT.mass * FLAT.gravity
#: Of stone and pad in series [N/m³].
NORMAL, SHEAR = 1.0 / (1.0 / 2e9 + 1.0 / 1e8), 1.0 / (1.0 / 1e9 + 1.0 / 2e6)
PERIOD = 2.0 * math.pi * math.sqrt(FLAT.mass / (SHEAR * AREA))


def on_pad(**fields) -> st.Column:
    return FLAT.replace(links=[st.Pad(joint=1, **fields)])


def period(time: np.ndarray, place: np.ndarray) -> float:
    """Of what swings freely from 0.06 s on [s]."""
    early, late = place[:-1], place[1:]
    crossed = np.flatnonzero((early * late < 0.0) & (time[:-1] > 0.06))
    at = time[crossed] - early[crossed] * (time[1] - time[0]) / (late[crossed] - early[crossed])
    return 2.0 * float(np.diff(at).mean())


PULSE = st.Motion(0.001, np.r_[np.full(50, 0.5), np.zeros(950)])


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
def test_a_joint_closes_under_the_weight_by_both_springs(model) -> None:
    column = on_pad(**SOFT)
    block = engine_for(model, column).block(RunOptions())
    block.load(0, Case(column, PULSE))
    height = block.records.body["z"][1, 0]
    assert height == pytest.approx(0.1 - WEIGHT / (NORMAL * AREA), abs=1e-12)


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
def test_a_block_swings_on_its_pad(model) -> None:
    """T = 2π √(m / k_s A), to 0.2 %: rocking on the same pad makes it 0.06 % longer."""
    response = st.simulate(on_pad(**SOFT), PULSE, model)
    assert period(response.time, response.drum_x[:, 0]) == pytest.approx(PERIOD, rel=2e-3)
    assert response.energy_imbalance < 1e-3


def test_a_block_of_an_assembly_swings_on_its_pad() -> None:
    """As a column does, with the same law in the joint; the pad comes back from a description."""
    block = Block(((-1.0, 0.0), (1.0, 0.0), (1.0, 0.2), (-1.0, 0.2)), 2500.0, "flat", depth=2.0)
    pad = block_link("pad", ("ground", "flat"), **SOFT, friction_coefficient=0.9)
    assembly = Assembly((block,), JOINT, links=(pad,))
    (joint,) = assembly.joints
    assert (joint.law.normal_stiffness, joint.law.shear_stiffness) == pytest.approx((NORMAL, SHEAR))
    assert joint.law.tan_phi == 0.9
    again = assembly_from_dict(json.loads(json.dumps(assembly.to_dict())))
    assert again == assembly
    assert again.digest == assembly.digest
    response = simulate(assembly, PULSE, st.DistinctElement2D())
    assert period(response.time, response.x[:, 1]) == pytest.approx(PERIOD, rel=2e-3)


def test_a_pushover_begins_with_the_stiffness_of_the_pad() -> None:
    """Top displacement over multiplier: W/(k_s A) of slip, and W h/2 · h/(k_n J) of rotation."""
    path = pushover(on_pad(**SOFT), to=2e-4)
    expected = WEIGHT / (SHEAR * AREA) + WEIGHT * 0.1 * 0.2 / (NORMAL * 8.0 * 2.0 / 12.0)
    assert path.displacement[1] / path.multiplier[1] == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("friction", [{"friction_coefficient": 0.1}, {"friction_angle": math.degrees(math.atan(0.1))}])
def test_limit_analysis_knows_the_friction_of_a_pad(friction) -> None:
    column = on_pad(**SOFT, **friction)
    assert limit_analysis(column).multiplier == pytest.approx(0.1, rel=1e-9)
    assert limit_in_space(column, 30.0).multiplier == pytest.approx(0.1, rel=1e-4)
    assert limit_analysis(on_pad(**SOFT)).multiplier == pytest.approx(2.0, rel=1e-9)


def test_a_pad_holds_nothing_in_tension() -> None:
    """A slender block rocks on a stiff pad as without it: the same static acceleration opens it."""
    slender = st.Column.of_drums([st.Drum(2.0, 0.4, 0.4, 2500.0)], JOINT)
    stood = slender.replace(links=[st.Pad(joint=1, thickness=0.003, material="lead")])
    assert limit_analysis(stood).multiplier == pytest.approx(limit_analysis(slender).multiplier, rel=1e-9)
    pulse = st.cosine_pulse(frequency=1.0, amplitude=4.0)
    bare, padded = (st.simulate(column, pulse, st.DistinctElement2D()) for column in (slender, stood))
    assert bare.peak_rotation > 0.01
    assert padded.peak_rotation == pytest.approx(bare.peak_rotation, rel=0.02)


def test_moduli_of_lead_and_rubber_by_hand() -> None:
    """Lead E/t, G/t; rubber of 20 mm under 2 m × 2 m has S = 25, round ones of 1 m S = 12.5 (Lindley)."""
    (lead,) = on_pad(thickness=0.004, material="lead").placed_links
    assert (lead.bed_stiffness, lead.bed_shear_stiffness) == pytest.approx((16.1e9 / 0.004, 5.59e9 / 0.004))
    (rubber,) = on_pad(thickness=0.02, material="rubber").placed_links
    assert rubber.bed_stiffness == pytest.approx(1.0 / (0.02 / (2.2e6 * (1.0 + 1.46 * 625.0)) + 0.02 / 1030e6))
    assert rubber.bed_shear_stiffness == pytest.approx(0.64e6 / 0.02)
    round_ = st.Column.of_drums([st.Drum(1.0, 1.0, 1.0, 2500.0, "circular")], JOINT)
    (pad,) = round_.replace(links=[st.Pad(joint=1, thickness=0.02, material="rubber")]).placed_links
    assert pad.bed_stiffness == pytest.approx(1.0 / (0.02 / (2.2e6 * (1.0 + 1.46 * 156.25)) + 0.02 / 1030e6))
    between = {"kind": "pad", "between": ("a", "b"), "thickness": 0.02, "material": "rubber"}
    made = block_link(**between, shape_factor=25.0).numbers
    assert made is not None
    assert made.bed_stiffness == rubber.bed_stiffness
    with pytest.raises(st.InputError, match="between two bodies has no shape_factor"):
        block_link(**between)


def test_a_file_puts_pads_into_all_joints(tmp_path) -> None:
    column = st.Column.of_drums([st.Drum(1.0, 0.8, 0.8, 2500.0)] * 3, JOINT)
    path = write_column(column, tmp_path / "column.toml")
    with path.open("a") as file:
        file.write(
            '[[link]]\nkind = "pad"\njoints = "all"\nthickness = 0.003\nmaterial = "lead"\nfriction_angle = 20.0\n'
        )
    read = st.read_column(path)
    assert [link.joint for link in read.placed_links] == [1, 2, 3]
    assert read.friction == pytest.approx(math.tan(math.radians(20.0)))
    assert st.read_column(write_column(read, tmp_path / "again.toml")) == read
    assert column.replace(links=()).digest != read.digest


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({}, "neither material nor both normal_stiffness"),
        ({"normal_stiffness": 1e9}, "neither material nor both"),
        ({"material": "led", "thickness": 0.01}, "did you mean lead"),
        ({"material": "lead"}, "a pad of lead has no thickness"),
        ({**SOFT, "thickness": 0.0}, "thickness of a pad"),
        ({**SOFT, "normal_stiffness": -1.0}, "normal_stiffness of a pad"),
        ({**SOFT, "friction_coefficient": 0.1, "friction_angle": 5.0}, "give one of the two"),
        ({**SOFT, "at": (0.1, 0.0)}, "a pad covers its joint"),
        ({**SOFT, "joint": 2}, "there is no joint 2 for a pad"),
        ({**SOFT, "joint": None}, "a pad has no joint"),
    ],
)
def test_bad_pads_are_refused_in_one_sentence(fields, words) -> None:
    with pytest.raises(st.InputError, match=words):
        FLAT.replace(links=[st.Pad(**{"joint": 1} | fields)])


def test_a_pad_parts_the_stones() -> None:
    pad = st.Pad(joint=1, **SOFT)
    with pytest.raises(st.InputError, match="two pads"):
        FLAT.replace(links=[pad, pad])
    with pytest.raises(st.InputError, match="give that joint cohesion = 0"):
        FLAT.with_joint(cohesion=1e5).replace(links=[pad])


@pytest.mark.parametrize("modulus", [None, 3e10])
def test_what_has_come_down_lies_on_the_joint_with_its_layer_or_pad_and_on_all_else_without(modulus) -> None:
    drums = [st.Drum(0.4 + 0.2 * i, 1.0, 1.0, 2500.0) for i in range(3)]
    links = [st.Layer(joint=2, friction_coefficient=0.05), st.Pad(joint=3, **SOFT)]
    laws = bed_laws(st.Column.of_drums(drums, JOINT).replace(links=links), modulus)
    half = [0.0] * 4 if modulus is None else [0.0, *(0.5 * drum.height / modulus for drum in drums)]
    for upper in (1, 2, 3):
        for lower in range(upper):
            padded, friction = (lower, upper) == (2, 3), 0.05 if (lower, upper) == (1, 2) else 2.0
            bare = (NORMAL, SHEAR) if padded else (2e9, 1e9)
            normal = 1.0 / (1.0 / bare[0] + half[upper] + half[upper - 1])
            assert laws[lower, upper] == pytest.approx([normal, bare[1] * normal / bare[0], friction], rel=1e-12)
