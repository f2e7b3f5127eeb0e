"""Design values of links: force and slip by hand, fractiles and intervals by counting, and the command that prints them."""

import dataclasses
import json
import math
import re

import numpy as np
import pandas
import pytest

import stylobate as st
from stylobate.campaign.twins import LAW
from stylobate.cli.main import call
from stylobate.column.files import write_column
from stylobate.models.drums.links import link_histories
from stylobate.motion.motion import write_csv
from stylobate.probability.design import clearances, fractile, governing, values_of_runs, worst_of

SMOOTH = st.Joint(1e9, 5e8, friction_coefficient=0.1)
BARE = st.Column.of_drums([st.Drum(1.0, 1.0, 1.0, 2500.0)], SMOOTH, name="bare")
DOWEL = st.Dowel(joint=1, shear_stiffness=1e8, shear_capacity=1e4, ultimate_slip=0.05)
DOWELLED = BARE.replace(links=(DOWEL,), name="dowelled")


@pytest.fixture(scope="module")
def comparison():
    motions = [st.ricker(frequency, st.g) for frequency in (0.3, 0.4, 0.5)]
    states = {"as built": BARE, "dowelled": DOWELLED}
    return st.compare_states(states, motions, st.DistinctElement2D(), [0.2, 0.3], samples=200, threads=1)


def test_a_dowel_bears_the_push_that_friction_leaves(comparison):
    """V = m (a − μ g), slip V/k, of slow pulses on a dowel of 32 Hz: inertia adds below 0.1 %, and 1 % is left for what the
    joint's stiffness rings with as it begins to slip."""
    values = st.design_values(comparison)
    assert set(values["state"]) == {"dowelled"}
    weight = BARE.mass * st.g
    for level in (0.2, 0.3):
        force, slip = (
            values[(values["level"] == level) & (values["quantity"] == quantity)].iloc[0]
            for quantity in ("shear force", "slip")
        )
        expected = (level - 0.1) * weight
        assert force["value_84"] == pytest.approx(expected, rel=0.01)
        assert force["use_value_84"] == pytest.approx(expected / 1e4, rel=0.01)
        assert slip["value_50"] == pytest.approx(expected / 1e8, rel=0.01)
        assert (force["runs"], force["records"], force["gone"], force["undecided"]) == (3, 3, 0, 0)
        # three records leave the upper limit to the capacity, that of the slip open
        assert (force["high_84"], slip["high_84"]) == (1e4, math.inf)


def test_the_stone_limits_a_dowel_that_bears_more(comparison):
    """A dowel of 60 mm near the edge: what EN 1992-4 leaves the stone is its capacity, and a slip has that of the dowel."""
    size = {"diameter": 0.06, "embedment": 0.2, "material": "titanium"}
    near = BARE.replace(links=(st.Dowel(joint=1, at=(0.4, 0.0), **size),), name="dowelled")
    (link,) = near.placed_links
    assert link.stone.shear == link.shear_capacity < link.alone.shear_capacity
    values = values_of_runs({"dowelled": near}, comparison.table[comparison.table["state"] == "dowelled"])
    forces, slips = (values[values["quantity"] == quantity] for quantity in ("shear force", "slip"))
    assert set(forces["limited_by"]) == {"stone"}
    assert set(slips["limited_by"]) == {"link"}
    assert forces["use_value_84"].tolist() == (forces["value_84"] / link.stone.shear).tolist()
    assert slips["capacity"].tolist() == [link.ultimate_slip] * len(slips)


def test_what_collapses_is_lost_or_undecided_exceeds_every_slip(comparison):
    """Of three runs of 0.3 g one collapses, one is undecided: by the rules, with the peaks as they are."""
    table = comparison.table.copy()
    mine = table.index[(table["state"] == "dowelled") & (table["im"] == 0.3)]
    table.loc[mine[1], "verdict"], table.loc[mine[2], "verdict"] = "collapsed", "undecided"
    values = st.design_values(dataclasses.replace(comparison, table=table))
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
    assert set(st.design_values(dataclasses.replace(comparison, table=table))["level"]) == {0.2}


