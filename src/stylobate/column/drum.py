"""One drum: a frustum of stone with closed-form mass properties."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..errors import InputError, check_range

SECTIONS = ("circular", "rectangular")

#: Places (−1 … 1) and weights of Gauss's rule with three points.
GAUSS_POINTS = ((-math.sqrt(0.6), 5.0 / 9.0), (0.0, 8.0 / 9.0), (math.sqrt(0.6), 5.0 / 9.0))

#: Lengths [m] and densities [kg/m³] that a body can have: from a model's chip to a hill, from foam to the heaviest metal.
LENGTHS, DENSITIES = (1e-4, 1e3), (1.0, 1e5)


@dataclass(frozen=True)
class Drum:
    """A drum: truncated cone (``circular``) or trapezium of constant depth (``rectangular``).

    Parameters
    ----------
    height : float
        Height h [m].
    bottom_width, top_width : float
        Widths b and t of the lower and upper face in the plane of motion [m]; diameters for a circular section.
    density : float
        Mass density [kg/m³].
    section : {"circular", "rectangular"}
    depth : float
        Depth w perpendicular to the plane [m]; used for rectangular sections only.

    Raises
    ------
    InputError
        A value is not finite or outside its range.
    """

    height: float
    bottom_width: float
    top_width: float
    density: float
    section: str = "rectangular"
    depth: float = 1.0

    def __post_init__(self) -> None:
        if self.section not in SECTIONS:
            raise InputError(f"section is {self.section!r}; allowed are {', '.join(SECTIONS)}.")
        for name, unit, (low, high) in (
            ("height", "m", LENGTHS),
            ("bottom_width", "m", LENGTHS),
            ("top_width", "m", LENGTHS),
            ("density", "kg/m³", DENSITIES),
            ("depth", "m", LENGTHS),
        ):
            value = check_range(f"{name} of a drum", getattr(self, name), low, high, unit=unit, remedy="use SI units")
            object.__setattr__(self, name, value)

    @property
    def circular(self) -> bool:
        """Whether the section is a circle."""
        return self.section == "circular"

    @property
    def mean_width(self) -> float:
        """Mean of the two widths [m]: the paper's prism."""
        return 0.5 * (self.bottom_width + self.top_width)

    @property
    def volume(self) -> float:
        """Volume [m³]."""
        b, t, h = self.bottom_width, self.top_width, self.height
        if self.circular:
            return math.pi * h * (b * b + b * t + t * t) / 12.0
        return self.depth * h * (b + t) / 2.0

    @property
    def mass(self) -> float:
        """Mass m [kg]."""
        return self.density * self.volume

    @property
    def centroid_height(self) -> float:
        """Height of the centroid above the lower face [m]."""
        b, t, h = self.bottom_width, self.top_width, self.height
        if self.circular:
            return h * (b * b + 2.0 * b * t + 3.0 * t * t) / (4.0 * (b * b + b * t + t * t))
        return h * (b + 2.0 * t) / (3.0 * (b + t))

    @property
    def inertia(self) -> float:
        """Moment of inertia about the horizontal axis through the centroid, perpendicular to the plane [kg m²].

        Notes
        -----
        Integral over the height of (own second moment of the slice + slice area × distance²); the integrand is a
        polynomial of degree 4 at most, so three Gauss points are exact.
        """
        b, t, h, zc = self.bottom_width, self.top_width, self.height, self.centroid_height
        total = 0.0
        for x, weight in GAUSS_POINTS:
            z = 0.5 * h * (1.0 + x)
            q = b + (t - b) * z / h
            area, second = section_area(self.section, q, self.depth), section_second_moment(self.section, q, self.depth)
            total += 0.5 * h * weight * (second + area * (z - zc) ** 2)
        return self.density * total

    @property
    def cross_inertia(self) -> float:
        """Moment of inertia about the horizontal axis through the centroid, in the plane of motion [kg m²].

        As :attr:`inertia`, with the second moments of the slices about the other axis.
        """
        if self.circular:
            return self.inertia
        b, t, h, zc = self.bottom_width, self.top_width, self.height, self.centroid_height
        total = 0.0
        for x, weight in GAUSS_POINTS:
            z = 0.5 * h * (1.0 + x)
            q = b + (t - b) * z / h
            area, second = section_area(self.section, q, self.depth), section_second_moment(self.section, self.depth, q)
            total += 0.5 * h * weight * (second + area * (z - zc) ** 2)
        return self.density * total

    @property
    def axial_inertia(self) -> float:
        """Moment of inertia about the drum's own axis [kg m²]; exact by three Gauss points over the height."""
        b, t, h = self.bottom_width, self.top_width, self.height
        total = 0.0
        for x, weight in GAUSS_POINTS:
            q = b + (t - b) * 0.5 * (1.0 + x)
            own = section_second_moment(self.section, q, self.depth)
            other = own if self.circular else q * self.depth**3 / 12.0
            total += 0.5 * h * weight * (own + other)
        return self.density * total

    def as_prism(self) -> Drum:
        """The paper's idealisation: a drum of constant, mean width."""
        d = self.mean_width
        return Drum(self.height, d, d, self.density, self.section, self.depth)


def section_area(section: str, width: float, depth: float) -> float:
    """Area of a face of given width (diameter) and depth [m²]."""
    return math.pi * width**2 / 4.0 if section == "circular" else width * depth


def section_second_moment(section: str, width: float, depth: float) -> float:
    """Second moment of area of a face about its horizontal axis perpendicular to the plane [m⁴]."""
    return math.pi * width**4 / 64.0 if section == "circular" else depth * width**3 / 12.0
