"""Data of one run: what stood, histories, measures and provenance, and its bodies in space.

Words, tables, pages and files are made from it; :class:`stylobate.Response` is the same with all of these at hand.
"""

from __future__ import annotations

import dataclasses
import math
import warnings
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import store
from ..column import Column
from ..column.assembly import Assembly
from ..column.assembly_files import FROM_DICT
from ..column.shapes import hull
from ..column.structure import Structure
from ..errors import InputError, OutOfRangeWarning
from ..messages import MESSAGES, messages_in, restored
from ..outcome import Outcome
from .collapse import Collapse
from .histories import Histories
from .links import NAMES as LINKS
from .links import LinkHistories, LinkMeasures
from .measures import BlockMeasures, BodyMeasures, Measure, Measures, SpaceMeasures, measures_of
from .mechanism import Mechanism
from .poses import Bodies, PlanePoses, SpacePoses, bodies_of, exaggerated, rotation_matrices
from .residuals import Residuals, residuals_of

if TYPE_CHECKING:
    import xarray


class Views:
    """Attributes that a response passes on from its parts."""

    histories: Histories
    measures: Measures
    mechanism: Mechanism | None

    @property
    def poses(self) -> SpacePoses:
        """Position and orientation of every body in space."""
        raise NotImplementedError

    # -- histories -----------------------------------------------------------------------------------------------

    @property
    def time(self) -> np.ndarray:
        """Times of the recorded states [s], shape (T,)."""
        return self.histories.time

    @property
    def links(self) -> LinkHistories:
        """Forces, slips and elongations of the links over time."""
        if self.histories.links is None:
            raise AttributeError("what stood has no links that act; give the column some (links=…).")
        return self.histories.links

    @property
    def energy(self) -> dict[str, np.ndarray]:
        """Ledger [J], each term of shape (T,); see :class:`Histories`."""
        return self.histories.energy

    # -- measures ------------------------------------------------------------------------------------------------

    @property
    def outcome(self) -> Outcome:
        """End of the run."""
        return self.measures.outcome

    @property
    def collapsed(self) -> bool:
        """Whether it collapsed."""
        return self.measures.collapsed

    if (
        TYPE_CHECKING
    ):  # declared in ``histories.py`` and ``measures.py``; properties are made of these declarations below
        drum_x: np.ndarray
        drum_y: np.ndarray
        drum_z: np.ndarray
        drum_rotation: np.ndarray
        joint_opening: np.ndarray
        joint_slip: np.ndarray
        joint_twist: np.ndarray
        base_displacement: np.ndarray
        top_displacement: np.ndarray
        ground_acceleration: np.ndarray
        ground_displacement: np.ndarray
        imbalance: np.ndarray
        collapse_time: float
        peak_top_displacement: float
        residual_top_displacement: float
        peak_rotation: float
        peak_joint_opening: float
        residual_joint_slip: float
        energy_imbalance: float
        time_step: float
        steps: int
        peak_top_x: float | None
        peak_top_y: float | None
        peak_tilt: float | None
        peak_twist: float | None

    @property
    def reason(self) -> str:
        """Mechanism of a collapse, or why a run failed; empty otherwise."""
        return self.measures.reason

    @property
    def decided(self) -> bool:
        """False when the run ended while the verdict could still change."""
        return self.measures.decided

    @property
    def collapse(self) -> Collapse | None:
        """The collapse, as far as the model tells; None without one."""
        return self.measures.collapse

    @property
    def residuals(self) -> Residuals | None:
        """Residuals with their directions, joint by joint and body by body; None where the model does not tell."""
        return self.measures.residuals

    @property
    def residual_slip_per_joint(self) -> tuple[float, ...] | None:
        """Length of the offset along each joint at the end [m]."""
        return None if self.residuals is None else self.residuals.slips

    @property
    def residual_twist_per_joint(self) -> tuple[float, ...] | None:
        """Turn about each joint's normal at the end [rad]; None for plane models."""
        return None if self.residuals is None else self.residuals.twist

    @property
    def at_rest(self) -> bool | None:
        """Whether everything lies still at the end; None where the run cannot tell."""
        if self.measures.blocks is not None:
            return self.measures.blocks.at_rest
        return None if self.mechanism is None else self.mechanism.at_rest

    @property
    def fell_at(self) -> dict[str, float]:
        """When each body had fallen that has at the end [s]: lower by half of its height, or turned by over 45°."""
        if self.measures.blocks is not None:
            return dict(self.measures.blocks.fell_at)
        if self.mechanism is None:
            return {}
        return {
            f"drum {number}": time for number, time in zip(self.mechanism.fallen, self.mechanism.fell_at, strict=True)
        }

    @property
    def fallen(self) -> tuple[str, ...]:
        """Bodies that have fallen, of an assembly in this order; none where the run was not followed to the ground."""
        return tuple(self.fell_at)

    @property
    def displaced(self) -> tuple[str, ...]:
        """Bodies of an assembly that stand, and stand shifted."""
        return () if self.measures.blocks is None else self.measures.blocks.displaced

    # -- bodies in space -----------------------------------------------------------------------------------------

    @property
    def dims(self) -> str:
        """``xz`` for plane models, ``xyz`` in space."""
        return self.histories.dims

    @property
    def body_position(self) -> np.ndarray:
        """Centroid of every body relative to the moving base: x and y horizontal, z up [m], shape (T, n, 3)."""
        return self.poses.position

    @property
    def body_orientation(self) -> np.ndarray:
        """Unit quaternion of every body, real part first, from its axes to those of space [-], shape (T, n, 4)."""
        return self.poses.orientation

    @property
    def body_velocity(self) -> np.ndarray:
        """Velocity of every centroid relative to the moving base [m/s], shape (T, n, 3); of assemblies."""
        return _recorded(self.histories.velocity)

    @property
    def body_angular_velocity(self) -> np.ndarray:
        """Angular velocity of every body in the axes of space [rad/s], shape (T, n, 3); of assemblies."""
        return _recorded(self.histories.spin)

    @property
    def body_axis(self) -> np.ndarray:
        """Own axis of every body, upward in a column as built [-], shape (T, n, 3)."""
        return self.poses.axis

    @property
    def tilt(self) -> np.ndarray:
        """Angle between every body's axis and the vertical [rad], shape (T, n)."""
        x, y, z = np.moveaxis(self.poses.axis, -1, 0)
        return np.arctan2(np.hypot(x, y), z)

    @property
    def tilt_azimuth(self) -> np.ndarray:
        """Direction in which every body leans, from x towards y [rad], shape (T, n); 0 for an upright one."""
        x, y, _ = np.moveaxis(self.poses.axis, -1, 0)
        return np.arctan2(y, x) + 0.0  # no -0.0

    @property
    def opening(self) -> np.ndarray:
        """Largest gap between the two faces of each joint [m], shape (T, J); as ``joint_opening``."""
        return self.histories.opening

    @property
    def slip(self) -> np.ndarray:
        """Offset along x and y of each joint, from the start [m], shape (T, J, 2); zero along y in the plane.

        ``joint_slip`` has the shape (T, J) there.
        """
        return self.histories.slip

    @property
    def twist(self) -> np.ndarray:
        """Turn about the normal of each joint, from the start [rad], shape (T, J)."""
        return self.histories.twist

    @property
    def displacement(self) -> np.ndarray:
        """Distance of every centroid from where it was at the start [m], shape (T, n)."""
        poses = self.histories.poses
        if isinstance(poses, PlanePoses):
            return np.hypot(poses.x - poses.x[0], poses.z - poses.z[0])
        return np.linalg.norm(poses.position - poses.position[0], axis=-1)

    # -- bodies of an assembly ------------------------------------------------------------------------------

    @property
    def x(self) -> np.ndarray:
        """Place of every centroid along x [m], shape (T, n)."""
        return self._placed_by(0)

    @property
    def y(self) -> np.ndarray:
        """Place of every centroid along y [m], shape (T, n); zero in the plane."""
        return self._placed_by(1)

    @property
    def z(self) -> np.ndarray:
        """Height of every centroid [m], shape (T, n)."""
        return self._placed_by(2)

    @property
    def rotation(self) -> np.ndarray:
        """Rotation of every body, counter-clockwise positive (top to −x) [rad], shape (T, n); as ``drum_rotation``."""
        return self.histories.drum_rotation

    def _placed_by(self, axis: int) -> np.ndarray:
        poses = self.histories.poses
        if axis != 1 and isinstance(poses, PlanePoses) and self.measures.blocks is not None:
            return poses.x if axis == 0 else poses.z  # as recorded, to the last bit
        return self.poses.position[..., axis]


