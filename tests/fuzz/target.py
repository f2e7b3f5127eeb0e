"""What a target of the fuzzing is, how its tries are counted, and how a fault is told."""

from __future__ import annotations

import random
import signal
import statistics
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path


class Fault(AssertionError):
    """A try that did not end as it must: a silent change, a loss, an answer that is none."""


class Hang(BaseException):
    """A try that took longer than its limit; no handler of exceptions may swallow it."""


class Tried(str):
    """A word for what came of a try, with numbers whose distribution is told at the end.

    Parameters
    ----------
    word : str
    numbers : dict
        By what they are, with the unit: a list of numbers.
    """

    numbers: dict[str, list[float]]

    def __new__(cls, word: str, numbers: dict[str, list[float]]):
        made = super().__new__(cls, word)
        made.numbers = numbers
        return made


@dataclass(frozen=True)
class Target:
    """One kind of try.

    Parameters
    ----------
    name : str
        As on the command line.
    count : int
        Tries of a whole run.
    small : int
        Tries in the test suite.
    attempt : callable
        One try, from a generator of random numbers of its own and an empty folder of its own. Returns a word for what
        came of it (``read``, ``refused`` …), which is counted; raises :class:`Fault`, or anything else, where that is wrong.
    limit : float
        Longest time that one try may take [s].
    """

    name: str
    count: int
    small: int
    attempt: Callable[[random.Random, Path], str]
    limit: float = 20.0


@dataclass
class Report:
    """What came of the tries of a target."""

    target: Target
    wanted: int
    seconds: float = 0.0
    results: Counter = field(default_factory=Counter)
    faults: list[str] = field(default_factory=list)
    numbers: dict[str, list[float]] = field(default_factory=dict)

    @property
    def tries(self) -> int:
        """Number of tries made."""
        return sum(self.results.values()) + len(self.faults)

    def __str__(self) -> str:
        counts = ", ".join(f"{number} {word}" for word, number in sorted(self.results.items()))
        short = "" if self.tries >= self.wanted else f" of {self.wanted}, stopped by the budget"
        text = f"{self.target.name}: {self.tries} tries{short} in {self.seconds:.0f} s: {counts}; {len(self.faults)} faults"
        for what, values in self.numbers.items():
            if values:
                middle = f"median {statistics.median(values):.2f}, largest {max(values):.2f}"
                text += f"; {len(values)} {what}: {middle}"
        return text


def fuzz(
    target: Target,
    count: int | None = None,
    *,
    seed: int = 1,
    first: int = 0,
    budget: float = float("inf"),
    tell: Callable[[str], None] | None = None,
) -> Report:
    """Make ``count`` tries, or as many as the budget allows [s]; each can be repeated alone by its number."""
    wanted = target.count if count is None else count
    report, started = Report(target, wanted), time.monotonic()
    for number in range(first, first + wanted):
        if time.monotonic() - started > budget:
            break
        rng = random.Random(f"{target.name}:{seed}:{number}")
        try:
            with (
                tempfile.TemporaryDirectory() as folder,
                warnings.catch_warnings(),
                _within(target.limit),
            ):
                warnings.simplefilter("ignore")
                word = target.attempt(rng, Path(folder))
                report.results[str(word)] += 1
                for what, values in getattr(word, "numbers", {}).items():
                    report.numbers.setdefault(what, []).extend(values)
        except KeyboardInterrupt:
            raise
        except BaseException as error:
            what = f"no end after {target.limit:g} s" if isinstance(error, Hang) else traceback.format_exc(limit=-6)
            report.faults.append(f"{target.name} number {number} of seed {seed}: {what}")
            if tell:
                tell(report.faults[-1])
    report.seconds = time.monotonic() - started
    return report


@contextmanager
def _within(limit: float):
    def stop(*_):
        raise Hang

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, limit)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def sentence(error: BaseException) -> str:
    """The message of a refusal, which must be one clear sentence."""
    text = str(error)
    if "\n" in text or not text.endswith((".", "?")) or len(text) > 2500:
        raise Fault(f"not one sentence: {text[:2000]!r}") from error
    return text
