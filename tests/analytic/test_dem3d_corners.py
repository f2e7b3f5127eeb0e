"""Rectangular columns in space: against the plane model, closed forms of sliding and of free rotation, and themselves."""

import itertools
import math

import numpy as np
import pytest
from validation.space import flat_barrier

from stylobate.column import AsFound, Column, Drum, FoundDrum, Joint
from stylobate.constants import g
from stylobate.kernels.run_codes import RUNNING
from stylobate.models.base import Case, RunOptions
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.engine import engine_for
from stylobate.models.start import Start
from stylobate.motion import Motion, harmonic
from stylobate.simulate import simulate_many

pytestmark = pytest.mark.processor

SIDE = 0.81
JOINT = Joint(5e10, 2.5e10, friction_coefficient=0.7)


def prism(drums=1, depth=SIDE, side=SIDE, joint=JOINT):
    return Column.tapered(
        height=5.0, bottom_width=side, top_width=side, drums=drums, density=1600.0, joint=joint, depth=depth
    )


def blocks(column, motion, model=None, every=1, start=None):
    """A run chunk by chunk: yields the block with the run in lane 0."""
    model = model or DistinctElement3D()
    options = RunOptions(until_end=True, start=start)
    block = engine_for(model, column).block(options)
    block.load(0, Case(column, motion))
    yield block
    while not block.is_over(0):
        block.advance(every)
        yield block


def path(column, motion, model=None, **options):
    """Places of all centroids over time, shape (T, n, 3)."""
    places = [
        np.stack([block.records.body[c][1:, 0] for c in "xyz"], axis=-1).copy()
        for block in blocks(column, motion, model, **options)
    ]
    return np.array(places)


def both_ways(a, b, f=1.0, second=1.3, duration=1.0, dt=1e-3):
    t = np.arange(round(duration / dt) + 1) * dt
    x, y = a * g * np.sin(2 * np.pi * f * t), b * g * np.sin(2 * np.pi * second * t)
    return Motion(dt, x, ay=y)


@pytest.mark.parametrize(("drums", "depth", "limit"), [(1, SIDE, 1e-12), (1, 0.5, 1e-12), (12, SIDE, 1e-8)])
def test_a_prism_shaken_along_its_side_is_the_plane_model(drums, depth, limit):
    """The plane model with two points, at 0.5 s; nothing at all leaves the plane."""
    column, motion = prism(drums, depth), harmonic(1.0, 0.2 * g, 0.5)
    step = 0.4 * min(
        engine_for(model, column).stable_step for model in (DistinctElement2D(points=2), DistinctElement3D())
    )
    space = path(column, motion, DistinctElement3D(time_step=step))
    model = DistinctElement2D(points=2, time_step=step)
    plane = np.array(
        [
            np.stack([block.records.body[c][1:, 0] for c in "xz"], axis=-1).copy()
            for block in blocks(column, motion, model)
        ]
    )  # fmt: skip
    assert np.abs(plane[-1, :, 0]).max() > 1e-5
    assert np.abs(space[..., [0, 2]] - plane).max() < limit
    assert np.abs(space[..., 1]).max() < 1e-15


def test_a_prism_against_the_plane_model_over_many_motions():
    """Amplitudes in small steps up to collapse: so many collapse in both, and peaks lie together."""
    motions = [harmonic(0.8, a * g, 5.0) for a in np.linspace(0.2, 0.36, 48)]
    space = simulate_many(prism(), motions, DistinctElement3D())
    plane = simulate_many(prism(), motions, DistinctElement2D(points=2))
    lost = [int((table["outcome"] == "collapsed").sum()) for table in (space, plane)]
    assert 8 < lost[1] < 40
    assert abs(lost[0] - lost[1]) <= 6
    peaks = [table["peak_top_displacement_m"][table["outcome"] != "collapsed"].median() for table in (space, plane)]
    assert peaks[0] == pytest.approx(peaks[1], rel=0.2)