def _recorded(velocity: np.ndarray | None) -> np.ndarray:
    if velocity is None:
        raise AttributeError("velocities are recorded of assemblies only; differentiate body_position.")
    return velocity


def _read_directly(measure: Measure, part: str) -> None:
    """Make a measure an attribute of responses; None where the run has no such part."""

    def read(views: Views) -> float | None:
        holder = getattr(views.measures, part) if part else views.measures
        return None if holder is None else getattr(holder, measure.field)

    unit, where = measure.unit or "-", "; None for plane models" if part else ""
    setattr(Views, measure.field, property(read, doc=f"{measure.meaning.capitalize()} [{unit}]{where}."))


#: Histories that a response passes on.
_HISTORIES = (
    "drum_x", "drum_y", "drum_z", "drum_rotation", "joint_opening", "joint_slip", "joint_twist", "base_displacement",
    "top_displacement", "ground_acceleration", "ground_displacement", "imbalance",
)  # fmt: skip

for _name in _HISTORIES:
    setattr(Views, _name, property(attrgetter(f"histories.{_name}"), doc=getattr(Histories, _name).__doc__))

for _holder, _part in ((Measures, ""), (SpaceMeasures, "space")):
    for _one in measures_of(_holder):
        _read_directly(_one, _part)


@dataclass(frozen=True, eq=False, repr=False)
class Recorded(Views):
    """One run as data; everything relative to the moving base. The fields are those of :class:`stylobate.Response`."""

    structure: Structure
    histories: Histories
    measures: Measures
    model: str
    provenance: dict
    wall_time: float = 0.0
    mechanism: Mechanism | None = None
    followed: bool = False
    twins: tuple[Measures, ...] = ()

    @property
    def column(self) -> Column:
        """The column that stood."""
        return self.structure.must_be("column")

    @property
    def assembly(self) -> Assembly:
        """The assembly that stood."""
        return self.structure.must_be("assembly")

    # -- bodies --------------------------------------------------------------------------------------------------

    @cached_property
    def bodies(self) -> Bodies:
        """Names and shapes of all bodies."""
        return bodies_of(self.structure)

    @property
    def poses(self) -> SpacePoses:
        """Position and orientation of every body in space."""
        return self._in_space

    @cached_property
    def _in_space(self) -> SpacePoses:
        recorded = self.histories.poses
        return self.bodies.reference.space(recorded) if isinstance(recorded, PlanePoses) else recorded

    def outline(self, index: int, body: int, factor: float = 1.0) -> np.ndarray:
        """Corners of a body at a recorded state as seen along y, horizontally and upward [m], shape (k, 2).

        Parameters
        ----------
        index, body : int
            Number of the state and of the body, from 0.
        factor : float
            By which displacements and rotations are drawn larger.
        """
        shape, recorded = self.bodies.shapes[body], self.histories.poses
        if isinstance(recorded, PlanePoses):
            x, z, angle = self._plane(factor)[index, body] if factor != 1.0 else self._placed[index, body]
            c, s = np.cos(angle), np.sin(angle)
            return shape.outline @ np.array([[c, s], [-s, c]]) + (x, z)
        pose = exaggerated(recorded, index, factor)
        corners = shape.mesh().vertices @ rotation_matrices(pose.orientation[body]).T + pose.position[body]
        return hull(corners[:, [0, 2]])

    @cached_property
    def _placed(self) -> np.ndarray:
        return self._plane(1.0)

    def _plane(self, factor: float) -> np.ndarray:
        recorded = self.histories.poses
        assert isinstance(recorded, PlanePoses)
        return self.bodies.reference.plane(recorded, factor)


