"""Distinct elements in space: rigid drums with round or rectangular faces on soft frictional joints, stepped explicitly."""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar

from ...column import Column
from ...column.found_geometry import shares_left
from ...column.shapes import DRUMS, ConvexSolid, Glued
from ...column.spatial.assembly import SpatialAssembly
from ...column.specimen import Specimen
from ...column.structure import Structure
from ...errors import InputError, check_choice, check_range
from ...kernels.run_codes import LANES
from ...motion import Motion
from ...response import Measures, Response
from ..base import Case, RunOptions
from ..drums.bodies import Topology
from ..drums.impact import Rocking, damping_for
from ..drums.joints import damping_rows, joint_stiffnesses
from ..drums.links import bonds, link_stiffness, with_beds_alone, with_links
from ..drums.losses import LossyDrums
from ..drums.records import Packed
from ..shared.opening import Opening, opening
from ..shared.soft_joints import check_step_resolves
from ..shared.stable_step import chosen_step, stable_step
from ..shared.toes import bed_toes, point_toes, rim_toes
from ..space.assemblies import SpatialNumbers, expected_step, run_in_space
from ..space.lanes import measures_in_space
from ..space.rocking import rocking_stone
from .arrays import Records
from .block import SpaceBlock, Stack
from .found_start import found_start
from .kind import ALONE, CHIPPED, RING, SPECIMEN, Kind
from .links import link_fields
from .packing import chipped, drum_fields, joint_fields, lane_fields, pack_column
from .specimen import FreeBody, RockingSpecimen, pack_specimen, rows_for, top_frequency
from .stability import highest_frequency
from .verdict import numbers_for

#: Bending stiffness of a closed joint over k_n J, less 1: of each law of contact of round faces, and of corners.
LAWS = {"rim": 1.0, "bed": 0.0}
ON_CORNERS = 2.0

