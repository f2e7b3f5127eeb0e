"""Measures of a run, each declared once: the same facts, under the same names, for every model, single run or batch.

A measure is a field that :func:`measure` declares. Rows, JSON, tables, files, limit states, lines of the command line,
the page and the report read the declarations; a new one is declared here and computed by an engine.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from functools import cache
from numbers import Integral
from typing import Any

from ..messages import say
from ..outcome import Outcome
from .collapse import Collapse
from .links import LinkMeasures, row_of
from .residuals import Residuals, no_residuals

#: Kinds of devices that compute runs, the usual one first.
DEVICES = CPU, GPU = "cpu", "gpu"

#: What a measure is of: the top of a column, bodies, joints, the run, or the way it was computed.
TOP, BODY, JOINT, RUN, STEPS = "top", "body", "joint", "run", "steps"


@dataclass(frozen=True)
class Measure:
    """Declaration of a measure.

    Its name begins with ``peak_`` for the largest value of a run, up to a collapse, and with ``residual_`` for the value at
    the end, which what has fallen does not have.

    Parameters
    ----------
    field : str
        Attribute of the class that declares it.
    of : str
        ``top`` (which only columns have), ``body``, ``joint``, ``run`` or ``steps``.
    unit : str
        ``m``, ``rad`` or ``s``; empty for a share or a number.
    meaning : str
        What it is, for whoever reads a file.
    label, phrase : str
        Its name beside a value, in short and in a report; empty where it is not shown beside others.
    spread : bool
        Whether percentiles of it are given over columns like one.
    short : str
        Its short name in limit states.
    missing : float or None
        What a row has where it is not known.
    """

    field: str
    of: str
    unit: str = ""
    meaning: str = ""
    label: str = ""
    phrase: str = ""
    spread: bool = False
    short: str = ""
    missing: float | None = math.nan

    @property
    def key(self) -> str:
        """Its name in rows, JSON, tables and attributes of files: with the unit."""
        return f"{self.field}_{self.unit}" if self.unit else self.field

    @property
    def peak(self) -> bool:
        """Whether it is a largest value, which is not undone by what comes later."""
        return self.field.startswith("peak_")

    @property
    def residual(self) -> bool:
        """Whether it is a value at the end, which what has fallen does not have."""
        return self.field.startswith("residual_")

    @property
    def width(self) -> str:
        """Width over which it is given in diameters: that of the base, or for joints that of the narrowest joint."""
        return "joint_width_m" if self.of == JOINT else "base_width_m"

    def plain(self, value: float) -> float | int | None:
        """A value as rows have it."""
        if isinstance(value, Integral):
            return int(value)
        return self.missing if math.isnan(value) else float(value)


def measure(of: str, unit: str = "", meaning: str = "", *, default: float = math.nan, **words: Any) -> Any:
    """Declare a field of a dataclass as a measure, not known by default; see :class:`Measure` for what it says."""
    return dataclasses.field(default=default, metadata={"measure": (of, unit, meaning), "words": words})


@cache
def measures_of(holder: type) -> tuple[Measure, ...]:
    """Measures that a class declares, in their order."""
    fields = (field for field in dataclasses.fields(holder) if "measure" in field.metadata)
    return tuple(Measure(field.name, *field.metadata["measure"], **field.metadata["words"]) for field in fields)


def row_by(holder: Any, but: str = "") -> dict[str, Any]:
    """Measures of a value under the names that scripts rely on, but those of one kind."""
    listed = measures_of(type(holder))
    return {measure.key: measure.plain(getattr(holder, measure.field)) for measure in listed if measure.of != but}


@dataclass(frozen=True)
class SpaceMeasures:
    """Measures that only models in space have."""

    peak_top_x: float = measure(
        TOP, "m", "largest absolute displacement of the middle of the top face along x, relative to the base"
    )
    peak_top_y: float = measure(
        TOP, "m", "largest absolute displacement of the middle of the top face along y, relative to the base"
    )
    peak_tilt: float = measure(
        BODY, "rad", "largest angle between a drum's axis and the vertical", label="peak tilt", phrase=say("peak tilt")
    )
    peak_twist: float = measure(
        JOINT, "rad", "largest absolute twist of any joint", label="peak twist", phrase=say("peak twist of a joint")
    )


@dataclass(frozen=True)
class BodyMeasures:
    """Measures of one body of an assembly.

    Parameters
    ----------
    name : str
    peak_tilt : float
        Largest turn since the start of what was vertical then, over the whole run, its fall included [rad].
    fell_at : float or None
        When it had fallen for good [s].
    fall_azimuth : float or None
        Where its centroid was then, from where it stood, from x towards y [rad]; None where it fell straight down.
    moved : (float, float, float)
        Of its centroid, from the start to the end of the run, of what fell too [m].
    displaced : bool
        Whether it stands, and stands shifted; only known where all lies still at the end.
    """

    name: str
    peak_tilt: float
    fell_at: float | None
    fall_azimuth: float | None
    moved: tuple[float, float, float]
    displaced: bool

    def row(self) -> dict:
        """The facts under the names that scripts rely on; what has fallen has no residual displacement."""
        fell = self.fell_at is not None
        return {
            "peak_tilt_rad": self.peak_tilt,
            "fell_at_s": self.fell_at,
            "fall_azimuth_deg": None if self.fall_azimuth is None else math.degrees(self.fall_azimuth),
            "residual_displacement_m": None if fell else math.hypot(*self.moved),
            "displacement_at_end_m": list(self.moved),
        }


@dataclass(frozen=True)
class BlockMeasures:
    """Measures that only runs of assemblies have; there is no top.

    Parameters
    ----------
    fell_at : tuple of (str, float)
        Blocks that have fallen, in this order, and when each of them had [s].
    peak_displacement, residual_displacement : float
        [m]
    at_rest : bool
        Whether everything lies still at the end.
    in_equilibrium : bool, optional
        Whether the assembly is in equilibrium as drawn; None if it is not known.
    bodies : tuple of BodyMeasures
        Of those that can move, in the assembly's order.
    struck_at : float, optional
        When bodies that no joint holds together first touched [s]; None if none did, or the record does not tell.
    """

    fell_at: tuple[tuple[str, float], ...] = ()
    peak_displacement: float = measure(
        BODY, "m", "largest distance of a centroid from where it was at the start, until the first block has fallen",
        label="peak displacement", phrase=say("peak displacement of a block"), spread=True,
    )  # fmt: skip
    residual_displacement: float = measure(
        BODY, "m", "largest distance of a centroid from where it was at the start, at the end",
        label="residual displacement", phrase=say("residual displacement of a block"), spread=True,
    )  # fmt: skip
    at_rest: bool = False
    in_equilibrium: bool | None = None
    bodies: tuple[BodyMeasures, ...] = ()
    struck_at: float | None = None

    @property
    def displaced(self) -> tuple[str, ...]:
        """Bodies that stand, and stand shifted; none where not all lies still at the end."""
        return tuple(body.name for body in self.bodies if body.displaced)

    @property
    def hangs_on_strikes(self) -> bool:
        """Whether bodies struck one another before the last that fell had fallen, or although none fell."""
        return self.struck_at is not None and self.struck_at <= max(
            (when for _, when in self.fell_at), default=math.inf
        )

    def row(self) -> dict:
        """The facts under the names that scripts rely on."""
        return row_by(self) | {
            "at_rest": bool(self.at_rest),
            "fallen_blocks": len(self.fell_at),
            "fallen": [name for name, _ in self.fell_at],
            "displaced": list(self.displaced),
            "bodies": {body.name: body.row() for body in self.bodies},
        }


@dataclass(frozen=True, eq=False)
class Measures:
    """Measures of a run.

    Residuals of a column that collapsed are those of the debris; its peaks end with the collapse, of columns of drums with
    the last look before they fell. In space displacements of the top are lengths in plan; an assembly has no top.

    Parameters
    ----------
    outcome : Outcome
    decided : bool
        False when the run ended while the column was still far from rest, so that the verdict could change.
    collapse_time, …, steps : float
        Each declared with its unit and meaning; NaN for what a run does not have.
    reason : str
        Mechanism of a collapse, or why a run failed; empty otherwise.
    collapse : Collapse, optional
        The collapse, if there was one.
    space : SpaceMeasures, optional
        Of a model in space.
    blocks : BlockMeasures, optional
        Of an assembly.
    stepped : (float, float, float), optional
        Where the quiet of the motion was left out: times from and to which it was stepped, and how much of it [s].
    links : tuple of LinkMeasures
        Of the links that act, in the column's order.
    residuals : Residuals, optional
        Joint by joint and body by body; None where the model does not tell.
    computed_by : str
        The kind of processor that has stepped it: ``cpu``, or ``gpu`` with the card in parentheses.
    """

    outcome: Outcome
    decided: bool
    collapse_time: float = measure(RUN, "s", "time at which the collapse became certain", missing=None)
    peak_top_displacement: float = measure(
        TOP, "m", "largest top displacement relative to the base",
        label="peak top displacement", phrase=say("peak displacement of the top"), spread=True, short="top",
    )  # fmt: skip
    residual_top_displacement: float = measure(
        TOP, "m", "top displacement relative to the base at the end, of the debris after a collapse",
        label="residual top displacement", phrase=say("residual displacement of the top"), spread=True,
    )  # fmt: skip
    peak_rotation: float = measure(
        BODY, "rad", "largest rotation of any drum", label="peak rotation", phrase=say("peak rotation"), spread=True
    )
    peak_joint_opening: float = measure(
        JOINT, "m", "largest opening of any joint", label="peak joint opening", phrase=say("peak opening of a joint")
    )
    residual_joint_slip: float = measure(
        JOINT, "m", "largest offset of a drum along its joint at the end, of the debris after a collapse",
        label="residual joint slip", phrase=say("largest residual slip of a joint"), spread=True, short="drums",
    )  # fmt: skip
    energy_imbalance: float = measure(RUN, "", "energy that the ledger cannot account for, over the energy at stake")
    time_step: float = measure(STEPS, "s", "step of the integration, the smallest if it varies")
    steps: int = measure(STEPS, "", "steps taken", default=0)
    reason: str = ""
    collapse: Collapse | None = None
    space: SpaceMeasures | None = None
    blocks: BlockMeasures | None = None
    stepped: tuple[float, float, float] | None = None
    links: tuple[LinkMeasures, ...] = ()
    residuals: Residuals | None = None
    computed_by: str = CPU

    def __eq__(self, other: object) -> bool:
        """Equal to the bit, one missing number (NaN) like another; left alone, Python 3.13 tells NaN from NaN."""
        if not isinstance(other, Measures):
            return NotImplemented
        pairs = zip(self._compared().values(), other._compared().values(), strict=True)
        return all(mine == theirs or (mine != mine and theirs != theirs) for mine, theirs in pairs)

    def _compared(self) -> dict:
        return vars(self) | {"links": [link.row() for link in self.links]}

    @property
    def collapsed(self) -> bool:
        """Whether the column collapsed."""
        return self.outcome is Outcome.COLLAPSED

    def shown(self, *, space: bool = False) -> list[tuple[Measure, float]]:
        """Measures that have a label, with their values; those of models in space only if asked for."""
        parts = [part for part in (self.blocks, self, self.space if space else None) if part is not None]
        pairs = (
            (measure, getattr(part, measure.field))
            for part in parts
            for measure in measures_of(type(part))
            if measure.label
        )
        return [(measure, value) for measure, value in pairs if measure.of != TOP or self.blocks is None]

    def row(self) -> dict:
        """The facts under the names that scripts rely on: keys of ``stylobate run --json`` and table columns."""
        row = {"outcome": self.outcome.label, "collapsed": self.collapsed, "decided": bool(self.decided)}
        row |= row_by(self, but="" if self.blocks is None else TOP)
        row |= {"computed_by": self.computed_by, "reason": self.reason}
        row |= {} if self.blocks is None else self.blocks.row()
        azimuth = None if self.collapse is None else self.collapse.azimuth
        row["collapse_azimuth_deg"] = None if azimuth is None else math.degrees(azimuth)
        row |= {} if self.space is None else row_by(self.space)
        row |= {} if self.residuals is None else self.residuals.row()
        if self.stepped is not None:
            row |= dict(zip(("stepped_from_s", "stepped_to_s", "stepped_s"), map(float, self.stepped), strict=True))
        return row | (row_of(self.links) if self.links else {})


#: All measures of runs; those whose percentiles are given, displacements first.
MEASURES = measures_of(Measures) + measures_of(BlockMeasures) + measures_of(SpaceMeasures)
SPREAD = tuple(
    sorted((measure for measure in MEASURES if measure.spread), key=lambda measure: "displacement" not in measure.field)
)


def blank_row(*, space: bool = False, links: bool = False, blocks: bool = False) -> dict:
    """Row of a run before there is one: all measures missing.

    Parameters
    ----------
    space : bool
        Of a model in space.
    links : bool
        Of what has links.
    blocks : bool
        Of an assembly, which has no top.
    """
    parts: dict[str, Any] = {"space": SpaceMeasures()} if space and not blocks else {}
    parts |= {"blocks": BlockMeasures()} if blocks else {}
    row = Measures(Outcome.AT_REST, False, residuals=no_residuals(space=space), **parts).row()
    return row | (row_of(()) if links else {})
