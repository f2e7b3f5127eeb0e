"""Measured tosses and shaking-table tests, computed again from the raw numbers by other code; measures must be met."""

import csv
import json
import math

import numpy as np
import pytest
from experiments import FOLDER, needs_cube, needs_granite
from oracles.springs import Body, matrix

from stylobate import DistinctElement3D, simulate
from stylobate_studies.experiments import cube as cubes
from stylobate_studies.experiments.cube_files import read_tosses
from stylobate_studies.experiments.granite import motion_of
from stylobate_studies.experiments.granite_files import read_granite

HALF = 0.0524


@needs_cube
@pytest.mark.slow
@pytest.mark.parametrize("name", ["t000", "t002", "t004"])
def test_a_toss_to_its_first_impact(name):
    """Position 20 ms after it: the published size, mass, inertia, friction and restitution; stiffness as chosen here.

    The two read the state at the start in ways of their own (1 mm/s, 0.05 rad/s apart), and friction slips in two ways:
    3 mm on a cube of 105 mm.
    """
    with np.load(FOLDER / "cube" / "tosses.npz") as file:
        states, dt = file[name].astype(float), float(file["dt"])
    corners = HALF * np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    jumps = np.abs(np.diff(states[:, 7:10], axis=0) + np.array((0.0, 0.0, 9.80665 * dt))).max(axis=1)
    first = int(np.flatnonzero(jumps > 0.15)[0])  # velocities of the file are those of the interval before
    t = np.arange(first) * dt
    velocity = [np.polyfit(t, states[:first, c] + (0.5 * 9.80665 * t**2 if c == 2 else 0.0), 1)[0] for c in range(3)]
    position = [np.polyfit(t, states[:first, c] + (0.5 * 9.80665 * t**2 if c == 2 else 0.0), 1)[1] for c in range(3)]
    spin = states[1:first, 10:13].mean(axis=0)  # in the axes of the body, and constant: a cube is a sphere to itself
    stiffness = 4e9 * HALF**2
    body = Body(0.37, np.eye(3) * 0.295 * HALF**2, corners, stiffness, 0.5 * stiffness, 0.18, 0.125)
    toss = next(candidate for candidate in read_tosses(FOLDER / "cube").tosses if candidate.name == name)
    frame = cubes.impacts(toss)[0] + 4
    start = np.concatenate((position, states[0, 3:7], velocity, spin))
    moved = body.move(start, np.array([0.0, frame * dt]))
    error = np.linalg.norm(moved.y[:3, -1] - states[frame, :3]) / (2.0 * HALF)
    ours = cubes.compare(toss, 0.18, 0.125)["first impact: position [widths]"]
    assert error == pytest.approx(ours, abs=0.03)


@needs_granite
@pytest.mark.slow
@pytest.mark.parametrize("number", [190, 212, 228])
def test_a_boulder_topples_when_and_where_it_does_here(number):
    """Time from the first 0.05 g to a tilt of 45°, to 5 %, and the direction, to 5°.

    These tests topple within 1.4 s. The time near an unstable equilibrium goes with the logarithm of what pushes the
    body off it: the two ways of friction, and the integrator's 1e-4, are 0.05 s there.
    """
    with open(FOLDER / "granite" / "specimens.json") as file:
        specimen = json.load(file)["SP1"]
    with np.load(FOLDER / "granite" / "motions.npz") as file:
        samples, dt = file[f"a{number:03d}"].astype(float), float(file["dt"])
    with open(FOLDER / "granite" / "tests.csv", newline="") as file:
        row = next(row for row in csv.DictReader(file) if row["id"] == str(number))
    assert row["toppled_sp1"] == "1"
    vertices = np.array(specimen["hull_vertices_m"]) - (0.0, 0.0, specimen["com_height_at_rest_m"])
    (ax, ay, _), (bx, by, _), (cx, cy, _) = specimen["resting_contact_points_m"]
    area = 0.5 * abs((bx - ax) * (cy - ay) - (cx - ax) * (by - ay))
    stiffness = 5e10 * area / 3.0
    below = vertices[vertices[:, 2] < 0.3]  # the rest touches nothing before 45°
    body = Body(specimen["mass_kg"], specimen["inertia_about_com_kg_m2"], below, stiffness, 0.5 * stiffness, 0.7, 0.5)
    time = np.arange(len(samples)) * dt
    begins = time[np.argmax(np.abs(samples) > 0.5)]

    def fallen(t, y, ground):
        return matrix(y[3:7])[2, 2] - math.sqrt(0.5)

    fallen.terminal = True
    height = specimen["com_height_at_rest_m"]
    start = np.concatenate(([0.0, 0.0, height], [1.0, 0.0, 0.0, 0.0], np.zeros(6)))
    times = np.array([begins - 0.1, begins + 3.0])
    moved = body.move(start, times, lambda t: np.interp(t, time, samples), 1e-4, 1e-4, fallen, "RK23")
    fell, at = moved.t_events[0][0] - begins, moved.y_events[0][0]
    up = matrix(at[3:7])[:, 2]
    granite = read_granite(FOLDER / "granite")
    test = next(test for test in granite.tests if test.number == number)
    response = simulate(granite.scans["SP1"].specimen(), motion_of(test, 0.0), DistinctElement3D())
    ours = np.arange(len(test.acceleration)) * dt
    first = ours[np.argmax(np.abs(test.acceleration) > 0.5)]
    collapse = response.measures.collapse
    assert fell == pytest.approx(collapse.time - first, rel=0.05)
    apart = math.atan2(up[1], up[0]) - collapse.azimuth
    assert abs(math.remainder(apart, 2.0 * math.pi)) < math.radians(5.0)