#: Energy of a joint of each law with its load on its edge.
TOES = {"rim": rim_toes, "bed": bed_toes, "corners": lambda column, kn: point_toes(column, kn, 0.25)}


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
    takes_start: ClassVar[bool] = True
    computes: ClassVar[tuple[type, ...]] = (*DRUMS, ConvexSolid, Glued)
    takes_as_found: ClassVar[bool] = True
    takes_rings: ClassVar[bool] = True
    varies_law: ClassVar[bool] = True
    takes_links: ClassVar[frozenset[str]] = LossyDrums.takes_links | {"clamp"}

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

    def run(self, column: Column, motion: Motion, options: RunOptions) -> Response:
        """One run with histories, of an assembly down to the ground; says what damping a restitution has led to."""
        if column.space_joints is not None:
            return self.told(column, motion, self.run_in_space(column, motion, options))
        response = self.told(column, motion, super().run(column, motion, options))
        if self.restitution is None:
            return response
        more = replace(self, restitution=None, time_step=None).stable_step(column) / self.stable_step(column)
        chosen = {"stiffness_damping_s": self.damping(column), "steps_over_undamped": more}
        return replace(response, provenance=response.provenance | chosen)

    def run_in_space(
        self, structure: Structure, motion: Motion, options: RunOptions, *, recorded: bool = True
    ) -> Response:
        """One run of an assembly in space; its histories are kept, wanted or not: the verdict rests on its ledger.

        Raises
        ------
        InputError
            A start, or something that its engine does not know, is asked for.
        """
        del recorded
        if options.start is not None:
            raise InputError(
                f"a start from a pose is for columns, and {structure.name!r} is {structure.described}; give its bodies "
                "orientations and velocities, and leave start out."
            )
        return run_in_space(structure, motion, self.spatial_numbers(structure), options)

    def run_many(self, cases: Sequence[Case], options: RunOptions, threads: int) -> Iterator[tuple[int, Measures]]:
        """Many runs in lanes, assemblies as long as nothing of them comes loose; never of columns too in one batch."""
        if len(cases) and cases[0].column.space_joints is not None:
            return measures_in_space(self.run_in_space, cases, self.spatial_numbers, options, threads)
        return super().run_many(cases, options, threads)

    def expected_step(self, column: Any, motion: Motion) -> tuple[float, float]:
        """Time step and its cost [s]; of an assembly as long as it stands."""
        if column.space_joints is None:
            return super().expected_step(column, motion)
        return expected_step(column, self.spatial_numbers(column))

    def spatial_numbers(self, structure: Structure) -> SpatialNumbers:
        """What an assembly in space is computed with."""
        damping = self.acting(structure).stiffness_damping
        return SpatialNumbers(self.name, damping, self.step_factor, self.time_step, self.restitution)

    def rocking(self, structure: Any) -> Rocking:
        """How single bodies of a structure rock in the engine that computes it."""
        if structure.space_joints is not None:
            return rocking_stone
        return super().rocking(structure) if structure.stack is not None else RockingSpecimen(structure.restitution)

    def _check_assembly(self, structure: Structure, motion: Motion) -> None:
        del motion
        defaults = DistinctElement3D()
        unknown = ("law", "pivot_friction", "rolling_resistance", "planar", "block_modulus", "mass_damping")
        given = next((name for name in unknown if getattr(self, name) != getattr(defaults, name)), None)
        if given is not None:
            raise InputError(
                f"{given} is {getattr(self, given)!r}, which assemblies in space such as {structure.name!r} do not know; "
                "leave it out."
            )

    def check_length(self, column: Any, motion: Motion, options: RunOptions) -> None:
        """As of all models; the step of what may come loose is known once its contacts are: each run asks for itself."""
        if column.space_joints is None:
            super().check_length(column, motion, options)

    def as_followed(self, structure: Any) -> Any:
        """An assembly as it is, a column as one of its drums: any two bodies may strike each other."""
        if structure.space_joints is not None:
            return structure
        return super().as_followed(structure) if structure.stack is None else SpatialAssembly.of_column(structure.stack)

    def carried(self, column: Any) -> int:
        """How many are taken along: what may come loose is alone in its lane."""
        return 0 if column.space_joints is not None else super().carried(column)

    def check(self, column: Any, motion: Motion) -> None:
        """Refuse joints too soft, what is found that space does not know, and a step unstable or too long for the motion."""
        if column.space_joints is not None:
            super().check(column, motion)
            self._check_assembly(column, motion)
            return
        if self.rolling_resistance and column.section != "circular":
            raise InputError(
                f"rolling_resistance = {self.rolling_resistance:g} is for round drums, and {column.name!r} has corners; "
                "leave it out."
            )
        super().check(column, motion)
        (self._check_stack if column.stack is not None else self._check_body)(column, motion)

    def _check_stack(self, column: Column, motion: Motion) -> None:
        del motion
        law = self.acting(column).law
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
        if self.planar and not column.as_found.in_plane:
            raise InputError(
                f"planar = True holds the motion in the plane of x and z, and {column.name!r} is found out of it; "
                "leave one of the two out."
            )

    def _check_body(self, body: Specimen, motion: Motion) -> None:
        if self.planar:
            raise InputError(f"planar is on, and a specimen such as {body.name!r} moves in space; leave it off.")
        if self.restitution is not None:
            raise InputError(
                f"restitution is given, and that of a specimen such as {body.name!r} depends on the side it falls to; "
                "give it to the specimen (restitution of a vertex), or give stiffness_damping."
            )
        chosen_step(self.stable_step(body), self.step_factor, self.time_step, f"{body.name!r}")
        check_step_resolves(self.time_step, motion)

    # -- what a block of lanes needs -----------------------------------------------------------------------------

    def opening(self, column: Column) -> Opening | None:
        """What rocks a column on the law of its joints; not a single body on vertices."""
        if column.stack is None:
            return None
        kn = joint_stiffnesses(column, self.block_modulus)[0]
        return opening(column, kn, self.acting(column).law if column.section == "circular" else "corners")

    def kind(self, column: Any) -> Kind:
        """Columns of one kind share blocks of lanes; specimens with as many rows."""
        if column.stack is None:
            return Kind(ALONE, SPECIMEN, rows_for(column), self.law, True, self.rolling_resistance > 0.0)
        section = RING if column.on_rings else CHIPPED if chipped(column) else column.section
        how = self.acting(column)
        return Kind(Topology.of(column), section, column.n, how.law, how.damped, how.rolling_resistance > 0.0)

    def kernel(self) -> Any:
        """Module of kernels."""
        return importlib.import_module("...kernels.dem3d.step", __package__)

    def pack(self, column: Any) -> Packed:
        """A column or a specimen as the kernel wants it."""
        return (_pack_specimen if column.stack is None else _pack)(column, self.acting(column))

    def records(self, kind: Kind, lanes: int = LANES) -> Records:
        """Empty records of the kernel for what is of a kind."""
        return Records(self.kernel(), kind.record_types(bool(kind.topology.links), lanes), kind.topology, kind.rows)

    def stable_step(self, column: Any) -> float:
        """Largest stable time step of the closed column [s]."""
        if column.stack is None:
            return stable_step(top_frequency(column), self.acting(column).stiffness_damping)
        return _stable_step(column, self.acting(column))

    def block_for(self, kind: Kind, options: RunOptions, lanes: int = LANES) -> SpaceBlock:
        """A block of lanes for what is of a kind."""
        if kind.section == SPECIMEN:
            return SpaceBlock(self.records(kind), FreeBody(), self.pack, options, self.cost(kind.rows // 32))
        bodies, cost = Stack(planar=self.planar, pivots=self.pivot_friction < 1.0), self.cost(kind.rows)
        return SpaceBlock(self.records(kind, lanes), bodies, self.pack, options, cost, planar=self.planar)

    def cost(self, drums: int) -> float:
        """About what a step of a single run costs on one core [s]."""
        return (8.3 if self.damped else 5.5) * super().cost(drums)


@lru_cache(maxsize=256)
def _pack_specimen(specimen: Specimen, model: DistinctElement3D) -> Packed:
    damping = model.stiffness_damping, model.mass_damping
    step = chosen_step(model.stable_step(specimen), model.step_factor, model.time_step, f"{specimen.name!r}")
    return pack_specimen(model.records(model.kind(specimen)), specimen, damping, step)


@lru_cache(maxsize=4096)
def _pack(column: Column, model: DistinctElement3D) -> Packed:
    kn, ks = joint_stiffnesses(column, model.block_modulus)
    closure = column.joint_weights / (kn * column.joint_areas)
    drums, joints = drum_fields(column, closure), joint_fields(column, kn, ks)
    options = model.pivot_friction, model.planar, model.rolling_resistance
    lane = lane_fields(column, damping_rows(model.damped, model.damping(column), model.mass_damping), *options)
    kind = model.kind(column)
    if column.as_found or column.pretensioned:
        found, friction = found_start(
            column, model.kernel(), kind.record_types(linked=False), (drums, joints, lane), closure
        )
        drums, joints = drums | found, joints | friction
    links, top = link_fields(column, drums), Stack(planar=model.planar).top
    numbers = pack_column(model.records(kind), column, (drums, joints, lane), links, top)
    law = model.law if column.section == "circular" else "corners"
    stand = numbers_for(column, TOES[law](column, kn * shares_left(column)))
    return Packed(numbers, bonds(column), model.step_for(column), column.joint_widths, column.lowest_barrier, stand)


@lru_cache(maxsize=4096)
def _stable_step(column: Column, model: DistinctElement3D) -> float:
    kn, ks = joint_stiffnesses(column, model.block_modulus)
    share = LAWS[model.law] if column.section == "circular" else ON_CORNERS
    return stable_step(
        *with_links(link_stiffness(column), highest_frequency(column, kn, ks, share), model.damping(column))
    )
