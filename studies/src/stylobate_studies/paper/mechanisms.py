"""How columns of drums fall: the state in which each collapse of a domain begins, and how often each kind is seen."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from stylobate.atomic import replacing
from stylobate.campaign.campaign import Progress
from stylobate.campaign.ledger import RUNS_FILE
from stylobate.column import preset
from stylobate.messages import percent
from stylobate.response.mechanism import AS_ONE
from stylobate.verdicts import verdict as v
from stylobate.verdicts.domain import Domain, collapse_domain

from .cases import BEAM, BLOCKS, DEM, DRUMS, DURATION, MODELS
from .folder import is_ready
from .sentences import Statement, judged

#: Models whose collapses are counted.
COUNTED = (BEAM, BLOCKS, DEM)

#: Kinds of collapse.
WHOLE, PART, BROKEN, SLID = "the whole column", "the part above a joint", "in several pieces", "by sliding"


def mechanisms_piece(
    data: Path, domains: Mapping[str, Domain], tail: float, threads: int, advance: Callable[[str], Progress | None]
) -> dict[str, dict[str, int]]:
    """Numbers of collapses of the twelve drums by model and kind, with the runs of the domains in the ledger.

    Parameters
    ----------
    data : path
        Folder of the pieces.
    domains : mapping
        By model.
    tail : float
        [s]
    threads : int
    advance : callable
        Gives what is told of the progress of what has a name.
    """
    place = data / "mechanisms.json"
    if not is_ready(place):
        counts = {}
        for label, domain in domains.items():
            whole = collapse_domain(
                preset(DRUMS), MODELS[label], domain.frequencies, domain.amplitudes, DURATION, tail=tail, threads=threads,
                progress=advance(f"mechanisms: {label}"), ledger=data / RUNS_FILE,
            )  # fmt: skip
            if not whole.complete:
                raise KeyboardInterrupt
            table = whole.table.query("verdict == @v.COLLAPSED")
            kinds = [kind(*both) for both in zip(table["residual_tilt_x_rad"], table["residual_slip_x_m"], strict=True)]
            counts[label] = {mechanism: kinds.count(mechanism) for mechanism in (WHOLE, PART, BROKEN, SLID)}
        with replacing(place) as partial:
            partial.write_text(json.dumps(counts), encoding="utf-8")
    return json.loads(place.read_text(encoding="utf-8"))


def kind(tilts: list[float], slips: list[float]) -> str:
    """How a collapse begins, from inclinations of the drums [rad] and slips of the joints [m] when it has become certain."""
    tilt, width = np.array(tilts), preset(DRUMS).joint_widths
    if (np.abs(slips) > 0.5 * width).any():
        return SLID
    relative = np.abs(np.diff(tilt, prepend=0.0))
    joint = int(np.argmax(relative > 0.5 * relative.max()))
    if np.ptp(tilt[joint:]) > AS_ONE * relative[joint]:
        return BROKEN
    return PART if joint else WHOLE


def mechanisms_statement(counts: Mapping[str, Mapping[str, int]], opening: np.ndarray) -> Statement:
    """What the abstract says of collapse mechanisms, by distinct elements.

    Parameters
    ----------
    counts : mapping
        By model and kind.
    opening : array
        Largest opening of a joint in each collapse of the distinct elements [m].
    """
    wide = float(np.median(opening) / preset(DRUMS).base_width)
    text = "; ".join(
        f"{label} ({sum(by.values())} collapses): "
        + ", ".join(f"{mechanism} {number}" for mechanism, number in by.items())
        for label, by in counts.items()
    )
    return Statement(
        "Abstract ¶2", "The DEM shows collapse mechanisms with large displacements of the blocks.",
        f"twelve drums, as the fall of each cell of the domain begins: {text}. Largest opening of a joint by then, distinct "
        f"elements: {percent(wide)} of the base width in the median",
        judged(wide > 0.1),
        "Taken as: a tenth of the base width. A piece turns as one where inclinations within it differ by less than "
        f"{percent(AS_ONE)} of its rotation in the lowest joint that opens; sliding is a slip of half of a joint's width.",
        "Drums fall apart later, on their way to the ground.",
    )  # fmt: skip


def openings(domain: Domain) -> np.ndarray:
    """Largest opening of a joint in each collapse of a domain [m]."""
    return domain.grid("peak_joint_opening_m")[domain.verdicts == v.COLLAPSED]
