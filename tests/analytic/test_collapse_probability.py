"""Probability of collapse: the confidence interval, the population of columns, and counts that never flatter."""

import dataclasses
import json

import numpy as np
import pytest

import stylobate as st
from stylobate.campaign import runs
from stylobate.column import preset
from stylobate.column.scatter import LARGEST, Scatter
from stylobate.models.engine import engine_for
from stylobate.motion.pulses import PHASES, MotionScatter, ScatteredSines
from stylobate.verdicts import verdict as v
from stylobate.verdicts.compare import compare_steps, halved_step
from stylobate.verdicts.domain import (
    SAFE,
    UNCERTAIN,
    UNKNOWN,
    UNSAFE,
    CollapseProbability,
    Domain,
    collapse_probability,
)
from stylobate.verdicts.population import certainty
from stylobate.verdicts.verdict import collapse_interval, share_collapsed, wilson_interval

CODES = {letter: v.VERDICTS.index(verdict) for letter, verdict in zip("SCUFN", v.VERDICTS)}
#: All of the scatter but width.
NOTHING = {name: 0.0 for name in LARGEST if name != "width"}
GRID = (np.array([0.5, 1.0]), np.linspace(0.15, 0.45, 4) * st.g, 6.0)


def probability(cells, amplitudes=(0.1, 0.2, 0.3, 0.4)):
    """One frequency per line, one word of verdicts per cell: S stands, C collapsed, U undecided, F failed, N not run."""
    codes = np.array([[[CODES[letter] for letter in cell] for cell in line.split()] for line in cells], dtype=np.int8)
    return CollapseProbability(
        preset("paper-monolithic"), "dem2d", np.arange(1.0, len(cells) + 1.0), np.array(amplitudes) * st.g, codes,
        np.zeros(codes.shape, np.float32), Scatter(), MotionScatter(), 0, 0.95, 1.0, {},
    )  # fmt: skip


def test_wilson_s_interval_solves_its_own_equation():
    k, n = np.array([1, 5, 9, 30]), np.array([10, 10, 10, 40])
    z2 = 1.959963984540054**2
    for p in wilson_interval(k, n, 0.95):
        np.testing.assert_allclose((k / n - p) ** 2, z2 * p * (1 - p) / n, rtol=1e-12)


def test_wilson_s_interval_at_its_ends():
    z2 = 1.959963984540054**2
    low, high = wilson_interval(np.array([0, 10, 0]), np.array([10, 10, 0]))
    np.testing.assert_allclose(low, [0.0, 10 / (10 + z2), 0.0])
    np.testing.assert_allclose(high, [z2 / (10 + z2), 1.0, 1.0])


def test_wilson_s_interval_covers_as_often_as_it_says():
    from math import comb

    n = 20
    low, high = wilson_interval(np.arange(n + 1), np.full(n + 1, n))
    coverage = []
    for p in np.linspace(0.02, 0.98, 97):
        weight = np.array([comb(n, k) * p**k * (1 - p) ** (n - k) for k in range(n + 1)])
        coverage.append(weight[(low <= p) & (p <= high)].sum())
    assert np.mean(coverage) == pytest.approx(0.95, abs=0.01)
    assert min(coverage) > 0.83


def test_kinds_of_cells_and_the_band():
    result = probability(["SSSS SSSC SCCC CCCC", "SSSS SSUS SUUU SSSS", "SSSS CSSS SSSS CCCS", "CCCF FFFF CCCC CCCC"])
    assert result.kinds.tolist() == [
        [SAFE, UNCERTAIN, UNCERTAIN, UNSAFE],
        [SAFE, UNKNOWN, UNKNOWN, SAFE],
        [SAFE, UNCERTAIN, SAFE, UNCERTAIN],
        [UNSAFE, UNKNOWN, UNSAFE, UNSAFE],
    ]
    low, high = (bound / st.g for bound in result.band)
    np.testing.assert_allclose(low, [0.2, np.nan, 0.2, 0.1])
    np.testing.assert_allclose(high, [0.3, 0.4, 0.4, np.nan])
    np.testing.assert_allclose(result.band_width / st.g, [0.2, np.nan, np.nan, 0.0], atol=1e-12)
    assert result.band_is_open.tolist() == [False, False, True, False]
    summary = result.summary()
    assert summary["band_width_median_g"] == pytest.approx(0.1)
    assert summary["band_open_frequencies"] == 1
    assert summary["all_stand"] + summary["some_collapse"] + summary["all_collapse"] + summary["no_verdict"] == 16


