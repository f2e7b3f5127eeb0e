"""Links as data: files and back, digests, numbers of presets by their formulas, and every mistake in one sentence."""

from __future__ import annotations

import json
import math
import random
import re
from typing import Any

import pytest

import stylobate as st
from stylobate.column.files import column_from_dict, write_column
from stylobate.column.links import COLUMN_KINDS, KINDS
from stylobate.column.links.kinds import shear_limits, shear_stiffness
from stylobate.column.links.link import MATERIALS
from stylobate.models.engine import engine_for
from stylobate.models.registry import MODELS, model_class
from stylobate.statics.limit import limit_analysis, limit_in_space

JOINT = st.Joint(normal_stiffness=5e10, shear_stiffness=2.5e10, friction_angle=35.0)
COLUMN = st.Column.tapered(
    height=5.0, bottom_width=0.96, top_width=0.66, drums=12, density=1600.0, joint=JOINT, section="circular"
)
#: SHA-256 of this column before there were links.
DIGEST = "cf5328c3705b61ff5499fe2b97e3c4294dcb7b439120614cd95b9de4590d2992"

ALL_KINDS = (
    st.Dowel(joint=3, at=(0.1, -0.1), diameter=0.04, embedment=0.1, material="titanium", clearance=0.001),
    st.Dowel(joint=3, shear_stiffness=1e8, shear_capacity=2e4, failure="brittle", name="key"),
    st.Bar(joint=1, diameter=0.03, embedment=0.2, material="stainless steel", pretension=1e3),
    st.Tie(at=(0.55, 0.0), to=(0.4, 0.0), diameter=0.02, material="stainless steel", pretension=1e4),
    st.Core(diameter=0.03, material="titanium", to_drum=11),
    st.Layer(joint=1, friction_coefficient=0.05, shear_stiffness=1e5, damping=1e4),
    st.Pad(joint=5, thickness=0.005, material="lead", friction_angle=30.0),
)


def test_every_kind_that_a_column_may_have_is_tried_here() -> None:
    assert {link.kind for link in ALL_KINDS} == set(COLUMN_KINDS)


def test_a_column_without_links_keeps_its_digest() -> None:
    assert COLUMN.digest == DIGEST
    assert COLUMN.replace(links=()).digest == DIGEST
    assert COLUMN.replace(links=ALL_KINDS).digest != DIGEST


def test_links_come_back_from_files_and_descriptions(tmp_path) -> None:
    column = COLUMN.replace(links=ALL_KINDS)
    assert st.read_column(write_column(column, tmp_path / "column.toml")) == column
    assert column_from_dict(json.loads(json.dumps(column.to_dict()))) == column


def test_a_file_puts_one_link_into_all_joints(tmp_path) -> None:
    path = write_column(COLUMN, tmp_path / "column.toml")
    with path.open("a") as file:
        file.write(
            '[[link]]\nkind = "dowel"\njoints = "all"\nat = [0.1, 0]\nshear_stiffness = 1e8\n'
            '[[link]]\nkind = "layer"\njoints = [1, 2]\ndamping = 1000\n'
        )
    links = st.read_column(path).links
    assert [link.joint for link in links if isinstance(link, st.Dowel)] == list(range(1, 13))
    assert [link.joint for link in links if isinstance(link, st.Layer)] == [1, 2]


def test_the_friction_of_a_joint_is_that_of_its_layer() -> None:
    friction = COLUMN.replace(links=ALL_KINDS).friction
    assert friction[0] == 0.05
    assert friction[1] == JOINT.tan_phi
    assert COLUMN.replace(links=ALL_KINDS).replace(links=()).friction[0] == JOINT.tan_phi


def test_long_and_short_dowels_meet_the_limits_of_a_beam_on_a_foundation() -> None:
    """Long: K/(4 β), the half-infinite beam; short: K l/8, a rigid pin that turns (Hetényi 1946)."""
    d, stone = 0.03, 50e9
    bending = 105e9 * math.pi * d**4 / 64.0
    bed = 0.65 * (stone * d**4 / bending) ** (1 / 12) * stone / (1.0 - 0.25**2)
    beta = (bed / (4.0 * bending)) ** 0.25
    assert shear_stiffness("titanium", d, 12.0 / beta, stone) == pytest.approx(bed / (4.0 * beta), rel=1e-6)
    assert shear_stiffness("titanium", d, 0.1 / beta, stone) == pytest.approx(bed * 0.1 / beta / 8.0, rel=1e-4)


