"""Result of a pushover analysis: the equilibrium path, its peak, where it falls to zero, and the mechanism behind it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..atomic import replacing
from ..notebook import Shown

if TYPE_CHECKING:
    import pandas

#: Names of the joint states, by their codes in the kernels.
STATES = ("elastic", "sliding", "rocking", "open")

#: Multipliers on a plateau differ by what Newton's method leaves out of balance; closer ones count as equal [g].
PLATEAU = 2e-7


def mechanism_rows(mechanism: np.ndarray) -> list[dict[str, float]]:
    """One row per drum: x, z and rotation for a unit horizontal movement of the drum that moves most."""
    return [
        {"drum": i + 1, "x": float(x), "z": float(z), "rotation_rad_per_m": float(turn)}
        for i, (x, z, turn) in enumerate(mechanism)
    ]


@dataclass(frozen=True, eq=False)
class PushoverResult(Shown):
    """Equilibrium path of a pushover analysis, as far as it was found.

    Parameters
    ----------
    displacement : array
        Horizontal displacement of the middle of the top, or of the centroid of drum ``at`` [m], shape (steps,).
    multiplier : array
        Load multiplier [g], shape (steps,).
    position : array
        Displacement of each block's centroid in x and z [m] and its rotation [rad], shape (steps, n, 3).
    states : array
        State of each joint, index into :data:`STATES`, shape (steps, n).
    compression, shear, eccentricity : array
        N [N], V on the part above [N], M/N [m], each of shape (steps, n).
    opening, rotation, slip : array
        Opening at the wider edge [m], relative rotation [rad], slip [m] of each joint, each of shape (steps, n).
    complete : bool
        Whether the path was followed to where it was meant to end.
    peaked : bool
        Whether the multiplier had stopped rising before the path ended. Where it had not, the collapse multiplier is
        unknown, and :attr:`largest_multiplier` a lower bound of it.
    stop : str
        Where and why the path ends.
    geometric : bool
        Whether equilibrium is in the displaced state.
    arms : array
        Height of the top above each joint [m], shape (n,).
    links : tuple of (str, str)
        Name of each link and what it does: ``shear``, ``closing`` of its joint, ``line``.
    link_force : array
        What each of them holds [N], shape (steps, links).
    at : int, optional
        Drum, from 1, whose movement is told instead of that of the top.
    """

    displacement: np.ndarray
    multiplier: np.ndarray
    position: np.ndarray
    states: np.ndarray
    compression: np.ndarray
    shear: np.ndarray
    eccentricity: np.ndarray
    opening: np.ndarray
    rotation: np.ndarray
    slip: np.ndarray
    complete: bool
    peaked: bool
    stop: str
    geometric: bool
    arms: np.ndarray
    links: tuple[tuple[str, str], ...] = ()
    link_force: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))
    at: int | None = None

    @property
    def peak(self) -> int:
        """Step at which the multiplier first has its largest value, within what equilibrium is found to."""
        return int(np.argmax(self.multiplier >= self.multiplier.max() - PLATEAU))

    @property
    def largest_multiplier(self) -> float:
        """Largest multiplier on the path [g]."""
        return float(self.multiplier.max())

    @property
    def collapse_multiplier(self) -> float:
        """Multiplier at which the column gives way [g]; NaN where the path ends while the multiplier still rises."""
        return self.largest_multiplier if self.peaked else math.nan

    @property
    def peak_displacement(self) -> float:
        """Displacement of the top at which the column gives way [m]; NaN where the path ends before."""
        return float(self.displacement[self.peak]) if self.peaked else math.nan

    @property
    def ultimate_displacement(self) -> float:
        """Displacement of the top at which the multiplier has fallen to zero [m]; NaN where the path ends before."""
        place = self._zero()
        return math.nan if place is None else float(np.interp(place, *self._along(self.displacement)))

    def rotation_at_zero(self, joint: int) -> float:
        """Relative rotation of a joint (from 1) where the multiplier has fallen to zero [rad]; NaN if it has not."""
        place = self._zero()
        return math.nan if place is None else float(np.interp(place, *self._along(self.rotation[:, joint - 1])))

    def _along(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.arange(len(values)), values

    def _zero(self) -> float | None:
        # Place (step number, fractional) of the first multiplier ≤ 0 behind the peak, linear between two steps.
        fallen = np.flatnonzero(self.multiplier[self.peak :] <= 0.0)
        if not fallen.size or self.peak == 0:
            return None
        k = self.peak + int(fallen[0])
        before, after = self.multiplier[k - 1], self.multiplier[k]
        return k - 1 + float(before / (before - after))

    @property
    def mechanism(self) -> np.ndarray:
        """Movement of the blocks for a unit horizontal movement of the fastest, shape (n, 3): behind the peak, if any."""
        start = self.peak if self.peak < len(self.multiplier) - 1 else 0
        move = self.position[-1] - self.position[start]
        return move / np.abs(move[:, 0]).max()

    @property
    def governing_joint(self) -> int:
        """Joint (from 1) whose rotation or slip contributes most to the movement of the top behind the peak.

        Where the path never peaked: to the movement so far, of a column that may have all its joints closed.
        """
        start = self.peak if self.peak < len(self.multiplier) - 1 else 0
        turned = np.abs(self.rotation[-1] - self.rotation[start]) * self.arms
        slid = np.abs(self.slip[-1] - self.slip[start])
        return int(np.argmax(turned + slid)) + 1

    def summary(self) -> dict[str, Any]:
        """The JSON object of ``stylobate pushover``; null where the path ends before the column gives way."""
        return {
            "collapse_multiplier_g": self.collapse_multiplier,
            "peaked": self.peaked,
            "largest_multiplier_g": self.largest_multiplier,
            "peak_displacement_m": self.peak_displacement,
            "ultimate_displacement_m": self.ultimate_displacement,
            "governing_joint": self.governing_joint if self.peaked else None,
            "led_drum": self.at,
            "complete": self.complete,
            "stop": self.stop,
            "steps": len(self.multiplier),
            "curve": {"displacement_m": self.displacement.tolist(), "multiplier_g": self.multiplier.tolist()},
            "mechanism": mechanism_rows(self.mechanism),
            "links": [
                {"link": name, "action": action, "largest_force_n": float(abs(self.link_force[:, k]).max())}
                for k, (name, action) in enumerate(self.links)
            ],
            "joint_states": [[STATES[state] for state in step] for step in self.states[[self.peak, -1]]],
        }

    def to_frame(self) -> pandas.DataFrame:
        """The path as a table: one row per step, joints numbered from 1."""
        import pandas

        what = "top" if self.at is None else f"drum_{self.at}"
        table = {"step": np.arange(len(self.displacement)), f"{what}_displacement_m": self.displacement}
        table["multiplier_g"] = self.multiplier
        names = np.array(STATES)
        for i in range(self.states.shape[1]):
            table[f"joint_{i + 1}_state"] = names[self.states[:, i]]
            table[f"joint_{i + 1}_rotation_rad"] = self.rotation[:, i]
            table[f"joint_{i + 1}_opening_m"] = self.opening[:, i]
            table[f"joint_{i + 1}_slip_m"] = self.slip[:, i]
            table[f"joint_{i + 1}_eccentricity_m"] = self.eccentricity[:, i]
        for k, (name, action) in enumerate(self.links):
            table[f"{name}, {action}, N"] = self.link_force[:, k]
        return pandas.DataFrame(table)

    def save(self, path: str | Path) -> Path:
        """Write the path as CSV, whole or not at all; returns where."""
        target = Path(path)
        with replacing(target) as partial:
            self.to_frame().to_csv(partial, index=False)
        return target
