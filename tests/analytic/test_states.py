"""Was it worth it: states of a column under the same motions, paired."""

import dataclasses
import json
import math
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.text import Text

import stylobate as st
from stylobate import plots
from stylobate.cli.main import call
from stylobate.cli.states import describe
from stylobate.column.files import write_column
from stylobate.column.materials import material
from stylobate.column.scatter import usual_scatter
from stylobate.probability.evidence import Evidence
from stylobate.probability.fragility import fragility
from stylobate.probability.states import _difference, compare_states, doubt, with_undecided
from stylobate.response.words import UNDAMPED_WOBBLE
from stylobate.verdicts.limit_states import EXCEEDED, NOT_EXCEEDED, OPEN, median_name, shares

JOINT = st.Joint(1e9, 5e8, friction_coefficient=0.7)


def block(width):
    return st.Column.of_drums([st.Drum(3.0, width, width, 2500.0)], JOINT, name=f"{width} m")


@pytest.fixture(scope="module")
def comparison():
    motions = [st.ricker(frequency, st.g) for frequency in np.linspace(0.6, 1.5, 10)]
    states = {"as built": block(0.6), "the same": block(0.6), "wider": block(0.9)}
    return compare_states(states, motions, st.DistinctElement2D(), [0.3, 0.5, 0.8], samples=200, threads=1)


def test_a_state_compared_with_itself_differs_by_nothing(comparison):
    same = comparison.differences[0]
    assert (same.saved, same.harmed, same.pairs) == (0, 0, 30)
    # and by what ten records at three levels cannot show: a share z²/(10 + z²) of them at one level
    most = 1.96**2 / (10.0 + 1.96**2)
    assert (same.share, same.share_low, same.share_high) == pytest.approx((0.0, -most / 3.0, most / 3.0), abs=1e-4)
    assert same.ratio == 1.0
    assert same.ratio_low <= math.exp(-most * math.log(0.8 / 0.3) / 2.0) + 1e-4
    assert same.ratio_low * same.ratio_high == pytest.approx(1.0)
    assert "not shown to be stronger than “as built”" in same.sentence


def test_differences_are_those_of_the_pairs(comparison):
    table = comparison.table
    fell = {
        label: table[table["state"] == label].set_index(["motion", "im"])["collapsed"].astype(int)
        for label in comparison.labels
    }
    wider = comparison.differences[1]
    change = fell["wider"] - fell["as built"]
    assert wider.share == pytest.approx(change.mean())
    assert (wider.saved, wider.harmed) == ((change == -1).sum(), (change == 1).sum())
    assert wider.saved > 3
    assert wider.share_low <= wider.share <= wider.share_high < 0.0
    assert wider.ratio_low < wider.ratio
    assert wider.ratio > 1.0
    assert wider.sentence.startswith("“wider”: stronger than “as built” against collapse, under these motions.")
    assert [(share.label, share.runs) for share in comparison.shares] == [(label, 30) for label in comparison.labels]


def test_the_picture_shows_curves_and_differences(comparison):
    figure = plots.draw_states(comparison)
    curves, bars = figure.axes
    assert len(curves.get_lines()) >= 3
    low, high = bars.get_xlim()
    assert low < 0.0 < high  # both sides of zero are there, and named
    assert [text.get_text().strip() for text in bars.texts] == ["← stronger", "weaker →"]
    assert [label.get_text() for label in bars.get_yticklabels()] == ["the same", "wider"]


def test_without_a_curve_the_differences_stand_alone(comparison):
    """Of few records nothing is fitted: no empty frame, and the legend outside of the axes."""
    figure = plots.draw_states(dataclasses.replace(comparison, curves=tuple(None for _ in comparison.curves)))
    (bars,) = figure.axes
    assert bars.get_legend() is None
    assert "percentage points" in bars.get_xlabel()


def test_the_command(tmp_path, capsys):
    narrow, wide = (write_column(block(width), tmp_path / f"{width}.toml") for width in (0.6, 0.9))
    base = ["states", "--as-built", str(narrow), "--with", str(wide)]
    records = ["--motion", "sample:el-centro-1940"]  # or as arguments
    assert (
        call([*base, *records, "--im", "pga", "--levels", "0.4g:1.2g:2", "--json", "--out", str(tmp_path / "out")]) == 0
    )
    output = json.loads(capsys.readouterr().out)
    assert [state["label"] for state in output["states"]] == ["as built", "0.9"]
    assert output["states"][0]["fragility"] is None  # one record makes no curve
    assert output["differences"][0]["pairs"] == 2
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"states.csv", "links.csv", "states.png", "states.json", "asked-states.json"} <= names
    assert output["doubt"] == ""
    assert call([*base, "--pulse", "ricker,1Hz,0.2g"]) == 0  # one motion, which is no file
    output = capsys.readouterr().out
    assert "under 1 record and worse in 0; nothing is concluded from fewer than 10 records)" in output
    assert [line.split()[-2:] for line in output.splitlines() if line.strip().startswith("0.9")][-1] == ["%", "-"]


