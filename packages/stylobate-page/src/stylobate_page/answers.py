"""Answers that all parts of the page give: what is refused, what is missing, and what a request holds."""

from __future__ import annotations

import json
import math
from typing import Any

from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, Response

from stylobate.column.toml import check_values
from stylobate.errors import InputError, StylobateError

from .forms import in_page_words
from .guard import TooLarge, TooSlow

#: Headers of what the page itself asks, and of an answer that refuses it: that is no failure, which a browser would note.
ASKS, REFUSES = "x-page", "x-refused"

#: Fields that hold the text of a file, and a file that is opened.
TEXTS = ("assembly", "ruin", "file")


class Answer(JSONResponse):
    """A JSON object that every browser can read, whatever it holds."""

    def render(self, content: Any) -> bytes:
        """The object as ASCII; null for what is no number."""
        return as_json(content).encode()


def as_json(content: Any) -> str:
    """Content as JSON in ASCII: halves of characters, which a file of earlier versions may hold, stay escaped."""
    try:
        return json.dumps(content, allow_nan=False, separators=(",", ":"))
    except ValueError:
        return json.dumps(json.loads(json.dumps(content), parse_constant=lambda _: None))


async def json_object(request: Request) -> dict[str, Any]:
    """The JSON object that a request holds.

    Raises
    ------
    InputError
        It holds none, or what no file can hold.
    """
    try:
        json_object = json.loads(await request.body(), parse_constant=_finite, parse_float=_finite)
    except (ValueError, RecursionError):
        json_object = None
    if not isinstance(json_object, dict):
        raise InputError("the request holds no JSON object of finite numbers; reload the page.")
    check_values(json_object, "the request")
    return json_object


def _finite(text: str) -> float:
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(text)
    return number


def found_wrong(error: InputError) -> Response:
    """The answer to a question that was put well, about something that cannot be."""
    return _about(error, 200)


class Missing(Exception):
    """Nothing of the name that was asked for is here."""


def missing(what: str) -> Response:
    """The answer about what is not here."""
    return Answer({"error": f"there is no such {what}; reload the page."}, 404)


def _about(error: Exception | str, code: int, **headers: str) -> Response:
    field = getattr(error, "field", None)
    of_text = field is not None and field.partition(".")[0] in TEXTS
    return Answer({"error": in_page_words(error, of_text), "field": field}, code, headers)


async def _on_input(request: Request, error: Exception) -> Response:
    if ASKS in request.headers:
        return _about(error, 200, **{REFUSES: "yes"})
    return _about(error, 422)


async def _on_too_large(request: Request, error: Exception) -> Response:
    return _about(error, 413, connection="close")


async def _on_too_slow(request: Request, error: Exception) -> Response:
    return _about(error, 408, connection="close")


async def _on_failure(request: Request, error: Exception) -> Response:
    return _about(f"{error}"[:300], 500)


async def _on_disk(request: Request, error: Exception) -> Response:
    why = getattr(error, "strerror", None) or type(error).__name__
    return _about(
        f"a file of the page cannot be written or read: {why}; make room on the disk, or reload the page.", 500
    )


async def _on_missing(request: Request, error: Exception) -> Response:
    return missing(str(error) if isinstance(error, Missing) else "page")


async def _on_other_method(request: Request, error: Exception) -> Response:
    return _about("that cannot be asked for in this way; reload the page.", 405)


async def _on_gone(request: Request, error: Exception) -> Response:
    return _about("the request broke off; send it again.", 400)  # nobody hears it


#: Answers where something goes wrong.
HANDLERS: dict[Any, Any] = {
    TooLarge: _on_too_large,
    TooSlow: _on_too_slow,
    ClientDisconnect: _on_gone,
    InputError: _on_input,
    StylobateError: _on_failure,
    OSError: _on_disk,
    Missing: _on_missing,
    404: _on_missing,
    405: _on_other_method,
}
