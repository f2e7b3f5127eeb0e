"""Conclusions of the paper (its section 4 and its abstract)."""

from __future__ import annotations

from stylobate.column.catalogue import PAPER
from stylobate.constants import g

from .cases import BEAM, BLOCKS, DEM, MONOLITH, SHORT
from .reading import Reader, first, in_g, percent
from .sentences import Statement, judged


def conclusions(r: Reader) -> list[Statement]:
    """The sentences, in the order of the paper's text."""
    sizes = {(name, label): r.unsafe(name, label) for name in PAPER for label in (BEAM, BLOCKS, DEM)}
    smaller = [sizes[name, BEAM] > sizes[name, DEM] for name in PAPER]
    low = [first(r.domain(name, label), high=1.0).min() for name in PAPER for label in (BEAM, DEM)]
    between = [
        min(sizes[name, BEAM], sizes[name, DEM]) <= sizes[name, BLOCKS] <= max(sizes[name, BEAM], sizes[name, DEM])
        for name in PAPER
    ]
    agree = [r.agreement(name) for name in PAPER]
    cost = r.results.cost
    light = {label: cost[label] < min(0.02, cost[DEM]) for label in (BEAM, BLOCKS)}
    limits = {label: float(r.results.limits[MONOLITH, label].first_collapse[0] / g) for label in (BEAM, BLOCKS, DEM)}
    static = limits[BEAM] < limits[BLOCKS] < limits[DEM]
    return [
        Statement(
            "4 ¶1", "The rigid beam is in sufficient agreement with the DEM over the harmonic tests.",
            f"same verdict: monolith {int(agree[0].sum())}, drums {int(agree[1].sum())} of {agree[0].size} cases each",
            judged(
                min(same.mean() for same in agree) >= 0.8,
                {
                    f"{SHORT[name]}, {same.sum()} of {same.size}": bool(same.mean() >= 0.8)
                    for name, same in zip(PAPER, agree)
                },
            ),
            "Sufficient is taken as four verdicts in five.",
        ),
        Statement(
            "4 ¶1, Figs. 6, 9", "The rigid beam has the smaller safe domain for both column types.",
            "unsafe share, rigid beam against DEM: "
            + "; ".join(
                f"{SHORT[name]} {percent(sizes[name, BEAM])} against {percent(sizes[name, DEM])}" for name in PAPER
            ),
            judged(all(smaller), dict(zip(SHORT.values(), smaller))), "Prisms of mean width, no loss at impact, no sliding.",
        ),
        Statement(
            "4 ¶1, Figs. 6, 9", "The rigid beam has small collapse accelerations for decreasing frequency, "
            "compared with the DEM.",
            f"smallest up to 1 Hz: monolith {in_g(low[0])} against {in_g(low[1])}, "
            f"drums {in_g(low[2])} against {in_g(low[3])}",
            judged(low[0] < low[1] and low[2] <= low[3], {"monolith": low[0] < low[1], "drums": low[2] <= low[3]}),
            "For the monolith the prism's tan α is 0.162, the trapezium's 0.205. The stack of prisms has its true "
            "base, and nearly the statics of the true stack.",
        ),
        Statement(
            "4 ¶1", "The rigid block model shows an intermediate behaviour between DEM and rigid beam.",
            "unsafe share of beam, blocks, DEM: "
            + "; ".join(
                f"{SHORT[name]} " + ", ".join(percent(sizes[name, label]) for label in (BEAM, BLOCKS, DEM))
                for name in PAPER
            )
            + f"; monolith at 0.1 Hz {limits[BEAM]:.3f} g, {limits[BLOCKS]:.3f} g, {limits[DEM]:.3f} g",
            judged(all(between) and static, {f"harmonic tests, {SHORT[name]}": value for name, value in zip(PAPER, between)}
                   | {"monolith at 0.1 Hz, nearly statics": static}),
            "The paper says it of the pushover, and announces the harmonic tests.",
        ),
        Statement(
            "Abstract ¶2", "The rigid models represent columns with a computational effort that is not significant.",
            "two seconds of twelve drums, in batches on one core: "
            + ", ".join(f"{label} {1e3 * cost[label]:.1f} ms" for label in (BEAM, BLOCKS, DEM)),
            judged(all(light.values()), light),
            "Taken as: a hundred times faster than the motion itself, and faster than the DEM. Measured on the machine that "
            "wrote this table.",
        ),
    ]  # fmt: skip
