"""Earthquakes one after another: one run of all of them, to the bit; what each leaves, and how many it takes."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import stylobate as st
from stylobate.motion import in_sequence, spans_of
from stylobate.motion.sequence import Span, number_at
from stylobate.verdicts.sequence import Count, SequenceResult
from stylobate.verdicts.verdict import wilson_interval

SLIPPERY = st.Joint(5e8, 2.5e8, 20.0)
ROUGH = st.Joint(5e8, 2.5e8, 40.0)
COLUMN = st.Column.tapered(height=3.0, bottom_width=0.8, top_width=0.6, drums=2, density=2000.0, joint=SLIPPERY)
MONOLITH = st.Column.tapered(height=2.0, bottom_width=0.5, top_width=0.5, drums=1, density=2000.0, joint=ROUGH)
FIRST = st.Motion(0.01, 4.0 * np.sin(np.linspace(0.0, 2.0 * np.pi, 61)), name="first")
SECOND = st.Motion(0.01, 3.0 * np.sin(np.linspace(0.0, 4.0 * np.pi, 81)), name="second")
REST = 0.5


def plane_assembly():
    tall = st.Block([[0.0, 0.0], [0.2, 0.0], [0.2, 1.0], [0.0, 1.0]], 2000.0, name="tall")
    low = st.Block([[2.0, 0.0], [2.6, 0.0], [2.6, 0.5], [2.0, 0.5]], 2000.0, name="low")
    return st.Assembly((tall, low), ROUGH)


def spatial_assembly():
    return st.SpatialAssembly(
        (
            st.Stone.box((0.4, 0.4, 0.8), (0.0, 0.0, 0.0), 2000.0, name="high"),
            st.Stone.box((0.5, 0.4, 0.3), (1.0, 0.0, 0.0), 2000.0, name="low"),
        ),
        st.Joint(5e7, 2.5e7, 20.0),
    )


def by_hand(*motions, rest=REST):
    zeros = np.zeros(round(rest / 0.01))
    return np.concatenate([part for samples in motions for part in (samples, zeros)])


@pytest.mark.parametrize(
    ("structure", "model"),
    [
        (COLUMN, st.DistinctElement2D()),
        (COLUMN, st.RigidBlock()),
        (COLUMN, st.RigidBeam()),
        (MONOLITH, st.HousnerBlock()),
        (COLUMN, st.DistinctElement3D()),
        (plane_assembly(), st.DistinctElement2D()),
        (spatial_assembly(), st.DistinctElement3D()),
    ],
    ids=["dem2d", "rigid-block", "rigid-beam", "housner", "dem3d", "blocks", "stones"],
)
def test_a_sequence_is_one_run_of_both_with_rest_between_to_the_bit(structure, model):
    result = st.sequence(structure, [FIRST, SECOND], model, rest=REST)
    whole = st.Motion(0.01, by_hand(FIRST.acceleration, SECOND.acceleration))
    once = st.simulate(structure, whole, model)
    assert result.response.measures == once.measures
    for name in ("time", "opening", "slip", "twist", "body_position", "body_orientation"):
        np.testing.assert_array_equal(getattr(result.response, name), getattr(once, name))
    for term, values in once.histories.energy.items():
        np.testing.assert_array_equal(result.response.histories.energy[term], values)
    assert [event.number for event in result.events] == [1, 2]
    assert result.events[1].run is result.response
    early, late = result.events
    assert early.run.time[-1] == pytest.approx(early.span.ends, abs=0.03)
    # what the first left and the second added is what both leave, joint by joint
    sums = np.add(early.run.residuals.slip_x, late.added.slip_x)
    np.testing.assert_allclose(sums, result.response.residuals.slip_x, atol=2e-3)
    assert early.summary()["outcome"] in ("at_rest", "rocked", "displaced")


def test_two_components_are_joined_alike():
    both = [st.Motion(0.01, motion.samples, 0.5 * motion.samples, -0.1 * motion.samples) for motion in (FIRST, SECOND)]
    joined = in_sequence(both, REST)
    for name, share in (("acceleration", 1.0), ("lateral", 0.5), ("vertical", -0.1)):
        expected = by_hand(share * FIRST.acceleration, share * SECOND.acceleration)
        np.testing.assert_array_equal(getattr(joined, name), expected)
    spans = spans_of(joined)
    assert [(span.begins, span.quiet, span.ends) for span in spans] == [
        pytest.approx((0.0, 0.6, 1.1)),
        pytest.approx((1.11, 1.91, 2.41)),
    ]
    assert spans_of(joined.scaled(2.0)) == spans  # a factor does not move them
    assert spans_of(FIRST) == ()


def test_steps_that_differ_are_divided_and_said():
    """0.02 s and 0.015 s are multiples of 0.005 s; between samples the acceleration was linear before, too."""
    coarse = st.Motion(0.02, np.array([0.0, 1.0, -2.0, 0.5]), name="coarse")
    fine = st.Motion(0.015, np.array([1.0, 3.0, 0.0]), name="fine")
    joined = in_sequence([coarse, fine], 0.01)
    assert joined.dt == pytest.approx(0.005)
    for motion, span in zip((coarse, fine), spans_of(joined), strict=True):
        inside = (joined.time >= span.begins - 1e-9) & (joined.time <= span.quiet + 1e-9)
        expected = np.interp(joined.time[inside] - span.begins, motion.time, motion.acceleration)
        np.testing.assert_allclose(joined.acceleration[inside], expected, atol=1e-12)
        assert any(step.startswith(f"{motion.name}: step of") for step in joined.processing)
    with pytest.raises(st.InputError, match="have no common one"):
        in_sequence([coarse, st.Motion(0.01 * math.pi, np.ones(3))])


def test_a_block_that_slides_slides_as_far_each_time():
    """Ground at -a for t and quiet then: a block of friction tan φ slides (a - g tan φ) t²/2 and on with the velocity."""
    low = st.Column.tapered(height=0.3, bottom_width=0.8, top_width=0.8, drums=1, density=2000.0, joint=SLIPPERY)
    push, length = 6.0, 0.3
    holds = st.g * math.tan(math.radians(20.0))
    speed = (push - holds) * length
    way = 0.5 * speed * length + 0.5 * speed**2 / holds
    motion = st.Motion(0.002, np.full(round(length / 0.002) + 1, -push))
    result = st.sequence(low, motion, st.DistinctElement2D(), rest=1.0, repeat=3)
    assert [event.added.slip_x[0] for event in result.events] == pytest.approx([way] * 3, rel=0.04)
    assert result.response.residuals.slip_x[0] == pytest.approx(3.0 * way, rel=0.04)
    assert [event.at_rest for event in result.events] == [True] * 3
    assert result.unsettled == ()
    table = result.table
    assert table["residual_slip_m"].tolist() == pytest.approx([way, 2.0 * way, 3.0 * way], rel=0.04)
    assert np.allclose(table["added_slip_m"], way, rtol=0.04)


def test_a_column_falls_once_and_the_run_ends_there():
    hard = st.Motion(0.01, 12.0 * np.sin(np.linspace(0.0, 2.0 * np.pi, 121)), name="hard")
    gentle = FIRST.scaled(0.1)
    result = st.sequence(MONOLITH, [gentle, hard, gentle], st.DistinctElement2D(), rest=1.0)
    assert (result.fell_in, len(result.events)) == (2, 2)
    first, second = result.events
    assert not first.run.collapsed
    assert first.run.summary()["decided"]
    assert second.run.summary() == result.response.summary()
    assert second.added is None
    assert math.isnan(second.peak_rotation)
    assert result.sentence.startswith("It falls in earthquake 2 of 3 (hard). The run ends there")
    assert result.summary()["events"][1]["alone"]["added_slip_m"] is None


def test_an_assembly_goes_on_when_a_block_has_fallen():
    result = st.sequence(
        plane_assembly(), [FIRST.scaled(0.1), FIRST.scaled(1.2), FIRST], st.DistinctElement2D(), rest=2.0
    )
    assert [event.fallen for event in result.events] == [(), ("tall",), ()]
    assert [event.run.fallen for event in result.events] == [(), ("tall",), ("tall",)]
    assert [event.run.summary()["fallen"] for event in result.events] == [[], ["tall"], ["tall"]]
    assert result.fell_in == 2
    assert result.sentence.startswith("1 body falls in earthquake 2 of 3")
    assert result.events[2].span.ends == pytest.approx(result.response.time[-1], abs=0.02)


def test_a_link_stays_broken():
    weak = st.Dowel(joint=1, shear_stiffness=1e8, shear_capacity=2e3, failure="brittle")
    result = st.sequence(
        COLUMN.replace(links=[weak]), [FIRST.scaled(0.01), FIRST.scaled(2.0), FIRST], st.DistinctElement2D(), rest=0.5
    )
    assert [len(event.broken) for event in result.events] == [0, 1, 0]
    assert [event.run.summary()["links_broken"] for event in result.events] == [0, 1, 1]


def test_counts_are_told_with_what_is_not_known():
    """Of six that were counted to four: falls in 1, 2, 2 and 4, one still rocks at the end, one stands."""
    spans = [Span("one", float(k), k + 0.5, k + 1.0) for k in range(4)]

    def row(time=None, decided=True, outcome="displaced"):
        collapsed = time is not None
        return {"outcome": "collapsed" if collapsed else outcome, "collapsed": collapsed, "decided": decided,
                "collapse_time_s": time}  # fmt: skip

    rows = [row(0.1), row(1.0), row(1.9), row(3.5), row(decided=False), row(), row(outcome="failed")]
    count = Count.of_rows(rows, spans)
    assert (count.low, count.high, count.failed) == ((1, 2, 2, 4, 4, 5), (1, 2, 2, 4, 5, 5), 1)
    assert count.median == (2, 2)
    assert count.interval == (1, 5)  # of six, the smallest and the largest: 97 %
    assert count.sentence == "median of 6: 2 (95 %: 1 to more than 4); 1 more failed"
    assert count.summary()["interval_high"] is None
    assert Count((5, 5), (5, 5), 4).sentence == "median of 2: more than 4 (no interval of fewer than 6)"
    assert [number_at(spans, time) for time in (None, math.nan, 0.0, 0.99, 3.2, 9.0)] == [None, None, 1, 1, 4, 4]


def test_the_interval_of_a_median_holds_it_as_often_as_it_says():
    """Of the order of uniform numbers alone: the interval of a median of 15 holds it in at least 95 % of 2000 samples."""
    drawn = np.random.default_rng(3).integers(1, 1_000_001, (2000, 15))
    inside = []
    for counts in drawn:
        low, high = Count(tuple(counts.tolist()), tuple(counts.tolist()), 2_000_000).interval
        inside.append(low <= 500_000 <= high)
    assert 0.945 < np.mean(inside) < 0.985


def test_how_many_it_takes_of_a_kind():
    hard = st.Motion(0.01, 12.0 * np.sin(np.linspace(0.0, 2.0 * np.pi, 121)), name="hard")
    until_fall = st.earthquakes_until_fall(MONOLITH, [hard, FIRST.scaled(0.1)], st.DistinctElement2D(), 2, rest=0.5)
    assert [count.sentence for count in until_fall.each] == ["1", "more than 2"]
    assert until_fall.over_motions.median == (1, 1)
    assert until_fall.table["not_fallen"].tolist() == [0, 1]
    with_twins = st.earthquakes_until_fall(MONOLITH, hard, st.DistinctElement2D(), 2, rest=0.5, replicates=7, seed=2)
    assert len(with_twins.each[0].low) == 7
    riding = st.sequence(MONOLITH, hard, st.DistinctElement2D(), repeat=2, rest=0.5, replicates=7, seed=2)
    assert riding.falls == with_twins.each[0]
    assert riding.table["fallen_share"].iloc[-1] == 1.0


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: in_sequence([]), "no motion is given"),
        (lambda: in_sequence(FIRST, rest=-1.0), "`rest` is -1"),
        (lambda: in_sequence(FIRST, repeat=0), "`repeat` is 0"),
        (lambda: in_sequence(FIRST, repeat=5000), "`repeat` is 5000"),
        (lambda: in_sequence([FIRST] * 20, repeat=100), "2000 earthquakes are asked for"),
        (lambda: in_sequence([FIRST, st.Motion(0.01, SECOND.samples, SECOND.samples)]), "has the components x and"),
        (lambda: in_sequence([FIRST.replace(dt=1e-5)] * 100, rest=3600.0), "samples; allowed is up to"),
        (lambda: st.earthquakes_until_fall(COLUMN, [], st.DistinctElement2D()), "no motion is given"),
        (lambda: st.earthquakes_until_fall(COLUMN, FIRST, st.DistinctElement2D(), 0), "most is 0"),
        (
            lambda: st.sequence(
                COLUMN, FIRST.replace(dt=1.0), st.RigidBeam(), rest=3600.0, repeat=20, output_interval=1e-3
            ),
            "states of|would take",
        ),
    ],
)
def test_what_cannot_be_used_is_refused_in_a_sentence(call, message):
    with pytest.raises(st.InputError, match=message) as refused:
        call()
    assert str(refused.value).count("\n") == 0


def test_records_leave_their_quiet_out_as_any_run_does():
    """The same bits as one run with the share of quiet of records; a block that slides slides as far when all is stepped."""
    low = st.Column.tapered(height=0.3, bottom_width=0.8, top_width=0.8, drums=1, density=2000.0, joint=SLIPPERY)
    recorded = [motion.scaled(2.0).replace(metadata={"format": "columns"}) for motion in (FIRST, SECOND)]
    result = st.sequence(low, recorded, st.DistinctElement2D(), rest=20.0)
    whole = st.Motion(0.01, by_hand(*(motion.acceleration for motion in recorded), rest=20.0))
    once = st.simulate(low, whole, st.DistinctElement2D(), quiet=0.1)
    assert result.response.measures == once.measures
    assert result.response.measures.stepped[2] < 0.6 * whole.duration
    all_of_it = st.sequence(low, recorded, st.DistinctElement2D(), rest=20.0, whole=True)
    assert all_of_it.response.measures.stepped is None
    for mine, other in zip(result.events, all_of_it.events, strict=True):
        assert abs(other.added.slip_x[0]) > 5e-4
        np.testing.assert_allclose(mine.added.slip_x, other.added.slip_x, atol=1e-4)


def test_pictures_are_drawn():
    from stylobate import plots

    for structure in (COLUMN, plane_assembly()):
        result = st.sequence(structure, [FIRST, SECOND], st.DistinctElement2D(), rest=REST)
        plots.draw_sequence(result.response, result.events).draw_without_rendering()
        plots.draw_ends(result.response, result.events).draw_without_rendering()


def test_components_that_the_model_leaves_out_need_not_be_alike():
    """A record with a component across and one without, by a plane model: the one across is left out, and told."""
    across = FIRST.replace(ay=0.5 * FIRST.samples)
    result, same = (
        st.sequence(COLUMN, [motion, SECOND], st.DistinctElement2D(), rest=REST) for motion in (across, FIRST)
    )
    assert "first: second horizontal component" in result.response.provenance["left_out"][0]
    assert result.response.measures == same.response.measures


def test_undecided_runs_widen_the_share_that_has_fallen_and_a_fall_without_a_time_is_one():
    """Of four under two earthquakes one fell in the first, one at the end without a time, one stands, one is undecided."""
    sound = {"outcome": "rocked", "collapsed": False, "decided": True, "collapse_time_s": None}
    fell = sound | {"outcome": "collapsed", "collapsed": True}
    rows = [fell | {"collapse_time_s": 0.3}, fell, sound, sound | {"decided": False}]
    spans = [Span("a", 0.0, 0.5, 1.0), Span("b", 1.0, 1.5, 2.0)]
    assert Count.of_rows(rows, spans) == Count((1, 2, 3, 2), (1, 2, 3, 3), 2)
    response = st.sequence(COLUMN, [FIRST, SECOND], st.RigidBlock(), rest=REST).response
    whole = in_sequence([FIRST, SECOND], REST)
    table = SequenceResult(response, whole, SimpleNamespace(drawn=SimpleNamespace(groups=()), rows=rows), 0.0).table
    assert table["fallen_share"].iloc[-1] == 0.5
    low, high = wilson_interval(np.array([2, 3]), np.array([4, 4]))
    assert table["fallen_share_low"].iloc[-1] == pytest.approx(low[0])
    assert table["fallen_share_high"].iloc[-1] == pytest.approx(high[1])
