"""Chosen records: factors, bounds and limits that hold for whatever is chosen, and the choice beside all that there are."""

from __future__ import annotations

import re
from itertools import combinations

import numpy as np
import pytest

import stylobate as st
from stylobate.codes.records import OWN_MISFIT, RecordRange, select_records
from stylobate.motion.events import recorded_again
from stylobate.motion.intensity import parse_measure
from stylobate.motion.specs import parse_synthetic
from stylobate.motion.spectra import pseudo_acceleration


@pytest.fixture(scope="module")
def motions():
    return [
        parse_synthetic(f"greece,{m}Mw,{r}km,seed={k}").replace(name=f"record {k}")
        for k, (m, r) in enumerate(
            [(6.0, 10), (6.5, 20), (6.8, 15), (7.0, 30), (6.2, 8), (6.6, 12), (7.0, 20), (6.4, 25)]
        )
    ]


def _table(tmp_path, motion, times):
    t = np.geomspace(0.05, 5.0, 400)
    values = times * pseudo_acceleration(motion, t)
    file = tmp_path / "target.csv"
    file.write_text("period_s,sa_m_s2\n" + "\n".join(f"{a:.17g},{b:.17g}" for a, b in zip(t, values)) + "\n")
    return st.target_spectrum(str(file))


def test_a_record_that_is_the_target(tmp_path, motions):
    """Its own spectrum 1.5 times: multiplied by 1.5, over all periods within what lies between rows of the table."""
    selection = select_records(motions, _table(tmp_path, motions[2], 1.5), 1)
    assert selection.table["record"].tolist() == ["record 2"]
    assert selection.table["factor"][0] == pytest.approx(1.5, rel=2e-3)
    assert selection.ratio == pytest.approx(np.ones_like(selection.ratio), rel=0.03)
    assert selection.meets
    assert np.array_equal(selection.motions[0].samples, motions[2].samples)


@pytest.mark.parametrize("count", [2, 3])
def test_exchanges_reach_the_best_of_all_sets(tmp_path, motions, count):
    """The misfit of the chosen set is at most 5 % above that of the best of all sets."""
    target = st.target_spectrum("ec8,ag=0.2g,soil=B")
    wide = {"factors": (0.1, 10.0), "least": 0.1}
    each = [select_records([motion], target, 1, **wide) for motion in motions]
    own = np.array([selection.spectra[0] * selection.table["factor"][0] ** 0 for selection in each])
    best = own / np.exp(np.log(own / each[0].wanted).mean(axis=1))[:, None] / each[0].wanted

    def misfit(chosen):
        mean = best[list(chosen)].mean(axis=0)
        level = np.exp(np.log(mean).mean())
        alone = np.sqrt((np.log(best[list(chosen)]) ** 2).mean(axis=1)).mean()
        return np.sqrt(((mean / level - 1.0) ** 2).mean()) + OWN_MISFIT * alone

    names = [motion.name for motion in motions]
    records = select_records(motions, target, count, **wide).table["record"]
    least = min(map(misfit, combinations(range(len(motions)), count)))
    assert misfit([names.index(name) for name in records]) <= 1.05 * least


def test_bounds_and_limits_hold(motions):
    target = st.target_spectrum("ec8,ag=0.2g,soil=B")
    selection = select_records(motions, target, 4, factors=(0.2, 6.0))
    assert selection.meets
    assert selection.ratio.min() >= 0.9 - 1e-9
    assert selection.pga_over_target >= 1.0 - 1e-9
    assert ((selection.table["factor"] >= 0.2) & (selection.table["factor"] <= 6.0)).all()
    for motion, row in zip(selection.motions, selection.spectra, strict=True):
        assert pseudo_acceleration(motion, selection.periods) == pytest.approx(row)
    short = select_records(motions, target, 4, factors=(0.2, 6.0), least=1.9)
    assert (short.table["factor"] <= 6.0).all()
    assert ("does not meet" in short.sentence) == (not short.meets)


def test_ranges_and_events(motions):
    target = st.target_spectrum("ec8,ag=0.2g,soil=B")
    recordings = [
        motion.replace(metadata={**motion.metadata, "event": "A" if k < 5 else f"{k}"})
        for k, motion in enumerate(motions)
    ]
    selection = select_records(recordings, target, 4, factors=(0.01, 100.0), per_event=1)
    assert (selection.table["event"] == "A").sum() <= 1
    with pytest.raises(st.InputError, match="4 records can be chosen with at most 1 of one event"):
        select_records(recordings, target, 5, factors=(0.01, 100.0), per_event=1)
    about = {motion.name: {"magnitude": 6.0 + 0.1 * k} for k, motion in enumerate(motions)}
    wanted = [RecordRange("magnitude", 6.25, 6.75), RecordRange(parse_measure("pgv"), 0.0, 10.0)]
    selection = select_records(motions, target, 3, factors=(0.01, 100.0), wanted=wanted, about=about)
    assert set(selection.refused) == {"record 0", "record 1", "record 2"}
    with pytest.raises(st.InputError, match="0 of 8 records can be used, and 3 are asked for"):
        select_records(motions, target, 3, wanted=[RecordRange("distance_km", 0.0, 10.0)])


