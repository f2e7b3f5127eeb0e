"""Round faces that carry on rings, and resistance to rolling: closed forms, quadrature, and what is refused."""

import math

import numpy as np
import pytest
from validation import space

from stylobate.column import Column, Joint
from stylobate.column.files import column_from_dict, read_column, write_column
from stylobate.column.found_geometry import rotation
from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.kernels.dem3d.bed import settle_ring
from stylobate.models.base import Case, RunOptions
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.engine import engine_for
from stylobate.models.shared.toes import disc_on_bed
from stylobate.models.start import Start
from stylobate.motion import Motion, harmonic

pytestmark = pytest.mark.processor

RING = 0.1


def on_rings(width=RING, drums=1, **changes):
    return Column.tapered(
        height=5.0, bottom_width=0.96, top_width=0.66, drums=drums, density=1600.0,
        joint=Joint(5e10, 2.5e10, friction_coefficient=0.7, ring_width=width), section=changes.get("section", "circular"),
    )  # fmt: skip


def test_two_rings_against_quadrature_over_the_plane():
    """Area, force and moments of sunken and offset faces; strips are met to 5e-3 at worst, a grid of 1 mm to 2e-3."""
    grid = np.linspace(-0.6, 0.6, 1201)
    x, y = np.meshgrid(grid, grid, indexing="ij")
    cell = (grid[1] - grid[0]) ** 2
    for ra, rl, ia, il, along, across, d, gx, gy in (
        (0.48, 0.48, 0.38, 0.38, 0.0, 0.0, 1e-3, 0.0, 0.0),
        (0.48, 0.5, 0.3, 0.4, 0.02, -0.01, 1e-4, 1e-3, 0.0),
        (0.48, 0.48, 0.38, 0.38, 0.05, 0.03, -1e-4, 1e-3, 4e-4),
        (0.48, 1e3, 0.4, 1e-9, 0.0, 0.0, -3e-4, 1e-3, 0.0),
    ):
        upper, lower = np.hypot(x - along, y - across), np.hypot(x, y)
        depth = np.maximum(d + gx * x + gy * y, 0.0)
        there = (upper < ra) & (lower < rl) & (upper > ia) & (lower > il) & (depth > 0.0)
        exact = [
            cell * float(integrand[there].sum())
            for integrand in (np.ones_like(x), depth, depth * x, depth * y, depth**2)
        ]
        area, n, mx, my, _, square, *_ = settle_ring(d, gx, gy, along, across, ra, rl, ia, il)
        size = (exact[0], exact[1], exact[1] * ra, exact[1] * ra, exact[4])
        assert np.abs(np.subtract((area, n, mx, my, square), exact) / size).max() < 0.012


def lever(kn, radius, weight, slope, inner=0.0):
    """Where a face on a bed tilted by a slope carries a weight, from its middle [m], and how deep the middle is."""

    def sums(depth):
        force, first = 0.0, 0.0
        for r, sign in ((radius, 1.0), (inner, -1.0)):
            if r > 0.0:
                edge = slope * r
                x = min(max(-depth / edge, -1.0), 1.0)
                w, angle = math.sqrt(1.0 - x * x), math.acos(x)
                force += sign * disc_on_bed(kn, r, depth, slope)[0]
                second = 0.25 * (angle + x * w * (1.0 - 2.0 * x * x))
                first += sign * kn * r**3 * (depth * 2.0 / 3.0 * w**3 + edge * second)
        return force, first

    low, high = -slope * radius, 1.0
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if sums(middle)[0] < weight else (low, middle)
    return sums(high)[1] / weight, high


def threshold(column, inner):
    """Smallest steady push that overturns a column on its elastic bed [g], and the slope at which it does."""
    drum = column.drums[0]
    b, weight = drum.centroid_height, column.mass * column.gravity
    slopes = np.geomspace(1e-4, 2e-2, 400)
    levers = [lever(5e10, 0.48, weight, s, inner) for s in slopes]
    reach = [(arm - b * s) / (b - depth) for s, (arm, depth) in zip(slopes, levers, strict=True)]
    return max(reach), slopes[int(np.argmax(reach))]


def test_static_uplift_of_a_column_on_a_ring():
    """A ring wider than the toe has the threshold of the whole face; flatter, the law is the closed form disc less disc."""
    column = on_rings()
    whole, _ = threshold(column, 0.0)
    ring, _ = threshold(column, 0.38)
    assert whole == pytest.approx(0.206104, abs=2e-5)  # the whole face; the largest of 400 slopes
    assert ring == pytest.approx(whole, rel=1e-9)
    slope = 1e-4
    model = DistinctElement3D(law="bed")
    block = engine_for(model, column).block(RunOptions())
    block.load(0, Case(column, Motion(1.0, np.zeros(2))))
    arm, depth = lever(5e10, 0.48, column.mass * g, slope, 0.38)
    assert arm > 1.01 * lever(5e10, 0.48, column.mass * g, slope)[0]
    for azimuth in (0.0, 0.7, 4.0):
        turn = rotation(np.array([-math.sin(azimuth), math.cos(azimuth), 0.0]), math.atan(slope))
        for a, axis in enumerate("ijk"):
            for c, name in enumerate("xyz"):
                block.records.body[axis + name][1, 0] = turn[c, a]
        foot = turn @ np.array([0.0, 0.0, block.records.body["fz"][1, 0]])
        for c, name in enumerate("xyz"):
            block.records.body[name][1, 0] = -foot[c] - (depth if c == 2 else 0.0)
        block.records.net(0)
        load = block.records.load
        assert load["f"][0, 2, 0] == pytest.approx(column.mass * g, rel=2e-3)
        towards = np.array([math.cos(azimuth), math.sin(azimuth)])
        about = load["lo"][0, :2, 0] @ (-towards[1], towards[0])
        assert about == pytest.approx(column.mass * g * arm, rel=2e-3)