@pytest.mark.parametrize("number", [20, 21, 72, 73])
def test_fractile_and_interval_by_counting(number):
    """One run a record: the fractile of the sample, and limits by Wilson's inequality itself, (x − p)² ≤ z² p (1 − p)/n."""
    x = np.random.default_rng(number).permutation(number) + 1.0
    z2 = 1.959964**2
    for share in (0.5, 0.84, 0.95):
        value, low, high = fractile(x, x, np.arange(number), share)
        assert value == np.quantile(x, share, method="inverted_cdf")
        counts = np.arange(1, number + 1)  # of the records up to a value, which is the value itself
        inside, above = (counts / number - share) ** 2 <= z2 * share * (1.0 - share) / number, counts / number > share
        assert low == counts[inside | above][0]
        assert high == min(counts[~inside & above], default=math.inf)
    assert math.isfinite(fractile(x, x, np.arange(number), 0.84)[2]) == (number >= 21)
    assert math.isfinite(fractile(x, x, np.arange(number), 0.95)[2]) == (number >= 73)


def test_twins_of_a_record_count_as_one():
    """Each record ten times over, one a hundred times: nothing changes."""
    x = np.arange(1.0, 31.0)
    owner = np.repeat(np.arange(30), [10] * 29 + [100])
    assert fractile(x[owner], x[owner], owner, 0.84) == fractile(x, x, np.arange(30), 0.84)


def test_values_are_told_at_the_highest_level_at_which_few_collapse(comparison):
    """All three runs of 0.3 g collapse: 0.2 g is told, unless another level is asked for. Links alike keep their order."""
    table = comparison.table.copy()
    table.loc[(table["state"] == "dowelled") & (table["im"] == 0.3), "verdict"] = "collapsed"
    fallen = dataclasses.replace(comparison, table=table)
    for level, expected in ((None, 0.2), (0.3, 0.3)):
        values = st.design_values(fallen, level=level)
        assert set(values["level"]) == {0.2, 0.3}  # every one is in the table
        worst = worst_of(values)
        assert set(worst["level"]) == {expected}
        assert np.isfinite(worst["value_84"]).all() == (expected == 0.2)
        assert np.isfinite(values.loc[values["told"] & (values["unit"] == "N"), "instant_84_s"]).all() == (
            expected == 0.2
        )
    assert set(worst_of(st.design_values(comparison))["level"]) == {0.3}
    with pytest.raises(st.InputError, match=r"is 0\.4; allowed is one that was run: 0\.2, 0\.3"):
        st.design_values(comparison, level=0.4)
    names = [f"dowel in joint {k}" for k in range(1, 12)]
    alike = pandas.concat([values[values["unit"] == "N"].assign(link=name, use_value_84=1.0) for name in names])
    assert list(dict.fromkeys(worst_of(alike)["link"])) == names
    slips = [values[values["unit"] == "m"].assign(link=name, use_value_84=0.01 * k) for k, name in enumerate(names)]
    yielding = pandas.concat([alike, *slips])
    assert list(dict.fromkeys(worst_of(yielding)["link"])) == names[::-1]  # all bear what they can
    assert governing(yielding)["link"].tolist() == [names[-1]] * len(governing(yielding))
    assert set(governing(yielding)["quantity"]) == {"shear force", "slip"}


def test_the_command_prints_writes_and_reports_them(tmp_path, capsys):
    bare, dowelled = (write_column(column, tmp_path / f"{column.name}.toml") for column in (BARE, DOWELLED))
    out = tmp_path / "out"
    command = ["states", "--as-built", str(bare), "--with", str(dowelled), "--pulse", "ricker,0.4Hz,0.2g"]
    assert call([*command, "--out", str(out)]) == 0
    output = capsys.readouterr().out
    assert "Design values: not exceeded under 84 %" in output
    assert "the law of the joints is taken as known" in output
    assert "shear force" in output
    table = pandas.read_csv(out / "design.csv")
    rows = json.loads((out / "states.json").read_text())["design_values"]
    assert [row["quantity"] for row in rows] == table["quantity"].tolist() == ["shear force", "slip"]
    assert rows[1]["high_84"] is None  # beyond all that was computed
    assert worst_of(table)["quantity"].tolist() == ["shear force", "slip"]
    assert (out / "design.png").is_file()
    project, page = tmp_path / "project.toml", tmp_path / "page.html"
    project.write_text('client = "A"\nsite = "B"\nengineer = "C"\n')
    assert call(["report", str(out), "--project", str(project), "--out", str(page)]) == 0
    front, case = page.read_text().split("Sources of the results", 1)
    assert re.search(r"Design values that govern.*>× 1<.*>shear force<.*>kN<", front, re.DOTALL)
    assert "Design values: what" in case


