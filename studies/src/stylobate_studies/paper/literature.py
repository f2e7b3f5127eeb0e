"""Round columns in space as others have tested them: the populations behind what the literature says."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from stylobate.atomic import replacing
from stylobate.campaign.campaign import Campaign
from stylobate.campaign.digests import Hasher
from stylobate.campaign.ledger import RUNS_FILE
from stylobate.campaign.runs import Request, run_all
from stylobate.column.scatter import twins_of
from stylobate.constants import g
from stylobate.models.base import Case
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.motion import harmonic

from . import cases as c
from .folder import is_ready

#: Shaking of the populations: frequency [Hz], amplitude [m/s²], duration and time after it [s].
SHAKING = 1.0, 0.26 * g, 6.0, 5.0

#: Columns of a population, and by how much they differ at most [-].
NUMBER, WITHIN = 16, 0.001

#: Populations of round columns: (preset, law of contact, what acts across over what acts along).
QUESTIONS: tuple[tuple[str, str, float], ...] = (
    (c.MONOLITH, "rim", 0.01),
    (c.DRUMS, "rim", 0.0),
    (c.DRUMS, "rim", 0.01),
    (c.DRUMS, "bed", 0.01),
)


def literature_piece(data: Path) -> dict[str, dict[str, list[float]]]:
    """Peaks, residuals and verdicts of the populations, by name."""
    place = data / "literature.json"
    if not is_ready(place):
        populations = {population_name(*setup): _population(*setup, data / RUNS_FILE) for setup in QUESTIONS}
        with replacing(place) as partial:
            partial.write_text(json.dumps(populations), encoding="utf-8")
    return json.loads(place.read_text(encoding="utf-8"))


def population_name(name: str, law: str, across: float) -> str:
    """A population in words."""
    what = "monolith" if name == c.MONOLITH else "drums"
    return f"{what}, {law}" + (f", {across:.0%} across".replace("%", " %") if across else ", nothing across")


def _population(name: str, law: str, across: float, ledger: Path) -> dict[str, list[float]]:
    frequency, amplitude, duration, tail = SHAKING
    columns = twins_of(c.paper_column(name, "circular"), c.alike(WITHIN), NUMBER, 0)
    beside = (frequency, across * amplitude, 0.5 * np.pi) if across else None
    motion = harmonic(frequency, amplitude, duration, across=beside)
    cases = [Case(column, motion) for column in columns]
    rows = run_all(
        Request.of(cases, Hasher(DistinctElement3D(law=law), Campaign(tail=tail).options)), Campaign(ledger=ledger)
    )
    measures = {
        "collapsed": "collapsed",
        "peak": "peak_top_displacement_m",
        "along": "peak_top_x_m",
        "across": "peak_top_y_m",
        "residual": "residual_top_displacement_m",
    }
    return {key: rows.floats(column).tolist() for key, column in measures.items()}
