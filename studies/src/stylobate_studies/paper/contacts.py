"""Contact parameters in the plane and in space (the paper's section 1): how far verdicts hang on them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from stylobate.campaign.campaign import Progress
from stylobate.column import Column
from stylobate.column.catalogue import PAPER
from stylobate.constants import g
from stylobate.messages import percent
from stylobate.verdicts.domain import CollapseProbability

from .cases import ACROSS, DEM, DURATION, PLANE, POPULATIONS, SHORT, SPACE, paper_column
from .pieces import population_piece, slug
from .sentences import Statement, judged

#: Frequencies [Hz], amplitudes [m/s²] and number of columns of each cell.
FREQUENCIES, AMPLITUDES, COLUMNS = np.array([0.5, 1.0, 2.0]), np.linspace(0.15, 0.6, 10) * g, 4

#: Contact parameters that are changed: their factor; friction by its coefficient. The first is the columns as they are, the
#: second the change that a verdict makes of nothing.
SETTINGS: Mapping[str, dict[str, float]] = {
    "as they are": {},
    "k_n, k_s · 1.001": {"normal_stiffness": 1.001, "shear_stiffness": 1.001},
    "k_n / 10": {"normal_stiffness": 0.1},
    "k_n · 10": {"normal_stiffness": 10.0},
    "k_s / 10": {"shear_stiffness": 0.1},
    "k_s · 10": {"shear_stiffness": 10.0},
    "tan φ = 0.5": {"friction_coefficient": 0.5},
    "tan φ = 0.9": {"friction_coefficient": 0.9},
}
SAME, NOTHING = list(SETTINGS)[:2]

Populations = Mapping[tuple[str, str, str], CollapseProbability]


def contacts_piece(
    data: Path, tail: float, threads: int, advance: Callable[[str], Progress | None]
) -> dict[tuple[str, str, str], CollapseProbability]:
    """Shares of round columns that collapse, by column, model (plane or space) and setting."""
    grid = (FREQUENCIES, AMPLITUDES, DURATION)
    return {
        (name, where, setting): population_piece(
            data / slug("contacts", name, where, setting.replace("·", "times")), _changed(name, change),
            POPULATIONS[where], grid, COLUMNS, tail, threads, advance(f"contacts, {name}, {where}: {setting}"), ACROSS,
        )
        for name in PAPER
        for where in (PLANE, SPACE)
        for setting, change in SETTINGS.items()
    }  # fmt: skip


def moved(populations: Populations, name: str, where: str, setting: str) -> float:
    """Mean change of the share of columns that collapse in a cell [-]."""
    share, other = (populations[name, where, key].frequency for key in (setting, SAME))
    return float(np.nanmean(np.abs(share - other)))


def contacts_statement(populations: Populations) -> Statement:
    """The sentence on the sensitivity to contact parameters."""
    changed = [key for key in SETTINGS if key not in (SAME, NOTHING)]
    mean = {
        (name, where): float(np.mean([moved(populations, name, where, key) for key in changed]))
        for name in PAPER
        for where in (PLANE, SPACE)
    }
    noise = {pair: moved(populations, *pair, NOTHING) for pair in mean}
    less = {
        SHORT[name]: mean[name, SPACE] - mean[name, PLANE] > max(noise[name, where] for where in (PLANE, SPACE))
        for name in PAPER
    }
    share = {key: population.mean for key, population in populations.items()}
    means = "; ".join(
        f"{SHORT[name]} {where} {percent(mean[name, where])} (a change of 0.1 %: {percent(noise[name, where])})"
        for name, where in mean
    )
    worst = "; ".join(
        f"{SHORT[name]} {where} {percent(share[name, where, SAME])}, "
        + _ends({key: share[name, where, key] for key in changed})
        for name, where in mean
    )
    return Statement(
        "1 ¶3", "Two-dimensional analyses are less sensitive to the contact parameters than three-dimensional ones.",
        f"mean change of the share of round columns that collapse in a cell, over {len(changed)} changes of a contact "
        f"parameter: {means}",
        judged(all(less.values()), less),
        "Taken as: less by more than a change of 0.1 % makes. k_n and k_s ten times smaller and larger, tan φ 0.5 and 0.9. "
        f"Unsafe share as they are, and least and most with a change: {worst}.",
        f"{COLUMNS} columns in each of {FREQUENCIES.size * AMPLITUDES.size} cells.",
    )  # fmt: skip


def time_statement(cost: Mapping[str, float]) -> Statement:
    """The sentence on the computing time of the plane."""
    plane, space = cost[DEM], cost[SPACE]
    return Statement(
        "1 ¶3", "Two-dimensional analyses are more time efficient than three-dimensional ones.",
        f"two seconds of twelve drums by distinct elements, in batches on one core: plane {1e3 * plane:.1f} ms, space "
        f"{1e3 * space:.1f} ms",
        judged(plane < space), "Measured on the machine that wrote this table.",
    )  # fmt: skip


def _changed(name: str, change: Mapping[str, float]) -> Column:
    column = paper_column(name, "circular")
    law = column.joints[0]
    new = {key: value if key == "friction_coefficient" else value * getattr(law, key) for key, value in change.items()}
    return column.with_joint(**new) if new else column


def _ends(shares: Mapping[str, float]) -> str:
    low, high = min(shares, key=shares.__getitem__), max(shares, key=shares.__getitem__)
    return f"{percent(shares[low])} ({low}) to {percent(shares[high])} ({high})"
