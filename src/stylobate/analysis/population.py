"""What twins of a column under one motion come to: verdicts, intervals, spread, and the words for them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ..campaign.twins import Twins
from ..messages import joined, say
from ..percent import percents
from ..response.measures import SPREAD
from ..response.recorded import Recorded
from ..response.words import doubt_of
from . import verdicts as v
from .debris import BodyOverTwins, bodies_over_twins, words_of_bodies
from .directions import peak_of
from .unknown_law import share_limits

if TYPE_CHECKING:
    import pandas

#: Twins that must stand before their largest and least displacement tell where a run belongs.
ENOUGH = 8


#: Interval in tables as if the law of the joints were known, where it is not.
OF_COLUMNS = ("collapse_interval_of_columns_low", "collapse_interval_of_columns_high")

#: Heading of a column of a table that holds :func:`chance_words`.
CHANCE = say("those like it that collapse")


@dataclass(frozen=True, eq=False)
class Population:
    """Twins of a column under one motion.

    Parameters
    ----------
    drawn : Twins
    rows : tuple of dict
        One per twin, with the keys of ``Measures.row()``.
    confidence : float
        Level of the interval.
    to_decide : str
        What decides those whose verdict is open, in a clause.
    doubt : str
        Of assemblies in space, what stands beside all of them: some may have struck where the run itself did not.
    """

    drawn: Twins
    rows: tuple[dict, ...]
    confidence: float = 0.95
    to_decide: str = ""
    doubt: str = ""

    @property
    def verdicts(self) -> list[str]:
        """Verdict on each twin."""
        return [v.verdict(row) for row in self.rows]

    @property
    def counts(self) -> dict[str, int]:
        """Number of twins of each verdict."""
        return v.count(self.verdicts)

    @property
    def probability(self) -> float:
        """Share of the twins that collapse, NaN without a verdict: :func:`stylobate.analysis.verdicts.share_collapsed`."""
        return float(v.share_collapsed(*self._counts))

    @cached_property
    def interval(self) -> tuple[float, float]:
        """Confidence limits of the probability of collapse; see :func:`stylobate.analysis.unknown_law.share_limits`."""
        low, high = share_limits(np.array(self.verdicts), self.drawn.groups[: len(self.rows)], self.confidence)
        return float(low), float(high)

    @cached_property
    def interval_of_columns(self) -> tuple[float, float]:
        """The same as if the law of their joints were known."""
        low, high = v.collapse_interval(*self._counts, self.confidence)
        return float(low), float(high)

    @property
    def spread(self) -> dict[str, list[float] | None]:
        """Values that 16, 50 and 84 % of the twins do not exceed, by measure; a collapse exceeds everything.

        None where a verdict is missing, or a percentile lies among the collapses.
        """
        named = (one.key for one in SPREAD)
        return {name: self._percentiles(name) for name in named if not self.rows or name in self.rows[0]}

    @cached_property
    def bodies(self) -> tuple[BodyOverTwins, ...]:
        """Each body of an assembly over its twins; empty for columns."""
        return bodies_over_twins(self.rows)

    @property
    def like(self) -> str:
        """What the twins are: columns, assemblies."""
        return self.drawn.like

    @property
    def order(self) -> list[int]:
        """Twins from the least to the most: by peak displacement, then those that collapse, the last one first."""

        def harm(index: int) -> tuple[bool, float]:
            row = self.rows[index]
            fell = bool(row["collapsed"])
            return fell, -row["collapse_time_s"] if fell else abs(row[peak_of(row)])

        sound = [i for i, verdict in enumerate(self.verdicts) if verdict != v.FAILED]
        return sorted(sound, key=harm)

    @property
    def median(self) -> int | None:
        """Index of the twin in the middle; None if all failed."""
        return self.order[(len(self.order) - 1) // 2] if self.order else None

    @property
    def worst(self) -> int | None:
        """Index of the twin that fares worst; None if all failed."""
        return self.order[-1] if self.order else None

    @property
    def sentence(self) -> str:
        """Certainty of the verdict, in a sentence."""
        counts, number = self.counts, len(self.rows)
        trials = number - counts[v.FAILED]
        if trials == 0:
            return f"None of {number} {self.like} like this could be computed."
        said = f"Collapses in {counts[v.COLLAPSED]} of {trials} {self.like} like this"
        said += f" ({100.0 * self.confidence:g} %: {percents(*self.interval)}"
        if self.drawn.groups:
            said += f"; {percents(*self.interval_of_columns)} by the column alone, the rest by the law of its joints"
        said += ")"
        if counts[v.UNDECIDED]:
            said += f"; {_not_fallen(counts)}{f': {self.to_decide}' if self.to_decide else ''}"
        said += f"; {counts[v.FAILED]} more failed." if counts[v.FAILED] else "."
        return f"{said} {words_of_bodies(self.bodies)}".rstrip()

    @property
    def table(self) -> pandas.DataFrame:
        """One row per twin."""
        import pandas

        named = zip(self.drawn.columns, self.verdicts, self.rows, strict=True)
        return pandas.DataFrame([{"column": twin.name, "verdict": one, **row} for twin, one, row in named])

    @property
    def table_of_bodies(self) -> pandas.DataFrame:
        """One row per body of an assembly: in how many twins it fell, and the regions in which it lay at the end."""
        import pandas

        return pandas.DataFrame([{"body": one.name, **one.row(self.confidence)} for one in self.bodies])

    @property
    def columns(self) -> dict[str, Any]:
        """Certainty of the verdict, as columns of a table; displacements that a share of the twins does not exceed."""
        low, high = self.interval
        columns: dict[str, Any] = {
            "collapse_probability": self.probability,
            "collapse_interval_low": low,
            "collapse_interval_high": high,
            "replicates": len(self.rows),
        }
        if self.drawn.groups:
            columns |= dict(zip(OF_COLUMNS, self.interval_of_columns, strict=True))
        columns |= {f"twins_{one}": number for one, number in self.counts.items() if one != v.NOT_RUN}
        name = next(iter(self.spread))
        spread = self.spread[name]
        for i, share in enumerate((16, 50, 84)):
            columns[f"{name.removesuffix('_m')}_{share}_m"] = None if spread is None else spread[i]
        return columns

    def beside(self, run: Mapping[str, Any]) -> str:
        """Caveat on a run that is no example of its twins; empty where it is one.

        Parameters
        ----------
        run : mapping
            Under the names of the JSON object of ``stylobate run``.
        """
        limits = self.interval if self.drawn.groups else None
        if said := set_against(run, self.counts, self.confidence, limits):
            return said
        name = peak_of(run)
        stood = [abs(row[name]) for row, verdict in zip(self.rows, self.verdicts) if verdict == v.STANDS]
        own = run.get(name)
        if run["collapsed"] or own is None or len(stood) < ENOUGH or min(stood) <= abs(own) <= max(stood):
            return ""
        low, high, here = 1e3 * min(stood), 1e3 * max(stood), 1e3 * abs(own)
        return (
            f"{'Its top moves' if 'top' in name else 'It moves'} {'more' if here > high else 'less'} than "
            f"{'that of ' * ('top' in name)}any {'column' if 'top' in name else 'one'} like it that stands "
            f"({low:.3g} to {high:.3g} mm): with this one, from {min(low, here):.3g} to {max(high, here):.3g} mm."
        )

    def doubt_about(self, response: Recorded) -> str:
        """Why the verdict on the run itself may be another one, where its twins do not say so: those of other laws do."""
        return self.doubt or ("" if self.drawn.groups else doubt_of(response))

    def summary(self, run: Mapping[str, Any] | None = None) -> dict[str, Any]:
        """Under the names of the JSON object of ``stylobate run``; with what must be said of the run itself, if given."""
        low, high = self.interval
        counts = self.counts
        middle = self.median
        return {
            **({"doubt": self.doubt} if self.doubt else {}),
            "collapse_probability": self.probability,
            "collapse_interval_low": low,
            "collapse_interval_high": high,
            "replicates": len(self.rows),
            "certainty": {
                "sentence": self.sentence,
                **{one: counts[one] for one in v.MADE},
                "confidence": self.confidence,
                **({"interval": [low, high]} if self.drawn.groups else {}),
                **({"interval_of_columns": list(self.interval_of_columns)} if self.drawn.groups else {}),
                **self.drawn.facts,
                "percentiles": [16, 50, 84],
                **self.spread,
                "median_twin": None if middle is None else middle + 1,
                "worst_twin": None if self.worst is None else self.worst + 1,
                **({"bodies": {one.name: one.row(self.confidence) for one in self.bodies}} if self.bodies else {}),
                **({} if run is None else {"beside": self.beside(run)}),
            },
        }

    @property
    def _counts(self) -> tuple[int, int, int]:
        counts = self.counts
        return counts[v.COLLAPSED], counts[v.STANDS], counts[v.UNDECIDED]

    def _percentiles(self, name: str) -> list[float] | None:
        sound = [row for row, verdict in zip(self.rows, self.verdicts, strict=True) if verdict != v.FAILED]
        values = np.array([np.inf if row["collapsed"] else abs(row[name]) for row in sound])
        if np.isnan(values).all():  # there are none, or the model does not compute it
            return None
        found = np.quantile(values, (0.16, 0.5, 0.84), method="higher")
        return [float(one) for one in found]


def chance_words(row: Mapping[str, Any]) -> str:
    """Share of the columns like one that collapse, with its interval and their number; empty where there are none.

    Parameters
    ----------
    row : mapping
        Of a table with :attr:`Population.columns`, or the JSON object of ``stylobate run`` with twins; their interval is
        that of :attr:`Population.interval`, which holds another law of the joints where that is not known.
    """
    known = row.get("certainty") or {one: row.get(f"twins_{one}") for one in v.MADE}
    fell, stood, open_, failed = (int(known.get(one) or 0) for one in (v.COLLAPSED, v.STANDS, v.UNDECIDED, v.FAILED))
    number = fell + stood + open_
    if not number:
        return say("none of {count} could be computed", count=failed) if failed else ""
    low, high = (float(row[f"collapse_interval_{one}"]) for one in ("low", "high"))
    said = say("{share} of {count} ({interval})", share=percents(fell / number, (fell + open_) / number), count=number,
               interval=percents(low, high))  # fmt: skip
    counts = [say("{count} undecided", count=open_) * bool(open_), say("{count} failed", count=failed) * bool(failed)]
    return joined("; ", [said, joined(", ", counts)])


def set_against(
    run: Mapping[str, Any],
    counts: Mapping[str, Any],
    confidence: float = 0.95,
    limits: tuple[float, float] | None = None,
) -> str:
    """Caveat where most columns like one end otherwise than it did, the run counted in; empty where they do not.

    The column as surveyed is one of its population: its collapse is never set aside because others stand.

    Parameters
    ----------
    run : mapping
        Of the column itself, under the names of the JSON object of ``stylobate run``.
    counts : mapping
        How many columns like it have which verdict, by its name.
    confidence : float
        Level of the interval.
    limits : (float, float), optional
        Of the share, where more than the columns is unknown; else those of the counts.
    """
    fell, stood, open_ = (int(counts.get(one) or 0) for one in (v.COLLAPSED, v.STANDS, v.UNDECIDED))
    collapsed, decided = bool(run.get("collapsed")), bool(run.get("decided", True))
    differ = stood + open_ > fell if collapsed else fell > stood
    if run.get("outcome") == "failed" or not differ:
        return ""
    number = fell + stood + open_
    fell, stood, open_ = fell + collapsed, stood + (decided and not collapsed), open_ + (not decided and not collapsed)
    low, high = limits or (float(one) for one in v.collapse_interval(fell, stood, open_, confidence))
    some = say("{fell} of {all}, this one and {count} like it, collapse ({level:g} %: {range}); {rest}.")
    alone = say("{fell} of {all}, this one and {count} like it, collapses ({level:g} %: {range}); {rest}.")
    all_ = (alone if fell == 1 else some).of(
        fell=fell, all=number + 1, count=number, level=100.0 * confidence, range=percents(low, high),
        rest=_not_fallen({v.STANDS: stood, v.UNDECIDED: open_}),
    )  # fmt: skip
    if collapsed:
        return say("That others stand does not make this one safe, which falls and is one of them: {all}", all=all_)
    if decided:
        return say("That this one stands does not make it safe, as most like it collapse: {all}", all=all_)
    return say("That this one has not fallen yet does not make it safe, as most like it collapse: {all}", all=all_)


def _not_fallen(counts: Mapping[str, int]) -> str:
    """Numbers of columns that stand and that are undecided."""
    stood, open_ = counts[v.STANDS], counts[v.UNDECIDED]
    words = say("{count} stands", count=stood) if stood == 1 else say("{count} stand", count=stood)
    open_words = say(" and {count} is undecided") if open_ == 1 else say(" and {count} are undecided")
    return words + (open_words.of(count=open_) if open_ else "")
