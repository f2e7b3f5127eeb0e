"""Distinct elements in space: rigid drums with round or rectangular faces on soft frictional joints, stepped explicitly."""

from __future__ import annotations

import importlib
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar

from ...column import Column
from ...column.found_geometry import shares_left
from ...column.spatial.assembly import SpatialAssembly
from ...column.specimen import Specimen
from ...errors import InputError, check_choice, check_range
from ...kernels.run_codes import LANES
from ...motion import Motion
from ...response import Response
from ..base import RunOptions
from ..drums.impact import damping_for, rocking_column
from ..drums.links import bonds, link_stiffness, with_beds_alone, with_links
from ..drums.records import Packed, Topology, damping_rows, joint_stiffnesses
from ..drums.stepped import LaneEngine, LossyDrums, StackEngine, with_provenance
from ..engine import engine_for
from ..shared.stable_step import check_step_resolves, stable_step
from ..shared.toes import Opening, bed_toes, opening, point_toes, rim_toes
from ..space.lanes import BodiesInSpace
from .block import SpaceBlock, Stack
from .packing import (
    ALONE,
    CHIPPED,
    RING,
    SPECIMEN,
    Kind,
    Records,
    chipped,
    drum_fields,
    found_start,
    highest_frequency,
    joint_fields,
    lane_fields,
    link_fields,
    numbers_for,
    pack_column,
)
from .specimen import FreeBody, RockingSpecimen, pack_specimen, rows_for, top_frequency

#: Bending stiffness of a closed joint over k_n J, less 1: of each law of contact of round faces, and of corners.
LAWS = {"rim": 1.0, "bed": 0.0}
ON_CORNERS = 2.0

#: Energy of a joint of each law with its load on its edge.
TOES = {"rim": rim_toes, "bed": bed_toes, "corners": lambda column, kn: point_toes(column, kn, 0.25)}


class InSpace(LaneEngine):
    """Base of the engines of columns and of single bodies in space."""

    takes = frozenset({"as found", "rings", "start"})
    links = StackEngine.links | {"clamp"}

    def check(self, motion: Motion) -> None:
        """Refuse rolling of what has corners."""
        rolling = self.model.rolling_resistance
        if rolling and self.structure.section != "circular":
            raise InputError(
                f"rolling_resistance = {rolling:g} is for round drums, and {self.structure.name!r} has corners; leave it "
                "out."
            )
        super().check(motion)

    def records(self, kind: Kind, lanes: int = LANES) -> Records:
        """Empty records of the kernel for what is of a kind."""
        return Records(kernel(), kind.record_types(bool(kind.topology.links), lanes), kind.topology, kind.rows)


