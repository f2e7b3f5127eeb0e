"""Plane distinct elements: rigid drums on soft frictional joints, stepped explicitly (Cundall; the paper's UDEC)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from ...column import Column
from ...errors import InputError, check_choice, check_range, check_whole
from ...kernels.plane.records import LOCAL
from ...kernels.run_codes import LANES
from ...motion import Motion
from ...response import Response
from ..base import Case, RunOptions
from ..drums.impact import rocking_column
from ..drums.links import acting, link_stiffness, with_links
from ..drums.records import Packed, body_fields, contact_points, damping_rows, joint_stiffnesses
from ..drums.stepped import LossyDrums, with_provenance
from ..engine import engine_for
from ..plane.columns import PlaneStack
from ..plane.loose import LooseInPlane
from ..plane.packing import Types, found_start, joint_fields, lane_fields, pack_column, point_law
from ..shared import stable_step as shared
from ..shared.stable_step import LOCAL_DAMPING, settled
from ..shared.toes import Opening, opening, point_toes

MAX_POINTS = 32


class PointStack(PlaneStack):
    """Columns in the plane on contact points: in lanes, and followed to the ground where that is asked for."""

    takes = frozenset({"as found", "start"})
    links = PlaneStack.links | {"clamp"}
    rocking = staticmethod(rocking_column)

    def record_types(self, linked: bool, lanes: int = LANES) -> Types:
        """Types of the records by the law of the joints, for columns with links or without."""
        return point_law(self.model.points, self.model.damped, lanes, linked)

    def pack(self, structure: Column) -> Packed:
        """A column as the lanes want it, settled if asked for."""
        return _pack(structure, self.model.acting(structure))

    @property
    def stable_step(self) -> float:
        """Largest stable time step of the closed column [s]."""
        return _stable_step(self.structure, self.acting)

    def followed(self) -> Column:
        """The column: any two of its drums may strike each other."""
        return self.structure

    def run(self, motion: Motion, options: RunOptions) -> Response:
        """One run with histories; a column that falls is followed to the ground if asked for."""
        if options.until_end or options.until_rest:
            from ..plane.collapse import follow

            how = engine_for(self.acting, self.structure)
            lanes = how.block(replace(options, until_end=True))
            response = follow(self.structure, motion, lanes, self.acting, options)
        else:
            response = super().run(motion, options)
        return with_provenance(self, motion, response, self.model.opening(self.structure))


@dataclass(frozen=True, kw_only=True)
class DistinctElement2D(LossyDrums):
    """Rigid drums with contact points on every joint: penalty springs, no tension, Coulomb friction.

    Parameters
    ----------
    points : int
        Contact points per joint. 2 are at the corners with half of the area each (UDEC's); more follow Gauss–Lobatto's
        rule over the joint's section, which is exact for the elastic closed joint from 3 on.
    block_modulus : float, optional
        Young's modulus of the stone [Pa]: half of each drum's height acts as a spring in series with its joints. None for
        rigid drums.
    step_factor : float
        Time step as a share of the largest stable one.
    time_step : float, optional
        Time step [s], instead of ``step_factor``.
    losses : {"none", "stone"} or Losses
        What joints lose: ``stone`` chooses β, with a source and a spread; ``none`` leaves it to the parameters below; or
        those that were measured (:func:`stylobate.read_losses`).
    stiffness_damping : float
        β: dashpots of β times each contact's stiffness, in parallel, while the contact is closed and does not slide [s].
    mass_damping : float
        α: force −α m v on every drum, v relative to the base [1/s].
    start : {"static", "settle"}
        Joints closed by their static weight at once, or settled with local damping from there.
    restitution : float, optional
        Share of the closing speed that contacts of drums which are not, or no longer, joined give back; for single runs
        that are followed to the ground. By default 0.3.

    Notes
    -----
    A run ends as ``collapsed`` when the part above some joint is lost for good: its centroid is beyond the end of the
    contact, moves outward, and its weight has a larger moment about that end than the strongest acceleration of the
    motion could set against it (for a joint between drums, with 1 g in reserve, because the drum below can move); or
    when a drum has left its support.

    In a batch drums touch their neighbours and the base only; with ``until_end`` a run goes on to its end all the same.
    A single run with ``until_end`` or ``until_rest`` is followed to the ground: any two drums may strike each other.
    """

    name: ClassVar[str] = "dem2d"
    title: ClassVar[str] = "distinct elements in the plane"
    references: ClassVar[tuple[str, ...]] = ("baraldi", "cundall1971", "cundall1979", "psycharis2000")
    assumptions: ClassVar[tuple[str, ...]] = (
        "Drums are rigid, with their true shape; the stone's flexibility can be put into the joints (block_modulus).",
        "Faces touch at contact points with springs, without tension, with Coulomb friction and cohesion.",
        "The base is a rigid half-plane that moves with the record.",
        "Plane motion: a circular column has its true mass, inertia and joints, but it cannot wobble.",
    )
    limits: ClassVar[tuple[str, ...]] = (
        "What an impact loses depends on contact points, friction and damping: two points are nearest to Housner's loss, "
        "more points without damping give a bouncier column.",
        "In batches a drum touches its neighbours and the base only; a single run can be followed to the ground.",
        "Drums do not crack, chip or wear.",
        "The cost of a run grows with the square root of the joint's stiffness over the drum's mass.",
    )
    engines: ClassVar[tuple[Any, ...]] = (PointStack, LooseInPlane)

    points: int = 2
    block_modulus: float | None = None
    start: str = "static"
    restitution: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_whole("points", self.points, 2, MAX_POINTS)
        if self.block_modulus is not None:
            check_range("block_modulus", self.block_modulus, 0.0, 1e14, unit="Pa", open_low=True)
        check_choice("start", self.start, ("static", "settle"))
        if self.restitution is not None:
            check_range("restitution", self.restitution, 0.0, 1.0)

    def cost(self, drums: int) -> float:
        """About what a step of a single run costs on one core [s]."""
        return (1.0 if self.damped else 0.5) * self.points * super().cost(drums)

    def opening(self, column: Column) -> Opening | None:
        """What rocks a column on two points; others have no closed form here."""
        kn = joint_stiffnesses(column, self.block_modulus)[0]
        return opening(column, kn, "corners") if self.points == 2 else None


@lru_cache(maxsize=4096)
def _pack(column: Column, model: DistinctElement2D) -> Packed:
    kn, ks = joint_stiffnesses(column, model.block_modulus)
    width, area = column.joint_widths, column.joint_areas
    xi, share = contact_points(column.section, model.points)
    drums, shear = body_fields(column, column.joint_weights / (kn * area)), np.zeros((column.n, model.points))
    if column.as_found or column.pretensioned:
        start_fields, shear = found_start(column, kn * area / width, xi, share)
        drums |= start_fields
    if model.start == "settle":
        state, shear = _settled(column, model)
        drums |= state
    joint = joint_fields(column, kn, ks) | {"fs": shear}
    types = point_law(model.points, model.damped, 1, bool(acting(column)))
    damp = damping_rows(model.damped, model.stiffness_damping, model.mass_damping)
    fields = drums, joint, lane_fields(column, damp, model.points)
    return pack_column(column, types, fields, engine_for(model, column).step, point_toes(column, kn, float(share[-1])))


#: Residual acceleration at which a column has settled [m/s²], and the most chunks of steps for it.
SETTLED, SETTLE_CHUNKS = 1e-7, 20_000


@lru_cache(maxsize=256)
def _settled(column: Column, model: DistinctElement2D) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Numbers of the drums and shear forces of the joints after settling under gravity with local damping."""
    damped = replace(model, start="static", mass_damping=max(model.mass_damping, 1e-300))
    block = engine_for(damped, column).block(RunOptions())
    block.load(0, Case(column, Motion(1e3, np.zeros(2))))
    records = block.records
    records.lane["damp"][0, LOCAL, 0] = LOCAL_DAMPING
    if not settled(block.advance, lambda: block.residual_acceleration(0), SETTLED, SETTLE_CHUNKS):
        raise InputError(
            f"column {column.name!r} does not come to rest under its weight: {block.residual_acceleration(0):.2g} m/s² "
            f"remain, allowed is {SETTLED:g}; check that every drum is supported under its centroid."
        )
    places = {name: records.body[name][:, 0].copy() for name in ("x", "z", "th", "c", "s")}
    return places, records.joint["fs"][..., 0].copy()


@lru_cache(maxsize=4096)
def _stable_step(column: Column, model: DistinctElement2D) -> float:
    """Largest stable step of central differences for the closed column, from its contact stiffness matrix [s]."""
    n = column.n
    kn, ks = joint_stiffnesses(column, model.block_modulus)
    xi, share = contact_points(column.section, model.points)
    stiffness = np.zeros((3 * n, 3 * n))
    for j in range(n):
        below = column.drums[j - 1].height - column.drums[j - 1].centroid_height if j else 0.0
        above = column.drums[j].centroid_height
        for place, part in zip(xi, share, strict=True):
            arm = 0.5 * column.joint_widths[j] * place
            # relative displacement of the contact per degree of freedom (x, z, θ) of the drum above and of the one below
            normal, shear = np.zeros(3 * n), np.zeros(3 * n)
            normal[3 * j + 1], normal[3 * j + 2] = 1.0, arm
            shear[3 * j], shear[3 * j + 2] = 1.0, above
            if j:
                normal[3 * j - 2], normal[3 * j - 1] = -1.0, -arm
                shear[3 * j - 3], shear[3 * j - 1] = -1.0, below
            area = part * column.joint_areas[j]
            stiffness += kn[j] * area * np.outer(normal, normal) + ks[j] * area * np.outer(shear, shear)
    inverse = 1.0 / np.stack((column.masses, column.masses, column.inertias), axis=1).ravel()
    return shared.stable_step(
        *with_links(link_stiffness(column), shared.highest_frequency(stiffness, inverse), model.stiffness_damping)
    )
