"""Dask workers on this machine, in processes of their own that end with this one, however it ends.

The scheduler and the workers belong to a second process in a session of its own: a Ctrl-C at the terminal reaches this
process alone, which ends them; when it is killed, its end of the pipe closes, and they end by themselves.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from ..errors import StylobateError

#: Time until they end by force, and between looks at whether they live [s].
_PATIENCE = 0.5

#: Of Dask: a chunk that has died with two workers is told; nothing is measured that nobody looks at.
_SETTINGS = {
    "distributed.scheduler.allowed-failures": 1,
    "distributed.worker.profile.enabled": False,
    "distributed.admin.system-monitor.interval": "10s",
}

#: Times that they are started before it is said that they do not.
_TRIES = 3


class LocalWorkers:
    """A scheduler and workers of one thread each.

    Raises
    ------
    StylobateError
        They could not be started.
    """

    def __init__(self, count: int) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", __name__, str(count)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True,
        )  # fmt: skip
        assert self._process.stdout is not None
        last = ""
        try:
            for line in self._process.stdout:
                last = line.strip()
                if last.startswith("tcp://"):
                    self.address = last
                    return
        except BaseException:
            self.end()
            raise
        raise StylobateError(f"the workers on this machine did not start ({last}); leave `dask` out to use threads.")

    @property
    def process(self) -> int:
        """Number of the process of the scheduler."""
        return self._process.pid

    def end(self) -> None:
        """End them; what they are computing is not waited for."""
        with suppress(OSError):
            if self._process.stdin is not None:
                self._process.stdin.close()
        try:
            self._process.wait(_PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()  # its workers notice
            self._process.wait()
        finally:
            if self._process.stdout is not None:
                self._process.stdout.close()


def serve(count: int) -> None:
    """Be the process of the scheduler, until the one that started it closes the pipe or ends."""
    from dask.config import set as setting
    from distributed import LocalCluster

    with tempfile.TemporaryDirectory(prefix="stylobate-workers-", ignore_cleanup_errors=True) as place:
        with setting(_SETTINGS):
            how: dict[str, Any] = {"threads_per_worker": 1, "processes": True, "dashboard_address": None}
            how["memory_limit"] = None  # nobody measures it ten times a second
            cluster = started(lambda: LocalCluster(n_workers=count, local_directory=place, **how))
        print(cluster.scheduler_address, flush=True)
        threading.Thread(target=_keep_alive, args=(cluster, count), daemon=True).start()
        nothing = os.open(os.devnull, os.O_WRONLY)
        for stream in (1, 2):
            os.dup2(nothing, stream)
        sys.stdin.read()
        for nanny in list(cluster.workers.values()):
            with suppress(Exception):
                nanny.process.process._process.kill()  # at once: a compiled loop does not listen
    os._exit(0)


def started(make: Callable[[], Any]) -> Any:
    """Files made at the last try at the latest: a worker that dies while it starts takes the whole cluster along."""
    for _ in range(_TRIES - 1):
        with suppress(Exception):
            return make()
    return make()


def _keep_alive(cluster: Any, count: int) -> None:
    """Start again what died while it was being started, for which the runs would wait for ever.

    Either its nanny waits for it as long, or it gives up and leaves the cluster.
    """
    seen: set[str] = set()
    while True:
        time.sleep(_PATIENCE)
        if len(cluster.workers) < count:
            cluster.scale(count)  # what is missing is made anew
        dead = set()
        for nanny in list(cluster.workers.values()):
            if nanny.process is not None and nanny.process.status.name in ("stopped", "failed"):
                dead.add(nanny.id)
                if nanny.id in seen:  # twice in a row: it is not on its way
                    with suppress(Exception):
                        cluster.sync(nanny.instantiate)
        seen = dead


if __name__ == "__main__":
    serve(int(sys.argv[1]))
