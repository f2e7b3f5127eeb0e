"""Round drums with a chip: the law against quadrature of its rim, what opens a joint, turns, mirrors, energy, verdicts."""

import math

import numpy as np
import pytest
from validation.space import cylinder, round_column

import stylobate as st
from stylobate.column.found_geometry import rotation
from stylobate.kernels.dem3d.rim import press_chord
from stylobate.models.base import Case, RunOptions
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.engine import engine_for
from stylobate.motion import Motion

AZIMUTH = 30.0


def chipped(chip=0.08, azimuth=AZIMUTH, column=None, **fields):
    """A column whose lowest drum has lost a segment."""
    drum = st.FoundDrum(1, chip_right=chip, chip_azimuth=azimuth, **fields)
    return (column or round_column()).replace(as_found=st.AsFound((drum,)))


def block_of(column, options=None, **model):
    model = DistinctElement3D(**model)
    return engine_for(model, column).block(options or RunOptions())


def by_quadrature(ru, rl, chip, c, n, e, count=40_000):
    """Force on the upper face [N] and its moment about the middle of the lower one [N m], over k_n, by points round the rim.

    ``c`` is the middle of the upper face, ``n`` its normal and ``e`` the direction of the chip in it, in the frame of the
    lower face.
    """
    z = np.array([0.0, 0.0, 1.0])
    h = n * (1.0, 1.0, 0.0)
    sine, cosine = np.linalg.norm(h), n[2]
    h = h / sine
    t = np.cross(z, h)
    d = cosine * h - sine * z
    ce, se = e @ d, e @ t
    flat_e, flat_f = ce * h + se * t, -se * h + ce * t
    ra, reach, wide = ru * cosine, ru - chip, math.sqrt(chip * (2.0 * ru - chip))
    middle = c * (1.0, 1.0, 0.0)
    # what of each line lies on the rim of the overlap, seen along z
    phi = (np.arange(count) + 0.5) * (2.0 * math.pi / count)
    cos, sin = np.cos(phi)[:, None], np.sin(phi)[:, None]
    upper, lower = c + ru * (cos * d + sin * t), rl * (cos * h + sin * t)
    seen = middle + ra * (cos * h + sin * t)
    on_upper = (np.linalg.norm(seen, axis=1) < rl) & ((cos * ce + sin * se)[:, 0] * ru < reach)
    beside = lower - middle
    on_lower = (np.linalg.norm(beside, axis=1) < ra) & (beside @ flat_e < reach * cosine)
    y = (np.arange(count) + 0.5) * (2.0 * wide / count) - wide
    along = c + reach * e + y[:, None] * (-se * d + ce * t)
    seen = middle + cosine * (reach * flat_e + y[:, None] * flat_f)
    on_chord = np.linalg.norm(seen, axis=1) < rl
    # area of the overlap, by strips across e
    x = (np.arange(count) + 0.5) * (2.0 * ra / count) - ra
    keep = x < reach * cosine
    x = x[keep]
    half, off = np.sqrt(ra * ra - x * x), middle @ flat_f
    below = np.sqrt(np.maximum(rl * rl - (x + middle @ flat_e) ** 2, 0.0))
    area = np.maximum(np.minimum(half, below - off) - np.maximum(-half, -below - off), 0.0).sum() * 2.0 * ra / count
    each = np.array([2.0 * math.pi / count, 2.0 * math.pi / count, 2.0 * wide / count])
    rim = (ra * on_upper.sum(), rl * on_lower.sum(), cosine * on_chord.sum()) @ each
    force, moment = np.zeros(3), np.zeros(3)
    lines = (
        (upper, on_upper, -upper[:, 2], z, ru * each[0]),
        (lower, on_lower, (lower - c) @ n, n, rl * each[1]),
        (along, on_chord, -along[:, 2], z, each[2]),
    )
    for place, on, depth, normal, length in lines:
        pressure = np.where(on, np.maximum(depth, 0.0), 0.0) * (length * area / rim)
        force += pressure.sum() * normal
        moment += np.cross(pressure @ place, normal)
    return force, moment