def test_shaking_along_y_is_shaking_along_x_of_the_column_turned_by_a_right_angle():
    a = path(prism(3, depth=0.6), both_ways(0.2, 0.1, duration=0.6))
    motion = both_ways(0.2, 0.1, duration=0.6)
    turned = Motion(motion.dt, -motion.y_samples, ay=motion.samples)
    other = Column.tapered(
        height=5.0, bottom_width=0.6, top_width=0.6, drums=3, density=1600.0, joint=JOINT, depth=SIDE
    )
    b = path(other, turned)
    k = min(len(a), len(b))
    assert k == len(a) == len(b)
    assert np.abs(a[..., 0]).max() > 1e-4
    assert np.abs(np.stack([b[..., 1], -b[..., 0]], -1) - a[..., :2]).max() < 1e-8


def test_mirror_images_move_as_mirror_images():
    motion = both_ways(0.25, 0.15, duration=0.45)
    other = Motion(motion.dt, motion.samples, ay=-motion.y_samples)
    a, b = path(prism(3, depth=0.6), motion), path(prism(3, depth=0.6), other)
    assert np.abs(a[..., 1]).max() > 1e-4
    assert np.abs(a * (1.0, -1.0, 1.0) - b).max() < 1e-11


def test_a_square_pushed_along_its_diagonal_stays_in_that_plane_and_starts_to_lift_later():
    """Symmetry; and its corner is √2 times as far as its side: it lifts at √2 times the acceleration."""
    shaken = both_ways(0.18, 0.18, second=1.0, duration=1.0)  # 0.25 g along the diagonal, above 0.229 g
    a = path(prism(), shaken)
    assert np.abs(a[..., 0] - a[..., 1]).max() < 1e-11

    # the slow push that overturns: 0.162 g along a side
    def leans(share, azimuth):
        t = np.arange(2001) * 1e-3
        ramp = np.minimum(t, 1.0) * share * g * SIDE / 5.0
        push = Motion(1e-3, ramp * math.cos(azimuth), ay=ramp * math.sin(azimuth))
        *_, last = blocks(prism(), push, DistinctElement3D(step_factor=0.8, mass_damping=2.0), every=20)
        return 1.0 - float(last.records.body["kz"][1, 0]) > 1e-4

    assert leans(1.1, 0.0)
    assert not leans(0.9, 0.0)
    assert not leans(1.25, math.pi / 4)
    assert leans(1.6, math.pi / 4)


def sliding(ax, ay, duration, dt=1e-3):
    """A stocky block of friction 0.3 on a base with given accelerations: its slip over time, and the times."""
    column = Column.of_drums([Drum(0.2, 2.0, 2.0, 2000.0, depth=2.0)], Joint(5e9, 2.5e9, friction_coefficient=0.3))
    t = np.arange(round(duration / dt) + 1) * dt
    model = DistinctElement3D(stiffness_damping=1e-4)
    slips = [
        (block.time(0), *block.records.joints(0)[1][0]) for block in blocks(column, Motion(dt, ax(t), ay=ay(t)), model)
    ]
    return np.array(slips)


def test_friction_is_a_cone():
    """Closed forms: a constant push along the diagonal, and two pulses a quarter of a period apart."""
    push = lambda t: np.where(t < 0.2 + 1e-9, -0.6 * g / math.sqrt(2.0), 0.0)  # noqa: E731
    slips = sliding(push, push, 0.6)
    # the record falls to zero over one sample: half of it belongs to the push
    length, last = 0.6 * g * 0.2005**2 / 2.0 * (0.6 / 0.3 - 1.0), slips[-1, 1:]
    assert np.hypot(*last) == pytest.approx(length, rel=3e-3)
    assert last[0] == pytest.approx(last[1], rel=1e-6)
    wave = lambda t: np.where((t >= 0) & (t <= 1.0), 0.8 * g * np.sin(2.0 * np.pi * t), 0.0)  # noqa: E731
    slips = sliding(wave, lambda t: wave(t - 0.25), 1.8)
    assert slips[-1, 1:] == pytest.approx([0.0719977, -0.3834036], abs=2e-3)


