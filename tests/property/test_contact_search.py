"""Plane contacts: the kernel's forces against a brute-force search in world axes, on random poses of two faces."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from stylobate.kernels.run_codes import LANES
from stylobate.models.drums.records import Topology, contact_points
from stylobate.models.plane.columns import Records
from stylobate.models.plane.packing import point_law

KN, KS, MU, COHESION, DT = 3.0e10, 1.1e10, 0.6, 2.0e4, 1e-5


def rotation(angle):
    return np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


class Face:
    """One face of a drum as a segment in world axes: ends, tangent (to the right), normal (upward).

    ``reach`` are the ways from the foot of the centroid to the left and to the right end.
    """

    def __init__(self, centroid, angle, reach, offset):
        turn = rotation(angle)
        self.tangent, self.normal = turn @ [1.0, 0.0], turn @ [0.0, 1.0]
        middle = np.asarray(centroid) + offset * self.normal
        self.left, self.right = middle - reach[0] * self.tangent, middle + reach[1] * self.tangent

    def across(self, point, direction):
        """Where a ray from ``point`` along ``direction`` meets the face: share of the way left → right, or None."""
        along = self.right - self.left
        bottom = cross(along, direction)
        if abs(bottom) < 1e-12:
            return None
        share = cross(point - self.left, direction) / bottom
        return share if 0.0 <= share <= 1.0 else None


def faces(pose):
    """The upper drum's lower face and the lower drum's upper face of a pose."""
    upper = Face(pose["xu"], pose["au"], (pose["bl"], pose["br"]), -pose["hb"])
    return upper, Face(pose["xl"], pose["al"], (pose["w"], pose["w"]), pose["ht"])


def overlap_ends(upper, lower):
    """Contacts at both ends of the overlap: (place along the lower face, point, gap, normal), or [] without overlap.

    Every corner of one face is tried against the other segment, seen along the lower face's normal; of those that meet
    it, the outermost two are the ends. The contact is at the corner, normal and gap are those of the segment.
    """
    contacts = []
    for corner in (upper.left, upper.right):
        if lower.across(corner, lower.normal) is not None:
            gap = (corner - lower.left) @ lower.normal
            contacts.append(((corner - lower.left) @ lower.tangent, corner, gap, lower.normal))
    for corner in (lower.left, lower.right):
        if upper.across(corner, lower.normal) is not None:
            gap = (upper.left - corner) @ upper.normal
            contacts.append(((corner - lower.left) @ lower.tangent, corner, gap, upper.normal))
    contacts.sort(key=lambda contact: contact[0])
    return [contacts[0], contacts[-1]] if len(contacts) >= 2 else []


def joint_contacts(upper, lower, points):
    """All contacts of a joint, and the length of the overlap."""
    ends = overlap_ends(upper, lower)
    if not ends or (upper.right - upper.left) @ lower.tangent <= 0.0:
        return [], 0.0
    length = ends[1][0] - ends[0][0]
    contacts = [ends[0]]
    for xi in contact_points("rectangular", points)[0][1:-1]:
        place = ends[0][0] + 0.5 * (1.0 + xi) * length
        point = lower.left + place * lower.tangent
        share = upper.across(point, lower.normal)
        above = upper.left + share * (upper.right - upper.left)
        contacts.append((place, point, (above - point) @ lower.normal, lower.normal))
    return [*contacts, ends[1]], length


def expected(pose, points):
    """Force on the upper drum, its moments about the upper and about the lower centroid, fn and fs of all points."""
    upper, lower = faces(pose)
    contacts, length = joint_contacts(upper, lower, points)
    force, on_upper, on_lower = np.zeros(2), 0.0, 0.0
    fn, fs = np.zeros(points), np.zeros(points)
    shares = contact_points("rectangular", points)[1]
    spin = lambda omega, arm: omega * np.array([-arm[1], arm[0]])  # noqa: E731
    for p, (_, point, gap, normal) in enumerate(contacts):
        tangent = np.array([normal[1], -normal[0]])
        area = length * shares[p]
        velocity = pose["vu"] + spin(pose["wu"], point - pose["xu"]) - pose["vl"] - spin(pose["wl"], point - pose["xl"])
        fn[p] = max(0.0, -KN * area * gap)
        limit = MU * fn[p] + (COHESION * area if fn[p] > 0.0 else 0.0)
        fs[p] = np.clip(pose["fs"][p] - KS * area * (velocity @ tangent) * DT, -limit, limit)
        f = fn[p] * normal + fs[p] * tangent
        force += f
        on_upper += cross(point - pose["xu"], f)
        on_lower += cross(point - pose["xl"], f)
    return force, on_upper, on_lower, fn, fs


def kernel_forces(poses, points):
    """The kernel's answer for LANES poses at once: records of bodies, of the joint and of its load after one call."""
    records = Records(point_law(points, False, LANES, False), Topology(2, ((0, 1),)))
    drum, joint, lane = records.body, records.joint, records.lane
    places, shares = contact_points("rectangular", points)
    lane["xi"][0], lane["sh"][0] = places[:, None], shares[:, None]
    lane["dt"][0] = DT
    joint["kn"], joint["ks"], joint["co"], joint["mu"] = KN, KS, COHESION, MU
    for l, pose in enumerate(poses):
        for i, (x, angle, v, omega) in enumerate([("xl", "al", "vl", "wl"), ("xu", "au", "vu", "wu")]):
            drum["x"][i, l], drum["z"][i, l] = pose[x]
            drum["th"][i, l] = pose[angle]
            frame = pose[angle] - (pose["lean"] if i == 0 else 0.0)
            drum["c"][i, l], drum["s"][i, l] = math.cos(frame), math.sin(frame)
            drum["vx"][i, l], drum["vz"][i, l] = pose[v]
            drum["w"][i, l] = pose[omega]
        joint["lc"][0, l], joint["ls"][0, l] = math.cos(pose["lean"]), math.sin(pose["lean"])
        for name, value in {"wl": "w", "wr": "w", "ht": "ht", "bl": "bl", "br": "br", "hb": "hb"}.items():
            joint[name][0, l] = pose[value]
        joint["fs"][0, :, l] = pose["fs"][:points]
    records.kernel.gather(records.state)
    return drum, joint, records.load


