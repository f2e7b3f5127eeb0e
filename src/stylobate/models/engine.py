"""What computes a structure with a model: an engine, chosen once, which says what it takes, carries, refuses and costs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from ..column import Column
from ..errors import InputError, LeftOutWarning, PlaneOnlyWarning, warn
from ..messages import joined, say
from ..motion import Motion, beyond_axes
from ..response import Measures, Response
from ..response.words import ROUND_IN_THE_PLANE
from .base import Case, Model, RunOptions, refuse_endless, refuse_long_histories

if TYPE_CHECKING:
    from .devices import Device

#: Larger accelerations are rejected as non-physical; numbers would overflow [m/s²].
LARGEST_ACCELERATION = 1e6


@dataclass(frozen=True)
class Engine:
    """Base of the engines: what it does not take is refused here.

    Class attributes: ``computes``, the kinds of structures; ``takes``, which of ``as found`` (structures that are not as
    built), ``rings`` (joints that carry on them) and ``start`` (one from a pose) it knows; ``links``, by which laws they may
    act; ``twins``, how many structures alike it takes along in a single run at next to no cost.

    Parameters
    ----------
    model : Model
    structure : Structure
        Of one of the kinds that it computes.
    """

    computes: ClassVar[tuple[type, ...]] = (Column,)
    takes: ClassVar[frozenset[str]] = frozenset()
    links: ClassVar[frozenset[str]] = frozenset()
    twins: ClassVar[int] = 0

    model: Any
    structure: Any

    @classmethod
    def computes_for(cls, model: Any, structure: Any) -> bool:
        """Whether it computes a structure with a model."""
        del model
        return isinstance(structure, cls.computes)

    # -- what it refuses -----------------------------------------------------------------------------------------------

    def check(self, motion: Motion) -> None:
        """Refuse (InputError) or warn (OutOfRangeWarning) before anything is computed."""
        structure, name, axes = self.structure, self.model.name, self.model.axes
        if "as found" not in self.takes:
            structure.must_be_as_built(name)
        elif "y" not in axes and not structure.as_found.in_plane:
            raise InputError(
                f"{name} computes the plane of x and z, and {structure.name!r} is found out of it "
                "(an azimuth other than 0 and 180, or a turn); use dem3d, project it onto a plane (`project=AZIMUTH`), or "
                "leave these out."
            )
        if "rings" not in self.takes:
            structure.must_carry_on_whole_faces(name)
        structure.must_link_by(self.links, name)
        for axis, peak in motion.peaks.items():
            if not peak <= LARGEST_ACCELERATION:
                raise InputError(
                    f"the component {axis} of {motion.name!r} reaches {peak:.3g} m/s²; allowed is up to "
                    f"{LARGEST_ACCELERATION:g} m/s²: check its unit and its factor."
                )
        left_out = beyond_axes(motion, axes)
        if "y" in left_out and structure.section == "circular":
            warn(ROUND_IN_THE_PLANE, PlaneOnlyWarning)
        for component in left_out.values():
            takes = say("left out of {motion!r}: {what}; {model} takes {axes}.")
            axes_ = joined(say(" and "), axes)
            warn(takes.of(motion=motion.name, what=component, model=name, axes=axes_), LeftOutWarning)

    def check_start(self) -> None:
        """Refuse a start from a pose."""
        if "start" not in self.takes:
            raise InputError(
                f"{self.model.name} starts from rest; leave start out, or use dem2d or dem3d (DistinctElement2D, 3D)."
            )

    def check_length(self, motion: Motion, options: RunOptions) -> None:
        """Refuse a run that would not end, and histories that no memory holds, with the estimate (InputError)."""
        length = motion.duration + options.tail
        step, cost = self.expected_step(motion)
        refuse_endless(f"{self.structure.name!r} under {motion.name!r}", length, step, cost)
        refuse_long_histories(length / options.output_interval, self.structure.n)

    def followed(self) -> Any:
        """The structure in the form in which a run that goes on until everything lies still computes it.

        Raises
        ------
        InputError
            No collapse of it is followed to the ground.
        """
        what = self.structure.described
        raise InputError(
            f"`until_rest` is on, and {self.model.name} does not follow how {what} comes down; use dem2d or dem3d for "
            "columns and assemblies, or leave it off: `tail` and `until_end` are for every model.",
            "until_rest",
        )

    # -- what it knows of twins ----------------------------------------------------------------------------------------

    @property
    def not_scattered(self) -> tuple[str, ...]:
        """Parts of a :class:`~stylobate.column.scatter.Scatter` that change nothing in its runs, by name."""
        return () if "as found" in self.takes else ("offset",)

    @property
    def draws_laws(self) -> bool:
        """Whether structures may have losses and laws of joints of their own."""
        return False

    @property
    def paced(self) -> Model:
        """The model that computes structures like this one beside it: in its time step, where that may be chosen."""
        return self.model

    # -- what it costs -------------------------------------------------------------------------------------------------

    def expected_step(self, motion: Motion) -> tuple[float, float]:
        """Time step that a run will take, and about what a step costs on one core, both [s]; the cost of a single run."""
        return motion.dt, 0.0

    def expected_time(self, motion: Motion, options: RunOptions, *, alone: bool) -> float:
        """About how long a run takes on one core [s]; 0 where that is not known, as of one of a batch that is not stepped as
        single runs are (``alone``)."""
        step, cost = self.expected_step(motion) if alone else (1.0, 0.0)
        return cost * (motion.duration + options.tail) / step

    # -- runs ----------------------------------------------------------------------------------------------------------

    def run(self, motion: Motion, options: RunOptions) -> Response:
        """One run with histories."""
        raise NotImplementedError

    def run_many(self, cases: Sequence[Case], options: RunOptions, threads: int) -> Iterator[tuple[int, Measures]]:
        """Many runs, the first one of this structure; yields (index of the case, measures) as they finish, in any order."""
        raise NotImplementedError

    def on_card(self, device: Device) -> bool:
        """Whether a graphics card steps runs of the structure."""
        del device
        return False

    def run_on_card(
        self, device: Device, cases: Sequence[Case], options: RunOptions, threads: int
    ) -> Iterator[tuple[int, Measures]]:
        """As :meth:`run_many`, where a graphics card steps what it has kernels for, and threads the rest; all of it here."""
        del device
        return self.run_many(cases, options, threads)


def engine_for(model: Model, structure: Any) -> Any:
    """The engine that computes a structure with a model; here it is chosen, and nowhere else.

    Raises
    ------
    InputError
        The model computes no structures of this kind.
    """
    for engine in model.engines:
        if engine.computes_for(model, structure):
            return engine(model, structure)
    raise InputError(
        f"{model.name} cannot shake {structure.name!r}, which is {structure.described}; {structure.computed_by}."
    )