def test_wider_limits_that_are_told_let_in_as_many_as_are_asked_for(motions):
    target = st.target_spectrum("ec8,ag=0.2g,soil=B")
    spread = [motion.scaled(1.6**k) for k, motion in enumerate(motions)]
    with pytest.raises(st.InputError, match="Factors from ") as caught:
        select_records(spread, target, 6, factors=(0.9, 1.1))
    low, high = map(float, re.search(r"Factors from (\S+) to (\S+) would let in as many", str(caught.value)).groups())
    assert len(select_records(spread, target, 6, factors=(low, high)).table) == 6
    with pytest.raises(st.InputError, match=r"[45] of 8 records can be used, and 6 are asked for"):
        select_records(
            spread, target, 6, factors=(1.005 * low if low < 0.9 else low, high / 1.01 if high > 1.1 else high)
        )


def test_a_recording_in_two_files_counts_once(motions):
    """Scaled, resampled, its components in other places or alone: the one with more of them is the record."""
    target = st.target_spectrum("ec8,ag=0.2g,soil=B")
    pair = motions[1].replace(lateral=np.resize(motions[2].samples, len(motions[1].samples)), name="both")
    fine = np.interp(
        np.arange(2 * len(motions[1].samples) - 1), 2 * np.arange(len(motions[1].samples)), motions[1].samples
    )
    alone = st.Motion(0.5 * motions[1].dt, 1.7 * fine, name="alone")
    selection = select_records([alone, pair, *motions[3:]], target, 3, factors=(0.01, 100.0))
    assert selection.refused == {"alone": "it is the recording of 'both' once more; a record counts once"}


def test_a_recording_that_wider_limits_let_in_twice_counts_once(motions):
    """The file with more components is the record, wherever its factor lies."""
    target = st.target_spectrum("ec8,ag=0.2g,soil=B")
    factor = select_records(motions[:1], target, 1, factors=(0.01, 100.0)).table["factor"][0]
    recording = motions[0].scaled(factor)
    weak = recording.scaled(0.1).replace(vertical=0.3 * recording.samples, name="weaker, with a vertical component")
    with pytest.raises(
        st.InputError, match=r"1 of 2 records can be used, and 2 are asked for; .* give more\. The first"
    ):
        select_records([recording, weak], target, 2, factors=(0.5, 2.0))


def test_one_recording_processed_otherwise_is_told(motions):
    dt, (x, y) = motions[0].dt, (np.resize(motion.samples, 3000) for motion in motions[:2])
    t, many = dt * np.arange(3000), list(motions[2:])
    both, alone = st.Motion(dt, x, y), st.Motion(dt, x)
    drifting = x + 0.01 * np.abs(x).max() * (t / t[-1] - 0.5)
    turned = [st.Motion(dt, np.cos(a) * x - np.sin(a) * y, np.sin(a) * x + np.cos(a) * y) for a in (0.1, 0.7, 2.0)]
    mirrored = st.Motion(dt, y, -3.0 * x)
    coarse = st.Motion(4 * dt, np.interp(np.arange(0.0, t[-1], 4 * dt), t, x))
    late = st.Motion(dt, np.concatenate([np.zeros(400), -x[:2500]]))
    for recording, other in [
        *((both, again) for again in (*turned, mirrored)),
        *((alone, again) for again in (coarse, late, st.Motion(dt, drifting))),
    ]:
        assert recorded_again([*many, recording, other]) == {len(many) + 1: len(many)}
    assert recorded_again([*many, alone, st.Motion(dt, x[::-1]), st.Motion(dt, y)]) == {}


def test_a_target_in_another_unit_is_refused(tmp_path):
    file = tmp_path / "target.csv"
    file.write_text("period_s,sa_g\n0.1,7.35\n1,2.0\n")
    with pytest.raises(
        st.InputError, match=r"sa_g of .* is 7.35 at 0.1 s, .*; if m/s² is meant, call the column sa_m_s2"
    ):
        st.target_spectrum(str(file))
