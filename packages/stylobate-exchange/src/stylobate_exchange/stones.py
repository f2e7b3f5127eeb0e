"""What a model of another tool becomes here: an assembly in space of its stones, or a column of its drums, as tables."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from stylobate.column import Column
from stylobate.column.block import length_of
from stylobate.column.drum import Drum
from stylobate.column.found_geometry import space_geometry
from stylobate.column.materials import material
from stylobate.column.shapes import about
from stylobate.column.spatial.stone import MeshPart
from stylobate.constants import DEGREE
from stylobate.errors import InputError

from .fitting import Frustum, Hull, within_tolerance

#: A drum that leans less than this out of the one under it stands straight on it [degrees].
STRAIGHT = 0.05


#: What is nearer than this is where it was told [m]; decimals of corners in files; share of a volume that is told.
ROUNDING, DIGITS, TOLD = 1e-6, 10, 1e-4


def near(distance: float) -> str:
    """A distance between what was told and what stands for it, in words [m]."""
    return length_of(distance) if distance > ROUNDING else "rounding"


class Fitted(NamedTuple):
    """A stone of a model: its name, what fits it, whether it is a support, and its density [kg/m³] if the model tells."""

    name: str
    shape: Frustum | Hull
    fixed: bool
    density: float | None

    @property
    def words(self) -> str:
        """What it became, and how far the mesh is from that."""
        one, far = self.shape, near(self.shape.residual)
        more = 1.0 / one.filled - 1.0
        off = f"; its volume is {100.0 * more:+.2g} % off the mesh" if abs(more) > TOLD else ""
        off += ", whose mass it keeps" if off and self.density is not None and isinstance(one, Hull) else ""
        if isinstance(one, Hull):
            drum = "" if one.drum is None else f" (no round drum within {near(one.drum.residual)})"
            return f"block of {len(one.corners)} corners, within {far}{drum}{off}"
        flat = f", {near(one.flat)} more between corners" if one.flat > ROUNDING else ""
        return f"drum ⌀ {one.bottom:.4g} to {one.top:.4g} m, {one.height:.4g} m high, within {far}{flat}{off}"


def fit_all(
    parts: Sequence[tuple[MeshPart, bool, float | None]], hulls: Sequence[Hull], tolerance: float
) -> list[Fitted]:
    """What fits each part of a model within a tolerance [m]; parts ``NAME, part 1`` … are convex parts of one block.

    A hull has the mass of its part where the model tells a density: its own is less by what the hull adds.

    Raises
    ------
    InputError
        A part that is not convex, by its name.
    """
    found = []
    for (part, fixed, density), hull in zip(parts, hulls, strict=True):
        shape = within_tolerance(hull, tolerance, f"part {part.name!r}")
        shape = hull._replace(drum=None) if ", part " in part.name else shape
        if density is not None and isinstance(shape, Hull) and abs(shape.filled - 1.0) > TOLD:
            density = round(density * shape.filled, 3)
        found.append(Fitted(part.name, shape, fixed, density))
    return found


def body_of(part: str) -> str:
    """Name of the body that a part belongs to."""
    return part.partition(", part ")[0]


def assembly_tables(name: str, stones: Sequence[Fitted], stone: str | None, ground: float | None) -> dict[str, Any]:
    """Content of a file of an assembly in space.

    Parameters
    ----------
    name : str
    stones : sequence of Fitted
    stone : str or None
        Name of a material; None where all is stated otherwise.
    ground : float or None
        Level of the ground [m]; None for none.
    """
    blocks: dict[str, dict[str, Any]] = {}
    for one in stones:
        called, part = body_of(one.name), ", part " in one.name
        entry: dict[str, Any] = {}
        if isinstance(one.shape, Frustum):
            entry = _drum(one.shape)
        else:
            entry["vertices"] = (one.shape.corners.round(DIGITS) + 0.0).tolist()
        facts: dict[str, Any] = {"name": called} | ({"fixed": True} if one.fixed else {})
        facts |= {} if one.density is None else {"density": one.density}
        if part:
            blocks.setdefault(called, facts | {"at": [0.0, 0.0, 0.0], "parts": []})["parts"].append(entry)
        else:
            blocks[called] = facts | entry
    return {
        "name": name,
        **({} if stone is None else {"material": material(stone).name}),
        "ground": False if ground is None else ground,
        "block": list(blocks.values()),
    }


def _drum(one: Frustum) -> dict[str, Any]:
    """``at`` is the middle of the lower face before the drum is turned about its centroid."""
    high = Drum(one.height, one.bottom, one.top, 1.0e3, "circular").centroid_height
    at = one.foot + high * one.axis - (0.0, 0.0, high)
    table: dict[str, Any] = {
        "drum": {"bottom_diameter": one.bottom, "top_diameter": one.top, "height": one.height},
        "at": at.tolist(),
    }
    lean = math.hypot(*one.axis[:2])
    if lean > 0.0:
        across = (-float(one.axis[1]) / lean, float(one.axis[0]) / lean, 0.0)
        table["orientation"] = list(about(across, math.atan2(lean, float(one.axis[2]))))
    return table


def column_tables(
    name: str, stones: Sequence[Fitted], stone: str | None, tolerance: float
) -> tuple[dict[str, Any], list[str]]:
    """Content of a column file of drums that stand on one another, and what is said of them.

    Drums are as high and as wide as they fit; how they are offset and lean is what is found.

    Raises
    ------
    InputError
        A part that is no drum, or drums farther apart, or deeper in one another, than the tolerance [m].
    """
    other = next((one for one in stones if isinstance(one.shape, Hull)), None)
    if other is not None:
        drum = other.shape.drum if isinstance(other.shape, Hull) else None
        off = "" if drum is None else f" within {length_of(drum.residual)}"
        raise InputError(
            f"part {other.name!r} is no round drum{off}; a column is made of such, write an assembly.", "as"
        )
    order = sorted(stones, key=lambda one: float(one.shape.foot[2]) if isinstance(one.shape, Frustum) else 0.0)
    drums = [one.shape for one in order if isinstance(one.shape, Frustum)]
    rows, found, gaps = [], [], []
    axis, frame = np.array([0.0, 0.0, 1.0]), np.eye(3)
    for number, (one, named) in enumerate(zip(drums, order, strict=True), 1):
        rows.append({"height": one.height, "bottom_width": one.bottom, "top_width": one.top})
        if named.density is not None:
            rows[-1]["density"] = named.density
        facts: dict[str, Any] = {"index": number}
        if number > 1:
            below = drums[number - 2]
            way = one.foot - below.foot - below.height * below.axis
            gap = float(way @ axis)
            if abs(gap) > tolerance:
                what = "apart" if gap > 0.0 else "deep in one another"
                raise InputError(
                    f"{order[number - 2].name!r} and {named.name!r} are {length_of(abs(gap))} {what}; allowed are "
                    f"{length_of(tolerance)}: mend the mesh.",
                    "tolerance",
                )
            gaps.append(gap)
            x, y = (float(one) for one in frame[:, :2].T @ way)
            if math.hypot(x, y) > 1e-9:
                facts |= {"offset": math.hypot(x, y), "offset_azimuth": math.atan2(y, x) / DEGREE}
        x, y, z = (float(one) for one in frame.T @ one.axis)
        lean = math.atan2(math.hypot(x, y), z) / DEGREE
        if lean > STRAIGHT:
            facts |= {"tilt": -lean, "tilt_azimuth": math.atan2(y, x) / DEGREE}
            across = np.array([-y, x, 0.0]) / math.hypot(x, y)
            skew = np.array([[0.0, 0.0, across[1]], [0.0, 0.0, -across[0]], [-across[1], across[0], 0.0]])
            angle = lean * DEGREE
            frame = frame @ (np.eye(3) + math.sin(angle) * skew + (1.0 - math.cos(angle)) * skew @ skew)
            axis = frame[:, 2]
        if len(facts) > 1:
            found.append(facts)
    table: dict[str, Any] = {"name": name, "section": "circular", "drum": rows}
    table |= {} if stone is None else {"material": material(stone).name}
    if found:
        table["as_found"] = {"drum": found}
    apart = [f"drums fit on one another within {near(max(map(abs, gaps)))}"] if gaps else []
    return table, apart


def distance_of(column: Column, stones: Sequence[Fitted]) -> float:
    """Largest distance of the middle of a drum's lower face from where a mesh has it, from the lowest one's [m]."""
    drums = sorted((one.shape for one in stones if isinstance(one.shape, Frustum)), key=lambda one: float(one.foot[2]))
    at = space_geometry(column)
    feet = [at.centroid[i] - at.axes[i][:, 2] * drum.centroid_height for i, drum in enumerate(column.drums)]
    return max(
        float(np.linalg.norm((foot - feet[0]) - (one.foot - drums[0].foot)))
        for foot, one in zip(feet, drums, strict=True)
    )
