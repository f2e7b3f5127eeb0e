"""A specimen of any shape on the base: against the rectangular column, itself, and closed forms; bad input."""

import math

import numpy as np
import pytest

import stylobate as st
from stylobate.models.base import Case, RunOptions
from stylobate.models.engine import engine_for

JOINT = st.Joint(5e10, 2.5e10, friction_coefficient=0.7)
SIDE, HEIGHT, DENSITY = 0.81, 5.0, 1600.0


def moments(a, b, h, mass):
    return np.array([b * b + h * h, a * a + h * h, a * a + b * b]) * mass / 12.0


def box(a=SIDE, b=SIDE, h=HEIGHT, turned=0.0):
    """A box as a specimen, its vertices and inertia in axes that are turned about z."""
    c, s = math.cos(turned), math.sin(turned)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    corners = 0.5 * np.array([(x * a, y * b, z * h) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    mass = a * b * h * DENSITY
    inertia = turn @ np.diag(moments(a, b, h, mass)) @ turn.T
    return st.Specimen(mass, inertia, corners @ turn.T, "box", JOINT)


def boulder(seed=3, points=60):
    """A convex body with a flat foot and principal axes that are askew."""
    rng = np.random.default_rng(seed)
    vertices = rng.normal(size=(points, 3))
    vertices *= 0.4 / np.linalg.norm(vertices, axis=1)[:, None]
    vertices[:, 2] *= 1.6
    vertices[:, 2] = np.maximum(vertices[:, 2], -0.45)
    inertia = np.array([[21.3, -1.5, -2.0], [-1.5, 18.6, -0.8], [-2.0, -0.8, 16.3]])
    return st.Specimen(350.0, inertia, vertices, "boulder", JOINT)


def path(structure, motion, model):
    block = engine_for(model, structure).block(RunOptions(until_end=True))
    block.load(0, Case(structure, motion))
    centroids = [np.array([block.records.body[c][1, 0] for c in "xyz"])]
    while not block.is_over(0):
        block.advance(1)
        centroids.append(np.array([block.records.body[c][1, 0] for c in "xyz"]))
    return np.array(centroids), block


def shaken(a, b, duration=1.0, dt=1e-3):
    t = np.arange(round(duration / dt) + 1) * dt
    return st.Motion(dt, a * st.g * np.sin(2 * np.pi * t), ay=b * st.g * np.sin(2.6 * np.pi * t))


@pytest.mark.parametrize(("depth", "limit"), [(SIDE, 1e-9), (0.5, 1e-6)])
def test_a_box_is_the_rectangular_column(depth, limit):
    """With three different moments the steps of both split the rotation about other axes."""
    column = st.Column.tapered(
        height=HEIGHT, bottom_width=SIDE, top_width=SIDE, drums=1, density=DENSITY, joint=JOINT, depth=depth
    )
    motion, body = shaken(0.2, 0.1, 0.5), box(SIDE, depth)
    step = 0.4 * min(engine_for(st.DistinctElement3D(), structure).stable_step for structure in (column, body))
    model = st.DistinctElement3D(time_step=step)
    column_path, box_path = path(column, motion, model)[0], path(body, motion, model)[0]
    assert np.abs(column_path[:, :2]).max() > 1e-4
    assert np.abs(column_path - box_path).max() < limit


def test_turning_body_and_motion_turns_the_response():
    angle, motion = 0.6, shaken(0.2, 0.1, 0.5)
    c, s = math.cos(angle), math.sin(angle)
    x, y = motion.samples, motion.y_samples
    turned = st.Motion(motion.dt, c * x - s * y, ay=s * x + c * y)
    centroids, _ = path(box(b=0.5), motion, st.DistinctElement3D())
    other, _ = path(box(b=0.5, turned=angle), turned, st.DistinctElement3D())
    back = np.stack((c * other[:, 0] + s * other[:, 1], c * other[:, 1] - s * other[:, 0], other[:, 2]), axis=1)
    assert np.abs(centroids - back).max() < 1e-10


def test_it_starts_in_equilibrium_and_stays():
    body = boulder()
    for model in (st.DistinctElement3D(), st.DistinctElement3D(stiffness_damping=1e-4)):
        response = st.simulate(body, st.Motion(1.0, np.zeros(2)), model)
        assert response.provenance["residual_acceleration_at_start_m_s2"] < 1e-8
        assert response.outcome == st.Outcome.AT_REST
        assert response.decided
        assert response.peak_top_displacement < 1e-9


def test_it_lies_on_the_face_that_needs_the_smallest_turn():
    corners = box(1.0, 0.8, 0.6).vertices
    c, s = math.cos(0.1), math.sin(0.1)
    askew = corners @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    rest = st.Specimen(100.0, (10.0, 10.0, 10.0), askew, joint=JOINT).resting
    assert rest.turn == pytest.approx(0.1)
    assert rest.height == pytest.approx(0.3)
    assert rest.area == pytest.approx(0.8)
    assert len(rest.footprint) == 4


def test_it_turns_about_the_vertical_as_its_twist_says():
    response = st.simulate(boulder(), shaken(0.3, 0.25), st.DistinctElement3D())
    twist = response.twist[:, 0]
    assert np.abs(twist).max() > 5e-5
    assert response.measures.space.peak_twist == pytest.approx(np.abs(twist).max(), rel=0.05)
    assert response.residual_twist_per_joint[0] == twist[-1]


def test_static_threshold_of_a_tripod():
    """Three feet: it topples over the nearest edge once a/g is above distance over height, and not below."""
    feet = np.array([(0.3, 0.0), (-0.15, 0.26), (-0.15, -0.26)])
    vertices = np.vstack((np.column_stack((feet, np.full(3, -0.8))), [(0.0, 0.0, 1.0)]))
    body = st.Specimen(500.0, (150.0, 150.0, 20.0), vertices, "tripod", JOINT)
    limit, outcomes = 0.15 / 0.8 * st.g, []
    for share in (0.93, 1.07):
        t = np.arange(6001) * 1e-3
        push = st.Motion(1e-3, share * limit * np.minimum(t / 2.0, 1.0))  # the body leans to −x, over an edge
        outcomes.append(st.simulate(body, push, st.DistinctElement3D(stiffness_damping=1e-4)))
    assert [response.outcome == st.Outcome.COLLAPSED for response in outcomes] == [False, True]
    assert outcomes[1].measures.collapse.azimuth == pytest.approx(math.pi, abs=0.02)
    assert "beyond 45°" in outcomes[1].measures.reason


def test_a_batch_has_the_bits_of_single_runs_whatever_its_neighbours():
    bodies = [boulder(3), boulder(4, 90), box(0.6, 0.5, 1.5)]
    motions = [shaken(0.1, 0.05), shaken(0.15, 0.1), shaken(0.3, 0.1)]
    table = st.simulate_many(bodies * 6, motions * 6, st.DistinctElement3D(), threads=2)
    for i in range(3):
        alone = st.simulate(bodies[i], motions[i], st.DistinctElement3D()).measures
        for j in range(6):
            row = table.iloc[i + 3 * j]
            assert row["peak_top_displacement_m"] == alone.peak_top_displacement
            assert row["residual_joint_slip_m"] == alone.residual_joint_slip
            assert row["energy_imbalance"] == alone.energy_imbalance


def test_the_ledger_closes_to_second_order():
    """Half the step, a quarter of the imbalance: 4.0 over 256 rocking bodies; of 128 the ratio scatters by 0.3."""
    motions = [shaken(a, 0.5 * a, 2.0) for a in np.linspace(0.25, 0.3, 128)]
    means = []
    for share in (0.8, 0.4):
        table = st.simulate_many(box(0.8, 0.6, 3.0, 0.4), motions, st.DistinctElement3D(step_factor=share))
        means.append(float(np.sqrt((table["energy_imbalance"] ** 2).mean())))
    assert means[1] < 1e-2
    assert means[0] / means[1] > 2.8


def test_free_fall_turns_as_a_free_body():
    """Lifted off the base it falls with g; its angular momentum is kept and its energy of rotation bounded."""
    model = st.DistinctElement3D(time_step=1e-4)
    body = boulder()
    block = engine_for(model, body).block(RunOptions(until_end=True))
    block.load(0, Case(body, st.Motion(1.0, np.zeros(2))))
    drum = block.records.body
    drum["z"][1, 0] = 100.0
    drum["lx"][1, 0], drum["ly"][1, 0], drum["lz"][1, 0] = 3.0, 40.0, 2.0
    first = block.energies(0)
    block.advance(10**4)
    last = block.energies(0)
    assert drum["z"][1, 0] == pytest.approx(100.0 - 0.5 * st.g * block.time(0) ** 2, abs=1e-3)
    assert abs(last[1:3].sum() - first[1:3].sum()) < 1e-5 * first[1]
    assert drum["ly"][1, 0] == 40.0


def test_responses_of_specimens_are_written_and_read_back(tmp_path):
    response = st.simulate(boulder(), shaken(0.05, 0.02, 0.3), st.DistinctElement3D())
    response.save(tmp_path / "boulder.nc")
    again = st.load_response(tmp_path / "boulder.nc")
    assert again.structure.digest == response.structure.digest
    assert again.bodies.shapes[0].mesh().vertices.shape == response.structure.vertices.shape
    assert "boulder" in repr(response)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mass": 0.0}, "mass of a specimen"),
        ({"mass": -1.0}, "mass of a specimen"),
        ({"inertia": (1.0, 1.0, 3.0)}, "sum of the other two"),
        ({"inertia": (1.0, 1.0, -1.0)}, "positive"),
        ({"inertia": [[1.0, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]}, "not symmetric"),
        ({"inertia": (1.0, 2.0)}, "3 × 3"),
        ({"vertices": [(0.0, 0.0, 0.0)] * 3}, "at least four points"),
        ({"vertices": [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 1.0, 0.0)]}, "lie in one plane"),
        ({"vertices": box().vertices + np.array([0.0, 0.0, 3.0])}, "outside the hull"),
        ({"vertices": box().vertices @ np.array([[1.0, 0, 0], [0, 1.0, 0], [0.5, 0, 1.0]])}, "not above its footprint"),
        ({"vertices": box().vertices * math.nan}, "finite"),
    ],
)
def test_bad_input_is_one_sentence(change, message):
    given = {"mass": 100.0, "inertia": (10.0, 10.0, 10.0), "vertices": box().vertices} | change
    with pytest.raises(st.InputError, match=message):
        st.Specimen(**given)


