"""Survival since a date as an observation: a rock of known age in closed form, dates, and what weighs draws."""

import numpy as np
import pytest

import stylobate as st
from stylobate.probability.risk import Hazard
from stylobate_ruins.answers import Answers
from stylobate_ruins.outlasting import hazard_of, outlasting, rates_of
from stylobate_ruins.ruin import Fact
from stylobate_ruins.simulations import FELL, STANDS, FinalState, Simulations

#: Draws; PGV that fells the rock [m/s]; age [y].
DRAWS, FELLS, AGE = 20_000, 0.5, 1500.0

PRIOR = st.Prior(pgv=(0.05, 2.0), period=(0.3, 1.6), law=("rim",), stiffness_damping=(1e-4,))

#: λ = 2e-4 a year at 0.5 m/s, falling with the square of the PGV: straight in logarithms.
HAZARD = Hazard(np.array([0.02, 5.0]), 5e-5 * np.array([0.02, 5.0]) ** -2.0, "m/s", "hazard.csv", "pgv")

#: Of a column no bodies are told.
NO_BODIES = np.zeros((DRAWS, 0), bool), np.zeros((DRAWS, 0, 2))

STANDING = Fact(0, "state", "rock stands", (0.0,))


def rock(slip=0.0) -> Simulations:
    """A table of a rock that falls by all shaking above a PGV, and is moved by ``slip`` times the PGV by any other."""
    pgv = 0.05 * 40.0 ** np.random.default_rng(1).random(DRAWS)
    rest = {name: np.ones(DRAWS) for name in ("pga_g", "period_s", "azimuth_deg")}
    unknown = {"law": np.zeros(DRAWS), "stiffness_damping_s": np.full(DRAWS, 1e-4)}
    verdict = np.where(pgv > FELLS, FELL, STANDS).astype(np.int8)
    moved = np.stack((slip * pgv, 0.0 * pgv), axis=-1)[:, None, :]
    state = FinalState("rock", verdict, np.full(DRAWS, np.nan), moved, np.zeros((DRAWS, 1)), *NO_BODIES)
    return Simulations(PRIOR, {"pgv_m_s": pgv, **rest, **unknown}, (state,))


def since(tmp_path, **dates) -> st.Outlasted:
    return st.Outlasted(tmp_path / "hazard.csv", **{"until": 2000.0, **dates})


def test_rock_of_known_age(tmp_path):
    # Anderson and Brune (1999): it stands with exp(−λ(0.5 m/s) t). Classes of 141 draws are 2.6 % wide in the PGV, of which
    # the threshold cuts one: 2 × 2.6 % of λ t = 0.3 at most.
    result = outlasting(rock(), [STANDING], since(tmp_path, since=500.0), HAZARD, 1)
    assert result.chance == pytest.approx(np.exp(-AGE * HAZARD.at(FELLS)), rel=0.016)
    assert not result.odd
    old = outlasting(rock(), [STANDING], since(tmp_path, since=-9000.0, until=3000.0), HAZARD, 1)
    assert old.chance == pytest.approx(np.exp(-12_000.0 * HAZARD.at(FELLS)), rel=0.13)  # 5.2 % of 2.4
    assert not old.odd  # 0.09
    assert outlasting(rock(), [STANDING], since(tmp_path, since=-9999.0, until=3000.0), worse(2.0), 1).odd


def worse(times: float) -> Hazard:
    return Hazard(HAZARD.im, times * HAZARD.rate, "m/s", "worse.csv", "pgv")


def test_rates_of_draws_are_those_of_the_curve():
    pgv = rock().parameters["pgv_m_s"]
    rates = rates_of(pgv, HAZARD)
    assert rates.sum() == pytest.approx(HAZARD.at(pgv.min()), rel=1e-12)  # a sum of differences
    for level in (0.1, 0.3, 1.0):  # within the width of a class
        assert rates[pgv > level].sum() == pytest.approx(HAZARD.at(level), rel=0.06)


def test_earthquake_is_one_of_the_hazard(tmp_path):
    # Of a rock that has fallen, nothing is asked afterwards: density of the PGV ∝ −dλ, whose median above 0.5 m/s is
    # 0.5 √2 m/s where λ ∝ PGV⁻²; what is beyond 2 m/s (1/16) counts with the strongest draws, below the median not.
    table, fallen = rock(), Fact(0, "state", "rock fell", (1.0,))
    result = outlasting(table, [fallen], since(tmp_path, earthquake=1800.0), HAZARD, 1)
    assert result.chance == 1.0
    answers = Answers(table, [fallen], 1, result.weights)
    pgv = answers.posterior(answers.to([fallen]))["pgv_m_s"]
    assert pgv.median == pytest.approx(FELLS * 2.0**0.5, rel=0.03)  # a class
    assert pgv.low == pytest.approx(FELLS / 0.95**0.5, rel=0.03)
    assert result.rates[answers.matching([fallen])].sum() == pytest.approx(HAZARD.at(FELLS), rel=0.06)