def test_the_law_is_that_of_points_round_the_rim():
    """Random poses of a drum with a small or a large chip, off the middle of one of about its size, flat or on an edge."""
    rng = np.random.default_rng(7)
    column = chipped(column=round_column(2))
    column = column.replace(as_found=st.AsFound((st.FoundDrum(2, chip_right=0.1),)))
    block = block_of(column)
    block.load(0, Case(column, Motion(0.1, np.zeros(2))))
    for records in (block.records.body, block.records.joint, block.lane):
        for name in records.dtype.names:
            records[name][...] = records[name][..., :1]
    block.lane["dt"] = 0.0
    for name in "st":
        block.records.joint[name][...] = 0.0
    ru = float(block.records.body["rb"][2, 0])
    ht = float(block.records.body["ht"][1, 0])
    kn = float(block.records.joint["kn"][1, 0])
    poses = []
    for lane in range(block.lanes):
        rl, chip = ru * rng.uniform(0.9, 1.4), ru * rng.choice((1e-3, 0.1, 0.5, 1.2))
        tilt, azimuth, turn, slip, over = rng.uniform((0, 0, 0, 0, 0), (0.1, 6.3, 6.3, 0.3 * ru, 6.3))
        tilt = tilt if lane % 4 else 1e-5
        axes = rotation(np.array([-math.sin(azimuth), math.cos(azimuth), 0.0]), tilt) @ rotation(
            np.array([0.0, 0.0, 1.0]), turn
        )
        c = np.array([slip * math.cos(over), slip * math.sin(over), rng.uniform(-0.5, 0.7) * ru * tilt - 1e-6])
        poses.append((rl, chip, c, axes[:, 2], axes[:, 0]))
        block.records.body["rt"][1, lane] = rl
        angle = math.acos(1.0 - chip / ru)
        block.records.joint["chip"][1, :, lane] = 1.0, 0.0, 0.0, angle, math.cos(angle), math.sin(angle)
        lower = np.array([block.records.body[name][1, lane] for name in "xyz"])
        for a, axis in enumerate("ijk"):
            for b, name in enumerate("xyz"):
                block.records.body[axis + name][1, lane], block.records.body[axis + name][2, lane] = (
                    float(a == b),
                    axes[b, a],
                )
        foot = axes @ [block.records.body[name][2, lane] for name in ("fx", "fy", "fz")]
        for b, name in enumerate("xyz"):
            block.records.body[name][2, lane] = lower[b] + ht * (b == 2) + c[b] - foot[b]
    block.records.kernel.forces(block.records.state)
    loaded = 0
    for lane, (rl, chip, c, n, e) in enumerate(poses):
        force, moment = by_quadrature(ru, rl, chip, c, n, e)
        actual_force = block.records.load["f"][1, :, lane] / kn
        # the moment on the lower drum, about its centroid: from the middle of its upper face
        turned = -block.records.load["lo"][1, :, lane] / kn - np.cross((0.0, 0.0, ht), actual_force)
        scale = max(np.linalg.norm(force), 1e-9)
        assert np.abs(actual_force - force).max() < 1e-3 * scale, lane
        assert np.abs(turned - moment).max() < 1e-3 * scale * ru, lane
        loaded += np.linalg.norm(force) > 0.0
    assert loaded > 12


def test_a_chord_without_pressure_has_no_moments_either():
    """Rounding must not leave a spread of a pressure that is none: friction would grow beyond all bounds on landing."""
    rng = np.random.default_rng(1)
    empty = 0
    for _ in range(2000):
        low, high = np.sort(rng.uniform(-0.5, 0.5, 2))
        slope = rng.choice((-1.0, 1.0)) * 10.0 ** rng.uniform(-16.0, -1.0)
        depth = -slope * rng.choice((low, high)) * (1.0 + rng.choice((0.0, 1e-15, 1e-3, -1e-3)))
        n, first, second, square, *_ = press_chord(depth, slope, low, high)
        far = max(abs(low), abs(high))
        assert abs(first) <= far * n
        assert 0.0 <= second <= far * far * n
        assert square >= 0.0
        empty += n == 0.0
    assert empty > 100