class SpaceStack(InSpace, StackEngine):
    """Columns in space."""

    rocking = staticmethod(rocking_column)

    @property
    def draws_laws(self) -> bool:
        """Whether columns may have losses and laws of joints of their own: out of the plane."""
        return not self.model.planar

    def check(self, motion: Motion) -> None:
        """Refuse joints too soft, what is found that space does not know, and a step unstable or too long for the motion."""
        super().check(motion)
        column = self.structure
        law = self.acting.law
        if law != "bed":
            column.must_carry_on_whole_faces(f"dem3d with law={law}")
        twice = next((drum.drum for drum in column.as_found.drums if drum.chip_left and drum.chip_right), None)
        if twice is not None and chipped(column):
            raise InputError(
                f"drum {twice} of {column.name!r} is round and chipped on the left and on the right; dem3d knows one "
                "chip of a round drum: leave the smaller one out, or use dem2d in its plane."
            )
        if law == "bed" and chipped(column):
            raise InputError(
                f"dem3d with law=bed knows no chips of round drums, and a drum of {column.name!r} has one; use law=rim, "
                "or leave the chip out."
            )
        if self.model.planar and not column.as_found.in_plane:
            raise InputError(
                f"planar = True holds the motion in the plane of x and z, and {column.name!r} is found out of it; "
                "leave one of the two out."
            )

    @property
    def kind(self) -> Kind:
        """Columns of one kind share blocks of lanes."""
        column, how = self.structure, self.acting
        section = RING if column.on_rings else CHIPPED if chipped(column) else column.section
        return Kind(Topology.of(column), section, column.n, how.law, how.damped, how.rolling_resistance > 0.0)

    def block_for(self, kind: Kind, options: RunOptions, lanes: int = LANES) -> SpaceBlock:
        """A block of lanes for columns of a kind."""
        model = self.model
        bodies, cost = Stack(planar=model.planar, pivots=model.pivot_friction < 1.0), model.cost(kind.rows)
        return SpaceBlock(self.records(kind, lanes), bodies, self.pack, options, cost, planar=model.planar)

    def pack(self, structure: Column) -> Packed:
        """A column as the kernel wants it."""
        return _pack(structure, self.model.acting(structure))

    @property
    def stable_step(self) -> float:
        """Largest stable time step of the closed column [s]."""
        return _stable_step(self.structure, self.acting)

    def followed(self) -> SpatialAssembly:
        """The column as an assembly of its drums: any two bodies may strike each other."""
        return SpatialAssembly.of_column(self.structure)

    def run(self, motion: Motion, options: RunOptions) -> Response:
        """One run with histories; says what opens the column, and what damping a restitution has led to."""
        column, model = self.structure, self.model
        response = with_provenance(self, motion, super().run(motion, options), model.opening(column))
        if model.restitution is None:
            return response
        more = engine_for(replace(model, restitution=None, time_step=None), column).stable_step / self.stable_step
        chosen = {"stiffness_damping_s": model.damping(column), "steps_over_undamped": more}
        return replace(response, provenance=response.provenance | chosen)


