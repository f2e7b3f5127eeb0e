"""Incremental dynamic analysis: levels that tell something, curves with plateaus, and which intensity tells most."""

import dataclasses
import math
import warnings

import numpy as np
import pandas
import pytest

import stylobate as st
from stylobate.errors import InputError, OutOfRangeWarning
from stylobate.motion import half_sine_pulse
from stylobate.motion.intensity import parse_levels, parse_measure
from stylobate.probability.evidence import evidence, intervals, median_of
from stylobate.probability.fragility import fragility
from stylobate.probability.ida import CLOSE, ida, next_levels, which_tells_most
from stylobate.probability.states import doubt
from stylobate.response.words import UNDAMPED_WOBBLE, round_in_the_plane
from stylobate.verdicts import verdict as v
from stylobate.verdicts.rocking_spectrum import rocking_block
from stylobate.verdicts.verdict import caveat

BLOCK = rocking_block(2.0, 0.2)


def hunted(capacity, runs=14, first=0.3, largest=20.0, stands=lambda _: False, open_=lambda _: False):
    """Levels and verdicts of a hunt under a record that collapses the column from ``capacity`` on."""
    levels, verdicts = [], []
    while new := next_levels(levels, verdicts, first, largest, runs - len(levels)):
        assert not set(new) & set(levels)
        levels += new
        verdicts += [
            v.UNDECIDED if open_(x) else v.COLLAPSED if x >= capacity and not stands(x) else v.STANDS for x in new
        ]
    return np.array(levels), np.array(verdicts)


@pytest.mark.parametrize("capacity", [0.31, 0.5, 1.0, 3.7, 11.0, 19.9])
def test_the_hunt_brackets_the_capacity(capacity):
    levels, verdicts = hunted(capacity)
    assert len(levels) == 14
    low, high = levels[verdicts == v.STANDS].max(), levels[verdicts == v.COLLAPSED].min()
    assert low < capacity <= high
    assert high / low < 1.1
    assert levels.min() >= 0.29 * min(1.0, capacity / 0.31)


def test_the_hunt_ends():
    levels, verdicts = hunted(math.inf, runs=30)
    assert (verdicts == v.STANDS).all()
    assert levels.max() == pytest.approx(20.0)
    assert len(levels) == 30
    assert np.diff(np.sort(levels)).min() > 0.0
    levels, _ = hunted(1.0, runs=500)  # nothing tells more at last
    assert len(levels) < 500
    assert np.exp(np.diff(np.log(np.sort(levels)))).min() > 1.0 + 0.2 * (CLOSE - 1.0)
    levels, verdicts = hunted(1.0, open_=lambda _: True)
    assert len(levels) <= 14
    assert len(hunted(0.001)[0]) <= 14  # it collapses where the hunt begins


def test_resurrections_are_looked_for_above_the_first_collapse():
    levels, verdicts = hunted(1.0, runs=20, stands=lambda x: 1.3 < x < 1.6)
    assert ((levels > 1.3) & (levels < 1.6) & (verdicts == v.STANDS)).any()


@pytest.fixture(scope="module")
def pulses():
    return [
        half_sine_pulse(f, 0.3 * st.g, 12.0).replace(name=f"{f} Hz", metadata={"format": "made for this test"})
        for f in (0.5, 0.8, 1.2, 1.8, 2.5)
    ]


@pytest.fixture(scope="module")
def analysis(pulses):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OutOfRangeWarning)
        return ida(BLOCK, pulses, st.HousnerBlock(), "pga", runs=12, about={"0.5 Hz": {"magnitude": 6.0}}, threads=1)


def test_capacities_are_those_of_a_fine_grid(analysis, pulses):
    # Every capacity lies in its bracket: just above its upper end, of a run at the ends themselves, by the model.
    table = analysis.capacities
    assert len(table) == 5
    assert (table["runs"] == 12).all()
    for row, pulse in zip(table.to_dict("records"), pulses):
        ends = np.array([row["stands_until"], row["collapses_from"]])
        runs = st.simulate_many(BLOCK, [pulse.scaled_to_pga(a * st.g) for a in ends], st.HousnerBlock(), threads=1)
        assert runs["collapsed"].tolist() == [False, True]
        assert ends[1] / ends[0] < 1.1
    assert (np.diff(table["collapses_from"].astype(float)) > 0.0).all()  # the shorter a pulse, the more it takes


def test_fractiles_count_a_collapse_as_larger_than_anything(analysis):
    table = analysis.fractiles()
    for share in (16, 50, 84):
        edp = table[f"edp_{share}"].to_numpy()
        known = edp[~np.isnan(edp)]
        assert np.isinf(known[-1])
        assert (np.diff(np.where(np.isinf(known), 1e9, known)) > -1e-3).all()
    # where three of five have collapsed, the median is a collapse
    fell = np.sort(analysis.capacities["collapses_from"].astype(float))
    beyond = table["im"] > fell[2]
    assert np.isinf(table.loc[beyond, "edp_50"].dropna()).all()
    assert analysis.summary()["capacity_50"] == pytest.approx(fell[2])


