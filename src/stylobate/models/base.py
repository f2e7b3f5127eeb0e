"""Base of models: a frozen set of parameters that can run one case or many."""

from __future__ import annotations

import dataclasses
import typing
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

from ..column.shapes import DRUMS
from ..errors import InputError, LeftOutWarning, PlaneOnlyWarning, suggest, warn
from ..messages import joined, say
from ..motion import Motion, beyond_axes, keep_axes
from ..response import Measures, Response
from ..response.words import round_in_the_plane
from .start import Start, Toss

if TYPE_CHECKING:
    from .devices import Device

#: Larger accelerations are rejected as non-physical; numbers would overflow [m/s²].
LARGEST_ACCELERATION = 1e6

#: Longest run, by the estimate [s], and most states times bodies of its histories.
LONGEST_RUN, MOST_STATES = 3600.0, 5e7


class Case(NamedTuple):
    """One run of a batch: what stands, and what shakes it."""

    column: Any
    motion: Motion

    @property
    def multiplied(self) -> Case:
        """The case with the factor of its motion in the samples: what is stepped is what a file of the motion holds."""
        return self._replace(motion=self.motion.multiplied)


class Cases(Sequence[Any]):
    """Cases that are made when they are asked for, so that there may be millions of them.

    Parameters
    ----------
    count : int
    make : callable
        The case of a number from 0 to ``count`` − 1.
    """

    def __init__(self, count: int, make: Callable[[int], Case]) -> None:
        self.length, self.make = count, make

    def __len__(self) -> int:
        return self.length

    def __getitem__(self, index: Any) -> Any:
        if not 0 <= index < self.length:
            raise IndexError(index)
        return self.make(index)


#: Share of the closing speed that bodies which no joint holds give back, where the model says nothing else [-].
RESTITUTION = 0.3


@dataclass(frozen=True)
class RunOptions:
    """Length and closeness of a run; the same for every model.

    Parameters
    ----------
    tail : float
        Time to go on after the motion has ended [s].
    output_interval : float
        Wanted time between recorded states of a single run [s]; the nearest multiple of the step is used.
    until_end : bool
        Go on after a collapse is certain.
    until_rest : bool
        Go on after the motion until everything lies still (models that follow a collapse to the ground).
    until_decided : bool
        Go on after motion and tail, a minute at most: columns of models that step drums as long as they move and their
        verdict could change, assemblies as long as nothing has fallen and not all lies still.
    start : Start or Toss, optional
        Pose and velocity at the start, instead of rest (models with ``takes_start``).
    quiet : float
        Share of what opens a joint below which the lead-in and the end of a motion are not stepped (models of drums; see
        ``models/shared/quiet.py``); 0 steps the whole motion [-].
    twins : tuple of Column
        Columns under the same motion in the other lanes of a single run (models with ``carries``, as many at most).
    progress : callable, optional
        Called with (time so far, time of the whole run) [s] at every recorded state of a single run, by models of drums and
        for assemblies.
    """

    tail: float = 0.0
    output_interval: float = 0.01
    until_end: bool = False
    until_rest: bool = False
    until_decided: bool = False
    start: Start | Toss | None = None
    quiet: float = 0.0
    twins: tuple[Any, ...] = ()
    progress: Callable[[float, float], None] | None = None


