"""Memory of campaigns: nothing grows with the number of cases but what is asked for, in columns or in bits."""

import dataclasses
import math
import tracemalloc
from collections import deque
from contextlib import closing

import numpy as np

import stylobate as st
from stylobate.campaign.digests import Hasher
from stylobate.campaign.ledger import Ledger
from stylobate.campaign.runs import Request, Runs, run_all
from stylobate.models.base import Case, Cases, Model
from stylobate.models.engine import Engine
from stylobate.models.shared.lanes import WINDOW, run_alike
from stylobate.outcome import Outcome
from stylobate.response import Measures
from stylobate.response.rows import Rows

COLUMN, MOTION = st.preset("paper-monolithic"), st.harmonic(1.0, 1.0, 1.0)
ONE = Case(COLUMN, MOTION)


class AtOnce:
    """A block of lanes whose runs end at once, each with numbers of its own."""

    lanes = 16

    def __init__(self):
        self.number = 0.0

    def load(self, lane, case):
        pass

    def advance(self):
        pass

    def is_over(self, lane):
        return True

    def collect(self, lane):
        self.number += 1.0
        sizes = [self.number / size for size in range(1, 7)]
        return Measures(Outcome.ROCKED, True, math.nan, *sizes, 1e-4, 1000)


class InNoTime(Engine):
    """Every run takes no time."""

    def run_many(self, cases, options, threads):
        return run_alike(lambda case: "one", lambda kind: AtOnce(), cases, 1)


@dataclasses.dataclass(frozen=True)
class Instant(Model):
    """The model of these."""

    name = "instant"
    engines = (InNoTime,)


def bytes_per_case(work, few, many):
    """Slope of the largest memory over the number of cases; from the first to the second ``yield`` of ``work``."""

    def peak(count):
        given = work(count)
        next(given)
        tracemalloc.start()
        kept = next(given)
        memory = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        given.close()
        del kept
        return memory

    peak(100)  # what is loaded once
    return (peak(many) - peak(few)) / (many - few)


def cases(count):
    return Cases(count, lambda number: ONE)


def distinct(count):
    return Cases(count, lambda number: Case(COLUMN, MOTION.scaled(1.0 + number)))


def test_a_campaign_keeps_the_bytes_of_its_numbers():
    def work(count):
        yield
        yield run_all(Request.of(cases(count), Hasher(Instant())))

    # ten numbers and a step count of eight bytes each, two truths, two texts, a byte for each that there is a value;
    # beside it some hundreds of results that wait for the caller, more or fewer of them as the threads take turns
    assert bytes_per_case(work, 2 * WINDOW, 6 * WINDOW) < 200.0


def test_a_stream_of_runs_keeps_their_digests_and_one_that_goes_on_no_more(tmp_path):
    remaining = 200
    row = AtOnce().collect(0).row()

    def work(count):
        ledger = tmp_path / f"{count}.sqlite"
        request = Request.of(distinct(count), Hasher(Instant()))
        with closing(Ledger(ledger)) as book:
            for number in range(count - remaining):
                book.record(int(request.digests.keys[number]), {"case": request.digests[number], **row})
        yield
        with closing(Runs(st.Campaign(ledger=ledger))) as runs:
            yield deque(runs.run(Request.of(distinct(count), Hasher(Instant()))), maxlen=0)

    # a digest of 16 bytes, its number and its place, while they are sorted each twice, and whether it is known
    assert bytes_per_case(work, WINDOW, 6 * WINDOW) < 100.0


ROWS = [
    {"outcome": "rocked", "at": None, "size": 0.1 + 0.2, "steps": 7, "ok": True, "reason": "", "list": [0.1, math.inf]},
    None,
    {"outcome": "failed", "at": None, "size": -0.0, "steps": 2**62, "ok": False, "reason": "a line\nand ü"},
    {"outcome": "rocked", "at": 1.5, "size": None, "steps": 0, "ok": True, "reason": "", "list": [1e-300, 2.0]},
    {"outcome": 3, "at": 1, "size": "x", "steps": 2**70, "ok": None, "reason": "", "list": [1.0], "new": {"a": [1]}},
]


def test_rows_come_back_as_they_were_put_in():
    rows = Rows(len(ROWS))
    for number in (3, 0, 4, 2):  # as they are finished
        rows[number] = ROWS[number]
    assert list(rows) == ROWS
    assert rows == ROWS
    assert rows == Rows.of(ROWS)
    assert rows != ROWS[:-1]
    assert rows != [None, *ROWS[1:]]
    assert rows[1:4] == ROWS[1:4]
    assert rows.finished == 4
    assert [type(value) for value in rows[0].values()] == [type(ROWS[0][name]) for name in rows[0]]
    assert math.copysign(1.0, rows[2]["size"]) == -1.0
    part = Rows.of(ROWS[:4])
    np.testing.assert_array_equal(part.floats("size"), [0.1 + 0.2, np.nan, -0.0, np.nan])
    np.testing.assert_array_equal(part.floats("nothing"), np.full(4, np.nan))
    assert part.are("outcome", "rocked").tolist() == [True, False, False, True]
    assert Rows.of(ROWS[-1:]).are("outcome", "rocked").tolist() == [False]


def test_a_table_of_rows_is_that_of_their_dictionaries():
    import pandas

    made = [row for row in ROWS[:4] if row is not None]
    table = Rows.of(ROWS[:4]).table()
    assert table.to_csv(index=False) == pandas.DataFrame(made).to_csv(index=False)
    assert table.steps.dtype == np.int64
    assert table.ok.dtype == bool
    assert list(Rows(3).table().columns) == []


def test_cases_are_made_when_they_are_asked_for():
    made = []
    lazy_cases = Cases(3, lambda number: made.append(number) or ONE)
    assert len(lazy_cases) == 3
    assert made == []
    assert len(list(lazy_cases)) == 3
    assert made == [0, 1, 2]
