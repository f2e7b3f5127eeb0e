"""Losses of a column from its free motion: with intervals, in words, as a file, and as motions to be drawn."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from stylobate.column import Column
from stylobate.column.files import write_losses
from stylobate.column.joint import Losses
from stylobate.column.scatter import LARGEST
from stylobate.errors import InputError
from stylobate.messages import percent
from stylobate.models.drums.impact import Free, one_body, released
from stylobate.models.drums.stepped import LossyDrums
from stylobate.models.start import Start
from stylobate.notebook import NotebookSummary

from .free_history import FreeHistory
from .loss_likelihood import Posterior
from .swings import Wobble

#: A loss is not told from below where its interval begins no farther from the least than one of which nothing is known and
#: this share of the way to the most; nor from above likewise.
AT_LIMIT = 0.05

#: Two losses are not told apart where the correlation of their logarithms goes beyond this.
TOGETHER = 0.8

#: Rate at which a wobble's direction turns at its beginning is known to this share at best, beside its noise [-].
RATE = 0.1

#: Draws of the band in the picture, and states of each motion.
DRAWS, STATES = 16, 4000


class Loss(NamedTuple):
    """One loss.

    Parameters
    ----------
    value, low, high : float
        The likeliest, and the limits of the interval.
    reaches : str
        Limits of what was looked for which the interval reaches: ``least``, ``most``, both, or nothing.
    """

    value: float
    low: float
    high: float
    reaches: str

    @property
    def bounded(self) -> bool:
        """Whether the history tells it from both sides."""
        return not self.reaches


@dataclass(frozen=True, eq=False)
class Calibration(NotebookSummary):
    """Losses of a column from its free motion.

    Parameters
    ----------
    column : Column
    model : LossyDrums
        What computed the motions.
    history : FreeHistory
    confidence : float
        Of intervals.
    noise : float
        Standard deviation of the measured tilt [rad].
    measured : Free
        Time [s] and lean of the history [rad].
    beginning : Wobble
        From which motions were computed.
    edges : array
        Extremes of swings in a plane, or the ends of windows of a wobble: times of :attr:`amplitudes` [s].
    amplitudes : array
        Extremes, or the largest lean of each window [rad].
    after : Posterior
    limits : tuple
        Of each loss, between which it was looked for.
    restitution : Loss or None
        Of an impact, by extremes alone (in a plane).
    """

    column: Column
    model: LossyDrums
    history: FreeHistory
    confidence: float
    noise: float
    measured: Free
    beginning: Wobble
    edges: np.ndarray
    amplitudes: np.ndarray
    after: Posterior
    limits: tuple[tuple[float, float], ...]
    restitution: Loss | None

    @cached_property
    def laws(self) -> dict[str, float]:
        """Share of each law of round faces that was tried; empty where the column has corners."""
        return {law: self.after.share(law) for law in dict.fromkeys(self.after.laws) if law is not None}

    @cached_property
    def losses(self) -> Losses:
        """Those of the motion that is likest the measured one."""
        law, at = self.after.likeliest()
        return losses_at(at, self.limits, law)

    @cached_property
    def intervals(self) -> dict[str, Loss]:
        """Each loss with its interval, over all laws."""
        losses, near = {}, 0.5 * (1.0 - self.confidence) + AT_LIMIT
        for i, (name, limits) in enumerate(zip(("stiffness_damping", "rolling_resistance"), self.limits)):
            low, high = self.after.interval(i, self.confidence)
            reaches = " and ".join(["least"] * (low < near) + ["most"] * (high > 1.0 - near))
            losses[name] = Loss(getattr(self.losses, name), between(low, limits), between(high, limits), reaches)
        return losses

    @property
    def apart(self) -> bool | None:
        """Whether the history tells the two losses apart; None of one."""
        if len(self.limits) < 2:
            return None
        return abs(self.after.correlation()) < TOGETHER and all(loss.bounded for loss in self.intervals.values())

    @property
    def sentence(self) -> str:
        """What the history tells, in words."""
        words = []
        for name, loss in self.intervals.items():
            unit = " s" if name == "stiffness_damping" else ""
            span = f"{loss.low:.2g} to {loss.high:.2g}{unit}"
            if loss.bounded:
                words.append(f"{name} is {loss.value:.2g}{unit} ({span}, {percent(self.confidence)}).")
            elif loss.reaches == "least":
                words.append(f"{name} is at most {loss.high:.2g}{unit}: this history tells no lower limit.")
            elif loss.reaches == "most":
                words.append(f"{name} is at least {loss.low:.2g}{unit}: this history tells no upper limit.")
            else:
                words.append(f"{name} is not told by this history.")
        if self.laws:
            words.append("Law: " + ", ".join(f"{name} {percent(share)}" for name, share in self.laws.items()) + ".")
        if self.apart is False:
            words.append("It does not tell stiffness_damping and rolling_resistance apart: take them as a pair.")
        if not self.after.reached:
            words.append("No losses that were tried let it die away as it does: these are none to be used.")
        return " ".join(words)

    def scatter(self) -> dict[str, float]:
        """What is left unknown as parts of a :class:`~stylobate.Scatter`: spreads of losses, share of other laws."""
        from scipy.special import ndtri

        wide = 2.0 * float(ndtri(0.5 * (1.0 + self.confidence)))
        spreads = {}
        for name, loss in self.intervals.items():
            sigma = math.log(loss.high / loss.low) / wide
            spreads[name] = min(math.sqrt(math.expm1(sigma**2)), LARGEST[name]) if sigma < 3.0 else LARGEST[name]
        if self.laws:
            spreads["law"] = 1.0 - self.laws[str(self.losses.law)]
        return spreads

    def motions(self, number: int = DRAWS) -> list[Free]:
        """Motion with the likeliest losses, then with so many draws of them, from the beginning on."""
        wanted = [self.after.likeliest(), *self.after.drawn(number)]
        duration = float(self.measured.time[-1] - self.beginning.time)
        losses = [losses_at(at, self.limits, law) for law, at in wanted]
        starts = [start_of(self.beginning, at[len(self.limits) :]) for _, at in wanted]
        return released(self.column, self.model, losses, starts, duration, max(duration / STATES, 1e-4))

    def save(self, path: str | Path) -> Path:
        """Write the file of losses that ``--losses`` takes (TOML).

        Raises
        ------
        InputError
            No losses that were tried let the motion die away as it does.
        """
        if not self.after.reached:
            raise InputError(f"no file of losses of {self.history.name}: {self.sentence}")
        interval: dict[str, Any] = {"confidence": self.confidence}
        interval |= {name: [loss.low, loss.high] for name, loss in self.intervals.items()}
        measured = {
            "column": self.column.name,
            "history": self.history.name,
            "model": self.model.name,
            "normal_stiffness": self.column.joints[0].normal_stiffness,
            "decrements": len(self.amplitudes) - 1,
            "discrepancy": self.after.discrepancy,
            "said": self.sentence,
        }
        return write_losses(self.losses, path, interval, measured)

    def summary(self) -> dict[str, Any]:
        """Plain values, as ``stylobate calibrate`` prints them."""
        fields: dict[str, Any] = {"column": self.column.name, "model": self.model.name, "history": self.history.name}
        for name, loss in self.intervals.items():
            fields[name] = {
                "value": loss.value,
                "low": loss.low,
                "high": loss.high,
                "told": loss.bounded,
                "reaches": loss.reaches,
            }
        fields["law"], fields["laws"] = self.losses.law, self.laws
        fields["restitution"] = None
        if self.restitution is not None:
            value, low, high, _ = self.restitution
            rigid = one_body(self.column).restitution
            fields["restitution"] = {"value": value, "low": low, "high": high, "housner": rigid}
        return fields | {
            "confidence": self.confidence,
            "told_apart": self.apart,
            "correlation": None if len(self.limits) < 2 else self.after.correlation(),
            "reached": self.after.reached,
            "decrements": len(self.amplitudes) - 1,
            "discrepancy": self.after.discrepancy,
            "noise_rad": self.noise,
            "first_tilt_rad": self.beginning.tilt,
            "precession_rad_s": self.beginning.rate,
            "normal_stiffness": self.column.joints[0].normal_stiffness,
            "scatter": self.scatter(),
            "sentence": self.sentence,
        }


def between(share: float, limits: tuple[float, float]) -> float:
    """Value at a share of the way between two limits, by their logarithms."""
    return limits[0] * (limits[1] / limits[0]) ** float(share)


def losses_at(shares: np.ndarray, limits: tuple[tuple[float, float], ...], law: str | None) -> Losses:
    """Losses of a law at some shares of the way between their limits; of unknowns that begin with these."""
    return Losses(*[between(share, both) for share, both in zip(shares[: len(limits)], limits, strict=True)], law=law)


def start_of(begin: Wobble, others: np.ndarray) -> Start:
    """Pose and velocity at the beginning of a motion.

    Of a wobble two things are known badly, or not at all: the rate at which its direction turns, and whether the body turns
    about its own axis as well, from not at all to with its direction. Both are given as shares of what may be.
    """
    from scipy.special import ndtri

    if not len(others):
        return Start(begin.tilt, begin.azimuth)
    rate = begin.rate + math.hypot(begin.error, RATE * begin.rate) * float(ndtri(0.02 + 0.96 * others[0]))
    across = math.sin(begin.tilt)
    axis = np.array([across * math.cos(begin.azimuth), across * math.sin(begin.azimuth), math.cos(begin.tilt)])
    upright = np.array([0.0, 0.0, rate])
    spin = upright - (1.0 - float(others[1])) * (upright @ axis) * axis
    return Start(begin.tilt, begin.azimuth, (float(spin[0]), float(spin[1]), float(spin[2])))
