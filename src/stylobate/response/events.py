"""A run through several earthquakes, cut where each of them ends: what had become of the structure by then."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

import numpy as np

from ..motion.sequence import Span, number_at
from ..outcome import Outcome, classify
from .assemblies import measures_of_bodies
from .collapse import Touch
from .histories import Histories
from .links import NAMES, LinkMeasures
from .measures import Measures, SpaceMeasures, measures_of
from .poses import PlanePoses, rotation_matrices
from .residuals import Residuals, residuals_of, turned_up
from .response import Response

#: What moves by less than this share of its size within so long lies still [-], [s].
STILL, WHILE = 2.0e-4, 0.5


@dataclass(frozen=True, eq=False)
class Event:
    """One earthquake of a sequence.

    Parameters
    ----------
    number : int
        From 1.
    span : Span
        What shakes, and when.
    run : Response
        The sequence so far, as if it ended with the rest after this earthquake. Peaks are those of the recorded states since
        the beginning; of the last earthquake that was reached it is the whole run.
    added : Residuals or None
        Slips, twists, displacements and tilts by this earthquake alone, of an assembly those of what fell, too; None of a
        column that fell in it, or before.
    peak_rotation, peak_opening : float
        Largest turn of a body since the beginning [rad], and opening of a joint [m], during this earthquake and the rest
        after it; until the first body of an assembly fell, and NaN of a column that fell in it.
    fallen, broken : tuple of str
        Bodies that fell and links that broke in it.
    moving : float
        Way of the body that moves most in the last half second, over its size [-].
    """

    number: int
    span: Span
    run: Response
    added: Residuals | None
    peak_rotation: float
    peak_opening: float
    fallen: tuple[str, ...]
    broken: tuple[str, ...]
    moving: float

    @property
    def at_rest(self) -> bool:
        """Whether everything lies still before the next one begins."""
        return self.moving <= STILL

    @property
    def added_slip(self) -> float:
        """Largest slip of a joint by this earthquake [m]; NaN where something has fallen."""
        return math.nan if self.added is None or self.run.collapsed else max(self.added.slips, default=0.0)

    def row(self) -> dict[str, Any]:
        """A row of the table."""
        return {
            "earthquake": self.number,
            "motion": self.span.motion,
            "begins_s": self.span.begins,
            "ends_s": self.span.ends,
            "outcome": self.run.outcome.label,
            "collapsed": self.run.collapsed,
            "peak_rotation_rad": self.peak_rotation,
            "peak_joint_opening_m": self.peak_opening,
            "added_slip_m": self.added_slip,
            "residual_slip_m": math.nan if self.run.collapsed else self.run.residual_joint_slip,
            "fallen": len(self.fallen),
            "links_broken": len(self.broken),
            "at_rest": self.at_rest,
        }

    def summary(self) -> dict[str, Any]:
        """Summary of the run so far, under the names of ``stylobate run``, and what is of this earthquake alone."""
        own = self.row()
        alone = {name: own[name] for name in ("earthquake", "motion", "begins_s", "ends_s")}
        alone["quiet_s"] = self.span.quiet
        alone["alone"] = {
            "peak_rotation_rad": _number_or_none(self.peak_rotation),
            "peak_joint_opening_m": _number_or_none(self.peak_opening),
            "added_slip_m": _number_or_none(self.added_slip),
            "fallen": list(self.fallen),
            "links_broken": list(self.broken),
            "at_rest": self.at_rest,
            "added": None if self.added is None else self.added.row(),
        }
        return alone | self.run.summary()


def events_of(response: Response, spans: Sequence[Span]) -> tuple[Event, ...]:
    """The earthquakes of a run, up to the one with which it ended; none of a run that failed.

    Parameters
    ----------
    response : Response
    spans : sequence of Span
        When they come.
    """
    if response.outcome is Outcome.FAILED:
        return ()
    h, events = response.histories, []
    turn, reached = turns(response), [span for span in spans if span.begins <= response.time[-1]]
    stood = h.time < response.collapse_time if response.collapsed else np.ones(len(h.time), dtype=bool)
    for number, span in enumerate(reached, 1):
        first = int(np.searchsorted(h.time, span.begins * (1.0 + 1e-9), "right")) - 1
        last = int(np.searchsorted(h.time, span.ends * (1.0 + 1e-9), "right")) - 1
        last, final = (len(h.time) - 1, True) if number == len(reached) else (last, False)
        run = response if final else _so_far(response, last)
        inside = np.zeros(len(h.time), dtype=bool)
        inside[first : last + 1] = True
        gone = run.collapsed and response.measures.blocks is None
        known = inside & stood & (not gone)
        events.append(
            Event(
                number, span, run, None if gone else residuals_of(response.structure, _cut(h, last), first),
                float(turn[known].max()) if known.any() else math.nan,
                float(h.opening[known].max(initial=0.0)) if known.any() else math.nan,
                _within(response.fell_at.items(), reached, number),
                _within([(link.name, link.broken_at) for link in response.measures.links], reached, number),
                _moving(response, last),
            )
        )  # fmt: skip
    return tuple(events)


def _so_far(response: Response, last: int) -> Response:
    """A run as if it ended with a state."""
    measures = _by(response, last)
    fell = response.mechanism if measures.collapsed else None
    return replace(response, histories=_cut(response.histories, last), measures=measures, mechanism=fell, twins=())


def turns(response: Response) -> np.ndarray:
    """Turn of every body since the start, of what was vertical then [rad], shape (T, n)."""
    poses = response.histories.poses
    if isinstance(poses, PlanePoses):
        return np.abs(poses.rotation - (0.0 if response.structure.relative else poses.rotation[0]))
    axes = rotation_matrices(poses.orientation)
    up = turned_up(axes, axes[0])
    return np.arctan2(np.hypot(up[..., 0], up[..., 1]), up[..., 2])


def _within(what: Any, spans: Sequence[Span], number: int) -> tuple[str, ...]:
    return tuple(name for name, time in what if number_at(spans, time) == number)


def _moving(response: Response, last: int) -> float:
    """Way within the last moments before a state, over the size of the structure's smallest body [-]."""
    time, places = response.time, response.body_position
    first = int(np.searchsorted(time, time[last] - WHILE))
    free = [not body.fixed for body in response.structure.bodies[response.structure.first :]]
    size = min(body.size for body in response.structure.bodies if not body.fixed)
    return float(np.ptp(places[first : last + 1, free], axis=0).max() / size)