def test_how_columns_of_a_material_scatter_is_kept(tmp_path):
    """They scatter by their material, and were told to scatter by the defaults."""
    stone = material("marble, worn")
    joint = st.Joint(1e9, 5e8, friction_coefficient=stone.friction_coefficient.value)
    drum = st.Drum(3.0, 0.6, 0.6, stone.density.value)
    column = st.Column.of_drums([drum], joint).replace(material="marble, worn")
    file = str(write_column(column, tmp_path / "stone.toml"))
    options = ["--model", "housner", "--pulse", "ricker,1Hz,0.2g", "--replicates", "2", "--out", str(tmp_path / "out")]
    assert usual_scatter(column) != st.Scatter()
    for other, words in ((file, "{stone}"), ("paper-monolithic", "as built: {stone}; paper-monolithic: {usual}")):
        assert call(["states", "--as-built", file, "--with", other, *options]) == 0
        kept = json.loads((tmp_path / "out" / "asked-states.json").read_text())["options"]["scatter"]
        assert kept == words.format(stone=usual_scatter(column).describe(), usual=st.Scatter().describe())


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--as-built", "paper-monolithic"], "only the state 'as built' is given"),
        ([], "no state is given; give two or more"),
        (["a.V2", "--as-built", "paper-monolithic", "--with", "paper-12-drums", "--motion", "b.V2"], "give them once"),
        (
            ["--as-built", "paper-monolithic", "--with", "paper-12-drums", "--im", "pgv"],
            "scaled by --im and --levels together",
        ),
    ],
)
def test_what_cannot_be_compared_is_said_in_one_sentence(capsys, arguments, words):
    assert call(["states", *arguments, "--pulse", "ricker,1Hz,0.3g"]) == 2
    assert words in capsys.readouterr().err


def test_the_ratio_of_medians_is_that_of_the_runs_that_both_states_know():
    """Ten records, capacities 1 and 2 times a stripe: of the other state the weak records' strong runs have no verdict.

    Where only one of the two is known neither counts, in the value as in its samples, so that the value lies among them.
    """
    levels = np.geomspace(0.1, 10.0, 9)
    records = np.repeat([f"record {k}" for k in range(10)], len(levels)).astype(object)
    im = np.tile(levels, 10)
    capacity = np.repeat(np.geomspace(0.5, 1.6, 10), len(levels))
    codes = (im > capacity).astype(np.int8)
    first = Evidence(records, im, codes, "im", "-", "collapse", "first")
    gone = np.where((capacity < 0.9) & (im > 0.4), OPEN, (im > 2.0 * capacity).astype(np.int8))
    other = Evidence(records, im, gone, "im", "-", "collapse", "other")
    both = Evidence(records, im, np.where(gone == OPEN, OPEN, codes), "im", "-", "collapse", "first")
    curves = [fragility(evidence, samples=200) for evidence in (first, other, both)]
    ratio = _difference(first, other, curves[0], curves[1], 200, 0, 0.95).ratio
    assert ratio == pytest.approx(curves[1].median / curves[2].median, rel=1e-9)
    assert ratio != pytest.approx(curves[1].median / curves[0].median, rel=1e-3)


def test_the_ratio_of_medians_holds_what_wide_levels_leave_open():
    """8 of 12 records collapse at 1.5 g, none at 1 g: the median lies between, and its ratio holds all of that."""

    def compared(levels):
        states = []
        for name, capacity in (("first", np.linspace(1.1, 1.69, 12)), ("other", np.linspace(0.95, 1.46, 12))):
            codes = (np.array(levels) >= capacity[:, None]).astype(np.int8).ravel()
            records = np.repeat(np.array([f"r{k:02}" for k in range(12)], dtype=object), len(levels))
            states.append(Evidence(records, np.tile(levels, 12), codes, "pga", "g", "collapse", name))
        return _difference(*states, *(fragility(state, samples=100) for state in states), 100, 0, 0.95)

    designs = ([0.5, 1.0, 1.5, 2.0], [0.9 + 0.1 * k for k in range(9)], [0.6, 0.9, 1.2, 1.5, 1.8], [0.75, 1.25, 1.75])
    differences = [compared(levels) for levels in designs]
    assert max(difference.ratio_low for difference in differences) < min(
        difference.ratio_high for difference in differences
    )
    for difference in differences:
        assert (
            difference.ratio_low < 1.205 / 1.395 < difference.ratio_high
        )  # the true medians, in the middle of each dozen


