"""Rigid block model: true drums, each joint one elastic–plastic interface on the N–V–M domain; stepped explicitly."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from ...column import Column
from ...errors import InputError, check_range
from ...kernels.run_codes import LANES
from ...motion import Motion
from ..drums.links import acting, link_stiffness, with_links
from ..drums.records import Packed, body_fields, damping_rows
from ..drums.stepped import SteppedDrums
from ..engine import engine_for
from ..plane.columns import PlaneStack
from ..plane.packing import Types, face_fields, interface_law, lane_fields, pack_column
from ..shared import stable_step as shared
from ..shared.toes import point_toes
from .block_stack import BlockStack


class InterfaceStack(PlaneStack):
    """Columns in the plane whose joints are one interface each."""

    def check(self, motion: Motion) -> None:
        """Refuse an unstable step, joints that crush under the weight, and pretension; say what a plane model leaves out."""
        super().check(motion)
        column, strength = self.structure, self.model.compressive_strength
        if column.pretensioned:
            pull = max(link.pretension for link in column.placed_links)
            raise InputError(
                f"rigid-block begins with joints that the weight alone presses, and a link of {column.name!r} has a "
                f"pretension of {pull:g} N; use dem2d or dem3d, or leave the pretension out."
            )
        if strength is not None:
            stress = column.joint_weights / column.joint_areas
            worst = int(np.argmax(stress))
            if stress[worst] >= strength:
                raise InputError(
                    f"joint {worst + 1} crushes under the column's own weight: compressive_strength is "
                    f"{strength:g} Pa; allowed is above {stress[worst]:.4g} Pa."
                )

    def record_types(self, linked: bool, lanes: int = LANES) -> Types:
        """Types of the records by the law of the joints, for columns with links or without."""
        return interface_law(self.model.compressive_strength is not None, self.model.damped, lanes, linked)

    def pack(self, structure: Column) -> Packed:
        """A column as the lanes want it."""
        return _pack(structure, self.model)

    @property
    def stable_step(self) -> float:
        """Largest stable time step of the closed column [s]."""
        return stable_step(self.structure, self.model.stiffness_damping)


@dataclass(frozen=True, kw_only=True)
class RigidBlock(SteppedDrums):
    """Rigid drums with three coordinates each, joined by interfaces with compression, shear and moment at one place.

    Parameters
    ----------
    compressive_strength : float, optional
        f_c of every joint [Pa]: |M| ≤ |N| d/2 (1 − |N|/(f_c A)) and |N| ≤ f_c A. None for unlimited strength. It shortens
        the levers; what it does not do is damage: a toe that has crushed bears again as before.
    step_factor : float
        Time step as a share of the largest stable one.
    time_step : float, optional
        Time step [s], instead of ``step_factor``.
    stiffness_damping : float
        β: dashpots of β times the joint's stiffness at the point of contact, while it is pressed [s].
    mass_damping : float
        α: force −α m v on every drum, v relative to the base [1/s].

    Notes
    -----
    Compression and moment are holonomic (no tension, eccentricity inside the faces' overlap: rocking gives back what it
    takes), shear is plastic (Mohr–Coulomb without dilatancy): ``docs/theory/rigid_block.md``. Rotations may be large.

    Steps are explicit, as in the distinct element model, because a joint closes and opens within a millisecond: an
    implicit step that followed it would have to be as short, and would solve a system in each. *Collapsed* and
    *decided* mean what they mean there.

    References
    ----------
    Baraldi, Sarhosis and Milani, section 2.3.
    """

    name: ClassVar[str] = "rigid-block"
    title: ClassVar[str] = "rigid blocks with interfaces"
    references: ClassVar[tuple[str, ...]] = ("baraldi",)
    assumptions: ClassVar[tuple[str, ...]] = (
        "Drums are rigid, with their true shape; rotations may be large.",
        "Every joint is one interface with a compression, a shear and a moment; opening costs nothing and closes again.",
        "Compression acts inside the overlap of the two faces; shear is Mohr–Coulomb without dilatancy.",
        "Plane motion.",
    )
    limits: ClassVar[tuple[str, ...]] = (
        "The normal of a joint is the lower face's: once drums have slid over an edge, dem2d has the right one.",
        "What an impact loses comes out of the joint's law; it is less than Housner's for one block.",
        "A compressive strength shortens the levers of the joints while they are pressed; it takes no energy, does no "
        "damage that stays, and does not shorten a drum.",
        "A drum touches its neighbours only; what comes down is not followed.",
        "Columns that are not as built are refused, and links with pretension.",
    )

    engines: ClassVar[tuple[Any, ...]] = (InterfaceStack,)

    compressive_strength: float | None = None
    step_factor: float = 0.2

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.compressive_strength is not None:
            check_range("compressive_strength", self.compressive_strength, 0.0, 1e12, unit="Pa", open_low=True)


@lru_cache(maxsize=4096)
def _pack(column: Column, model: RigidBlock) -> Packed:
    n, area = column.n, column.joint_areas
    kn, km, ks = joint_stiffness(column)
    strength = model.compressive_strength
    joint = face_fields(column) | {
        "kn": kn,
        "km": km,
        "ks": ks,
        "co": np.array([joint.cohesion for joint in column.joints]) * area,
        "mu": column.friction,
        "crush": np.zeros((n, 1)) if strength is None else np.repeat((1.0 / (strength * area))[:, None], 2, 1),
        "chi": np.ones(n),
    }
    types = interface_law(strength is not None, model.damped, 1, bool(acting(column)))
    damp = damping_rows(model.damped, model.stiffness_damping, model.mass_damping)
    fields = body_fields(column, column.joint_weights / kn), joint, lane_fields(column, damp)
    return pack_column(column, types, fields, engine_for(model, column).step, _toes(column, strength))


def _toes(column: Column, strength: float | None) -> np.ndarray:
    """Energy that joints give [J], shape (2, n); a joint that crushes carries its load further in."""
    kn, km, _ = joint_stiffness(column)
    half = 0.5 * column.joint_widths
    inset = 0.0 if strength is None else half * column.joint_weights / (strength * column.joint_areas)
    crushed = column.joint_weights * inset * half / np.hypot(half, column.parts_above[1])
    return point_toes(column, kn / column.joint_areas, 1.0 / (1.0 + half**2 * kn / km), crushed)


def joint_stiffness(column: Column) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """k_n A [N/m], k_n J [N m] and k_s A [N/m] of each joint (Baraldi et al., Eq. 8), each of shape (n,)."""
    kn = np.array([joint.normal_stiffness for joint in column.joint_laws])
    ks = np.array([joint.shear_stiffness for joint in column.joint_laws])
    return kn * column.joint_areas, kn * column.joint_second_moments, ks * column.joint_areas


@lru_cache(maxsize=4096)
def stable_step(column: Column, stiffness_damping: float = 0.0) -> float:
    """Largest stable step of central differences for the column on its elastic joints [s]."""
    kn, km, ks = joint_stiffness(column)
    strain = BlockStack.of_column(column).compatibility()
    stiffness = strain.T @ (np.stack((kn, ks, km), axis=1).ravel()[:, None] * strain)
    inverse = 1.0 / np.stack((column.masses, column.masses, column.inertias), axis=1).ravel()
    frequency = shared.highest_frequency(stiffness, inverse)
    return shared.stable_step(*with_links(link_stiffness(column), frequency, stiffness_damping))
