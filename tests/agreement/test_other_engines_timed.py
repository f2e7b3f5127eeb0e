"""The assembly that other engines are timed with: what they are given, and what is told where they are not installed."""

import pytest

from stylobate_studies.speed import assemblies, others


def test_engines_that_are_not_installed_are_left_out(monkeypatch, tmp_path):
    monkeypatch.setattr(others, "PYTHON", tmp_path / "python")
    assert others.others(assemblies.colonnade(), assemblies.over()) == {"mujoco": None, "pybullet": None}
    assert "make peers" in others.MISSING


def test_they_are_given_the_same_bodies():
    """Drums as cylinders of their mean diameter, which have the same height and nearly the same volume."""
    structure = assemblies.colonnade()
    bodies = [others.body(stone) for stone in structure.stones]
    assert [shape for shape, *_ in bodies] == ["cylinder"] * 12 + ["block"] * 3
    assert bodies[0][1] == [0.975, 1.5]
    assert bodies[-1] == ("block", [2.6, 2.6, 0.7, 0.6], [6.5, 0.0, pytest.approx(4.8)])
