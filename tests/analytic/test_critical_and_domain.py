"""Critical amplitudes and domains of a model whose verdict is known for every amplitude and frequency."""

import math
import os
import subprocess
import sys
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest
import xarray

import stylobate as st
from stylobate.campaign.ledger import RUNS_FILE
from stylobate.column.catalogue import preset
from stylobate.models.base import Model
from stylobate.models.engine import Engine
from stylobate.response import Measures
from stylobate.verdicts import verdict as v
from stylobate.verdicts.compare import compare_domains
from stylobate.verdicts.critical import amplitude_grid

COLUMN = preset("paper-monolithic")


class Thresholds(Engine):
    """Of :class:`Threshold`."""

    def run_many(self, cases, options, threads):
        for index in reversed(range(len(cases))):  # in another order than asked for
            if os.environ["THRESHOLD_RUNS"] == os.environ.get("THRESHOLD_STOPS"):
                raise KeyboardInterrupt
            os.environ["THRESHOLD_RUNS"] = str(int(os.environ["THRESHOLD_RUNS"]) + 1)
            yield index, self.model.measures(cases[index].motion)


@dataclass(frozen=True)
class Threshold(Model):
    """Collapses from ``limit`` × (1 + frequency) [g] on, except where it stands, fails or stays undecided."""

    limit: float = 0.2
    stands_at: tuple = ()
    fails_at: tuple = ()
    undecided_at: tuple = ()

    name: ClassVar[str] = "threshold"
    version: ClassVar[str] = "1"
    engines: ClassVar[tuple] = (Thresholds,)

    def measures(self, motion):
        amplitude = round(motion.factor / st.g, 6)
        crossings = np.count_nonzero(np.diff(np.signbit(motion.samples[1:-1])))
        frequency = (crossings + 1) / 2 / motion.duration
        outcome, decided = st.Outcome.ROCKED, True
        if amplitude in self.fails_at:
            outcome, decided = st.Outcome.FAILED, False
        elif amplitude in self.undecided_at:
            decided = False
        elif amplitude >= round(self.limit * (1 + frequency), 6) and amplitude not in self.stands_at:
            outcome = st.Outcome.COLLAPSED
        time = 1.0 if outcome is st.Outcome.COLLAPSED else math.nan
        return Measures(outcome, decided, time, amplitude, 0.0, 0.1, 0.1, 0.0, 0.0, 1e-3, 10)


def count(stops=None):
    """Count runs from zero, and stop after so many: beside the model, whose values decide which runs are its own."""
    os.environ |= {"THRESHOLD_RUNS": "0", "THRESHOLD_STOPS": str(stops)}


def runs():
    return int(os.environ["THRESHOLD_RUNS"])


@pytest.fixture(autouse=True)
def _count_from_zero(monkeypatch):
    monkeypatch.setenv("THRESHOLD_RUNS", "0")
    monkeypatch.setenv("THRESHOLD_STOPS", "None")


def critical(model, **options):
    motion = st.harmonic(1.0, 1.0, 10.0)
    return st.critical_amplitude(COLUMN, motion, model, 0.05 * st.g, 0.6 * st.g, 0.05 * st.g, nominal=1.0, **options)


def test_the_critical_amplitude_is_the_first_of_the_grid_at_or_above_the_threshold():
    result = critical(Threshold(limit=0.11))  # 0.22 g at 1 Hz
    assert result.critical == pytest.approx(0.25 * st.g)
    assert result.all_collapse_above == pytest.approx(0.25 * st.g)
    assert result.summary()["runs"] == len(result.amplitudes) == 12
    assert result.alternation.to_dict("list") == {
        "from_g": pytest.approx([0.05, 0.25]),
        "to_g": pytest.approx([0.20, 0.60]),
        "verdict": ["stands", "collapsed"],
        "runs": [4, 8],
    }


def test_verdicts_that_alternate_are_all_reported():
    result = critical(Threshold(limit=0.1, stands_at=(0.3, 0.45)))
    assert result.critical == pytest.approx(0.2 * st.g)
    assert result.all_collapse_above == pytest.approx(0.5 * st.g)
    assert result.alternation["verdict"].tolist() == ["stands", "collapsed"] * 3


