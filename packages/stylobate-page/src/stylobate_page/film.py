"""The film of a run for the page: what the player draws, and histories in step with it, as one JSON file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.atomic import replacing
from stylobate.plots.film import film_data, film_of, frame_indices
from stylobate.plots.scene import OBLIQUE
from stylobate.response import Response
from stylobate.response.histories import ENERGY_TERMS

from .forms import in_page_words

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
        "opening": _plain(1e3 * h.opening[indices].T),
        "slip": _plain(1e3 * slip[indices].T),
        "energy": {term: _plain(1e-3 * h.energy[term][indices]) for term in ENERGY_TERMS if term in h.energy},
    }
    if h.top is not None:
        top = h.top[:, None] if h.top.ndim == 1 else h.top
        histories["top"] = {axis: _plain(1e3 * top[indices, k]) for k, axis in zip(range(top.shape[1]), "xy")}
    if response.dims == "xyz":
        histories["twist"] = _plain(h.twist[indices].T)
    return histories


def _plain(values: np.ndarray) -> list[Any]:
    rounded = np.where(np.isfinite(values), np.round(values, 4), np.nan)
    if rounded.ndim == 2:
        return [_plain(row) for row in rounded]
    return [None if one != one else one for one in rounded.tolist()]
