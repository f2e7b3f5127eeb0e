"""Guard of the page: keys, names of hosts, origins, sizes of bodies, and the headers of every answer."""

from __future__ import annotations

import asyncio
import ipaddress
from collections.abc import Awaitable, Callable, MutableMapping
from typing import Any

from starlette.responses import JSONResponse, PlainTextResponse

from .keys import CLOSED, Keys

Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]

#: Names of this machine.
LOOPBACK = ("127.0.0.1", "localhost", "[::1]")

#: Largest body of a request but uploads of records [bytes].
BODY = 1_000_000

#: Longest silence in the middle of a body [s].
SILENCE = 30.0

#: Rights of a browser with a page of ours: nothing from elsewhere, no code but our files, in no frame of others.
POLICY = "; ".join(
    (
        *("default-src 'none'", "script-src 'self'", "style-src 'self'", "img-src 'self' data:", "connect-src 'self'"),
        *("base-uri 'none'", "form-action 'none'", "frame-ancestors 'none'"),
    )
)
HEADERS = {
    "content-security-policy": POLICY,
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-resource-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
    "cache-control": "no-store",
}


class TooLarge(Exception):
    """A body is larger than it may be; the message says how large that is. The application answers it with 413."""


class TooSlow(Exception):
    """A body has stopped coming in. The application answers it with 408."""


def is_loopback(host: str) -> bool:
    """Whether an address is one of this machine alone."""
    try:
        return host == "localhost" or ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False


class Guard:
    """In front of the application: refuses what another site sends, and bodies that are too large while they come in.

    Parameters
    ----------
    app : callable
        The application.
    hosts : sequence of str
        Names under which this machine may be called, besides those of the loopback.
    uploads : dict
        Paths with bodies larger than :data:`BODY`, and their largest size [bytes].
    keys : Keys, optional
        What lets a request in; without them whoever reaches this machine may come in.
    """

    def __init__(
        self, app: Any, hosts: tuple[str, ...] = (), uploads: dict[str, int] | None = None, keys: Keys | None = None
    ) -> None:
        self.app, self.hosts, self.uploads, self.keys = app, {*LOOPBACK, *hosts}, uploads or {}, keys

    async def __call__(self, scope: dict[str, Any], receive: Receive, send: Send) -> None:
        """Answer a request (ASGI)."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        headers = {name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]}
        most = self.uploads.get(scope["path"], BODY)
        added = dict(HEADERS)

        async def sent(message: Message) -> None:
            if message["type"] == "http.response.start":
                given = {name for name, _ in message["headers"]}
                new = [(name.encode(), value.encode()) for name, value in added.items()]
                message["headers"] = [*message["headers"], *(one for one in new if one[0] not in given)]
            await send(message)

        refusal = self._refusal(scope, headers, most)
        if refusal is None and self.keys is not None:
            admitted = self.keys.admits(scope, headers)
            if admitted is None:
                added["set-cookie"] = self.keys.cookie(scope)
            elif not admitted:
                refusal = 403, CLOSED
        if refusal is not None:
            code, sentence = refusal
            page = scope["path"] == "/"  # a person reads it
            answer = PlainTextResponse(sentence, code) if page else JSONResponse({"error": sentence}, code)
            await answer(scope, receive, sent)
            return
        await self.app(scope, self._measured(receive, most), sent)

    def _refusal(self, scope: dict[str, Any], headers: dict[str, str], most: int) -> tuple[int, str] | None:
        """Code and sentence where a request is not for us, or not from us."""
        host = headers.get("host", "")
        if host.rpartition(":")[0] not in self.hosts and host not in self.hosts:
            return 403, f"the page is called by the name {host[:100]!r}, which is none of this machine; use 127.0.0.1."
        origin = headers.get("origin")
        if origin is not None and origin != f"{scope['scheme']}://{host}":
            return 403, f"the request comes from {origin[:100]!r}, another site; only this page may send it."
        site = headers.get("sec-fetch-site", "none")
        if site not in ("none", "same-origin") and scope["path"] != "/":
            return 403, "the request comes from another site; only this page may send it."
        length = headers.get("content-length", "0")
        if not length.isdecimal() or int(length) > most:
            return 413, too_large(most)
        return None

    def _measured(self, receive: Receive, most: int) -> Receive:
        """The body, counted while it comes in: its announced length may be wrong, or missing, or it may never end."""
        seen, more = 0, True

        async def measured() -> Message:
            nonlocal seen, more
            try:
                message = await asyncio.wait_for(receive(), SILENCE if more else None)
            except TimeoutError:
                raise TooSlow(f"nothing more has come in for {SILENCE:g} s; send it again.") from None
            seen, more = seen + len(message.get("body", b"")), message.get("more_body", False)
            if seen > most:
                raise TooLarge(too_large(most))
            return message

        return measured


def too_large(most: int) -> str:
    """The sentence about a body that is larger than so many bytes."""
    return f"more than {most / 1e6:g} MB are sent at once; that is the largest size allowed: send less."
