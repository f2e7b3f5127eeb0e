"""Assemblies in space under motions, from the structure to the response: a portal under pulses, and what is refused."""

import math
from pathlib import Path

import numpy as np
import pytest

import stylobate as st
from stylobate.models.space import loose as assemblies

GALLERY = Path(__file__).parents[2] / "gallery" / "assemblies"

TAN_PHI = math.degrees(math.atan(0.7))


def portal(kn=5e10, phi=TAN_PHI):
    stones = [
        st.Stone.box((0.8, 0.8, 4.0), (-1.2, 0.0, 0.0), 2700.0, name="left"),
        st.Stone.box((0.8, 0.8, 4.0), (1.2, 0.0, 0.0), 2700.0, name="right"),
        st.Stone.box((3.2, 0.8, 0.6), (0.0, 0.0, 4.0), 2700.0, name="beam"),
    ]
    return st.SpatialAssembly(tuple(stones), st.Joint(kn, 0.5 * kn, phi), name="portal")


def pulse(share, duration, cycles, azimuth=0.0):
    """Half a sine, or a whole one, in shares of gravity."""
    t = np.arange(0.0, duration + 1e-9, 0.0025)
    a = share * 9.81 * np.sin(2.0 * np.pi * cycles * t / duration)
    if azimuth:
        return st.Motion(0.0025, a * math.cos(azimuth), lateral=a * math.sin(azimuth))
    return st.Motion(0.0025, a)


def test_a_portal_at_rest_stays(tmp_path):
    """And its response is read from its file again."""
    response = st.simulate(portal(), st.Motion(0.01, np.zeros(21)), st.DistinctElement3D())
    response.save(tmp_path / "response.nc")
    again = st.Response.load(tmp_path / "response.nc")
    assert np.array_equal(again.poses.position, response.poses.position)
    assert again.measures.blocks == response.measures.blocks
    assert response.measures.outcome == st.Outcome.AT_REST
    assert response.measures.blocks.in_equilibrium
    assert response.measures.blocks.peak_displacement < 1e-7
    assert response.histories.joint_slip.shape == (len(response.histories.time), 4, 2)


@pytest.mark.parametrize(
    ("share", "duration", "cycles", "stands", "peak"),
    [
        (0.35, 0.8, 0.5, True, 0.08719524),
        (0.35, 0.8, 1.0, True, 0.016169558),
        (0.45, 1.0, 0.5, False, None),
        (0.45, 1.0, 1.0, False, 0.06014188),
        (0.6, 0.5, 0.5, False, None),
        (0.6, 0.5, 1.0, True, 0.027741575),
        (0.8, 0.6, 0.5, False, None),
        (0.8, 0.6, 1.0, None, 0.071342357),
    ],
)
def test_a_portal_under_a_pulse(share, duration, cycles, stands, peak):
    """Verdict, where impacts do not decide it, and first peak to 2 %: the block of Makris and Vassiliou (2013)."""
    response = st.simulate(portal(5e11), pulse(share, duration, cycles), st.DistinctElement3D(), tail=2.5)
    assert response.measures.outcome != st.Outcome.FAILED
    if stands is not None:
        assert (response.measures.blocks.fell_at == ()) == stands
    if peak is not None:
        lean = np.abs(response.histories.poses.axis[:, 1, 0])
        first = np.argmax(lean[1:-1] > np.maximum(np.maximum.accumulate(lean)[:-2] - 1e-12, lean[2:] + 1e-9)) + 1
        assert math.asin(lean[first]) == pytest.approx(peak, rel=0.02)


def test_a_portal_falls_and_comes_to_rest():
    """Every body tells when it fell; the ledger accounts for what was set free."""
    model = st.DistinctElement3D(stiffness_damping=1e-4)
    response = st.simulate(portal(5e9), pulse(0.6, 0.6, 0.5), model, until_rest=True)
    measures = response.measures
    assert measures.outcome == st.Outcome.COLLAPSED
    assert {name for name, _ in measures.blocks.fell_at} == {"left", "right", "beam"}
    assert measures.blocks.at_rest
    assert measures.energy_imbalance < 0.01
    assert response.poses.position[-1, 1:, 2].min() > 0.25


def test_a_run_out_of_balance_has_no_verdict(monkeypatch):
    """Whatever it shows; before anything fell, energy is missed of the input, not of all that the fall sets free."""
    monkeypatch.setattr(assemblies, "LARGEST_IMBALANCE", 1e-5)
    response = st.simulate(portal(5e9), pulse(0.6, 0.6, 0.5), st.DistinctElement3D(), tail=2.0)
    blocks = response.measures.blocks
    assert min(response.poses.position[-1, 1:, 2]) < 1.0  # something lies on the ground
    assert (blocks.fell_at, blocks.displaced) == ((), ())
    assert not any(body.fell_at or body.displaced for body in blocks.bodies)
    assert response.measures.outcome == st.Outcome.FAILED
    assert not response.measures.decided
    assert "no verdict on the assembly. Reason: the energy ledger is out of balance by" in response.describe()


def test_bodies_that_sink_into_one_another_have_no_verdict(monkeypatch):
    """In a collapse on soft joints contacts are some millimetres deep."""
    monkeypatch.setattr(assemblies, "DEEPEST", 1e-3)
    response = st.simulate(portal(5e9), pulse(0.6, 0.6, 0.5), st.DistinctElement3D(), tail=2.0)
    assert response.measures.outcome == st.Outcome.FAILED
    assert "bodies sank into one another" in response.describe()


def test_a_corner_of_a_temple_settles():
    """Its step is a tenth of a portal's: how long it may take is a time, not a number of steps."""
    structure = st.read_assembly(GALLERY / "temple_corner.toml")
    still = st.Motion(0.001, np.zeros(11))
    assert st.simulate(structure, still, st.DistinctElement3D()).measures.blocks.in_equilibrium


def test_a_run_goes_on_to_its_end_whatever_has_fallen():
    """A stone that falls past a support in the first second is followed through seven seconds and a tail, in batches too."""
    stones = (
        st.Stone.box((1.0, 1.0, 1.0), (0.0, 0.0, 0.0), 2700.0, name="support", fixed=True),
        st.Stone.box((0.5, 0.5, 0.5), (3.0, 0.0, 0.0), 2700.0, name="stone"),
    )
    scene = st.SpatialAssembly(stones, st.Joint(1e6, 5e5, TAN_PHI), ground=None, settle=False)
    still, model = st.Motion(0.01, np.zeros(701)), st.DistinctElement3D()
    response = st.simulate(scene, still, model, tail=1.0)
    assert response.fallen == ("stone",)
    assert response.time[-1] == pytest.approx(8.0, abs=0.5)  # whole chunks of long steps
    [row] = st.simulate_many(scene, [still], model, tail=1.0).to_dict("records")
    assert row["steps"] * row["time_step_s"] == pytest.approx(response.time[-1])


def test_what_is_not_known_is_refused():
    still = st.Motion(0.01, np.zeros(11))
    with pytest.raises(st.InputError, match=r"law is 'bed', which assemblies in space such as 'portal' do not know"):
        st.simulate(portal(), still, st.DistinctElement3D(law="bed"))
    with pytest.raises(
        st.InputError, match=r"a start from a pose is for columns, and 'portal' is an assembly in space"
    ):
        st.simulate(portal(), still, st.DistinctElement3D(), start=st.Start(tilt=0.01))
    with pytest.raises(st.InputError, match=r"time_step is 0.5 s; the largest stable step for 'portal' is"):
        st.simulate(portal(), still, st.DistinctElement3D(time_step=0.5))
