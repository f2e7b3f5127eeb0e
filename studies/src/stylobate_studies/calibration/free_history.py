"""A measured free motion: tilt of a column or displacement of a point of it over time, and the files that hold one."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import cached_property
from numbers import Real
from pathlib import Path

import numpy as np

from stylobate.errors import InputError, check_choice, check_kind, check_range
from stylobate.motion.readers.columns import first_row, read_table
from stylobate.motion.readers.record import first_bad_step, resampled, step_of
from stylobate.motion.readers.source import Source
from stylobate.motion.specs import TIME_UNITS

#: Units of tilt [rad] and of displacement [m].
TILTS = {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180.0, "°": math.pi / 180.0, "degrees": math.pi / 180.0}
LENGTHS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254}

#: How the columns of a file are named, for messages.
EXAMPLE = "name the columns as in time_s,tilt_deg, or time_s,tilt_x_deg,tilt_y_deg, or time_s,displacement_mm"

#: Fewest samples of a history.
FEWEST = 20

_NAME = re.compile(r"(?P<what>time|tilt|displacement)(?:_(?P<axis>x|y))?(?:_(?P<unit>[a-z°]+))?")


@dataclass(frozen=True, eq=False)
class FreeHistory:
    """Tilt of a column that rocks or wobbles freely, or displacement of a point of it, over time.

    Parameters
    ----------
    dt : float
        Step [s].
    values : array
        Shape (samples,), or (samples, 2) along x and y; tilt towards the axis [rad] or displacement along it [m].
    kind : {"tilt", "displacement"}
    name : str
    unit : float
        Size of the unit of its file [rad or m].

    Raises
    ------
    InputError
        Numbers that are not finite, too few of them, or tilts beyond a right angle.
    """

    dt: float
    values: np.ndarray
    kind: str = "tilt"
    name: str = "history"
    unit: float = 1.0

    def __post_init__(self) -> None:
        check_range("dt", self.dt, 0.0, 10.0, unit="s", open_low=True)
        check_choice("kind of a history", self.kind, ("tilt", "displacement"))
        try:
            values = np.array(self.values, dtype=float)
        except (TypeError, ValueError):
            raise InputError(
                "values of a history are no array of numbers; give one or two columns.", "values"
            ) from None
        values = values[:, None] if values.ndim == 1 else values
        if values.ndim != 2 or values.shape[1] not in (1, 2):
            raise InputError(f"{self.name} has the shape {values.shape}; give one column of values, or two (x and y).")
        if len(values) < FEWEST:
            raise InputError(f"{self.name} holds {len(values)} samples; give at least {FEWEST}.")
        if not np.isfinite(values).all():
            raise InputError(f"{self.name} holds values that are not finite; take them out, or cut the history.")
        most = float(np.hypot(*values.T).max() if values.shape[1] == 2 else np.abs(values).max())
        if self.kind == "tilt" and most > 0.5 * math.pi:
            raise InputError(
                f"the tilt of {self.name} reaches {math.degrees(most):.4g}°; allowed is up to 90°: check its unit."
            )
        object.__setattr__(self, "values", values)

    @property
    def time(self) -> np.ndarray:
        """Times from its first sample on [s]."""
        return self.dt * np.arange(len(self.values))

    @cached_property
    def noise(self) -> float:
        """Standard deviation of its noise, taken as white, from third differences [rad or m]."""
        third = np.diff(self.values, 3, axis=0)
        return float(1.4826 * np.median(np.abs(third - np.median(third, axis=0))) / math.sqrt(20.0))

    def tilts(self, height: float, half_width: float, noise: float | None = None) -> tuple[np.ndarray, float]:
        """Lean of a body that turns about the edge it leans to, towards each axis, and the noise of that [rad].

        A point of its axis at a height h moves by u = h sin θ + b (1 − cos θ), b half the width.

        Parameters
        ----------
        height, half_width : float
            h of a displacement, and b [m].
        noise : float, optional
            Standard deviation [rad or m].
        """
        sd = self.noise if noise is None else noise
        if self.kind == "tilt":
            return self.values, sd
        reach, edge = math.hypot(height, half_width), math.atan2(half_width, height)
        size = np.hypot(*self.values.T) if self.values.shape[1] == 2 else np.abs(self.values[:, 0])
        if float(size.max()) >= reach:
            raise InputError(
                f"{self.name} reaches {size.max():.4g} m at a height of {height:.4g} m, farther than the column is high; "
                "check its unit and `height`."
            )
        lean = edge + np.arcsin((size - half_width) / reach)
        share = np.divide(lean, size, out=np.full(len(size), 1.0 / height), where=size > 0.0)
        return self.values * share[:, None], sd / height


def read_free_history(path: str | Path, unit: str | None = None, dt: float | None = None) -> FreeHistory:
    """Read a measured free motion: columns of text, with a header such as ``time_s,tilt_deg``.

    Parameters
    ----------
    path : path
    unit : str, optional
        Of values whose header names none: deg, rad, mrad, m, cm, mm, in.
    dt : float, optional
        Step of a file without times, or to resample unequal steps to [s].

    Returns
    -------
    FreeHistory

    Raises
    ------
    InputError
        The file cannot be read with certainty.
    """
    check_kind("unit", unit, str, optional=True)
    check_kind("dt", dt, Real, optional=True)
    source = Source.open(path)
    start = first_row(source.lines) if source.is_text else None
    if start is None:
        raise InputError(
            f"{source.name} holds no columns of tilt or displacement (records of other formats hold accelerations); "
            f"{EXAMPLE}."
        )
    table = read_table(source.lines, start, source.name)
    titles = [line.strip() for line in source.lines[:start] if line.strip() and not line.strip().startswith(("#", "%"))]
    timed, order, kind, size = _columns(titles[-1] if titles else "", table, unit, source.name)
    values = np.ascontiguousarray(table[:, order]) * size
    if timed is None:
        if dt is None:
            raise InputError(f"{source.name} has no times; state the step: `dt=0.01`.", "dt")
        return FreeHistory(dt, values, kind, source.name, size)
    time = table[:, 0] * timed
    step = step_of(time)
    if step is None:
        bad = first_bad_step(time)
        if dt is None or (np.diff(time) <= 0.0).any():
            raise InputError(
                f"{source.name}: the time goes from {time[bad - 1]:g} s to {time[bad]:g} s, unlike the other steps; mend "
                "it, or state a step to resample to: `dt=0.01`.",
                "dt",
            )
        made = [resampled(time, signal, dt, source.name) for signal in values.T]
        step, values = made[0][0], np.stack([result[1] for result in made], axis=-1)
    return FreeHistory(step, values, kind, source.name, size)


def _columns(header: str, table: np.ndarray, unit: str | None, file: str) -> tuple[float | None, list[int], str, float]:
    """Unit of the times [s] in the first column, if it holds them; columns of values, what they are, and their unit."""
    number = table.shape[1]
    if not header:
        grows = number > 1 and bool((np.diff(table[:, 0]) > 0.0).all())
        if number - grows > 1:
            raise InputError(f"{file} has rows of {number} numbers without column names; {EXAMPLE}.")
        kind, size = _unit(unit, "", file)
        return 1.0 if grows else None, list(range(int(grows), number)), kind, size
    names = [name.strip().strip('"').lower() for name in re.split(r"[,;\t]", header)]
    matches = [_NAME.fullmatch(name) for name in names]
    if len(names) != number or None in matches:
        odd = next((name for name, match in zip(names, matches, strict=True) if match is None), None)
        what = f"{len(names)} names for {number} columns" if odd is None else f"the unknown column {odd!r}"
        raise InputError(f"{file}: its header has {what}; {EXAMPLE}.")
    timed, axes, measured = None, {}, set()
    for i, match in enumerate(matches):
        assert match is not None
        if match["what"] == "time":
            timed = TIME_UNITS.get(match["unit"] or "s")
            if timed is None or i or match["axis"]:
                raise InputError(f"{file}: its header has the column {names[i]!r}; {EXAMPLE}, times first.")
            continue
        axis = match["axis"] or ""
        if axis in axes:
            raise InputError(f"{file}: its header names two columns alike; {EXAMPLE}.")
        axes[axis] = i
        measured.add(_unit(match["unit"] or unit, match["what"], file))
    if sorted(axes) not in ([""], ["x"], ["x", "y"]) or len(measured) != 1:
        raise InputError(f"{file}: its header names no one tilt or displacement, along x or along x and y; {EXAMPLE}.")
    kind, size = measured.pop()
    return timed, [axes[axis] for axis in sorted(axes)], kind, size


def _unit(unit: str | None, wanted: str, file: str) -> tuple[str, float]:
    """What a unit measures, and its size in rad or m."""
    if unit is None:
        raise InputError(f"{file} states no unit; state it: `unit='deg'`, or rad, mrad, m, cm, mm.", "unit")
    name = unit.strip().lower()
    for kind, units in (("tilt", TILTS), ("displacement", LENGTHS)):
        if name in units and wanted in ("", kind):
            return kind, units[name]
    what = f" of a {wanted}" if wanted else ""
    allowed = ", ".join(TILTS if wanted == "tilt" else LENGTHS if wanted else TILTS | LENGTHS)
    raise InputError(f"unit{what} is {unit!r}; allowed is {allowed}.", "unit")