#: Distance, in sizes of the structure, beyond which a body is out of every picture.
ASIDE = 3.0


def way_of(response: Recorded) -> np.ndarray:
    """Displacement [m], shape (T,): the top along x with its sign, or the body that has moved farthest."""
    top = response.histories.top
    if top is None:
        return response.displacement.max(axis=1)
    return top if top.ndim == 1 else top[:, 0]


def size_of(response: Recorded) -> float:
    """Larger side of the box around everything that can move, as it stood, seen along y [m]."""
    moving = [i for i, fixed in enumerate(response.bodies.fixed) if not fixed]
    return float(np.ptp(np.concatenate([response.outline(0, i) for i in moving]), axis=0).max())


def telling_states(response: Recorded) -> list[int]:
    """Up to eight recorded states, from the first to the last that can be seen."""
    return _of_a_top(response) if response.histories.top is not None else _of_bodies(response)


def _of_a_top(response: Recorded) -> list[int]:
    """At rest, at the largest displacement in each fifth of the clear motion and before a collapse, and at the end."""
    way = way_of(response) if response.dims == "xz" else np.hypot(*response.top_displacement.T)
    far = np.nan_to_num(np.abs(way))
    time, last = response.collapse_time, _last_above_ground(response)
    before = far if math.isnan(time) else np.where(response.time <= time, far, 0.0)
    peak = int(before.argmax())
    far[last + 1 :] = before[last + 1 :] = 0.0
    moving = np.flatnonzero(np.abs(far[: last + 1] - far[last]) > 0.1 * before[peak])
    start, end = (int(moving[0]), int(moving[-1])) if moving.size else (0, last)
    start = max(start, int(np.argmax(before > 0.1 * before[peak])))
    edges = np.linspace(start, end + 1, 6).round().astype(int)
    spread = [low + int(far[low:high].argmax()) for low, high in pairwise(edges) if high > low]
    apart = 0.02 * (end - start)
    chosen = sorted({0, peak, *spread}) if last else []
    return [i for i in chosen if last - i > apart] + [last]


