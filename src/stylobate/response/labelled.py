"""Responses as labelled data sets, and back without loss.

A data set holds the histories along ``time``, ``drum`` and ``joint`` (both numbered from 1 at the base; an assembly has
``body`` by name), and ``axis``; the energy ledger as ``energy_*``; the measures as attributes under the names of
``stylobate run --json``; what stood, what happened and the provenance as JSON texts.
"""

from __future__ import annotations

import dataclasses
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import store
from ..column.assembly_files import FROM_DICT
from ..column.structure import Structure
from ..errors import InputError, OutOfRangeWarning
from ..outcome import Outcome
from .collapse import Collapse
from .histories import Histories
from .links import NAMES as LINKS
from .links import LinkHistories, LinkMeasures
from .measures import BlockMeasures, BodyMeasures, Measures, SpaceMeasures, measures_of
from .mechanism import Mechanism
from .poses import PlanePoses
from .recorded import Recorded
from .residuals import Residuals, residuals_of

if TYPE_CHECKING:
    import xarray

#: Terms of the energy ledger have this before their names.
ENERGY = "energy_"

# name: unit, meaning; of columns in the plane and in space, of assemblies in the plane
_BODY = {
    "drum_x": ("m", "horizontal displacement of the drum's centroid relative to the base"),
    "drum_z": ("m", "vertical displacement of the drum's centroid relative to the base"),
    "drum_rotation": ("rad", "rotation of the drum, counter-clockwise positive"),
    "x": ("m", "horizontal place of the body's centroid relative to the base"),
    "z": ("m", "height of the body's centroid relative to the base"),
    "rotation": ("rad", "rotation of the body, counter-clockwise positive"),
    "body_position": ("m", "centroid relative to the moving base, z upward"),
    "body_orientation": ("1", "unit quaternion from the body's axes to those of space, real part first"),
    "body_velocity": ("m s-1", "velocity of the centroid relative to the moving base"),
    "body_angular_velocity": ("rad s-1", "angular velocity in the axes of space"),
    "tilt": ("rad", "angle between the body's axis and the vertical"),
}
_REST = {
    "joint_opening": ("m", "largest gap between the faces of the joint"),
    "joint_slip": ("m", "offset along the joint of the body above it"),
    "joint_twist": ("rad", "turn of the body above the joint about its normal"),
    "base_displacement": ("m", "horizontal displacement of the lowest face relative to the base"),
    "top_displacement": ("m", "horizontal displacement of the topmost face relative to the base"),
    "ground_acceleration": ("m s-2", "acceleration of the base"),
    "ground_displacement": ("m", "displacement of the base"),
    "ground_acceleration_z": ("m s-2", "vertical acceleration of the base"),
    "ground_displacement_z": ("m", "vertical displacement of the base"),
    "link_shear": ("N", "force of the link across its joint"),
    "link_tension": ("N", "tension of the link, along it or against the opening of its joint"),
    "link_slip": ("m", "slip of the joint at the link's place"),
    "link_elongation": ("m", "elongation of the link, or lift of the joint at its place"),
    "link_angle": (
        "rad",
        "direction of link_shear on the body above, from the first to the second way of slip of the link",
    ),
}
_MEANINGS = _BODY | _REST

#: Attributes of a file beside the outcome, by field of the measures: the same as in tables and JSON.
_ATTRIBUTES = {"decided": "decided", **{one.field: one.key for one in measures_of(Measures)}, "reason": "reason"}