def test_what_is_undecided_or_failed_is_no_collapse_and_widens_the_interval():
    result = probability(["CSSS CSSU CSSF FFFF"])
    np.testing.assert_allclose(result.frequency[0], [0.25, 0.25, 1 / 3, np.nan])
    low, high = result.interval
    assert low[0, 1] == low[0, 0]
    assert high[0, 1] > high[0, 0]
    np.testing.assert_allclose([low[0, 2], high[0, 2]], np.ravel(wilson_interval([1], [3])))
    assert (low[0, 3], high[0, 3]) == (0.0, 1.0)
    assert result.summary()["collapsed"] == 3
    assert result.summary()["failed"] == 5
    assert result.table["undecided"].tolist() == [0, 1, 0, 0]


@pytest.mark.parametrize("field", ["amplitude", "phase", "across"])
def test_an_impossible_scatter_of_the_motion_is_refused(field):
    with pytest.raises(st.InputError, match=f"{field} of the motion's scatter is 1.05"):
        MotionScatter(**{field: 1.05})


def test_where_next_to_nothing_scatters_every_column_has_the_verdict_of_the_domain():
    column = preset("paper-monolithic")
    domain = st.collapse_domain(column, st.HousnerBlock(), *GRID)
    result = collapse_probability(
        column, st.HousnerBlock(), *GRID, replicates=3, scatter=Scatter(**NOTHING, width=1e-9)
    )
    names = np.array(v.VERDICTS, dtype=object)[result.codes]
    assert (names == domain.verdicts[..., None]).all()
    assert (result.summary()["some_collapse"], result.summary()["runs"]) == (0, 24)
    np.testing.assert_allclose(result.peaks[..., 0], domain.grid("peak_top_displacement_m"), rtol=1e-6)
    with pytest.raises(st.InputError, match="nothing scatters"):
        collapse_probability(column, st.HousnerBlock(), *GRID, replicates=3, scatter=Scatter(**NOTHING, width=0.0))


def test_a_cell_agrees_with_the_columns_like_this_one_of_a_run_of_its_motion():
    """One population; those beside a run take its step, so that single verdicts near the boundary are other ones."""
    column, model, number = preset("paper-12-drums"), st.DistinctElement2D(), 40
    result = collapse_probability(column, model, [0.8], [0.33 * st.g], 5.0, replicates=number, seed=2, tail=2.0)
    motion = st.harmonic(0.8, 0.33 * st.g, 5.0)
    paced = collapse_probability(
        column, engine_for(model, column).paced, [0.8], [0.33 * st.g], 5.0, replicates=number, seed=2, tail=2.0
    )
    beside = certainty(column, motion, model, replicates=number, seed=2, tail=2.0).population
    fell = np.array([bool(row["collapsed"]) for row in beside.rows])
    np.testing.assert_array_equal(paced.codes[0, 0] == CODES["C"], fell)
    assert result.scatter == beside.drawn.scatter
    low, high = wilson_interval(np.array([result.count("collapsed")[0, 0], fell.sum()]), np.full(2, number))
    assert 0.0 < low.max() <= high.min() < 1.0


def test_threads_and_seed_decide_nothing_but_what_they_should():
    column = preset("paper-monolithic")
    size = {"scatter": Scatter(width=0.05, height=0.05), "motion_scatter": MotionScatter(amplitude=0.05, phase=0.2)}
    runs = [
        collapse_probability(column, st.HousnerBlock(), *GRID, replicates=8, **size, seed=seed, threads=threads)
        for seed, threads in ((1, 1), (1, 2), (2, 1))
    ]
    np.testing.assert_array_equal(runs[0].peaks, runs[1].peaks)
    assert (runs[0].peaks != runs[2].peaks).any()
    assert np.unique(runs[0].peaks[0, 1]).size > 4


