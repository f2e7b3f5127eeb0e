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
        logs = np.log(np.array([one for one in each if one.min() > 0.0]).reshape(-1, len(periods)))
        shapes.append(logs - logs.mean(axis=1, keepdims=True))
    order = sorted(range(len(motions)), key=lambda k: -len(motions[k].components))
    owner = np.array([k for k in order for _ in shapes[k]], dtype=int)
    every = np.concatenate([np.empty((0, len(periods))), *(shapes[k] for k in order)])
    again: dict[int, int] = {}
    before = 0
    for k in order:
        near = np.zeros(before, dtype=bool)
        for shape in shapes[k]:
            near |= np.abs(every[:before] - shape).max(axis=1, initial=0.0) < ALIKE
        others = [other for other in owner[:before][near].tolist() if other not in again]
        if others:
            again[k] = others[0]
        before += len(shapes[k])
    return again