def to_dataset(response: Recorded, *, derived: bool = True) -> xarray.Dataset:
    """A response as a labelled data set; see :meth:`Response.to_xarray`.

    Parameters
    ----------
    response : Recorded
    derived : bool
        With what follows from the rest: position and tilt of plane models in space.
    """
    import xarray

    h, bodies, m = response.histories, response.bodies, response.measures
    of = "body" if m.blocks is not None else "drum"
    variables = {name: (dims, values) for name, dims, values in _recorded(response, of)}
    if derived and h.dims == "xz":
        variables["body_position"] = (("time", of, "axis"), response.body_position)
    if derived:
        variables["tilt"] = (("time", of), response.tilt)
    labelled: dict[str, Any] = {
        name: (dims, values, dict(zip(("units", "long_name"), _MEANINGS[name], strict=True)))
        for name, (dims, values) in variables.items()
    }
    for term, values in h.energy.items():
        labelled[ENERGY + term] = ("time", values, {"units": "J", "long_name": f"energy ledger: {term}"})
    facts = {
        "collapse": None if m.collapse is None else m.collapse.to_dict(),
        "space": None if m.space is None else dataclasses.asdict(m.space),
        "residuals": None if m.residuals is None else dataclasses.asdict(m.residuals),
        "blocks": None if m.blocks is None else dataclasses.asdict(m.blocks),
        "mechanism": None if response.mechanism is None else dataclasses.asdict(response.mechanism),
        "followed": response.followed,
    }
    if m.stepped is not None:
        facts["stepped"] = list(m.stepped)
    if m.links:
        facts["links"] = [link.row() for link in m.links]
    labelled[response.structure.kind] = ((), store.as_json(response.structure.to_dict()))
    labelled |= {"facts": ((), store.as_json(facts)), "provenance": ((), store.as_json(response.provenance))}
    numbers = np.arange(1, len(bodies.names) + 1)
    joints = np.arange(1, h.opening.shape[1] + 1)
    coordinates: dict[str, Any] = {
        "time": ("time", h.time, {"units": "s", "long_name": "time"}),
        "joint": ("joint", joints, {"long_name": response.structure.joints_are}),
    }
    if of == "body":
        coordinates["body"] = (
            "body",
            [name.replace("\0", "\N{REPLACEMENT CHARACTER}") for name in bodies.names],
            {"long_name": "name of the body"},
        )
    else:
        coordinates["drum"] = ("drum", numbers, {"long_name": "drum, numbered from the bottom"})
    if h.links is not None:
        coordinates["link"] = ("link", [link.name for link in m.links], {"long_name": "name of the link"})
    if any("axis" in entry[0] for entry in labelled.values()):
        coordinates["axis"] = ("axis", ["x", "y", "z"], {"long_name": "axis: x, y horizontal, z up"})
    attributes: dict[str, Any] = {"model": response.model, "dims": h.dims, "wall_s": float(response.wall_time)}
    attributes |= {"outcome": m.outcome.label}
    for field, name in _ATTRIBUTES.items():
        value = getattr(m, field)
        attributes[name] = int(value) if isinstance(value, (bool, np.bool_, np.integer)) else value
    return xarray.Dataset(labelled, coordinates, attributes)


def load(path: str | Path) -> Recorded:
    """Read a response that was saved by this version or the one before it.

    Raises
    ------
    InputError
        There is no such file, it is damaged, or it is not a response.
    """
    data = store.read(path, "response")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", OutOfRangeWarning)  # they were given when the column was made
            return _from_dataset(data)
    except InputError as error:
        error.place(f"{store.shown(path)} does not hold what can be used")
        raise
    except Exception as error:
        raise store.unreadable(path, error) from None


def _recorded(response: Recorded, of: str) -> list[tuple[str, tuple[str, ...], np.ndarray]]:
    """Name, dimensions and values of everything that a model recorded."""
    h, poses = response.histories, response.histories.poses
    body, joint = ("time", of), ("time", "joint")
    found: list[tuple[str, tuple[str, ...], np.ndarray]] = []
    along: tuple[str, ...] = ("time",)
    if isinstance(poses, PlanePoses):
        names = ("x", "z", "rotation") if of == "body" else ("drum_x", "drum_z", "drum_rotation")
        found += [(name, body, values) for name, values in zip(names, (poses.x, poses.z, poses.rotation), strict=True)]
    else:
        along = ("time", "direction")
        found.append(("body_position", (*body, "axis"), poses.position))
        found.append(("body_orientation", (*body, "part"), poses.orientation))
        found.append(("joint_twist", joint, h.twist))
    if h.velocity is not None and h.spin is not None:
        found += [("body_velocity", (*body, "axis"), h.velocity), ("body_angular_velocity", (*body, "axis"), h.spin)]
    found.append(("joint_opening", joint, h.opening))
    found.append(("joint_slip", joint if h.dims == "xz" else (*joint, "direction"), h.joint_slip))
    if h.base is not None and h.top is not None:
        found += [("base_displacement", along, h.base), ("top_displacement", along, h.top)]
    if h.links is not None:
        named = [*LINKS, *(["angle"] if h.links.angle is not None else [])]
        found += [(f"link_{name}", ("time", "link"), getattr(h.links, name)) for name in named]
    ground = ("time",) if h.dims == "xz" else ("time", "axis")
    found += [
        ("ground_acceleration", ground, h.ground_acceleration),
        ("ground_displacement", ground, h.ground_displacement),
    ]
    if h.dims == "xz" and (h.acceleration[:, 2].any() or h.displacement[:, 2].any()):
        found.append(("ground_acceleration_z", ("time",), h.acceleration[:, 2]))
        found.append(("ground_displacement_z", ("time",), h.displacement[:, 2]))
    return found


