"""Links on an equilibrium path: forces, what has yielded or is lost, and their tangent."""

from __future__ import annotations

import numpy as np

from ..models.rigid_block.block_stack import SHEAR, BlockStack, Hold, link_strain, link_strains

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
