"""Twins whose joints' law varies: how laws are drawn, what the interval holds then, and how often it holds the truth."""

import dataclasses

import numpy as np
import pandas as pd
import pytest

import stylobate as st
from stylobate.campaign.campaign import Campaign
from stylobate.campaign.twins import LAW, PER_LAW, the_twins, usual_with_laws
from stylobate.verdicts import verdict as v
from stylobate.verdicts.population import Population, certainty, chance_words
from stylobate.verdicts.verdict import share_limits, share_under_another_law, under_another_law

JOINT = st.Joint(5e10, 2.5e10, friction_coefficient=0.7)
SIZE = {"height": 2.0, "bottom_width": 0.5, "top_width": 0.5, "density": 2700.0}
ROUND = st.Column.tapered(**SIZE, drums=1, joint=JOINT, section="circular", name="round")
SQUARE = st.Column.tapered(**SIZE, depth=0.5, drums=1, joint=JOINT, name="square")
SPACE = st.DistinctElement3D()


def drawn(number: int, column=ROUND, model=SPACE, seed: int = 0, **sizes):
    scatter = dataclasses.replace(usual_with_laws(column, st.DistinctElement3D()), **sizes)
    return the_twins(column, model, Campaign(replicates=number, scatter=scatter, seed=seed))


def test_half_of_the_variance_is_common_to_the_twins_of_a_law():
    """ln β has the standard deviation of a coefficient of variation of 0.8, √ln 1.64 = 0.703, and half of its variance
    between laws: correlation 0.5 of twins of one law. 600 laws: standard errors 0.015 and 0.04, less where spread evenly.
    """
    beta = np.array([twin.losses.stiffness_damping for twin in drawn(3 * 600).columns])
    logs = np.log(beta).reshape(-1, PER_LAW)
    assert np.exp(np.median(logs)) == pytest.approx(3e-4, rel=0.05)
    assert logs.std() == pytest.approx(0.703, abs=0.04)
    assert np.corrcoef(logs[:, 0], logs[:, 1])[0, 1] == pytest.approx(0.5, abs=0.1)


def test_laws_reach_from_the_softest_joints_to_stone():
    """Each order of magnitude from 1e9 N/m³ to E/h = 1e11/2 as likely, whatever the column's own; joints of a law differ by
    some 14 % more. At half of it the spread is half as wide."""

    def common(share: float) -> np.ndarray:
        twins = drawn(3 * 200, unknown_stiffness=share).columns
        return np.log([twin.joints[0].normal_stiffness for twin in twins]).reshape(-1, PER_LAW).mean(axis=1)

    logs = common(1.0)
    span = np.log(5e10 / 1e9)
    assert logs.min() == pytest.approx(np.log(1e9), abs=0.4)
    assert logs.max() == pytest.approx(np.log(5e10), abs=0.4)
    assert logs.mean() == pytest.approx(np.log(1e9) + 0.5 * span, abs=0.1)
    assert logs.std() == pytest.approx(span / np.sqrt(12.0), rel=0.03)
    assert common(0.5).std() == pytest.approx(0.5 * span / np.sqrt(12.0), rel=0.06)
    assert drawn(3, friction=0.0, joint_stiffness=0.0, unknown_stiffness=0.0).columns[0].joints == ROUND.joints


def test_half_of_the_laws_carry_otherwise_and_twins_of_one_law_alike():
    twins = drawn(120)
    laws = np.array([twin.losses.law for twin in twins.columns]).reshape(-1, PER_LAW)
    assert np.all(laws == laws[:, :1])
    assert np.mean(laws[:, 0] == "bed") == pytest.approx(0.5, abs=0.08)  # evenly spread: no more than some of 40 off
    assert len(set(twins.groups)) == 40


def test_more_twins_are_the_same_ones_and_more():
    few, many = drawn(10), drawn(40)
    assert tuple(many.columns[:10]) == tuple(few.columns)


