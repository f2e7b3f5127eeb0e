"""Releases from a pose, in the plane and in space: one meaning, one sentence for what cannot be."""

import math

import numpy as np
import pytest
from validation.space import joint, round_column

import stylobate as st

pytestmark = pytest.mark.processor

STILL = st.Motion(1.2, np.zeros(2))


def prism(drums: int = 1, stiffness: float = 5e10) -> st.Column:
    """A rectangular column without taper."""
    return st.Column.tapered(
        height=5.0, bottom_width=0.81, top_width=0.81, drums=drums, density=1600.0, joint=joint(stiffness), depth=0.81
    )


@pytest.mark.parametrize(("share", "quarter"), [(0.5, 0.74849162), (0.75, 1.17190153)])
@pytest.mark.parametrize("azimuth", [0.0, math.pi])
def test_time_from_release_to_upright_in_the_plane(share, quarter, azimuth):
    # rigid body about its corner, integrated; the corner gives by 1e-4 of itself at this stiffness
    column = round_column(stiffness=5e12)
    start = st.Start(share * column.slenderness, azimuth)
    response = st.simulate(column, STILL, st.DistinctElement2D(), start=start, output_interval=1e-3)
    lean = -response.drum_rotation[:, 0] * math.cos(azimuth)
    assert lean[0] == pytest.approx(start.tilt, rel=1e-12)
    i = int(np.argmax(lean < 0.0))
    at = np.interp(0.0, lean[[i, i - 1]], response.time[[i, i - 1]])
    assert at == pytest.approx(quarter, rel=1.5e-4)
    # what the pose holds is conserved until the edge strikes
    energy = np.sum([np.asarray(response.energy[term]) for term in ("kinetic", "gravitational", "elastic")], axis=0)
    assert np.abs(energy[: i - 1]).max() < 1.0
    top = column.height * math.sin(start.tilt) + 0.48 * (1.0 - math.cos(start.tilt))
    assert response.top_displacement[0] * math.cos(azimuth) == pytest.approx(top, abs=1e-4)


@pytest.mark.parametrize(("drums", "limit"), [(1, 1e-10), (3, 1e-8)])  # rounding, and what it becomes as joints rattle
@pytest.mark.parametrize("rate", [0.0, 0.2])
def test_the_plane_and_its_twin_start_alike(drums, limit, rate):
    column, start = prism(drums), st.Start(0.06, math.pi, (0.0, rate, 0.0))
    plane = st.simulate(column, STILL, st.DistinctElement2D(time_step=2e-5), start=start)
    twin = st.simulate(column, STILL, st.DistinctElement3D(planar=True, time_step=2e-5), start=start)
    soon = plane.time < 0.2
    assert np.abs(plane.top_displacement - twin.top_displacement[:, 0])[soon].max() < limit
    assert plane.top_displacement[0] < -0.2
    assert plane.decided == twin.decided
    energies = [response.measures.energy_imbalance for response in (plane, twin)]
    assert max(energies) < 1e-2


def test_a_start_on_its_way_over_falls_and_one_held_back_does_not():
    column, model = prism(), st.DistinctElement2D()
    over = 1.02 * column.slenderness
    fallen = st.simulate(column, STILL, model, start=st.Start(over), tail=5.0)
    restrained = st.simulate(column, STILL, model, start=st.Start(over, 0.0, (0.0, -0.05, 0.0)), tail=5.0)
    assert fallen.collapsed
    assert fallen.measures.collapse is not None
    assert fallen.measures.collapse.side == "right"
    assert not restrained.collapsed
    outward = st.Start(0.98 * column.slenderness, 0.0, (0.0, 0.1, 0.0))
    on_its_way = st.simulate(column, st.Motion(0.01, np.zeros(2)), model, start=outward)
    assert not on_its_way.collapsed
    assert not on_its_way.decided


def test_a_release_that_is_followed_to_the_ground():
    column = prism(2)
    response = st.simulate(
        column, STILL, st.DistinctElement2D(), start=st.Start(1.02 * column.slenderness), until_rest=True
    )
    assert response.collapsed
    assert np.degrees(np.abs(response.drum_rotation[-1])).min() > 80.0


def test_starts_that_cannot_be_are_refused_in_one_sentence():
    with pytest.raises(st.InputError, match=r"tilt of a start is 1\.5708"):
        st.Start(0.5 * math.pi)
    with pytest.raises(st.InputError, match=r"tilt of a start is -0\.1"):
        st.Start(-0.1)
    column = prism()
    for start in (st.Start(0.1, 0.5), st.Start(0.1, 0.0, (0.1, 0.0, 0.0)), st.Start(0.1, 0.0, (0.0, 0.0, 1.0))):
        with pytest.raises(st.InputError, match="keeps to the plane of x and z, and the start leaves it"):
            st.simulate(column, STILL, st.DistinctElement2D(), start=start)
    with pytest.raises(st.InputError, match="starts from rest; leave start out, or use dem2d or dem3d"):
        st.simulate(column, STILL, st.RigidBlock(), start=st.Start(0.1))
