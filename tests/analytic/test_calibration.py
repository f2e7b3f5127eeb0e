"""Losses from free motions: extremes in closed form, losses found again, and histories that tell nothing refused."""

import math

import numpy as np
import pytest

import stylobate as st
from stylobate.models.drums.impact import released
from stylobate_studies.calibration.free_history import FreeHistory
from stylobate_studies.calibration.loss_likelihood import searched
from stylobate_studies.calibration.swings import envelope, kept, swings


def block(stiffness: float = 3e9, section: str = "rectangular") -> st.Column:
    size = {"height": 1.5, "bottom_width": 0.5, "top_width": 0.5, "density": 2700.0, "depth": 0.5}
    joint = st.Joint(stiffness, 0.5 * stiffness, friction_coefficient=0.7)
    return st.Column.tapered(**size, drums=1, joint=joint, section=section, name="block")


def let_go(column, model, losses, start, *, seconds=6.0, noise=3e-4, seed=0) -> FreeHistory:
    """A measured free motion: every 5 ms, with white noise."""
    free = released(column, model, [losses], [start], seconds, 0.002)[0]
    time = np.arange(0.0, seconds, 0.005)
    lean = np.stack([np.interp(time, free.time, component) for component in free.lean.T], axis=-1)
    lean = lean if "y" in model.axes and not model.planar else lean[:, :1]
    return FreeHistory(0.005, lean + noise * np.random.default_rng(seed).standard_normal(lean.shape))


def rocking(column: st.Column, restitution: float) -> tuple[np.ndarray, np.ndarray]:
    """Times and tilts of Housner's block, let go from 0.4 of its slenderness."""
    model = st.HousnerBlock(restitution=restitution, initial_rotation=-0.4 * column.slenderness)
    response = st.simulate(column, st.Motion(0.01, np.zeros(601)), model, output_interval=0.002)
    return response.time, -response.drum_rotation[:, 0]


def test_extremes_of_a_rigid_block_give_its_restitution():
    """Housner's block of e = 0.92 leaves e² of V at each impact; parabolas from 0.8 of an extreme cost less than 0.2 %."""
    column = block()
    logs, _ = kept(swings(*rocking(column, 0.92)), column.slenderness)
    assert len(logs) > 10
    assert np.exp(logs[:10]) == pytest.approx(0.92, rel=0.002)


def test_noise_of_a_history_is_told():
    """Third differences of white noise have 20 times its variance; the median of 1200 is within a tenth (about 3 sd)."""
    free = let_go(block(), st.DistinctElement2D(), st.Losses(3e-4), st.Start(0.15), noise=3e-4)
    assert free.noise == pytest.approx(3e-4, rel=0.1)


def test_damping_is_found_again_and_the_restitution_beside_it():
    """β of another model (dem2d, in space corners) lies in the interval, and the rest of the file is what was found."""
    column, true = block(), 5e-4
    history = let_go(column, st.DistinctElement2D(), st.Losses(true), st.Start(0.2))
    calibration = st.calibrate(history, column)
    loss = calibration.intervals["stiffness_damping"]
    assert loss.bounded
    assert loss.low < true < loss.high < 4.0 * loss.low
    assert (
        calibration.restitution.low
        < calibration.restitution.value
        < calibration.restitution.high
        < 1.02 * calibration.restitution.low
    )
    assert calibration.after.reached
    assert calibration.laws == {}


def test_next_to_no_damping_has_no_lower_limit():
    """Undamped points lose as much by friction: all that is told is that β is small."""
    column = block()
    calibration = st.calibrate(let_go(column, st.DistinctElement2D(), st.Losses(1e-7), st.Start(0.15)), column)
    assert calibration.intervals["stiffness_damping"].reaches == "least"
    assert "no lower limit" in calibration.sentence


