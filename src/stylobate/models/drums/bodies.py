"""Structure for the engines in the plane and in space: which contacts there are, and where its bodies are at rest."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from ...column.structure import Structure
from .links import acting


@dataclass(frozen=True)
class Topology:
    """Which contacts there are, the same in all lanes of a block.

    Parameters
    ----------
    bodies : int
    joints : tuple of (int, int)
        Lower and upper body of each joint.
    links : tuple of (int, int)
        The same of each link.
    fixed : tuple of int
        Bodies that move with the ground.
    stack : int
        Drums of the column that is looked at, bodies 1 … stack on joints 0 … stack − 1; 0 for none.
    which : tuple
        What else tells whose runs can share a block: the links themselves.
    """

    bodies: int
    joints: tuple[tuple[int, int], ...]
    links: tuple[tuple[int, int], ...] = ()
    fixed: tuple[int, ...] = (0,)
    stack: int = 0
    which: tuple[Any, ...] = ()

    @classmethod
    @lru_cache(maxsize=4096)
    def of(cls, structure: Structure) -> Topology:
        """Of all bodies of a structure, on its joints and on those of its links that act."""
        joints = tuple((pair.lower, pair.upper) for pair in structure.face_pairs)
        links = tuple((one.lower, one.upper) for one in acting(structure))
        fixed = tuple(i for i, body in enumerate(structure.bodies) if body.fixed)
        stack = 0 if structure.stack is None else structure.stack.n
        return cls(len(structure.bodies), joints, links, fixed, stack, structure.links if links else ())


def body_fields(structure: Structure, closure: np.ndarray | None = None) -> dict[str, np.ndarray]:
    """Fields of the bodies as they stand, at rest; each joint of a stack closed by ``closure`` [m], shape (n,)."""
    bodies = structure.bodies
    x, z, lean, m, i = np.array([(*body.place, body.lean, body.mass, body.inertia) for body in bodies]).T
    if closure is not None:
        z[1:] -= np.cumsum(closure)
    free = np.array([not body.fixed for body in bodies])
    m, i = np.where(free, m, 0.0), np.where(free, i, 0.0)
    im, ii = (np.divide(1.0, one, out=np.zeros(len(bodies)), where=free) for one in (m, i))
    at_rest = {name: np.zeros(len(bodies)) for name in ("th", "vx", "vz", "w")}
    return at_rest | {
        "x": x, "z": z, "c": np.cos(lean), "s": np.sin(lean), "m": m, "i": i, "im": im, "ii": ii
    }  # fmt: skip