def test_phase_starts_the_sine_elsewhere_and_shares_its_samples():
    sines = ScatteredSines(GRID[0], 6.0, MotionScatter(phase=0.25), 40, 0)
    motions = [sines.motion(0, 1.0, k) for k in range(40)]
    starts = sorted({float(motion.samples[0]) for motion in motions})
    assert starts[0] == pytest.approx(-1.0)
    assert starts[-1] == pytest.approx(1.0)
    assert len({id(motion.samples) for motion in motions}) <= PHASES
    assert motions[0].duration == pytest.approx(6.0)


def test_an_interrupted_probability_goes_on_where_it_was(tmp_path, monkeypatch):
    column = preset("paper-monolithic")
    whole = collapse_probability(column, st.HousnerBlock(), *GRID, replicates=4)
    counts, real = [], runs.executor()

    def stopping(cases, *args, **kwargs):
        counts.append(len(cases))
        for n, item in enumerate(real(cases, *args, **kwargs)):
            if len(counts) == 1 and n == 9:
                raise KeyboardInterrupt
            yield item

    monkeypatch.setattr(runs, "executor", lambda: stopping)
    first = collapse_probability(column, st.HousnerBlock(), *GRID, replicates=4, out=tmp_path)
    assert not first.complete
    assert first.summary()["not_run"] == 23
    second = collapse_probability(column, st.HousnerBlock(), *GRID, replicates=4, out=tmp_path)
    assert counts == [32, 23]
    np.testing.assert_array_equal(second.peaks, whole.peaks)
    assert {path.name for path in tmp_path.iterdir()} == {"probability.nc", "probability.csv", "runs.sqlite"}


def test_half_of_a_step_is_half_and_the_verdicts_are_counted():
    column = preset("paper-monolithic")
    motion = st.harmonic(1.0, 3.0, 6.0)
    model = halved_step(st.DistinctElement2D(), column, motion)
    assert engine_for(model, column).step == pytest.approx(0.5 * engine_for(st.DistinctElement2D(), column).step)
    beam = st.RigidBeam(idealisation="prism")
    half = halved_step(beam, column, motion)
    assert half.time_step == pytest.approx(0.5 * beam.step_for(column.as_prism(), motion))
    with pytest.raises(st.InputError, match="time_step"):
        halved_step(st.HousnerBlock(), column, motion)
    pair = compare_steps(column, st.HousnerBlock(time_step=0.004), *GRID)
    assert pair.halved.provenance["parameters"]["time_step"] == 0.002
    assert pair.summary()["differing"] == 0
    assert pair.summary()["comparable"] == int(pair.comparable.sum()) > 5


def test_a_probability_is_read_back_from_its_file(tmp_path):
    size = {"scatter": Scatter(width=0.02), "motion_scatter": MotionScatter(phase=0.1)}
    column = preset("paper-monolithic")
    made = collapse_probability(column, st.HousnerBlock(), *GRID, replicates=3, **size, seed=4, out=tmp_path)
    copy = CollapseProbability.load(tmp_path / "probability.nc")
    np.testing.assert_array_equal(copy.codes, made.codes)
    np.testing.assert_array_equal(copy.peaks, made.peaks)
    assert copy.summary() == made.summary()
    # a rigid block as built: all but its size is left out of the scatter
    assert (copy.column, copy.motion_scatter) == (column, size["motion_scatter"])
    assert copy.scatter == Scatter(**NOTHING | {"width": 0.02, "height": 0.005})
    assert json.dumps(copy.provenance) == json.dumps(made.provenance)
    domain = st.collapse_domain(column, st.HousnerBlock(), *GRID)
    with pytest.raises(st.InputError, match="is a domain, not a probability"):
        CollapseProbability.load(domain.save(tmp_path / "domain.nc"))


