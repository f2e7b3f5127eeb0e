"""What a browser draws of analyses, from their files: cells of a domain as they come, curves."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Iterator, Mapping
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stylobate.atomic import replacing
from stylobate.campaign.grid import read_grid
from stylobate.campaign.ledger import RUNS_FILE, rows_in
from stylobate.motion.intensity import parse_measure
from stylobate.plots.film import film_data, film_of, frame_indices
from stylobate.plots.scene import OBLIQUE
from stylobate.response import Response
from stylobate.response.histories import ENERGY_TERMS
from stylobate.verdicts.verdict import verdict

from .forms import in_page_words
from .job_request import FRAGILITY, RESULT, STUDY
from .workshop import GROWING

if TYPE_CHECKING:
    from stylobate.probability.evidence import Ida

#: Room at the right of the largest response, for collapses [-].
ROOM = 1.25

#: Share of the records by the column of the table that holds its curve.
SHARES = {"16": "edp_16", "50": "edp_50", "84": "edp_84"}


def curves(folder: Path) -> dict[str, Any]:
    """Pictures of a job, without those of what it has not computed.

    Parameters
    ----------
    folder : Path
        Of the job.
    """
    plots: dict[str, Any] = {}
    if (folder / RESULT / "ida.json").is_file():
        plots["ida"] = _ida(folder / RESULT)
    for name, file in (("fragility", folder / FRAGILITY / "fragility.json"), ("growing", folder / GROWING)):
        if file.is_file() and "fragility" not in plots:
            plots[name] = _fragility(json.loads(file.read_text(encoding="utf-8")))
    if (folder / RESULT / "critical.csv").is_file():
        plots["critical"] = [
            [_number(row["amplitude_g"]), _moved(row), row["verdict"]]
            for row in _rows(folder / RESULT / "critical.csv")
        ]
    return plots


def _ida(folder: Path) -> dict[str, Any]:
    """Intensity over the response of every record, collapses as plateaus; and the curves of the records' shares."""
    summary = json.loads((folder / "ida.json").read_text(encoding="utf-8"))
    runs: dict[tuple[str, str], list[tuple[float, float]]] = {}
    width = 1.0
    for row in _rows(folder / "runs.csv"):
        width = _number(row.get("base_width_m")) or 1.0
        level, moved = _number(row["level"]), _moved(row)
        if level is not None and moved is not None:
            runs.setdefault(_curve(row), []).append((level, abs(moved) / width))
    lines, ends = [], []
    for row in _rows(folder / "capacities.csv"):
        stands, falls = _number(row["stands_until"]), _number(row["collapses_from"])
        below = [
            (0.0, 0.0),
            *sorted(point for point in runs.get(_curve(row), ()) if falls is None or point[0] < falls),
        ]
        lines.append({"name": _curve(row)[0], "x": [point[1] for point in below], "y": [point[0] for point in below]})
        ends.append(None if falls is None else math.sqrt(stands * falls) if stands else 0.5 * falls)
    right = ROOM * (max((max(line["x"]) for line in lines), default=0.0) or 1.0)
    for line, end in zip(lines, ends, strict=True):
        if end is not None:
            line["x"] += [line["x"][-1], right]
            line["y"] += [end, end]
    shares = {}
    for share, column in SHARES.items():
        x, y = [0.0], [0.0]
        for row in _rows(folder / "fractiles.csv"):
            value, level = float(row[column] or "nan"), _number(row["im"])
            if math.isnan(value) or level is None:
                continue
            x.append(min(value / width, right))
            y.append(level)
            if math.isinf(value):
                break
        shares[share] = {"x": _plain(x), "y": _plain(y)}
    for line in lines:
        line["x"], line["y"] = _plain(line["x"]), _plain(line["y"])
    moves = (
        "peak displacement [m]"
        if summary.get("edp") == "peak_displacement_m"
        else "peak top displacement [base widths]"
    )
    return {"records": lines, "shares": shares, "right": right, "moves": moves, "words": _words(summary)}


def write_points(analysis: Ida, state: str, target: Path) -> Path:
    """Write the shares of the records that are known of an analysis so far, in the form of a fragility without a curve."""
    from stylobate.probability.evidence import evidence
    from stylobate.probability.fragility import points_of

    run_evidence = evidence(analysis, state=state)
    points = points_of(run_evidence, run_evidence.codes, "records" if run_evidence.brackets else "runs")
    summary = {"im": run_evidence.measure, "state": run_evidence.state, "points": points.table()}
    with replacing(target) as partial:
        partial.write_text(json.dumps(summary), encoding="utf-8")
    return target


def _fragility(summary: Mapping[str, Any]) -> dict[str, Any]:
    """The curve with its band, the shares of the records with their intervals, and the interval of the median."""
    points = [
        [_number(point[key]) for key in ("im", "share", "low", "high", "records")]
        for point in summary.get("points", ())
    ]
    points = [point for point in points if point[0] is not None]
    interval = [_number(summary.get(key)) for key in ("median_low", "median_high")]
    drawn = {name: _plain(values) for name, values in summary.get("curve", {}).items()}
    return {"curve": drawn, "points": points, "median": interval, "state": summary["state"], "words": _words(summary)}


