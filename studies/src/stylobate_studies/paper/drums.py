"""Sentences of the paper on the column of drums under harmonic motion (its section 3.2)."""

from __future__ import annotations

import numpy as np

from .cases import BEAM, DEM, DRUMS, MONOLITH, REFERENCE
from .monolith import base_displacements
from .reading import Reader, all_but, first, in_g, nearest, percent, percents, rising, share, span, step
from .sentences import Statement, judged


def drum_statements(r: Reader) -> list[Statement]:
    """The sentences, in the order of the paper's text."""
    bd, dd = r.domain(DRUMS, BEAM), r.domain(DRUMS, DEM)
    low, beams = first(bd, high=0.999), r.variants(DRUMS, BEAM)
    pairs = np.array([first(bd), first(dd)])
    sizes = {(name, label): r.unsafe(name, label) for name in (MONOLITH, DRUMS) for label in (BEAM, DEM)}
    order = {
        label: {key: share(d) - share(r.results.variants[MONOLITH, key]) for key, d in r.variants(DRUMS, label).items()}
        for label in (BEAM, DEM)
    }
    return [
        base_displacements(r, DRUMS, "3.2 ¶1, 4 ¶1, Figs. 7, 8"),
        Statement(
            "3.2 ¶1, Figs. 7, 8", "The multi-drum column collapses more readily with the rigid beam than with the DEM.",
            f"unsafe share of the domain: rigid beam {percent(sizes[DRUMS, BEAM])}, DEM {percent(sizes[DRUMS, DEM])}",
            judged(sizes[DRUMS, BEAM] > sizes[DRUMS, DEM]),
            "No sliding and no loss in the beam.",
            f"On the grid of the open parameters: beam {percents([share(beam) for beam in beams.values()])}, "
            f"DEM {percents([share(variant) for variant in r.variants(DRUMS, DEM).values()])}.",
        ),
        Statement(
            "3.2 ¶2, Fig. 9", "The rigid beam's multi-drum column collapses for accelerations up to 0.2 g below 1 Hz.",
            f"first collapse below 1 Hz: {span(low)}, in steps of {step(bd):.4g} g",
            judged(
                bool((low <= 0.2 + 1e-6).all()),
                {"within a step of the grid": bool((low - step(bd) <= 0.2 + 1e-6).all())}
                | {key: bool((first(beam, high=0.999) <= 0.2 + 1e-6).all()) for key, beam in beams.items()},
            ),
            "The statics of the stack of prisms opens the lowest joint at 0.20 g. Taken as: the first "
            "collapse is not above 0.2 g; the boundary lies within a step below it.",
            "First collapse " + r.spread(DRUMS, BEAM, 0.66) + ".",
        ),
        _at_two_hertz(r),
        Statement(
            "3.2 ¶2, Fig. 9", "The rigid beam's collapse accelerations are smaller than the DEM's (drums).",
            f"smaller at {int((pairs[0] < pairs[1]).sum())}, equal at {int((pairs[0] == pairs[1]).sum())} "
            f"of {pairs.shape[1]} frequencies",
            judged(
                bool((pairs[0] <= pairs[1]).all()),
                {"at nine frequencies in ten": bool((pairs[0] <= pairs[1]).mean() > 0.9)},
            ),
            "No sliding and no loss in the beam; the next row asks which of them it is.",
            "At 1 Hz the DEM's first collapse goes " + r.spread(DRUMS, DEM, 1.0).removeprefix("at 1 Hz ") + ".",
        ),
        _sliding(r),
        Statement(
            "3.2 ¶3, Figs. 6, 9", "With the rigid beam the monolith is less prone to collapse than the drums.",
            f"unsafe share: monolith {percent(sizes[MONOLITH, BEAM])}, drums {percent(sizes[DRUMS, BEAM])}",
            judged(all(gap > 0.0 for gap in order[BEAM].values()), {key: gap > 0.0 for key, gap in order[BEAM].items()}),
            "Drums add ways to collapse, and the beam takes no energy out of them.",
            all_but({key: gap > 0.0 for key, gap in order[BEAM].items()}),
        ),
        Statement(
            "3.2 ¶3, Figs. 6, 9", "With the DEM the unsafe region of the multi-drum column is the smaller one.",
            f"unsafe share: monolith {percent(sizes[MONOLITH, DEM])}, drums {percent(sizes[DRUMS, DEM])}",
            judged(all(gap < 0.0 for gap in order[DEM].values()), {key: gap < 0.0 for key, gap in order[DEM].items()}),
            "Twelve joints slip a little in every cycle and so take out energy.",
            all_but({key: gap < 0.0 for key, gap in order[DEM].items()}),
        ),
    ]  # fmt: skip