def test_a_report_tells_how_the_motions_of_design_values_were_scaled(tmp_path):
    dowelled = write_column(DOWELLED, tmp_path / "dowelled.toml")
    project, page = tmp_path / "project.toml", tmp_path / "page.html"
    project.write_text('client = "A"\nsite = "B"\nengineer = "C"\n')
    (tmp_path / "recs").mkdir()
    for k, size in enumerate((1.0, 2.0)):
        write_csv(st.ricker(0.4, size), tmp_path / "recs" / f"{k}.csv")
    commands = {
        "scaled": ["suite", str(dowelled), str(tmp_path / "recs"), "--pga", "0.3g"],
        "as they are": ["suite", str(dowelled), str(tmp_path / "recs")],
        "models": ["compare", str(dowelled), "--models", "dem2d", "--pulse", "ricker,0.4Hz,0.2g"],
    }
    for name, arguments in commands.items():
        assert call([*arguments, "--out", str(tmp_path / name)]) == 0
    arguments = [str(tmp_path / name) for name in commands]
    assert call(["report", *arguments, "--project", str(project), "--out", str(page)]) == 0
    front = page.read_text().split("Sources of the results", 1)[0].split("Design values that govern", 1)[1]
    front = front.replace("\N{NO-BREAK SPACE}", " ")
    cells = [re.findall(rf'data-name="{name}">([^<]*)<', front) for name in ("case", "state", "level", "quantity")]
    quantities = ("shear force", "slip")
    assert list(zip(*cells, strict=True)) == [
        *(("1", "dowelled", "pga 0.3 g", quantity) for quantity in quantities),
        *(("2", "dowelled", "× 1", quantity) for quantity in quantities),
        *(("3", "dem2d", "pga 0.2 g", quantity) for quantity in quantities),
    ]


def test_a_layer_with_a_spring_needs_the_clearance_of_its_slip():
    layer = st.Layer(joint=1, friction_coefficient=0.08, shear_stiffness=1e5)
    states = {"as built": BARE, "layer": BARE.replace(links=(layer,), name="layer")}
    comparison = st.compare_states(
        states, [st.ricker(0.5, st.g)], st.DistinctElement2D(), [0.2, 0.3], samples=200, threads=1
    )
    (clearance,) = clearances(st.design_values(comparison)).to_dict("records")
    table = comparison.table[(comparison.table["state"] == "layer") & (comparison.table["im"] == 0.3)]
    assert clearance["value_84"] == table["link_peak_slip_m"].iloc[0][0] > 0.01
    assert worst_of(st.design_values(comparison)).empty  # it has no capacity to be used


def test_what_is_no_comparison_of_states_is_refused():
    with pytest.raises(st.InputError, match="comparison"):
        st.design_values(BARE)  # pyright: ignore[reportArgumentType]


def runs_of(peaks, laws, records):
    """Rows of runs with one dowel that bears these forces."""
    rows = [
        {"state": "dowelled", "im": 1.0, "record": record, "verdict": "stands", LAW: law, "link_broken_s": [None],
         "link_peak_shear_n": [peak], "link_peak_tension_n": [0.0], "link_peak_slip_m": [peak / 1e8],
         "link_peak_elongation_m": [0.0]}
        for peak, law, record in zip(peaks, laws, records, strict=True)
    ]  # fmt: skip
    return pandas.DataFrame(rows)


def test_intervals_hold_one_more_law_of_the_joints():
    """All 200 records the same, so that they leave only the laws: 10, 20 and 40 N under three. ln q has mean ln 20 and
    s = ln 2, and one more law lies within t(2) s √(1 + 1/3), t(2) = 4.302653 at 95 %: a factor of 2^4.968. Digits of t."""
    laws = np.tile([1, 2, 3], 200)
    runs = runs_of(np.array([10.0, 20.0, 40.0])[laws - 1], laws, np.repeat(np.arange(200), 3))
    factor = 2.0 ** (4.302653 * math.sqrt(4.0 / 3.0))
    slip = values_of_runs({"dowelled": DOWELLED}, runs).iloc[1]
    assert (slip["quantity"], slip["laws"], slip["records"]) == ("slip", 3, 200)
    assert slip["value_50"] == 20.0 / 1e8
    # over records 50 % lie on the edge of nothing: 1/3 of them below, 2/3 up to the value
    assert slip["high_50"] == pytest.approx(20.0 / 1e8 * factor, rel=1e-5)
    assert slip["low_50"] == pytest.approx(20.0 / 1e8 / factor, rel=1e-5)
    alone = values_of_runs({"dowelled": DOWELLED}, runs.drop(columns=LAW)).iloc[1]
    assert (alone["laws"], alone["low_50"], alone["high_50"]) == (0, 20.0 / 1e8, 20.0 / 1e8)