def free(column, omega, duration, step):
    """Free motion of a body without joint and gravity: axes over time, times, angular momentum drift, energies."""
    model = DistinctElement3D(time_step=step)
    block = engine_for(model, column).block(RunOptions(until_end=True))
    block.load(0, Case(column, Motion(duration, np.zeros(2))))
    block.records.joint["kn"][:] = block.records.joint["ks"][:] = 0.0
    block.lane["g"][:] = 0.0
    drum = block.records.body
    drum["z"][1, 0] = 10.0
    moments = np.array([column.drums[0].cross_inertia, column.drums[0].inertia, column.drums[0].axial_inertia])
    for c, name in enumerate("xyz"):
        drum["l" + name][1, 0], drum["w" + name][1, 0] = moments[c] * omega[c], omega[c]
    kinetic, axes, times = [], [block.records.axes(0)[0]], [0.0]
    while block.feed["step"][0, 0] < block.steps[0]:
        # a body that turns over in the air has not collapsed
        block.watch["status"][0, 0], block.lane["dt"][0, 0] = RUNNING, block.dt[0]
        block.advance(1)
        times.append(block.time(0))
        axes.append(block.records.axes(0)[0])
        momentum = np.array([drum["l" + c][1, 0] for c in "xyz"]) @ axes[-1]
        kinetic.append(0.5 * float((momentum**2 / moments).sum()))
    return np.array(times), np.array(axes), np.array(kinetic), moments


def test_free_rotation_of_a_square_prism_is_exact():
    """Precession of a body with two equal moments: exact at any step."""
    column = Column.of_drums([Drum(1.0, 0.5, 0.5, 2000.0, depth=0.5)], Joint(1e8, 1e8, 35.0))
    omega = np.array([0.3, 0.0, 2.0])
    times, axes, kinetic, moments = free(column, omega, 2.0, 1e-3)
    a, c = moments[0], moments[2]
    momentum = np.array([a * 0.3, 0.0, c * 2.0])
    rate, axis = np.linalg.norm(momentum) / a, momentum / np.linalg.norm(momentum)
    k = np.array([0.0, 0.0, 1.0])
    turn = rate * times[:, None]
    exact = k * np.cos(turn) + np.cross(axis, k) * np.sin(turn) + axis * (axis @ k) * (1 - np.cos(turn))
    assert np.abs(axes[:, :, 2] - exact).max() < 1e-12
    assert np.abs(kinetic / kinetic[0] - 1.0).max() < 1e-12


def test_free_rotation_of_a_slab_about_its_middle_axis():
    """The slab turns over at the exact times; energy stays bounded and falls with the square of the step."""
    column = Column.of_drums([Drum(0.4, 0.6, 0.6, 384.0 / 0.24, depth=1.0)], Joint(1e8, 1e8, 35.0))
    moments = [column.drums[0].cross_inertia, column.drums[0].inertia, column.drums[0].axial_inertia]
    assert sorted(moments) == pytest.approx([16.64, 37.12, 43.52], rel=1e-12)
    order = np.argsort(moments)  # small, middle, large in the exact solution
    omega = np.zeros(3)
    omega[order] = (-0.01, 3.0, 0.01)  # y, x and z are left-handed
    errors = []
    for step in (1e-3, 5e-4):
        _, axes, kinetic, inertia = free(column, omega, 10.0, step)
        errors.append(np.abs(kinetic / kinetic[0] - 1.0).max())
    momentum = np.array([moments[c] * omega[c] for c in range(3)])
    end = (momentum @ axes[-1] / inertia)[order]
    assert np.abs(end) == pytest.approx([0.1141247, 2.9959416, 0.1261485], abs=2e-5)
    assert errors[0] < 1e-6
    assert 3.0 < errors[0] / errors[1] < 5.0


@pytest.mark.parametrize(
    ("drums", "options", "limit"), [(1, {}, 2e-2), (3, {}, 1e-2), (3, {"stiffness_damping": 1e-4}, 1e-2)]
)
def test_the_ledger_closes_to_second_order(drums, options, limit):
    motions = [both_ways(a, 0.7 * a, duration=2.0) for a in np.linspace(0.22, 0.26, 32)]
    means = []
    for share in (0.8, 0.4):
        table = simulate_many(prism(drums, 0.7), motions, DistinctElement3D(step_factor=share, **options))
        means.append(float(np.sqrt((table["energy_imbalance"] ** 2).mean())))
    assert means[0] < limit
    assert means[0] / means[1] > 2.8


