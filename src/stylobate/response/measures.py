"""Scalar results of a run: the same facts, under the same names, for every model, single run or batch."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..outcome import Outcome
from .body_measures import BodyMeasures
from .collapse import Collapse
from .links import LinkMeasures, row_of
from .residuals import Residuals, no_residuals

#: Kinds of devices that compute runs, the usual one first.
DEVICES = CPU, GPU = "cpu", "gpu"


@dataclass(frozen=True)
class SpaceMeasures:
    """Measures that only models in space have.

    Parameters
    ----------
    peak_top_x, peak_top_y : float
        Largest absolute displacement of the middle of the top face along x and along y, relative to the base [m].
    peak_tilt : float
        Largest angle between a drum's axis and the vertical [rad].
    peak_twist : float
        Largest absolute twist of any joint [rad].
    """

    peak_top_x: float
    peak_top_y: float
    peak_tilt: float
    peak_twist: float

    def row(self) -> dict:
        """The facts under the names that scripts rely on."""
        return {
            "peak_top_x_m": float(self.peak_top_x),
            "peak_top_y_m": float(self.peak_top_y),
            "peak_tilt_rad": float(self.peak_tilt),
            "peak_twist_rad": float(self.peak_twist),
        }


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
    nan = math.nan
    in_space = SpaceMeasures(nan, nan, nan, nan) if space and not blocks else None
    of_blocks = BlockMeasures((), nan, nan, False) if blocks else None
    row = Measures(
        Outcome.AT_REST, False, nan, nan, nan, nan, nan, nan, nan, nan, 0, space=in_space, blocks=of_blocks,
        residuals=no_residuals(space=space),
    ).row()  # fmt: skip
    return row | (row_of(()) if links else {})


@dataclass(frozen=True)
class BlockMeasures:
    """Measures that only runs of assemblies have; there is no top.

    Parameters
    ----------
    fell_at : tuple of (str, float)
        Blocks that have fallen, in this order, and when each of them had [s].
    peak_displacement, residual_displacement : float
        Largest distance of a centroid from where it was at the start, until the first block has fallen and at the end [m].
    at_rest : bool
        Whether everything lies still at the end.
    in_equilibrium : bool, optional
        Whether the assembly is in equilibrium as drawn; None if it is not known.
    bodies : tuple of BodyMeasures
        Of those that can move, in the assembly's order.
    struck_at : float, optional
        When bodies that no joint holds together first touched [s]; None if none did, or the record does not tell.
    """

    fell_at: tuple[tuple[str, float], ...]
    peak_displacement: float
    residual_displacement: float
    at_rest: bool
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
        return {
            "peak_displacement_m": float(self.peak_displacement),
            "residual_displacement_m": float(self.residual_displacement),
            "at_rest": bool(self.at_rest),
            "fallen_blocks": len(self.fell_at),
            "fallen": [name for name, _ in self.fell_at],
            "displaced": list(self.displaced),
            "bodies": {body.name: body.row() for body in self.bodies},
        }


@dataclass(frozen=True, eq=False)
class Measures:
    """Measures of a run.

    Parameters
    ----------
    outcome : Outcome
    decided : bool
        False when the run ended while the column was still far from rest, so that the verdict could change.
    collapse_time : float
        Time at which the collapse became certain [s]; NaN without collapse.
    peak_top_displacement, residual_top_displacement : float
        Of the middle of the top face, relative to the base, largest absolute value and value at the end [m]; in space the
        lengths in plan. NaN for an assembly. Residuals of a column that collapsed are those of the debris; its peaks, these
        and the others, end with the collapse, of columns of drums with the last look before they fell.
    peak_rotation : float
        Largest absolute rotation of any drum since the start [rad].
    peak_joint_opening : float
        Largest opening of any joint, at the edge that opens most [m].
    residual_joint_slip : float
        Largest absolute offset that a drum has, at the end, along its joint [m].
    energy_imbalance : float
        Energy that the ledger cannot account for, over the largest of the input work so far, the energy at the start, the
        lowest barrier and the potential energy that was released [-].
    time_step : float
        Step of the integration, the smallest if it varies [s].
    steps : int
        Steps taken.
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
    collapse_time: float
    peak_top_displacement: float
    residual_top_displacement: float
    peak_rotation: float
    peak_joint_opening: float
    residual_joint_slip: float
    energy_imbalance: float
    time_step: float
    steps: int
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

    def row(self) -> dict:
        """The facts under the names that scripts rely on: keys of ``stylobate run --json`` and table columns."""
        row = {
            "outcome": self.outcome.label,
            "collapsed": self.collapsed,
            "decided": bool(self.decided),
            "collapse_time_s": None if math.isnan(self.collapse_time) else float(self.collapse_time),
            "peak_top_displacement_m": float(self.peak_top_displacement),
            "residual_top_displacement_m": float(self.residual_top_displacement),
            "peak_rotation_rad": float(self.peak_rotation),
            "peak_joint_opening_m": float(self.peak_joint_opening),
            "residual_joint_slip_m": float(self.residual_joint_slip),
            "energy_imbalance": float(self.energy_imbalance),
            "time_step_s": float(self.time_step),
            "steps": int(self.steps),
            "computed_by": self.computed_by,
            "reason": self.reason,
        }
        if self.blocks is not None:  # an assembly has no top
            del row["peak_top_displacement_m"], row["residual_top_displacement_m"]
            row |= self.blocks.row()
        azimuth = None if self.collapse is None else self.collapse.azimuth
        row["collapse_azimuth_deg"] = None if azimuth is None else math.degrees(azimuth)
        if self.space is not None:
            row |= self.space.row()
        if self.residuals is not None:
            row |= self.residuals.row()
        if self.stepped is not None:
            row |= dict(zip(("stepped_from_s", "stepped_to_s", "stepped_s"), map(float, self.stepped), strict=True))
        if self.links:
            row |= row_of(self.links)
        return row
