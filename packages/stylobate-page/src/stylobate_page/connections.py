"""Connections to the page: whoever opens one and asks for nothing, or never comes to the end of it, is cut off."""

from __future__ import annotations

import asyncio
from typing import Any

from uvicorn.protocols.http.h11_impl import H11Protocol

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
                longest = min(silent, key=lambda one: one._since)
                longest._cease()  # it is lost a moment later: until then the next one is not to find it again
                longest.transport.abort()

    def _cease(self) -> None:
        if self._end is not None:
            self._end.cancel()
            self._end = None
