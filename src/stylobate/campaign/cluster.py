"""Runs on a Dask cluster: this process hands out chunks of cases and takes results as they come."""

from __future__ import annotations

import logging
import queue
import threading
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

from ..errors import InputError
from ..models.base import Case, Model, RunOptions
from ..response import Measures
from ..simulate import thread_count
from .executor import computed_by
from .hand_out import HandOut
from .local_workers import LocalWorkers

if TYPE_CHECKING:
    from distributed import Client

#: Workers on this machine, as an address.
LOCAL = "local"

#: Time that a scheduler has to answer [s].
PATIENCE = 6.0


@contextmanager
def on_cluster(
    address: str, workers: int | None = None, say: Callable[[str], object] | None = None
) -> Iterator[Client]:
    """Inside the block every campaign is computed by the workers of a Dask cluster, to the same bits as by threads.

    Parameters
    ----------
    address : str
        Of the scheduler, such as ``tcp://10.0.0.1:8786``; ``local`` starts workers on this machine, and ends them with the
        block.
    workers : int, optional
        Of a local cluster, each of one thread; as many as cores by default.
    say : callable, optional
        Told in a sentence what a person should know, e.g. that the cluster has no workers yet.

    Raises
    ------
    InputError
        Dask is not installed, or no scheduler answers within ten seconds.
    StylobateError
        The workers of this machine do not start, or the scheduler is lost on the way.
    """
    try:
        import distributed
    except ImportError:
        raise InputError(
            "runs on a cluster take Dask, which is not installed; install stylobate[cluster], or leave `dask` out."
        ) from None
    for name in list(logging.root.manager.loggerDict):  # what goes wrong is said here, in one sentence
        if name.partition(".")[0] in ("distributed", "tornado", "asyncio"):
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)
    local = LocalWorkers(thread_count(workers)) if address == LOCAL else None
    try:
        client = _connect(distributed.Client, address if local is None else local.address)
        try:
            with computed_by(_Cluster(client, say)):
                yield client
        finally:
            with suppress(Exception):
                client.close(timeout=0.2)
    finally:
        if local is not None:
            local.end()


def _connect(client: type[Client], address: str) -> Client:
    """A client of the scheduler at an address, or the sentence that there is none; within :data:`PATIENCE`."""
    from distributed.comm.addressing import get_address_host_port

    answers: queue.Queue = queue.Queue()

    class Known(client):
        """A client that waits for nobody at its end, unless it has come to a scheduler."""

        def __del__(self) -> None:
            if self.status == "running":
                super().__del__()

    def ask() -> None:
        try:
            answers.put(Known(address, timeout=0.9 * PATIENCE, set_as_default=False, name="stylobate"))
        except BaseException as error:
            answers.put(error)

    try:
        get_address_host_port(address)
        threading.Thread(target=ask, daemon=True).start()  # what takes a connection and says nothing is not waited for
        found = answers.get(timeout=PATIENCE)
        if isinstance(found, BaseException):
            raise found
        return found
    except Exception as error:  # of whichever library finds the address wrong
        why = " ".join(str(error).split()) or f"nothing within {PATIENCE:g} s"
        raise InputError(
            f"no Dask scheduler answers at {address!r} ({why[:200]}); give its address, such as tcp://10.0.0.1:8786, or "
            "local for workers on this machine."
        ) from None


class _Cluster:
    """The executor of :mod:`stylobate.campaign.executor` that stands for a cluster."""

    def __init__(self, client: Client, say: Callable[[str], object] | None) -> None:
        self.client, self.say = client, say

    def __call__(
        self, cases: Sequence[Case], model: Model, options: RunOptions, threads: int | None
    ) -> Generator[tuple[int, Measures], None, None]:
        work = HandOut(self.client, cases, model, options, self.say)
        try:
            yield from work.results()
        finally:
            work.end()