def test_a_thin_long_dowel_is_sheared_and_a_short_thick_one_crushes_the_stone() -> None:
    thin = shear_limits("titanium", 0.02, 0.2, 60e6)
    assert min(thin, key=lambda name: thin[name]).startswith("shear of the bar")
    assert min(thin.values()) == pytest.approx(275e6 / math.sqrt(3.0) * math.pi * 0.02**2 / 4.0)
    short = st.Dowel(joint=2, diameter=0.2, embedment=0.05, material="titanium", stone_strength=10e6)
    made = COLUMN.replace(links=[short]).placed_links[0].alone  # beside its stone, whose edge gives way first
    assert made.failure == "crushing"
    assert made.shear_capacity == pytest.approx((math.sqrt(2.0) - 1.0) * 30e6 * 0.2 * 0.05)


def test_a_tie_has_the_stiffness_and_yield_of_its_bar() -> None:
    tie = COLUMN.replace(links=ALL_KINDS).placed_links[3]
    area, length = math.pi * 0.01**2, math.dist(tie.low, tie.high)
    assert tie.axial_stiffness == pytest.approx(200e9 * area / length)
    assert tie.axial_capacity == pytest.approx(200e6 * area)
    assert (tie.lower, tie.upper, tie.straight) == (0, 12, True)


TITANIUM: dict[str, Any] = {"diameter": 0.04, "embedment": 0.1, "material": "titanium"}


@pytest.mark.parametrize(
    ("made", "message"),
    [
        (lambda: st.Dowel(joint=2, **(TITANIUM | {"embedment": 0.5})), "embedded by 0.5 m, and drum 2 is 0.416667 m"),
        (lambda: st.Dowel(joint=2, at=(0.7, 0.0), **TITANIUM), "outside the section"),
        (lambda: st.Dowel(joint=2, at=(0.43, 0.0), **TITANIUM), "at least 20 mm must be left"),
        (lambda: st.Dowel(joint=2, clearance=0.05, **TITANIUM), "leaves 0.02 m all round"),
        (lambda: st.Dowel(joint=2, clearance=0.005, hole=0.042, **TITANIUM), "its hole leaves 0.001 m all round"),
        (lambda: st.Tie(at=(0.3, 0.0), axial_stiffness=1e6), "passes through stone"),
        (lambda: st.Core(at=(0.32, 0.0), axial_stiffness=1e6), "to the rim of drum 12"),
        (lambda: st.Dowel(joint=2, shear_stiffness=1e6, shear_capacity=0.0), "holds nothing"),
        (lambda: st.Dowel(joint=13, shear_stiffness=1e6), "there is no joint 13"),
        (lambda: st.Dowel(joint=0, shear_stiffness=1e6), "allowed is a whole number from 1"),
        (lambda: st.Dowel(joint=2, diameter=0.04, embedment=0.1, material="titan"), "did you mean titanium"),
        (lambda: st.Dowel(joint=2), "neither material nor shear_stiffness"),
        (lambda: st.Dowel(joint=2, shear_stiffness=1e6, failure="britle"), "did you mean brittle"),
        (lambda: st.Tie(at=(0.6, 0.0), axial_stiffness=1e6, axial_capacity=1e3, pretension=2e3), "more than its axial"),
        (lambda: st.Tie(at=(0.6, 0.0), from_drum=3, to_drum=2, axial_stiffness=1e6), "must be the higher one"),
        (lambda: st.Tie(at=(0.6, 0.0), to_drum=40, axial_stiffness=1e6), "the drums are 1 to 12"),
        (lambda: st.Layer(joint=1), "neither friction_coefficient"),
        (lambda: st.Dowel(joint=2, **{"at": (0.1,), "shear_stiffness": 1e6}), "a place in plan"),
        (lambda: st.Dowel(joint=2, **(TITANIUM | {"stone_strength": 60.0})), r"is 60 Pa; .* use SI units"),
        (lambda: "dowel", "allowed is a Dowel, Bar, Tie, Core, Layer or Pad"),
    ],
)
def test_what_cannot_be_is_said_in_one_sentence(made, message) -> None:
    with pytest.raises(st.InputError, match=message) as error:
        COLUMN.replace(links=[made()])
    assert str(error.value).count(". ") == 0
    assert str(error.value).endswith(".")