@dataclass(frozen=True)
class Model:
    """Base of the models. A subclass is a frozen dataclass of parameters, checked where it is made.

    Class attributes: ``name`` as on the command line; ``version`` of a model of somebody else, another whenever its
    results change, because finished runs of an equal version are not computed again; ``title`` for people; ``references``
    as keys of the bibliography; ``assumptions`` and ``limits`` in sentences; ``axes`` of the ground motion that the model
    takes, ``xz`` in a plane; ``computes`` the shapes of bodies that it knows, ``takes_as_found`` whether it computes
    columns that are not as built, ``takes_start`` whether it can start from a pose, ``takes_rings`` whether joints may
    carry on rings, ``takes_links`` by which laws links may act; ``carries`` how many columns alike it can take along in a
    single run at next to no cost; ``varies_law`` whether columns may have losses and laws of joints of their own.
    """

    wanted: ClassVar[str] = "a model, such as DistinctElement2D()"
    name: ClassVar[str] = ""
    version: ClassVar[str] = ""
    title: ClassVar[str] = ""
    references: ClassVar[tuple[str, ...]] = ()
    assumptions: ClassVar[tuple[str, ...]] = ()
    limits: ClassVar[tuple[str, ...]] = ()
    axes: ClassVar[str] = "xz"
    computes: ClassVar[tuple[type, ...]] = DRUMS
    takes_as_found: ClassVar[bool] = False
    takes_start: ClassVar[bool] = False
    takes_rings: ClassVar[bool] = False
    takes_links: ClassVar[frozenset[str]] = frozenset()
    carries: ClassVar[int] = 0
    varies_law: ClassVar[bool] = False

    @property
    def not_scattered(self) -> tuple[str, ...]:
        """Parts of a :class:`~stylobate.column.scatter.Scatter` that change nothing in its runs, by name."""
        return () if self.takes_as_found else ("offset",)

    def check(self, column: Any, motion: Motion) -> None:
        """Refuse (InputError) or warn (OutOfRangeWarning) before anything is computed."""
        column.must_consist_of(self.computes, self.name)
        if not self.takes_as_found:
            column.must_be_as_built(self.name)
        elif "y" not in self.axes and not column.as_found.in_plane:
            raise InputError(
                f"{self.name} computes the plane of x and z, and {column.name!r} is found out of it "
                "(an azimuth other than 0 and 180, or a turn); use dem3d, project it onto a plane (`project=AZIMUTH`), or "
                "leave these out."
            )
        if not self.takes_rings:
            column.must_carry_on_whole_faces(self.name)
        column.must_link_by(self.takes_links, self.name)
        for axis, peak in motion.peaks.items():
            if not peak <= LARGEST_ACCELERATION:
                raise InputError(
                    f"the component {axis} of {motion.name!r} reaches {peak:.3g} m/s²; allowed is up to "
                    f"{LARGEST_ACCELERATION:g} m/s²: check its unit and its factor."
                )
        left_out = beyond_axes(motion, self.axes)
        if "y" in left_out and column.section == "circular":
            left = say("{model} leaves out what shakes a round column across.", model=self.name)
            said = joined(" ", [left, round_in_the_plane(column)])
            warn(said, PlaneOnlyWarning)
        for one in left_out.values():
            takes = say("left out of {motion!r}: {what}; {model} takes {axes}.", motion=motion.name, what=one, model=self.name,
                        axes=joined(say(" and "), self.axes))  # fmt: skip
            warn(takes, LeftOutWarning)

    @classmethod
    def is_plane(cls, parameters: Mapping[str, Any]) -> bool:
        """Whether a model of this kind, with these parameters, lets what stands move in one plane only."""
        return "y" not in cls.axes or bool(parameters.get("planar", False))

    def taken(self, motion: Motion) -> Motion:
        """The components of a motion that the model takes; what it leaves out is said in ``metadata["left_out"]``."""
        return keep_axes(motion, self.axes)

    def as_followed(self, structure: Any) -> Any:
        """What stands, in the form in which a run that goes on until everything lies still computes it.

        Raises
        ------
        InputError
            The model follows no collapse of it to the ground.
        """
        raise InputError(
            f"`until_rest` is on, and {self.name} does not follow how {structure.described} comes down; use dem2d or dem3d "
            "for columns and assemblies, or leave it off: `tail` and `until_end` are for every model.",
            "until_rest",
        )

    def carried(self, column: Any) -> int:
        """Number of twins along a run of what stands."""
        del column
        return self.carries

    def paced(self, column: Any) -> Model:
        """The model that computes columns like this one beside it: in its time step, where that is the model's to choose."""
        return self

    def expected_step(self, column: Any, motion: Motion) -> tuple[float, float]:
        """Time step that a run will take, and about what a step costs on one core, both [s]; the cost of a single run."""
        return motion.dt, 0.0

    def check_length(self, column: Any, motion: Motion, options: RunOptions) -> None:
        """Refuse a run that would not end, and histories that no memory holds, with the estimate (InputError)."""
        length = motion.duration + options.tail
        step, cost = self.expected_step(column, motion)
        refuse_endless(f"{column.name!r} under {motion.name!r}", length, step, cost)
        refuse_long_histories(length / options.output_interval, column.n)

    def run(self, column: Any, motion: Motion, options: RunOptions) -> Response:
        """One run with histories."""
        raise NotImplementedError

    def run_many(self, cases: Sequence[Case], options: RunOptions, threads: int) -> Iterator[tuple[int, Measures]]:
        """Many runs; yields (index of the case, measures) as they finish, in any order."""
        raise NotImplementedError

    def run_on_card(
        self, device: Device, cases: Sequence[Case], options: RunOptions, threads: int
    ) -> Iterator[tuple[int, Measures]]:
        """As :meth:`run_many`, where a graphics card steps what it has kernels for, and threads the rest; all of it here."""
        del device
        return self.run_many(cases, options, threads)

    def on_card(self, device: Device, column: Any) -> bool:
        """Whether a graphics card steps runs of what stands."""
        del device, column
        return False

    def parameters(self) -> dict[str, Any]:
        """All parameters as plain values, for provenance."""
        return dataclasses.asdict(self)

    @classmethod
    def from_settings(cls, settings: Mapping[str, str]) -> Model:
        """Make the model from texts, such as ``points`` and ``3``.

        Raises
        ------
        InputError
            An unknown name, or a value that is not of the parameter's type.
        """
        hints = typing.get_type_hints(cls)
        allowed = [f.name for f in dataclasses.fields(cls)]
        values = {}
        for key, text in settings.items():
            if key not in allowed:
                known = ", ".join(allowed) or "none"
                raise InputError(
                    f"{cls.name} has no parameter {key!r}; {suggest(key, allowed)}parameters are {known}.", key
                )
            values[key] = _parse(key, text, hints[key])
        return cls(**values)


