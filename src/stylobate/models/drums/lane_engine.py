"""What each engine gives to the runs in its lanes: how a case is put into its records, and what is read out of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ...column import Column
from ...motion import Motion
from ...response import Collapse
from ...response.collapse import what_is_lost
from ...response.measures import SpaceMeasures
from ...response.residuals import Residuals


class Left(NamedTuple):
    """What runs have left behind, of each of them.

    Parameters
    ----------
    residuals : sequence of Residuals
    offset : array
        Length of the offset along every joint [m], shape (runs, joints).
    slip : array
        Of every joint since the start, as :meth:`LaneEngine.stay` takes it [m], shape (runs, joints) or (runs, joints, 2).
    top : array
        Residual displacement of the top [m], shape (runs,).
    rotation : array
        Largest rotation of a body [rad], shape (runs,).
    space : sequence of SpaceMeasures, optional
    """

    residuals: Sequence[Residuals]
    offset: np.ndarray
    slip: np.ndarray
    top: np.ndarray
    rotation: np.ndarray
    space: Sequence[SpaceMeasures] | None = None


class LaneEngine:
    """Base of :class:`stylobate.models.drums.runs.LaneRuns`: the methods in which the plane and space differ."""

    def step(self, chunks: int) -> None:
        """Let the kernel take so many chunks of steps."""
        raise NotImplementedError

    def energies_without_tension(self, lane: int, bare: Column) -> np.ndarray:
        """The same as if the column stood there without its pretension; ``bare`` is that column."""
        raise NotImplementedError

    def shake(self, lane: int, motion: Motion) -> None:
        """Note how the base of a lane moves."""
        raise NotImplementedError

    @property
    def stood(self) -> tuple[np.ndarray, ...]:
        """What is kept of how the columns stood, the lanes first."""
        raise NotImplementedError

    def stand(self, lane: int) -> None:
        """Note how a column stands in a lane."""
        raise NotImplementedError

    def take_pose(self, lane: int, column: Any, start: Any) -> None:
        """Put a column that stands in a lane where a run starts from."""
        raise NotImplementedError

    def half_a_step_back(self, lane: int) -> None:
        """Velocities half a step before the start."""
        raise NotImplementedError

    def collapse(self, lane: int) -> Collapse:
        """The collapse of a lane."""
        raise NotImplementedError

    def left(self, lanes: list[int]) -> Left:
        """What the runs of some lanes leave behind."""
        raise NotImplementedError

    def lost(self, collapse: Collapse, column: Any) -> str:
        """Fallen bodies, and their places, in words."""
        return f"{what_is_lost(collapse, column.n)}, to the {collapse.side}"

    def stay(self, lanes: list[int], energy: np.ndarray, slip: np.ndarray) -> np.ndarray:
        """Whether what stands in lanes with so much energy above that at rest [J] stands for good, shape (lanes,).

        ``slip`` is that of every joint since the start [m], of each lane.
        """
        raise NotImplementedError