def _of_bodies(response: Recorded) -> list[int]:
    """The start, the end, and states between which the bodies have gone equal ways; the farthest if nothing falls."""
    places = response.body_position
    step = np.linalg.norm(np.diff(places, axis=0), axis=-1)
    step[response.displacement[1:] > ASIDE * size_of(response)] = 0.0  # out of the picture
    gone = np.concatenate(([0.0], np.nan_to_num(step).sum(axis=1).cumsum()))
    last = len(gone) - 1
    chosen = set(np.searchsorted(gone, np.linspace(0.0, gone[-1], 8)[1:-1]).tolist())
    if not response.collapsed:
        chosen.add(int(np.nan_to_num(response.displacement).max(axis=1).argmax()))
    frames = [0]
    for i in sorted(chosen):
        if min(gone[i] - gone[frames[-1]], gone[-1] - gone[i]) > 0.03 * gone[-1]:
            frames.append(i)
    return [*frames, last] if last else frames


def _last_above_ground(response: Recorded) -> int:
    """The last state to be seen: a model that does not follow what falls to the ground lets it pass through."""
    if response.followed:
        return len(response.time) - 1
    below = np.flatnonzero((response.body_position[..., 2] < 0.0).any(axis=1))
    return max(int(below[0]) - 1, 0) if below.size else len(response.time) - 1


# Responses as labelled data sets, and back without loss.
#
# A data set holds the histories along ``time``, ``drum`` and ``joint`` (both numbered from 1 at the base; an assembly has
# ``body`` by name), and ``axis``; the energy ledger as ``energy_*``; the measures as attributes under the names of
# ``stylobate run --json``; what stood, what happened and the provenance as JSON texts.

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
_ATTRIBUTES = {
    "decided": "decided",
    **{measure.field: measure.key for measure in measures_of(Measures)},
    "reason": "reason",
}


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
    variables = {name: (dims, values) for name, dims, values in _recorded_variables(response, of)}
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
        MESSAGES: messages_in({"reason": m.reason}),
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
        number = isinstance(value, (bool, np.bool_, np.integer))
        attributes[name] = int(value) if number else str.__str__(value) if isinstance(value, str) else value
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
        error.place(f"{store.printable(path)} does not hold what can be used")
        raise
    except Exception as error:
        raise store.unreadable(path, error) from None


