"""Starts other than rest: a column tilted about its rim or edge, and turning; a body tossed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ..errors import InputError, as_typed, check_range


@dataclass(frozen=True)
class Start:
    """The column as one rigid body, tilted about its rim.

    Parameters
    ----------
    tilt : float
        Lean of the column [rad].
    azimuth : float
        Direction in which it leans, from x towards y [rad]; the lowest point of the rim is at its place on the ground.
    angular_velocity : (float, float, float)
        In space axes [rad/s]; the lowest point of the rim is at rest.

    Raises
    ------
    InputError
        A value outside its range.
    """

    tilt: float
    azimuth: float = 0.0
    angular_velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        level = 0.5 * math.pi
        tilt = check_range("tilt of a start", self.tilt, 0.0, level, unit="rad", open_high=True)
        object.__setattr__(self, "tilt", tilt)
        turn = 2.0 * math.pi
        object.__setattr__(self, "azimuth", check_range("azimuth of a start", self.azimuth, -turn, turn, unit="rad"))
        spin = tuple(self.angular_velocity)
        if len(spin) != 3:
            raise InputError(
                f"angular_velocity of a start is {as_typed(spin)}; give three components, about x, y and z [rad/s]."
            )
        spin = tuple(
            check_range("angular_velocity of a start", component, -1e4, 1e4, unit="rad/s") for component in spin
        )
        object.__setattr__(self, "angular_velocity", spin)


def check_takes_pose(start: Any, column: Any) -> None:
    """Refuse a start that is not one for this column."""
    if not isinstance(start, Start):
        raise InputError(f"a toss is for a specimen, and {column.name!r} is a column; give a Start.")
    if column.as_found:
        raise InputError(
            f"a start from a pose takes a column as built, and {column.name!r} is as found; leave one out."
        )
    column.must_link_by((), "a start from a pose")


def check_in_plane(start: Start, who: str) -> None:
    """Refuse a start that the plane of x and z does not hold.

    Parameters
    ----------
    start : Start
    who : str
        What keeps to the plane, as the beginning of the sentence.

    Raises
    ------
    InputError
    """
    wx, _, wz = start.angular_velocity
    if abs(start.tilt * math.sin(start.azimuth)) > 1e-12 or wx != 0.0 or wz != 0.0:
        raise InputError(
            f"{who} keeps to the plane of x and z, and the start leaves it (azimuth {start.azimuth:g} rad, angular_velocity "
            f"{start.angular_velocity}); give azimuth 0 or pi and a velocity about y only, or use dem3d."
        )


@dataclass(frozen=True)
class Toss:
    """A specimen that is let go somewhere over the base, or on it, with a velocity.

    Parameters
    ----------
    position : (float, float, float)
        Of the centroid [m].
    orientation : (float, float, float, float)
        Quaternion that turns the axes of the specimen's vertices into those of space, real part first; brought to length 1.
    velocity : (float, float, float)
        Of the centroid [m/s].
    angular_velocity : (float, float, float)
        In space axes [rad/s].

    Raises
    ------
    InputError
        A value outside its range, or a vector of another length.
    """

    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    angular_velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        for name, length, limit, unit in (
            ("position", 3, 1e4, "m"),
            ("orientation", 4, 1e6, ""),
            ("velocity", 3, 1e4, "m/s"),
            ("angular_velocity", 3, 1e4, "rad/s"),
        ):
            given = tuple(getattr(self, name))
            if len(given) != length:
                raise InputError(f"{name} of a toss has {len(given)} components; give {length}.")
            checked = tuple(
                check_range(f"{name} of a toss", component, -limit, limit, unit=unit) for component in given
            )
            object.__setattr__(self, name, checked)
        size = math.hypot(*self.orientation)
        if size < 1e-9:
            raise InputError("orientation of a toss is a quaternion of zeros; give one of length 1, real part first.")
        object.__setattr__(self, "orientation", tuple(component / size for component in self.orientation))
