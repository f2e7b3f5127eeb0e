"""What shaking was it? A posterior of past shaking from what stands, has fallen and is out of place."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stylobate.campaign.campaign import RUNS, Campaign
from stylobate.errors import InputError, check_kind
from stylobate.messages import joined, say
from stylobate.notebook import NotebookSummary

from . import abc
from .answers import FEWEST, LABELS, UNITS, Answers, Posterior, listed, words_of
from .outlasting import Outlasting, hazard_of, outlasting
from .ruin import Fact, Ruin
from .ruin_check import Checked, checks_of
from .ruin_files import read_ruin
from .simulations import TAIL, simulations_of

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True, eq=False)
class Inference(NotebookSummary):
    """The answer: what shaking it was, as far as shapes tell.

    Parameters
    ----------
    ruin : Ruin
    answers : Answers
        Of the table's draws that could be computed.
    outlasted : Outlasting, optional
        What survival since a date says, where it is observed.
    failed : int
        Draws that could not.
    wall_time : float
        [s]
    """

    ruin: Ruin
    answers: Answers
    outlasted: Outlasting | None = None
    failed: int = 0
    wall_time: float = field(default=0.0)

    @cached_property
    def taken(self) -> abc.Accepted:
        """Accepted draws."""
        return self.answers.to(self.answers.facts)

    @cached_property
    def posterior(self) -> dict[str, Posterior]:
        """PGV, PGA, period and azimuth."""
        return self.answers.posterior(self.taken)

    @property
    def informative(self) -> bool:
        """Whether the shapes tell the PGV."""
        return self.posterior["pgv_m_s"].informative

    @cached_property
    def bayes_factor(self) -> tuple[float, bool]:
        """How many times more probable what is seen is under the prior than without any earthquake; whether at least."""
        return self.answers.bayes_factor()

    @cached_property
    def information(self) -> list[dict[str, Any]]:
        """What each fact tells: what is left of the prior's spread of ln PGV with it alone, and without it."""
        rows = []
        for fact in self.answers.facts:
            alone = self.answers.spread_of_pgv(self.answers.alone(fact))
            without = self.answers.spread_of_pgv(self.answers.without(fact))
            rows.append({"observation": fact.label, "spread_alone": alone, "spread_without": without})
        if self.outlasted is not None:
            without = Answers(self.answers.table, self.answers.facts, self.answers.seed)
            alone, rest = self.answers.spread_of_pgv([]), without.spread_of_pgv(without.facts)
            rows.append({"observation": self.outlasted.label, "spread_alone": alone, "spread_without": rest})
        return rows

    @cached_property
    def checks(self) -> list[Checked]:
        """Whether each thing seen is inside what all else predicts."""
        checks = checks_of(self.answers, FEWEST)
        lasted = self.outlasted
        if lasted is not None:
            expected = f"that some of it has fallen or moved by another earthquake, by {lasted.hazard.name}"
            checks.append(Checked(lasted.label, lasted.chance, lasted.odd, expected))
        return checks

    @property
    def odd(self) -> list[Checked]:
        """Things seen that all else does not predict."""
        return [check for check in self.checks if check.odd]

    @cached_property
    def records(self) -> list[dict[str, Any]]:
        """Named records by their probability, each with its Bayes factor against all the others together."""
        records = self.ruin.prior.records
        if not records:
            return []
        number, before = self.answers.table.parameters["record"].astype(int), 1.0 / len(records)
        rows = []
        for k, record in enumerate(records):
            share = float(self.taken.weights[number[self.taken.which] == k].sum())
            odds = share / (1.0 - share) * (1.0 - before) / before if share < 1.0 and before < 1.0 else None
            rows.append({"record": record.name, "probability": share, "bayes_factor_against_others": odds})
        return sorted(rows, key=lambda row: -row["probability"])

    @property
    def sentence(self) -> str:
        """The answer, in a few sentences."""
        pgv, sentences = self.posterior["pgv_m_s"], [check.sentence for check in self.odd]
        if pgv.informative:
            all_of_it = say("If shaking alone did all of it, the peak ground velocity was {pgv} (90 %).")
            words = all_of_it if sentences else say("The peak ground velocity was {pgv} (90 %).")
            sentences.append(words.of(pgv=words_of("pgv_m_s", pgv)))
        informative = [
            name for name, posterior in self.posterior.items() if posterior.informative and name != "pgv_m_s"
        ]
        word = say("{name:capital} {value}.")
        sentences += [
            word.of(name=say(LABELS[name]), value=words_of(name, self.posterior[name])) for name in informative
        ]
        untold = [LABELS[name] for name, posterior in self.posterior.items() if not posterior.informative]
        if untold:
            sentences.append(say("The shapes do not tell {names}: what they leave is the prior.", names=listed(untold)))
        factor, at_least = self.bayes_factor
        if self.answers.facts:
            with_, least = (
                say("What is seen is {factor:.3g} times as probable with such an earthquake as with none."),
                say("What is seen is at least {factor:.3g} times as probable with such an earthquake as with none."),
            )
            without = say("What is seen is {factor:.3g} times as probable without any such earthquake as with one.")
            words = (
                without.of(factor=1.0 / factor) if factor < 1.0 else (least if at_least else with_).of(factor=factor)
            )
            sentences.append(words)
        if self.taken.effective < 0.5 * FEWEST:
            few = say(
                "Draws that count as {number:.0f} carry all of this, and intervals are as wide as that asks for; raise "
                "simulations."
            )
            sentences.append(few.of(number=self.taken.effective))
        if self.outlasted is not None:
            sentences.append(self.outlasted.sentence(self.answers.matching(self.answers.facts)))
        return joined(" ", sentences)

    @property
    def table(self) -> pandas.DataFrame:
        """One row per parameter."""
        import pandas

        return pandas.DataFrame(
            [
                {"parameter": LABELS[name], "unit": UNITS[name], **posterior.summary()}
                for name, posterior in self.posterior.items()
            ]
        )

    @property
    def draws(self) -> pandas.DataFrame:
        """The accepted draws, the nearest first, with their weights."""
        order = np.argsort(self.taken.distance, kind="stable")
        rows = self.answers.table.table.iloc[self.taken.which[order]]
        return rows.assign(weight=self.taken.weights[order], distance=self.taken.distance[order])

    def summary(self) -> dict[str, Any]:
        """The JSON object of ``stylobate infer``."""
        factor, at_least = self.bayes_factor
        return {
            "sentence": self.sentence,
            "posterior": {name: posterior.summary() for name, posterior in self.posterior.items()},
            "informative": self.informative,
            "bayes_factor_no_earthquake": factor,
            "bayes_factor_is_at_least": at_least,
            "simulations": len(self.answers.table),
            "failed": self.failed,
            "matching": len(self.answers.matching(self.answers.facts)),
            "accepted": len(self.taken.which),
            "effective": self.taken.effective,
            "observations": self.information,
            "checks": [check.summary() for check in self.checks],
            "consistent": not self.odd,
            "survival": None
            if self.outlasted is None
            else self.outlasted.summary(self.answers.matching(self.answers.facts)),
            "records": self.records,
            "prior": self.ruin.prior.facts() | {"records": [record.name for record in self.ruin.prior.records]},
            "columns": [structure.name for structure in self.ruin.structures],
            "model": self.ruin.model.name,
            "seed": self.ruin.seed,
            "wall_s": self.wall_time,
        }


