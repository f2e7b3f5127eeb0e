"""Footprints from several scans: a known turn is found, a mean has less of the scans' noise than any of them."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from stylobate_studies.experiments import footprint
from stylobate_studies.experiments.granite_files import Scan

MASS, INERTIA = 350.0, np.diag([20.0, 18.0, 14.0])


def stone(rng, noise):
    """A boulder with a smooth base (radii of 1.5 m and 2 m), seen at 700 places with noise of their heights [m]."""
    level, azimuth = 0.36 * np.sqrt(rng.random(700)), 2.0 * np.pi * rng.random(700)
    x, y = level * np.cos(azimuth), 0.9 * level * np.sin(azimuth)
    base = np.stack((x, y, x**2 / 3.0 + y**2 / 4.0 + 0.15 * (level / 0.36) ** 12 + rng.normal(0.0, noise, 700)), axis=1)
    rim = np.stack((0.3 * np.cos(azimuth[:200]), 0.3 * np.sin(azimuth[:200]), np.full(200, 0.75)), axis=1)
    points = np.concatenate((base, rim)) - (0.0, 0.0, 0.29)
    return Scan("stone", MASS, INERTIA, points[ConvexHull(points).vertices])


def face(scan):
    """Area of the face on which it rests [m²]."""
    return scan.specimen().resting.area


def test_a_scan_that_was_turned_and_shifted_is_brought_back():
    """To what 3000 directions leave between corners of the hull."""
    scan = stone(np.random.default_rng(1), 1e-3)
    turn, shift = Rotation.from_rotvec((0.02, -0.03, 0.01)).as_matrix(), np.array([0.002, -0.001, 0.003])
    moved = Scan("moved", MASS, turn @ INERTIA @ turn.T, scan.vertices @ turn.T + shift, shift)
    back = footprint.registered(Scan("moved", MASS, moved.inertia, moved.vertices), scan)
    assert np.abs(back.vertices - scan.vertices).max() < 1e-4
    assert back.centroid == pytest.approx(-shift, abs=2e-4)
    assert back.inertia == pytest.approx(INERTIA, abs=1e-2)


def test_a_mean_of_one_scan_is_that_scan():
    rng = np.random.default_rng(2)
    scans = [stone(rng, 1e-3) for _ in range(3)]
    mean = footprint.mean_of(scans, (1.0, 0.0, 0.0))
    along = footprint.directions()
    np.testing.assert_allclose(
        footprint.support(mean.vertices, along), footprint.support(scans[0].vertices, along), rtol=0, atol=1e-15
    )
    assert face(mean) == pytest.approx(face(scans[0]), rel=1e-9)


def test_noise_widens_the_face_a_stone_rests_on_and_a_mean_narrows_it():
    """A smooth stone rests on a point. Medians of eight: 29 cm² as scanned, 63 with noise once more, 7 the mean of three."""
    rng = np.random.default_rng(3)
    scanned, noisier, means = [], [], []
    for _ in range(8):
        scans = [stone(rng, 1e-3) for _ in range(3)]
        scanned.append(face(scans[0]))
        more = scans[0].vertices + rng.normal(0.0, 1e-3, len(scans[0].vertices))[:, None] * (0.0, 0.0, 1.0)
        noisier.append(face(Scan("noisier", MASS, INERTIA, more)))
        means.append(face(footprint.mean_of(scans, rng.dirichlet(np.ones(3)))))
    assert np.median(means) < 0.5 * np.median(scanned)
    assert np.median(noisier) > 1.2 * np.median(scanned)


def test_worn_edges_are_those_that_a_ball_rolls_over_from_within():
    """A box of half widths a opened by r reaches Σ (aᵢ − r) |uᵢ| + r in direction u."""
    half, r = np.array([0.3, 0.25, 0.4]), 0.06
    box = Scan("box", MASS, INERTIA, half * [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    vertices = footprint.worn(box, r).vertices
    along = footprint.downwards(np.linspace(0.1, 20.0, 30), 36)
    exact = np.abs(along) @ (half - r) + r
    reach = footprint.support(vertices, along)
    assert (reach <= exact + 1e-8).all()
    assert (reach >= exact - 3e-3 * r).all()  # a chord of 7.5° lies 2.1e-3 r within its arc
    assert face(footprint.worn(box, r)) == pytest.approx(4.0 * (half[0] - r) * (half[1] - r), rel=0.01)
