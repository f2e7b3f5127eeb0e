"""Columns computed beside a single run: they change nothing of it, and are the same as in a batch."""

import dataclasses

import numpy as np
import pytest

import stylobate as st
from stylobate.campaign.twins import Twins, the_twins
from stylobate.column.scatter import twins_of
from stylobate.models.base import Case, RunOptions
from stylobate.response.words import to_decide
from stylobate.verdicts.population import Population, batch

COLUMN = st.Column.tapered(
    height=2.4, bottom_width=0.5, top_width=0.4, drums=3, density=2600.0, section="circular",
    joint=st.Joint(normal_stiffness=2e9, shear_stiffness=1e9, friction_coefficient=0.7),
)  # fmt: skip

ROW = {"peak_top_displacement_m": 0.1, "residual_top_displacement_m": 0.01, "peak_rotation_rad": 0.1,
       "residual_joint_slip_m": 0.0, "collapse_time_s": None}  # fmt: skip


def row(outcome: str, **changes) -> dict:
    fell = outcome == "collapsed"
    return {
        **ROW,
        "outcome": outcome,
        "collapsed": fell,
        "decided": True,
        "collapse_time_s": 1.0 if fell else None,
    } | changes


def population(*rows: dict) -> Population:
    return Population(Twins([COLUMN] * len(rows), st.Scatter(), 0, ()), rows)


def test_a_run_that_is_no_example_of_its_twins_says_so():
    """It stands where most of them fall, falls where most stand, or moves as none of those that stand."""
    mostly = population(*[row("collapsed")] * 11, *[row("rocked")] * 4)
    sentence = (
        "That this one stands does not make it safe, as most like it collapse: 11 of 16, this one and 15 like it, "
    )
    sentence += "collapse (95 %: 44 to 86 %); 5 stand."
    assert mostly.beside(row("rocked")) == sentence
    open_ = mostly.beside(row("rocked", decided=False))
    assert "this one has not fallen yet" in open_
    assert open_.endswith("(95 %: 44 to 90 %); 4 stand and 1 is undecided.")
    assert mostly.beside(row("collapsed")) == mostly.beside(row("failed", decided=False)) == ""
    assert mostly.summary(row("rocked"))["certainty"]["beside"] == sentence
    seldom = population(*[row("rocked")] * 14, row("rocked", decided=False))
    assert seldom.sentence.endswith("; 14 stand and 1 is undecided.")
    advised = dataclasses.replace(seldom, to_decide=to_decide(COLUMN, {}, 5.0))
    assert advised.sentence.endswith("is undecided: go on with a tail of 10 s.")
    fell = seldom.beside(row("collapsed"))
    assert "not the single run" not in fell
    assert fell == (
        "That others stand does not make this one safe, which falls and is one of them: 1 of 16, this one and 15 like it, "
        "collapses (95 %: 1 to 36 %); 14 stand and 1 is undecided."
    )
    assert seldom.probability == 0.0  # of the twins alone
    moved = [row("rocked", peak_top_displacement_m=peak) for peak in np.linspace(0.1, 0.2, 15)]
    spread = population(*moved)
    assert spread.beside(row("rocked", peak_top_displacement_m=-0.15)) == ""
    assert "less than that of any column like it that stands (100 to 200 mm)" in spread.beside(
        row("rocked", peak_top_displacement_m=0.05)
    )
    assert " more than " in spread.beside(row("rocked", peak_top_displacement_m=0.25))
    assert population(*moved[:7]).beside(row("rocked", peak_top_displacement_m=0.25)) == ""  # too few to tell


@pytest.mark.parametrize(
    "model", [st.DistinctElement2D(), st.RigidBlock(), st.DistinctElement3D()], ids=lambda model: model.name
)
@pytest.mark.parametrize("amplitude", [0.35, 0.9])
def test_the_column_itself_does_not_change_to_the_bit(model, amplitude):
    # both a column that stands beside some that fall, and one that falls first
    motion = st.sine_pulse(frequency=0.9, amplitude=amplitude * st.g, duration=2.5)
    alone = st.simulate(COLUMN, motion, model, until_decided=True)
    beside = st.certainty(COLUMN, motion, model).response
    assert alone.measures == beside.measures
    for history, other in (
        (alone.time, beside.time),
        (alone.body_position, beside.body_position),
        (alone.slip, beside.slip),
    ):
        assert np.array_equal(history, other)
    assert alone.provenance == beside.provenance


