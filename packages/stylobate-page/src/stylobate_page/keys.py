"""Who may use the page: whoever has the address that was printed, and the browser that has visited it."""

from __future__ import annotations

import secrets
from collections.abc import Mapping
from typing import Any
from urllib.parse import parse_qs

from starlette.requests import cookie_parser

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
            asked = parse_qs(scope["query_string"].decode("latin-1"), max_num_fields=20)
        except ValueError:
            return False
        if self._is_token(asked.get(TOKEN, [""])[-1]):
            return None
        ticket = asked.get(TICKET, [""])[-1]
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