def test_a_column_on_rings_keeps_its_energy_and_the_share_that_it_touches_with():
    column = on_rings(drums=3)
    inner = 0.5 * max(column.sunken_widths(1))
    assert column.joint_areas[1] == pytest.approx(math.pi * ((0.5 * column.joint_widths[1]) ** 2 - inner**2), rel=1e-12)
    model = DistinctElement3D(law="bed")
    block = engine_for(model, column).block(RunOptions(until_end=True))
    block.load(0, Case(column, harmonic(1.5, 0.25 * g, 1.0)))
    while not block.is_over(0):
        block.advance(50)
    measures = block.collect(0)
    assert measures.outcome.name != "FAILED"
    assert measures.peak_joint_opening > 1e-4
    assert abs(measures.energy_imbalance) < 5e-3
    assert np.abs(block.records.body["y"][1:, 0]).max() < 1e-9


def test_rings_go_through_a_file_and_leave_digests_alone(tmp_path):
    column = on_rings(drums=2)
    again = read_column(write_column(column, tmp_path / "rings.toml"))
    assert again == column
    assert column_from_dict(column.to_dict()) == column
    assert "ring_width" not in space.round_column(2).to_dict()["joints"][0]
    assert column.digest != space.round_column(2).digest


def test_rings_that_nothing_carries_are_refused():
    with pytest.raises(InputError, match=r"thicker than its face, of diameter 0\.96 m; allowed is up to 0\.48 m"):
        on_rings(0.5)
    with pytest.raises(InputError, match="rings are known for round ones"):
        on_rings(section="rectangular")
    motion = harmonic(1.0, 1.0, 0.5)
    with pytest.raises(InputError, match="dem3d with law=rim knows no rings"):
        engine_for(DistinctElement3D(), on_rings()).check(motion)
    with pytest.raises(InputError, match="dem2d knows no rings"):
        engine_for(DistinctElement2D(), on_rings()).check(motion)
    sides = {"height": 5.0, "bottom_width": 1.0, "top_width": 1.0, "drums": 1, "density": 1600.0}
    square = Column.tapered(**sides, joint=Joint(5e10, 2.5e10, 35.0))
    with pytest.raises(InputError, match="is for round drums"):
        engine_for(DistinctElement3D(rolling_resistance=0.01), square).check(motion)


def test_steady_rolling_decays_by_what_resists_it():
    """c N r on the arm a cos θ against the rolling Ω sin θ cos θ, for 0.5 s; the pivot lies 0.2 % inside the rim."""
    column, tilt, precession, c = space.round_column(), 0.1, 1.9129969655, 1e-3
    model = DistinctElement3D(pivot_friction=0.0, rolling_resistance=c)
    block = engine_for(model, column).block(RunOptions(start=space.wobble(tilt, precession), until_end=True))
    block.load(0, Case(column, Motion(0.5, np.zeros(2))))
    before = block.energies(0)
    while not block.is_over(0):
        block.advance(1)
    change = block.energies(0) - before
    drum = column.drums[0]
    rate = c * drum.mass * g * 0.48 * precession * math.sin(tilt) * math.cos(tilt) ** 2
    assert abs(change[5]) == pytest.approx(0.5 * rate, rel=0.01)
    # it goes out of the motion
    assert change[1:4].sum() == pytest.approx(-abs(change[5]), rel=0.05)


@pytest.mark.parametrize("spin", [1e-7, 1e-3])
def test_no_step_adds_to_rolling(spin):
    """A slender drum nearly on its side, at 86°, rolls about its own axis: 1/C there is thirty times 1/A."""
    column = space.cylinder(0.6, 4.0)
    model = DistinctElement3D(pivot_friction=0.0, rolling_resistance=1.0)
    start = Start(1.5, 0.0, tuple(spin * space.axis_of(1.5, 0.0)))
    block = engine_for(model, column).block(RunOptions(start=start, until_end=True))
    block.load(0, Case(column, Motion(0.5, np.zeros(2))))
    block.advance(1)
    axial_spin = sum(block.records.body[f"w{c}"][1, 0] * block.records.body[f"k{c}"][1, 0] for c in "xyz")
    assert abs(axial_spin) < 0.5 * spin


def test_rocking_in_a_plane_does_not_roll():
    column = space.round_column()
    model = DistinctElement3D(rolling_resistance=0.01, planar=True)
    block = engine_for(model, column).block(RunOptions(until_end=True))
    block.load(0, Case(column, harmonic(1.0, 0.3 * g, 0.7)))
    while not block.is_over(0):
        block.advance(50)
    energies = block.energies(0)
    assert energies[1] > 1.0
    assert abs(energies[5]) < 1e-9 * energies[1]