def pushed(column, azimuths, levels):
    """Largest rotation [rad] under a ground that slowly takes up each acceleration [g]: the column turns to an azimuth."""
    rise = np.concatenate((np.linspace(0.0, 1.0, 100), np.ones(100))) * -st.g
    motions = [
        Motion(0.01, level * rise * math.cos(math.radians(azimuth)), level * rise * math.sin(math.radians(azimuth)))
        for azimuth, level in zip(azimuths, levels, strict=True)
    ]
    return st.simulate_many([column] * len(motions), motions, DistinctElement3D())["peak_rotation_rad"].to_numpy()


def test_a_chip_moves_the_pivot_within_its_segment_only():
    """The load leaves the face at the chord, (R − c)/cos ψ from the middle, and beyond it at the rim."""
    column = chipped(0.08, column=round_column(stiffness=5e12))
    radius, height = 0.5 * column.base_width, column.centroid_height
    half = math.acos(1.0 - 0.08 / radius)
    ways = (0.0, 0.6 * half, -1.3 * half, math.pi)
    arms = [(radius - 0.08) / math.cos(way) if abs(way) < half else radius for way in ways]
    azimuths = [AZIMUTH + math.degrees(way) for way in ways for _ in range(2)]
    turned = pushed(column, azimuths, [share * arm / height for arm in arms for share in (0.99, 1.01)]).reshape(-1, 2)
    assert (turned[:, 0] < 1e-3).all()
    assert (turned[:, 1] > 2e-3).all()
    assert column.uplift_acceleration == pytest.approx(st.g * (radius - 0.08) / height, rel=1e-9)


def shaken(angle=0.0, mirrored=1.0, duration=0.8):
    """Two directions at once, turned about z or seen in a mirror."""
    time = np.arange(round(duration * 500) + 1) * 2e-3
    x, y = 0.3 * st.g * np.sin(6.0 * time), mirrored * 0.2 * st.g * np.sin(8.0 * time)
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    return Motion(2e-3, c * x - s * y, s * x + c * y)


def places(column, motion):
    """Centroids of all drums every 32 steps, shape (T, 3, n)."""
    block = block_of(column, RunOptions(until_end=True))
    block.load(0, Case(column, motion))
    assert block.residual_acceleration(0) < 1e-6
    centroids = []
    while not block.is_over(0):
        block.advance(1)
        centroids.append(np.array([block.records.body[name][1:, 0] for name in "xyz"]))
    return np.array(centroids)


def test_turned_mirrored_and_all_but_whole():
    """The chip and the motion turned by 37° turn the response; so does a mirror; a chip that is none changes nothing."""
    first = places(chipped(), shaken())
    turned = places(chipped(azimuth=AZIMUTH + 37.0), shaken(37.0))
    c, s = math.cos(math.radians(37.0)), math.sin(math.radians(37.0))
    back = np.stack((c * turned[:, 0] + s * turned[:, 1], c * turned[:, 1] - s * turned[:, 0], turned[:, 2]), axis=1)
    assert np.abs(first - first[0]).max() > 0.02
    assert np.abs(back - first).max() < 1e-9
    mirrored = places(chipped(azimuth=-AZIMUTH), shaken(0.0, -1.0)) * np.array([1.0, -1.0, 1.0])[:, None]
    assert np.abs(mirrored - first).max() < 1e-9
    # left, and turned round
    other = round_column().replace(
        as_found=st.AsFound((st.FoundDrum(1, chip_left=0.08, chip_azimuth=AZIMUTH - 180.0),))
    )
    assert np.abs(places(other, shaken()) - first).max() < 1e-9
    whole = round_column().replace(as_found=st.AsFound((st.FoundDrum(1, offset=1e-12),)))
    nothing = places(chipped(1e-12), shaken())
    assert np.abs(nothing - places(whole, shaken())).max() < 1e-6
    assert np.abs(nothing - first).max() > 1e-5