def _words(summary: Mapping[str, Any]) -> str:
    return "intensity" if summary["im"] == "im" else parse_measure(summary["im"]).words


def _moved(row: Mapping[str, str]) -> float | None:
    """Peak displacement of the top, or of the body of an assembly that goes farthest [m]."""
    return _number(row.get("peak_top_displacement_m", row.get("peak_displacement_m")))


def _curve(row: Mapping[str, str]) -> tuple[str, str]:
    """Motion and realisation of a row; folders of earlier versions hold the record only."""
    return row.get("motion") or row["record"], row["realisation"]


def _rows(path: Path) -> Iterator[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        yield from csv.DictReader(file)


def _number(value: Any) -> float | None:
    """A finite number; None for anything else."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        return None
    return number if math.isfinite(number) else None


def _plain(values: list[float]) -> list[float]:
    return [float(f"{value:.6g}") for value in values]


def new_cells(folder: Path, known: set[int]) -> list[list[Any]]:
    """Cells of a job that are finished and were not known: number, verdict, peak top displacement [m].

    Parameters
    ----------
    folder : Path
        Of the job.
    known : set of int
        Numbers of the cells that the caller has; what is returned is added to it.
    """
    table = folder / RESULT / "domain.csv"
    cells = _in_table(table) if table.is_file() else _in_ledger(folder, known)
    new = [cell for cell in cells if cell[0] not in known]
    known.update(cell[0] for cell in new)
    return new


def _in_table(path: Path) -> Iterator[list[Any]]:
    with suppress(OSError, ValueError, KeyError), path.open(encoding="utf-8", newline="") as file:
        for number, row in enumerate(csv.DictReader(file)):
            yield [number, row["verdict"], _displacement(row["peak_top_displacement_m"])]


def _in_ledger(folder: Path, known: set[int]) -> Iterator[list[Any]]:
    ledger = folder / RESULT / RUNS_FILE
    if ledger.is_file() and (folder / STUDY).is_file():
        cells = {number: cell for cell, number in enumerate(_numbers(folder / STUDY)) if cell not in known}
        for number, row in rows_in(ledger, cells.__contains__):
            yield [cells[number], verdict(row), _displacement(row.get("peak_top_displacement_m"))]


@lru_cache(maxsize=16)
def _numbers(study: Path) -> list[int]:
    """Numbers of the cells of a study in its ledger; the study of a job does not change."""
    return read_grid(study).request().digests.keys.tolist()


def _displacement(value: Any) -> float | None:
    number = _number(value)
    return None if number is None or abs(number) >= 1e6 else round(number, 5)


# The film of a run for the page: what the player draws, and histories in step with it, as one JSON file.

#: Least width over height of a film: upright, for phones.
SHAPE = 0.9

#: States of all bodies together that a film holds at most, frames per second that it has at best, and at least.
MOST, BEST, LEAST = 60_000, 30.0, 4.0


def write_film(response: Response, target: Path) -> Path:
    """Write the film of a response."""
    content = json.dumps(film(response), separators=(",", ":"))
    with replacing(target) as partial:
        partial.write_text(content, encoding="utf-8")
    return target


def film(response: Response) -> dict[str, Any]:
    """The verdict in words, the film, and histories at its states: mm and kJ, null for what is not finite."""
    length = float(response.time[-1] - response.time[0]) or 1.0
    rate = min(BEST, max(LEAST, MOST / (len(response.bodies.shown) * length)))
    scene = film_of(response, OBLIQUE)
    wanted = frame_indices(response.time, min(rate, 4900.0 / length), 1.0)
    # A film is coarser than what is recorded: the largest displacement and openings are states of it, too.
    h = response.histories
    sizes = [h.opening] if h.top is None else [h.opening, np.hypot(*h.top.T) if h.top.ndim == 2 else np.abs(h.top)]
    largest = [np.nan_to_num(values).argmax(axis=0) for values in sizes if values.size]
    indices = np.unique(np.concatenate([wanted, *map(np.ravel, largest), [len(response.time) - 1]]))
    return {
        "sentence": in_page_words(response.sentence),
        "film": film_data(scene, indices, least=SHAPE),
        "histories": _histories(response, indices),
    }


def _histories(response: Response, indices: np.ndarray) -> dict[str, Any]:
    h = response.histories
    slip = np.linalg.norm(h.slip, axis=-1)
    histories: dict[str, Any] = {
        "opening": _plain_history(1e3 * h.opening[indices].T),
        "slip": _plain_history(1e3 * slip[indices].T),
        "energy": {term: _plain_history(1e-3 * h.energy[term][indices]) for term in ENERGY_TERMS if term in h.energy},
    }
    if h.top is not None:
        top = h.top[:, None] if h.top.ndim == 1 else h.top
        histories["top"] = {axis: _plain_history(1e3 * top[indices, k]) for k, axis in zip(range(top.shape[1]), "xy")}
    if response.dims == "xyz":
        histories["twist"] = _plain_history(h.twist[indices].T)
    return histories


def _plain_history(values: np.ndarray) -> list[Any]:
    rounded = np.where(np.isfinite(values), np.round(values, 4), np.nan)
    if rounded.ndim == 2:
        return [_plain_history(row) for row in rounded]
    return [None if value != value else value for value in rounded.tolist()]