def _cut(histories: Histories, last: int) -> Histories:
    """The histories up to a state, that one too."""

    def until(value: Any) -> Any:
        if isinstance(value, np.ndarray):
            return value[: last + 1]
        if isinstance(value, dict):
            return {name: until(part) for name, part in value.items()}
        if is_dataclass(value) and not isinstance(value, type):
            return replace(value, **{field.name: until(getattr(value, field.name)) for field in fields(value)})
        return value

    return until(histories)


def _by(response: Response, last: int) -> Measures:
    """Measures of a run by a state in which it goes on."""
    structure, m, h = response.structure, response.measures, _cut(response.histories, last)
    now, residuals = float(h.time[-1]), residuals_of(response.structure, _cut(response.histories, last))
    links = tuple(_link_by(link, k, h, now) for k, link in enumerate(m.links))
    steps = round(now / m.time_step)
    if m.blocks is not None:
        names = [body.name for body in structure.bodies]
        since = {
            names.index(name): int(np.searchsorted(h.time, time)) for name, time in m.blocks.fell_at if time <= now
        }
        struck = m.blocks.struck_at
        touched = None if struck is None or struck > now else Touch(struck)
        return measures_of_bodies(
            structure, h.time, response.body_position[: last + 1], response.displacement[: last + 1],
            turns(response)[: last + 1], since, h.opening, np.array(residuals.slips),
            at_rest=_moving(response, last) <= STILL, failed=False, in_equilibrium=m.blocks.in_equilibrium,
            touched=touched, residuals=residuals, energy_imbalance=m.energy_imbalance, time_step=m.time_step, steps=steps,
            links=links,
        )  # fmt: skip
    slips, top = np.array(residuals.slips), h.top_displacement
    residual = float(top[-1]) if top.ndim == 1 else float(np.hypot(*top[-1]))
    so_far: dict[str, Any] = {"residual_top_displacement": residual, "residual_joint_slip": float(slips.max())}
    so_far |= {"residuals": residuals, "links": links, "steps": steps, "stepped": None}
    if now >= m.collapse_time:  # it fell before: its peaks ended there
        return replace(m, **{measure.field: math.nan for measure in measures_of(Measures) if measure.residual} | so_far)
    column = response.column
    opening = float(h.opening.max())
    outcome = classify(False, False, opening / column.joint_width, float((slips / column.joint_widths).max()))
    space = None
    if m.space is not None:
        tilt = float(response.tilt[: last + 1].max())
        space = SpaceMeasures(peak_top_x=float(np.abs(top[:, 0]).max()), peak_top_y=float(np.abs(top[:, 1]).max()),
                        peak_tilt=tilt, peak_twist=float(np.abs(h.twist).max()))  # fmt: skip
    unknown = {measure.field: math.nan for measure in measures_of(Measures) if measure.peak or measure.residual}
    peaks = {
        "peak_top_displacement": float((np.abs(top) if top.ndim == 1 else np.hypot(*top.T)).max()),
        "peak_rotation": float(turns(response)[: last + 1].max()),
        "peak_joint_opening": opening,
    }
    return replace(
        m, outcome=outcome, decided=True, collapse_time=math.nan, reason="", collapse=None, space=space,
        **unknown | peaks | so_far,
    )  # fmt: skip


def _link_by(link: LinkMeasures, k: int, histories: Histories, now: float) -> LinkMeasures:
    """Results for a link by a state."""
    if histories.links is None:
        return replace(link, broken_at=link.broken_at if link.broken_at <= now else math.nan)
    peaks = {}
    for name in NAMES:
        values = getattr(histories.links, name)[:, k]
        signed = name in ("tension", "elongation")  # pressed or shortened is none of it
        peaks[f"peak_{name}"] = float((values if signed else np.abs(values)).max(initial=0.0))
    return replace(link, broken_at=link.broken_at if link.broken_at <= now else math.nan, **peaks)


def _number_or_none(value: float) -> float | None:
    return None if math.isnan(value) else value
