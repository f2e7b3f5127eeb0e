"""Links: the ledger closes with every kind, mirror images, one law in both models, and links that do nothing."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import stylobate as st
from stylobate.column.links import COLUMN_KINDS
from stylobate.models.base import Case, RunOptions
from stylobate.models.engine import engine_for

JOINT = st.Joint(normal_stiffness=5e9, shear_stiffness=2.5e9, friction_coefficient=0.5)
COLUMN = st.Column.tapered(height=1.8, bottom_width=0.5, top_width=0.4, drums=3, density=2500.0, joint=JOINT)
MOTION = st.harmonic(frequency=2.0, amplitude=4.5, duration=1.5)
PLANE, SPACE = st.DistinctElement2D(), st.DistinctElement3D(planar=True)

KINDS: dict[str, tuple[st.Link, ...]] = {
    "elastic dowels": tuple(st.Dowel(joint=j, at=(0.1, 0.0), shear_stiffness=1e7, clearance=1e-4) for j in (1, 2, 3)),
    "yielding dowels": tuple(st.Dowel(joint=j, shear_stiffness=1e7, shear_capacity=600.0) for j in (1, 2, 3)),
    "crushing dowels": tuple(
        st.Dowel(joint=j, shear_stiffness=1e7, shear_capacity=600.0, failure="crushing") for j in (1, 2, 3)
    ),
    "brittle dowels": tuple(
        st.Dowel(joint=j, shear_stiffness=1e7, shear_capacity=600.0, failure="brittle") for j in (1, 2, 3)
    ),
    "short dowels": tuple(st.Dowel(joint=j, at=(-0.1, 0.0), shear_stiffness=1e7, embedment=0.01) for j in (1, 2, 3)),
    "bars": (
        st.Bar(joint=1, at=(0.1, 0.0), shear_stiffness=1e7, axial_stiffness=2e7, axial_capacity=4e3, pretension=1e3),
        st.Bar(joint=1, at=(-0.1, 0.0), shear_stiffness=1e7, axial_stiffness=2e7, axial_capacity=4e3, pretension=1e3),
    ),
    "ties": (
        st.Tie(at=(0.3, 0.0), to=(0.25, 0.0), to_height=1.7, axial_stiffness=3e6, axial_capacity=3e3, pretension=5e2),
        st.Tie(at=(-0.3, 0.0), to=(-0.25, 0.0), to_height=1.7, axial_stiffness=3e6, ultimate_elongation=2e-3),
    ),
    "core": (st.Core(axial_stiffness=5e6, pretension=4e3),),
    "layer": (st.Layer(joint=1, friction_coefficient=0.1, shear_stiffness=1e5, shear_capacity=5e3, damping=3e3),),
    "pad under bars": (
        st.Pad(joint=1, normal_stiffness=5e9, shear_stiffness=2e9, friction_coefficient=0.3),
        st.Bar(joint=1, shear_stiffness=1e7, axial_stiffness=2e7),
    ),
}


def test_every_kind_that_a_column_may_have_is_tried_here() -> None:
    assert {link.kind for links in KINDS.values() for link in links} == set(COLUMN_KINDS)


def run(column: st.Column, model=PLANE, motion: st.Motion = MOTION) -> st.Response:
    return st.simulate(column, motion, model)


@pytest.mark.parametrize("kind", KINDS)
def test_the_ledger_closes_with_every_kind_of_link(kind) -> None:
    """To 0.2 % of the energy at stake, in a quarter of the usual step: in that one the joints alone leave 0.5 %."""
    response = run(COLUMN.replace(links=KINDS[kind]), st.DistinctElement2D(step_factor=0.1))
    links = response.measures.links
    assert response.energy_imbalance < 2e-3
    assert max(max(link.peak_shear, link.peak_tension) for link in links) > 100.0
    if kind == "yielding dowels":
        assert max(link.peak_slip for link in links) > 10.0 * 600.0 / 1e7
    if kind == "brittle dowels":
        assert any(link.broken for link in links)
        when = max(link.broken_at for link in links if link.broken)
        broken = [i for i, link in enumerate(links) if link.broken]
        assert not response.links.shear[response.time > when][:, broken].any()
    if kind == "layer":
        viscous = response.histories.energy["viscous"]
        assert viscous[-1] > 0.0
        assert (np.diff(viscous) > -1e-9).all()


@pytest.mark.parametrize("kind", ["elastic dowels", "brittle dowels", "bars", "ties", "layer"])
def test_rigid_blocks_close_their_ledger_with_links(kind) -> None:
    """Less their pretension, which rigid blocks refuse; to 0.2 %, in half of the usual step."""
    pulled = [link for link in KINDS[kind] if getattr(link, "pretension", 0.0)]
    links = [dataclasses.replace(link, pretension=0.0) if link in pulled else link for link in KINDS[kind]]
    response = run(COLUMN.replace(links=links), st.RigidBlock(step_factor=0.1))
    assert response.energy_imbalance < 2e-3
    assert max(max(link.peak_shear, link.peak_tension) for link in response.measures.links) > 100.0
    if pulled:
        with pytest.raises(st.InputError, match=r"pretension of .* N; use dem2d or dem3d"):
            run(COLUMN.replace(links=KINDS[kind]), st.RigidBlock())


@pytest.mark.parametrize("kind", ["elastic dowels", "yielding dowels", "bars", "ties", "layer"])
def test_held_in_a_plane_space_has_the_plane_law(kind) -> None:
    """Contact at the corners in both: to a thousandth until the joints slip, after 0.25 s."""
    column = COLUMN.replace(links=KINDS[kind])
    step = 0.9 * min(engine_for(model, column).step for model in (PLANE, SPACE))
    motion = st.harmonic(frequency=2.0, amplitude=4.5, duration=0.25)
    plane, space = (
        run(column, type(model)(**(model.parameters() | {"time_step": step})), motion) for model in (PLANE, SPACE)
    )
    scale = np.abs(plane.top_displacement).max()
    assert scale > 1e-5
    assert space.top_displacement[:, 0] == pytest.approx(plane.top_displacement, abs=1e-3 * scale)
    assert space.links.shear == pytest.approx(plane.links.shear, abs=1e-3 * max(plane.links.shear.max(), 1.0))
    assert space.links.tension == pytest.approx(plane.links.tension, abs=1e-3 * max(plane.links.tension.max(), 1.0))


@pytest.mark.parametrize("model", [PLANE, st.RigidBlock()], ids=lambda model: model.name)
def test_a_link_without_stiffness_is_no_link_to_the_bit(model) -> None:
    nothing = (st.Dowel(joint=2, shear_stiffness=0.0), st.Tie(at=(0.4, 0.0), axial_stiffness=0.0))
    bare, linked = run(COLUMN, model), run(COLUMN.replace(links=nothing), model)
    assert np.array_equal(bare.drum_x, linked.drum_x)
    assert np.array_equal(bare.drum_rotation, linked.drum_rotation)
    assert bare.measures == linked.measures


def test_a_broken_link_changes_nothing_afterwards() -> None:
    """All links of a block broken by hand before it moves: the drums go where those without links go, but for rounding."""
    model = st.DistinctElement2D(time_step=2e-5)
    motion = st.harmonic(frequency=2.0, amplitude=4.5, duration=0.5)
    linked = COLUMN.replace(links=KINDS["elastic dowels"] + KINDS["ties"][1:])
    positions = []
    for column in (COLUMN, linked):
        block = engine_for(model, column).block(RunOptions())
        block.load(0, Case(column, motion))
        if column.links:
            block.records.link["on"] = 0.0
        block.advance(200)
        positions.append(block.records.body["x"][1:, 0].copy())
        if column.links:
            assert not block.records.link["fx"].any()
            assert not block.records.link["ft"].any()
    assert positions[1] == pytest.approx(positions[0], rel=1e-9, abs=1e-15)


@pytest.mark.parametrize("model", [PLANE, st.DistinctElement3D()], ids=lambda model: model.name)
def test_mirror_images_move_as_mirror_images(model) -> None:
    """Until rounding has grown; a quarter of a second before joints open."""
    links = KINDS["elastic dowels"] + KINDS["bars"][:1] + KINDS["ties"][:1]
    mirrored = tuple(
        type(link)(
            **(
                vars(link)
                | {"at": (-link.at[0], link.at[1])}
                | ({"to": (-0.25, 0.0)} if isinstance(link, st.Tie) else {})
            )
        )
        for link in links
    )
    motion, reverse = (st.harmonic(frequency=2.0, amplitude=sign * 2.0, duration=0.25) for sign in (1.0, -1.0))
    original = run(COLUMN.replace(links=links), model, motion)
    other = run(COLUMN.replace(links=mirrored), model, reverse)
    x = original.histories.drum_x
    assert other.histories.drum_x == pytest.approx(-x, abs=1e-7 * np.abs(x).max())
    assert other.links.shear == pytest.approx(original.links.shear, abs=1e-6 * original.links.shear.max())


def test_a_batch_has_the_numbers_of_single_runs() -> None:
    """Columns with different links, some with none, in one batch: each goes to a block of its kind."""
    columns = [COLUMN, *(COLUMN.replace(links=KINDS[kind]) for kind in ("yielding dowels", "ties", "brittle dowels"))]
    motion = st.harmonic(frequency=2.0, amplitude=4.5, duration=0.5)
    table = st.simulate_many(columns, [motion] * len(columns), PLANE)
    for column, row in zip(columns, table.to_dict("records"), strict=True):
        alone = run(column, PLANE, motion).measures
        assert row["peak_top_displacement_m"] == alone.peak_top_displacement
        assert row["steps"] == alone.steps
        if column.links:
            assert row["links_broken"] == sum(link.broken for link in alone.links)
            assert row["link_utilisation"] == [link.utilisation for link in alone.links]


def test_a_response_with_links_comes_back_from_its_file(tmp_path) -> None:
    response = run(COLUMN.replace(links=KINDS["brittle dowels"] + KINDS["ties"]))
    again = st.load_response(response.save(tmp_path / "run.nc"))
    assert again.measures == response.measures
    assert np.array_equal(again.links.tension, response.links.tension)
    assert again.sentence == response.sentence
    data = response.to_xarray()
    assert data.link_shear.dims == ("time", "link")
    assert [link["name"] for link in response.summary()["links"]] == list(data.link.values)
    broken = sum(link.broken for link in response.measures.links)
    assert f"{broken} of 5 links broke, the first" in response.sentence


def test_what_cannot_go_with_links_says_so() -> None:
    column = COLUMN.replace(links=KINDS["core"])
    with pytest.raises(st.InputError, match="a start from a pose knows no links"):
        st.simulate(column, MOTION, PLANE, start=st.Start(tilt=0.01))
    with pytest.raises(st.InputError, match="not in equilibrium"):
        COLUMN.replace(links=[st.Tie(at=(0.3, 0.0), to_height=1.7, axial_stiffness=1e6, pretension=2e5)])