def infer(
    ruin: Ruin | str | Path,
    *,
    out: str | Path | None = None,
    campaign: Campaign | None = None,
    **settings: Any,
) -> Inference:
    """Infer what shaking left a ruin as it is: approximate Bayesian computation over one table of simulations.

    Parameters
    ----------
    ruin : Ruin or path
        Or the file that describes one.
    out : path, optional
        Folder that keeps the table (``simulations.npz``) and the finished runs: the next question to the same table takes
        seconds, and more ``simulations`` add to it.
    campaign, **settings : Campaign, optional

    Raises
    ------
    InputError
        The ruin cannot be used; no draw of the prior leaves what is seen, or fewer than a hundred do.

    References
    ----------
    Barber et al. (2021); Beaumont, Zhang and Balding (2002); Fearnhead and Prangle (2012); of survival, Anderson and Brune
    (1999).
    """
    campaign = Campaign.of("infer", campaign, settings, RUNS, tail=TAIL)
    began = time.perf_counter()
    if not isinstance(ruin, Ruin):
        ruin = read_ruin(check_kind("ruin", ruin, (str, Path)))
    survival = None if ruin.survival is None else (ruin.survival, hazard_of(ruin.survival))
    options = {"folder": out, "campaign": campaign}
    table = simulations_of(ruin.simulated, ruin.prior, ruin.model, ruin.simulations, ruin.seed, **options)
    sound = table.subset(np.flatnonzero(table.sound))
    lasted = None if survival is None else outlasting(sound, ruin.facts, *survival, ruin.seed)
    answers = Answers(sound, ruin.facts, ruin.seed, None if lasted is None else lasted.weights)
    _refuse_few(answers)
    return Inference(ruin, answers, lasted, len(table) - len(sound), time.perf_counter() - began)


def _refuse_few(answers: Answers) -> None:
    """Refuse what no draw, or too few of them, have left."""
    which, count = answers.matching(answers.facts), len(answers.table)
    if len(which) >= FEWEST:
        return
    if not len(which):
        events = list(answers.matched)
        rarest = min(events, key=lambda fact: int(answers.matched[fact].sum()))
        share = int(answers.matched[rarest].sum())
        never = f"none of them leaves {rarest.label!r}" if not share else (
            f"the rarest of what is seen is {rarest.label!r}, which {share} of them leave"
        )  # fmt: skip
        agree = np.sum([answers.matched[fact] for fact in events], axis=0)
        nearest = [_draw_words(answers, int(k), events) for k in np.argsort(-agree, kind="stable")[:3]]
        raise InputError(
            f"none of {count} simulations leaves all that is seen: {never}; the nearest are {'; '.join(nearest)}; widen the "
            "prior, or raise simulations.",
            "prior",
        )
    wanted = int(np.ceil(1.2 * FEWEST * count / len(which) / 100.0) * 100)
    raise InputError(
        f"{len(which)} of {count} simulations leave what is seen, and {FEWEST} are needed; raise simulations to about "
        f"{wanted}, or leave out what is hardly ever left.",
        "simulations",
        value=count,
    )


def _draw_words(answers: Answers, k: int, events: Sequence[Fact]) -> str:
    """A draw, and the events that it leaves otherwise."""
    parameters = answers.table.parameters
    other = [fact.label for fact in events if not answers.matched[fact][k]]
    of = f"{parameters['pgv_m_s'][k]:.2g} m/s with {parameters['period_s'][k]:.2g} s"
    return f"{of} (all but {listed([repr(label) for label in other])})"
