"""Which records are one recording in several files: by the shapes of their spectra, and by their course in time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from .motion import Motion
from .spectra import pseudo_acceleration

#: Periods at which shapes of spectra are compared [s], and their bounds for the bands of those of both components together.
PERIODS, BANDS = np.geomspace(0.1, 3.0, 24), np.geomspace(1.0 / 3.0, 10.0, 25)

#: Kinds of shapes: of the spectrum of a component, and of both components together.
KINDS = ALONE, TOGETHER = range(2)

#: Distance of logarithms within which shapes agree at a period, and share of the periods at which those of one recording do:
#: other filters, base lines and sampling change its ends. At two stations it is a fifth.
ALIKE, SHARE = 0.02, 0.6

#: Least correlation of the accelerations of one recording, at the best time lag.
CORRELATED = 0.8

#: Resolution of spectra of both components [Hz].
RESOLUTION = 0.005


def recorded_again(motions: Sequence[Motion]) -> dict[int, int]:
    """Numbers of the records that are another one once more, in another file, with the number of that one.

    Scaled, turned in plan, cut, sampled or filtered otherwise, or in another format. Spectra of a horizontal component of
    each, or of both together, which do not hang on the axes, have one shape then, and the accelerations one course: at
    stations a street apart they differ. Of two files that with more components is the record.
    """
    order = sorted(range(len(motions)), key=lambda k: -len(motions[k].peaks))
    rank = {k: place for place, k in enumerate(order)}
    own = {k: list(_shapes(motions[k])) for k in order}
    seen = {kind: _SpectrumShapes(sum(one == kind for some in own.values() for one, _ in some)) for kind in KINDS}
    again: dict[int, int] = {}
    for k in order:
        near = {other for kind, shape in own[k] for other in seen[kind].near(shape)}
        owner = next((one for one in sorted(near, key=rank.__getitem__) if _correlated(motions[one], motions[k])), None)
        if owner is not None:
            again[k] = owner
            continue
        for kind, shape in own[k]:
            seen[kind].add(k, shape)
    return again


class _SpectrumShapes:
    """Shapes of one kind of the records that were looked at, with room for so many."""

    def __init__(self, room: int) -> None:
        self.shapes, self.owner, self.count = np.empty((room, len(PERIODS))), np.zeros(room, int), 0

    def add(self, number: int, shape: np.ndarray) -> None:
        """Keep the shape of a record."""
        self.shapes[self.count], self.owner[self.count] = shape, number
        self.count += 1

    def near(self, shape: np.ndarray) -> list[int]:
        """Numbers of records with a shape like this one, whatever its size."""
        apart = self.shapes[: self.count] - shape
        apart -= np.median(apart, axis=1, keepdims=True)
        return self.owner[: self.count][(np.abs(apart) < ALIKE).mean(axis=1) >= SHARE].tolist()


def _shapes(motion: Motion) -> Iterator[tuple[int, np.ndarray]]:
    """Kinds and logarithms of spectra of a motion, each of as many numbers."""
    axes = [axis for axis in "xy" if axis in motion.peaks]
    for axis in axes:
        spectrum = pseudo_acceleration(motion, PERIODS, component=axis)
        if spectrum.min() > 0.0:
            yield ALONE, np.log(spectrum)
    if len(axes) < 2:
        return
    count = 1 << int(np.ceil(np.log2(max(1.0 / (RESOLUTION * motion.dt), motion.steps + 1))))
    power = np.sum([np.abs(np.fft.rfft(one, count)) ** 2 for one in _horizontal(motion)], axis=0)
    edges = np.searchsorted(np.fft.rfftfreq(count, motion.dt), BANDS)
    bands = np.diff(np.concatenate([[0.0], np.cumsum(power)])[edges])
    if bands.min(initial=np.inf) > 0.0:
        yield TOGETHER, 0.5 * np.log(bands)


def _correlated(one: Motion, other: Motion) -> bool:
    """Whether the accelerations of two motions have one course, at some lag: of a component of each, or of both in plan.

    Components in plan are a complex number, so that a turn is a factor of length 1.
    """
    mine, theirs = _horizontal(one), _horizontal(other)
    pairs = [(a, b) for a in mine for b in theirs]
    if len(mine) == len(theirs) == 2:
        pairs += [(mine[0] + 1j * mine[1], theirs[0] + sign * 1j * theirs[1]) for sign in (1.0, -1.0)]
    return any(_correlation(a, one.dt, b, other.dt) >= CORRELATED for a, b in pairs)


def _correlation(a: np.ndarray, dt_a: float, b: np.ndarray, dt_b: float) -> float:
    """Largest correlation of two signals with steps [s] over all lags [-]."""
    dt = min(dt_a, dt_b)
    a, b = (
        np.interp(np.arange(0.0, len(x) * own, dt), own * np.arange(len(x)), x) for x, own in ((a, dt_a), (b, dt_b))
    )
    size = float(np.linalg.norm(a) * np.linalg.norm(b))
    count = 1 << int(np.ceil(np.log2(len(a) + len(b))))
    most = np.abs(np.fft.ifft(np.fft.fft(a, count) * np.conj(np.fft.fft(b, count)))).max()
    return float(most) / size if size > 0.0 else 0.0


def _horizontal(motion: Motion) -> list[np.ndarray]:
    """Samples along the horizontal axes; those of one motion have one factor."""
    return [one for one in (motion.samples, motion.y_samples) if one is not None]
