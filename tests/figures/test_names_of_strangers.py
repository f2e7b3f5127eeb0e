"""Pictures of columns and motions whose names hold dollars and control characters are drawn, and show the name."""

import inspect
import warnings

import pytest
from matplotlib.figure import Figure

import stylobate as st
from stylobate import plots
from stylobate.plots.style import plain
from stylobate.verdicts.critical import critical_suite

NAMES = ["$", "$x^$", r"a\$b$\frac{1$", "a\x00b\x1bc\x7f", "line\nline", "\u202eabc", "x" * 3000, "列柱", "%s{0}"]
COLUMN = st.Column.tapered(
    height=5.0,
    bottom_width=0.96,
    top_width=0.66,
    drums=2,
    density=1600.0,
    joint=st.Joint(5e9, 2.5e9, 35.0),
    name="column",
)


def response_of(name):
    motion = st.harmonic(1.0, 1.0, 0.1).replace(name=name)
    column = COLUMN if set(name) & set("\x00\n") else COLUMN.replace(name=name)  # which has no such name
    return st.simulate(column, motion, st.DistinctElement2D())


@pytest.fixture(scope="module")
def record():
    return st.harmonic(1.0, 1.0, 0.5)


@pytest.mark.parametrize("name", NAMES, ids=range(len(NAMES)))
def test_every_picture_takes_every_name(name, record, tmp_path):
    named = response_of(name)
    motion = record.replace(name=name)
    figures = {
        "histories": plots.draw_histories(named),
        "strip": plots.draw_filmstrip(named),
        "joints": plots.draw_joints(named),
        "energy": plots.draw_energy(named),
        "motion": plots.draw_motion(motion),
        "spectra": plots.draw_spectra(motion),
    }
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing")
        for figure in figures.values():
            figure.draw_without_rendering()  # where a text that is no mathematics fails
        for file in plots.save(figures["motion"], tmp_path / "motion"):
            assert file.stat().st_size > 1000


def test_pictures_of_amplitudes_and_records_take_every_name(record, tmp_path):
    stone = COLUMN.replace(name="$_{")
    single = st.critical_amplitude(stone, record.replace(name="$^"), st.RigidBeam(), 1.0, 2.0, 1.0)
    plots.save(plots.draw_amplitudes(single), tmp_path / "one")
    many = critical_suite(stone, [record.replace(name="$^"), record.replace(name="b$")], st.RigidBeam(), 1.0, 2.0, 1.0)
    plots.save(plots.draw_record_verdicts(many), tmp_path / "many")


def test_a_name_is_shown_as_it_is():
    figure = plots.draw_energy(response_of("5 $ of $tone"))
    assert figure.axes[0].get_title(loc="left").replace("\\$", "$").startswith("5 $ of $tone")
    assert plain("a\x00$") == "a\N{REPLACEMENT CHARACTER}\\$"
    assert plain(plain("a$b$")) == plain("a$b$")


def test_pictures_are_drawn_where_they_are_asked_to(record, tmp_path):
    page = Figure(figsize=(9.0, 6.0), layout="constrained")
    left, right = page.subfigures(1, 2)
    beside = left.subplots()
    result = st.critical_amplitude(COLUMN, record, st.RigidBeam(), 1.0, 2.0, 1.0)
    plots.draw_amplitudes(result, ax=beside, title="here")
    assert beside.get_title(loc="left") == "here"
    assert plots.draw_motion(record, figure=right) is right
    assert len(right.axes) == 2
    assert len(plots.draw_spectra(record).axes) == 2
    layout = page.get_layout_engine()
    for file in plots.save(page, tmp_path / "page"):
        assert file.stat().st_size > 1000
    assert page.get_layout_engine() is layout  # which is settled once for both files


@pytest.mark.parametrize("name", [name for name in plots.__all__ if name.startswith("draw_")])
def test_every_picture_takes_axes_or_a_figure(name):
    assert {"ax", "figure"} & set(inspect.signature(getattr(plots, name)).parameters)
