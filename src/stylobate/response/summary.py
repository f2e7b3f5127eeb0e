"""The JSON object of ``stylobate run``: measures under the names that scripts rely on, and joint by joint."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from ..constants import g
from .links import row_of
from .measures import BODY, MEASURES, Measures
from .words import doubt_of, mechanism_of, moving_at_end

if TYPE_CHECKING:
    from .recorded import Recorded


def summary_of(response: Recorded) -> dict:
    """Plain values. What has fallen has no residuals: they are None after a collapse, and peaks end with it."""
    run = {"wall_s": response.wall_time, "model": response.model, "version": response.provenance.get("version", "")}
    run |= losses_of(response.provenance) | opening_of(response.provenance)
    return (_of_blocks(response) if response.measures.blocks is not None else _of_column(response)) | run


def losses_of(provenance: Mapping[str, Any]) -> dict[str, Any]:
    """Which losses acted: their name, ``given`` where parameters say it, and what they come to; None of models without."""
    known = provenance.get("parameters", {})
    if "losses" not in known:
        return {"losses": None}
    acting = {name: known.get(name) for name in LOSSES if known.get(name)}
    acting |= {name: provenance[key] for name, key in LOSSES.items() if provenance.get(key)}
    given = not isinstance(known["losses"], str) or (acting and known["losses"] == "none")
    name = "given" if given else known["losses"]
    return {"losses": name, "losses_acting": acting}


def opening_of(provenance: Mapping[str, Any]) -> dict[str, Any]:
    """Static acceleration that rocks a column, on its joints and on rigid ones [g], and how far its toe reaches in [-]."""
    opens = provenance.get("opening")
    if opens is None:
        return {}
    return {
        "opening_acceleration_g": opens["acceleration"] / g,
        "opening_acceleration_rigid_g": opens["rigid"] / g,
        "toe_over_width": opens["toe"],
    }


#: Parameters by which a run loses energy besides friction, and where its provenance has what was chosen for them.
LOSSES = {
    "stiffness_damping": "stiffness_damping_s",
    "rolling_resistance": "rolling_resistance",
    "mass_damping": "",
    "restitution": "",
}


def _of_column(response: Recorded) -> dict:
    h, m = response.histories, response.measures
    row = m.row()
    before = h.time <= m.collapse_time if m.collapsed else np.ones(len(h.time), dtype=bool)
    before[:1] = True
    row["peak_opening_per_joint_m"] = _finite(np.abs(h.opening[before]).max(axis=0))
    if m.space is None:
        row["residual_slip_per_joint_m"] = _finite(h.slip[-1, :, 0])
    row["doubt"] = doubt_of(response)
    if m.collapsed:
        first = 1 if m.collapse is None or m.collapse.joint is None else m.collapse.joint
        row |= {measure.key: None for measure in MEASURES if measure.residual and measure.key in row}
        listed = (
            {"residual_slip_per_joint_m"} if m.residuals is None else {"residual_slip_per_joint_m", *m.residuals.row()}
        )
        for name in row.keys() & listed:  # body and joint by their numbers: what stood on the first joint that was lost
            row[name] = [value if i + 1 < first else None for i, value in enumerate(row[name])]
        if m.collapse is not None:
            row["collapse"] = m.collapse.to_dict() | {"side": m.collapse.side}
    row |= _of_links(m)
    if response.mechanism is not None:
        row["mechanism"] = asdict(response.mechanism) | {"sentence": response.mechanism.describe()}
    return row


def _of_blocks(response: Recorded) -> dict:
    m, blocks = response.measures, response.measures.blocks
    assert blocks is not None
    gone, moving = m.collapsed, moving_at_end(response)
    h, row = response.histories, m.row()
    for name in ("computed_by", "reason", "fallen_blocks", "collapse_azimuth_deg"):
        del row[name]
    before = h.time <= m.collapse_time if gone else np.ones(len(h.time), dtype=bool)
    row["peak_opening_per_joint_m"] = _finite(h.opening[before].max(axis=0))
    if m.residuals is not None:
        fell = [body.fell_at is not None or body.name in moving for body in blocks.bodies]
        row |= {name: [None] * len(each) if gone else each for name, each in m.residuals.of_joints().items()}
        for name, each in m.residuals.of_bodies().items():
            row[name] = [None if down else value for value, down in zip(each, fell, strict=True)]
    row |= {
        measure.key: None
        for measure in MEASURES
        if measure.residual and measure.key in row and (gone or (moving and measure.of == BODY))
    }
    for name in moving.keys() & row["bodies"].keys():
        row["bodies"][name]["residual_displacement_m"] = None
    return row | {
        "fallen": list(response.fallen),
        "in_equilibrium_as_drawn": blocks.in_equilibrium,
        "moving_at_end_m_s": moving,
        "struck_at_s": blocks.struck_at,
        "mechanism": mechanism_of(response),
        "doubt": doubt_of(response),
        **_of_links(m),
    }


def _of_links(m: Measures) -> dict:
    return row_of(m.links) | {"links": [link.row() for link in m.links]} if m.links else {}


def _finite(values: np.ndarray) -> list[float | None]:
    return [float(v) if np.isfinite(v) else None for v in values]
