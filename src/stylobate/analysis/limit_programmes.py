"""The programmes of limit analysis: strength of joints and links as facets, static and kinematic bound, mechanism."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..errors import InputError, StylobateError
from ..models.rigid_block.block_stack import SHEAR, BlockStack, link_strains
from .static_loads import contact_limits

#: Strength counts as used up when less than this share of it is left [-].
ACTIVE = 1e-7

#: A multiplier stays if it falls by no more than this share of itself [-].
STAYS = 1e-9

_TIGHT = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}


def equilibrium_matrix(stack: BlockStack) -> np.ndarray:
    """Openings, slips and rotations of the joints, and strains of the links, from small displacements of the blocks.

    Its transpose turns joint forces (N, V, M) on the part above, and what each link pushes apart with, into forces on the
    blocks; shape (3 n + links, 3 n).
    """
    joints = stack.compatibility()
    return np.vstack((joints, link_strains(stack.links, stack.centroid, stack.angle)[1])) if stack.links else joints


class Facets:
    """Strength of joints and links as rows f · s ≤ k over all joint and link forces, with the place and kind of each.

    A place below ``n`` is a joint, beyond it a link.
    """

    def __init__(self, stack: BlockStack) -> None:
        self.stack = stack
        self.size = 3 * stack.n + len(stack.links)
        self.rows: list[np.ndarray] = []
        self.bound: list[float] = []
        self.place: list[int] = []
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
        for k, link in enumerate(stack.links):
            place, most = stack.n + k, link.capacity if link.strength else 0.0
            if link.action == SHEAR:
                self.add(place, [-1.0], most, "yields to the right")
                self.add(place, [1.0], most, "yields to the left")
            else:  # it pulls, so that what it pushes with lies between −capacity and 0
                self.add(place, [-1.0], most, "yields")
                self.add(place, [1.0], 0.0, "slack")

    def add(self, place: int, values: Sequence[float], bound: float, kind: str) -> None:
        """One facet; without a finite bound there is none."""
        if not np.isfinite(bound):
            return
        row = np.zeros(self.size)
        first = 3 * place if place < self.stack.n else 2 * self.stack.n + place
        row[first : first + len(values)] = values
        self.rows.append(row)
        self.bound.append(bound)
        self.place.append(place)
        self.kind.append(kind)

    def cut(self, forces: np.ndarray, strength: np.ndarray) -> bool:
        """Add tangents of the crushing domain M ≤ N a (1 − N/(f_c A)) that the forces violate."""
        added = False
        for i in map(int, np.flatnonzero(np.isfinite(strength))):
            n, _, m = forces[3 * i : 3 * i + 3]
            for half, sign, kind in ((self.right[i], 1.0, "rocking right"), (-self.left[i], -1.0, "rocking left")):
                if sign * m > half * n * (1.0 - n / strength[i]) + 1e-10 * half * n:
                    # Tangent at N: M ≤ a [N (1 − 2 n/F) + n²/F].
                    slope, offset = half * (1.0 - 2.0 * n / strength[i]), half * n * n / strength[i]
                    self.add(i, [-slope, 0.0, sign], offset, kind)
                    added = True
        return added

    def matrix(self, *, dilatancy: bool = True) -> np.ndarray:
        """Rows as one matrix, shape (facets, forces); without dilatancy the flow of friction has no opening."""
        out = np.array(self.rows)
        if not dilatancy:
            for k, (place, kind) in enumerate(zip(self.place, self.kind)):
                if kind.startswith("sliding"):
                    out[k, 3 * place] = 0.0
        return out

    def worth(self, slopes: np.ndarray) -> np.ndarray:
        """By how much a larger capacity of each link raises λ [1/N], of ∂λ/∂k of the facets; shape (links,)."""
        found = np.zeros(len(self.stack.links))
        for place, kind, slope in zip(self.place, self.kind, slopes, strict=True):
            if place >= self.stack.n and kind != "slack":
                found[place - self.stack.n] += slope
        return found

    def used(self, forces: np.ndarray) -> np.ndarray:
        """Which facets the forces have used up, shape (facets,)."""
        left_over = np.array(self.bound) - self.matrix() @ forces
        n = self.stack.n
        scale = np.array([forces[3 * place] if place < n else self.stack.weight for place in self.place])
        return left_over < ACTIVE * scale


def static_bound(
    equilibrium: np.ndarray, dead: np.ndarray, live: np.ndarray, facets: Facets
) -> tuple[float, np.ndarray, np.ndarray]:
    """Largest λ in equilibrium with admissible forces (lower bound theorem), these forces, and ∂λ/∂k of the facets [1/N]."""
    scale = np.abs(dead).max()
    found = _admissible(equilibrium, dead, live, facets, np.append(np.zeros(len(equilibrium)), -1.0))
    if found.status == 3:
        endless = [link.name for link in facets.stack.links if link.capacity == np.inf and link.strength]
        raise InputError(
            f"the column bears any push, because {' and '.join(endless[:2]) or 'a link'} has no capacity; give it one [N]."
        )
    _check_solved(found, "static")
    return float(found.x[-1]), found.x[:-1] * scale, -found.ineqlin.marginals / scale


def largest_forces(
    equilibrium: np.ndarray, dead: np.ndarray, live: np.ndarray, facets: Facets, multiplier: float, strength: np.ndarray
) -> np.ndarray:
    """The most that each link holds in any admissible answer at a multiplier [N], infinite without limit; shape (links,).

    Two programmes for each link: the largest and the smallest force that equilibrium and strength admit while λ stays.
    ``strength`` is that of the joints against crushing [N], whose tangents are added as they are needed.
    """
    size, links = len(equilibrium), len(facets.stack.links)
    scale, most = np.abs(dead).max(), np.zeros(links)
    least = multiplier - STAYS * max(abs(multiplier), 1e-3)
    for k in range(links):
        for sign in (1.0, -1.0):
            cost = np.zeros(size + 1)
            cost[size - links + k] = sign
            found = _admissible(equilibrium, dead, live, facets, cost, least)
            while found.status == 0 and facets.cut(found.x[:-1] * scale, strength):
                found = _admissible(equilibrium, dead, live, facets, cost, least)
            if found.status == 3:
                most[k] = np.inf
                continue
            _check_solved(found, "static")
            most[k] = max(most[k], -sign * found.x[size - links + k] * scale)
    return most


def _admissible(
    equilibrium: np.ndarray,
    dead: np.ndarray,
    live: np.ndarray,
    facets: Facets,
    cost: np.ndarray,
    least: float | None = None,
) -> Any:
    """The admissible forces over the largest load, and λ, of least cost; λ not below ``least``."""
    from scipy.optimize import linprog

    scale = np.abs(dead).max()
    return linprog(
        cost,
        A_ub=np.column_stack((facets.matrix(), np.zeros(len(facets.rows)))),
        b_ub=np.array(facets.bound) / scale,
        A_eq=np.column_stack((equilibrium.T, live.ravel() / scale)),
        b_eq=-dead.ravel() / scale,
        bounds=[(None, None)] * len(equilibrium) + [(least, None)],
        method="highs",
        options=_TIGHT,
    )


def kinematic_bound(
    equilibrium: np.ndarray, dead: np.ndarray, live: np.ndarray, facets: Facets
) -> tuple[float, np.ndarray, np.ndarray]:
    """Smallest λ = (dissipation − power of gravity) / (power of the live load), associated flow (upper bound)."""
    from scipy.optimize import linprog

    size = dead.size
    scale = np.abs(dead).max()
    flow = facets.matrix()
    # Normality: what joints and links dissipate is −s · B q̇, so that B q̇ + Σ γ f = 0.
    compatible = np.column_stack((equilibrium, flow.T))
    power = np.append(live.ravel() / scale, np.zeros(len(flow)))
    found = linprog(
        np.append(-dead.ravel() / scale, np.array(facets.bound) / scale),
        A_eq=np.vstack((compatible, power)),
        b_eq=np.append(np.zeros(len(equilibrium)), 1.0),
        bounds=[(None, None)] * size + [(0.0, None)] * len(flow),
        method="highs",
        options=_TIGHT,
    )
    _check_solved(found, "kinematic")
    return float(found.fun), found.x[:size].reshape(-1, 3), found.x[size:]


def non_associated(
    equilibrium: np.ndarray, live: np.ndarray, facets: Facets, forces: np.ndarray
) -> tuple[np.ndarray, np.ndarray] | None:
    """Mechanism of the facets that the forces use up, friction without dilatancy: the one of least movement.

    None where there is none: with links the forces of both bounds need not allow it.
    """
    from scipy.optimize import linprog

    size = live.size
    scale = np.abs(live).max()
    flow = facets.matrix(dilatancy=False)
    compatible = np.column_stack((equilibrium, flow.T))
    power = np.append(live.ravel() / scale, np.zeros(len(flow)))
    found = linprog(
        np.append(np.zeros(size), np.ones(len(flow))),
        A_eq=np.vstack((compatible, power)),
        b_eq=np.append(np.zeros(len(equilibrium)), 1.0),
        bounds=[(None, None)] * size + [(0.0, None if use else 0.0) for use in facets.used(forces)],
        method="highs",
        options=_TIGHT,
    )
    if found.status != 0 and facets.stack.links:
        return None
    _check_solved(found, "mechanism")
    return found.x[:size].reshape(-1, 3), found.x[size:]


def _check_solved(found, which: str) -> None:
    if found.status != 0:
        raise StylobateError(f"the {which} programme of the limit analysis was not solved: {found.message}")
