"""Guard of the page: keys, names of hosts, origins, sizes of bodies, headers of answers, connections that stay silent."""

from __future__ import annotations

import asyncio
import ipaddress
import secrets
from collections.abc import Awaitable, Callable, Mapping, MutableMapping
from typing import Any
from urllib.parse import parse_qs

from starlette.requests import cookie_parser
from starlette.responses import JSONResponse, PlainTextResponse
from uvicorn.protocols.http.h11_impl import H11Protocol

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
                message["headers"] = [*message["headers"], *(header for header in new if header[0] not in given)]
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


#: Names in an address: of the token, which lets in until the page ends, and of a ticket, which lets in once.
TOKEN, TICKET = "token", "ticket"

#: Answer to everybody else.
CLOSED = (
    "the page opens by the address that was printed when it was started; open that one: every start makes a new one."
)


class Keys:
    """A token for the address, which a browser keeps as a cookie after its first visit.

    The address that a browser is started with can be read by every user of the machine, in the list of its processes. It
    holds a ticket instead, which is worth nothing once the page has been opened.
    """

    def __init__(self) -> None:
        self.token = secrets.token_hex(16)
        self._tickets: set[str] = set()

    def printed(self, address: str) -> str:
        """The address with the token."""
        return f"{address}?{TOKEN}={self.token}"

    def once(self, address: str) -> str:
        """The address with a ticket."""
        ticket = secrets.token_hex(16)
        self._tickets.add(ticket)
        return f"{address}?{TICKET}={ticket}"

    def admits(self, scope: Mapping[str, Any], headers: Mapping[str, str]) -> bool | None:
        """Whether a request may come in: True with the cookie, None where it has yet to be given one, False if not."""
        cookies = cookie_parser(headers.get("cookie", ""))
        if self._is_token(cookies.get(_cookie(scope), "")):
            return True
        try:
            query = parse_qs(scope["query_string"].decode("latin-1"), max_num_fields=20)
        except ValueError:
            return False
        if self._is_token(query.get(TOKEN, [""])[-1]):
            return None
        ticket = query.get(TICKET, [""])[-1]
        if ticket in self._tickets:
            self._tickets.discard(ticket)
            return None
        return False

    def cookie(self, scope: Mapping[str, Any]) -> str:
        """The cookie that is set at the first visit; browsers share them among ports, hence its name."""
        return f"{_cookie(scope)}={self.token}; Path=/; HttpOnly; SameSite=Strict"

    def _is_token(self, text: str) -> bool:
        return secrets.compare_digest(text.encode("utf-8", "surrogatepass"), self.token.encode())


def _cookie(scope: Mapping[str, Any]) -> str:
    return f"stylobate-{(scope.get('server') or ('', 0))[1]}"


#: Time for the whole head of a request [s]; largest head [bytes]; most connections that have not sent theirs.
PATIENCE, HEAD, SILENT = 10.0, 32_768, 160

#: Most connections that wait to be taken: what comes in one go must not crowd out those who are about to ask.
BACKLOG = 64


class Connection(H11Protocol):
    """A connection that has a limited time for the head of each request.

    Where too many are silent, the one that has been so for longest is cut off: an honest one asks at once.
    """

    def __init__(self, *given: Any, **named: Any) -> None:
        super().__init__(*given, **named)
        self._since = 0.0
        self._end: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        """Begin to wait for the first request."""
        super().connection_made(transport)
        self._look()

    def data_received(self, data: bytes) -> None:
        """Stop waiting where a head is whole."""
        super().data_received(data)
        self._look()

    def on_response_complete(self) -> None:
        """Begin to wait for the next request."""
        super().on_response_complete()
        self._look()

    def send_400_response(self, msg: str) -> None:
        """Refuse what is no HTTP; a request whose body it was is given up, and not answered as well."""
        cycle = self.cycle
        if cycle is not None and not cycle.response_complete:
            cycle.disconnected = True
            cycle.message_event.set()
            if cycle.response_started:
                self.transport.close()
                return
        super().send_400_response(msg)

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop waiting."""
        super().connection_lost(exc)
        self._cease()

    def _look(self) -> None:
        if self.transport.is_closing() or (self.cycle is not None and not self.cycle.response_complete):
            self._cease()
        elif self._end is None:
            self._since = self.loop.time()
            self._end = self.loop.call_later(PATIENCE, self.transport.close)
            silent = [
                connection
                for connection in self.connections
                if isinstance(connection, Connection) and connection._end is not None
            ]
            if len(silent) > SILENT:
                longest = min(silent, key=lambda connection: connection._since)
                longest._cease()  # it is lost a moment later: until then the next one is not to find it again
                longest.transport.abort()

    def _cease(self) -> None:
        if self._end is not None:
            self._end.cancel()
            self._end = None
