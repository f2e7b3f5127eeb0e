"""Runs on a graphics card beside those of the processor: run by ``make test-gpu`` where there is a card.

Twelve drums under harmonic motions of ten seconds, from columns that stay shut to columns that fall.
"""

import numpy as np
import pytest
from scipy.stats import binomtest

import stylobate as st
from stylobate.column import preset
from stylobate_gpu import driver
from stylobate_gpu import lanes as lanes

pytestmark = [pytest.mark.gpu, pytest.mark.slow]

PLANE = preset("paper-12-drums"), st.DistinctElement2D(), 64
SPACE = st.Column.tapered(
    height=5.0, bottom_width=0.96, top_width=0.66, drums=12, density=1600.0, section="circular",
    joint=st.Joint(normal_stiffness=5e10, shear_stiffness=2.5e10, friction_angle=35.0),
), st.DistinctElement3D(), 16  # fmt: skip


@pytest.fixture(scope="module", autouse=True)
def card():
    """The card of this machine."""
    try:
        return driver.the_card()
    except st.InputError as none:
        pytest.skip(str(none))


def cells(number):
    """As many motions along each side of a grid, in random order: neighbours on the card have nothing in common."""
    units = [st.harmonic(frequency=f, amplitude=1.0, duration=10.0) for f in np.linspace(0.33, 4.0, number)]
    every = [unit.scaled(a * st.g) for unit in units for a in np.linspace(0.05, 0.6, number)]
    return [every[k] for k in np.random.default_rng(1).permutation(len(every))]


@pytest.fixture(scope="module", params=[PLANE, SPACE], ids=["plane", "space"])
def both(request):
    """Tables of the processor and of the card, with what was run."""
    column, model, number = request.param
    motions = cells(number)
    tables = {device: st.simulate_many(column, motions, model, device=device) for device in ("cpu", "gpu")}
    return column, model, motions, tables


def test_verdicts_differ_no_more_than_those_of_two_processors(both):
    # of 4,096 cells the processor's own verdicts differ in 60 under a change of the motions by 1e-12: twice as many are
    # allowed; none of the two favours a side
    *_, tables = both
    here, there = (tables[device]["collapsed"].to_numpy() for device in ("cpu", "gpu"))
    assert set(tables["gpu"]["computed_by"].str[:3]) == {"gpu"}
    only = int((there & ~here).sum()), int((here & ~there).sum())
    assert sum(only) <= (120 if len(here) > 1000 else 30), only
    assert not sum(only) or binomtest(only[0], sum(only)).pvalue > 1e-3, only


def test_columns_that_stay_shut_move_alike(both):
    *_, tables = both
    shut = (tables["cpu"]["peak_joint_opening_m"] == 0.0) & (tables["gpu"]["peak_joint_opening_m"] == 0.0)
    assert shut.sum() > 10
    here, there = (tables[device]["peak_top_displacement_m"][shut] for device in ("cpu", "gpu"))
    assert np.quantile(np.abs(there / here - 1.0), 0.99) <= 1e-6


def test_energy_is_kept_as_by_the_processor(both):
    *_, tables = both
    assert not (tables["gpu"]["outcome"] == "failed").sum() > (tables["cpu"]["outcome"] == "failed").sum()
    here, there = (np.abs(tables[device]["energy_imbalance"]) for device in ("cpu", "gpu"))
    assert np.quantile(there, 0.99) <= 1.5 * np.quantile(here, 0.99)


def test_a_run_has_the_same_bits_again_shuffled_and_cut(both, monkeypatch):
    column, model, motions, tables = both
    gpu_table = tables["gpu"].drop(columns="wall_s")
    order = np.random.default_rng(2).permutation(len(motions))
    shuffled = st.simulate_many(column, [motions[k] for k in order], model, device="gpu").drop(columns="wall_s")
    assert gpu_table.iloc[order].reset_index(drop=True).equals(shuffled)
    monkeypatch.setattr(lanes, "CHUNKS_PER_LAUNCH", 37)
    assert gpu_table.equals(st.simulate_many(column, motions, model, device="gpu").drop(columns="wall_s"))


def test_what_was_stopped_goes_on_to_the_same_rows(tmp_path):
    column, model, _ = PLANE
    grid = column, model, np.linspace(0.5, 3.0, 16), np.linspace(0.1, 0.5, 16) * st.g, 5.0

    def stop(done, total):
        if done >= 100:
            raise KeyboardInterrupt

    ledger = tmp_path / "runs.sqlite"
    stopped = st.collapse_domain(*grid, device="gpu", ledger=ledger, progress=stop)
    assert 100 <= len(stopped.table) < 256
    resumed = st.collapse_domain(*grid, device="gpu", ledger=ledger)
    assert resumed.table.equals(st.collapse_domain(*grid, device="gpu").table)