def random_poses(seed, steep, deep):
    """LANES poses: unequal and lopsided faces, lower drum anywhere, its upper face inclined to its axes in every other
    pose, the upper drum slid up to past both edges, opened up to ``steep``.

    The deepest corner of either face within the overlap is put at a gap between −deep and +deep / 4.
    """
    rng = np.random.default_rng(seed)
    poses = []
    while len(poses) < LANES:
        b, w = rng.uniform(0.2, 1.5, 2)
        if rng.random() < 0.2:
            w = b
        al = rng.uniform(-1.2, 1.2)
        opened = rng.choice([rng.uniform(-steep, steep), rng.normal(0.0, 1e-3), 0.0], p=[0.6, 0.3, 0.1])
        pose = {
            "bl": b, "br": b * rng.choice([1.0, rng.uniform(0.5, 1.5)]), "lean": rng.choice([0.0, rng.uniform(-0.5, 0.5)]),
            "w": w, "hb": rng.uniform(0.1, 2.0), "ht": rng.uniform(0.1, 2.0), "al": al, "au": al + opened,
            "xl": rng.uniform(-5.0, 5.0, 2), "xu": np.zeros(2), "vl": rng.normal(0.0, 1.0, 2),
            "vu": rng.normal(0.0, 1.0, 2), "wl": rng.normal(0.0, 2.0), "wu": rng.normal(0.0, 2.0),
            "fs": rng.normal(0.0, 2e5, 8),
        }  # fmt: skip
        slid = rng.uniform(-1.1, 1.1) * (b * math.cos(opened) + w) * rng.choice([1.0, 0.05])
        middle = pose["xl"] + rotation(al) @ [slid, pose["ht"]]
        pose["xu"] = middle + rotation(pose["au"]) @ [0.0, pose["hb"]]
        ends = overlap_ends(*faces(pose))
        if ends:
            lift = rng.uniform(-deep, 0.25 * deep) - min(ends[0][2], ends[1][2])
            pose["xu"] = pose["xu"] + lift * (rotation(al) @ [0.0, 1.0])
        poses.append(pose)
    return poses


@pytest.mark.parametrize("points", [2, 3, 5])
@given(
    seed=st.integers(0, 2**32 - 1), steep=st.sampled_from([0.02, 0.3, math.radians(80.0)]),
    deep=st.sampled_from([1e-6, 1e-4, 1e-3]),
)  # fmt: skip
@example(seed=1, steep=math.radians(80.0), deep=1e-3)
@settings(max_examples=60, deadline=None)
def test_forces_and_moments_agree_with_brute_force(points, seed, steep, deep):
    poses = random_poses(seed, steep, deep)
    _, joint, load = kernel_forces(poses, points)
    for l, pose in enumerate(poses):
        force, on_upper, on_lower, fn, fs = expected(pose, points)
        # rounding of a gap of coordinates of some metres, times the stiffness
        scale = KN * 3.0 * 4e-15 + 1e-9 * (np.abs(fn).sum() + np.abs(fs).sum())
        np.testing.assert_allclose(joint["fn"][0, :, l], fn, rtol=1e-9, atol=scale)
        np.testing.assert_allclose(joint["fs"][0, :, l], fs, rtol=1e-9, atol=scale)
        np.testing.assert_allclose([load["fx"][0, l], load["fz"][0, l]], force, rtol=0, atol=3 * points * scale)
        np.testing.assert_allclose(load["mu_"][0, l], on_upper, rtol=0, atol=20 * points * scale)
        np.testing.assert_allclose(load["ml"][0, l], on_lower, rtol=0, atol=20 * points * scale)