def test_limits_over_records_and_laws_add_by_their_squares_and_one_law_tells_nothing():
    """Factors e^a over records and e^b over two laws make e^√(a² + b²), each by a table of one of them; digits of t(1)."""
    x = np.exp(np.random.default_rng(1).normal(size=60))
    records = np.tile(np.arange(60), 2)
    both = values_of_runs({"dowelled": DOWELLED}, runs_of(np.append(x, 1.1 * x), np.repeat([1, 2], 60), records)).iloc[
        1
    ]
    known = values_of_runs({"dowelled": DOWELLED}, runs_of(np.append(x, 1.1 * x), np.zeros(120), records)).iloc[1]
    middle, far = math.log(math.sqrt(1.1)), 12.7062 * math.log(1.1) / math.sqrt(2.0) * math.sqrt(1.5)
    q = fractile(x, x, np.arange(60), 0.84)[0] / 1e8
    by_law = math.log(q) + middle + far - math.log(known["value_84"])
    expected = math.hypot(by_law, math.log(known["high_84"] / known["value_84"]))
    assert math.log(both["high_84"] / both["value_84"]) == pytest.approx(expected, rel=1e-4)
    single_law = values_of_runs({"dowelled": DOWELLED}, runs_of(x, np.ones(60), np.arange(60))).iloc[1]
    assert (single_law["low_84"], single_law["high_84"]) == (0.0, math.inf)


@pytest.mark.parametrize("azimuth", [30.0, 200.0])
def test_the_peak_of_a_dowel_acts_with_the_ground_at_its_largest_acceleration(azimuth):
    """A slow pulse along an azimuth: the dowel pulls the block along with the ground, at the middle of the pulse. It turns
    there as cos, so that ringing of 1 % (of V, 2 μg of 3 a) takes the instant off by its root over 2π f, 0.05 s; the block
    only slides, so that 0.01° is rounding of the joint's friction."""
    pulse, way = st.ricker(0.4, 0.3 * st.g), math.radians(azimuth)
    shaken = st.Motion(pulse.dt, math.cos(way) * pulse.acceleration, math.sin(way) * pulse.acceleration, name="pulse")
    strong = BARE.replace(links=(dataclasses.replace(DOWEL, shear_capacity=1e5),), name="strong")
    table = st.suite_table([strong, BARE], [shaken.scaled(0.9), shaken], st.DistinctElement3D(), threads=1)
    force, slip = table.attrs["design_values"]
    assert force["azimuth_84_deg"] == pytest.approx(azimuth, abs=0.01)
    middle = int(np.argmax(pulse.acceleration)) * pulse.dt
    assert force["instant_84_s"] == pytest.approx(middle, abs=0.05)
    assert force["value_84"] == pytest.approx(0.2 * BARE.mass * st.g, rel=0.01)
    assert math.isnan(slip["instant_84_s"])


def test_only_a_run_that_stands_or_is_open_tells_an_instant(comparison):
    """In the plane the dowel pulls towards x, 0°; where the value is that of a collapse, nothing is told."""
    values = st.design_values(comparison)
    forces = values[values["quantity"] == "shear force"].set_index("level")
    assert forces.loc[0.3, "azimuth_84_deg"] == 0.0
    assert forces.loc[0.3, "record_84"] in set(comparison.table["record"])
    assert math.isnan(forces.loc[0.2, "instant_84_s"])  # only at the largest level
    fell = dataclasses.replace(comparison, table=comparison.table.assign(verdict="collapsed"))
    assert set(st.design_values(fell)["record_84"]) == {None}
    assert st.design_values(fell)["instant_84_s"].isna().all()
    assert st.design_values(comparison, instants=False)["instant_84_s"].isna().all()


def test_the_instant_of_a_peak_between_recorded_states_is_that_of_the_peak():
    """Recorded shear 1, 3, 2, 2 N, of which 5 N were reached between the third and the fourth state: not at the second."""
    rows = {"shear": [1, 3, 2, 2], "tension": [0] * 4, "slip": [0] * 4, "elongation": [0] * 4}
    rows |= {"angle": [0.0, 0.1, 0.2, 0.3], "peak": [1, 3, 3, 5], "pull": [0] * 4}
    states = [{"links": np.array(instant, dtype=float)[:, None]} for instant in zip(*rows.values(), strict=True)]
    histories = link_histories(states)
    assert histories is not None
    assert histories.reached is not None
    assert histories.reached.tolist() == [[3], [0]]
    assert histories.angle is not None
    assert histories.angle[:, 0].tolist() == rows["angle"]


