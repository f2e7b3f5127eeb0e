"""Columns with links, followed until all lies still: the ledger, links that do nothing, hold, and break on the way down."""

from __future__ import annotations

import math

import numpy as np
import pytest
from conservation.test_links import COLUMN, KINDS

import stylobate as st

#: Under this the bare column falls, and comes to rest within four seconds.
PUSH = st.harmonic(frequency=1.0, amplitude=6.0, duration=2.0)


def to_the_ground(links: tuple[st.Link, ...], model: st.DistinctElement2D | None = None) -> st.Response:
    response = st.simulate(COLUMN.replace(links=links), PUSH, model or st.DistinctElement2D(), until_rest=True)
    assert response.mechanism is not None
    assert response.mechanism.at_rest
    return response


@pytest.mark.parametrize("kind", KINDS)
def test_the_ledger_closes_until_all_lies_still(kind) -> None:
    """To 1 % of the energy at stake, as without links; measured 0.05 to 0.8 %, the bare column 0.05 %."""
    response = to_the_ground(KINDS[kind])
    assert response.energy_imbalance < 0.01
    assert response.collapsed == bool(response.mechanism.fallen)
    assert max(max(link.peak_shear, link.peak_tension) for link in response.measures.links) > 100.0
    energy = response.histories.energy
    for term in ("friction", "viscous"):  # a slip, a break and a dashpot can only take energy
        assert np.diff(energy[term]).min() >= -1e-3 * energy[term].max()


def test_links_that_are_never_reached_change_no_bit() -> None:
    """Dowels with a metre of slack, through the whole fall: nothing but their presence in the engine."""
    slack = tuple(
        st.Dowel(joint=j, shear_stiffness=1e7, shear_capacity=1e3, clearance=1.0, embedment=0.01) for j in (1, 2, 3)
    )
    model = st.DistinctElement2D(time_step=5e-5)
    bare, linked = to_the_ground((), model), to_the_ground(slack, model)
    assert bare.collapsed
    assert linked.provenance["first_foreign_contact_s"] == bare.provenance["first_foreign_contact_s"] > 0.0
    for name in ("time", "drum_x", "drum_z", "drum_rotation", "joint_slip", "joint_opening"):
        assert np.array_equal(getattr(linked.histories, name), getattr(bare.histories, name))
    assert (
        bare.collapse_time <= linked.collapse_time < bare.collapse_time + 0.5
    )  # certain when they are out of their holes
    assert linked.energy_imbalance == bare.energy_imbalance
    assert not linked.links.shear.any()
    assert max(link.peak_slip for link in linked.measures.links) > 0.05


def test_ties_hold_a_column_that_falls_without_them() -> None:
    ties = tuple(st.Tie(at=(x, 0.0), to=(0.8 * x, 0.0), to_height=1.7, axial_stiffness=1e7) for x in (0.3, -0.3))
    bare, tied = to_the_ground(()), to_the_ground(ties)
    assert bare.mechanism.fallen == (1, 2, 3)
    assert tied.mechanism.fallen == ()
    assert tied.mechanism.standing == (1, 2, 3)
    assert not tied.collapsed
    assert tied.measures.decided
    assert min(link.peak_tension for link in tied.measures.links) > 1e3


def test_links_that_break_in_the_fall_are_told() -> None:
    """A tie that the column stretches by 0.4 m while it falls, and a dowel that its shaking snaps long before."""
    tie = st.Tie(
        at=(-0.3, 0.0),
        to=(-0.25, 0.0),
        to_height=1.7,
        axial_stiffness=1e3,
        axial_capacity=50.0,
        ultimate_elongation=0.4,
    )
    dowel = st.Dowel(joint=1, shear_stiffness=1e7, shear_capacity=600.0, failure="brittle")
    response = to_the_ground((tie, dowel))
    broken = {link.kind: link for link in response.measures.links}
    assert response.collapsed
    assert broken["dowel"].broken_at < 0.5
    assert broken["tie"].broken_at > 1.0
    assert broken["tie"].peak_elongation >= 0.4
    after = response.time > broken["tie"].broken_at
    assert after.any()
    assert not response.links.tension[after].any()
    assert response.energy_imbalance < 0.01
    summary = response.summary()
    assert summary["links_broken"] == 2
    assert summary["first_link_broken_s"] == broken["dowel"].broken_at
    assert "broke" in response.sentence
    assert not math.isnan(summary["links"][0]["broken_s"])
