"""The graphics card of this machine, as a device of stylobate: which columns it steps, and by which kernel."""

from __future__ import annotations

from functools import cache, partial
from threading import Lock
from typing import Any

from stylobate.models.base import RunOptions
from stylobate.models.dem2d.model import DistinctElement2D
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.drums.records import Topology
from stylobate.models.drums.stepped import LaneEngine, SteppedDrums

from . import card_check, driver, kinds, lanes
from .card import Device


class GraphicsCard:
    """A card that steps columns (:class:`stylobate.models.devices.Device`).

    Parameters
    ----------
    card : Device
        By which memory, kernels and launches are reached.
    """

    def __init__(self, card: Device) -> None:
        self.card, self.name, self.threads = card, card.name, lanes.THREADS

    def steps(self, model: SteppedDrums, kind: Any) -> bool:
        """Whether there is a kernel for columns of a kind, room for them, and the kernel computes as the processor does."""
        name = kernel_for(model, kind)
        if name is None:
            return False
        drums = kind.stack if isinstance(kind, Topology) else kind.topology.stack
        return card_check.usable(self.card, name, drums, type(model))

    def lanes(self, engine: LaneEngine, kind: Any, options: RunOptions, runs: int, turn: Lock) -> lanes.CardLanes:
        """Lanes on the card for columns of a kind; each of its threads has its share of the runs."""
        name, share = kernel_for(engine.model, kind), -(-runs // self.threads)
        assert name is not None
        return lanes.CardLanes(self.card, name, partial(engine.block_for, kind, options), share, turn)


def kernel_for(model: SteppedDrums, kind: Any) -> str | None:
    """Name of the kernel for columns of a kind; None where there is none.

    There are kernels for columns without links: in the plane on two contact points a joint, in space on whole rims and on
    corners.
    """
    if isinstance(model, DistinctElement2D):
        taken = kind.stack and not kind.links and model.points == kinds.POINTS
        return kinds.plane_kernel(model.damped) if taken else None
    if isinstance(model, DistinctElement3D):
        taken = kind.face in kinds.FACES and not kind.topology.links
        return kinds.space_kernel(kind.face, kind.damped, kind.rolls) if taken else None
    return None


@cache
def the_device() -> GraphicsCard:
    """The card of this machine.

    Raises
    ------
    InputError
        The driver cannot be reached, there is no card, or there are no kernels for it.
    """
    return GraphicsCard(driver.the_card())