def test_failed_and_undecided_runs_are_never_collapse():
    result = critical(Threshold(limit=0.1, fails_at=(0.2, 0.6), undecided_at=(0.25,)))
    assert result.critical == pytest.approx(0.3 * st.g)
    assert result.all_collapse_above is None  # the last run failed
    summary = result.summary()
    assert (summary["failed"], summary["undecided"], summary["collapsed"], summary["stands"]) == (2, 1, 6, 3)


def test_nothing_collapses():
    summary = critical(Threshold(limit=10.0)).summary()
    assert summary["critical_g"] is None
    assert summary["first_collapse_g"] is None
    assert summary["all_collapse_above_g"] is None


def test_a_record_is_scaled_to_its_peak():
    record = st.Motion(0.01, 3.0 * np.sin(2 * np.pi * np.arange(1001) * 0.01))
    result = st.critical_amplitude(COLUMN, record, Threshold(limit=1.0), 1.0, 2.0, 0.5)
    peaks = result.table["peak_top_displacement_m"] * st.g * record.pga
    np.testing.assert_allclose(peaks, [1.0, 1.5, 2.0], rtol=1e-5)


@pytest.mark.parametrize(
    ("grid", "expected"),
    [
        ((0.05, 1.0, 0.005), np.linspace(0.05, 1.0, 191)),
        ((0.1, 0.35, 0.1), [0.1, 0.2, 0.3]),
        ((0.3, 0.3, 0.1), [0.3]),
    ],
)
def test_the_grid_ends_at_the_last_whole_step(grid, expected):
    np.testing.assert_allclose(amplitude_grid(*grid), expected, rtol=1e-12)


@pytest.mark.parametrize(
    "grid", [(0.0, 1.0, 0.1), (0.5, 0.4, 0.1), (0.1, 1.0, 0.0), (0.1, 1.0, 1e-6), (0.1, math.nan, 0.1)]
)
def test_impossible_grids(grid):
    with pytest.raises(st.InputError):
        amplitude_grid(*grid)


FREQUENCIES = np.array([0.5, 1.0, 2.0])
AMPLITUDES = np.linspace(0.05, 0.6, 12) * st.g


def domain(model=None, **options):
    return st.collapse_domain(COLUMN, model or Threshold(), FREQUENCIES, AMPLITUDES, **options)


def test_the_domain_has_the_boundary_of_the_threshold():
    result = domain(Threshold(fails_at=(0.1,), undecided_at=(0.55,)))
    assert result.complete
    np.testing.assert_allclose(result.first_collapse, np.array([0.3, 0.4, 0.6]) * st.g)
    np.testing.assert_allclose(result.all_collapse_above, np.array([0.6, 0.6, 0.6]) * st.g)
    expected = np.round(AMPLITUDES / st.g, 6)[None, :] >= np.round(0.2 * (1 + FREQUENCIES), 6)[:, None]
    expected[:, 10] = False
    np.testing.assert_array_equal(result.verdicts == v.COLLAPSED, expected)
    summary = result.summary()
    assert (summary["cells"], summary["runs"]) == (36, 36)
    assert (summary["collapsed"], summary["failed"], summary["undecided"]) == (expected.sum(), 3, 3)
    table = result.table
    assert table["frequency_hz"].tolist() == np.repeat(FREQUENCIES, 12).tolist()
    np.testing.assert_allclose(table["peak_top_displacement_m"], table["amplitude_g"], rtol=1e-6)


def test_the_domain_on_disk(tmp_path):
    result = domain()
    result.save(tmp_path / "domain.nc")
    result.save(tmp_path / "domain.csv")
    with xarray.open_dataset(tmp_path / "domain.nc", engine="h5netcdf") as data:
        assert data.sizes == {"frequency": 3, "amplitude": 12}
        np.testing.assert_array_equal(data["amplitude"], AMPLITUDES)
        meanings = data["verdict"].attrs["flag_meanings"].split()
        assert meanings == [verdict.replace(" ", "_") for verdict in v.VERDICTS]
        np.testing.assert_array_equal(np.array(v.VERDICTS)[data["verdict"].to_numpy()], result.verdicts)
        assert data["collapse_time_s"].attrs["units"] == "s"
    lines = (tmp_path / "domain.csv").read_text().splitlines()
    assert len(lines) == 37
    assert lines[0].startswith("frequency_hz,amplitude_g,verdict,outcome")
    with pytest.raises(st.InputError, match=r"saved as \.nc .* or \.csv"):
        result.save(tmp_path / "domain.xlsx")


