"""What an observation of a ruin may not do: change the answer by saying nothing, by its place, or by being one of many."""

import dataclasses

import numpy as np
import pytest

import stylobate as st
from stylobate_ruins.answers import Answers
from stylobate_ruins.infer import Inference
from stylobate_ruins.ruin import Fact
from stylobate_ruins.simulations import FELL, STANDS, FinalState, Simulations

#: Draws; of which joint 1 slips with the shaking, and joints 2 to 4 without regard to it.
DRAWS = 1500

COLUMNS = [
    st.Column.tapered(
        height=3.0, bottom_width=0.8, top_width=0.7, drums=4, density=2600.0, section="circular", name=name,
        joint=st.Joint(normal_stiffness=5e9, shear_stiffness=5e9, friction_coefficient=0.67),
    )
    for name in ("A", "B")
]  # fmt: skip

PRIOR = st.Prior(pgv=(0.1, 1.5), period=(0.3, 1.6))


def made(seed: int = 1) -> Simulations:
    """A table of two columns, which fall beyond 1.2 and 0.7 m/s or so, and whose joint 1 slips by the cube of the PGV."""
    stream = np.random.default_rng(seed)
    pgv, period = 0.1 * 15.0 ** stream.random(DRAWS), 0.3 * (1.6 / 0.3) ** stream.random(DRAWS)
    rest = {"pga_g": 0.64 * pgv / period, "azimuth_deg": 180.0 * stream.random(DRAWS), "law": np.zeros(DRAWS)}
    states = []
    for name, fells in (("A", 1.2), ("B", 0.7)):
        size = pgv / fells * np.exp(0.2 * stream.standard_normal(DRAWS))
        slip, twist = 0.02 * stream.standard_normal((DRAWS, 4, 2)), 3.0 * stream.standard_normal((DRAWS, 4))
        slip[:, 0] = (0.05 * size**3)[:, None] * stream.standard_normal((DRAWS, 2))
        verdict = np.where(size > 1.0, FELL, STANDS).astype(np.int8)
        towards = np.where(size > 1.0, 360.0 * stream.random(DRAWS), np.nan)
        states.append(
            FinalState(name, verdict, towards, slip, twist, np.zeros((DRAWS, 0), bool), np.zeros((DRAWS, 0, 2)))
        )
    return Simulations(PRIOR, {"pgv_m_s": pgv, "period_s": period, **rest}, tuple(states))


TABLE = made()

STATES = {"A": {"state": "stands"}, "B": {"state": "fell"}}
SLIP = {"A": {"state": "stands", "offsets": [(1, 0.01, -0.02, 0.003)]}, "B": {"state": "fell"}}

#: Observations that are known too badly to say anything.
UNKNOWN = {
    "an offset known to 10 m": {"A": {"offsets": [(2, 0.0, 0.0, 10.0)]}},
    "offsets known to 10 m": {"A": {"offsets": [(joint, 0.3, -0.2, 10.0) for joint in (2, 3, 4)]}},
    "a twist known to 360°": {"A": {"twists": [(1, 20.0, 360.0)]}},
}

#: And those of another cause than the shaking.
OTHER = {
    "offsets": {"A": {"offsets": [(joint, 0.01, 0.02, 0.003) for joint in (2, 3, 4)]}},
    "twists": {"A": {"twists": [(joint, 2.0, 0.5) for joint in (1, 2, 3, 4)]}},
    "a fall": {"B": {"fell_towards": 30.0, "towards_sd": 15.0}},
}


def ruin_of(*seen: dict, order: int = 1) -> st.Ruin:
    """A ruin of which several things are seen; ``order`` -1 turns everything in its file around."""
    fields: dict = {"A": {}, "B": {}}
    for observation in seen:
        for column, given in observation.items():
            for name, value in given.items():
                fields[column][name] = [*fields[column].get(name, ()), *value] if isinstance(value, list) else value
    rows = {c: {n: v[::order] if isinstance(v, list) else v for n, v in values.items()} for c, values in fields.items()}
    return st.Ruin(COLUMNS, [st.Observed(column, **values) for column, values in [*rows.items()][::order]], PRIOR)


def answers_to(ruin: st.Ruin, weights: np.ndarray | None = None, table: Simulations = TABLE) -> Answers:
    return Answers(table, ruin.facts, 1, weights)


def interval(answers: Answers) -> np.ndarray:
    """Logarithms of the PGV: its median and the ends of 90 %."""
    pgv = answers.posterior(answers.to(answers.facts))["pgv_m_s"]
    return np.log([pgv.low, pgv.median, pgv.high])