def test_files_name_the_table_and_the_nearest_key(tmp_path) -> None:
    path = write_column(COLUMN, tmp_path / "column.toml")
    text = path.read_text()
    for table, message in (
        ('kind = "dovel"\njoint = 1', "did you mean dowel"),
        ('kind = "dowel"\njoint = 1\nshear_stifness = 1e6', "shear_stiffness"),
        ('kind = "dowel"\nshear_stiffness = 1e6', "a dowel has no joint"),
        ('kind = "layer"\njoint = 1\nembedment = 0.1\ndamping = 1.0', "a layer has no 'embedment'"),
        ('kind = "tie"\njoints = "all"\naxial_stiffness = 1e6', "give from_drum and to_drum"),
        ('kind = "dowel"\njoints = "some"\nshear_stiffness = 1e6', 'must be "all"'),
    ):
        path.write_text(f"{text}\n[[link]]\n{table}\n")
        with pytest.raises(st.InputError, match=message):
            st.read_column(path)


def test_models_without_links_refuse_them() -> None:
    column = COLUMN.replace(links=[st.Dowel(joint=2, shear_stiffness=1e6)])
    motion = st.harmonic(frequency=1.0, amplitude=1.0, duration=1.0)
    for model in (st.HousnerBlock(), st.RigidBeam()):
        with pytest.raises(st.InputError, match="knows no links"):
            st.simulate(column, motion, model)


class Brake(st.Tie):
    """A kind of link that nobody computes."""

    kind = "brake"


def test_two_dowels_in_one_stone_are_no_two_dowels() -> None:
    """A block of a file that is copied, and its place forgotten, would hold twice as much."""
    far, near, joint = (st.Dowel(joint=k, at=(x, 0.0), **TITANIUM) for k, x in ((2, 0.2), (2, 0.17), (3, 0.17)))
    COLUMN.replace(links=[far, joint, st.Dowel(joint=2, at=(0.15, 0.0), **TITANIUM)])
    with pytest.raises(st.InputError, match=r"link 2 .* in joint 2 are 0\.03 m apart .* give them other places"):
        COLUMN.replace(links=[far, near])


@pytest.mark.parametrize("name", [*MODELS, "limit_analysis", "limit_in_space", "pushover"])
def test_a_new_kind_is_refused_by_all_until_one_takes_it(name) -> None:
    """Also where it is a tie in all but its name: nobody may take it for what it lies like."""
    column = COLUMN.replace(
        links=[st.Tie(at=(0.55, 0.0), axial_stiffness=1e6), Brake(at=(-0.55, 0.0), axial_stiffness=1e6)]
    )
    statics = {"limit_analysis": limit_analysis, "limit_in_space": limit_in_space, "pushover": st.pushover}
    motion = st.harmonic(frequency=1.0, amplitude=1.0, duration=1.0)
    refused = r"and '.*' (has a brake, which )?does not; .*leave it out\.$|knows no links"
    with pytest.raises(st.InputError, match=refused):
        statics[name](column) if name in statics else engine_for(model_class(name)(), column).check(motion)


def test_a_kind_lies_where_all_lie_that_act_by_its_law() -> None:
    """Engines compute a straight line by where it lies, and models take it by its law."""
    with pytest.raises(TypeError, match="Post acts as a dowel, which lies in a joint, and lies in a line"):
        type("Post", (st.Dowel,), {"law": "dowel", "lies": "line"})


def test_every_kind_acts_by_a_law_that_a_model_knows() -> None:
    taken = {law for name in MODELS for engine in model_class(name).engines for law in engine.links}
    assert {kind.law for kind in KINDS.values()} == taken


