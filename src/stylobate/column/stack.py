"""Measures of a stack of drums: widths, masses and weights at its joints, and the whole of it as one rigid body."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from ..errors import InputError
from .drum import Drum, section_area, section_second_moment
from .joint import Joint


class Stack:
    """Closed-form properties of the drums of a column as built, standing on each other on their axis."""

    drums: tuple[Drum, ...]
    joints: tuple[Joint, ...]
    gravity: float
    name: str

    @property
    def n(self) -> int:
        """Number of drums."""
        return len(self.drums)

    @property
    def section(self) -> str:
        """``circular`` or ``rectangular``."""
        return self.drums[0].section

    @cached_property
    def heights(self) -> np.ndarray:
        """Drum heights [m], shape (n,)."""
        return np.array([drum.height for drum in self.drums])

    @cached_property
    def masses(self) -> np.ndarray:
        """Drum masses [kg], shape (n,)."""
        return np.array([drum.mass for drum in self.drums])

    @cached_property
    def inertias(self) -> np.ndarray:
        """Drum inertias about their own centroids [kg m²], shape (n,)."""
        return np.array([drum.inertia for drum in self.drums])

    @cached_property
    def joint_heights(self) -> np.ndarray:
        """Height of each joint above the base [m], shape (n,)."""
        return np.concatenate(([0.0], np.cumsum(self.heights)[:-1]))

    @cached_property
    def centroid_heights(self) -> np.ndarray:
        """Height of each drum's centroid above the base [m], shape (n,)."""
        return self.joint_heights + np.array([drum.centroid_height for drum in self.drums])

    @cached_property
    def joint_widths(self) -> np.ndarray:
        """Width d_i of each joint's contact section, the smaller of its two faces [m], shape (n,)."""
        widths = [drum.bottom_width for drum in self.drums]
        for i in range(1, self.n):
            widths[i] = min(widths[i], self.drums[i - 1].top_width)
        return np.array(widths)

    @cached_property
    def joint_areas(self) -> np.ndarray:
        """Contact area A_i of each joint [m²], shape (n,)."""
        whole = [section_area(self.section, d, self._joint_depth(i)) for i, d in enumerate(self.joint_widths)]
        sunken = [section_area("circular", max(self.sunken_widths(i)), 0.0) for i in range(self.n)]
        return np.array(whole) - sunken

    @cached_property
    def joint_second_moments(self) -> np.ndarray:
        """Second moment J_i of each joint's contact area [m⁴], shape (n,)."""
        whole = [section_second_moment(self.section, d, self._joint_depth(i)) for i, d in enumerate(self.joint_widths)]
        sunken = [section_second_moment("circular", max(self.sunken_widths(i)), 0.0) for i in range(self.n)]
        return np.array(whole) - sunken

    def check_rings(self) -> None:
        """Refuse rings of faces that are not round, are as small as the ring, or do not meet."""
        for j, joint in enumerate(self.joints):
            if joint.ring_width is None:
                continue
            if self.section != "circular":
                raise InputError(
                    f"ring_width of joint {j + 1} is {joint.ring_width:g} m, and {self.name!r} has rectangular faces; "
                    "rings are known for round ones: leave it out.",
                    f"override.{j + 1}.ring_width",
                )
            width = float(self.joint_widths[j])
            if joint.ring_width > 0.5 * width:
                raise InputError(
                    f"ring_width of joint {j + 1} of {self.name!r} is {joint.ring_width:g} m, thicker than its face, "
                    f"of diameter {width:g} m; allowed is up to {0.5 * width:g} m, or leave it out for a whole face.",
                    f"override.{j + 1}.ring_width",
                    value=joint.ring_width,
                    allowed=f"up to {0.5 * width:g} m",
                )
            if max(self.sunken_widths(j)) >= width:
                raise InputError(
                    f"the rings of joint {j + 1} of {self.name!r} do not meet: ring_width = {joint.ring_width:g} m, and one "
                    f"face is that much wider than the other; make the ring wider.",
                    f"override.{j + 1}.ring_width",
                )

    def sunken_widths(self, joint: int) -> tuple[float, float]:
        """Diameters of the sunken middles of the face above a joint and of the one below [m]; 0 for none.

        The base is not sunk.
        """
        ring = self.joints[joint].ring_width
        if ring is None:
            return 0.0, 0.0
        below = self.drums[joint - 1].top_width if joint else 0.0
        return max(self.drums[joint].bottom_width - 2.0 * ring, 0.0), max(below - 2.0 * ring, 0.0)

    def joint_edge(self, joint: int) -> float:
        """Length of the edge of a joint's contact area, of a ring both [m]."""
        width, sunken = float(self.joint_widths[joint]), max(self.sunken_widths(joint))
        if self.section == "circular":
            return math.pi * (width + sunken)
        return 2.0 * (width + self._joint_depth(joint))

    def _joint_depth(self, i: int) -> float:
        return min(self.drums[i].depth, self.drums[i - 1].upper_depth) if i else self.drums[0].depth

    @cached_property
    def joint_weights(self) -> np.ndarray:
        """Static weight N_i carried by each joint [N], shape (n,)."""
        return np.cumsum(self.masses[::-1])[::-1] * self.gravity

    @cached_property
    def parts_above(self) -> tuple[np.ndarray, np.ndarray]:
        """Mass of the part above each joint [kg], and height of its centroid over that joint [m], each of shape (n,)."""
        mass, height = np.empty(self.n), np.empty(self.n)
        for j, level in enumerate(self.joint_heights):
            each = self.masses[j:]
            mass[j] = each.sum()
            height[j] = each @ (self.centroid_heights[j:] - level) / mass[j]
        return mass, height

    @cached_property
    def lowest_barrier(self) -> float:
        """Smallest energy that overturns the part above some joint of the upright column as one body [J]."""
        parts = zip(*(array.tolist() for array in (*self.parts_above, 0.5 * self.joint_widths)), strict=True)
        return min(self.gravity * mass * (math.hypot(half, height) - height) for mass, height, half in parts)

    @cached_property
    def joint_closures(self) -> np.ndarray:
        """By how much each joint closes under the weight that it carries [m], shape (n,)."""
        return self.joint_weights / (np.array([joint.normal_stiffness for joint in self.joints]) * self.joint_areas)

    # -- the whole of it as one body ----------------------------------------------------------------------------------

    @property
    def height(self) -> float:
        """Total height [m]."""
        return float(self.heights.sum())

    @property
    def mass(self) -> float:
        """Total mass [kg]."""
        return float(self.masses.sum())

    @property
    def centroid_height(self) -> float:
        """Height of the centroid of the whole column [m]."""
        return float(self.masses @ self.centroid_heights / self.masses.sum())

    @property
    def base_width(self) -> float:
        """Width of the joint with the base [m]."""
        return float(self.joint_widths[0])

    @property
    def joint_width(self) -> float:
        """Smallest width of a joint [m]."""
        return float(self.joint_widths.min())

    @property
    def radius(self) -> float:
        """R: distance from the base corner to the centroid of the whole column [m]."""
        return math.hypot(0.5 * self.base_width, self.centroid_height)

    @property
    def slenderness(self) -> float:
        """α: angle at the base corner between the vertical and the line to the centroid [rad]."""
        return math.atan2(0.5 * self.base_width, self.centroid_height)

    @property
    def corner_inertia(self) -> float:
        """I₀: inertia of the column as one rigid body about its base corner [kg m²]."""
        about_axis = float((self.inertias + self.masses * self.centroid_heights**2).sum())
        return about_axis + self.mass * (0.5 * self.base_width) ** 2

    @property
    def frequency_parameter(self) -> float:
        """p = sqrt(m g R / I₀) of the column as one rigid body [rad/s] (Housner 1963)."""
        return math.sqrt(self.mass * self.gravity * self.radius / self.corner_inertia)

    @property
    def restitution(self) -> float:
        """e = 1 − 2 m b² / I₀ with b the half base: Housner's velocity restitution at an impact [-]."""
        return 1.0 - 2.0 * self.mass * (0.5 * self.base_width) ** 2 / self.corner_inertia
