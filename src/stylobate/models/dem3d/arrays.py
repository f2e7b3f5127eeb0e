"""Arrays of an engine in space for one stack of bodies: their records, and the list of their contacts."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...kernels.run_codes import CHUNK
from ...kernels.shared.records import STATE
from ..shared.lanes import aligned_zeros


def stack_arrays(types: dict[str, np.dtype], bodies: int, joints: int, links: int = 0) -> dict[str, Any]:
    """Records by their names in ``STATE``, empty but for the contacts.

    Parameters
    ----------
    types : dict of dtype
        Of the records (``kernels/dem3d/records.py``).
    bodies : int
        The base among them; every one has a contact with the one below.
    joints : int
        Rows of the records of joints: as many as these contacts, or those of a body's vertices.
    links : int
        Their contacts follow, :func:`join_links`.
    """
    contacts = bodies - 1 + links
    rows = {
        "body": bodies,
        "joint": joints,
        "load": contacts + 2,
        "link": links,
        "bond": links,
        "ground": CHUNK + 1,
        "span": bodies,
    }
    rows |= {"hold": joints if links else 0, "pair": contacts, "touch": 2 * contacts}
    arrays: dict[str, Any] = {name: aligned_zeros(rows.get(name, 1), types[name]) for name in STATE[:-1]}
    arrays["stack"] = bodies - 1
    arrays["pair"]["lower"][: bodies - 1] = np.arange(bodies - 1)
    arrays["pair"]["upper"][: bodies - 1] = np.arange(1, bodies)
    _list(arrays, bodies - 1)
    return arrays


def join_links(arrays: dict[str, Any], lower: np.ndarray, upper: np.ndarray) -> None:
    """List the contacts of links between these bodies, behind those of the joints."""
    pair, first = arrays["pair"], len(arrays["body"]) - 1
    pair["lower"][first:], pair["upper"][first:] = lower, upper
    _list(arrays, len(pair))


def _list(arrays: dict[str, Any], count: int) -> None:
    """List the first contacts body by body; the last load is one of nothing."""
    from ...kernels.shared.contacts import list_contacts

    list_contacts(arrays["pair"], count, len(arrays["load"]) - 1, arrays["span"], arrays["touch"])


def state_of(arrays: dict[str, Any]) -> tuple[Any, ...]:
    """The arrays as the kernels take them."""
    return tuple(arrays[name] for name in STATE)
