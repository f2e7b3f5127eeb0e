"""JSON files of results: read with one sentence about what is wrong."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..messages import MESSAGES, restored
from ..reading import read_bytes, shown

#: Largest JSON file of a result [bytes].
MOST = 500_000_000


def read_json(path: Path) -> dict[str, Any]:
    """The object in a JSON file.

    Raises
    ------
    InputError
        There is none, or it holds something else.
    """
    content = read_bytes(path, MOST)
    try:
        found = json.loads(content)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{shown(path)} is no JSON that can be read ({error}); run again.") from None
    if not isinstance(found, dict):
        raise InputError(f"{shown(path)} holds no object as stylobate writes it; run again.")
    messages = found.pop(MESSAGES, {})
    try:
        return restored(found, messages)
    except (AttributeError, KeyError, TypeError, ValueError):
        raise InputError(f"{shown(path)} holds messages as nobody writes them; run again.") from None
