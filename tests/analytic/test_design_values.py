"""Design values of links: force and slip by hand, fractiles and intervals by counting, and the command that prints them."""

import dataclasses
import json
import math

import numpy as np
import pandas
import pytest

import stylobate as st
from stylobate.analysis.design_values import clearances, fractile, worst_of
from stylobate.cli.main import call
from stylobate.column.files import write_column

SMOOTH = st.Joint(1e9, 5e8, friction_coefficient=0.1)
BARE = st.Column.of_drums([st.Drum(1.0, 1.0, 1.0, 2500.0)], SMOOTH, name="bare")
DOWEL = st.Dowel(joint=1, shear_stiffness=1e8, shear_capacity=1e4, ultimate_slip=0.05)
DOWELLED = BARE.replace(links=(DOWEL,), name="dowelled")


@pytest.fixture(scope="module")
def found():
    motions = [st.ricker(frequency, st.g) for frequency in (0.3, 0.4, 0.5)]
    states = {"as built": BARE, "dowelled": DOWELLED}
    return st.compare_states(states, motions, st.DistinctElement2D(), [0.2, 0.3], samples=200, threads=1)


def test_a_dowel_bears_the_push_that_friction_leaves(found):
    """V = m (a − μ g), slip V/k, of slow pulses on a dowel of 32 Hz: inertia adds below 0.1 %, and 1 % is left for what the
    joint's stiffness rings with as it begins to slip."""
    values = st.design_values(found)
    assert set(values["state"]) == {"dowelled"}
    weight = BARE.mass * st.g
    for level in (0.2, 0.3):
        force, slip = (
            values[(values["level"] == level) & (values["quantity"] == one)].iloc[0] for one in ("shear force", "slip")
        )
        expected = (level - 0.1) * weight
        assert force["value_84"] == pytest.approx(expected, rel=0.01)
        assert force["use_value_84"] == pytest.approx(expected / 1e4, rel=0.01)
        assert slip["value_50"] == pytest.approx(expected / 1e8, rel=0.01)
        assert (force["runs"], force["records"], force["gone"], force["undecided"]) == (3, 3, 0, 0)
        # three records leave the upper limit to the capacity, that of the slip open
        assert (force["high_84"], slip["high_84"]) == (1e4, math.inf)


def test_what_collapses_is_lost_or_undecided_exceeds_every_slip(found):
    """Of three runs of 0.3 g one collapses, one is undecided: by the rules, with the peaks as they are."""
    table = found.table.copy()
    mine = table.index[(table["state"] == "dowelled") & (table["im"] == 0.3)]
    table.loc[mine[1], "verdict"], table.loc[mine[2], "verdict"] = "collapsed", "undecided"
    values = st.design_values(dataclasses.replace(found, table=table))
    force, slip = (
        values[(values["level"] == 0.3) & (values["quantity"] == q)].iloc[0] for q in ("shear force", "slip")
    )
    peaks = [table.loc[i, "link_peak_slip_m"][0] for i in mine]
    assert (slip["gone"], slip["undecided"]) == (1, 1)
    assert slip["value_50"] == max(peaks[0], peaks[2])
    assert slip["value_84"] == math.inf
    assert force["value_84"] == 1e4
    assert force["use_value_84"] == 1.0
    table.loc[mine, "verdict"] = "failed"
    assert set(st.design_values(dataclasses.replace(found, table=table))["level"]) == {0.2}


@pytest.mark.parametrize("number", [20, 21, 72, 73])
def test_fractile_and_interval_by_counting(number):
    """One run a record: the fractile of the sample, and limits by Wilson's inequality itself, (x − p)² ≤ z² p (1 − p)/n."""
    x = np.random.default_rng(number).permutation(number) + 1.0
    z2 = 1.959964**2
    for share in (0.5, 0.84, 0.95):
        value, low, high = fractile(x, x, np.arange(number), share)
        assert value == np.quantile(x, share, method="inverted_cdf")
        counts = np.arange(1, number + 1)  # of the records up to a value, which is the value itself
        held, above = (counts / number - share) ** 2 <= z2 * share * (1.0 - share) / number, counts / number > share
        assert low == counts[held | above][0]
        assert high == min(counts[~held & above], default=math.inf)
    assert math.isfinite(fractile(x, x, np.arange(number), 0.84)[2]) == (number >= 21)
    assert math.isfinite(fractile(x, x, np.arange(number), 0.95)[2]) == (number >= 73)


def test_twins_of_a_record_count_as_one():
    """Each record ten times over, one a hundred times: nothing changes."""
    x = np.arange(1.0, 31.0)
    owner = np.repeat(np.arange(30), [10] * 29 + [100])
    assert fractile(x[owner], x[owner], owner, 0.84) == fractile(x, x, np.arange(30), 0.84)


def test_the_command_prints_writes_and_reports_them(tmp_path, capsys):
    bare, dowelled = (write_column(one, tmp_path / f"{one.name}.toml") for one in (BARE, DOWELLED))
    out = tmp_path / "out"
    asked = ["states", "--as-built", str(bare), "--with", str(dowelled), "--pulse", "ricker,0.4Hz,0.2g"]
    assert call([*asked, "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "Design values at the largest level" in said
    assert "shear force" in said
    table = pandas.read_csv(out / "design.csv")
    told = json.loads((out / "states.json").read_text())["design_values"]
    assert [one["quantity"] for one in told] == table["quantity"].tolist() == ["shear force", "slip"]
    assert told[1]["high_84"] is None  # beyond all that was computed
    assert worst_of(table)["quantity"].tolist() == ["shear force", "slip"]
    assert (out / "design.png").is_file()
    page = tmp_path / "page.html"
    assert call(["report", str(out), "--out", str(page)]) == 0
    assert "Design values at the largest level" in page.read_text()


def test_a_layer_with_a_spring_needs_the_clearance_of_its_slip():
    layer = st.Layer(joint=1, friction_coefficient=0.08, shear_stiffness=1e5)
    states = {"as built": BARE, "layer": BARE.replace(links=(layer,), name="layer")}
    found = st.compare_states(
        states, [st.ricker(0.5, st.g)], st.DistinctElement2D(), [0.2, 0.3], samples=200, threads=1
    )
    (told,) = clearances(st.design_values(found)).to_dict("records")
    table = found.table[(found.table["state"] == "layer") & (found.table["im"] == 0.3)]
    assert told["value_84"] == table["link_peak_slip_m"].iloc[0][0] > 0.01
    assert worst_of(st.design_values(found)).empty  # it has no capacity to be used


def test_what_is_no_comparison_of_states_is_refused():
    with pytest.raises(st.InputError, match="found"):
        st.design_values(BARE)  # pyright: ignore[reportArgumentType]
