"""Records of one earthquake are told by name and by time, in the words of every format that states them."""

import numpy as np
import pytest
from fuzz.record_files import esm

import stylobate as st
from stylobate.motion import write_csv
from stylobate.motion.events import events_of, unknown_events
from stylobate.motion.specs import parse_synthetic


def record(name, event=None, start_time=None, seconds=300.0):
    """A record whose header says so much."""
    return st.Motion(1.0, np.zeros(int(seconds) + 1), name=name, metadata={"event": event, "start_time": start_time})


@pytest.mark.parametrize(
    ("head", "other", "same"),
    [
        # one accelerogram from two networks: the file with a pre-event part begins three minutes before the other
        (("Rcrd of Fri", "7/06/19, 03:16: 8.0 UTC (GPS)"), (None, "2019-07-06T03:19:23.038300Z"), True),
        (("COALINGA", "05/02/83, 16:42:48.2 PDT"), (None, "1983-05-02T23:42:50Z"), True),
        (("Waiau", "2016 November 13         11:02:56 UT"), ("Kaikoura", "2016-11-13T11:03:10Z"), True),
        (("Waiau", None), ("Waiau", None), True),
        (("1989 10 18 0004 Loma Prieta, CA", None), (None, "1989-10-18T00:04:30Z"), True),
        ((None, "20161030_064018"), (None, "2016/10/30 06:40:20 UTC"), True),
        # an aftershock an hour later; two of one day that both have names
        ((None, "2019-07-06T03:16:08Z"), (None, "2019-07-06T04:19:23Z"), False),
        (("Mainshock", "2016-10-30 06:40:18"), ("Aftershock", "2016-10-30 13:40:18"), False),
        ((None, None), (None, None), False),
        # a sequence that goes by one name
        (("CENTRAL_ITALY", "20160824_013600.000"), ("CENTRAL_ITALY", "20161030_064018.000"), False),
        (("CENTRAL_ITALY", "20160824_013600.000"), ("CENTRAL_ITALY", "20160824_013610.000"), True),
        ((None, "2019-13-45T99:00:00Z"), (None, "2019-07-06T03:19:23Z"), False),
    ],
)
def test_records_of_one_earthquake(head, other, same):
    first, second = events_of([record("a", *head), record("b", *other)])
    assert (first == second) is same


@pytest.mark.parametrize(("ids", "same"), [("AB", False), ("AA", True), (["A", None], True), ([None, None], True)])
def test_records_of_other_numbers_of_the_event_are_of_other_earthquakes(ids, same, tmp_path):
    """Both of one name and one day; the numbers stay with motions that were written and read again."""
    motions = []
    for k, number in enumerate(ids):
        path = tmp_path / f"{k}.asc"
        head = esm().replace("NETWORK", f"EVENT_ID: {number}\nNETWORK" if number else "NETWORK")
        path.write_text(f"DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS: 20160824_0{k}3600.000\n{head}")
        motions.append(st.read_motion(path))
    again = [st.read_motion(write_csv(motion, tmp_path / f"{k}.csv")) for k, motion in enumerate(motions)]
    for records in (motions, again):
        first, second = events_of(records)
        assert (first == second) is same


def test_earthquakes_that_no_file_tells_are_named():
    known, dated, bare = record("k", "Waiau"), record("d", None, "2016-11-13T11:03:10Z"), record("b")
    assert unknown_events([known, dated, bare]) == ["d", "b"]
    assert unknown_events([dated, record("e", None, "2019-07-06T03:19:23Z"), bare]) == ["b"]
    assert unknown_events([bare]) == []


def test_one_earthquake_is_chosen_once():
    """Two copies of one accelerogram, one without a name of its event; and a third record that tells nothing."""
    shaking = [parse_synthetic(f"greece,6.5Mw,20km,seed={k}") for k in range(3)]
    heads = [("Ridgecrest", "7/06/19, 03:16: 8.0 UTC"), (None, "2019-07-06T03:16:20Z"), (None, None)]
    motions = [
        motion.replace(name=name, metadata={"event": event, "start_time": start})
        for motion, name, (event, start) in zip(shaking, "abc", heads, strict=True)
    ]
    target = st.target_spectrum("ec8,ag=0.2g,soil=B")
    selection = st.select_records(motions, target, 2, factors=(0.01, 100.0), per_event=1)
    assert selection.table["record"].tolist() in (["a", "c"], ["b", "c"])
    assert selection.summary()["unknown_events"] == ["c"]
    assert "The files of c do not tell of which earthquake they are" in selection.sentence
    with pytest.raises(st.InputError, match="2 records can be chosen with at most 1 of one event"):
        st.select_records(motions, target, 3, factors=(0.01, 100.0), per_event=1)
