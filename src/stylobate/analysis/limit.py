"""Limit analysis of the rigid–plastic column: lower and upper bound by linear programmes, mechanism, active joints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..column import Column
from ..errors import InputError, StylobateError
from ..models.rigid_block.block_stack import BlockStack
from .static_loads import check_standing, contact_limits, crushing_forces, gravity_forces, horizontal_forces

#: A joint's strength counts as used up when less than this share of it is left [-].
ACTIVE = 1e-7

FLOWS = ("non-associated", "associated")

_TIGHT = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}


@dataclass(frozen=True)
class ActiveJoint:
    """A joint that takes part in the mechanism.

    Parameters
    ----------
    joint : int
        Counted from 1 at the base.
    mode : str
        ``rocking right``, ``rocking left``, ``sliding right``, ``sliding left``: what the part above does.
    rate : float
        Relative rotation [rad] or slip [m] per metre that the fastest block moves.
    """

    joint: int
    mode: str
    rate: float


@dataclass(frozen=True, eq=False)
class LimitResult:
    """Result of :func:`limit_analysis`.

    Parameters
    ----------
    multiplier : float
        Collapse multiplier λ: horizontal forces of λ times the weight make the column a mechanism [g].
    lower, upper : float
        Bounds of the static and the kinematic programme [g].
    mechanism : array
        Velocities of each block's centroid and its rotation, for a unit horizontal velocity of the fastest block:
        x, z [m], rotation counter-clockwise positive [rad], shape (n, 3).
    active : tuple of ActiveJoint
    compression, shear, eccentricity : array
        Joint forces at collapse: N [N], V [N] on the part above, towards +x positive, and M/N [m], shape (n,).
    at_limit : tuple of int
        Joints whose strength is used up, whether or not the mechanism shown uses them; counted from 1.
    flow : str
        Flow rule of the mechanism that is shown.
    """

    multiplier: float
    lower: float
    upper: float
    mechanism: np.ndarray
    active: tuple[ActiveJoint, ...]
    compression: np.ndarray
    shear: np.ndarray
    eccentricity: np.ndarray
    at_limit: tuple[int, ...]
    flow: str

    @property
    def governing_joint(self) -> int:
        """Lowest joint of the mechanism, counted from 1."""
        return min(item.joint for item in self.active)


def limit_analysis(
    column: Column | BlockStack,
    *,
    pattern: Sequence[float] | None = None,
    base_tilt: float = 0.0,
    direction: float = 0.0,
    flow: str = "non-associated",
    compressive_strength: float | None = None,
) -> LimitResult:
    """Collapse multiplier of horizontal forces on a column of rigid blocks, from below and from above.

    The forces push towards +x, or to the other side with ``direction=180``. What is found then is told as seen in a
    mirror: the forces push to the right again.

    Parameters
    ----------
    column : Column or BlockStack
    pattern : sequence of float, optional
        Relative horizontal force on each drum, bottom to top; proportional to mass by default. Their sum is λ W.
    base_tilt : float
        Tilt of the base, downhill towards +x, where the forces push along it [degrees]; a negative one makes them push
        uphill. A column as found brings its own ``base_tilt``, counted the other way, counter-clockwise; its forces are
        horizontal.
    direction : {0, 180}
        Where the forces push to [degrees], in the plane; in space see
        :func:`stylobate.analysis.limit_directions.limit_in_space`.
    flow : {"non-associated", "associated"}
        Flow rule of friction in the mechanism: sliding without or with dilatancy tan φ. In a stack the joint forces
        follow from equilibrium alone, so that the multiplier is the same.
    compressive_strength : float, optional
        f_c of the joints [Pa]; unlimited by default.

    Returns
    -------
    LimitResult

    Raises
    ------
    InputError
        The column cannot stand under its own weight, or an argument cannot be used.
    """
    if flow not in FLOWS:
        raise InputError(f"flow is {flow!r}; allowed are {', '.join(FLOWS)}.")
    stack = towards(column, direction)
    strength = crushing_forces(stack, compressive_strength)
    dead = gravity_forces(stack, base_tilt)
    live = horizontal_forces(stack, pattern)
    check_standing(stack, dead, strength, base_tilt)
    equilibrium = stack.compatibility()
    facets = _Facets(stack)
    lower, forces = _static(equilibrium, dead, live, facets)
    # The crushing domain is curved: its tangents are added where the last answer left it.  (Kelley's cutting planes)
    while facets.cut(stack, forces, strength):
        lower, forces = _static(equilibrium, dead, live, facets)
    upper, rates, multipliers = _kinematic(equilibrium, dead, live, facets)
    if flow == "non-associated":
        rates, multipliers = _non_associated(equilibrium, live, facets, forces)
    control = _top_movement(rates)
    return _result(stack, lower, upper, forces, rates / control, multipliers / control, facets, flow)


def towards(column: Column | BlockStack, direction: float) -> BlockStack:
    """The stack of a column, seen in a mirror where the forces push to the left.

    Raises
    ------
    InputError
        A direction out of the plane.
    """
    stack = column if isinstance(column, BlockStack) else BlockStack.of_column(column)
    if direction % 360.0 not in (0.0, 180.0):
        raise InputError(f"direction is {direction:g} degrees; allowed in the plane are 0 (to the right) and 180.")
    return stack.mirrored() if direction % 360.0 else stack


# -- the programmes ---------------------------------------------------------------------------------------------------


class _Facets:
    """Strength of all joints as rows f · (N, V, M) ≤ k, each with the place, kind and flow of its joint."""

    def __init__(self, stack: BlockStack) -> None:
        self.rows: list[np.ndarray] = []
        self.bound: list[float] = []
        self.joint: list[int] = []
        self.kind: list[str] = []
        left, right = contact_limits(stack)
        self.left, self.right = left, right
        for i in range(stack.n):
            mu, cohesion = stack.friction[i], stack.cohesion[i]
            # M = N e: the eccentricity stays inside the contact section.  # theory/limit_analysis, strength
            self.add(i, [-right[i], 0.0, 1.0], 0.0, "rocking right")
            self.add(i, [left[i], 0.0, -1.0], 0.0, "rocking left")
            # |V| ≤ c A + N tan φ; V acts on the part above: towards −x when that slides to the right.
            self.add(i, [-mu, -1.0, 0.0], cohesion, "sliding right")
            self.add(i, [-mu, 1.0, 0.0], cohesion, "sliding left")

    def add(self, joint: int, row: Sequence[float], bound: float, kind: str) -> None:
        self.rows.append(np.asarray(row, dtype=float))
        self.bound.append(bound)
        self.joint.append(joint)
        self.kind.append(kind)

    def cut(self, stack: BlockStack, forces: np.ndarray, strength: np.ndarray) -> bool:
        """Add tangents of the crushing domain M ≤ N a (1 − N/(f_c A)) that the forces (N, V, M) violate."""
        added = False
        for i in map(int, np.flatnonzero(np.isfinite(strength))):
            n, _, m = forces[i]
            for half, sign, kind in ((self.right[i], 1.0, "rocking right"), (-self.left[i], -1.0, "rocking left")):
                if sign * m > half * n * (1.0 - n / strength[i]) + 1e-10 * half * n:
                    # Tangent at N: M ≤ a [N (1 − 2 n/F) + n²/F].
                    slope, offset = half * (1.0 - 2.0 * n / strength[i]), half * n * n / strength[i]
                    self.add(i, [-slope, 0.0, sign], offset, kind)
                    added = True
        return added

    def matrix(self, n: int, *, dilatancy: bool = True) -> np.ndarray:
        """Rows as one matrix of shape (facets, 3 n); without dilatancy the flow of friction has no opening."""
        out = np.zeros((len(self.rows), 3 * n))
        for k, (row, i, kind) in enumerate(zip(self.rows, self.joint, self.kind)):
            out[k, 3 * i : 3 * i + 3] = row
            if not dilatancy and kind.startswith("sliding"):
                out[k, 3 * i] = 0.0
        return out


def _static(equilibrium: np.ndarray, dead: np.ndarray, live: np.ndarray, facets: _Facets) -> tuple[float, np.ndarray]:
    """Largest λ in equilibrium with admissible joint forces (lower bound theorem)."""
    from scipy.optimize import linprog

    size = dead.size
    scale = np.abs(dead).max()
    balance = np.column_stack((equilibrium.T, live.ravel() / scale))
    strength = np.column_stack((facets.matrix(size // 3), np.zeros(len(facets.rows))))
    found = linprog(
        np.append(np.zeros(size), -1.0),
        A_ub=strength,
        b_ub=np.array(facets.bound) / scale,
        A_eq=balance,
        b_eq=-dead.ravel() / scale,
        bounds=(None, None),
        method="highs",
        options=_TIGHT,
    )
    _check_solved(found, "static")
    return float(found.x[-1]), found.x[:-1].reshape(-1, 3) * scale


def _kinematic(
    equilibrium: np.ndarray, dead: np.ndarray, live: np.ndarray, facets: _Facets
) -> tuple[float, np.ndarray, np.ndarray]:
    """Smallest λ = (dissipation − power of gravity) / (power of the live load), associated flow (upper bound)."""
    from scipy.optimize import linprog

    size = dead.size
    scale = np.abs(dead).max()
    flow = facets.matrix(size // 3)
    # Normality: what the joints dissipate is −(N, V, M) · B q̇, so that B q̇ + Σ γ f = 0.
    compatible = np.column_stack((equilibrium, flow.T))
    power = np.append(live.ravel() / scale, np.zeros(len(flow)))
    found = linprog(
        np.append(-dead.ravel() / scale, np.array(facets.bound) / scale),
        A_eq=np.vstack((compatible, power)),
        b_eq=np.append(np.zeros(size), 1.0),
        bounds=[(None, None)] * size + [(0.0, None)] * len(flow),
        method="highs",
        options=_TIGHT,
    )
    _check_solved(found, "kinematic")
    return float(found.fun), found.x[:size].reshape(-1, 3), found.x[size:]


def _non_associated(
    equilibrium: np.ndarray, live: np.ndarray, facets: _Facets, forces: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Mechanism of the facets that the joint forces use up, friction without dilatancy: the one of least movement."""
    from scipy.optimize import linprog

    size = live.size
    scale = np.abs(live).max()
    left_over = np.array(facets.bound) - facets.matrix(size // 3) @ forces.ravel()
    used = left_over < ACTIVE * forces[facets.joint, 0]
    flow = facets.matrix(size // 3, dilatancy=False)
    compatible = np.column_stack((equilibrium, flow.T))
    power = np.append(live.ravel() / scale, np.zeros(len(flow)))
    found = linprog(
        np.append(np.zeros(size), np.ones(len(flow))),
        A_eq=np.vstack((compatible, power)),
        b_eq=np.append(np.zeros(size), 1.0),
        bounds=[(None, None)] * size + [(0.0, None if use else 0.0) for use in used],
        method="highs",
        options=_TIGHT,
    )
    _check_solved(found, "mechanism")
    return found.x[:size].reshape(-1, 3), found.x[size:]


def _check_solved(found, which: str) -> None:
    if found.status != 0:
        raise StylobateError(f"the {which} programme of the limit analysis was not solved: {found.message}")


def _result(
    stack: BlockStack,
    lower: float,
    upper: float,
    forces: np.ndarray,
    rates: np.ndarray,
    multipliers: np.ndarray,
    facets: _Facets,
    flow: str,
) -> LimitResult:
    threshold = ACTIVE * multipliers.max()
    active = [
        ActiveJoint(facets.joint[k] + 1, facets.kind[k], float(rate))
        for k, rate in enumerate(multipliers)
        if rate > threshold
    ]
    left_over = np.array(facets.bound) - facets.matrix(stack.n) @ forces.ravel()
    used = left_over < ACTIVE * forces[facets.joint, 0]
    n = forces[:, 0]
    return LimitResult(
        multiplier=0.5 * (lower + upper),
        lower=lower,
        upper=upper,
        mechanism=rates,
        active=tuple(sorted(active, key=lambda item: item.joint)),
        compression=n,
        shear=forces[:, 1],
        eccentricity=forces[:, 2] / np.where(n > 0.0, n, np.nan),
        at_limit=tuple(sorted({facets.joint[k] + 1 for k in np.flatnonzero(used)})),
        flow=flow,
    )


def _top_movement(rates: np.ndarray) -> float:
    """Largest horizontal velocity of a block: the measure that makes a mechanism comparable."""
    return float(np.abs(rates[:, 0]).max())