def test_what_is_undecided_or_failed_tells_of_no_response(analysis):
    """It was drawn as the response of the last run that stands, and as none at all where no run stands."""
    runs = analysis.runs.copy()
    for name, verdict in (("0.5 Hz", v.UNDECIDED), ("0.8 Hz", v.FAILED)):
        runs.loc[(runs["record"] == name) & (runs["verdict"] == v.COLLAPSED), "verdict"] = verdict
    runs.loc[(runs["record"] == "1.2 Hz") & (runs["verdict"] == v.STANDS), "verdict"] = v.UNDECIDED
    for curve in dataclasses.replace(analysis, runs=runs).curves():
        stood = curve.im[curve.im < curve.collapses].max(initial=0.0)
        responses = curve.at(np.linspace(0.01, 1.2, 50) * (stood or curve.collapses))
        beyond = ~np.isfinite(responses)
        assert beyond.any()
        assert np.isnan(responses[beyond]).any() == (curve.record in ("0.5 Hz", "0.8 Hz", "1.2 Hz"))
        assert (responses[~beyond] > 0.0).any() or not stood


def test_a_median_that_no_level_brackets_is_a_bound(analysis):
    assert analysis.summary()["bounds"] == {}
    low, high = (
        analysis.capacities[name].astype(float).sort_values().iloc[2] for name in ("stands_until", "collapses_from")
    )
    assert (
        median_of(analysis.summary()) == f"half of the curves have collapsed between pga = {low:.3g} and {high:.3g} g"
    )
    below = dataclasses.replace(
        analysis, runs=analysis.runs[analysis.runs["level"] <= low]
    )  # the third has not fallen yet
    low = below.capacities["stands_until"].sort_values().iloc[2]
    assert below.summary()["bounds"]["capacity_50"] == f"> {low:.4g}"
    assert median_of(below.summary()) == (
        f"fewer than half of the curves collapse up to pga = {low:.3g} g, and the median lies above"
    )
    fell = dataclasses.replace(analysis, runs=analysis.runs[analysis.runs["verdict"] == v.COLLAPSED])
    assert fell.summary()["bounds"]["capacity_50"] == f"≤ {high:.4g}"
    assert "or below: no lower level was stood" in median_of(fell.summary())


def test_scaled_measures_follow_the_factor(analysis):
    rows = analysis.runs[analysis.runs["record"] == "0.5 Hz"]
    for name in ("pga", "pgv", "arias", "d5_95", "pga_over_g_tan_alpha"):
        measure = parse_measure(name)
        values = rows[measure.key] / rows["factor"] ** measure.power
        assert np.ptp(values) == pytest.approx(0.0, abs=1e-9 * values.max())
    assert rows["pga_g"].to_numpy() == pytest.approx(rows["level"])


def test_the_velocity_tells_more_than_the_acceleration_of_pulses(analysis):
    # Overturning by short pulses hangs on their velocity: β of PGV must be the smaller one.
    table = which_tells_most(analysis.runs).set_index("measure")
    assert table.loc["pgv", "beta"] < 0.5 * table.loc["pga", "beta"]
    assert table.loc["pga", "beta"] == pytest.approx(table.loc["pga_over_g_tan_alpha", "beta"], rel=1e-6)
    assert table.loc["pga", "p_d5_95_s"] < 0.05  # given PGA, the length of the pulse still matters
    assert math.isnan(table.loc["pga", "p_magnitude"])  # of one record it is known


def test_runs_that_stand_at_one_level_show_no_dispersion_over_it(analysis):
    """A straight line through one intensity has no slope; of 1 g the logarithm is nothing, on which the fit broke down."""
    for level in (1.0, 2.0):
        runs, stand = analysis.runs.copy(), analysis.runs["verdict"] == v.STANDS
        lowest = runs.loc[stand, "pga_g"].min()
        runs.loc[stand, "pga_g"] = lowest
        runs["pga_g"] *= level / lowest
        table = which_tells_most(runs).set_index("measure")
        assert math.isnan(table.loc["pga", "sigma_ln_edp"])
        assert table.loc["pgv", "sigma_ln_edp"] > 0.0


def test_an_ida_is_evidence_in_any_of_its_measures(analysis):
    observations = evidence(analysis.runs, "pgv")
    assert observations.brackets
    assert len(observations.im) == len(analysis.runs)