def test_a_batch_has_the_bits_of_single_runs():
    cases = [
        (prism(2), both_ways(0.25, 0.1)),
        (prism(3, 0.5), both_ways(0.2, 0.2)),
        (prism(2, 0.6), harmonic(1.0, g, 1.0)),
    ]
    table = simulate_many([c for c, _ in cases] * 7, [m for _, m in cases] * 7, DistinctElement3D(), threads=2)
    for (column, motion), (_, row) in zip(cases, table.iterrows(), strict=False):
        alone = simulate_many(column, [motion], DistinctElement3D()).iloc[0]
        for name in (
            "outcome",
            "peak_top_displacement_m",
            "residual_joint_slip_m",
            "energy_imbalance",
            "collapse_time_s",
        ):
            assert row[name] == alone[name] or (row[name] != row[name] and alone[name] != alone[name])
    for i, j in itertools.product(range(3), range(1, 7)):
        assert table["peak_top_displacement_m"][i] == table["peak_top_displacement_m"][i + 3 * j]


def test_release_about_a_corner_and_about_an_edge():
    """Quarter period of a rigid prism about its edge: θ̈ = −p² sin(α − θ), to the joint's flexibility."""
    column = prism(joint=Joint(5e12, 2.5e12, friction_coefficient=0.7))
    from scipy.integrate import solve_ivp

    def quarter(radius_to_edge, inertia):
        alpha, size = math.atan2(radius_to_edge, 2.5), math.hypot(radius_to_edge, 2.5)
        p2 = column.mass * g * size / (inertia + column.mass * size**2)
        upright = lambda _, y: y[0]  # noqa: E731
        upright.terminal = True
        rates = lambda _, y: (y[1], -p2 * math.sin(alpha - y[0]))  # noqa: E731
        return solve_ivp(rates, (0.0, 5.0), (0.05, 0.0), events=upright, rtol=1e-10, atol=1e-12).t[-1]

    for azimuth, reach in ((0.0, SIDE / 2.0), (math.pi / 4, SIDE / math.sqrt(2.0))):
        exact = quarter(reach, column.drums[0].inertia)
        times, leans = [], []
        for block in blocks(column, Motion(1.5 * exact, np.zeros(2)), start=Start(0.05, azimuth)):
            times.append(block.time(0))
            leans.append(
                float(
                    block.records.body["kx"][1, 0] * math.cos(azimuth)
                    + block.records.body["ky"][1, 0] * math.sin(azimuth)
                )
            )
        i = int(np.argmax(np.array(leans) < 0.0))
        crossing = times[i - 1] + (times[i] - times[i - 1]) * leans[i - 1] / (leans[i - 1] - leans[i])
        assert crossing == pytest.approx(exact, rel=1e-3)


def test_barrier_of_turned_and_offset_faces():
    column = prism(2)
    straight = flat_barrier(column, np.zeros((2, 2)))
    half, height, whole = SIDE / 2.0, 2.5, column.mass
    assert straight == pytest.approx(
        min(whole * g * (math.hypot(half, height) - height), 0.5 * whole * g * (math.hypot(half, 1.25) - 1.25))
    )
    offset = flat_barrier(column, np.array([(0.0, 0.0), (0.3, 0.0)]))
    assert 0.0 < offset < straight
    assert offset == pytest.approx(flat_barrier(column, np.array([(0.0, 0.0), (0.0, -0.3)])))
    assert flat_barrier(column, np.array([(0.0, 0.0), (0.5, 0.0)])) == 0.0
    assert flat_barrier(column, np.zeros((2, 2)), np.array([0.0, 0.0, 0.3])) < straight
    assert flat_barrier(column, np.zeros((2, 2)), np.array([0.0, 0.3, 0.3])) == pytest.approx(straight)


def reach(corners, toward):
    """How far a convex polygon goes from the origin in a direction."""
    side = np.roll(corners, -1, axis=0) - corners
    outward = np.stack((side[:, 1], -side[:, 0]), axis=1)[np.hypot(*side.T) > 1e-12]
    level = (outward * corners[np.hypot(*side.T) > 1e-12]).sum(axis=1)
    ahead = outward @ toward > 1e-12
    return float((level[ahead] / (outward[ahead] @ toward)).min())


