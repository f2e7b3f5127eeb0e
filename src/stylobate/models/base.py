"""Base of models: a frozen set of parameters; cases that are run with them, and how."""

from __future__ import annotations

import dataclasses
import typing
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

from ..errors import InputError, suggest
from ..motion import Motion, keep_axes
from .start import Start, Toss

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


def given_back(model: Any) -> float:
    """The same of a model: as stated, or what there is by default [-]."""
    return RESTITUTION if model.restitution is None else model.restitution


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
        Pose and velocity at the start, instead of rest (engines of columns that are stepped, and of specimens).
    quiet : float
        Share of what opens a joint below which the lead-in and the end of a motion are not stepped (models of drums; see
        ``models/shared/ground.py``); 0 steps the whole motion [-].
    twins : tuple of Column
        Columns under the same motion in the other lanes of a single run (engines with ``twins``, as many at most).
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
    takes, ``xz`` in a plane; ``engines``, the kinds of :class:`~stylobate.models.engine.Engine` that compute it, each for
    structures of its own kinds.
    """

    wanted: ClassVar[str] = "a model, such as DistinctElement2D()"
    name: ClassVar[str] = ""
    version: ClassVar[str] = ""
    title: ClassVar[str] = ""
    references: ClassVar[tuple[str, ...]] = ()
    assumptions: ClassVar[tuple[str, ...]] = ()
    limits: ClassVar[tuple[str, ...]] = ()
    axes: ClassVar[str] = "xz"
    engines: ClassVar[tuple[Any, ...]] = ()

    @classmethod
    def is_plane(cls, parameters: Mapping[str, Any]) -> bool:
        """Whether a model of this kind, with these parameters, lets what stands move in one plane only."""
        return "y" not in cls.axes or bool(parameters.get("planar", False))

    def taken(self, motion: Motion) -> Motion:
        """The components of a motion that the model takes; what it leaves out is said in ``metadata["left_out"]``."""
        return keep_axes(motion, self.axes)

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
