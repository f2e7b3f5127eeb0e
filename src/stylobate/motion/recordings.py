"""Which records are one recording in several files or formats: by the shape of the spectra of their components."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .motion import Motion
from .spectra import pseudo_acceleration

#: Periods at which, and largest distance of the logarithms by which, shapes of spectra of one recording agree.
ALIKE_POINTS, ALIKE = 24, 0.02


def recorded_again(motions: Sequence[Motion]) -> dict[int, int]:
    """Numbers of the records that are another one once more, in another file or format, with the number of that one.

    Two files are of one recording where the spectra of a horizontal component of each have one shape: at stations a street
    apart they differ by several per cent. Of two files that with more components is the record.
    """
    periods = np.geomspace(0.1, 3.0, ALIKE_POINTS)
    shapes: list[np.ndarray] = []
    for motion in motions:
        each = [pseudo_acceleration(motion, periods, component=axis) for axis in "xy" if axis in motion.components]
        logs = np.log(np.maximum([one for one in each if one.min() > 0.0] or np.ones((0, len(periods))), 1e-300))
        shapes.append(logs - logs.mean(axis=1, keepdims=True))
    again: dict[int, int] = {}
    order = sorted(range(len(motions)), key=lambda k: -len(motions[k].components))
    for place, k in enumerate(order):
        for other in order[:place]:
            apart = np.abs(shapes[k][:, None] - shapes[other][None]).max(axis=2, initial=0.0)
            if apart.size and apart.min() < ALIKE and other not in again:
                again[k] = other
                break
    return again