def test_stripes(pulses):
    levels = parse_levels("0.2g:0.6g:3", parse_measure("pga"))
    assert levels == pytest.approx([0.2, 0.4, 0.6])
    stripes = ida(BLOCK, pulses[:2], st.HousnerBlock(), "pga", levels=levels, threads=1)
    assert sorted(stripes.runs["level"].unique()) == pytest.approx([0.2, 0.4, 0.6])
    assert len(stripes.runs) == 6
    assert not evidence(stripes.runs, "pga").brackets


def test_what_cannot_be_scaled_or_is_not_there(pulses):
    for im, why in (
        ("pgv_over_pga", "does not change"),
        ("pgv@y", "second horizontal"),
        ("nonsense", "not known"),
        ("sa:-1s", "negative"),
    ):
        with pytest.raises(InputError, match=why):
            ida(BLOCK, pulses, st.HousnerBlock(), im)
    with pytest.raises(InputError, match="no record"):
        ida(BLOCK, [], st.HousnerBlock())
    with pytest.raises(InputError, match="same name"):
        ida(BLOCK, [pulses[0], pulses[0]], st.HousnerBlock())
    with pytest.raises(InputError, match="without shaking"):
        ida(BLOCK, [st.Motion(0.01, np.zeros(100))], st.HousnerBlock())
    with pytest.warns(OutOfRangeWarning, match="multiplied by more than 10"):
        ida(BLOCK, [pulses[0].scaled(0.07)], st.HousnerBlock(), "pga", levels=[0.3], threads=1)
    with pytest.raises(
        InputError, match=r"the level pga = 300 g multiplies '0.5 Hz', of 0.3 g, by 1000; allowed is up to 20"
    ):
        ida(BLOCK, pulses[:1], st.HousnerBlock(), "pga", levels=[0.3, 300.0])


def test_measures_by_name():
    motion = st.Motion(0.01, np.sin(np.arange(500) * 0.05), 0.5 * np.cos(np.arange(500) * 0.05))
    x, y = (parse_measure(f"pga@{axis}").of(motion) for axis in "xy")
    assert parse_measure("pga@geomean").of(motion) == pytest.approx(math.sqrt(x * y))
    assert parse_measure("pga@larger").of(motion) == max(x, y)
    assert parse_measure("pga@rotd100").of(motion) == pytest.approx(x, rel=1e-3)
    assert parse_measure("pga@rotd50").of(motion) < x
    assert parse_measure("avgsa").of(motion) > 0.0
    # the average over nearly one period is Sa there
    assert parse_measure("avgsa:1s-1.0001s").of(motion) == pytest.approx(parse_measure("sa:1s").of(motion), rel=1e-3)
    for name in ("pgv", "sa:1s", "avgsa:0.5s-3s", "pga@geomean", "arias@larger"):
        assert parse_measure(name).name == name
    for wrong in ("sa", "sa:1s-2s", "pgv:1s", "pga@north", "cav@rotd50", "avgsa:3s-1s", "sa:0s", ""):
        with pytest.raises(InputError, match=r"intensity measure|rotd50"):
            parse_measure(wrong)
    with pytest.raises(InputError, match="a column"):
        parse_measure("omega_g_over_p").of(motion)
    for wrong in ("0.3", "0.3m/s", "-1g", "x"):
        with pytest.raises(InputError, match="level"):
            parse_levels(wrong, parse_measure("pga"))


def test_an_undecided_run_below_the_first_collapse_widens_the_capacity(analysis):
    rows = pandas.DataFrame({"record": "a", "motion": "a", "realisation": 0, "level": [0.1, 0.2, 0.3, 0.4], "edp": 0.0})
    rows["verdict"] = [v.STANDS, v.UNDECIDED, v.STANDS, v.COLLAPSED]
    four_runs = dataclasses.replace(analysis, runs=rows.rename(columns={"edp": "peak_top_displacement_m"}))
    (capacity,) = four_runs.capacities.to_dict("records")
    assert (capacity["stands_until"], capacity["collapses_from"], capacity["open"]) == (0.1, 0.4, 1)
    fewer = dataclasses.replace(analysis, runs=four_runs.runs[:3])
    assert fewer.capacities["stands_until"].tolist() == [0.1]