def test_the_ledger_of_chipped_drums_closes():
    drums = (
        st.FoundDrum(1, chip_left=0.1, chip_azimuth=20.0),
        st.FoundDrum(2, offset=0.04, offset_azimuth=70.0, turn=10.0),
        st.FoundDrum(3, chip_right=0.06, chip_azimuth=-60.0, tilt=0.5, tilt_azimuth=50.0),
    )
    column = round_column(3).replace(as_found=st.AsFound(drums, 1.0, 30.0))
    response = st.simulate(column, shaken(), DistinctElement3D())
    assert response.provenance["residual_acceleration_at_start_m_s2"] < 1e-5
    assert response.measures.peak_joint_opening > 1e-3
    assert response.measures.energy_imbalance < 2e-3
    batch = st.simulate_many([column] * 2, [shaken()] * 2, DistinctElement3D())
    assert batch.iloc[1]["peak_top_displacement_m"] == response.measures.peak_top_displacement


def stiffness(column):
    """Normal stiffness of the closed lowest joint: closure, and two rotations about the middle of its face, shape (3, 3)."""
    block = block_of(column)
    block.load(0, Case(column, Motion(0.1, np.zeros(2))))
    for records in (block.records.body, block.records.joint, block.lane):
        for name in records.dtype.names:
            records[name][...] = records[name][..., :1]
    block.lane["dt"] = 0.0
    depth, turn, high = 1e-3, 1e-7, column.drums[0].centroid_height
    for lane, (down, x, y) in enumerate(((0.0, 0.0, 0.0), (1e-7, 0.0, 0.0), (0.0, turn, 0.0), (0.0, 0.0, turn))):
        axes = rotation(np.array([1.0, 0.0, 0.0]), x) @ rotation(np.array([0.0, 1.0, 0.0]), y)
        for b, name in enumerate("xyz"):
            block.records.body[name][1, lane] = high * axes[b, 2] - (depth + down) * (b == 2)
            for a, axis in enumerate("ijk"):
                block.records.body[axis + name][1, lane] = axes[b, a]
    block.records.kernel.forces(block.records.state)
    loads = np.array(
        [
            (
                block.records.load["f"][0, 2, lane],
                block.records.load["lo"][0, 0, lane],
                block.records.load["lo"][0, 1, lane],
            )
            for lane in range(4)
        ]
    )
    return (loads[1:] - loads[0]).T / 1e-7


def test_what_a_chip_leaves_is_nowhere_stiffer_than_the_whole_face():
    """The stable step is that of whole faces: the difference of the two stiffness matrices has no negative eigenvalue."""
    whole = stiffness(chipped(1e-9, 0.0, cylinder(1.0, 0.5)))
    area = 0.25 * math.pi * 5e10
    assert whole == pytest.approx(np.diag((area, area / 8.0, area / 8.0)), rel=1e-4, abs=1e-4 * area)
    for chip in (0.01, 0.1, 0.3, 0.45):
        less = stiffness(chipped(chip, 0.0, cylinder(1.0, 0.5)))
        assert np.linalg.eigvalsh(whole - 0.5 * (less + less.T)).min() > -1e-6 * area
        # its middle has moved away from the chip
        assert less[2, 0] < 0.0


def test_a_drum_that_only_tips_over_its_chord_has_not_slipped():
    """Slip is read where the faces are closest: at the chord, not where the rim was."""
    column = chipped(0.2, 0.0, cylinder(1.0, 2.0))
    block = block_of(column)
    block.load(0, Case(column, Motion(0.1, np.zeros(2))))
    tilt, pivot = 0.1, np.array([0.3, 0.0, 0.0])
    for way in (0.0, 0.02):  # about the chord, and a little beside it
        axes = rotation(np.array([0.0, 0.0, 1.0]), way) @ rotation(np.array([0.0, 1.0, 0.0]), tilt)
        axes = axes @ rotation(np.array([0.0, 0.0, 1.0]), -way)
        edge = pivot if way == 0.0 else np.array([0.3, 0.4, 0.0])
        place = edge + axes @ (np.array([0.0, 0.0, column.centroid_height]) - edge)
        for b, name in enumerate("xyz"):
            block.records.body[name][1, 0] = place[b]
            for a, axis in enumerate("ijk"):
                block.records.body[axis + name][1, 0] = axes[b, a]
        _, slip, _ = block.records.joints(0)
        assert np.abs(slip[0]).max() < 1e-6