def test_medians_are_compared_where_runs_show_both_and_else_what_is_missing_is_said():
    """One collapse in 60 runs has a curve, but no median; nor has one whose median lies above all levels."""
    levels = np.linspace(0.1, 0.6, 6)
    im, records = np.tile(levels, 10), np.repeat([f"r{k}" for k in range(10)], 6).astype(object)

    def evidence_of(name, capacity):
        return Evidence(records, im, (im > np.repeat(capacity, 6)).astype(np.int8), "pga", "g", "collapse", name)

    many = evidence_of("as found", np.linspace(0.25, 0.55, 10))
    single = evidence_of("core", [0.55, *[0.7] * 9])
    half = evidence_of("core", [*np.linspace(0.35, 0.55, 4), *[0.7] * 6])
    curve = fragility(many, samples=100)
    for other, missing in (
        (single, "1 of 60 runs of “core” collapse, and a median needs at least 5 of them; give larger intensities"),
        (half, "the median of “core” lies above 0.6 g, where nothing was run; give larger intensities"),
    ):
        rest = fragility(other, samples=100)
        assert rest.median > levels[-1]
        difference = with_undecided(many, other, curve, rest, 100, 0, 0.95)
        assert math.isnan(difference.ratio)
        assert difference.basis.startswith(f"Medians are not compared: {missing}.")
        assert "higher" not in difference.sentence
        assert rest.span == (levels[0], levels[-1])
        assert max(rest.drawn()["im"]) == pytest.approx(levels[-1])
        (axes,) = plots.draw_fragility([curve, rest]).axes[:1]
        assert max(line.get_xdata().max() for line in axes.lines if len(line.get_xdata())) <= levels[-1] * (1.0 + 1e-9)
        assert "> 0.6 g" in " ".join(text.get_text() for text in axes.figure.findobj(Text))


def test_the_comparison_is_printed_before_design_values_are_computed(tmp_path, monkeypatch, capsys):
    """A design value takes the governing runs once more; whoever waits reads the answer in the meantime."""
    column = block(0.6)
    bare, linked = (write_column(structure, tmp_path / f"{name}.toml") for structure, name in (
        (column, "bare"), (column.replace(links=(st.Dowel(joint=1, shear_stiffness=1e8, shear_capacity=1e5),)), "linked"),
    ))  # fmt: skip
    seen = []

    def stopped(*_, **__):
        seen.append(capsys.readouterr().out)
        raise st.InputError("far enough.")

    monkeypatch.setattr("stylobate.probability.design.design_values", stopped)
    assert call(["states", "--as-built", str(bare), "--with", str(linked), "--pulse", "ricker,1Hz,0.3g"]) == 2
    assert "“linked”" in seen[0]


def test_what_a_plane_says_of_round_columns_is_doubted_before_any_advice():
    square = block(0.6)
    round_ = square.replace(drums=[dataclasses.replace(drum, section="circular") for drum in square.drums])
    measures, conditions = ("as built", "dowels"), ("as built", "as found")
    for model in (st.DistinctElement2D(), st.DistinctElement3D(planar=True)):
        assert "no measure is to be adopted before" in doubt(measures, [round_], model)
        assert doubt(conditions, [round_], model).endswith("before relying on it.")
        assert doubt(measures, [square], model) == ""
    assert doubt(measures, [round_], st.DistinctElement3D()) == UNDAMPED_WOBBLE
    assert doubt(measures, [round_], st.DistinctElement3D(stiffness_damping=1e-4)) == ""


def test_a_median_with_undecided_runs_does_not_stand_as_an_interval(capsys):
    """It reaches from one end to another, as an interval does: its column says what it is, and of what the 95 % are."""
    ends = {"if_open_exceed": {"median": 0.8}, "if_open_do_not": {"median": 1.1}}
    curve = {"median": 0.9, "unit": "g", "undecided": 3, "failed": 0, "levels": [0.5, 1.5]} | ends
    (share,) = shares({"as built": np.array([EXCEEDED, OPEN, NOT_EXCEEDED])})
    fields = {"doubt": "", "differences": (), "state": "collapse", "links": ()}
    describe(SimpleNamespace(**fields, shares=[share], curves=[SimpleNamespace(summary=lambda: curve)]))
    text = " ".join(capsys.readouterr().out.split())
    assert "95 % of the share" in text
    assert "median (undecided both ways)" in text
    assert median_name(curve | {"undecided": 0}, None) == "median"
