"""Seismic sources: how often earthquakes of which magnitude break where, and how far from a place."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stylobate.errors import InputError, check_choice, check_range

from .ground_motion import MECHANISMS

#: Widest class of magnitudes, and farthest that two ruptures of one magnitude lie apart along a fault [km].
CLASS, ALONG = 0.1, 5.0

#: Rings and rays of epicentres in a disc; strikes of ruptures whose strike nobody knows.
RINGS, RAYS, STRIKES = 8, 16, 8

#: Radius of the Earth [km].
EARTH = 6371.0


@dataclass(frozen=True)
class Source:
    """A fault, a point or a disc of epicentres, whose ruptures are straight and upright.

    Parameters
    ----------
    name : str
    ends : tuple of (float, float)
        Longitude and latitude of a point or centre, or of both ends of a fault [degrees].
    magnitudes : (float, float)
        Smallest and largest moment magnitude; equal for earthquakes of one size.
    rate : float
        Of earthquakes of the smallest magnitude or more [1/y].
    b : float
        Slope of Gutenberg and Richter: from magnitude to magnitude there are 10^b times fewer.
    mechanism : str
        ``normal``, ``reverse`` or ``strike-slip``.
    radius : float
        Of the disc in which epicentres are spread evenly [km].
    strike : float, optional
        Of ruptures about a point, from north [degrees]; all are as likely where nobody knows it.
    """

    name: str
    ends: tuple[tuple[float, float], ...]
    magnitudes: tuple[float, float]
    rate: float
    b: float = 1.0
    mechanism: str = "strike-slip"
    radius: float = 0.0
    strike: float | None = None

    def __post_init__(self) -> None:
        of = f"source {self.name!r}"
        check_range("magnitude", self.magnitudes[0], 3.0, 9.5, of=of)
        check_range("largest magnitude", self.magnitudes[1], self.magnitudes[0], 9.5, of=of)
        check_range("rate", self.rate, 0.0, 100.0, unit="a year", of=of, open_low=True)
        check_range("b", self.b, 0.1, 3.0, of=of)
        check_range("radius", self.radius, 0.0, 300.0, unit="km", of=of)
        check_choice("mechanism", self.mechanism, MECHANISMS, of=of)
        for lon, lat in self.ends:
            check_range("longitude", lon, -180.0, 180.0, unit="degrees", of=of)
            check_range("latitude", lat, -85.0, 85.0, unit="degrees", of=of)
        if len(self.ends) == 2 and (self.radius or self.strike is not None):
            raise InputError(f"{of} has two ends, and a radius or a strike; a fault needs neither, leave them out.")

    def sizes(self) -> tuple[np.ndarray, np.ndarray]:
        """Magnitudes in the middle of classes, and how often a year each comes, shape (m,)."""
        least, most = self.magnitudes
        if most == least:
            return np.array([least]), np.array([self.rate])
        edges = np.linspace(least, most, math.ceil((most - least) / CLASS - 1e-9) + 1)
        above = 10.0 ** (-self.b * (edges - least))  # truncated at both ends
        return 0.5 * (edges[1:] + edges[:-1]), self.rate * -np.diff(above) / (1.0 - above[-1])


@dataclass(frozen=True, eq=False)
class Events:
    """Ruptures of one source: straight, seen from above.

    Parameters
    ----------
    magnitude, rate : array
        Moment magnitude, and how often a year each comes, shape (e,).
    ends : array
        Of each rupture, shape (e, 2, 2), in the plane of :func:`plane` [km].
    """

    magnitude: np.ndarray
    rate: np.ndarray
    ends: np.ndarray

    def distance(self, place: np.ndarray) -> np.ndarray:
        """Shortest distance from a place on the ground [km], shape (e,): that of Joyner and Boore for upright ruptures."""
        first, along = self.ends[:, 0], self.ends[:, 1] - self.ends[:, 0]
        length = np.maximum((along**2).sum(axis=1), 1e-12)
        share = np.clip(((place - first) * along).sum(axis=1) / length, 0.0, 1.0)
        return np.linalg.norm(first + share[:, None] * along - place, axis=1)


def plane(places: Sequence[tuple[float, float]], middle: tuple[float, float]) -> np.ndarray:
    """East and north of a middle [km] of longitudes and latitudes [degrees], shape (n, 2); right within some 300 km."""
    found = np.radians(np.asarray(places, dtype=float) - np.asarray(middle))
    return EARTH * found * [math.cos(math.radians(middle[1])), 1.0]


def rupture_length(magnitude: float) -> float:
    """Length of a rupture below the ground [km] (Wells and Coppersmith 1994, all mechanisms)."""
    return 10.0 ** (0.59 * magnitude - 2.44)


def events_of(source: Source, middle: tuple[float, float]) -> Events:
    """Ruptures of a source: evenly along a fault, never beyond its ends; about a point or in a disc by their strike."""
    ends = plane(source.ends, middle)
    found = []
    for magnitude, rate in zip(*source.sizes(), strict=True):
        length = rupture_length(float(magnitude))
        if len(ends) == 2:
            whole = float(np.linalg.norm(ends[1] - ends[0]))
            run = max(whole - length, 0.0)
            number = math.ceil(run / ALONG) + 1
            begin = np.linspace(0.0, run, number)[:, None] / whole
            end = begin + min(length, whole) / whole
            pieces = np.stack([ends[0] + one * (ends[1] - ends[0]) for one in (begin, end)], axis=1)
        else:
            strikes = np.arange(STRIKES) * 180.0 / STRIKES if source.strike is None else np.array([source.strike])
            turned = np.radians(strikes)
            half = 0.5 * length * np.stack((np.sin(turned), np.cos(turned)), axis=1)
            middles = _disc(ends[0], source.radius)[:, None]
            pieces = np.stack((middles - half, middles + half), axis=2).reshape(-1, 2, 2)
        found.append((np.full(len(pieces), magnitude), np.full(len(pieces), rate / len(pieces)), pieces))
    return Events(*(np.concatenate(parts) for parts in zip(*found, strict=True)))


def _disc(centre: np.ndarray, radius: float) -> np.ndarray:
    """Epicentres, each for the same area."""
    if radius == 0.0:
        return centre[None]
    far = radius * np.sqrt((np.arange(RINGS) + 0.5) / RINGS)
    turned = 2.0 * np.pi * (np.arange(RAYS) + 0.5 * (np.arange(RINGS)[:, None] % 2)) / RAYS
    return centre + np.stack((far[:, None] * np.cos(turned), far[:, None] * np.sin(turned)), axis=2).reshape(-1, 2)