def test_what_stands_has_not_been_moved_farther_since(tmp_path):
    # 20 mm per m/s, 4 mm seen with 1 mm: all above 0.3 m/s (6 mm) would show.
    facts = [STANDING, Fact(0, "offset", "joint 1", (0.004, 0.0), 0.001)]
    result = outlasting(rock(0.02), facts, since(tmp_path, since=500.0), HAZARD, 1)
    assert result.chance == pytest.approx(np.exp(-AGE * HAZARD.at(0.3)), rel=0.052 * AGE * HAZARD.at(0.3))


def test_the_largest_slip_bounds_what_came_since_and_tells_the_shaking(tmp_path):
    # The same bound of a joint that nobody names; and at 20 mm per m/s 8 ± 0.2 mm are 0.4 m/s, ± 2.5 %, of which two pass.
    table = rock(0.02)
    bound = [STANDING, Fact(0, "largest", "largest offset", (0.004,), 0.001)]
    result = outlasting(table, bound, since(tmp_path, since=500.0), HAZARD, 1)
    assert result.chance == pytest.approx(np.exp(-AGE * HAZARD.at(0.3)), rel=0.052 * AGE * HAZARD.at(0.3))
    seen = [STANDING, Fact(0, "largest", "largest offset", (0.008,), 0.0002)]
    answers = Answers(table, seen, 1)
    assert answers.posterior(answers.to(seen))["pgv_m_s"].median == pytest.approx(0.4, rel=0.05)


def test_date_of_the_earthquake_is_integrated_over(tmp_path):
    # Before it the fallen rock must stand, afterwards anything may come: density exp(−λ (t − 0)) of the year t in 0 … 2000.
    # Its median t½ has 1 − exp(−λ t½) = (1 − exp(−2000 λ))/2; 4000 dates: four standard errors are 0.03 of the range.
    fallen = Fact(0, "state", "rock fell", (1.0,))
    often = worse(5.0)
    result = outlasting(rock(), [fallen], since(tmp_path, since=0.0), often, 1)
    rate = often.at(FELLS)
    half = -np.log1p(-0.5 * (1.0 - np.exp(-2000.0 * rate))) / rate
    assert result.year[1] == pytest.approx(half, abs=60.0)
    mean = (1.0 - np.exp(-2000.0 * rate)) / (2000.0 * rate)
    assert result.chance == pytest.approx(mean, rel=0.06)


def test_law_under_which_it_would_have_fallen_is_doubted(tmp_path):
    # Two laws, one of which never falls: odds of exp(−λ t) against 1.
    table = rock()
    law = np.random.default_rng(2).integers(0, 2, DRAWS).astype(float)
    table.parameters["law"] = law
    table.final_states[0].verdict[law == 1.0] = STANDS
    result = outlasting(table, [STANDING], since(tmp_path, since=-7000.0), HAZARD, 1)
    odds = result.weights[law == 0.0].sum() / result.weights[law == 1.0].sum()
    assert odds == pytest.approx(np.exp(-9000.0 * HAZARD.at(FELLS)), rel=0.15)  # classes and shares of 10,000 draws


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({}, "neither since nor earthquake"),
        ({"since": 1900.0, "earthquake": 1800.0}, "contradict one another"),
        ({"since": 2100.0}, "contradict one another"),
        ({"since": (1900.0, 1800.0)}, "the first and the last"),
        ({"since": (1800.0, 1900.0), "since_sd": 5.0}, "no single year"),
        ({"since": 1e6}, "a year of `since`"),
    ],
)
def test_dates_that_are_none_are_refused(tmp_path, fields, message):
    with pytest.raises(st.InputError, match=message):
        since(tmp_path, **fields)


def test_prior_must_begin_where_nothing_changes(tmp_path):
    table = rock()
    strong = table.subset(np.flatnonzero(table.parameters["pgv_m_s"] > 0.45))
    with pytest.raises(st.InputError, match="begin lower"):
        outlasting(
            strong.subset(np.flatnonzero(strong.parameters["pgv_m_s"] > FELLS)),
            [STANDING],
            since(tmp_path, since=0.0),
            HAZARD,
            1,
        )


@pytest.mark.parametrize(("head", "ok"), [("pgv_m_s", True), ("pga_g", True), ("im_m_s", False), ("sa_1s_g", False)])
def test_hazard_must_be_of_pgv_or_pga(tmp_path, head, ok):
    (tmp_path / "hazard.csv").write_text(f"{head},annual_rate\n0.05,0.01\n0.5,1e-4\n")
    if ok:
        assert hazard_of(since(tmp_path, since=0.0)).unit == ("g" if head == "pga_g" else "m/s")
        return
    with pytest.raises(st.InputError, match="PGV or PGA"):
        hazard_of(since(tmp_path, since=0.0))