def test_an_impact_that_no_damping_makes_is_no_file(tmp_path):
    """A block that keeps 0.97 of its velocity: contacts give 0.85 to 0.88, so that nothing is written."""
    column = block()
    time, tilt = rocking(column, 0.97)
    calibration = st.calibrate(FreeHistory(float(time[1]), tilt), column, noise=1e-4)
    assert not calibration.after.reached
    assert calibration.restitution.value == pytest.approx(0.97, abs=0.005)  # extremes alone tell it all the same
    with pytest.raises(st.InputError, match="no file of losses"):
        calibration.save(tmp_path / "losses.toml")
    assert not list(tmp_path.iterdir())


def test_intervals_hold_what_is_drawn_from_the_prior():
    """Decrements of a line in one unknown, with noise and a common error of 0.03: 90 % intervals hold 80 of 100 at least.

    Nine in ten are expected; 80 is four standard deviations (3) below.
    """
    stream, slopes = np.random.default_rng(3), -np.linspace(0.2, 0.6, 8)
    hits = 0
    for _ in range(100):
        true = stream.random()
        measured = slopes * true + 0.02 * stream.standard_normal(8) + 0.02 * stream.standard_normal()
        after = searched(
            lambda law, at: at * slopes, measured, 1e-6 * np.eye(8), (None,), 1, (48, 48, 3), least=0.0025
        )  # fmt: skip
        low, high = after.interval(0, 0.9)
        hits += low <= true <= high
    assert 80 <= hits


def test_an_envelope_is_the_largest_lean_of_each_window():
    time = np.linspace(0.0, 4.0, 4001)
    lean = np.abs(np.cos(2.0 * math.pi * time)) * np.exp(-0.5 * time)
    log_peaks = envelope(0.0, time, lean, np.array([0.0, 1.0, 2.0, 3.0]), 1e-6)
    assert np.diff(log_peaks) == pytest.approx(-0.5, abs=0.01)  # averages of a twentieth of a window


@pytest.mark.slow
def test_losses_of_a_wobble_are_found_again():
    """β and c of a drum that turns about its axis as it wobbles, which no tilt tells, lie in their intervals."""
    column, start = block(1e9, "circular"), st.Start(0.16, 0.3, (0.0, 0.0, 0.5))
    true = st.Losses(3e-4, 4e-3, "rim")
    calibration = st.calibrate(let_go(column, st.DistinctElement3D(), true, start, seconds=8.0), column)
    for name, loss in calibration.intervals.items():
        assert loss.low <= getattr(true, name) <= loss.high or not loss.bounded
    assert sum(calibration.laws.values()) == pytest.approx(1.0)


TIME = np.arange(0.0, 6.0, 0.005)
SLOW = FreeHistory(0.005, 0.1 * np.cos(np.arange(0.0, 6.0, 0.005)))


@pytest.mark.parametrize(
    ("history", "column", "message"),
    [
        (FreeHistory(0.005, np.full(400, 0.1)), block(), "swings beyond its noise"),
        (FreeHistory(0.005, 0.1 * np.exp(-np.arange(0.0, 2.0, 0.005))), block(), "swings beyond its noise"),
        (FreeHistory(0.2, 0.1 * np.cos(8.0 * np.arange(0.0, 9.0, 0.2))), block(), "shorter step"),
        (FreeHistory(0.005, 0.1 * np.cos(6.0 * TIME) * np.linspace(0.5, 1.5, 1200)), block(), "dies away"),
        (FreeHistory(0.005, 5.0 * SLOW.values), block(), "check the column"),
        (SLOW, block(section="circular"), "give two"),
        (FreeHistory(0.005, np.hstack((SLOW.values, SLOW.values))), block(), "two columns"),
        (FreeHistory(0.005, np.full((400, 2), 0.1)), block(section="circular"), "does not fall"),
    ],
)  # fmt: skip
def test_what_tells_nothing_is_refused(history, column, message):
    with pytest.raises(st.InputError, match=message):
        st.calibrate(history, column, noise=1e-4)


def test_a_model_with_damping_of_its_own_is_refused():
    with pytest.raises(st.InputError, match="without damping"):
        st.calibrate(SLOW, block(), st.DistinctElement3D(stiffness_damping=1e-4))
    with pytest.raises(st.InputError, match="rigid-beam"):
        st.calibrate(SLOW, block(), st.RigidBeam())