def test_an_interrupt_keeps_what_is_finished_and_the_same_call_goes_on(tmp_path):
    whole = domain()
    count(stops=10)
    part = domain(out=tmp_path)
    assert not part.complete
    assert part.counts["not run"] == 26
    assert [path.name for path in tmp_path.glob("*.nc")] == []
    count()
    again = domain(out=tmp_path)
    assert runs() == 26
    assert again.rows == whole.rows
    assert sorted(path.name for path in tmp_path.iterdir()) == ["domain.csv", "domain.nc", RUNS_FILE]


def test_runs_of_another_domain_are_not_mixed_in(tmp_path):
    domain(out=tmp_path)
    for change in ({"model": Threshold(limit=0.3)}, {"duration": 5.0}, {"tail": 1.0}):
        count()
        assert domain(**change, out=tmp_path).rows == domain(**change).rows
        assert runs() == 2 * 36


def test_a_killed_campaign_goes_on(tmp_path):
    script = f"""
import os, runpy, signal, time
here = runpy.run_path({__file__!r})
def killed(done, _):
    if done == 10:
        time.sleep(1.0)  # a second, and no further run that finishes
        os.kill(os.getpid(), signal.SIGKILL)
here["domain"](out={str(tmp_path)!r}, progress=killed)
"""
    ended = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert ended.returncode == -9, ended.stderr
    whole = domain()
    count()
    assert domain(out=tmp_path).rows == whole.rows
    assert runs() == 26


def test_a_file_that_is_no_ledger_is_refused_and_left_as_it_was(tmp_path):
    text = "not a database, and long enough to be looked at as one\n" * 20
    (tmp_path / RUNS_FILE).write_text(text)
    with pytest.raises(st.InputError, match=r"is damaged, or no such file .* it stays as it is: move it away"):
        domain(out=tmp_path)
    assert (tmp_path / RUNS_FILE).read_text() == text
    (tmp_path / RUNS_FILE).rename(tmp_path / "aside")
    assert domain(out=tmp_path).complete
    with pytest.raises(st.InputError, match="does not exist"):
        domain(out=tmp_path / "none")


def test_motions_of_one_frequency_share_their_samples():
    seen = []

    class Spying(Thresholds):
        def run_many(self, cases, options, threads):
            seen.extend(case.motion.samples for case in cases)
            yield from super().run_many(cases, options, threads)

    class Spy(Threshold):
        engines = (Spying,)

    domain(Spy())
    assert len(seen) == 36
    assert len({id(samples) for samples in seen}) == 3


@pytest.mark.parametrize(
    ("frequencies", "amplitudes", "words"),
    [
        ([], [1.0], "at least one value"),
        ([1.0, 0.5], [1.0], "must rise"),
        ([1.0], [-1.0], "-1 m/s²"),
        ([math.nan], [1.0], "nan"),
        (["x"], [1.0], "not an array of numbers"),
        (np.linspace(1, 2, 1001), np.linspace(1, 2, 1000), "1001 × 1000 cells"),
    ],
)
def test_impossible_domains(frequencies, amplitudes, words):
    with pytest.raises(st.InputError, match=words):
        st.collapse_domain(COLUMN, Threshold(), frequencies, amplitudes)


def test_two_models_differ_in_the_cells_between_their_boundaries():
    comparison = compare_domains(
        COLUMN, [Threshold(), Threshold(limit=0.25, fails_at=(0.35,))], FREQUENCIES, AMPLITUDES
    )
    # 0.5 Hz: 0.30 against 0.375 g, cells 0.30 (and 0.35, which failed); 1 Hz: 0.40 against 0.5, cells 0.40, 0.45;
    # 2 Hz: 0.60 against 0.75, cell 0.60.
    row = comparison.table.iloc[0]
    assert row["differing"] == row["only_first_collapses"] == 4
    assert row["only_second_collapses"] == 0
    assert row["comparable"] == 33
    assert comparison.differing(0, 1).sum() == 4
