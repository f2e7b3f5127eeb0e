"""The search for a set of records: which of them together follow a target, and the factor that lifts their mean onto it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..errors import InputError

#: Weight of the records' own misfits beside that of their mean, where sets are compared.
OWN_MISFIT = 0.2


def best_set(
    logs: np.ndarray, ratios: np.ndarray, count: int, events: Sequence[int], per_event: int | None
) -> list[int]:
    """Indices of the set of least misfit that exchanges of single records lead to."""
    own = np.sqrt((logs**2).mean(axis=1))

    def allowed(chosen: list[int], k: int) -> bool:
        return k not in chosen and (per_event is None or sum(events[one] == events[k] for one in chosen) < per_event)

    def misfit(chosen: list[int]) -> float:
        mean = ratios[chosen].mean(axis=0)
        level = np.exp(np.log(mean).mean())  # one factor brings the whole set up or down
        return float(np.sqrt(((mean / level - 1.0) ** 2).mean()) + OWN_MISFIT * own[chosen].mean())

    chosen: list[int] = []
    for _ in range(count):
        open_ = [k for k in range(len(own)) if allowed(chosen, k)]
        if not open_:
            raise InputError(
                f"{len(chosen)} records can be chosen with at most {per_event} of one event, and {count} are asked for; "
                "allow more of one event, or ask for fewer.",
                "per_event",
            )
        chosen.append(min(open_, key=lambda k: misfit([*chosen, k])))
    while True:
        tried = [
            (misfit([*rest, k]), place, k)
            for place in range(count)
            for rest in [chosen[:place] + chosen[place + 1 :]]
            for k in range(len(own))
            if allowed(rest, k) and k != chosen[place]
        ]
        better = min(tried, default=(np.inf, 0, 0))
        if not better[0] < misfit(chosen) - 1e-12:
            return sorted(chosen)
        chosen[better[1]] = better[2]


def lifted(
    own: np.ndarray,
    spectra: np.ndarray,
    peaks: np.ndarray,
    aim: np.ndarray,
    zero: float | None,
    least: float,
    largest: float,
) -> np.ndarray:
    """Factors of the records when all are multiplied by one that lifts their mean onto its bounds, as the limit allows."""
    size = own
    for _ in range(50):
        short = (least * aim / (size[:, None] * spectra).mean(axis=0)).max()
        if zero is not None:
            short = max(short, zero / (size * peaks).mean())
        if short <= 1.0 or (size >= largest).all():
            return size
        size = np.minimum(size * short, largest)
    return size