def _recorded_variables(response: Recorded, of: str) -> list[tuple[str, tuple[str, ...], np.ndarray]]:
    """Name, dimensions and values of everything that a model recorded."""
    h, poses = response.histories, response.histories.poses
    body, joint = ("time", of), ("time", "joint")
    variables: list[tuple[str, tuple[str, ...], np.ndarray]] = []
    along: tuple[str, ...] = ("time",)
    if isinstance(poses, PlanePoses):
        names = ("x", "z", "rotation") if of == "body" else ("drum_x", "drum_z", "drum_rotation")
        variables += [
            (name, body, values) for name, values in zip(names, (poses.x, poses.z, poses.rotation), strict=True)
        ]
    else:
        along = ("time", "direction")
        variables.append(("body_position", (*body, "axis"), poses.position))
        variables.append(("body_orientation", (*body, "part"), poses.orientation))
        variables.append(("joint_twist", joint, h.twist))
    if h.velocity is not None and h.spin is not None:
        variables += [
            ("body_velocity", (*body, "axis"), h.velocity),
            ("body_angular_velocity", (*body, "axis"), h.spin),
        ]
    variables.append(("joint_opening", joint, h.opening))
    variables.append(("joint_slip", joint if h.dims == "xz" else (*joint, "direction"), h.joint_slip))
    if h.base is not None and h.top is not None:
        variables += [("base_displacement", along, h.base), ("top_displacement", along, h.top)]
    if h.links is not None:
        named = [*LINKS, *(["angle"] if h.links.angle is not None else [])]
        variables += [(f"link_{name}", ("time", "link"), getattr(h.links, name)) for name in named]
    ground = ("time",) if h.dims == "xz" else ("time", "axis")
    variables += [
        ("ground_acceleration", ground, h.ground_acceleration),
        ("ground_displacement", ground, h.ground_displacement),
    ]
    if h.dims == "xz" and (h.acceleration[:, 2].any() or h.displacement[:, 2].any()):
        variables.append(("ground_acceleration_z", ("time",), h.acceleration[:, 2]))
        variables.append(("ground_displacement_z", ("time",), h.displacement[:, 2]))
    return variables


def _from_dataset(data: xarray.Dataset) -> Recorded:
    kind = next(name for name in FROM_DICT if name in data)
    structure = FROM_DICT[kind](store.from_json(data, kind))
    provenance = store.from_json(data, "provenance")
    facts = store.from_json(data, "facts")
    collapse, space, blocks = facts["collapse"], facts["space"], facts["blocks"]
    if blocks is not None:
        blocks["fell_at"] = tuple((str(name), float(time)) for name, time in blocks["fell_at"])
        blocks["bodies"] = tuple(BodyMeasures(**_tuples(body)) for body in blocks.get("bodies", ()))
        blocks.pop("joints", None)  # of an earlier version
    histories = _histories(data, structure)
    if "residuals" in facts:
        residuals = None if facts["residuals"] is None else Residuals(**_tuples(facts["residuals"]))
    else:  # of an earlier version: without directions, or among other measures
        residuals = residuals_of(structure, histories)
        space = None if space is None else {name: value for name, value in space.items() if name.startswith("peak")}
    parts = {
        "residuals": residuals,
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
        _measures(restored(data.attrs, facts.get(MESSAGES, {})), **parts),
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
    link_values = [get(f"link_{name}") for name in (*LINKS, "angle") if f"link_{name}" in data]
    links = LinkHistories(*link_values) if link_values else None
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
        histories = Histories.in_space(
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
        return dataclasses.replace(histories, links=links, **moving)
    ground = {}
    for name in ("ground_acceleration", "ground_displacement"):
        ground[name] = get(name)
        if f"{name}_z" in data:
            ground[name] = np.stack((ground[name], np.zeros(steps), get(f"{name}_z")), axis=1)
    if structure.relative:
        body = {name: get(name) for name in ("drum_x", "drum_z", "drum_rotation")}
        ends = {name: get(name) for name in ("base_displacement", "top_displacement")}
        histories = Histories.of_drums(get("time"), **body, **joint, **ends, **ground, energy=energy)
    else:
        body = {name: get(name) for name in ("x", "z", "rotation")}
        histories = Histories.of_blocks(get("time"), **body, **joint, **ground, energy=energy)
    for values in body.values():
        _check(values, (steps, bodies))
    return dataclasses.replace(histories, links=links, **moving)


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
