"""A ruin: what stands there as it was built, what is seen of it now, and what shaking it may have been."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from stylobate.column.structure import Structure
from stylobate.errors import (
    InputError,
    as_typed,
    check_all,
    check_choice,
    check_kind,
    check_range,
    check_whole,
    suggest,
)
from stylobate.models.base import Model

from .prior import MOST, Prior
from .survival import Outlasted

#: What may have become of a column; of the last two nothing follows for this earthquake.
STATES = ("stands", "fell", "fell before", "unknown")

#: Draws of the prior where no number is given.
USUAL_COUNT = 2000

#: Parameters of a model that are drawn, or follow from what is drawn.
DRAWN_OF_MODEL = ("law", "stiffness_damping", "losses", "restitution", "time_step")

#: Offsets may exceed the largest that there shall be by so many of their standard deviations.
BEYOND = 3.0


@dataclass(frozen=True)
class Observed:
    """What is seen of one column or assembly.

    Parameters
    ----------
    column : str
        Its name.
    state : {"stands", "fell", "fell before", "unknown"}
        ``fell before`` another earthquake or by another cause: nothing follows for this one.
    fell_towards : float, optional
        Azimuth of the fall, from x towards y [degrees].
    towards_sd : float, optional
        Its standard deviation [degrees], given with it.
    offsets : sequence of (joint, x, y, sd)
        Offset vectors of joints along x and y, and the standard deviation of each component [m]; joints by their number, 1
        at the base.
    twists : sequence of (joint, angle, sd)
        Twists of joints, from x towards y [degrees].
    no_slip_above : float, optional
        No joint is out of place by more than this [m].
    largest_slip : (length, sd), optional
        How far that joint is out of place that is so most, whichever it is, and the standard deviation [m].
    fell, stand : sequence of str
        Bodies of an assembly that have fallen, and that stand; of the others nothing is seen.
    moved : sequence of (body, x, y, sd)
        How far the centroids of bodies of an assembly that stand have moved along x and y, and the standard deviation of
        each component [m].

    Raises
    ------
    InputError
        A number that is not allowed, or observations that contradict one another.
    """

    column: str
    state: str = "unknown"
    fell_towards: float | None = None
    towards_sd: float | None = None
    offsets: Sequence[tuple[int, float, float, float]] = ()
    twists: Sequence[tuple[int, float, float]] = ()
    no_slip_above: float | None = None
    largest_slip: tuple[float, float] | None = None
    fell: Sequence[str] = ()
    stand: Sequence[str] = ()
    moved: Sequence[tuple[str, float, float, float]] = ()

    def __post_init__(self) -> None:
        check_choice("`state`", self.state, STATES, field="state")
        self._check_bodies()
        slips = ("offsets", "twists", "no_slip_above", "largest_slip")
        given = [name for name in slips if getattr(self, name) not in (None, (), [])]
        if given and self.state != "stands":
            raise InputError(
                f"state is {self.state!r}, and a slip or a twist is given: what fell has none; leave them out, or give "
                "state = 'stands'.",
                given[0],
            )
        if self.state != "fell" and (self.fell_towards is not None or self.towards_sd is not None):
            raise InputError(
                f"state is {self.state!r}, and fell_towards is given; leave it out, or give state = 'fell'.",
                "fell_towards",
            )
        if (self.towards_sd is None) != (self.fell_towards is None):
            present, other = ("fell_towards", "towards_sd")[:: 1 if self.towards_sd is None else -1]
            raise InputError(
                f"{present} is given without {other}; give both, such as fell_towards = 200 and towards_sd = 15 [degrees].",
                other,
            )
        if self.fell_towards is not None and self.towards_sd is not None:
            check_range("fell_towards", self.fell_towards, -360.0, 360.0, unit="degrees")
            check_range("towards_sd", self.towards_sd, 0.0, 90.0, unit="degrees", open_low=True)
        if self.no_slip_above is not None:
            check_range("no_slip_above", self.no_slip_above, 0.0, 100.0, unit="m", open_low=True)
        for name, numbers in (("offsets", 4), ("twists", 3)):
            rows = tuple(tuple(row) for row in getattr(self, name))
            for row in rows:
                self._check_row(name, row, numbers)
            joints = [row[0] for row in rows]
            if twice := next((joint for joint in joints if joints.count(joint) > 1), None):
                raise InputError(f"joint {twice} is given twice in `{name}`; give each joint once.", name)
            object.__setattr__(self, name, rows)
        self._check_slips()

    def _check_slips(self) -> None:
        """Refuse a largest slip that is none, and a joint that is farther out of place than it or the bound."""
        slips = [(f"joint {joint} is", math.hypot(x, y), sd) for joint, x, y, sd in self.offsets]
        bounds, largest = [], self.largest_slip
        if largest is not None:
            if not isinstance(largest, (list, tuple)) or len(largest) != 2:
                words = "a length and its sd, such as [0.1, 0.01]"
                raise InputError(f"largest_slip is {as_typed(largest)}; allowed are {words}.", "largest_slip")
            length = check_range("largest_slip", largest[0], 0.0, 100.0, unit="m")
            sd = check_range(
                "sd of largest_slip", largest[1], 0.0, 100.0, unit="m", open_low=True, field="largest_slip"
            )
            object.__setattr__(self, "largest_slip", (length, sd))
            bounds = [("largest_slip", length, sd, slips)]
            slips = [*slips, ("a joint is", length, sd)]
        if self.no_slip_above is not None:
            bounds.append(("no_slip_above", self.no_slip_above, 0.0, slips))
        for name, bound, doubt, seen in bounds:
            for words, length, sd in seen:
                if length > bound + BEYOND * math.hypot(doubt, sd):
                    raise InputError(
                        f"{words} {1e3 * length:.3g} mm out of place, and {name} is {1e3 * bound:.3g} mm; one of the two "
                        "is wrong.",
                        name,
                    )

    def _check_bodies(self) -> None:
        """Refuse bodies that contradict one another or the state; what has fallen tells the state, what has moved stands."""
        fell, stand = ([*check_all(name, getattr(self, name), str)] for name in ("fell", "stand"))
        if (fell or stand or self.moved) and self.state not in ("fell", "unknown"):
            raise InputError(
                f"state is {self.state!r}, and bodies are named: where all stand, leave the names out; where some have "
                "fallen, leave the state out.",
                "state",
            )
        rows: tuple[Any, ...] = tuple(tuple(row) for row in self.moved)
        for row in rows:
            if len(row) != 4 or not isinstance(row[0], str):
                layout = "body, x, y and sd, such as ['lintel', 0.031, -0.012, 0.003]"
                raise InputError(f"a row of moved is {as_typed(list(row))}; allowed are {layout}.", "moved")
            for value in row[1:-1]:
                check_range("a number of moved", value, -1e3, 1e3, unit="m", field="moved")
            check_range("sd of a row of moved", row[-1], 0.0, 1e3, unit="m", open_low=True, field="moved")
        moved = [row[0] for row in rows]
        for name, bodies in (("fell", fell), ("stand", stand), ("moved", moved)):
            if twice := next((body for body in bodies if bodies.count(body) > 1), None):
                raise InputError(f"{twice!r} is twice in `{name}`; name each body once.", name)
        for name, bodies in (("stand", stand), ("moved", moved)):
            if both := next((body for body in bodies if body in fell), None):
                raise InputError(f"{both!r} is in fell and in `{name}`; one of the two is wrong.", name)
        object.__setattr__(self, "moved", rows)
        object.__setattr__(self, "fell", tuple(fell))
        object.__setattr__(self, "stand", tuple(dict.fromkeys([*stand, *moved])))
        object.__setattr__(self, "state", "fell" if fell else self.state)

    @staticmethod
    def _check_row(name: str, row: tuple, numbers: int) -> None:
        example = "[2, 0.031, -0.012, 0.003]" if numbers == 4 else "[2, 4.0, 1.0]"
        if len(row) != numbers:
            layout = "joint, x, y and sd" if numbers == 4 else "joint, angle and sd"
            raise InputError(f"a row of `{name}` is {list(row)}; allowed are {layout}, such as {example}.", name)
        check_whole(f"joint of a row of `{name}`", row[0], 1, remedy="1 is at the base", field=name)
        limit, unit = (100.0, "m") if numbers == 4 else (360.0, "degrees")
        for value in row[1:-1]:
            check_range(f"a number of `{name}`", value, -limit, limit, unit=unit, field=name)
        check_range(f"sd of a row of `{name}`", row[-1], 0.0, limit, unit=unit, open_low=True, field=name)


@dataclass(frozen=True)
class Fact:
    """One thing that is seen.

    Parameters
    ----------
    structure : int
        Number of what it is seen of, among those that are simulated.
    kind : {"state", "body", "no slip above", "largest", "fell towards", "offset", "moved", "twist"}
    label : str
        In words.
    value : tuple of float
        Of a state, of the whole or of a body, 1 for fell, 0 for stands.
    sd : float
        Standard deviation of each value; 0 of what is told apart without one.
    joint : int
        From 0; of a body its place among those that can move.
    """

    structure: int
    kind: str
    label: str
    value: tuple[float, ...]
    sd: float = 0.0
    joint: int = 0


@dataclass(frozen=True, eq=False)
class Ruin:
    """Structures of one site, what is seen of them, and what may have shaken them.

    Parameters
    ----------
    structures : sequence of Column or SpatialAssembly
        As they were built.
    observed : sequence of Observed
    prior : Prior
    simulations : int
        Draws of the prior.
    seed : int
    model : Model
        In space.
    survival : Outlasted, optional
        Since when it has stood, and how often shaking comes.

    Raises
    ------
    InputError
        A column or a joint that is not there, one that is seen twice, a slip beyond a drum; what cannot vary, and a model
        that states what is drawn.
    """

    structures: Sequence[Structure]
    observed: Sequence[Observed]
    prior: Prior
    simulations: int = USUAL_COUNT
    seed: int = 0
    model: Model = field(default_factory=lambda: _usual_model())
    survival: Outlasted | None = None

    def __post_init__(self) -> None:
        structures = tuple(check_all("structures", self.structures, Structure))
        observed = tuple(check_all("observed", self.observed, Observed))
        check_kind("prior", self.prior, Prior)
        check_kind("model", self.model, Model)
        check_kind("survival", self.survival, Outlasted, optional=True)
        check_whole("simulations", self.simulations, 1, MOST)
        check_whole("`seed`", self.seed, 0, 2**31)
        usual = type(self.model)()
        refuse_drawn([name for name in DRAWN_OF_MODEL if getattr(self.model, name, 0) != getattr(usual, name, 0)])
        if alone := next((structure for structure in structures if not structure.scattered), None):
            raise InputError(
                f"{alone.name!r} is {alone.described}, and a ruin is of columns and assemblies in space; leave it out.",
                "columns",
            )
        names = [structure.name for structure in structures]
        if not names:
            raise InputError("the ruin names no column; give at least one in columns.", "columns")
        if twice := next((name for name in names if names.count(name) > 1), None):
            raise InputError(f"two columns are called {twice!r}; give each a name of its own.", "columns")
        seen = [observation.column for observation in observed]
        if twice := next((name for name in seen if seen.count(name) > 1), None):
            raise InputError(
                f"{twice!r} is observed twice; put all that is seen of it into one [[observed]].", "column"
            )
        for observation in observed:
            if observation.column not in names:
                raise InputError(
                    f"{observation.column!r} is observed, and is no column of the ruin; "
                    f"{suggest(observation.column, names)}known are {', '.join(names)}.",
                    "column",
                )
            self._check_joints(observation, structures[names.index(observation.column)])
            self._check_bodies(observation, structures[names.index(observation.column)])
        object.__setattr__(self, "structures", structures)
        object.__setattr__(
            self, "observed", tuple(sorted(observed, key=lambda observation: names.index(observation.column)))
        )

    @staticmethod
    def _check_joints(observation: Observed, structure: Structure) -> None:
        count = joints_of(structure)
        for name, row in [("offsets", row) for row in observation.offsets] + [
            ("twists", row) for row in observation.twists
        ]:
            if row[0] > count:
                raise InputError(
                    f"{name} name joint {row[0]}, and {observation.column!r} has {count} joint{'s' * (count > 1)}, counted "
                    "from the base.",
                    name,
                )
        column = structure.stack
        widths = [] if column is None else [float(width) for width in column.joint_widths]
        seen = [
            ("offsets", f"joint {joint}", math.hypot(x, y), range(joint - 1, joint))
            for joint, x, y, _ in observation.offsets
        ]
        if observation.largest_slip is not None:
            seen.append(("largest_slip", "a joint", observation.largest_slip[0], range(count)))
        for name, which, length, joints in seen if widths else ():
            width = max(widths[joint] for joint in joints)
            if length >= width:
                raise InputError(
                    f"{which} of {observation.column!r} is {length:.3g} m out of place, and {width:.3g} m wide: its drum "
                    "would have fallen; offsets are in metres.",
                    name,
                )

    @staticmethod
    def _check_bodies(observation: Observed, structure: Structure) -> None:
        named, known = (*observation.fell, *observation.stand), bodies_of(structure)
        if named and structure.stack is not None:
            raise InputError(
                f"bodies are named of {observation.column!r}, which is a column and falls as a whole; give its state.",
                "fell",
            )
        if unknown := next((name for name in named if name not in known), None):
            raise InputError(
                f"{unknown!r} is no body of {observation.column!r} that can move; {suggest(unknown, known)}known are "
                f"{', '.join(known)}.",
                "fell" if unknown in observation.fell else "stand",
            )

    @property
    def informative(self) -> list[Observed]:
        """Those of which something is seen that follows from this earthquake."""
        return [
            observation for observation in self.observed if observation.state in ("stands", "fell") or observation.stand
        ]

    @property
    def simulated(self) -> list[Structure]:
        """Structures of which something is seen."""
        by_name = {structure.name: structure for structure in self.structures}
        return [by_name[observation.column] for observation in self.informative]

    @property
    def facts(self) -> list[Fact]:
        """All that is seen, one by one."""
        facts: list[Fact] = []
        for i, (observation, structure) in enumerate(zip(self.informative, self.simulated, strict=True)):
            fell, name, bodies = observation.state == "fell", observation.column, bodies_of(structure)
            if observation.state != "unknown":
                facts.append(Fact(i, "state", f"{name} {observation.state}", (float(fell),)))
            for body in (*observation.fell, *observation.stand):
                down, number = body in observation.fell, bodies.index(body)
                label = f"{name}: {body} {'fell' if down else 'stands'}"
                facts.append(Fact(i, "body", label, (float(down),), joint=number))
            for body, x, y, sd in observation.moved:
                label = f"{name}: {body} moved by {1e3 * math.hypot(x, y):.3g} mm"
                facts.append(Fact(i, "moved", label, (x, y), sd, bodies.index(body)))
            if observation.no_slip_above is not None:
                bound = observation.no_slip_above
                facts.append(Fact(i, "no slip above", f"{name}: no slip above {1e3 * bound:.3g} mm", (bound,)))
            if observation.largest_slip is not None:
                length, sd = observation.largest_slip
                label = f"{name}: largest offset, {1e3 * length:.3g} mm"
                facts.append(Fact(i, "largest", label, (length,), sd))
            if observation.fell_towards is not None and observation.towards_sd is not None:
                label = f"{name} fell towards {observation.fell_towards:g}°"
                facts.append(Fact(i, "fell towards", label, (observation.fell_towards,), observation.towards_sd))
            for joint, x, y, sd in observation.offsets:
                label = f"{name}: offset of joint {joint}, {1e3 * math.hypot(x, y):.3g} mm"
                facts.append(Fact(i, "offset", label, (x, y), sd, joint - 1))
            for joint, angle, sd in observation.twists:
                facts.append(Fact(i, "twist", f"{name}: twist of joint {joint}, {angle:.3g}°", (angle,), sd, joint - 1))
        return facts


def bodies_of(structure: Structure) -> list[str]:
    """Names of what can move, in the order of residuals."""
    return [body.name for body in structure.bodies[structure.first :] if not body.fixed]


def joints_of(structure: Structure) -> int:
    """Number of its joints, as residuals count them."""
    return len(structure.joined_faces)


def refuse_drawn(stated: Sequence[str]) -> None:
    """Refuse parameters of a model that are drawn."""
    if stated:
        raise InputError(
            f"{stated[0]} is drawn with the motions, or follows from what is drawn; leave it out of the model, and give "
            "law and stiffness_damping as lists in [prior].",
            "set",
        )


def _usual_model() -> Any:
    from stylobate.models.registry import make_model

    return make_model("dem3d", {})
