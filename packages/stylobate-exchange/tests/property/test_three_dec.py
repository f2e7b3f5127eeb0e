"""Data files of 3DEC: polyhedra, ranges and properties, what is refused by its line, and a model of 156 blocks."""

import re
from dataclasses import replace
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


@pytest.mark.parametrize("option", [{"unit": "mm"}, {"up": "y"}])
def test_only_lengths_would_follow_another_unit(option, tmp_path):
    """Densities, stiffnesses and gravity of a file are of its own unit of length, and of its own axes."""
    (tmp_path / "a.dat").write_text(PAIR)
    ((name, _),) = option.items()
    with pytest.raises(st.InputError, match=f"`{name}` is .*; allowed for .*, a data file of 3DEC, is '[mz]': its"):
        convert(str(tmp_path / "a.dat"), tmp_path / "a.toml", Reading(**option))
    assert not (tmp_path / "a.toml").exists()


def prism(x: float, low: float, high: float) -> str:
    """A command for a stone 0.8 m square, from x on, in region 3."""
    ring = [(x, 0.1), (x + 0.8, 0.1), (x + 0.8, 0.9), (x, 0.9)]
    lower, upper = (" ".join(f"({a:.6g},{b:.6g},{z:.6g})" for a, b in ring) for z in (low, high))
    return f"\npoly region 3 prism a {lower} b {upper}"


def test_gaps_stay_open_unless_closing_says_otherwise(tmp_path):
    """A stone 0.8 mm over another is let down; a slit of 30 mm beside it stays, whatever hulls are allowed."""
    path = tmp_path / "a.dat"
    path.write_text(PAIR.split("poly region 2 face")[0] + PAIR[PAIR.index("prop mat 1") :] + prism(0.1, 1.5008, 2.0))
    structure, _, words = read_model(path, Reading(tolerance=0.05))
    assert len(structure.space_joints) == 2
    assert "the gap of 0.8 mm between 'region 2 1' and 'region 3 1', closed" in words
    path.write_text(path.read_text() + prism(0.93, 0.5, 1.5))
    assert len(read_model(path, Reading(tolerance=0.05))[0].space_joints) == 3
    structure, _, words = read_model(path, Reading(tolerance=0.05, closing=0.04))
    assert len(structure.space_joints) == 4
    assert any(word.startswith("2 gaps, the largest of 30 mm between") for word in words)


def test_glued_parts_are_one_stone(tmp_path):
    """Halves that share a face are one box of their mass, without a joint between them."""
    path = tmp_path / "a.dat"
    halves = prism(0.1, 0.5, 1.5) + prism(0.9, 0.5, 1.5)
    path.write_text(PAIR.split("poly region 2")[0] + PAIR[PAIR.index("prop mat 1") :] + halves)
    structure, *_ = read_model(path, Reading(glued=("region 3 1 + region 3 2",)))
    assert [stone.name for stone in structure.stones] == ["Plinth 1", "region 3 1"]
    assert structure.stones[1].mass == pytest.approx(1.6 * 0.8 * 2600.0, rel=1e-9)
    assert len(structure.space_joints) == 1
    for glued, says in (
        ("region 3 1 + block 7", "`glued` names 'block 7', which .* does not hold"),
        ("region 3 1", "allowed are two or more different parts of one density"),
        ("region 3 1 + Plinth 1", "allowed are two or more different parts of one density"),
    ):
        with pytest.raises(st.InputError, match=says):
            read_model(path, Reading(glued=(glued,)))


@pytest.mark.slow
@pytest.mark.skipif(not EVORA.exists(), reason="needs ../shared/monuments/evora")
def test_the_temple_of_evora():
    """156 polyhedra; the mass of all that can move within 0.1 % of a sum over the raw file.

    That sum takes every face around its middle, bent ones as well, by triangles, from the corners of the text.
    """
    with pytest.raises(st.InputError, match=r"out of plane by [\d.]+ mm.*or allow more with `tolerance=0\.05`"):
        read_model(EVORA, Reading())
    assert len(read_model(EVORA, Reading(tolerance=0.05))[0].stones) == 156
    halves = tuple(f"Column_{column} 1 + Column_{column} 2" for column in ("A1", "A2"))
    structure, _, words = read_model(EVORA, Reading(tolerance=0.05, ground=0.0, glued=halves))
    assert len(structure.stones) == 154
    assert replace(structure, name="evora").digest == load_structure("evora").digest
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
        total += volume * (2563.0 if marble else 2625.0) * (int(region) > 1)
    assert sum(stone.mass for stone in structure.stones if not stone.fixed) == pytest.approx(total, rel=1e-3)
    assert "2 gaps, the largest of 0.86 mm between 'Arch_West 2' and 'Arch_West 3', closed" in words
