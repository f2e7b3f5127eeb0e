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
    chosen = st.select_records([motion], st.target_spectrum("ec8,ag=0.2g,soil=B"), 1, factors=(0.1, 10.0))
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
    text = repr(column)
    assert "a column of 1 drum, 5 m high" in text
    assert f"{column.uplift_acceleration / st.g:.3f} g" in text
    assert f"Slenderness {column.slenderness:.3f} rad, p = {column.frequency_parameter:.3f} rad/s" in text


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


# -- IPython -------------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def shell(tmp_path_factory):
    """A shell of IPython of its own, in which a column has been shaken."""
    interactiveshell = pytest.importorskip(
        "IPython.core.interactiveshell", reason="the extra notebook is not installed"
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("IPYTHONDIR", str(tmp_path_factory.mktemp("ipython")))
        made = interactiveshell.InteractiveShell()
        made.history_manager.enabled = False
        yield made
        made.history_manager.end_session()


def completed(shell, text):
    from IPython.core.completer import provisionalcompleter

    with provisionalcompleter():
        return {completion.text for completion in shell.Completer.completions(text, len(text))}


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("st.Colu", "Column"),
        ("st.Mot", "MotionRequest"),
        ("st.", "simulate"),
        ("from stylobate import Distinct", "DistinctElement3D"),
        ("st.DistinctElement3D(la", "law="),
        ("column.upl", "uplift_acceleration"),
        ("response.to_x", "to_xarray"),
        ("table['coll", "collapsed"),
        ("histories['joint_o", "joint_opening"),
    ],
)
def test_names_are_completed(shell, text, name):
    """Names that are loaded when they are first used, keywords, and names of columns of a table and of histories."""
    import stylobate

    column, motion = st.preset("paper-monolithic"), st.harmonic(1.0, 1.0, 1.0)
    response = st.simulate(column, motion, st.HousnerBlock())
    table = st.simulate_many(column, [motion], st.HousnerBlock())
    own = {"column": column, "response": response, "table": table, "histories": response.to_xarray()}
    shell.user_ns.update(st=stylobate, **own)
    assert name in completed(shell, text)


def test_what_ipython_shows(shell):
    """HTML of a column, an assembly, motion, run, records, table and curves; in a terminal a paragraph, no arrays."""
    column, motion = st.preset("paper-monolithic"), st.harmonic(1.0, 1.0, 1.0)
    curves = [st.pushover(column), st.limit_analysis(column), st.limit_directions(column)]
    curves.append(st.collapse_domain(column, st.HousnerBlock(), [1.0], [1.0, 5.0]))
    run = st.simulate(column, motion, st.HousnerBlock())
    for value in (*shown(), run, *curves):
        formats, _ = shell.display_formatter.format(value)
        assert formats["text/html"] == value._repr_html_()
        assert "array(" not in formats["text/plain"]
        assert "\n" not in formats["text/plain"]
    table, _ = shell.display_formatter.format(st.simulate_many(column, [motion], st.HousnerBlock()))
    assert "<table" in table["text/html"]