@pytest.mark.parametrize("model", [st.DistinctElement2D(), st.DistinctElement3D()], ids=lambda model: model.name)
def test_twins_that_ride_along_are_those_of_a_batch_to_the_bit(model):
    motion = st.sine_pulse(frequency=0.9, amplitude=0.5 * st.g, duration=2.0)
    ridden = st.certainty(COLUMN, motion, model, replicates=18, seed=3, scatter=st.Scatter()).population  # of one law
    twins = the_twins(COLUMN, model, st.Campaign(replicates=18, seed=3), laws=False).columns
    options = RunOptions(until_decided=True)
    again = batch([Case(twin, motion) for twin in twins], COLUMN, model, st.Campaign(threads=2), options)
    assert [str(row) for row in ridden.rows] == [str(row) for row in again]
    assert len({row["peak_top_displacement_m"] for row in ridden.rows}) == 18


def test_the_same_seed_gives_the_same_twins_of_any_number():
    few, many = (twins_of(COLUMN, st.Scatter(), number, seed=5) for number in (3, 9))
    assert [twin.digest for twin in few] == [twin.digest for twin in many[:3]]
    assert few[0].digest != twins_of(COLUMN, st.Scatter(), 1, seed=6)[0].digest
    still = twins_of(COLUMN, dataclasses.replace(st.Scatter(), friction=0.0), 1, seed=5)[0]
    assert still.joints[0].tan_phi == COLUMN.joints[0].tan_phi
    assert still.drums == few[0].drums


def test_the_scatter_is_that_declared():
    # 400 columns: standard errors of a coefficient of variation are 1/√(2·400) = 3.5 % of it, bounds at four of these; the
    # cut at 2.5 standard deviations takes 4 % off the spread
    twins = twins_of(COLUMN, st.Scatter(), 400, seed=0)
    friction = np.array([[joint.tan_phi for joint in twin.joints] for twin in twins]) / COLUMN.joints[0].tan_phi
    assert np.std(friction[:, 0]) == pytest.approx(0.1, rel=0.18)
    assert np.corrcoef(friction[:, 0], friction[:, 2])[0, 1] == pytest.approx(0.5, abs=0.2)
    offset = np.array([twin.as_found.of(2).offset for twin in twins]) / COLUMN.joint_widths[1]
    assert np.std(offset) == pytest.approx(0.003, rel=0.18)
    assert all(twin.as_found.in_plane for twin in twins)
    assert not all(twin.as_found.in_plane for twin in twins_of(COLUMN, st.Scatter(), 2, seed=0, space=True))


def test_undecided_and_failed_twins_are_counted_as_neither():
    twins = population(row("collapsed"), row("rocked"), row("rocked", decided=False), row("failed"))
    assert twins.probability == pytest.approx(1 / 3)
    low, high = twins.interval
    # Wilson's limits for 1 of 3 and for 2 of 3
    assert (low, high) == pytest.approx((0.0615, 0.9385), abs=1e-3)
    assert twins.sentence.startswith(
        "Collapses in 1 of 3 columns like this (95 %: 6 to 94 %); 1 stands and 1 is undecided"
    )
    assert twins.sentence.endswith("1 more failed.")
    assert (twins.worst, twins.median) == (0, 2)
    nothing = population(row("failed"))
    assert np.isnan(nothing.probability)
    assert nothing.summary()["certainty"]["median_twin"] is None


def test_the_interval_of_the_issue():
    # 15 of 30 collapses: Wilson's 95 % interval is 33 to 67 %
    twins = population(*[row("collapsed")] * 15, *[row("rocked")] * 15)
    assert "15 of 30 columns like this (95 %: 33 to 67 %)" in twins.sentence


def test_a_model_of_columns_as_built_leaves_the_offsets_out_and_says_so():
    result = st.certainty(
        COLUMN, st.sine_pulse(frequency=0.9, amplitude=2.0, duration=1.2), st.RigidBlock(), replicates=2
    )
    assert result.population.drawn.left_out == ("offset",)
    assert result.population.drawn.scatter.offset == 0.0


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"replicates": 0}, "allowed is a whole number from 1"),
        ({"seed": -1}, "seed"),
        ({"scatter": st.Scatter(*[0.0] * 6)}, "scatters"),
    ],
)  # fmt: skip
def test_what_makes_no_population_is_refused(changes, message):
    with pytest.raises(st.InputError, match=message):
        st.certainty(
            COLUMN, st.sine_pulse(frequency=0.9, amplitude=2.0, duration=1.2), st.DistinctElement2D(), **changes
        )
