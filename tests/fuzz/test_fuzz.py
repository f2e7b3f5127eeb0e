"""Every target of ``make fuzz`` with few tries; and faults, hangs and budgets are seen."""

import time

import pytest

from fuzz import targets
from fuzz.target import Fault, Target, Tried, fuzz

TARGETS = targets.by_name()


@pytest.mark.parametrize("name", TARGETS)
def test_target(name):
    report = fuzz(TARGETS[name], TARGETS[name].small)
    assert not report.faults, "\n".join(report.faults)
    assert report.tries == TARGETS[name].small


def test_what_goes_wrong_is_seen_and_can_be_repeated_by_its_number():
    def attempt(rng, folder):
        assert not list(folder.iterdir())
        number = rng.random()
        if number < 0.2:
            raise Fault(f"{number}")
        if number < 0.4:
            raise ZeroDivisionError(f"{number}")
        return "read"

    target = Target("sample", 50, 1, attempt)
    report = fuzz(target)
    assert report.tries == 50
    assert report.results["read"] == 50 - len(report.faults) > 0
    assert any("ZeroDivisionError" in text for text in report.faults)
    first = report.faults[0]
    again = fuzz(target, 1, first=int(first.split()[2]))
    assert again.faults[0].splitlines()[0] == first.splitlines()[0]


def test_hangs_and_the_budget_end():
    target = Target("slow", 50, 1, lambda rng, folder: time.sleep(5.0) or "read", limit=0.05)
    started = time.monotonic()
    report = fuzz(target, budget=0.2)
    assert time.monotonic() - started < 4.0
    assert 1 <= len(report.faults) < 50
    assert all("no end after" in text for text in report.faults)
    assert "stopped by the budget" in str(report)


def test_numbers_of_the_tries_are_told_as_a_distribution():
    def attempt(rng, folder):
        return Tried("read", {"answers [s]": [0.1, 0.3, 0.2]})

    report = fuzz(Target("sample", 2, 1, attempt))
    assert report.results == {"read": 2}
    assert str(report).endswith("; 0 faults; 6 answers [s]: median 0.20, largest 0.30")