def test_components_and_twins_of_a_record_have_capacities_of_their_own_and_count_once():
    """Of two components of each record one falls at half of what the other takes; the median lies between the two."""
    levels, names = [1.0, 2.0, 4.0, 8.0, 16.0], [f"r{k}" for k in range(10)]
    rows = [
        {"record": name, "motion": f"{name} {part}", "realisation": 0, "im": x, "hunted": True,
         "verdict": v.COLLAPSED if x >= falls * (1 + k % 2) else v.STANDS}
        for k, name in enumerate(names) for part, falls in (("first", 2.0), ("second", 4.0)) for x in levels
    ]  # fmt: skip
    observations = evidence(pandas.DataFrame(rows))
    low, high, owner = intervals(observations, observations.codes, "records")
    assert len(low) == 20
    assert np.exp(high[:4]).tolist() == pytest.approx([2.0, 4.0, 4.0, 8.0])
    assert np.bincount(owner).tolist() == [2] * 10
    curve = fragility(observations, samples=50)
    assert curve.records == 10
    assert curve.points.records.tolist() == [10, 10, 10]
    assert curve.points.share == pytest.approx([0.25, 0.75, 1.0])  # of ten records, not of twenty curves
    pulse = half_sine_pulse(1.0, 0.3 * st.g, 2.0).replace(
        name="a first component", metadata={"direction": {"record": "a"}}
    )
    table = ida(BLOCK, [pulse], st.HousnerBlock(), "pga", levels=[0.1], about={"a": {"magnitude": 6.0}}, threads=1).runs
    assert table[["record", "motion", "magnitude"]].to_numpy().tolist() == [["a", "a first component", 6.0]]


def test_an_ida_is_evidence_and_makes_a_fragility_as_it_is(analysis):
    direct_evidence, other = evidence(analysis), evidence(analysis.runs, im="pga")
    assert (direct_evidence.measure, direct_evidence.unit, direct_evidence.codes.tolist()) == (
        "pga",
        "g",
        other.codes.tolist(),
    )
    assert evidence(analysis, "pgv").unit == "m/s"
    with pytest.raises(InputError, match="given twice, as measure and as im"):
        evidence(analysis, "pga", im="pga")
    with pytest.raises(InputError, match="a fragility of 5 records"):
        fragility(analysis)
    with pytest.raises(InputError, match="the table of runs is empty"):
        evidence(analysis.runs[:0])


def test_what_a_plane_leaves_out_of_round_drums_goes_with_the_runs():
    """Under one component nothing said so but one entry of one summary."""
    drums = [st.Drum(1.0, 0.6, 0.6, 2500.0, section="circular")] * 2
    column = st.Column.of_drums(drums, st.Joint(1e9, 5e8, 35.0))
    motions = [st.ricker(1.0 + 0.1 * k, 2.0) for k in range(10)]
    words, model = round_in_the_plane(column), st.DistinctElement2D()
    analysis = ida(column, motions, model, "pga", levels=[0.1, 1.5], threads=1)
    assert analysis.summary()["doubt"] == words
    assert evidence(analysis).doubt == evidence(analysis.runs, "pga").doubt == words
    assert fragility(analysis, samples=40).warnings[0] == words
    assert evidence(st.suite_table(column, motions[:1], model), "pga").doubt == words
    compared = st.compare_states({"as built": column, "same": column}, motions, model, [0.1, 1.5], "pga", samples=40)
    assert compared.curves[0].warnings[0] == words
    sure = st.certainty(column, motions[0].scaled(1.7), model, replicates=1)
    assert sure.sentence.endswith(words)
    for text in (repr(sure.response), sure.response.describe()):
        assert text.count(words) == 1


@pytest.mark.parametrize(
    ("about", "says"),
    [
        ({"b": {"magnitude": 6.0}}, r"`about` names 'b', which is no record here; records are a: leave out"),
        (
            {"a": {"magnitud": 6.0}},
            r"a fact about 'a' is 'magnitud'; did you mean magnitude\? allowed are magnitude, dist",
        ),
        ({"a": {"magnitude": "six"}}, r"magnitude of 'a' is 'six'; allowed is a number"),
        ({"a": 6.0}, r"'a' of about is 6.0; allowed is a mapping"),
    ],
)
def test_facts_that_nobody_asks_for_are_refused(about, says):
    pulse = half_sine_pulse(1.0, 0.3 * st.g, 3.0).replace(name="a")
    with pytest.raises(InputError, match=says):
        ida(BLOCK, [pulse], st.HousnerBlock(), "pga", levels=[0.1], about=about)


def test_what_nothing_damps_in_space_goes_with_the_runs():
    """A single run alone said so."""
    drums = [st.Drum(1.0, 0.6, 0.6, 2500.0, section="circular")] * 2
    column = st.Column.of_drums(drums, st.Joint(1e9, 5e8, 35.0))
    assert caveat([column], st.DistinctElement3D()) == UNDAMPED_WOBBLE
    assert doubt(["as built"], [column], st.DistinctElement3D()) == UNDAMPED_WOBBLE
    for model in (st.DistinctElement3D(stiffness_damping=1e-4), st.DistinctElement3D(planar=True)):
        assert UNDAMPED_WOBBLE not in (caveat([column], model), doubt(["as built"], [column], model))