def test_a_domain_is_read_back_from_its_file(tmp_path):
    domain = st.collapse_domain(preset("paper-monolithic"), st.HousnerBlock(), *GRID)
    copy = Domain.load(domain.save(tmp_path / "domain.nc"))
    np.testing.assert_array_equal(copy.verdicts, domain.verdicts)
    np.testing.assert_array_equal(copy.first_collapse, domain.first_collapse)
    for kept, row in zip(copy.rows, domain.rows):
        assert kept == {key: row[key] for key in kept}
    assert copy.column == domain.column
    assert json.dumps(copy.provenance) == json.dumps(domain.provenance)
    assert copy.wall_time == domain.wall_time
    with pytest.raises(st.InputError, match="there is no file"):
        Domain.load(tmp_path / "none.nc")
    part = dataclasses.replace(domain, rows=[None, *domain.rows[1:]])
    assert Domain.load(part.save(tmp_path / "part.nc")).verdicts[0, 0] == v.NOT_RUN


def test_an_undecided_run_is_no_collapse_and_no_survival_in_any_share():
    # 3 fall, 5 stand, 2 are undecided: 3 of 10; as few as Wilson's lower limit of 3, as many as his upper limit of 5.
    assert share_collapsed(3, 5, 2) == pytest.approx(0.3)
    assert np.isnan(share_collapsed(0, 0, 4))
    low, high = collapse_interval(3, 5, 2, 0.9)
    assert low == wilson_interval(3, 10, 0.9)[0]
    assert high == wilson_interval(5, 10, 0.9)[1]


def test_a_component_across_takes_the_shaking_out_of_the_plane():
    """Up to a share of the amplitude, a quarter of a cycle late, the same in every cell; plane models never see it."""
    f, a = np.array([0.5, 1.0]), np.array([1.0, 2.0])
    sines = ScatteredSines(f, 4.0, MotionScatter(across=0.02), 30, 3)
    shares = []
    for k in range(30):
        motion = sines.motion(0, 1.0, k)
        share = motion.lateral[0] / -motion.factor
        time = motion.time
        np.testing.assert_allclose(motion.acceleration, np.sin(np.pi * time), atol=1e-12)
        np.testing.assert_allclose(motion.lateral, -share * np.cos(np.pi * time), atol=1e-12)
        assert sines.motion(0, 2.0, k).lateral[0] == pytest.approx(2.0 * motion.lateral[0])
        shares.append(share)
    assert 0.0 < np.abs(shares).min() < np.abs(shares).max() <= 0.02
    assert np.unique(shares).size == 8
    plane = collapse_probability(
        preset("paper-monolithic"), st.HousnerBlock(), f, a, replicates=2, motion_scatter=MotionScatter(across=0.02)
    )
    same = collapse_probability(preset("paper-monolithic"), st.HousnerBlock(), f, a, replicates=2)
    np.testing.assert_array_equal(plane.codes, same.codes)


def test_a_motion_that_is_drawn_does_not_depend_on_how_many_are():
    """The phases of twenty were others than the first twenty of forty."""
    f, size = np.array([0.5]), MotionScatter(amplitude=0.1, phase=0.25, across=0.05)
    few, many = (ScatteredSines(f, 2.0, size, number, 3) for number in (7, 40))
    for k in range(7):
        motion, other = few.motion(0, 1.0, k), many.motion(0, 1.0, k)
        np.testing.assert_array_equal(motion.acceleration, other.acceleration)
        np.testing.assert_array_equal(motion.lateral, other.lateral)


def test_probabilities_of_an_earlier_version_are_refused_as_such(tmp_path):
    old = dataclasses.replace(probability(["SSSS SSSC SCCC CCCC"]), provenance={"imperfection": {"geometry": 0.01}})
    with pytest.raises(st.InputError, match="was written by an earlier version; run it again"):
        CollapseProbability.load(old.save(tmp_path / "probability.nc"))


def test_what_the_model_leaves_out_of_the_motions_is_told_as_left_out():
    plane = st.DistinctElement3D(planar=True)
    assert [model.is_plane(model.parameters()) for model in (st.HousnerBlock(), plane, st.DistinctElement3D())] == [
        True,
        True,
        False,
    ]
    result = collapse_probability(
        preset("paper-monolithic"), st.HousnerBlock(), [1.0], [0.5], 0.1, replicates=1,
        motion_scatter=MotionScatter(phase=0.1, across=0.01),
    )  # fmt: skip
    assert result.summary()["left_out"] == ["friction", "joint_stiffness", "density", "offset", "across"]
    assert result.motion_scatter == MotionScatter(phase=0.1)