@pytest.mark.parametrize(
    ("sides", "twist", "missing"),
    [((1.0, 1.0), 1.0, 0.009), ((1.0, 1.0), 5.0, 0.045), ((1.0, 1.0), 20.0, 0.187), ((1.0, 1.0), 45.0, 0.293),
     ((1.0, 0.5), 1.0, 0.017), ((1.0, 0.5), 5.0, 0.089), ((1.0, 0.5), 20.0, 0.348), ((1.0, 0.5), 45.0, 0.561)],
)  # fmt: skip
def test_how_much_of_the_overlap_of_turned_faces_is_missing(sides, twist, missing):
    """The joint opens where the four places end: nearer than the overlap's rim, by what the theory page says."""
    half = 0.5 * np.array(sides)
    c, s = math.cos(math.radians(twist)), math.sin(math.radians(twist))
    corners = half * np.array([(1, -1), (1, 1), (-1, 1), (-1, -1)])
    turned = corners @ np.array([(c, s), (-s, c)])
    overlap = np.clip(turned, -half, half)
    angles = np.radians(np.arange(0.0, 180.0, 0.05))
    ways = np.stack((np.cos(angles), np.sin(angles)), axis=1)
    four = np.array([reach(overlap, way) for way in ways])
    true = np.array([min(reach(corners, way), reach(turned, way)) for way in ways])
    assert (four < true * (1.0 + 1e-12)).all()
    worst = int(np.argmin(four / true))
    assert 1.0 - four[worst] / true[worst] == pytest.approx(missing, abs=6e-4)
    if twist != 20.0:
        return
    drum = Drum(1.5, sides[0], sides[0], 2000.0, "rectangular", sides[1])
    wide = Drum(1.5, 4.0, sides[0], 2000.0, "rectangular", 4.0, sides[1])
    column = Column.of_drums([wide, drum], Joint(2e11, 1e11, friction_coefficient=0.9))
    column = column.replace(as_found=AsFound((FoundDrum(2, turn=twist),)))
    # the upper drum alone, 0.75 m to its middle
    rise = np.concatenate((np.linspace(0.0, 1.0, 100), np.ones(20))) * -g * four[worst] / 0.75
    motions = [Motion(0.01, *(share * rise * component for component in ways[worst])) for share in (0.97, 1.03)]
    below, above = simulate_many([column] * 2, motions, DistinctElement3D())["peak_joint_opening_m"]
    assert above > 1e-5 > 10.0 * below


def test_a_turned_drum_on_another_stands_and_carries_its_weight_straight():
    """Turned by 45° against the drum below: the joint still carries the weight without a push sideways."""
    column = prism(2)
    for block in blocks(column, Motion(0.5, np.zeros(2))):
        if block.time(0) == 0.0:
            drum, c = block.records.body, math.cos(0.25 * math.pi)
            for name, value in (("ix", c), ("iy", c), ("jx", -c), ("jy", c)):
                drum[name][2, 0] = value
    assert not block.is_over(0) or block.collect(0).outcome != "collapsed"
    assert abs(float(drum["x"][2, 0])) < 1e-12
    assert float(drum["kz"][2, 0]) == pytest.approx(1.0, abs=1e-12)


def test_a_restitution_chooses_the_damping_of_a_rectangular_column():
    weak, strong = (DistinctElement3D(restitution=e).damping(prism()) for e in (0.975, 0.966))
    assert 0.0 < weak < strong < 3e-3


def test_a_square_column_that_tapers_both_ways_moves_alike_along_x_and_along_y():
    """Eight blocks of a square pyramid; a quarter turn of the motion is a quarter turn of the response.

    Impacts multiply the rounding: 1e-16 m has become 1e-9 m after 0.35 s, 1e-8 m after 0.6 s.
    """
    column = Column.tapered(
        height=5.95, bottom_width=1.11, top_width=0.9, drums=8, density=2620.0, joint=Joint(1e10, 1e10, 35.0), depth=1.11,
        top_depth=0.9,
    )  # fmt: skip
    t = np.arange(351) * 1e-3
    pulse = 0.35 * g * np.sin(2.0 * np.pi * t)
    along, across = path(column, Motion(1e-3, pulse)), path(column, Motion(1e-3, np.zeros(351), ay=pulse))
    assert np.abs(along[..., 0]).max() > 1e-2
    assert np.abs(along[..., 1]).max() < 1e-15
    assert np.abs(across[..., 1] - along[..., 0]).max() < 1e-8
    assert np.abs(across[..., 2] - along[..., 2]).max() < 1e-8