def test_other_models_and_steps_that_are_too_long_are_refused():
    motion = shaken(0.1, 0.0)
    with pytest.raises(st.InputError, match="is a specimen; dem3d"):
        st.simulate(box(), motion, st.DistinctElement2D())
    with pytest.raises(st.InputError, match="the largest stable step for 'box'"):
        st.simulate(box(), motion, st.DistinctElement3D(time_step=0.1))
    with pytest.raises(st.InputError, match="starts at rest or tossed"):
        st.simulate(box(), motion, st.DistinctElement3D(), start=st.Start(0.1))
    with pytest.raises(st.InputError, match="planar is on"):
        st.simulate(box(), motion, st.DistinctElement3D(planar=True))


def test_a_body_that_leans_has_not_slipped():
    """Turned by 0.1 rad about its lower edge, which stays where it is; the middle of its foot has moved by 2 mm."""
    model = st.DistinctElement3D()
    block = engine_for(model, box()).block(RunOptions())
    block.load(0, Case(box(), st.Motion(1.0, np.zeros(2))))
    c, s, edge = math.cos(0.1), math.sin(0.1), np.array([0.5 * SIDE, 0.0, 0.0])
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    place = edge + turn @ (np.array([block.records.body[name][1, 0] for name in "xyz"]) - edge)
    axes = turn @ block.records.axes(0)[0]
    for i, name in enumerate("xyz"):
        block.records.body[name][1, 0] = place[i]
        for a, axis in enumerate("ijk"):
            block.records.body[axis + name][1, 0] = axes[i, a]
    assert abs(block.bodies.foot(block.records, 0, box())[0]) > 1e-3
    opening, slip, twist = block.records.joints(0)
    assert np.abs(slip).max() < 1e-6  # the edge had sunk by some micrometres
    assert opening[0] == pytest.approx(SIDE * s, rel=1e-4)
    assert twist == pytest.approx(0.0, abs=1e-12)