def test_the_poses_reach_every_kind_of_contact():
    """The comparison above means something: each kind of contact at each end occurs often and carries force."""
    seen = {"left upper corner": 0, "left lower corner": 0, "right upper corner": 0, "right lower corner": 0, "none": 0}
    for seed in range(40):
        for pose in random_poses(seed, math.radians(80.0), 1e-3):
            upper, lower = faces(pose)
            ends = overlap_ends(upper, lower)
            if not ends:
                seen["none"] += 1
            for name, contact in zip(("left", "right"), ends, strict=False):
                if contact[2] < 0.0:
                    of_lower = any(np.array_equal(contact[1], corner) for corner in (lower.left, lower.right))
                    corner = "lower" if of_lower else "upper"
                    seen[f"{name} {corner} corner"] += 1
    assert min(seen.values()) > 20, seen


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=40, deadline=None)
def test_gap_is_the_distance_to_the_nearest_feature(seed):
    """Where no two corners meet, the depth of a closed contact is the plain distance of corner and segment."""
    for pose in random_poses(seed, math.radians(80.0), 1e-3):
        upper, lower = faces(pose)
        for corner, face, sign in (
            (upper.left, lower, 1.0), (upper.right, lower, 1.0), (lower.left, upper, -1.0), (lower.right, upper, -1.0),
        ):  # fmt: skip
            length = np.linalg.norm(face.right - face.left)
            along = (corner - face.left) @ face.tangent
            depth = -sign * (corner - face.left) @ face.normal
            if not (0.01 * length < along < 0.99 * length and 1e-7 < depth < 1.1e-3):
                continue
            alone = pose | {"vu": np.zeros(2), "vl": np.zeros(2), "wu": 0.0, "wl": 0.0, "fs": np.zeros(8)}
            _, joint, _ = kernel_forces([alone] * LANES, 2)
            over = joint["over"][0, 0]
            end = 0 if corner is upper.left or corner is lower.left else 1
            assert joint["fn"][0, end, 0] == pytest.approx(0.5 * KN * over * depth, rel=1e-6)


@pytest.mark.parametrize("points", [2, 3, 5])
@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=40, deadline=None)
def test_action_and_reaction_share_a_line(points, seed):
    """Moments about the origin: what the joint gives the upper drum it takes from the lower one."""
    drum, _, load = kernel_forces(random_poses(seed, math.radians(80.0), 1e-3), points)
    fx, fz = load["fx"][0], load["fz"][0]
    upper = load["mu_"][0] + drum["x"][1] * fz - drum["z"][1] * fx
    lower = load["ml"][0] + drum["x"][0] * fz - drum["z"][0] * fx
    scale = (np.abs(fx) + np.abs(fz)) * 10.0 + 1.0
    assert (np.abs(upper - lower) <= 1e-11 * scale + 1e-12 * KN * 1e-3).all()


@pytest.mark.parametrize("tilt", [0.0, 1e-3, -1e-3, 0.05])
@pytest.mark.parametrize("lower_angle", [0.0, 0.4])
def test_force_is_continuous_when_a_drum_slides_over_an_edge(tilt, lower_angle):
    """The corner of the upper face passes the lower edge at constant depth: the contact changes hands without a jump.

    Face to face the force is that of the shrinking overlap. At a relative rotation θ the normal turns by θ at the
    passage, so that the force may jump by |θ| of its size, and by no more.
    """
    b, w, depth, steps = 0.4, 0.5, 1e-4, 4000
    slid = np.linspace(0.0, 0.2, steps)
    poses = []
    for s in slid:
        centre = rotation(lower_angle) @ [-s, 1.0]
        corner_up = b * abs(math.sin(tilt))
        pose = {
            "bl": b, "br": b, "lean": 0.0, "w": w,
            "hb": 0.7, "ht": 1.0, "al": lower_angle, "au": lower_angle + tilt, "xl": np.zeros(2),
            "vl": np.zeros(2), "vu": np.zeros(2), "wl": 0.0, "wu": 0.0, "fs": np.zeros(8),
        }  # fmt: skip
        # the lowest place of the upper face within the lower one stays at −depth
        past = max(0.0, s + b * math.cos(tilt) - w) if tilt > 0.0 else 0.0
        up = corner_up - past * math.tan(abs(tilt)) - depth
        middle = centre + rotation(lower_angle) @ [0.0, up]
        pose["xu"] = middle + rotation(pose["au"]) @ [0.0, 0.7]
        poses.append(pose)
    size, jump, last = 0.0, 0.0, None
    for k in range(0, steps, LANES):
        _, _, load = kernel_forces(poses[k : k + LANES], 2)
        for l in range(LANES):
            now = np.array([load["fx"][0, l], load["fz"][0, l]])
            if tilt == 0.0:
                overlap = min(2 * b, b + w - slid[k + l])
                assert np.linalg.norm(now) == pytest.approx(KN * overlap * depth, rel=1e-8)
            if last is not None:
                jump = max(jump, np.linalg.norm(now - last))
            last, size = now, max(size, np.linalg.norm(now))
    assert jump <= (abs(tilt) * 1.01 + 3e-4) * size
    if abs(tilt) <= 1e-3 and tilt != 0.0:
        assert jump > 0.0
