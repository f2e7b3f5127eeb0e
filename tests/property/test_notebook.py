"""What a notebook shows: values told as elsewhere, nothing that runs, nothing from the network, names that stay texts."""

from __future__ import annotations

import re

import numpy as np
import pytest

import stylobate as st
from stylobate import notebook


def shown():
    column = st.preset("paper-12-drums")
    stone = st.Stone.box((0.6, 0.4, 1.8), at=(0.0, 0.0, 0.0), density=2700.0, name="statue")
    motion = st.sample_motion("el-centro-1940")
    chosen = st.select_records([motion], st.target_spectrum("ec8,ag=0.2g"), 1, factors=(0.1, 10.0))
    return [column, st.SpatialAssembly((stone,), joint=column.joint_laws[0], name="scene"), motion, chosen]


@pytest.mark.parametrize("k", range(4))
def test_what_is_shown_is_plain(k):
    value = shown()[k]
    page = value._repr_html_()
    assert "<script" not in page
    assert "http" not in page
    assert page.count("<table>") == page.count("</table>") == 1


def test_a_column_in_a_paragraph():
    """Numbers of the closed forms, as ``stylobate columns`` prints them."""
    column = st.preset("paper-monolithic")
    said = repr(column)
    assert "a column of 1 drum, 5 m high" in said
    assert f"{column.uplift_acceleration / st.g:.3f} g" in said
    assert f"Slenderness {column.slenderness:.3f} rad, p = {column.frequency_parameter:.3f} rad/s" in said


def test_names_are_texts():
    named = st.preset("paper-monolithic").replace(name="<img src=x onerror=1>")
    assert "<img" not in named._repr_html_()
    assert "<img" not in notebook.page("<img>", "<img>", {"<img>": "<img>"})


def test_a_history_keeps_its_peak():
    """However long, the line passes through the largest value at the height of 80."""
    values = np.sin(np.linspace(0.0, 400.0, 100_000))
    values[54_321] = -3.0
    points = re.findall(r"(-?[\d.]+),(-?[\d.]+)", notebook.history(values, "a"))
    assert max(float(y) for _, y in points) == pytest.approx(80.0)
    assert len(points) <= 1200