class SpaceBody(InSpace):
    """Single bodies on the vertices of their hulls."""

    computes = (Specimen,)

    @property
    def called(self) -> str:
        """Its name in messages."""
        return repr(self.structure.name)

    @property
    def rocking(self) -> RockingSpecimen:
        """How single bodies rock on vertices."""
        return RockingSpecimen(self.structure.restitution)

    def check(self, motion: Motion) -> None:
        """Refuse what acts on drums, and a step unstable or too long for the motion."""
        super().check(motion)
        body, model = self.structure, self.model
        if model.planar:
            raise InputError(f"planar is on, and a specimen such as {body.name!r} moves in space; leave it off.")
        if model.restitution is not None:
            raise InputError(
                f"restitution is given, and that of a specimen such as {body.name!r} depends on the side it falls to; "
                "give it to the specimen (restitution of a vertex), or give stiffness_damping."
            )
        self.step  # noqa: B018 (which refuses)
        check_step_resolves(model.time_step, motion)

    def run(self, motion: Motion, options: RunOptions) -> Response:
        """One run with histories."""
        return with_provenance(self, motion, super().run(motion, options))

    @property
    def kind(self) -> Kind:
        """Bodies with as many rows of vertices share blocks of lanes."""
        model = self.model
        return Kind(ALONE, SPECIMEN, rows_for(self.structure), model.law, True, model.rolling_resistance > 0.0)

    def block_for(self, kind: Kind, options: RunOptions, lanes: int = LANES) -> SpaceBlock:
        """A block of lanes for bodies of a kind."""
        del lanes
        return SpaceBlock(self.records(kind), FreeBody(), self.pack, options, self.model.cost(kind.rows // 32))

    def pack(self, structure: Specimen) -> Packed:
        """A body as the kernel wants it."""
        return _pack_specimen(structure, self.model.acting(structure))

    @property
    def stable_step(self) -> float:
        """Largest stable time step [s]."""
        return stable_step(top_frequency(self.structure), self.acting.stiffness_damping)


@dataclass(frozen=True, kw_only=True)
class DistinctElement3D(LossyDrums):
    """Rigid drums in space: no-tension joints that carry on the rims or corners of their overlap, Coulomb friction.

    Parameters
    ----------
    law : {"rim", "bed"}
        Where a joint of round faces carries: ``rim`` puts its stiffness on the rim of the overlap of the two faces, ``bed``
        spreads it over the overlap (an elastic bed without tension), less the sunken middles of joints on rings. Rectangular
        faces carry at the four corners of their overlap.
    pivot_friction : float
        Share of the torsional friction that acts, from 0 (a rim pivots freely about its point of contact) to 1.
    rolling_resistance : float
        c: a moment c N r resists the rolling of a round face about the arm r from its middle to that of the pressure N; it
        only dissipates, and counts as viscous in the ledger. 0 for none [-].
    planar : bool
        Hold the motion in the plane of x and z: the plane twin of the same law, for comparison.
    block_modulus : float, optional
        Young's modulus of the stone [Pa]: half of each drum's height acts as a spring in series with its joints. None for
        rigid drums.
    step_factor : float
        Time step as a share of the largest stable one.
    time_step : float, optional
        Time step [s], instead of ``step_factor``.
    losses : {"none", "stone"} or Losses
        What joints lose: ``stone`` chooses β (and, for round faces in space, c), with a source and a spread; ``none`` leaves
        it to the parameters below; or those that were measured (:func:`stylobate.read_losses`).
    stiffness_damping : float
        β: the depth of contact is taken as depth + β × its rate, so that no contact ever pulls; β times the stiffness in
        shear and torsion [s].
    restitution : float, optional
        Velocity restitution that the first impact of the column as one body shall have: chooses β, in place of
        ``stiffness_damping``. The provenance says which β that is, and how many times as many steps it costs. Of an assembly
        in space the share of the speed that bodies keep which strike one another or the ground, 0.3 by default; it does not
        act on joints, faces that lie on one another from the start.
    mass_damping : float
        α: force −α m v on every drum, v relative to the base, and moment −α L [1/s].

    Notes
    -----
    A run ends as ``collapsed`` when the part above some joint is lost for good: its centroid is beyond the overlap of the
    faces, moves outward, and its weight has a larger moment about the edge than the strongest acceleration of the motion
    and its own spin could set against it (for a joint between drums, with 1 g in reserve, because the drum below can
    move); or when a drum has left its support.
    """

    name: ClassVar[str] = "dem3d"
    title: ClassVar[str] = "distinct elements in space"
    references: ClassVar[tuple[str, ...]] = ("cundall1971", "cundall1979")
    assumptions: ClassVar[tuple[str, ...]] = (
        "Drums are rigid, with their true shape; the stone's flexibility can be put into the joints (block_modulus).",
        "Round faces carry on the rims of their overlap, without tension, with Coulomb friction in shear and torsion; "
        "rectangular ones at the four corners of their overlap, each with a shear force within Coulomb's cone. Faces of "
        "assemblies carry on the edge of their overlap, and whatever else touches on an elastic bed.",
        "The base is a rigid half-space that moves with the record, in all three directions.",
    )
    limits: ClassVar[tuple[str, ...]] = (
        "What an impact loses depends on the law of contact, on friction and on damping.",
        "Undamped (stiffness_damping = 0, the default) a column wobbles long, and near collapse the verdict hangs on how "
        "long a contact of stone lasts, which is not known: take a population, and compare 1e-4 to 1e-3 s. With losses = "
        "stone an impact leaves what Housner says.",
        "A drum of a column touches its neighbours and the base only. In an assembly any two bodies may touch: what is "
        "struck then hangs on how stiff a base is beside the contact, and a fall is one draw of many.",
        "Drums do not crack, chip or wear.",
        "The overlap of rectangular faces turned against each other is taken too small: its corners are those of the upper "
        "face, brought to the nearest place on the lower one.",
        "The cost of a run grows with the square root of the joint's stiffness over the drum's mass.",
    )
    axes: ClassVar[str] = "xyz"
    engines: ClassVar[tuple[Any, ...]] = (SpaceStack, SpaceBody, BodiesInSpace)

    law: str = "rim"
    pivot_friction: float = 1.0
    rolling_resistance: float = 0.0
    planar: bool = False
    block_modulus: float | None = None
    restitution: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_choice("law", self.law, LAWS)
        check_range("pivot_friction", self.pivot_friction, 0.0, 1.0)
        check_range("rolling_resistance", self.rolling_resistance, 0.0, 1.0)
        if self.restitution is not None:
            check_range("restitution", self.restitution, 0.0, 1.0)
        if self.block_modulus is not None:
            check_range("block_modulus", self.block_modulus, 0.0, 1e14, unit="Pa", open_low=True)

    @property
    def damped(self) -> bool:
        """Whether any damping acts during the run."""
        return super().damped or self.restitution is not None or self.rolling_resistance > 0.0

    def damping(self, column: Column) -> float:
        """Stiffness damping β for a column [s]: as given, or as its restitution asks for."""
        if self.restitution is None:
            return self.stiffness_damping
        if self.stiffness_damping:
            raise InputError(
                f"restitution = {self.restitution:g} and stiffness_damping = {self.stiffness_damping:g} are both given, and "
                f"of columns such as {column.name!r} the one chooses the other; give one of the two."
            )
        return damping_for(with_beds_alone(column), replace(self, restitution=None), self.restitution)

    def opening(self, column: Column) -> Opening | None:
        """What rocks a column on the law of its joints."""
        kn = joint_stiffnesses(column, self.block_modulus)[0]
        return opening(column, kn, self.acting(column).law if column.section == "circular" else "corners")

    def cost(self, drums: int) -> float:
        """About what a step of a single run costs on one core [s]."""
        return (8.3 if self.damped else 5.5) * super().cost(drums)


def kernel() -> Any:
    """Module of kernels."""
    return importlib.import_module("...kernels.dem3d.step", __package__)


@lru_cache(maxsize=256)
def _pack_specimen(specimen: Specimen, model: DistinctElement3D) -> Packed:
    engine, damping = engine_for(model, specimen), (model.stiffness_damping, model.mass_damping)
    return pack_specimen(engine.records(engine.kind), specimen, damping, engine.step)


@lru_cache(maxsize=4096)
def _pack(column: Column, model: DistinctElement3D) -> Packed:
    kn, ks = joint_stiffnesses(column, model.block_modulus)
    closure = column.joint_weights / (kn * column.joint_areas)
    drums, joints = drum_fields(column, closure), joint_fields(column, kn, ks)
    options = model.pivot_friction, model.planar, model.rolling_resistance
    lane = lane_fields(column, damping_rows(model.damped, model.damping(column), model.mass_damping), *options)
    engine = engine_for(model, column)
    kind = engine.kind
    if column.as_found or column.pretensioned:
        start_fields, friction = found_start(
            column, kernel(), kind.record_types(linked=False), (drums, joints, lane), closure
        )
        drums, joints = drums | start_fields, joints | friction
    links, top = link_fields(column, drums), Stack(planar=model.planar).top
    numbers = pack_column(engine.records(kind), column, (drums, joints, lane), links, top)
    law = model.law if column.section == "circular" else "corners"
    stand = numbers_for(column, TOES[law](column, kn * shares_left(column)))
    return Packed(numbers, bonds(column), engine.step, column.joint_widths, column.lowest_barrier, stand)


@lru_cache(maxsize=4096)
def _stable_step(column: Column, model: DistinctElement3D) -> float:
    kn, ks = joint_stiffnesses(column, model.block_modulus)
    share = LAWS[model.law] if column.section == "circular" else ON_CORNERS
    return stable_step(
        *with_links(link_stiffness(column), highest_frequency(column, kn, ks, share), model.damping(column))
    )
