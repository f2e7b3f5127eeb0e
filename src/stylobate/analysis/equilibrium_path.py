"""Path following: equilibrium of a stack of blocks under growing forces, step by step, by Newton's method."""

from __future__ import annotations

import math

import numpy as np

from ..errors import InputError
from ..messages import say
from ..models.rigid_block.block_stack import BlockStack
from .path_links import PathLinks
from .pushover_result import PushoverResult
from .static_loads import joint_forces

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
                found = measure(residual, gap)
                if np.isfinite(found) and (best is None or found < best[0]):
                    best = (found, tried, tried_multiplier)
                if found < (1.0 - 0.1 * share) * error:
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

        found = self.solve(unloaded, self.pressed(), 0.0)
        if isinstance(found, str):
            return found
        self.accept(*found)
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
                found = self.displaced(length)
            else:
                length = min(length, 0.05)
                found = self.along(length)
            if not isinstance(found, str) and abs(found[1] - self.multiplier) > LARGEST_CHANGE:
                found = f"the multiplier would jump from {self.multiplier:.4g} to {found[1]:.4g} g"
            if not isinstance(found, str) and cuts < MAX_CUTS // 2:
                ahead = (self.top(found[0])[0] - self.top(self.position)[0]) * self.rise
                if abs(found[1] - self.multiplier - ahead) > LARGEST_BEND:
                    found = "the path bends"
            if isinstance(found, str):
                cuts += 1
                length *= 0.5
                if cuts > MAX_CUTS or abs(length) < shortest:
                    return self.result(False, f"step {len(self.kept)}: {found}, with the step cut again and again.")
                continue
            self.accept(*found)
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
        found = self.solve(constraint, *start)
        if not isinstance(found, str) and self.top(found[0])[0] <= top:
            return "the path turns back on itself"
        return found

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
