"""``stylobate serve``: the page on this machine."""

from __future__ import annotations

import signal
import sys
from contextlib import suppress
from pathlib import Path

from stylobate.cli.options import option
from stylobate.errors import InputError

#: The process that does the jobs of the page.
WORKER = (sys.executable, "-m", "stylobate_page.worker")


def serve(
    port: int = option("N", "Of the page; 0 for any that is free.", 8040),
    host: str = option("ADDRESS", "Of this machine, for others to reach the page as well.", "127.0.0.1"),
    no_browser: bool = option(None, "Do not open the page in a browser.", False),
    out: Path | None = option("DIR", "Keep jobs and records there; without it they end with the page."),
) -> None:
    """A page to explore columns: edit, shake, watch, and map what stands and what falls.

    Prints its address as the first line, with the token that lets in, and serves this machine alone until it is stopped
    (Ctrl-C).
    """
    if not 0 <= port <= 65535:
        raise InputError(f"`port` is {port}; allowed is 0 to 65535.", "port")
    try:
        from ..server import serve as run
    except ImportError as error:
        if error.name is None or error.name.partition(".")[0] not in ("starlette", "uvicorn", "anyio"):
            raise
        raise InputError(
            f"the page needs {error.name}, which is not installed; install it with 'pip install stylobate-page'."
        ) from None
    signal.set_wakeup_fd(-1)  # the server ends by itself, and puts away what it has open
    with suppress(KeyboardInterrupt):
        run(host, port, out, WORKER, browser=not no_browser)