@pytest.mark.parametrize("known", [STATES, SLIP], ids=["states", "an offset"])
@pytest.mark.parametrize("nothing", UNKNOWN)
def test_what_is_hardly_known_changes_nothing(known, nothing):
    before, after = (answers_to(ruin_of(*seen)) for seen in ((known,), (known, UNKNOWN[nothing])))
    first, second = (answers.posterior(answers.to(answers.facts)) for answers in (before, after))
    assert first == second


@pytest.mark.parametrize("known", [STATES, SLIP], ids=["states", "an offset"])
@pytest.mark.parametrize("nothing", OTHER)
def test_what_the_shaking_does_not_touch_changes_nothing(known, nothing):
    # Over six tables an interval moves by 0.065 of its width at most, one standard deviation, as it does from table to table
    # by itself (0.045): four standard errors of the mean are 0.1. Leave-one-out summaries moved its ends by 0.2 and more.
    moved = []
    for seed in range(6):
        table = made(seed)
        ends = [interval(answers_to(ruin_of(*seen), None, table)) for seen in ((known,), (known, OTHER[nothing]))]
        moved.append((ends[1] - ends[0]) / (ends[0][2] - ends[0][0]))
    assert np.mean(moved, axis=0) == pytest.approx(0.0, abs=0.1)


def test_the_bayes_factor_takes_no_part_in_what_says_nothing():
    factors = [
        answers_to(ruin_of(*seen)).bayes_factor()[0]
        for seen in ((SLIP,), (SLIP, UNKNOWN["offsets known to 10 m"], UNKNOWN["a twist known to 360°"]))
    ]
    assert factors[1] == pytest.approx(factors[0], rel=0.01)  # 20° of 360: half of a square of one in eighteen


def test_the_bayes_factor_is_that_of_likelihoods():
    # A state by itself: shares of draws over chances without an earthquake. A slip of 22 mm known to 3 mm cannot be none,
    # and one known to 10 mm is exp(-2.5) times as likely so.
    both = np.array([state.verdict for state in TABLE.final_states])
    share = np.mean((both[0] == STANDS) & (both[1] == FELL))
    factor, at_least = answers_to(ruin_of(STATES)).bayes_factor()
    assert factor == pytest.approx(share / (0.99 * 0.01), rel=1e-9)
    assert not at_least
    known = {"A": {"state": "stands", "offsets": [(1, 0.01, -0.02, 0.01)]}, "B": {"state": "fell"}}
    matching = (both[0] == STANDS) & (both[1] == FELL)
    off = TABLE.final_states[0].slip[matching, 0] - np.array([0.01, -0.02])
    likely = np.exp(-0.5 * (off**2).sum(axis=1) / 1e-4).sum() / DRAWS
    assert answers_to(ruin_of(known)).bayes_factor()[0] == pytest.approx(
        likely / (0.99 * 0.01 * np.exp(-2.5)), rel=1e-9
    )


def test_order_changes_nothing():
    seen = (SLIP, OTHER["offsets"], OTHER["twists"])
    there, back = (answers_to(ruin_of(*seen, order=order)) for order in (1, -1))
    first, second = (answers.posterior(answers.to(answers.facts)) for answers in (there, back))
    for name, posterior in first.items():  # sums of the same numbers in another order, through some hundred products
        assert dataclasses.astuple(posterior) == pytest.approx(dataclasses.astuple(second[name]), rel=1e-6, abs=1e-6)
    assert [structure.name for structure in ruin_of(SLIP, order=-1).simulated] == [
        "A",
        "B",
    ]  # the same table, and no run anew


def test_few_draws_that_carry_all_are_told():
    ruin, weights = ruin_of(STATES), np.ones(DRAWS)
    assert "count as" not in Inference(ruin, answers_to(ruin, weights)).sentence
    matching = answers_to(ruin).matching(ruin.facts)
    weights[matching[:20]] = 1e6
    few = Inference(ruin, answers_to(ruin, weights))
    assert "Draws that count as 20 carry all of this" in few.sentence
    pgv = TABLE.parameters["pgv_m_s"][matching[:20]]
    assert few.posterior["pgv_m_s"].low == pytest.approx(pgv.min(), rel=0.02)  # 1 of 20 beyond the ends of 20 draws
    assert few.posterior["pgv_m_s"].high == pytest.approx(pgv.max(), rel=0.02)


def test_facts_are_measured_as_badly_as_they_were():
    fact = Fact(0, "twist", "twist", (3.0,), 5.0, 2)
    off = Answers(TABLE, [fact], 1).values[fact][:, 0] - TABLE.final_states[0].twist[:, 2]
    assert off.std() == pytest.approx(5.0, rel=4.0 * (2.0 * DRAWS) ** -0.5)
