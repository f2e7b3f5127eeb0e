"""Links of a column of round drums are the same in lanes of columns and as an assembly in space, and in the plane."""

import math

import numpy as np
import pytest

import stylobate as st
from stylobate.column.files import write_column
from stylobate.column.links import link_from_dict

STEP = 2.5e-5
JOINT = st.Joint(5e10, 2.5e10, math.degrees(math.atan(0.7)))

#: Of each kind, entries as in a file of a column: some slip behind a slack, yield, break, slide or damp in the swing.
KINDS = {
    "dowels": [
        {"kind": "dowel", "joint": j, "at": [0.1, 0.05], "shear_stiffness": 1e8, "clearance": 1e-6, "shear_capacity": 2e3}
        for j in (1, 2, 3)
    ],
    "bars": [
        {"kind": "bar", "joint": j, "shear_stiffness": 1e8, "axial_stiffness": 1e7, "axial_capacity": 4e3,
         "ultimate_elongation": 1e-3}
        for j in (1, 2, 3)
    ],
    "tie": [
        {"kind": "tie", "at": [0.45, 0.1], "to": [0.42, 0.1], "axial_stiffness": 1e7, "axial_capacity": 2.2e4,
         "pretension": 2e4},
        {"kind": "core", "axial_stiffness": 1e7, "pretension": 1e4},
    ],
    "layer": [
        {"kind": "layer", "joint": 2, "friction_coefficient": 0.1, "shear_stiffness": 1e6, "damping": 1e4},
        {"kind": "pad", "joint": 1, "normal_stiffness": 5e10, "shear_stiffness": 2e10, "friction_coefficient": 0.5},
    ],
}  # fmt: skip


def pushed(azimuth: float) -> st.Motion:
    """Half a sine that opens all joints."""
    push = 0.4 * 9.81 * np.sin(2.5 * np.pi * np.arange(0.0, 0.40001, 0.0025))
    return st.Motion(0.0025, push * math.cos(azimuth), lateral=push * math.sin(azimuth))


@pytest.mark.parametrize("kind", KINDS)
def test_a_column_with_links_in_both_engines(kind, tmp_path) -> None:
    """The first swing: places to 1e-9 m, of some millimetres, and forces to 1e-6 of the largest, the same links broken.

    The step is a power of two of that of the record, in which what links hold rounds alike.
    """
    links = tuple(link_from_dict(one) for one in KINDS[kind])
    drums = [st.Drum(1.0, 0.8, 0.8, 2700.0, section="circular")] * 3
    made = st.Column.of_drums(drums, JOINT, name="column").replace(links=links)
    write_column(made, tmp_path / "column.toml")
    (tmp_path / "alone.toml").write_text('[[column]]\nfile = "column.toml"\nat = [[0.0, 0.0]]\n')
    column, assembly = st.read_column(tmp_path / "column.toml"), st.read_assembly(tmp_path / "alone.toml")
    assert [one.name for one in assembly.placed_links] == [f"column 1, {one.name}" for one in column.placed_links]
    model = st.DistinctElement3D(time_step=STEP)
    lane, space = (st.simulate(one, pushed(0.6), model) for one in (column, assembly))
    ways = [np.array(one.poses.position)[:, -3:] for one in (lane, space)]
    ways = [way - way[0] for way in ways]
    print(kind, np.abs(ways[0]).max(), np.abs(ways[1] - ways[0]).max())
    for name in ("shear", "tension", "slip", "elongation"):
        one, two = getattr(lane.links, name), getattr(space.links, name)
        print(name, np.abs(one).max(axis=0), np.abs(one - two).max())
    print([(a.broken_at, b.broken_at) for a, b in zip(lane.measures.links, space.measures.links)], space.energy_imbalance, lane.energy_imbalance, space.sentence)
    assert np.abs(ways[0]).max() > 1e-3
    assert ways[1] == pytest.approx(ways[0], abs=1e-9)
