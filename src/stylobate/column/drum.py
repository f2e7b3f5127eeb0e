"""One drum: a frustum of stone with closed-form mass properties."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..errors import InputError, check_choice, check_range

SECTIONS = ("circular", "rectangular")

#: Places (−1 … 1) and weights of Gauss's rule with three points.
GAUSS_POINTS = ((-math.sqrt(0.6), 5.0 / 9.0), (0.0, 8.0 / 9.0), (math.sqrt(0.6), 5.0 / 9.0))

#: Lengths [m] and densities [kg/m³] that a body can have: from a model's chip to a hill, from foam to the heaviest metal.
LENGTHS, DENSITIES = (1e-4, 1e3), (1.0, 1e5)


@dataclass(frozen=True)
class Drum:
    """A drum: truncated cone (``circular``) or frustum with rectangular faces (``rectangular``).

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
        Depth w perpendicular to the plane [m], of the lower face; used for rectangular sections only.
    top_depth : float, optional
        Depth of the upper face [m]; that of the lower face if left out. Rectangular sections only.

    Raises
    ------
    InputError
        A value is not finite or outside its range, or a round drum has a ``top_depth``.
    """

    height: float
    bottom_width: float
    top_width: float
    density: float
    section: str = "rectangular"
    depth: float = 1.0
    top_depth: float | None = None

    def __post_init__(self) -> None:
        check_choice("section", self.section, SECTIONS)
        for name, unit, (low, high) in (
            ("height", "m", LENGTHS),
            ("bottom_width", "m", LENGTHS),
            ("top_width", "m", LENGTHS),
            ("density", "kg/m³", DENSITIES),
            ("depth", "m", LENGTHS),
        ):
            value = check_range(name, getattr(self, name), low, high, unit=unit, remedy="use SI units", of="a drum")
            object.__setattr__(self, name, value)
        if self.top_depth is not None:
            if self.circular:
                raise InputError(
                    f"top_depth of a drum is {self.top_depth:g} m for a circular section; leave it out.", "top_depth"
                )
            value = check_range("top_depth", self.top_depth, *LENGTHS, unit="m", remedy="use SI units", of="a drum")
            object.__setattr__(self, "top_depth", None if value == self.depth else value)

    @property
    def circular(self) -> bool:
        """Whether the section is a circle."""
        return self.section == "circular"

    @property
    def upper_depth(self) -> float:
        """Depth of the upper face [m]."""
        return self.depth if self.top_depth is None else self.top_depth

    @property
    def mean_depth(self) -> float:
        """Mean of the two depths [m]."""
        return 0.5 * (self.depth + self.upper_depth)

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
        if self.top_depth is None:
            return self.depth * h * (b + t) / 2.0
        w, v = self.depth, self.top_depth
        return h * (2.0 * b * w + 2.0 * t * v + b * v + t * w) / 6.0

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
        if self.top_depth is None:
            return h * (b + 2.0 * t) / (3.0 * (b + t))
        w, v = self.depth, self.top_depth
        return h * (b * w + t * w + b * v + 3.0 * t * v) / (2.0 * (2.0 * b * w + 2.0 * t * v + b * v + t * w))

    @property
    def inertia(self) -> float:
        """Moment of inertia about the horizontal axis through the centroid, perpendicular to the plane [kg m²].

        Notes
        -----
        Integral over the height of (own second moment of the slice + slice area × distance²); the integrand is a
        polynomial of degree 4 at most, so three Gauss points are exact.
        """
        return self._turned(across=False)

    @property
    def cross_inertia(self) -> float:
        """Moment of inertia about the horizontal axis through the centroid, in the plane of motion [kg m²].

        As :attr:`inertia`, with the second moments of the slices about the other axis.
        """
        return self.inertia if self.circular else self._turned(across=True)

    def _turned(self, *, across: bool) -> float:
        b, t, h, zc = self.bottom_width, self.top_width, self.height, self.centroid_height
        total = 0.0
        for x, weight in GAUSS_POINTS:
            z = 0.5 * h * (1.0 + x)
            q, w = b + (t - b) * z / h, self.depth_at(z)
            second = section_second_moment(self.section, *((w, q) if across else (q, w)))
            area = section_area(self.section, q, w)
            total += 0.5 * h * weight * (second + area * (z - zc) ** 2)
        return self.density * total

    @property
    def axial_inertia(self) -> float:
        """Moment of inertia about the drum's own axis [kg m²]; exact by three Gauss points over the height."""
        b, t, h = self.bottom_width, self.top_width, self.height
        total = 0.0
        for x, weight in GAUSS_POINTS:
            q = b + (t - b) * 0.5 * (1.0 + x)
            w = self.depth_at(0.5 * h * (1.0 + x))
            own = section_second_moment(self.section, q, w)
            other = own if self.circular else q * w**3 / 12.0
            total += 0.5 * h * weight * (own + other)
        return self.density * total

    def depth_at(self, z: float) -> float:
        """Depth of the section at a height above the lower face [m]."""
        return self.depth if self.top_depth is None else self.depth + (self.top_depth - self.depth) * z / self.height

    def as_prism(self) -> Drum:
        """The paper's idealisation: a drum of constant, mean width and depth."""
        d = self.mean_width
        return Drum(self.height, d, d, self.density, self.section, self.mean_depth)


def section_area(section: str, width: float, depth: float) -> float:
    """Area of a face of given width (diameter) and depth [m²]."""
    return math.pi * width**2 / 4.0 if section == "circular" else width * depth


def section_second_moment(section: str, width: float, depth: float) -> float:
    """Second moment of area of a face about its horizontal axis perpendicular to the plane [m⁴]."""
    return math.pi * width**4 / 64.0 if section == "circular" else depth * width**3 / 12.0