def test_a_limit_a_thousand_times_off_is_none():
    """Two laws of 1 and 2 N: t(1) takes ln q off by 12.7062·ln 2/√2·√1.5 = 7.63, a factor of 2050."""
    laws = np.tile([1, 2], 100)
    slip = values_of_runs({"dowelled": DOWELLED}, runs_of(1.0 * laws, laws, np.repeat(np.arange(100), 2))).iloc[1]
    assert (slip["value_95"], slip["low_95"], slip["high_95"]) == (2.0 / 1e8, 0.0, math.inf)


def test_a_suite_and_models_tell_the_same_values_as_states(tmp_path, capsys, comparison):
    """The same runs through three verbs, bit for bit; one motion leaves the upper limit at the capacity."""
    motions = [st.ricker(frequency, st.g).scaled(0.3) for frequency in (0.3, 0.4, 0.5)]
    model = st.DistinctElement2D()
    rows = st.suite_table([BARE, DOWELLED], motions, model, threads=1).attrs["design_values"]
    expected = st.design_values(comparison)
    expected = expected[expected["level"] == 0.3]
    assert [row["value_84"] for row in rows] == expected["value_84"].tolist()
    assert [row["high_84"] for row in rows] == expected["high_84"].tolist()
    models = [model, st.DistinctElement2D(points=3)]
    side = st.design_values(st.compare_models(DOWELLED, motions[0], models, labels=["a", "b"]))
    assert side["state"].tolist() == ["a", "a", "b", "b"]
    assert side["value_84"].tolist()[:2] == pytest.approx(
        [0.2 * BARE.mass * st.g, 0.2 * BARE.mass * st.g / 1e8], rel=0.01
    )
    assert side["high_84"].tolist() == [1e4, math.inf] * 2
    path, out = write_column(DOWELLED, tmp_path / "dowelled.toml"), tmp_path / "out"
    line = ["compare", str(path), "--models", "dem2d,dem2d:points=3", "--pulse", "ricker,0.4Hz,0.3g", "--out", str(out)]
    assert call(line) == 0
    assert "Design values: not exceeded" in capsys.readouterr().out
    assert (out / "design.csv").is_file()
    page = tmp_path / "page.html"
    assert call(["report", str(out), "--out", str(page)]) == 0
    assert "Design values: what" in page.read_text()


def test_the_moat_of_an_isolated_column_in_a_suite_is_its_largest_slip(tmp_path, capsys):
    """One record: its slip is the value, and twins of the column move it; the command prints, writes and reports it."""
    layer = st.Layer(joint=1, friction_coefficient=0.08, shear_stiffness=1e5)
    path = write_column(BARE.replace(links=(layer,), name="isolated"), tmp_path / "isolated.toml")
    line = ["suite", str(path), "sample:el-centro-1940", "--replicates", "3", "--threads", "1"]
    out, page = tmp_path / "out", tmp_path / "page.html"
    assert call([*line, "--out", str(out)]) == 0
    assert "Clearance that layers need [m]: not exceeded" in capsys.readouterr().out
    (clearance,) = clearances(pandas.DataFrame(json.loads((out / "suite.json").read_text())["design_values"])).to_dict(
        "records"
    )
    assert (clearance["runs"], clearance["records"], clearance["laws"]) == (4, 1, 0)
    own = json.loads((out / "suite.json").read_text())["runs"][0]["link_peak_slip_m"][0]
    assert clearance["low_84"] <= own <= clearance["value_84"]
    assert call(["report", str(out), "--out", str(page)]) == 0
    assert "Clearance that layers need around the foot" in page.read_text()


def test_the_moat_of_an_isolator_is_twice_its_static_slip_under_a_sudden_push():
    """Undamped, m ü + k u = −m a from rest has its peak 2 a m/k after half a period, friction μ takes 2 μ g m/k of it.

    1e-3 is left for the joint's own spring, 1e4 times as stiff as the isolator, and the damping of its joint.
    """
    slip, push, friction = 0.1, 0.5, 1e-3
    stiffness = BARE.mass * push / slip
    layer = st.Layer(joint=1, friction_coefficient=friction, shear_stiffness=stiffness)
    isolated = BARE.replace(links=(layer,), name="isolated")
    motion = st.Motion(0.01, np.full(400, push), name="step")
    rows = st.suite_table([isolated], [motion], st.DistinctElement2D(), threads=1).attrs["design_values"]
    (moat,) = clearances(pandas.DataFrame(rows)).to_dict("records")
    assert moat["value_84"] == pytest.approx(2.0 * (push - friction * st.g) * BARE.mass / stiffness, rel=1e-3)
    assert moat["high_84"] == math.inf  # one record
