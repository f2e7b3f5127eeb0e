"""Links in words: one at its capacity has yielded and is not called whole."""

import math

from stylobate.response.links import YIELDS, LinkMeasures, sentence_of


def link(name="core", kind="core", tension=1.0, broken_at=math.nan):
    return LinkMeasures(name, kind, 0, broken_at, 0.0, tension, 0.0, 0.0, math.inf, 1.0)


def test_a_link_at_its_capacity_is_not_whole():
    assert sentence_of([link(tension=0.4)]) == "The core is whole; the core bore 40 % of what it can."
    assert sentence_of([link()]) == f"The core did not break, but was at its capacity. {YIELDS}"
    bars = [link(f"bar {i}", "bar", size) for i, size in enumerate((1.0, 0.5, 1.0), start=1)]
    assert sentence_of(bars[:2]) == f"Neither of both bars broke, but the bar 1 was at its capacity. {YIELDS}"
    assert sentence_of(bars) == f"None of 3 bars broke, but 2 were at their capacity, such as the bar 1. {YIELDS}"
    broke = link("bar 4", "bar", broken_at=2.0)
    sentence = (
        "1 of 2 bars broke, the first at 2.00 s, the bar 4. Of those that did not break, the bar 1 was at its capacity."
    )
    assert sentence_of([bars[0], broke]) == f"{sentence} {YIELDS}"
