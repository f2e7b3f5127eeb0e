"""What steps columns in the place of threads of the processor: a device, which a package brings by an entry point."""

from __future__ import annotations

from threading import Lock
from typing import Any, Protocol

from ..added import DEVICES, entries, missing
from ..errors import InputError


class Device(Protocol):
    """A device.

    Attributes
    ----------
    name : str
        As its maker calls it.
    threads : int
        Threads of the processor that begin and end runs for it.
    """

    @property
    def name(self) -> str: ...

    threads: int

    def steps(self, model: Any, kind: Any) -> bool:
        """Whether it steps columns of a kind (``LaneEngine.kind``) of a model (:class:`.drums.stepped.SteppedDrums`).

        Raises
        ------
        StylobateError
            It computes otherwise than the processor.
        """
        ...

    def lanes(self, engine: Any, kind: Any, options: Any, runs: int, turn: Lock) -> Any:
        """Lanes (:class:`.shared.lanes.LaneBlock`) for columns of a kind that it steps.

        Parameters
        ----------
        engine : LaneEngine
        kind, options
            As its ``block_for`` takes them.
        runs : int
            How many runs there are, of all threads.
        turn : Lock
            Of all threads that work for it: they take turns in beginning and ending runs.
        """
        ...


def gpu() -> Device:
    """The graphics card of this machine.

    Raises
    ------
    InputError
        There is none that can be used, or no package that reaches it.
    """
    entry = entries(DEVICES).get("gpu")
    if entry is None:
        place = missing("devices", "gpu")
        raise InputError(f"`device` is gpu, and graphics cards are reached by {place} Or leave `device` out.", "device")
    return entry.load()()