@pytest.mark.parametrize("model", [st.DistinctElement2D(), st.DistinctElement3D()], ids=lambda model: model.name)
def test_what_lanes_have_of_their_own_begins_on_lines_of_the_cache(model) -> None:
    """64 bytes, in every row of a record: vectors across two lines made dowels cost a fifth more."""
    engine = engine_for(model, st.preset("paper-monolithic"))
    types = (
        engine.record_types(linked=True)
        if isinstance(model, st.DistinctElement2D)
        else engine.kind.record_types(linked=True)
    )
    for record_type in types.values() if isinstance(types, dict) else types:
        if not any(field.subdtype for field, *_ in record_type.fields.values()):
            continue  # numbers that all lanes share
        assert record_type.itemsize % 64 == 0
        lanes = [record_type.fields[name] for name in record_type.names if record_type.fields[name][0].itemsize >= 64]
        assert all(start % 64 == 0 for _, start in lanes)


def strengths(kind, at: float, size: dict[str, Any]) -> tuple[float, float, float, str]:
    """Shear and pull that a link of the column holds [N], its distance from the nearest edge [m], and how it fails."""
    (link,) = COLUMN.replace(links=[kind(joint=3, at=(at, 0.0), **size)]).placed_links
    assert link.stone is not None
    assert link.shear_capacity == min(link.alone.shear_capacity, link.stone.shear)
    assert link.axial_capacity == min(link.alone.axial_capacity, link.stone.pull)
    return link.shear_capacity, link.axial_capacity, link.stone.edge, link.failure


@pytest.mark.parametrize("seed", range(40))
def test_no_link_bears_more_nearer_to_the_rim_or_in_weaker_stone(seed) -> None:
    """Every size, place and stone that is allowed, to the ends of their ranges: what the stone limits is never left out."""
    draw = random.Random(seed)
    kind, embedment = draw.choice((st.Dowel, st.Bar)), 0.01 * 40.0 ** draw.choice((0.0, draw.random()))
    size = {"diameter": draw.uniform(0.005, 0.08), "embedment": embedment, "material": draw.choice([*MATERIALS])}
    rim = 0.5 * min(COLUMN.drums[2].bottom_width, COLUMN.drums[1].top_width) - 0.5 * size["diameter"] - 0.02
    stone = 1e6 * 500.0 ** draw.choice((0.0, draw.random(), 1.0))
    far, near = sorted(draw.choice((0.0, rim - 1e-9, draw.uniform(0.0, rim))) for _ in range(2))
    weak, strong = (strengths(kind, far, size | {"stone_strength": f}) for f in sorted((stone, draw.uniform(1e6, 5e8))))
    first, last = (strengths(kind, at, size | {"stone_strength": stone}) for at in (far, near))
    for less, more in ((weak, strong), (last, first)):
        assert less[0] <= more[0] * (1.0 + 1e-12)
        assert less[1] <= more[1] * (1.0 + 1e-12)
    d, h, c = (1e3 * length for length in (size["diameter"], embedment, last[2]))
    along = min(h, 12.0 * d if d <= 24.0 else max(8.0 * d, 300.0))
    edge = 1.7 * d ** (0.1 * math.sqrt(along / c)) * along ** (0.1 * (d / c) ** 0.2) * math.sqrt(1e-6 * stone) * c**1.5
    bar = min(shear_limits(size["material"], size["diameter"], embedment, stone).values())
    assert last[0] == pytest.approx(min(edge, bar), rel=1e-9)
    assert (last[3] == "brittle") == (edge < bar)


@pytest.mark.parametrize(
    ("change", "allowed"),
    [({"stone_strength": 9e5}, "1e+06"), ({"embedment": 0.009}, "0.01"), ({"diameter": 0.3}, "0.2")],
)
def test_a_link_whose_stone_no_formula_knows_is_refused(change, allowed) -> None:
    """It would hold its bar's own capacity, more than in a stone that is a little better."""
    with pytest.raises(st.InputError, match=re.escape(allowed)):
        st.Dowel(joint=2, **TITANIUM | change)