def test_other_parts_stay_as_they_were():
    """Of one seed, sizes, density and friction are those drawn without laws; the common part of stiffness is the law's."""
    none = dict.fromkeys(("stiffness_damping", "rolling_resistance", "law", "unknown_stiffness"), 0.0)
    with_laws, without = drawn(6).columns, drawn(6, **none).columns
    for twin, other in zip(with_laws, without, strict=True):
        assert twin.drums == other.drums
        assert [joint.tan_phi for joint in twin.joints] == [joint.tan_phi for joint in other.joints]
        assert twin.joints != other.joints
        assert other.losses is None


def test_square_columns_have_no_law_of_round_faces_and_planes_none_at_all():
    assert usual_with_laws(SQUARE, st.DistinctElement3D()).given.keys() & {"law", "rolling_resistance"} == set()
    twins = drawn(3, SQUARE, law=0.5)
    assert twins.left_out == ("law",)
    plane = drawn(3, SQUARE, st.DistinctElement2D())
    assert set(plane.left_out) == {"stiffness_damping", "unknown_stiffness"}
    assert plane.groups == ()
    assert plane.columns[0].losses is None


def test_the_limits_are_those_of_a_new_law_by_weighted_draws():
    """Draws of (m, r) as before counting, weighted by what was counted, and a new p for each: quantiles to 0.02."""
    from scipy.stats import betabinom

    fell, number = np.array([3, 0, 1, 0, 2]), np.full(5, 3)
    stream = np.random.default_rng(0)
    m, r = stream.random(400_000), stream.beta(1.0, 4.0, 400_000)
    a, b = m * (1.0 - r) / r, (1.0 - m) * (1.0 - r) / r
    weight = np.exp(sum(betabinom.logpmf(k, n, a, b) for k, n in zip(fell, number, strict=True)))
    p = stream.beta(a, b)
    order = np.argsort(p)
    share = np.cumsum(weight[order]) / weight.sum()
    expected = [float(p[order][np.searchsorted(share, quantile)]) for quantile in (0.025, 0.975)]
    assert share_under_another_law(fell, number) == pytest.approx(expected, abs=0.02)


def test_laws_that_agree_leave_little_doubt_and_laws_that_differ_much():
    """Thirty laws of thirty columns of which half fall: within 0.15 of it. Laws of which all or none fall: everything."""
    low, high = share_under_another_law([15] * 30, [30] * 30)
    assert 0.35 < low < 0.5 < high < 0.65
    low, high = share_under_another_law([3, 0] * 5, [3] * 10)
    assert low < 0.02
    assert high > 0.98


def test_the_interval_holds_the_share_of_another_law_where_that_of_the_columns_does_not():
    """200 cases of ten laws of three columns; shares of laws from beta distributions of correlation 0.05 to 0.5 and mean 0.1
    to 0.9, the truth an eleventh. At least 0.9 are held; Wilson's interval of 30 columns holds fewer than 0.7.
    """
    stream, hits = np.random.default_rng(3), np.zeros(2)
    for _ in range(200):
        r, m = stream.uniform(0.05, 0.5), stream.uniform(0.1, 0.9)
        p = stream.beta(m * (1.0 - r) / r, (1.0 - m) * (1.0 - r) / r, 11)
        fell = stream.binomial(3, p[:10])
        limits = share_under_another_law(fell, [3] * 10), v.wilson_interval(fell.sum(), 30)
        hits += [float(low) <= p[10] <= float(high) for low, high in limits]
    assert hits[0] >= 180
    assert hits[1] < 140


def test_the_sentence_says_which_part_is_the_laws():
    certainty_section = pytest.importorskip("stylobate_report.certainty").certainty_section
    certainty_sentence = pytest.importorskip("stylobate_report.certainty").certainty_sentence
    twins = drawn(6)
    peak = {
        "peak_top_displacement_m": 0.1,
        "residual_top_displacement_m": 0.0,
        "peak_rotation_rad": 0.1,
        "residual_joint_slip_m": 0.0,
    }
    rows = [
        {
            **peak,
            "outcome": "collapsed" if fell else "rocked",
            "collapsed": fell,
            "decided": True,
            "collapse_time_s": 1.0,
        }
        for fell in (True, True, True, False, False, False)
    ]
    population = Population(twins, tuple(rows))
    column, both = population.interval_of_columns, population.interval
    assert both[0] < column[0] < column[1] < both[1]
    assert "by the column alone, the rest by the law of its joints" in population.sentence
    summary = population.summary()
    assert summary["certainty"]["laws"] == 2
    assert (summary["collapse_interval_low"], summary["collapse_interval_high"]) == both
    assert summary["certainty"]["interval_of_columns"] == list(column)
    assert "if the law of its joints were known)" in certainty_sentence(summary)
    assert certainty_section(summary) is not None