def _from_dataset(data: xarray.Dataset) -> Recorded:
    kind = next(name for name in FROM_DICT if name in data)
    structure = FROM_DICT[kind](store.from_json(data, kind))
    provenance = store.from_json(data, "provenance")
    facts = store.from_json(data, "facts")
    collapse, space, blocks = facts["collapse"], facts["space"], facts["blocks"]
    if blocks is not None:
        blocks["fell_at"] = tuple((str(name), float(time)) for name, time in blocks["fell_at"])
        blocks["bodies"] = tuple(BodyMeasures(**_tuples(one)) for one in blocks.get("bodies", ()))
        blocks.pop("joints", None)  # of an earlier version
    histories = _histories(data, structure)
    if "residuals" in facts:
        left = None if facts["residuals"] is None else Residuals(**_tuples(facts["residuals"]))
    else:  # of an earlier version: without directions, or among other measures
        left = residuals_of(structure, histories)
        space = None if space is None else {name: one for name, one in space.items() if name.startswith("peak")}
    parts = {
        "residuals": left,
        "collapse": None if collapse is None else Collapse.from_dict(collapse),
        "space": None if space is None else SpaceMeasures(**_tuples(space)),
        "blocks": None if blocks is None else BlockMeasures(**blocks),
        "stepped": tuple(facts["stepped"]) if "stepped" in facts else None,
        "links": tuple(LinkMeasures.from_row(row) for row in facts.get("links", ())),
    }
    mechanism = facts["mechanism"]
    return Recorded(
        structure,
        histories,
        _measures(data.attrs, **parts),
        str(data.attrs["model"]),
        provenance,
        float(data.attrs["wall_s"]),
        None if mechanism is None else Mechanism(**_tuples(mechanism)),
        bool(facts["followed"]),
    )


def _histories(data: xarray.Dataset, structure: Structure) -> Histories:
    def get(name: str) -> np.ndarray:
        return data[name].to_numpy()

    steps, energy = len(data["time"]), _energy(data)
    velocities = "body_velocity", "body_angular_velocity"
    moving = {field: get(name) for field, name in zip(("velocity", "spin"), velocities) if name in data}
    held = [get(f"link_{name}") for name in (*LINKS, "angle") if f"link_{name}" in data]
    links = LinkHistories(*held) if held else None
    bodies = len(structure.shapes)
    for values in moving.values():
        _check(values, (steps, bodies, 3))
    joint = {"joint_opening": get("joint_opening"), "joint_slip": get("joint_slip")}
    if "body_orientation" in data:
        names = ("body_position", "body_orientation", "joint_twist")
        ends = {name: get(name) if name in data else None for name in ("base_displacement", "top_displacement")}
        position, orientation, twist = map(get, names)
        _check(position, (steps, bodies, 3))
        _check(orientation, (steps, bodies, 4))
        found = Histories.in_space(
            get("time"),
            position,
            orientation,
            **joint,
            joint_twist=twist,
            base_displacement=ends["base_displacement"],
            top_displacement=ends["top_displacement"],
            ground_acceleration=get("ground_acceleration"),
            ground_displacement=get("ground_displacement"),
            energy=energy,
        )
        return dataclasses.replace(found, links=links, **moving)
    ground = {}
    for name in ("ground_acceleration", "ground_displacement"):
        ground[name] = get(name)
        if f"{name}_z" in data:
            ground[name] = np.stack((ground[name], np.zeros(steps), get(f"{name}_z")), axis=1)
    if structure.relative:
        body = {name: get(name) for name in ("drum_x", "drum_z", "drum_rotation")}
        ends = {name: get(name) for name in ("base_displacement", "top_displacement")}
        found = Histories.of_drums(get("time"), **body, **joint, **ends, **ground, energy=energy)
    else:
        body = {name: get(name) for name in ("x", "z", "rotation")}
        found = Histories.of_blocks(get("time"), **body, **joint, **ground, energy=energy)
    for values in body.values():
        _check(values, (steps, bodies))
    return dataclasses.replace(found, links=links, **moving)


def _energy(data: xarray.Dataset) -> dict[str, np.ndarray]:
    return {
        str(name).removeprefix(ENERGY): values.to_numpy()
        for name, values in data.data_vars.items()
        if str(name).startswith(ENERGY)
    }


def _measures(attributes: dict[str, Any], **parts: Any) -> Measures:
    values: dict[str, Any] = {field: attributes[name] for field, name in _ATTRIBUTES.items() if name in attributes}
    for field, value in values.items():
        if isinstance(value, np.generic):
            values[field] = value.item()
    values["decided"] = bool(values["decided"])
    return Measures(outcome=Outcome[attributes["outcome"].upper()], **values, **parts)


def _check(values: np.ndarray, shape: tuple[int, ...]) -> None:
    if values.shape != shape:
        raise InputError(f"an array of shape {values.shape} where {shape} belongs; run again.")


def _tuples(values: dict[str, Any]) -> dict[str, Any]:
    return {key: tuple(value) if isinstance(value, list) else value for key, value in values.items()}
