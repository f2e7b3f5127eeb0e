"""Data files of 3DEC: polyhedra, ranges and properties, what is refused by its line, and a model of 156 blocks."""

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import stylobate as st
from stylobate.column.assembly_files import load_structure
from stylobate_exchange.convert import Reading, convert, read_model

EVORA = Path(__file__).parents[4].parent / "shared" / "monuments" / "evora" / "m03_geometry.dat"

PAIR = """; two stones on a plinth
Poly region 1 prism & ; goes on
 a (0, 0, 0) (2, 0, 0) (2, 1, 0) (0, 1, 0) &
 b (0, 0, 0.5) (2, 0, 0.5) (2, 1, 0.5) (0, 1, 0.5)
range name Plinth region 1
poly region 2 prism a (0.1,0.1,0.5) (0.9,0.1,0.5) (0.9,0.9,0.5) (0.1,0.9,0.5) &
 b (0.1,0.1,1.5) (0.9,0.1,1.5) (0.9,0.9,1.5) (0.1,0.9,1.5)
poly region 2 face (1.1,0.1,0.5) (1.9,0.1,0.5) (1.5,0.9,0.5) face (1.1,0.1,0.5) (1.5,0.5,1.4) (1.9,0.1,0.5) &
 face (1.9,0.1,0.5) (1.5,0.5,1.4) (1.5,0.9,0.5) face (1.5,0.9,0.5) (1.5,0.5,1.4) (1.1,0.1,0.5)
prop mat 1 density 2600
property material 2 density 2000
range name high z 0.6 9.0
range name left x 0 1
range name low_left nrange high left
range name all_of_them union nrange low_left plinth
change mat 2 range nrange all_of_them
prop jmat 1 jkn 3e9 jks 1e9 jfriction 30 jcohesion 0 jdilation 0
fix range region 1
gravity 0 0 -9.8
"""


def test_polyhedra_with_their_ranges_and_properties(tmp_path):
    """Densities by ranges that meet or are united; the second stone is a pyramid of 0.32·0.9/3 m³ on its faces."""
    (tmp_path / "a.dat").write_text(PAIR)
    structure, words, _ = convert(str(tmp_path / "a.dat"), tmp_path / "a.toml", Reading())
    assert [stone.name for stone in structure.stones] == ["Plinth 1", "region 2 1", "region 2 2"]
    assert [stone.fixed for stone in structure.stones] == [True, False, False]
    masses = (1.0 * 2000.0, 0.64 * 2000.0, 0.32 * 0.9 / 3.0 * 2600.0)
    assert [stone.mass for stone in structure.stones] == pytest.approx(masses, rel=1e-9)
    joint = structure.joint
    assert (joint.normal_stiffness, joint.shear_stiffness, structure.gravity) == (3e9, 1e9, 9.8)
    assert joint.friction_coefficient == pytest.approx(np.tan(np.radians(30.0)))
    assert len(structure.space_joints) == 2
    assert "no ground: the supports carry it" in words
    assert load_structure(tmp_path / "a.toml").digest == structure.digest


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("fix range region 1", "cycle 1000", "line 18 of .* is 'cycle 1000', which is not read"),
        ("range region 1", "range nrange podium", "line 18 .* for 'podium' is not defined before it"),
        ("jdilation 0", "jdilation 5", "line 17 .* is 'prop jmat"),
        ("gravity 0 0", "gravity 1 0", "line 19 of"),
        ("prop mat 1 density 2600", "; none", "gives no density of material 1"),
        ("(2, 1, 0)", "(2, 1)", "line 2 of .* is 'Poly region 1 prism"),
        ("b (0, 0, 0.5)", "b", "line 2 of"),
        (" face (1.9,0.1,0.5) (1.5,0.5,1.4) (1.5,0.9,0.5)", " ", "region 2 2 of .* has a hole"),
        ("(2, 1, 0.5)", "(2, 1, 0.6)", r"'Plinth 1' is not convex: .*face on line 2 is out of plane by 2\d(\.\d)? mm"),
    ],
)
def test_what_is_not_known_is_refused_by_its_line(old, new, says, tmp_path):
    (tmp_path / "a.dat").write_text(PAIR.replace(old, new))
    with pytest.raises(st.InputError, match=says):
        read_model(tmp_path / "a.dat", Reading())


@pytest.mark.slow
@pytest.mark.skipif(not EVORA.exists(), reason="needs ../shared/monuments/evora")
def test_the_temple_of_evora():
    """156 polyhedra; the mass of each within what its hull adds, of all within 0.1 % of a sum over the raw file.

    That sum takes every face around its middle, bent ones as well, by triangles, from the corners of the text.
    """
    with pytest.raises(st.InputError, match=r"out of plane by [\d.]+ mm.*or allow more with `tolerance=0\.05`"):
        read_model(EVORA, Reading())
    structure, _, words = read_model(EVORA, Reading(tolerance=0.05))
    assert len(structure.stones) == 156
    assert [stone.name for stone in structure.stones if stone.fixed] == ["podium 1"]
    text = re.sub(r";.*|&", "", EVORA.read_text())
    total = 0.0
    for region, lower, upper in re.findall(r"poly region (\d+) prism\s+a(.*?)b([^a-z]*)", text, re.DOTALL):
        rings = [np.array(re.findall(r"[-\d.]+", ring), dtype=float).reshape(-1, 3) for ring in (lower, upper)]
        sides = [
            np.array([rings[0][i], rings[0][k], rings[1][k], rings[1][i]])
            for i, k in pairwise([*range(len(rings[0])), 0])
        ]
        centre = np.concatenate(rings).mean(axis=0)
        volume = sum(
            abs(float(np.dot(p - centre, np.cross(q - centre, face.mean(axis=0) - centre)))) / 6.0
            for face in (*rings, *sides)
            for p, q in zip(face, np.roll(face, -1, axis=0), strict=True)
        )
        marble = 2 <= int(region) <= 15 and (4.33 <= centre[2] <= 4.70 or 11.0 <= centre[2] <= 12.02)
        total += volume * (2563.0 if marble else 2625.0)
    assert sum(stone.mass for stone in structure.stones) == pytest.approx(total, rel=1e-3)
    assert any("brought into common planes: corners moved by up to 23.8 mm" in word for word in words)