def test_the_run_itself_is_the_same_whatever_its_twins_lose():
    """No twin of another law rides along, so that the column's run keeps its bits."""
    shaking = st.harmonic(2.0, 0.4 * st.g, 1.0)
    alone = st.simulate(ROUND, shaking, SPACE)
    result = certainty(ROUND, shaking, SPACE, replicates=4)
    assert np.array_equal(alone.histories.top, result.response.histories.top)
    assert result.population.drawn.groups == (0, 0, 0, 1)
    assert result.population.counts[v.FAILED] == 0


def test_limits_over_many_cells_are_those_of_each():
    """Share by share as :func:`share_under_another_law` gives them, wider than Wilson's; without laws these alone."""
    verdicts = np.array([["collapsed"] * 6 + ["stands"] * 6, ["stands"] * 11 + ["undecided"], ["failed"] * 12])
    groups = tuple(k // 3 for k in range(12))
    low, high = share_limits(verdicts, groups)
    alone = share_limits(verdicts, ())
    assert (low[0], high[0]) == share_under_another_law([3, 3, 0, 0], [3] * 4)
    assert high[1] == share_under_another_law([0, 0, 0, 1], [3] * 4)[1]
    assert (low[2], high[2]) == (0.0, 1.0)
    assert np.all(low <= alone[0])
    assert np.all(high >= alone[1])
    assert alone[1][0] == pytest.approx(0.746, abs=1e-3)  # Wilson's limit of 6 of 12


@pytest.mark.parametrize("ask", ["suite", "critical", "domain"])
def test_every_interval_of_columns_in_space_holds_their_laws(ask):
    """What is not known of joints varies by default wherever columns like one are asked for, unless it is said what does."""
    column, model, motion = ROUND, SPACE, st.ricker(1.5, 0.01 * st.g)
    friction = {"scatter": st.Scatter(friction=0.1)}

    def limits(**fields):
        if ask == "suite":
            table = st.suite_table(column, [motion], model, replicates=6, **fields)
            known = "collapse_interval_of_columns_low" in table
            return known, table.attrs["twins"][column.name]["scatter"]["law"], table["collapse_interval_high"][0]
        if ask == "critical":
            result = st.critical_amplitude(
                column, motion, model, 0.01 * st.g, 0.02 * st.g, 0.01 * st.g, replicates=6, **fields
            )
            result = result.population
            return bool(result.drawn.groups), result.drawn.scatter.law, result.interval[1][0]
        result = st.collapse_probability(column, model, [1.5], [0.01 * st.g], 1.0, replicates=6, **fields)
        return bool(result.scatter.law), result.scatter.law, result.interval[1][0, 0]

    vary, law, high = limits()
    assert (vary, law) == (True, 0.5)
    alone, none, narrow = limits(**friction)
    assert (alone, none) == (False, 0.0)
    assert high >= narrow


def capacities(rng: np.random.Generator, laws: int, between: float) -> pd.DataFrame:
    """Runs of 12 records at six levels on three twins of each law; one more law, the truth, is that with the median 1.

    ln capacities vary by 0.4 between records, 0.15 between columns, and ``between`` among laws.
    """
    levels, law = np.geomspace(0.25, 4.0, 6), rng.normal(0.0, between, laws + 1)
    of_law = np.repeat(law[:-1] - law[-1], PER_LAW) + rng.normal(0.0, 0.15, laws * PER_LAW)
    log = rng.normal(0.0, 0.4, (12, 1)) + of_law + rng.normal(0.0, 0.1, (12, laws * PER_LAW))
    record, twin, level = np.meshgrid(*map(np.arange, (*log.shape, len(levels))), indexing="ij")
    fell = np.log(levels)[level] >= log[record, twin]
    table = {"record": record, "im": levels[level], "collapsed": fell.astype(int), "realisation": twin}
    return pd.DataFrame({name: values.ravel() for name, values in (table | {LAW: twin // PER_LAW + 1}).items()})


def test_median_of_a_fragility_holds_that_of_another_law():
    """Of 40 synthetic truths the 95 % interval holds 38 ± 4 (three standard errors); that of known laws fewer, where laws
    differ nearly as much as records do."""
    hits = alone = 0
    for seed in range(40):
        runs = capacities(np.random.default_rng([seed, 5]), 5, 0.3)
        summary = st.fragility(st.evidence(runs), samples=40, seed=seed).summary()
        hits += summary["median_low"] <= 1.0 <= summary["median_high"]
        alone += summary["median_of_columns_low"] <= 1.0 <= summary["median_of_columns_high"]
    assert hits >= 34
    assert alone < 30


def test_what_one_more_law_comes_to():
    """Student's interval of one more value: mean ± t s √(1 + 1/G), here 3.182 · 1.291 · 1.118 = 4.593 for 1, 2, 3, 4."""
    away = under_another_law(np.array([1.0, 2.0, 3.0, 4.0]), 200_000, np.random.default_rng(1))
    assert np.quantile(away, [0.025, 0.975]) == pytest.approx([-4.593, 4.593], rel=0.03)
    bound = under_another_law(np.array([1.0, 2.0, np.inf]), 1000, np.random.default_rng(1))
    assert np.isfinite(bound[bound < 0.0]).all()
    assert np.isposinf(bound[bound > 0.0]).all()
    assert np.isinf(under_another_law(np.array([1.0]), 10, np.random.default_rng(1))).all()


def test_too_few_laws_are_said_and_leave_no_limits():
    runs = capacities(np.random.default_rng(0), 1, 0.1)
    curve = st.fragility(st.evidence(runs), samples=60)
    assert curve.median_interval == (0.0, np.inf)
    assert any("too few to tell" in warning for warning in curve.warnings)
    assert np.isfinite(curve.of_columns.median_interval).all()


def test_analyses_over_records_draw_laws_and_say_which():
    """Runs of an IDA and of a study in space say of which law each is; in the plane none does."""
    motions = [st.harmonic(2.0, 1.0, 0.3).replace(name=name) for name in ("one", "other")]
    analysis = st.ida(ROUND, motions, SPACE, "pga", levels=[0.1], replicates=4, tail=0.1)
    assert analysis.runs[LAW].tolist() == [1, 1, 1, 2] * 2
    assert not analysis.doubt
    assert "Wobbling was not damped" in st.ida(ROUND, motions, SPACE, "pga", levels=[0.1], tail=0.1).doubt
    study = st.Study((ROUND,), motions, [SPACE, st.DistinctElement2D()], (0.1,), "pga", replicates=4, tail=0.1)
    assert study.plan().labels()[LAW].tolist() == [1, 1, 1, 2] * 2 + [0] * 8


def test_interval_of_a_table_is_that_of_its_twins():
    """The words of a row are those of the run: with another law of the joints, which holds more than Wilson's."""
    row = {"twins_collapsed": 2, "twins_stands": 13, "twins_undecided": 0, "twins_failed": 0}
    row |= {"collapse_interval_low": 0.01, "collapse_interval_high": 0.62}
    assert chance_words(row) == "13 % of 15 (1 to 62 %)"


def test_states_of_few_laws_say_so_and_conclude_nothing():
    """Three twins share one law: limits of a difference are those of all that can be, and the reason stands before."""
    motions = [st.harmonic(2.0, 1.0, 0.3).replace(name=f"m{k}") for k in range(2)]
    states = {"as found": ROUND, "other": dataclasses.replace(ROUND, name="other")}
    comparison = st.compare_states(states, motions, SPACE, [0.1], "pga", replicates=3, tail=0.1)
    assert comparison.doubt.startswith("The twins share 1 law of the joints")
    assert (comparison.differences[0].share_low, comparison.differences[0].share_high) == (-1.0, 1.0)
