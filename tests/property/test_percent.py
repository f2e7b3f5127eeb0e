"""One rule of rounding for shares, whoever tells them: the page, reports, pictures and the command line."""

import re
from fractions import Fraction

import numpy as np
import pytest
from sources import sources

from stylobate.campaign.twins import Twins
from stylobate.column.scatter import Scatter
from stylobate.messages import percent, percents, whole_percent
from stylobate.verdicts import verdict as v
from stylobate.verdicts.limit_states import shares
from stylobate.verdicts.population import Population, chance_words


@pytest.mark.parametrize(
    ("share", "text"),
    [(4 / 7, "57"), (0.575, "58"), (23 / 40, "58"), (0.145, "15"), (0.125, "13"), (0.565, "57"), (0.0, "0"), (1.0, "100"),
     (1e-17, "0"), (0.001, "<1"), (0.998, ">99"),
     (1 / 3, "33"), (2 / 3, "67"), (0.5749, "57"), (float("nan"), "–"), (float("inf"), "–")],
)  # fmt: skip
def test_half_of_a_per_cent_is_rounded_up(share, text):
    assert whole_percent(share) == text
    assert percent(share) == f"{text} %"


def test_every_share_of_up_to_four_hundred_runs_is_rounded_as_its_fraction_and_never_to_none_or_all():
    for runs in range(1, 401):
        for count in range(runs + 1):
            exact = (Fraction(100 * count, runs) + Fraction(1, 2)).__floor__()
            text = "<1" if exact == 0 < count else ">99" if exact == 100 > Fraction(100 * count, runs) else str(exact)
            assert whole_percent(count / runs) == text, (count, runs)


def test_all_who_tell_a_share_tell_the_same():
    row = {"collapsed": True, "decided": True, "outcome": "collapsed", "collapse_time_s": 1.0}
    rows = tuple({**row, "peak_top_displacement_m": 1.0, "collapsed": k < 23,
                  "outcome": "collapsed" if k < 23 else "rocked"} for k in range(40))  # fmt: skip
    (share,) = shares({"a": np.array([1] * 23 + [0] * 17)})
    population = Population(Twins([], Scatter(), 0, ()), rows)
    assert percents(share.low, share.high) == share.words == "58 %"
    assert chance_words(population.columns).startswith("58 % of 40 (")
    assert f"(95 %: {percents(*population.interval)})" in population.sentence
    assert population.counts[v.COLLAPSED] == 23


def test_nobody_else_rounds_a_share():
    """Neither a script of the page nor a module writes a percentage of whole numbers by itself."""
    own = re.compile(r":\.0f\} %|:\.0%|Math\.round\(100")
    lines = [
        f"{name}: {line.strip()}"
        for name, path in sources("py", "js")
        for line in path.read_text(encoding="utf-8").splitlines()
        if own.search(line) and "running.done" not in line  # how far a job is, no share of runs
    ]
    assert not lines


def test_runs_without_a_verdict_are_counted_in_a_sentence():
    assert (
        v.open_runs({"undecided": 1, "failed": 2}) == " 1 run is undecided and 2 runs failed: not counted as collapse."
    )
    assert v.open_runs({"undecided": 2, "failed": 0}, "left out") == " 2 runs are undecided: left out."
    assert v.open_runs({"undecided": 0}) == ""
