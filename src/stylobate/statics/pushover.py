"""Pushover: the path of equilibrium of a stack of blocks under growing forces, and whether its joints bear its weight."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..atomic import replacing
from ..column import Column
from ..errors import InputError, check_choice, check_range, check_whole
from ..messages import say
from ..models.rigid_block.block_stack import SHEAR, BlockStack, Hold, link_strain, link_strains
from ..notebook import NotebookSummary
from .limit import (
    check_standing,
    crushing_forces,
    gravity_forces,
    horizontal_forces,
    joint_forces,
    mechanism_rows,
    towards,
)

if TYPE_CHECKING:
    import pandas


#: Names of the joint states, by their codes in the kernels.
STATES = ("elastic", "sliding", "rocking", "open")

#: Multipliers on a plateau differ by what Newton's method leaves out of balance; closer ones count as equal [g].
PLATEAU = 2e-7


@dataclass(frozen=True, eq=False)
class PushoverResult(NotebookSummary):
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


#: A link that has come to this share of its capacity goes on yielding, as far as the tangent is concerned.
GOES_ON = 1.0 - 1e-9


class PathLinks:
    """The links of a stack while a pushover analysis runs.

    ``plastic`` [m] is the slip or elongation that stays, ``lost`` which of them hold nothing any more.
    """

    def __init__(self, stack: BlockStack, geometric: bool) -> None:
        self.stack, self.links, self.geometric = stack, stack.links, geometric
        self.plastic, self.lost = np.zeros(len(self.links)), np.zeros(len(self.links), bool)
        self.force = np.zeros(len(self.links))

    def loads(self, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Forces on the blocks [N, N, N m], shape (3 n,), and −∂forces/∂position, shape (3 n, 3 n)."""
        strain, slope, opening = self._strains(position)
        forces, stiffness = np.zeros(len(self.links)), np.zeros(len(self.links))
        for k, link in enumerate(self.links):
            forces[k], stiffness[k], _ = self._law(k, link, strain[k], opening[k])
        tangent = slope.T @ (stiffness[:, None] * slope)
        if self.geometric and forces.any():
            tangent += self._turning(position, forces)
        self.force = forces
        return -slope.T @ forces, tangent

    def accept(self, position: np.ndarray) -> list[str]:
        """Keep what yields and what is lost in a state of equilibrium; names of those that are lost now."""
        strain, _, opening = self._strains(position)
        gone = []
        for k, link in enumerate(self.links):
            force, _, plastic = self._law(k, link, strain[k], opening[k])
            self.plastic[k] = plastic
            snapped = link.brittle and abs(force) >= link.capacity * (1.0 - 1e-9)
            if not self.lost[k] and (snapped or abs(strain[k]) > link.ultimate):
                self.lost[k] = True
                gone.append(link.name)
        return gone

    def _strains(self, position: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        if self.geometric:
            return link_strains(self.links, self.stack.centroid, self.stack.angle, position)
        _, slope, _ = link_strains(self.links, self.stack.centroid, self.stack.angle)
        return slope @ position.ravel(), slope, np.zeros(len(self.links))

    def _law(self, k: int, hold: Hold, strain: float, opening: float) -> tuple[float, float, float]:
        """Force [N], its derivative [N/m], and the slip or elongation that stays [m]."""
        stays = float(self.plastic[k])
        if self.lost[k] or opening > hold.lift:
            return 0.0, 0.0, stays
        if hold.action == SHEAR:
            beyond = strain - stays
            act = np.sign(beyond) * max(abs(beyond) - hold.slack, 0.0)
            force = hold.stiffness * act
            if abs(force) >= hold.capacity * GOES_ON:
                stays += float(np.sign(force)) * max(abs(force) - hold.capacity, 0.0) / hold.stiffness
                return float(np.sign(force)) * min(abs(force), hold.capacity), 0.0, stays
            return float(force), hold.stiffness if act else 0.0, stays
        force = hold.link.pretension + hold.stiffness * (strain - stays)
        if force >= hold.capacity * GOES_ON:
            return min(force, hold.capacity), 0.0, stays + max(force - hold.capacity, 0.0) / hold.stiffness
        return max(force, 0.0), hold.stiffness if force > 0.0 else 0.0, stays

    def _turning(self, position: np.ndarray, forces: np.ndarray) -> np.ndarray:
        """Share of the forces in the tangent because the links turn: central differences of their directions."""
        out, step = np.zeros((position.size, position.size)), 1e-6
        centroid, angle, tried = self.stack.centroid, self.stack.angle, position.copy()
        for link, force in zip(self.links, forces, strict=True):
            if force == 0.0:
                continue
            own = [3 * block + a for block in link.blocks if block >= 0 for a in range(3)]
            for i in own:
                tried.flat[i] = position.flat[i] + step
                ahead = link_strain(link, centroid, angle, tried)[2:]
                tried.flat[i] = position.flat[i] - step
                behind = link_strain(link, centroid, angle, tried)[2:]
                tried.flat[i] = position.flat[i]
                for block, after, before in zip(link.blocks, ahead, behind, strict=True):
                    if block >= 0:
                        out[3 * block : 3 * block + 3, i] += force * (after - before) / (2.0 * step)
        return out


#: Newton: largest number of iterations and of halvings of a correction, and the tolerance [weight of the column].
MAX_ITERATIONS, MAX_HALVINGS, TOLERANCE = 60, 12, 1e-9

#: A step is cut at most this often before the path counts as lost; the share of stiffness kept by the tangent.
MAX_CUTS, SOFT = 30, 1e-9

#: A path that goes on only in steps shorter than this counts as lost [base widths, or length along the path].
SHORTEST = 1e-14

#: A step that changes the multiplier by more has left the path for another one [g].
LARGEST_CHANGE = 0.02

#: Steps are cut where the path bends away from its tangent by more than this, so that no peak is stepped over [g].
LARGEST_BEND = 5e-5

#: The multiplier counts as rising while it does so with more than this share of the elastic column's slope.
RISING = 1e-4

#: A path without a given end is followed on while the multiplier rises, but not further than this [base widths].
FARTHEST = 100.0


class EquilibriumPath:
    """The state of a pushover analysis while it runs."""

    def __init__(
        self,
        stack: BlockStack,
        dead: np.ndarray,
        live: np.ndarray,
        strength: np.ndarray,
        geometric: bool,
        at: int | None = None,
    ) -> None:
        self.stack, self.dead, self.live, self.geometric = stack, dead, live, geometric
        self.geometry = joint_geometry(stack, strength)
        n = stack.n
        self.memory = np.zeros((n, 4))
        self.memory[:, 2] = 1.0
        self.links = PathLinks(stack, geometric) if stack.links else None
        self.position, self.multiplier = np.zeros((n, 3)), 0.0
        self.force, self.stiffness = np.empty((n, 3)), np.empty((3 * n, 3 * n))
        self.after, self.report = np.empty((n, 4)), np.empty((n, 6))
        self.at, self.led = at, (n if at is None else at) - 1
        self.arm = stack.top - stack.centroid[-1] if at is None else np.zeros(2)
        self.height = float(stack.top[1])
        self.rise = 0.0
        self.kept: list[tuple] = []
        self.link_forces: list[np.ndarray] = []
        # Rounding of positions of the size of the column causes a force of this size: a smaller tolerance cannot be met.
        rounding = 20.0 * np.finfo(float).eps * self.height * float(stack.normal_stiffness.max())
        self.tolerance = max(TOLERANCE, rounding / stack.weight)
        # Forces are compared with the weight, moments with weight × height.
        self.scale = np.tile([stack.weight, stack.weight, stack.weight * self.height], n)

    # -- one equilibrium ---------------------------------------------------------------------------------------------

    def top(self, position: np.ndarray) -> tuple[float, np.ndarray]:
        """Horizontal displacement of the top, or of the drum that is led [m]; its derivative by the coordinates, (3 n,)."""
        slope, own = np.zeros(position.size), 3 * self.led
        slope[own] = 1.0
        x, _, turn = position[self.led]
        if not self.geometric:
            slope[own + 2] = -self.arm[1]
            return float(x - self.arm[1] * turn), slope
        c, s = math.cos(turn), math.sin(turn)
        slope[own + 2] = -s * self.arm[0] - c * self.arm[1]
        return float(x + c * self.arm[0] - s * self.arm[1] - self.arm[0]), slope

    def residual(self, position: np.ndarray, multiplier: float) -> np.ndarray:
        """Forces out of balance [N, N, N m], shape (3 n,); fills the tangent and the report."""
        from ..kernels.rigid_block.static import assemble

        assemble(
            position,
            self.geometry,
            self.memory,
            self.geometric,
            SOFT,
            self.force,
            self.stiffness,
            self.after,
            self.report,
        )
        out = (self.force + self.dead + multiplier * self.live).ravel()
        if self.links is None:
            return out
        loads, tangent = self.links.loads(position)
        self.stiffness += tangent
        return out + loads

    def solve(self, constraint, position: np.ndarray, multiplier: float) -> tuple[np.ndarray, float] | str:
        """Newton's method with line search for equilibrium under a constraint; what stopped it where it fails.

        ``constraint(position, multiplier)`` gives its value and derivatives by the coordinates and by λ, all relative.
        """

        def measure(residual: np.ndarray, gap: float) -> float:
            return max(float(np.abs(residual / self.scale).max()), abs(gap))

        residual = self.residual(position, multiplier)
        gap, by_position, by_multiplier = constraint(position, multiplier)
        size = residual.size
        system = np.empty((size + 1, size + 1))
        error = measure(residual, gap)
        for _ in range(MAX_ITERATIONS):
            if error < self.tolerance:
                return position, multiplier
            system[:size, :size] = self.stiffness / self.scale[:, None]
            system[:size, size] = -self.live.ravel() / self.scale
            system[size, :size], system[size, size] = by_position, by_multiplier
            try:
                change = np.linalg.solve(system, np.append(residual / self.scale, -gap))
            except np.linalg.LinAlgError:
                return "the tangent stiffness is singular"
            best, share = None, 1.0
            eccentricity = self.report[:, 1].copy()
            for _ in range(MAX_HALVINGS):
                tried = self.moved(position, share * change[:size].reshape(-1, 3), eccentricity)
                tried_multiplier = multiplier + share * change[size]
                residual = self.residual(tried, tried_multiplier)
                gap, by_position, by_multiplier = constraint(tried, tried_multiplier)
                trial_error = measure(residual, gap)
                if np.isfinite(trial_error) and (best is None or trial_error < best[0]):
                    best = (trial_error, tried, tried_multiplier)
                if trial_error < (1.0 - 0.1 * share) * error:
                    break
                share *= 0.5
            if best is None:
                return "the forces are not finite"
            error, position, multiplier = best
            residual = self.residual(position, multiplier)
            gap, by_position, by_multiplier = constraint(position, multiplier)
        return f"after {MAX_ITERATIONS} iterations {error:.2g} of the weight is still out of balance"

    def accept(self, position: np.ndarray, multiplier: float) -> None:
        """Keep a state of equilibrium."""
        self.residual(position, multiplier)
        self.position, self.multiplier = position, multiplier
        self.memory[:] = self.after
        if self.links is not None:
            self.links.accept(position)
            self.link_forces.append(self.links.force.copy())
        self.eccentricity = self.report[:, 1].copy()
        self.kept.append((self.top(position)[0], multiplier, position, self.report.copy(), self.memory[:, 3].copy()))

    # -- the path ----------------------------------------------------------------------------------------------------

    def settle(self) -> str:
        """Equilibrium under the weight alone, where the path starts; returns what stopped it, empty if nothing did."""

        def unloaded(position: np.ndarray, multiplier: float) -> tuple[float, np.ndarray, float]:
            return multiplier, np.zeros(position.size), 1.0

        outcome = self.solve(unloaded, self.pressed(), 0.0)
        if isinstance(outcome, str):
            return outcome
        self.accept(*outcome)
        return ""

    def follow(self, control: str, to: float, *, extend: bool = False) -> PushoverResult:
        """Gravity, then step by step; steps grow while they succeed and are cut where they do not.

        With ``extend`` the path goes on beyond ``to`` for as long as the multiplier still rises.
        """
        lost = self.settle()
        if lost:
            raise InputError(
                f"the pushover could not start: no equilibrium was found under the weight alone ({lost}); raise the "
                "joints' normal_stiffness, or lower the tilt."
            )
        width = float(self.stack.width[0])
        # First step: a two-hundredth of g on the elastic column.
        length, shortest = 0.01, SHORTEST
        if control == "displacement":
            length, shortest = 0.005 / self.tangent()[1], SHORTEST * width
        cuts, start = 0, self.kept[0][0]
        while True:
            moved = self.kept[-1][0] - start
            if abs(moved) >= to * (1.0 - 1e-9):
                if not (extend and to < FARTHEST * width and self.rises()):
                    return self.result(
                        True, say("the control displacement of {far:g} m was reached.", far=math.copysign(to, moved))
                    )
                to *= 2.0
            if len(self.kept) > 2 and self.multiplier <= 0.0:
                return self.result(True, say("the load multiplier has fallen to zero."))
            gone = self.off_support()
            if gone:
                return self.result(True, say("the part above joint {joint} has slid off its support.", joint=gone))
            if control == "displacement":
                longest = min(0.005 * width, to / 100.0) if self.geometric else to / 100.0
                length = math.copysign(min(abs(length), longest, to - abs(moved)), length)
                outcome = self.displaced(length)
            else:
                length = min(length, 0.05)
                outcome = self.along(length)
            if not isinstance(outcome, str) and abs(outcome[1] - self.multiplier) > LARGEST_CHANGE:
                outcome = f"the multiplier would jump from {self.multiplier:.4g} to {outcome[1]:.4g} g"
            if not isinstance(outcome, str) and cuts < MAX_CUTS // 2:
                ahead = (self.top(outcome[0])[0] - self.top(self.position)[0]) * self.rise
                if abs(outcome[1] - self.multiplier - ahead) > LARGEST_BEND:
                    outcome = "the path bends"
            if isinstance(outcome, str):
                cuts += 1
                length *= 0.5
                if cuts > MAX_CUTS or abs(length) < shortest:
                    return self.result(False, f"step {len(self.kept)}: {outcome}, with the step cut again and again.")
                continue
            self.accept(*outcome)
            cuts = 0
            length *= 1.5

    def rises(self) -> bool:
        """Whether the multiplier was never higher than now, and is going to be."""
        if self.multiplier < max(item[1] for item in self.kept):
            return False
        stack, slope = self.stack, self.top(np.zeros_like(self.position))[1]
        flexible = np.column_stack((stack.normal_stiffness, stack.shear_stiffness, stack.rotational_stiffness))
        strain = stack.compatibility()
        elastic = 1.0 / float(
            slope @ np.linalg.solve(strain.T @ (flexible.ravel()[:, None] * strain), self.live.ravel())
        )
        return self.tangent()[1] > RISING * elastic

    def off_support(self) -> int:
        """First joint (from 1) whose faces overlap by less than a twentieth of the joint's width; 0 if none."""
        g, slip = self.geometry, self.memory[:, 3]
        overlap = np.minimum(g[:, 6], g[:, 8] - slip) - np.maximum(g[:, 5], g[:, 7] - slip)
        short = np.flatnonzero(overlap < 0.05 * self.stack.width)
        return int(short[0]) + 1 if short.size else 0

    def tangent(self) -> tuple[np.ndarray, float]:
        """Direction of the path: change of the coordinates, shape (n, 3), and of λ for one metre of the top."""
        self.residual(self.position, self.multiplier)
        slope = self.top(self.position)[1]
        size = slope.size
        system = np.zeros((size + 1, size + 1))
        system[:size, :size] = self.stiffness / self.scale[:, None]
        system[:size, size] = -self.live.ravel() / self.scale
        system[size, :size] = slope
        ahead = np.linalg.solve(system, np.append(np.zeros(size), 1.0))
        self.rise = float(ahead[size])
        return ahead[:size].reshape(-1, 3), float(ahead[size])

    def pressed(self) -> np.ndarray:
        """Displacements under the dead load with all joints closed [m, m, rad], shape (n, 3): where Newton starts."""
        loads = self.dead
        if self.links is not None:  # what they are pretensioned with
            loads = loads + self.links.loads(np.zeros_like(self.position))[0].reshape(-1, 3)
        n, v, e = joint_forces(self.stack, loads)
        stack = self.stack
        strain = (-n / stack.normal_stiffness, -v / stack.shear_stiffness, -n * e / stack.rotational_stiffness)
        return np.linalg.solve(stack.compatibility(), np.column_stack(strain).ravel()).reshape(-1, 3)

    def displaced(self, step: float) -> tuple[np.ndarray, float] | str:
        """Equilibrium with the top a step further."""
        scale = 1.0 / (1e-3 * self.height)
        wanted = self.top(self.position)[0] + step

        def constraint(position: np.ndarray, multiplier: float) -> tuple[float, np.ndarray, float]:
            top, slope = self.top(position)
            return (top - wanted) * scale, slope * scale, 0.0

        ahead, rise = self.tangent()
        start = self.moved(self.position, step * ahead, self.eccentricity), self.multiplier + step * rise
        return self.solve(constraint, *start)

    def moved(self, position: np.ndarray, change: np.ndarray, eccentricity: np.ndarray) -> np.ndarray:
        """The coordinates after a finite change that keeps the joints' contact points in place, shape (n, 3)."""
        if not self.geometric:
            return position + change
        from ..kernels.rigid_block.static import carried

        out = np.empty_like(position)
        carried(position, change, eccentricity, self.geometry, out)
        return out

    def along(self, length: float) -> tuple[np.ndarray, float] | str:
        """Equilibrium at a distance along the path: √((Δu_top / height)² + (Δλ / 0.1 g)²)."""
        top, multiplier = self.top(self.position)[0], self.multiplier

        def constraint(position: np.ndarray, tried: float) -> tuple[float, np.ndarray, float]:
            place, slope = self.top(position)
            far, change = (place - top) / self.height, (tried - multiplier) / 0.1
            distance = max(math.hypot(far, change), 1e-3 * length)
            share = 1.0 / (distance * length)
            return distance / length - 1.0, share * far / self.height * slope, share * change / 0.1

        ahead, rise = self.tangent()
        step = length / math.hypot(1.0 / self.height, rise / 0.1)
        start = self.moved(self.position, step * ahead, self.eccentricity), multiplier + step * rise
        outcome = self.solve(constraint, *start)
        if not isinstance(outcome, str) and self.top(outcome[0])[0] <= top:
            return "the path turns back on itself"
        return outcome

    def result(self, complete: bool, stop: str) -> PushoverResult:
        """Findings so far."""
        report = np.array([item[3] for item in self.kept])
        return PushoverResult(
            displacement=np.array([item[0] for item in self.kept]) - self.kept[0][0],
            multiplier=np.array([item[1] for item in self.kept]),
            position=np.array([item[2] for item in self.kept]),
            states=report[:, :, 3].astype(int),
            compression=report[:, :, 0],
            shear=report[:, :, 2],
            eccentricity=report[:, :, 1],
            opening=report[:, :, 4],
            rotation=report[:, :, 5],
            slip=np.array([item[4] for item in self.kept]),
            complete=complete,
            peaked=not self.rises(),
            stop=stop,
            geometric=self.geometric,
            arms=self.height - self.stack.joint[:, 1],
            links=tuple((link.name, link.action) for link in self.stack.links),
            link_force=np.array(self.link_forces).reshape(len(self.kept), len(self.stack.links)),
            at=self.at,
        )


def joint_geometry(stack: BlockStack, strength: np.ndarray) -> np.ndarray:
    """Rows of the kernels' ``GEOMETRY`` for each joint, shape (n, 15)."""
    above = stack.joint - stack.centroid
    below = stack.joint.copy()
    below[1:] -= stack.centroid[:-1]
    return np.column_stack(
        (
            above,
            below,
            stack.angle,
            stack.upper_reach,
            stack.lower_reach,
            stack.normal_stiffness,
            stack.rotational_stiffness,
            stack.shear_stiffness,
            stack.friction,
            stack.cohesion,
            1.0 / strength,
        )
    )


#: Stiffness that is looked for at most, over the given one, and how closely [-].
STIFFEST, PRECISION = 2.0**40, 1e-4


def check_stable(stack: BlockStack, dead: np.ndarray, strength: np.ndarray) -> None:
    """Refuse a column that buckles under its own weight, because its joints are too soft for it.

    One block on its base is stable for k_n J > W z_C; it then rights itself from a small rotation.

    Parameters
    ----------
    stack : BlockStack
    dead : array
        Weight of each block [N, N, N m], shape (n, 3).
    strength : array
        f_c A of each joint [N], shape (n,).

    Raises
    ------
    InputError
        Names the joint that is softest for what it carries, and the stiffness needed.
    """

    def stands(factor: float) -> bool:
        return stable(_stiffer(stack, factor), dead, strength)

    if stands(1.0):
        return
    high = 2.0
    while not stands(high):
        high *= 2.0
        if high > STIFFEST:
            return  # The stiffness is not the cause; the pushover reports the real one.
    low = 0.5 * high
    while high - low > PRECISION * low:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if stands(middle) else (middle, high)
    mass, centroid = stack.parts_above()
    softness = mass * stack.gravity * (centroid - stack.joint)[:, 1] / stack.rotational_stiffness
    worst = int(np.argmax(softness))
    given = stack.normal_stiffness[worst] / stack.area[worst]
    others = "" if stack.n == 1 else f", and {high:.4g} times as much as given in all other joints"
    raise InputError(
        f"the column buckles under its own weight, first of all on joint {worst + 1}: its normal_stiffness is "
        f"{given:.4g} N/m³; needed is more than {high * given:.4g} N/m³{others}."
    )


def stable(stack: BlockStack, dead: np.ndarray, strength: np.ndarray) -> bool:
    """Whether a stack has an upright equilibrium under its weight in which every small displacement takes work."""
    path = EquilibriumPath(stack, dead, np.zeros_like(dead), strength, geometric=True)
    if path.settle() or float(np.abs(path.position[:, 2]).max()) > 0.5 * math.pi:
        return False
    path.residual(path.position, 0.0)
    # Scaled so that forces and moments are comparable; this changes no sign of an eigenvalue.
    unit = 1.0 / np.sqrt(np.tile([1.0, 1.0, path.height**2], stack.n))
    tangent = path.stiffness * np.outer(unit, unit)
    return bool(np.linalg.eigvalsh(0.5 * (tangent + tangent.T))[0] > 0.0)


def _stiffer(stack: BlockStack, factor: float) -> BlockStack:
    return replace(
        stack,
        normal_stiffness=factor * stack.normal_stiffness,
        rotational_stiffness=factor * stack.rotational_stiffness,
        shear_stiffness=factor * stack.shear_stiffness,
        # Friction is left out: a joint that slides is not one that is too soft.
        cohesion=np.full(stack.n, np.inf),
    )


CONTROLS = ("displacement", "arc-length")


def pushover(
    column: Column | BlockStack,
    *,
    pattern: Sequence[float] | None = None,
    control: str = "displacement",
    geometric: bool = True,
    to: float | None = None,
    at: int | None = None,
    base_tilt: float = 0.0,
    direction: float = 0.0,
    compressive_strength: float | None = None,
) -> PushoverResult:
    """Follow the equilibrium of a column under its weight and growing horizontal forces, over the peak and down.

    The forces push towards +x, or to the other side with ``direction=180``. What is found then is told as seen in a
    mirror: the forces push to the right again.

    Parameters
    ----------
    column : Column or BlockStack
    pattern : sequence of float, optional
        Relative horizontal force on each drum, bottom to top; proportional to mass by default. Their sum is λ W.
    control : {"displacement", "arc-length"}
        What is prescribed in a step: the displacement of the top, or the length of the step along the path.
    geometric : bool
        Equilibrium in the displaced state (large rotations), else in the undisplaced one.
    to : float, optional
        Displacement of the top at which to stop [m], whether or not the column has given way before. By default the
        path is followed until the multiplier is zero or the top has moved by two base widths (geometric), or to a tenth
        of the base width; and on from there while the multiplier still rises.
    at : int, optional
        Drum, from 1 at the base, whose centroid is led and told of instead of the top: of what a tie holds at its top.
    base_tilt : float
        Tilt of the base, downhill towards +x, where the forces push along it [degrees]; a negative one makes them push
        uphill. A column as found brings its own ``base_tilt``, counted the other way, counter-clockwise; its forces are
        horizontal.
    direction : {0, 180}
        Where the forces push to [degrees].
    compressive_strength : float, optional
        f_c of the joints [Pa]; unlimited by default.

    Returns
    -------
    PushoverResult
        Where the path is lost, its part so far, and the reason. Where it ends before the multiplier has stopped rising,
        ``peaked`` is false and the collapse multiplier NaN.

    Raises
    ------
    InputError
        The column cannot stand under its own weight, because it overturns, slides, crushes, or buckles on joints that are
        too soft for it; or an argument cannot be used.
    """
    check_choice("`control`", control, CONTROLS)
    stack = towards(column, direction)
    if at is not None:
        check_whole("`at`", at, 1, stack.n, remedy="it is a drum, from 1 at the base")
    if to is None:
        end = (2.0 if geometric else 0.1) * float(stack.width[0])
    else:
        remedy = "the forces push towards +x, so must it"
        end = check_range("control displacement", to, 0.0, 1e3, unit="m", open_low=True, remedy=remedy)
    strength = crushing_forces(stack, compressive_strength)
    dead = gravity_forces(stack, base_tilt)
    live = horizontal_forces(stack, pattern)
    check_standing(stack, dead, strength, base_tilt)
    if geometric:
        check_stable(stack, dead, strength)
    return EquilibriumPath(stack, dead, live, strength, geometric, at).follow(control, end, extend=to is None)
