"""What shaking may have been, before anything is seen: motions, contact and losses, drawn number by number."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from stylobate.campaign.twins import PARTS, unknown_stiffness, with_stiffness
from stylobate.column.column import Column
from stylobate.column.joint import LAWS, Losses
from stylobate.column.scatter import Scatter
from stylobate.constants import g
from stylobate.errors import InputError, as_typed, check_all, check_choice, check_range, check_whole
from stylobate.motion import Motion, integrate

from .ground_motion import elliptical_pulse

#: Quantities of a synthetic motion: least and most that is allowed, and the unit.
RANGES = {
    "pgv": (1e-4, 20.0, "m/s"), "pga": (1e-4, 20.0, "g"), "period": (0.02, 20.0, "s"), "azimuth": (-360.0, 360.0, "degrees"),
    "ellipticity": (0.0, 1.0, ""), "cycles": (1.0 + 1e-9, 20.0, ""), "scale": (1e-3, 1e3, ""),
}  # fmt: skip

#: Those that are drawn evenly in their logarithm.
LOGARITHMIC = ("pgv", "pga", "period", "scale")

#: Names of the uniform numbers of a draw, in their order, which is part of what a seed means.
DRAWN: tuple[str, ...] = (
    "size",
    "period",
    "azimuth",
    "ellipticity",
    "cycles",
    "phase",
    "law",
    "stiffness_damping",
    "record",
    "unknown_stiffness",
)

#: Damping of joints where nothing else is said [s]: nobody has measured it.
LOSSES = (1e-4, 3e-4, 1e-3)

#: Most draws.
MOST = 1_000_000


@dataclass(frozen=True, eq=False)
class Prior:
    """Motions that may have been, all independent of one another; ranges are pairs, least and most.

    Parameters
    ----------
    pgv : pair of float, optional
        Largest length of the velocity vector of the ground, even in its logarithm [m/s].
    pga : pair of float, optional
        The same of the acceleration [g]; one of the two is given for synthetic motions.
    period : pair of float, optional
        Of the pulse, even in its logarithm [s].
    azimuth : pair of float, optional
        Of the strong axis of synthetic motions, from x towards y [degrees], all directions by default: 0 to 180, because an
        axis has no sense. Records are turned by it as a whole, by 0 to 360 by default.
    ellipticity : pair of float
        Peak velocity across the strong axis over that along it [-].
    cycles : pair of float
        Length of the pulse in periods [-].
    records : sequence of Motion
        Instead of synthetic motions, each as likely.
    scale : pair of float
        Factor of records, even in its logarithm [-].
    law : sequence of str
        Laws of contact of round columns, each as likely.
    stiffness_damping : sequence of float
        Each as likely [s]; a column with losses of its own keeps these.
    scatter : Scatter, optional
        How what stands may differ from what was surveyed; by default as columns of their material do, with all drums in
        their places: a column that begins with offsets takes fifty times as long.
    unknown_stiffness : float, optional
        How far the stiffness of the joints of columns is unknown [-], as of a scatter, and alike in all of them: residual
        slips grow as it falls. 1 by default, 0 where a scatter is given.

    Raises
    ------
    InputError
        A range that is none, records beside ranges of synthetic motions, nothing of either.
    """

    pgv: tuple[float, float] | None = None
    pga: tuple[float, float] | None = None
    period: tuple[float, float] | None = None
    azimuth: tuple[float, float] | None = None
    ellipticity: tuple[float, float] | None = None
    cycles: tuple[float, float] | None = None
    records: Sequence[Motion] = ()
    scale: tuple[float, float] | None = None
    law: Sequence[str] = LAWS
    stiffness_damping: Sequence[float] = LOSSES
    scatter: Scatter | None = None
    unknown_stiffness: float | None = None

    def __post_init__(self) -> None:
        for name, (low, high, unit) in RANGES.items():
            given = getattr(self, name)
            if given is None:
                continue
            if not isinstance(given, (list, tuple)) or len(given) != 2:
                raise InputError(f"`{name}` is {as_typed(given)}; allowed are two numbers, least and most.", name)
            least, most = (check_range(f"`{name}`", number, low, high, unit=unit) for number in given)
            if not (least < most or (least == most and name not in ("pgv", "pga", "scale"))):
                raise InputError(
                    f"`{name}` is {as_typed(list(given))}; the first number must be below the second.", name
                )
            object.__setattr__(self, name, (least, most))
        records = tuple(check_all("records", self.records, Motion))
        synthetic = [
            name for name in ("pgv", "pga", "period", "ellipticity", "cycles") if getattr(self, name) is not None
        ]
        if records and synthetic:
            raise InputError(
                f"`records` and `{synthetic[0]}` are both given: motions are recorded or synthetic; give one of them.",
                synthetic[0],
            )
        if not records and self.scale is not None:
            raise InputError("`scale` is for records, and none are given; give records, or pgv and period.", "scale")
        if not records and (self.period is None or (self.pgv is None) == (self.pga is None)):
            raise InputError(
                "the prior needs pgv (or pga, not both) and period, such as pgv = [0.1, 1.5] and period = [0.3, 1.6]; or "
                "records.",
                "pgv" if self.period is not None else "period",
            )
        usual = {"azimuth": (0.0, 360.0), "scale": (0.5, 2.0)} if records else {
            "azimuth": (0.0, 180.0), "ellipticity": (0.0, 0.6), "cycles": (1.5, 4.0)
        }  # fmt: skip
        for name, pair in usual.items():
            if getattr(self, name) is None:
                object.__setattr__(self, name, pair)
        if self.azimuth[1] - self.azimuth[0] > 360.0:  # type: ignore[index]
            raise InputError("`azimuth` spans more than a full turn; allowed are 360° at most.", "azimuth")
        for name, values in (("law", self.law), ("stiffness_damping", self.stiffness_damping)):
            if isinstance(values, str) or not len(values) or len(set(values)) < len(values):
                raise InputError(f"`{name}` is {as_typed(values)}; allowed is a list of different values.", name)
        drawn = [name for name in PARTS if self.scatter is not None and getattr(self.scatter, name)]
        if drawn:
            raise InputError(
                f"the scatter of the prior varies {' and '.join(drawn)}, which a prior draws itself; give law, "
                "stiffness_damping and unknown_stiffness of the prior, and leave them out of its scatter.",
                "scatter",
            )
        unknown = float(self.scatter is None) if self.unknown_stiffness is None else self.unknown_stiffness
        unknown = check_range("unknown_stiffness of [prior]", unknown, 0.0, 1.0, field="unknown_stiffness")
        object.__setattr__(self, "unknown_stiffness", unknown)
        for value in self.law:
            check_choice("one of law", value, LAWS, field="law")
        for value in self.stiffness_damping:
            check_range("one of stiffness_damping", value, 0.0, 1.0, unit="s", field="stiffness_damping")
        object.__setattr__(self, "records", records)
        object.__setattr__(self, "law", tuple(self.law))
        object.__setattr__(self, "stiffness_damping", tuple(map(float, self.stiffness_damping)))

    @property
    def turn(self) -> float:
        """Angle after which directions are the same [degrees]: 180 of axes, 360 of records."""
        return 360.0 if self.records else 180.0

    def facts(self) -> dict[str, Any]:
        """Plain values that decide what is drawn."""
        values = {name: list(pair) for name in RANGES if (pair := getattr(self, name)) is not None}
        records = [[record.name, record.digest] for record in self.records]
        values |= {"records": records, "law": list(self.law), "stiffness_damping": list(self.stiffness_damping)}
        return values | {"unknown_stiffness": self.unknown_stiffness}

    def draws(self, count: int, seed: int) -> Draws:
        """The first draws of a seed; draw k is the same for any ``count`` above k."""
        check_whole("simulations", count, 1, MOST)
        return Draws(self, np.array([np.random.default_rng([seed, k]).random(len(DRAWN)) for k in range(count)]), seed)


class Draws:
    """Draws of a prior: numbers of each, and its motion.

    Parameters
    ----------
    prior : Prior
    uniform : array
        Even numbers from 0 to 1, shape (draws, numbers).
    seed : int
    """

    def __init__(self, prior: Prior, uniform: np.ndarray, seed: int) -> None:
        self.prior, self.seed = prior, seed
        self._uniform = dict(zip(DRAWN, uniform.T, strict=True))

    def __len__(self) -> int:
        return len(self._uniform["size"])

    def between(self, name: str, drawn: str | None = None) -> np.ndarray:
        """Values of a range of the prior, shape (draws,)."""
        low, high = getattr(self.prior, name)
        share = self._uniform[drawn or name]
        return low * (high / low) ** share if name in LOGARITHMIC else low + (high - low) * share

    def one_of(self, name: str, values: Sequence[Any]) -> np.ndarray:
        """Place of the value that each draw has of several, shape (draws,)."""
        return np.minimum((len(values) * self._uniform[name]).astype(int), len(values) - 1)

    @cached_property
    def parameters(self) -> dict[str, np.ndarray]:
        """What each draw is, by name, shape (draws,): PGV [m/s], PGA [g], period [s], azimuth [degrees] and the others.

        The period of a record is 2π PGV/PGA: that of the sine of the same two peaks.
        """
        prior = self.prior
        parameters = {"azimuth_deg": self.between("azimuth")}
        if prior.records:
            record, factor = self.one_of("record", prior.records), self.between("scale", "size")
            sizes = np.array([peaks(motion) for motion in prior.records])[record]
            parameters |= {"record": record.astype(float), "scale": factor, "pgv_m_s": factor * sizes[:, 0]}
            parameters |= {"pga_g": factor * sizes[:, 1] / g, "period_s": 2.0 * math.pi * sizes[:, 0] / sizes[:, 1]}
        else:
            parameters |= {name: self.between(name) for name in ("ellipticity", "cycles")}
            parameters |= {"period_s": self.between("period"), "phase_deg": 360.0 * self._uniform["phase"]}
            unit = np.array([peaks(self._unit(parameters, k))[1] for k in range(len(self))]) / g  # PGA of 1 m/s
            pgv = self.between("pgv", "size") if prior.pgv is not None else self.between("pga", "size") / unit
            parameters |= {"pgv_m_s": pgv, "pga_g": pgv * unit}
        parameters |= {"law": self.one_of("law", prior.law).astype(float)}
        damping = np.array(prior.stiffness_damping)
        parameters |= {"unknown_stiffness": self._uniform["unknown_stiffness"]}
        return parameters | {"stiffness_damping_s": damping[self.one_of("stiffness_damping", prior.stiffness_damping)]}

    def motion(self, k: int) -> Motion:
        """The motion of draw k."""
        p = self.parameters
        if not self.prior.records:
            return self._unit(p, k).scaled(float(p["pgv_m_s"][k]))
        record, angle = self.prior.records[int(p["record"][k])], math.radians(p["azimuth_deg"][k])
        x, y = record.samples, np.zeros(record.steps) if record.y_samples is None else record.y_samples
        c, s = math.cos(angle), math.sin(angle)
        return record.replace(acceleration=c * x - s * y, lateral=s * x + c * y).scaled(float(p["scale"][k]))

    @staticmethod
    def _unit(p: dict[str, np.ndarray], k: int) -> Motion:
        shape = {name: float(p[name][k]) for name in ("ellipticity", "cycles")}
        azimuth, phase = float(p["azimuth_deg"][k]), float(p["phase_deg"][k])
        return elliptical_pulse(float(p["period_s"][k]), 1.0, azimuth=azimuth, phase=phase, **shape)

    def on_joints(self, column: Column, k: int) -> Column:
        """A column on joints of the stiffness of draw k."""
        share = self.parameters["unknown_stiffness"][k : k + 1]
        return with_stiffness(column, float(unknown_stiffness(column, share)[0] ** self.prior.unknown_stiffness))

    def losses(self, column: Column, k: int, rolling: float) -> Losses:
        """What the joints of a column lose in draw k, whose own losses, where it has any, are not drawn.

        ``rolling`` is the resistance to rolling of the model.
        """
        law, own = self.prior.law[int(self.parameters["law"][k])], column.losses
        if own is not None:
            return dataclasses.replace(own, law=own.law or law)
        return Losses(float(self.parameters["stiffness_damping_s"][k]), rolling, law)


def peaks(motion: Motion) -> tuple[float, float]:
    """Largest lengths of the horizontal velocity [m/s] and acceleration [m/s²] of a motion."""
    axes = [values for axis, values in motion.components.items() if axis != "z"]
    speeds = [integrate(values, motion.dt) for values in axes]
    return float(np.sqrt(sum(v * v for v in speeds)).max()), float(np.sqrt(sum(a * a for a in axes)).max())