def refuse_endless(what: str, length: float, step: float, cost: float) -> None:
    """Refuse a run of a length in steps of a length [s] that cost so much each [s], if it takes more than an hour."""
    steps = length / step
    if steps * cost > LONGEST_RUN:
        raise InputError(
            f"a run of {what} would take {steps:.2g} steps of {step:.2g} s, about {duration(steps * cost)}; allowed is up "
            f"to {duration(LONGEST_RUN)}: lower the joints' stiffness, take fewer bodies, a larger time_step, or less time."
        )


def refuse_long_histories(states: float, bodies: int) -> None:
    """Refuse histories of so many states of so many bodies, if there are more than any memory holds."""
    if states * bodies > MOST_STATES:
        raise InputError(
            f"the histories would hold {states:.2g} states of {bodies} bodies; allowed is up to {MOST_STATES:.0e} "
            "together: give a longer output interval, or less time."
        )


def duration(seconds: float) -> str:
    """A time of computing for people."""
    for name, size in (("years", 3.15576e7), ("days", 86400.0), ("hours", 3600.0)):
        if seconds >= 2.0 * size:
            return f"{seconds / size:.2g} {name}"
    return f"{seconds / 60.0:.0f} minutes" if seconds >= 100.0 else f"{seconds:.2g} s"


#: What the text of a parameter must be, by pydantic's name of the mistake.
_EXPECTED = {"bool_parsing": "true or false", "int_parsing": "a whole number", "int_from_float": "a whole number",
             "float_parsing": "a number"}  # fmt: skip


def _parse(key: str, text: str, hint: Any) -> Any:
    from pydantic import TypeAdapter, ValidationError

    if type(None) in typing.get_args(hint) and text.lower() in ("none", "auto", ""):
        return None
    try:
        return TypeAdapter(hint).validate_python(text)
    except ValidationError as error:
        mistakes = error.errors()
    expected = next(
        (_EXPECTED[mistake["type"]] for mistake in mistakes if mistake["type"] in _EXPECTED), mistakes[0]["msg"]
    )
    raise InputError(f"parameter {key} is {text!r}; allowed is {expected}.", key, value=text, allowed=expected)
