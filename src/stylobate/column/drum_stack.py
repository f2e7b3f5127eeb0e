"""A stack of drums as a structure: what its measures as built, its links and how it is found come to in its joints."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from .joint import Joint
from .stack import Stack
from .structure import Structure


class DrumStack(Stack, Structure):
    """Drums on drums, with links, as found: what a column is to those who look where it stands and what loads it."""

    @cached_property
    def joint_laws(self) -> tuple[Joint, ...]:
        """Law of each joint with the layer or pad that lies in it."""
        laws = list(self.joints)
        for link in self.placed_links:
            if link.joint:
                laws[link.joint - 1] = link.joint_law(laws[link.joint - 1])
        return tuple(laws)

    @cached_property
    def friction(self) -> np.ndarray:
        """tan φ of each joint, that of a layer where there is one [-], shape (n,)."""
        return np.array([law.tan_phi for law in self.joint_laws])

    @property
    def on_rings(self) -> bool:
        """Whether some joint carries on a ring."""
        return any(joint.ring_width is not None for joint in self.joints)
