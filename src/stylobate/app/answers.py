"""Answers that all parts of the page give: what is refused, what is missing, and what a request holds."""

from __future__ import annotations

import json
from typing import Any

from starlette.requests import Request
from starlette.responses import JSONResponse, Response

from ..errors import InputError, StylobateError
from .guard import TooLarge


async def json_object(request: Request) -> dict[str, Any]:
    """The JSON object that a request holds.

    Raises
    ------
    InputError
        It holds none.
    """
    try:
        found = json.loads(await request.body())
    except (ValueError, RecursionError):
        found = None
    if not isinstance(found, dict):
        raise InputError("the request holds no JSON object; reload the page.")
    return found


def found_wrong(error: InputError, field: str | None) -> Response:
    """The answer to a question that was put well, about something that cannot be."""
    return JSONResponse({"error": str(error), "field": field})


def refused(error: InputError, field: str | None) -> Response:
    """The answer to what cannot be done."""
    return JSONResponse({"error": str(error), "field": field}, 422)


def missing(what: str) -> Response:
    """The answer about what is not here."""
    return JSONResponse({"error": f"there is no such {what}; reload the page."}, 404)


async def _on_input(request: Request, error: Exception) -> Response:
    return JSONResponse({"error": str(error), "field": None}, 422)


async def _on_too_large(request: Request, error: Exception) -> Response:
    return JSONResponse({"error": str(error)}, 413, {"connection": "close"})


async def _on_failure(request: Request, error: Exception) -> Response:
    return JSONResponse({"error": f"{error}"[:300]}, 500)


async def _on_missing(request: Request, error: Exception) -> Response:
    return missing("page")


#: What is answered where something goes wrong.
HANDLERS: dict[Any, Any] = {
    TooLarge: _on_too_large,
    InputError: _on_input,
    StylobateError: _on_failure,
    OSError: _on_failure,
    404: _on_missing,
}