def _at_two_hertz(r: Reader) -> Statement:
    domain, beams = r.domain(DRUMS, BEAM), r.variants(DRUMS, BEAM)
    two = nearest(domain, 2.0)
    as_printed = {
        key: nearest(variant, 2.0)
        for key, variant in beams.items()
        if abs(nearest(variant, 2.0) - 0.36) <= 0.041 and first(variant, high=1.001).max() <= 0.241
    }
    named = "; ".join(f"{key}: {in_g(value)}" for key, value in as_printed.items())
    return Statement(
        "3.2 ¶2, Fig. 9", "Its collapse acceleration slightly increases up to 0.36 g with 2 Hz.",
        f"first collapse at 2 Hz: {in_g(two)}; of all pairs of frequencies with different first collapses, the higher one "
        f"has the larger in {percent(rising(domain))}"
        + (f". {named[0].upper()}{named[1:]}" if named else ""),
        judged(abs(two - 0.36) <= 0.02 and rising(domain) >= 0.9, {key: key in as_printed for key in beams}),
        "With the law in each drum's own rotation and no damping, the stack shakes itself apart at high frequencies; "
        "gravity in the equations of motion and a trace of damping in closed joints remove that. The paper gives neither "
        "damping nor ξ. In part: within 0.04 g at 2 Hz, and no more than 0.24 g up to 1 Hz.",
        "First collapse " + r.spread(DRUMS, BEAM, 2.0) + ".",
    )  # fmt: skip


def _sliding(r: Reader) -> Statement:
    keys = (
        "beam, true drums",
        "beam with sliding",
        "beam with sliding, tan φ = 10",
        REFERENCE,
        "DEM, tan φ = 10",
    )
    free, slips, stuck, dem, rough = (share(r.results.variants[DRUMS, key]) for key in keys)
    gap = max(free - dem, 1e-9)
    closed, opened = (free - slips) / gap, (rough - dem) / gap
    damped, paper = (share(r.results.variants[DRUMS, f"beam, {key}"]) for key in ("β = 0.5 ms", "as the paper"))
    return Statement(
        "3.2 ¶2", "The difference is mainly given by sliding, which the rigid beam neglects.",
        f"unsafe share on the grid of the open parameters: beam of true drums {percent(free)}, with sliding "
        f"{percent(slips)}, DEM {percent(dem)}; with tan φ = 10: beam {percent(stuck)}, DEM {percent(rough)}",
        judged(
            closed > 0.5 and opened > 0.5,
            {"letting the beam slip": closed > 0.5, "keeping the DEM from slipping": opened > 0.5},
        ),
        f"Two tests. Letting the beam slip closes {percent(closed)} of the gap. Keeping the DEM from slipping, by "
        f"friction, opens {percent(max(0.0, opened))} of it: its joints then lose energy where they open under shear. What "
        "counts is the energy that joints take out, and sliding is one way of doing it.",
        f"A stiffness damping of 0.5 ms alone brings the paper's beam from {percent(paper)} to {percent(damped)}.",
    )  # fmt: skip