def test_a_body_whose_weight_is_next_to_an_edge_lies_where_it_is_stable():
    """0.4 mm from the edge the springs of its face give way; it comes to lie on the next face too, 0.2 mm higher there."""
    base = [(x, y, z) for x, z in ((-0.2, 0.0), (4e-4, 0.0), (0.2, 2e-4)) for y in (-0.1, 0.1)]
    top = [(x, y, 0.6) for x in (-0.2, 0.2) for y in (-0.1, 0.1)]
    stone = st.Specimen(350.0, (12.0, 15.0, 6.0), np.array(base + top) - (0.0, 0.0, 0.3))
    seen = st.simulate(stone, st.Motion(0.01, np.zeros(51)), st.DistinctElement3D(), output_interval=0.05)
    assert np.ptp(seen.tilt) < 1e-9
    assert 1e-5 < seen.tilt[0, 0] < math.atan(1e-3)
    assert np.ptp(seen.body_position, axis=0).max() < 1e-9


def test_a_lane_that_is_used_again_starts_as_a_new_one():
    """While others move on beside it, whose vertices are near or not."""
    model, motion = st.DistinctElement3D(), st.harmonic(3.0, 6.0, 0.5)
    block = engine_for(model, box()).block(RunOptions())
    for lane in range(2):
        block.load(lane, Case(box(), motion))

    def taken():
        return {name: rows[:, 0].copy() for name, rows in block.records.rows.items()}

    first, started = taken(), block.start[0].copy()
    block.advance(3)
    assert (taken()["body"] != first["body"]).any()
    block.load(0, Case(box(), motion))
    again = taken()
    assert (block.start[0] == started).all()
    assert all((again[name] == first[name]).all() for name in ("joint", "watch"))
    assert (again["feed"][3:] == first["feed"][3:]).all()  # but for where the samples of the motion are
    assert (block.start[0] == block.start[1]).all()
