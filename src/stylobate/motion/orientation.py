"""Turning the two horizontal components: to an azimuth, to the strongest direction, to the principal axes.

Azimuths count clockwise from north; x, y and the upward z are right-handed after turning: y points 90° to the left
of x. To turn x clockwise is to turn the motion from x towards y.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from ..constants import g
from ..errors import InputError, check_range
from ..messages import say
from .motion import Motion, square_integral

#: The axes besides x, in words.
OTHER_AXES = {"y": "second horizontal component", "z": "vertical component"}


def rotated(motion: Motion, azimuth: float) -> Motion:
    """Turn the horizontal components so that x points to ``azimuth`` and y to 90° less.

    A motion that states no azimuths counts as having x at 0° and y at −90°: it is turned as a whole by the angle ``azimuth``
    from x towards y.

    Parameters
    ----------
    motion : Motion
        With two horizontal components whose azimuths are not parallel.
    azimuth : float
        Clockwise from north [degrees].

    Raises
    ------
    InputError
        One horizontal component, two that are nearly parallel, or two of which only one states its azimuth.
    """
    wanted = check_range("azimuth", azimuth, -360.0, 360.0, unit="degrees")
    x, y = _samples(motion)
    known = _azimuths(motion)
    if known == (None, None):
        # As if x pointed north: turning the axes clockwise turns the motion from x towards y.
        c, s = _direction(wanted)
        text = say(
            "turned as a whole by {wanted:g}° from x towards y (no azimuths are stated: counted from its own x)",
            wanted=wanted,
        )
        return _with(motion, c * x - s * y, s * x + c * y, (wanted, wanted - 90.0), text)
    if known[0] is None or known[1] is None:
        axis, angle, other = ("x", known[0], "y") if known[1] is None else ("y", known[1], "x")
        raise InputError(
            f"{axis} of {motion.name!r} points to {angle:g}°, and where {other} points is not stated, as turning to an "
            f"azimuth needs; state it: write the motion as CSV, and add the line '# azimuth_{other}_deg: …' to it.",
            "azimuth",
        )
    wanted %= 360.0
    (ca, sa), (cb, sb) = (_direction(bearing) for bearing in (known[0], known[1]))
    determinant = math.sin(math.radians(known[0] - known[1]))
    if abs(determinant) < 0.1:
        raise InputError(
            f"the horizontal components of {motion.name!r} point to {known[0]:g}° and {known[1]:g}°, nearly parallel; "
            "check the azimuths.",
            "azimuth",
        )
    # a(θ) = e sin θ + n cos θ for both components, solved for east and north
    east = (x * cb - y * ca) / determinant
    north = (y * sa - x * sb) / determinant
    c, s = _direction(wanted)
    first = east * s + north * c
    second = -east * c + north * s
    return _with(
        motion,
        first,
        second,
        (wanted, wanted - 90.0),
        say("turned to azimuth {wanted:g}° (y to {wanted_:g}°)", wanted=wanted, wanted_=(wanted - 90.0) % 360.0),
    )


def turned(motion: Motion, angle: float) -> Motion:
    """Turn the horizontal components by an angle from x towards y, for files that state no azimuth.

    Parameters
    ----------
    motion : Motion
        With two horizontal components, taken as perpendicular.
    angle : float
        [degrees]
    """
    c, s = _direction(check_range("angle", angle, -360.0, 360.0, unit="degrees"))
    x, y = _samples(motion)
    known = _azimuths(motion)
    text = say("turned by {angle:g}° from x towards y", angle=angle)
    if known[0] is None or known[1] is None:
        return _with(motion, c * x + s * y, c * y - s * x, None, text)
    clockwise = math.cos(math.radians(known[1] - known[0] - 90.0)) > 0.0
    to = known[0] + (angle if clockwise else -angle)
    return _with(motion, c * x + s * y, c * y - s * x, (to, to + known[1] - known[0]), text)


def along(motion: Motion, azimuth: float) -> Motion:
    """The component along an azimuth as the only horizontal one, for a plane model; the rest is left out and said."""
    rotated_motion = rotated(motion, azimuth)
    azimuths = {key: value for key, value in rotated_motion.metadata["azimuths"].items() if key != "y"}
    return rotated_motion.replace(
        lateral=None,
        metadata={**rotated_motion.metadata, "azimuths": azimuths},
        processing=(*rotated_motion.processing, say("the component across it left out")),
    )


def record_of(motion: Motion) -> str:
    """The record that a motion is of: the same for all directions, signs, components and scaled copies of one."""
    return motion.record


def beyond_axes(motion: Motion, axes: str) -> dict[str, str]:
    """The components along other axes than those of ``axes`` and x, by axis, each in words with its peak."""
    azimuths = motion.metadata.get("azimuths") or {}
    components: dict[str, str] = {}
    for axis, word in OTHER_AXES.items():
        peak = motion.peaks.get(axis)
        if peak is not None and axis not in axes:
            where = "" if azimuths.get(axis) is None else say("azimuth {azimuths:g}°, ", azimuths=azimuths[axis])
            more = say(", more than along x") if axis == "y" and peak > motion.pga else ""
            components[axis] = say(
                "{what} ({where}peak {peak:.3g} g{more})", what=say(word), where=where, peak=peak / g, more=more
            )
    return components


def keep_axes(motion: Motion, axes: str) -> Motion:
    """The components along some of the axes; what is left out is said.

    Parameters
    ----------
    motion : Motion
    axes : str
        Axes that are kept, such as ``xz``; x is always kept.

    Returns
    -------
    Motion
        ``metadata["left_out"]`` and ``processing`` name each component that was left out, with its peak.
    """
    gone = beyond_axes(motion, axes)
    if not gone:
        return motion
    return motion.replace(
        ay=None if "y" in gone else motion.y_samples,
        az=None if "z" in gone else motion.z_samples,
        metadata={**motion.metadata, "left_out": (*motion.metadata.get("left_out", ()), *gone.values())},
        processing=(*motion.processing, *(say("left out: {what}", what=component) for component in gone.values())),
    )


def principal(motion: Motion) -> Motion:
    """Turn to the principal axes: x has the largest Arias intensity, y the smallest, and they are uncorrelated.

    References
    ----------
    Penzien and Watabe (1975).
    """
    x, y = _samples(motion)
    dt = motion.dt
    xx, yy = square_integral(x, dt)[-1], square_integral(y, dt)[-1]
    xy = 0.5 * (square_integral(x + y, dt)[-1] - xx - yy)
    return turned(motion, math.degrees(0.5 * math.atan2(2.0 * xy, xx - yy)))


def strongest(motion: Motion) -> Motion:
    """Turn so that x has the largest peak acceleration of all directions, the PGA of RotD100."""
    x, y = _samples(motion)
    at = int(np.argmax(x * x + y * y))
    return turned(motion, math.degrees(math.atan2(y[at], x[at])))


def _samples(motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    if motion.y_samples is None:
        raise InputError(f"motion {motion.name!r} has one horizontal component; turning needs two of them.", "azimuth")
    return motion.samples, motion.y_samples


def _direction(angle: float) -> tuple[float, float]:
    """Cosine and sine of an angle [degrees]: whole quarters leave nothing of a component across."""
    quarters, rest = divmod(angle, 90.0)
    if rest:
        return math.cos(math.radians(angle)), math.sin(math.radians(angle))
    return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarters) % 4]


def _azimuths(motion: Motion) -> tuple[float | None, float | None]:
    """Where x and y point [degrees], None where it is not stated."""
    azimuths = motion.metadata.get("azimuths")
    x, y = (azimuths.get("x"), azimuths.get("y")) if isinstance(azimuths, Mapping) else (None, None)
    return None if x is None else float(x), None if y is None else float(y)


def _with(motion: Motion, x: np.ndarray, y: np.ndarray, azimuths: tuple[float, float] | None, text: str) -> Motion:
    stated: dict[str, float | None] = {"x": None, "y": None}
    if azimuths is not None:
        stated = {"x": azimuths[0] % 360.0, "y": azimuths[1] % 360.0}
    return motion.replace(
        acceleration=x,
        lateral=y,
        metadata={
            **motion.metadata,
            "azimuths": {**(motion.metadata.get("azimuths") or {}), **stated},
            # what the file calls its directions is no longer true of x and y
            "labels": {axis: label for axis, label in (motion.metadata.get("labels") or {}).items() if axis == "z"},
        },
        processing=(*motion.processing, text),
    )
