"""The figures of ``stylobate reproduce``, with their captions, by section of the page."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stylobate.verdicts.domain import Domain
    from stylobate_report.page import Picture

    from .study import PaperResults

#: The columns as titles.
TITLES = {"paper-monolithic": "Monolithic column", "paper-12-drums": "Column of twelve drums"}


def draw(results: PaperResults, folder: Path) -> dict[str, list[Picture]]:
    """All figures as PNG and SVG in ``figures``; pictures of the page by section."""
    import numpy as np

    from stylobate import plots
    from stylobate.column.catalogue import PAPER
    from stylobate.constants import g
    from stylobate_report.page import Picture

    from . import cases as c
    from . import page
    from . import pictures as p
    from .pieces import slug

    place = folder / "figures"
    place.mkdir(exist_ok=True)

    def keep(name: str, figure: Any, caption: str) -> Picture:
        return Picture(plots.save(figure, place / name)[0], caption)

    top = f"{results.grids.amplitudes[-1] / g:g} g"
    shown = {
        section: [
            (TITLES[name], [(label, _seen(domain, label)) for label, domain in _of(results, name, section).items()])
            for name in PAPER
        ]
        for section in ("rectangular", "circular")
    }
    sections: dict[str, list[Picture]] = {
        page.OVERVIEW: [
            keep(
                "domains",
                p.draw_domain_panels(shown["rectangular"], "Which shaking brings the column down?"),
                "Every cell is one computed history: dark, the column falls; light, it stands. Above each panel the share "
                "of cells that collapse. Dashed, the static acceleration that opens a joint (for the paper's beam, of its "
                "prisms). Light cells inside the dark and dark ones outside are islands: near the boundary a verdict is a "
                "coin toss.",
            )
        ],
        page.LAWS: [
            keep(
                "figure-3-moment-rotation",
                p.draw_moment_laws(),
                "As the paper's Figure 3: left, the branch that falls to the critical angle; right, the first elastic "
                "branch, a thousand times smaller.",
            )
        ],
    }
    numbers = {(c.MONOLITH, c.BEAM): 4, (c.MONOLITH, c.DEM): 5, (c.DRUMS, c.BEAM): 7, (c.DRUMS, c.DEM): 8}
    pictures = sections[page.HISTORIES] = []
    for (name, label), number in numbers.items():
        figure = p.draw_history_grid(results.histories[name, label], c.paper_column(name), f"{TITLES[name]}, {label}")
        caption = (
            f"As the paper's Figure {number}: base (red) and top (dashed), relative to the ground. Tinted: collapse; "
            "hatched: no verdict; the shaking ends at the dotted line."
        )
        if label == c.BEAM:
            caption += " The base of this model is the ground."
        if (name, label) == (c.DRUMS, c.BEAM):
            caption += " In this model drums may turn on their own, by up to 90°, while the top hardly moves."
        pictures.append(keep(f"figure-{number}-{slug(name, label)}", figure, caption))
        figure = p.draw_history_grid(
            results.histories[name, label], c.paper_column(name), f"{TITLES[name]}, {label}, in space", absolute=True
        )
        caption = (
            f"The same as displacements in space, as the paper's Figure {number} may have drawn them: a sine of "
            "acceleration from rest lets the ground drift by a t/ω (blue), while a cosine of velocity does not."
        )
        pictures.append(keep(f"figure-{number}-{slug(name, label)}-absolute", figure, caption))
    looks = {label: i for i, label in enumerate(c.MODELS)}
    for section, title in (("rectangular", page.BOUNDARIES), ("circular", page.CIRCULAR)):
        pictures = sections[title] = []
        if section == "circular":
            figure = p.draw_domain_panels(shown[section], "Circular sections")
            pictures.append(keep("domains-circular", figure, "As above, with the widths as diameters."))
        for name, number in ((c.MONOLITH, 6), (c.DRUMS, 9)):
            domains = _of(results, name, section)
            if len(domains) > 1:
                named = [dataclasses.replace(domain, model=label) for label, domain in domains.items()]
                figure = plots.draw_boundaries(named, f"{TITLES[name]}, {section}", [looks[label] for label in domains])
                caption = (
                    f"As the paper's Figure {number}, {section} section: smallest amplitude that collapses the "
                    f"column. A line ends where nothing collapses up to {top}."
                )
                pictures.append(keep(f"figure-{number}-{section}", figure, caption))
    populations = [
        (TITLES[name], [(label, population) for (column, label), population in results.space.items() if column == name])
        for name in PAPER
    ]
    figure = p.draw_probability_panels(populations, "Round columns: which shaking brings them down?")
    many = results.grids.space_replicates
    caption = (
        f"Share of {many} slightly different round columns that collapse, in each cell under the same motions. Above each "
        "panel the mean over its cells."
    )
    sections[page.IN_SPACE] = [keep("space", figure, caption)]
    if results.company is not None:
        caption = (
            "Left, each column by itself; right, runs in which anything falls. Those without a verdict are left out."
        )
        sections[page.COMPANY] = [keep("company", p.draw_shares(results.company), caption)]
    pictures = sections[page.DOUBT] = []
    for name, doubt in results.doubts.items():
        figure = p.draw_doubt(doubt, f"{TITLES[name]}: the same question, asked three times")
        caption = "Distinct elements. Dots mark cells whose verdict is another one than in the panel on the left."
        pictures.append(keep(f"certainty-{slug(name)}", figure, caption))
        figure = plots.draw_probability(doubt.population, TITLES[name])
        caption = (
            f"Share of {doubt.population.replicates} columns that collapse, all within 1 % of the one in the figure above. "
            "Under the full line none collapses, above the dashed line all do; where that is missing, some stand even at "
            "the largest amplitude. Right: one frequency, with confidence intervals."
        )
        pictures.append(keep(f"probability-{slug(name)}", figure, caption))
    for (name, section), path in results.paths.items():
        path.save(folder / "data" / f"pushover-{slug(name, section)}.csv")
    paths = [(f"{TITLES[name]}, {section}", path) for (name, section), path in results.paths.items()]
    caption = (
        "Load multiplier over the displacement of the top: whole, and near the peak. One piece or twelve drums makes no "
        "difference but to the stiffness of the start."
    )
    figure = p.draw_pushover_paths(paths, "Pushover of the rigid block model")
    sections[page.PUSHOVER] = [keep("pushover", figure, caption)]
    pictures = sections[page.OPEN] = []
    for name in PAPER:
        first = {key: results.variants[name, key].first_collapse / g for key in results.grids.variants}
        frequencies = np.asarray(results.grids.variant_frequencies)
        figure = p.draw_sensitivity(first, frequencies, f"{TITLES[name]}: one parameter changed at a time")
        step = float(np.diff(results.grids.variant_amplitudes).max() / g)
        most = results.grids.variant_amplitudes[-1] / g
        caption = f"Smallest amplitude that collapses the column, in steps of {step:.2g} g; none: not up to {most:g} g."
        pictures.append(keep(f"sensitivity-{slug(name)}", figure, caption))
    return sections


def _of(results: PaperResults, name: str, section: str) -> dict[str, Domain]:
    return {label: d for (column, label, shape), d in results.domains.items() if (column, shape) == (name, section)}


def _seen(domain: Domain, label: str) -> Domain:
    """The domain with the column as the model sees it: the paper's beam is made of prisms."""
    from .cases import BEAM

    return dataclasses.replace(domain, column=domain.column.as_prism()) if label == BEAM else domain
