"""The server of the page: on this machine alone unless another address is asked for by name."""

from __future__ import annotations

import socket
import tempfile
import threading
import webbrowser
from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import uvicorn

from stylobate.errors import InputError

from .guard import BACKLOG, HEAD, Connection, Keys, is_loopback
from .records import locked_folder
from .site import create_app

#: Most connections at a time, silent ones included.
CONNECTIONS = 300

#: Time that open lines have to end when the server is stopped [s].
PATIENCE = 1


def serve(host: str, port: int, folder: Path | None, worker: Sequence[str], browser: bool = True) -> None:
    """Serve the page until it is stopped (Ctrl-C); its address, with the token that lets in, is the first line printed.

    Parameters
    ----------
    host : str
        Name or address of this machine; the page can be called by it, and by the names of the loopback.
    port : int
        0 for any that is free.
    folder : Path, optional
        Keeps records and jobs; without it they are deleted in the end.
    worker : sequence of str
        The command line of the process that does the jobs.
    browser : bool
        Open the page in the browser of this machine.

    Raises
    ------
    InputError
        The address cannot be used, or another page is served from the folder.
    """
    place = tempfile.TemporaryDirectory(prefix="stylobate-") if folder is None else nullcontext(str(folder))
    with listening_at(host, port) as listening, place as kept, locked_folder(Path(kept)):
        name = f"[{host}]" if ":" in host else host
        address, keys = f"http://{name}:{listening.getsockname()[1]}/", Keys()
        app = create_app(Path(kept), worker, (name,), keys)
        print(keys.printed(address), flush=True)
        if not is_loopback(host):
            print(f"Whoever reaches {host} and has this address can use the page and its files.", flush=True)
        server = server_of(app)
        if browser:
            threading.Timer(0.3, webbrowser.open, (keys.once(address),)).start()
        server.run([listening])


def server_of(app: Any) -> uvicorn.Server:
    """Server of an application."""
    return uvicorn.Server(
        uvicorn.Config(
            app,
            log_level="error",
            access_log=False,
            server_header=False,
            timeout_graceful_shutdown=PATIENCE,
            loop="asyncio",
            http=Connection,
            ws="none",
            h11_max_incomplete_event_size=HEAD,
            backlog=BACKLOG,
            limit_concurrency=CONNECTIONS,
        )
    )


def listening_at(host: str, port: int) -> socket.socket:
    """A socket at an address of this machine.

    Raises
    ------
    InputError
        The address cannot be used.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # The protocol is named: only then are small answers sent at once, instead of after a wait for more of 40 ms.
    listening = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    try:
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind((host, port))
        listening.listen()  # whoever comes before the server takes calls waits, and is not turned away
    except OSError as error:
        listening.close()
        raise InputError(
            f"the page cannot be served at {host}, port {port}: {error.strerror or error}; choose another `port`, or 0 for "
            "any that is free."
        ) from None
    return listening
