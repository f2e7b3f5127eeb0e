"""Plane distinct elements: rigid drums on soft frictional joints, stepped explicitly (Cundall; the paper's UDEC)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from ...column import Column
from ...column.assembly import Assembly
from ...column.shapes import DRUMS, Prism
from ...column.structure import Structure
from ...errors import InputError, check_choice, check_range, check_whole
from ...kernels.plane.records import LOCAL
from ...kernels.run_codes import LANES
from ...motion import Motion
from ...response import Measures, Response
from ..base import Case, RunOptions
from ..drums.bodies import Topology, body_fields
from ..drums.joints import contact_points, damping_rows, joint_stiffnesses
from ..drums.links import acting, link_stiffness, with_links
from ..drums.losses import LossyDrums
from ..drums.records import Packed
from ..plane.assemblies import expected_step, measures_of_assemblies, run_assembly
from ..plane.columns import ColumnLanes
from ..plane.found_start import found_start
from ..plane.laws import Types, point_law
from ..plane.loose import Contacts
from ..plane.packing import joint_fields, lane_fields, pack_column
from ..shared import stable_step as shared
from ..shared.opening import Opening, opening
from ..shared.settling import LOCAL_DAMPING, settled
from ..shared.toes import point_toes

MAX_POINTS = 32


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
    computes: ClassVar[tuple[type, ...]] = (*DRUMS, Prism)
    takes_as_found: ClassVar[bool] = True
    takes_start: ClassVar[bool] = True
    takes_links: ClassVar[frozenset[str]] = LossyDrums.takes_links | {"clamp"}

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

    # -- what a block of lanes needs -----------------------------------------------------------------------------

    def record_types(self, linked: bool, lanes: int = LANES) -> Types:
        """Types of the records by the law of the joints, for columns with links or without."""
        return point_law(self.points, self.damped, lanes, linked)

    def block_for(self, kind: Topology, options: RunOptions, lanes: int = LANES) -> ColumnLanes:
        """A block of lanes for columns of a kind."""
        return ColumnLanes(self.record_types(bool(kind.links), lanes), self.pack, kind, options, self.cost(kind.stack))

    def pack(self, column: Column) -> Packed:
        """A column as the engine wants it, settled if asked for."""
        return _pack(column, self.acting(column))

    def stable_step(self, column: Column) -> float:
        """Largest stable time step of the closed column [s]."""
        return _stable_step(column, self.acting(column))

    def opening(self, column: Column) -> Opening | None:
        """What rocks a column on two points; others have no closed form here."""
        kn = joint_stiffnesses(column, self.block_modulus)[0]
        return opening(column, kn, "corners") if self.points == 2 else None

    def run(self, column: Any, motion: Motion, options: RunOptions) -> Response:
        """One run with histories; a column that falls is followed to the ground if asked for, an assembly always."""
        if column.stack is None:
            if options.start is not None:
                raise InputError(
                    f"a start from a pose is for columns, and {column.name!r} is {column.described}; leave start out."
                )
            return self.told(column, motion, self.run_assembly(column, motion, replace(options, until_end=True)))
        if options.until_end or options.until_rest:
            from ..plane.collapse import follow

            how = self.acting(column)
            response = follow(column, motion, how.followed(column, options), how.contacts, options)
            return self.told(column, motion, response)
        return self.told(column, motion, super().run(column, motion, options))

    @property
    def contacts(self) -> Contacts:
        """Numbers for what may come loose."""
        return Contacts(
            self.name, self.points, self.stiffness_damping, self.mass_damping, self.block_modulus, self.restitution,
            self.step_factor, self.time_step, self.start == "settle",
        )  # fmt: skip

    def followed(self, column: Column, options: RunOptions) -> ColumnLanes:
        """Lanes for a column that is followed to the ground."""
        return self.block_for(self.kind(column), replace(options, until_end=True))

    def run_many(self, cases: Sequence[Case], options: RunOptions, threads: int) -> Iterator[tuple[int, Measures]]:
        """Many runs of columns in lanes, or of assemblies one by one in threads; never of both in one batch."""
        if len(cases) and cases[0].column.stack is None:
            return measures_of_assemblies(self.run_assembly, cases, options, threads)
        return super().run_many(cases, options, threads)

    def run_assembly(
        self, assembly: Assembly, motion: Motion, options: RunOptions, *, recorded: bool = True
    ) -> Response:
        """One run of an assembly of blocks, with histories where they are wanted.

        Raises
        ------
        InputError
            The stone is given a modulus, the step asked for is unstable, or the assembly cannot settle.
        """
        return run_assembly(assembly, motion, self.acting(assembly).contacts_of_blocks(), options, recorded=recorded)

    def expected_step(self, column: Structure, motion: Motion) -> tuple[float, float]:
        """Time step and its cost [s]; of an assembly as long as it stands."""
        if column.stack is not None:
            return super().expected_step(column.stack, motion)
        return expected_step(column.must_be("assembly"), motion, self.acting(column).contacts_of_blocks())

    def check_length(self, column: Any, motion: Motion, options: RunOptions) -> None:
        """As of all models; the step of what may come loose is known once its contacts are: each run asks for itself."""
        if column.stack is not None:
            super().check_length(column, motion, options)

    def as_followed(self, structure: Any) -> Any:
        """What stands as it is: all of it may come loose."""
        return structure

    def carried(self, column: Any) -> int:
        """Number of twins along a run: of columns only; what may come loose is alone in its lane."""
        return 0 if column.stack is None else self.carries

    def contacts_of_blocks(self) -> Contacts:
        """Numbers for assemblies, whose blocks are rigid."""
        if self.block_modulus is not None:
            raise InputError(
                f"block_modulus is {self.block_modulus:g} Pa; the blocks of an assembly are rigid: leave it out."
            )
        return self.contacts


@lru_cache(maxsize=4096)
def _pack(column: Column, model: DistinctElement2D) -> Packed:
    kn, ks = joint_stiffnesses(column, model.block_modulus)
    width, area = column.joint_widths, column.joint_areas
    xi, share = contact_points(column.section, model.points)
    drums, shear = body_fields(column, column.joint_weights / (kn * area)), np.zeros((column.n, model.points))
    if column.as_found or column.pretensioned:
        found, shear = found_start(column, kn * area / width, xi, share)
        drums |= found
    if model.start == "settle":
        state, shear = _settled(column, model)
        drums |= state
    joint = joint_fields(column, kn, ks) | {"fs": shear}
    types = point_law(model.points, model.damped, 1, bool(acting(column)))
    damp = damping_rows(model.damped, model.stiffness_damping, model.mass_damping)
    fields = drums, joint, lane_fields(column, damp, model.points)
    return pack_column(column, types, fields, model.step_for(column), point_toes(column, kn, float(share[-1])))


#: Residual acceleration at which a column has settled [m/s²], and the most chunks of steps for it.
SETTLED, SETTLE_CHUNKS = 1e-7, 20_000


@lru_cache(maxsize=256)
def _settled(column: Column, model: DistinctElement2D) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Numbers of the drums and shear forces of the joints after settling under gravity with local damping."""
    damped = replace(model, start="static", mass_damping=max(model.mass_damping, 1e-300))
    block = damped.block_for(damped.kind(column), RunOptions())
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
