"""What stands as bodies on closed joints, with the forces at rest: columns and assemblies, in the plane and in space."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..column.column import Column
from ..column.found_geometry import SpaceGeometry, overlap_edges, space_geometry, space_load
from ..column.shapes import cut
from ..column.structure import Structure
from ..constants import DEGREE
from ..errors import InputError
from ..messages import say
from ..models.dem2d.model import DistinctElement2D
from ..models.dem3d.model import DistinctElement3D
from ..models.dem3d.packing import face_corners
from ..models.drums.links import acting
from ..models.drums.records import contact_points, joint_stiffnesses
from ..models.engine import engine_for
from .small_vibrations import AROUND, ClosedJoint, Spring, Vibrating, pressed

#: Corners around a round face that is not whole, or not over a whole one.
FINE = 360

#: Rounds in which the points of an assembly that touch at rest are looked for.
ROUNDS = 100

#: Share of the largest stiffness that holds what nothing holds while that is looked for.
LOOSE = 1e-9

#: Depth over the largest one of an assembly below which a contact point is not pressed.
BARELY = 1e-6

#: Limit of torsion of a closed round face over that of shear and its radius [-].
DISC_LEVER = 2.0 / 3.0


def vibrating(structure: Structure, model: Any) -> Vibrating:
    """What stands, linear about rest, on the joints of a model.

    Raises
    ------
    InputError
        A joint is open at rest, or the model does not compute what stands.
    """
    if not isinstance(model, (DistinctElement2D, DistinctElement3D)):
        raise InputError(
            f"modes are of joints with stiffness, and {getattr(model, 'name', model)!s} is not a model of them; allowed are "
            "dem2d and dem3d.",
            "model",
        )
    engine_for(model, structure)  # which refuses
    if isinstance(model, DistinctElement2D):
        return _in_plane(structure, model)
    column = structure.stack
    if column is not None:
        return _column_in_space(column, model)
    if structure.space_joints is None:
        raise InputError(
            f"modes in space are of columns and of assemblies in space, and {structure.name!r} is {structure.described}; "
            "use dem2d, or write it with shapes in space."
        )
    return _assembly_in_space(structure)


# -- columns in space --------------------------------------------------------------------------------------------------


def _column_in_space(column: Column, model: DistinctElement3D) -> Vibrating:
    how = model.acting(column)
    law = how.law if column.section == "circular" else "corners"
    if law != "bed":
        column.must_carry_on_whole_faces(f"dem3d with law={law}")
    if column.on_rings and column.as_found:
        raise InputError(
            f"modes know joints on rings of columns as built, and {column.name!r} is as found; leave ring_width or "
            "[as_found] out."
        )
    at, (kn, ks) = space_geometry(column), joint_stiffnesses(column, model.block_modulus)
    joints = [_joint_of_column(column, at, j, law, float(kn[j]), float(ks[j])) for j in range(column.n)]
    return _column_on(column, at, joints)


def _column_on(column: Column, at: SpaceGeometry, joints: Sequence[ClosedJoint]) -> Vibrating:
    """A column whose drums stand as this geometry says, on these joints."""
    axes = np.concatenate((np.eye(3)[None], at.axes))
    moments = np.array([(drum.cross_inertia, drum.inertia, drum.axial_inertia) for drum in column.drums])
    inertias = np.einsum("nab,nb,ncb->nac", at.axes, moments, at.axes)
    last = column.drums[-1]
    springs, left_out = _springs(column, np.concatenate((np.zeros((1, 3)), at.centroid)), axes)
    return Vibrating(
        names=("base", *(f"drum {i}" for i in range(1, column.n + 1))),
        centroids=np.concatenate((np.zeros((1, 3)), at.centroid)),
        masses=np.concatenate(([0.0], column.masses)),
        inertias=np.concatenate((np.zeros((1, 3, 3)), inertias)),
        free=np.arange(column.n + 1) > 0,
        joints=tuple(joints),
        springs=springs,
        top=at.centroid[-1] + (last.height - last.centroid_height) * at.axes[-1][:, 2],
        top_body=column.n,
        left_out=left_out,
    )


def _joint_of_column(column: Column, at: SpaceGeometry, j: int, law: str, kn: float, ks: float) -> ClosedJoint:
    """A joint of a column, under the weight above and the pull of its links."""
    points, weights, edge, area, lever, lower = _contact(column, at, j, law)
    load = space_load(column, at, j)
    springs = kn * area * weights / weights.sum()
    closure = pressed(points, springs, edge, load.normal, load.place)
    _refuse_open(column, j, closure, edge, load.place, "space")
    middle = weights @ points / weights.sum()
    polar = float(weights @ ((points - middle) ** 2).sum(axis=1) / weights.sum()) * area
    torsion = (0.5 if law == "rim" else 1.0) * ks * polar
    frame, origin = at.frame[j], at.origin[j]

    def in_space(places: np.ndarray) -> np.ndarray:
        return origin + places @ frame[:, :2].T

    friction = column.friction[j] * load.normal + column.joint_laws[j].cohesion * area
    return ClosedJoint(
        name=say("joint {number}", number=j + 1),
        lower=j,
        upper=j + 1,
        frame=frame,
        points=in_space(points),
        springs=springs,
        edge=in_space(edge),
        shear=ks * area,
        torsion=torsion,
        middle=in_space(middle),
        force=frame @ np.array([*(-load.shear), load.normal]),
        place=in_space(load.place),
        closure=closure,
        follows_lower=lower,
        friction=friction,
        lever=lever,
        area=area,
        second_moment=float(column.joint_second_moments[j]),
    )


def _contact(
    column: Column, at: SpaceGeometry, j: int, law: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float, float, float]:
    """Points of a joint along it [m] and their weights, its edge [m], area [m²], lever of torsion [m], and the share of its
    force that turns with the body below."""
    drum, below = column.drums[j], column.drums[j - 1] if j else None
    condition, offset = column.as_found.of(j + 1), at.offset[j]
    if law == "corners":
        corners = _turned(face_corners(drum, condition), at.turned[j]) + offset
        if below is not None:
            back = _turned(corners, -at.turned[j - 1])
            half = np.array([0.5 * below.top_width, 0.5 * below.upper_depth])
            corners = _turned(np.clip(back, -half, half), at.turned[j - 1])
        area = abs(_area(corners))
        lever = float(np.hypot(*(corners - corners.mean(axis=0)).T).mean())
        under = 1.0 if below is None else _lower_share(drum.bottom_width, below.top_width)
        return corners, np.ones(4), corners, area, lever, under
    lower = 1.0 if below is None else _lower_share(drum.bottom_width, below.top_width)
    radius = 0.5 * (drum.bottom_width if below is None else min(drum.bottom_width, below.top_width))
    whole = not condition.chipped and (
        below is None or math.hypot(*offset) <= 0.5 * abs(drum.bottom_width - below.top_width) * (1.0 + 1e-12)
    )
    if whole:
        middle = offset if below is None or drum.bottom_width <= below.top_width else np.zeros(2)
        circle = _circle(AROUND)
        inner = 0.5 * max(column.sunken_widths(j)) if column.on_rings else 0.0
        area = math.pi * (radius**2 - inner**2)
        reach = radius if law == "rim" else math.sqrt(0.5 * (radius**2 + inner**2))
        lever = DISC_LEVER * (radius**3 - inner**3) / (radius**2 - inner**2)
        return middle + reach * circle, np.ones(AROUND), middle + radius * circle, area, lever, lower
    polygon = _overlap(column, at, j)
    area = _area(polygon)
    if law == "rim":
        points, weights = edge_points(polygon)
    else:
        points, weights = area_points(polygon)
    middle = weights @ points / weights.sum()
    spread = float(weights @ ((points - middle) ** 2).sum(axis=1) / weights.sum())
    lever = DISC_LEVER * math.sqrt(spread * (1.0 if law == "rim" else 2.0))
    return points, weights, polygon, area, lever, 0.5 if below is not None else 1.0


def _lower_share(above: float, below: float) -> float:
    """Share of a joint's pressure along the normal of its lower face: the edge of a smaller face presses on the
    larger one.
    """
    return 0.5 if math.isclose(above, below, rel_tol=1e-9) else float(above < below)


def _overlap(column: Column, at: SpaceGeometry, j: int) -> np.ndarray:
    """Overlap of the faces of a joint, along it [m], shape (k, 2)."""
    edges = overlap_edges(column, at, j)
    (first, radius), *others = edges.discs
    polygon = first + radius * _circle(FINE)
    for middle, size in others:
        for way in _circle(FINE):
            polygon = cut(polygon, way, size + float(way @ middle))
    for normal, bound in edges.sides:
        polygon = cut(polygon, normal, bound)
    return polygon


def _circle(count: int) -> np.ndarray:
    angle = np.arange(count) * (2.0 * math.pi / count)
    return np.stack((np.cos(angle), np.sin(angle)), axis=1)


def _turned(points: np.ndarray, angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


def _area(polygon: np.ndarray) -> float:
    x, y = polygon.T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def edge_points(polygon: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points on the sides of a polygon and their weights, exact for squares of places: Gauss's rule of two a side."""
    side = np.roll(polygon, -1, axis=0) - polygon
    places = 0.5 + np.array([-0.5, 0.5]) / math.sqrt(3.0)
    points = polygon[:, None] + places[None, :, None] * side[:, None]
    return points.reshape(-1, 2), np.repeat(0.5 * np.hypot(*side.T), 2)


def area_points(polygon: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points in a convex polygon and their weights, exact for squares of places: middles of the sides of its triangles."""
    foot, first, second = polygon[0], polygon[1:-1], polygon[2:]
    a, b = first - foot, second - foot
    area = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    points = np.concatenate((0.5 * (foot + first), 0.5 * (foot + second), 0.5 * (first + second)))
    return points, np.tile(area / 3.0, 3)


def _refuse_open(column: Column, j: int, closure: np.ndarray, edge: np.ndarray, place: np.ndarray, where: str) -> None:
    """Refuse a joint part of which is open at rest."""
    if float(closure.min()) > 0.0:
        return
    away = float(np.hypot(*(place - edge.mean(axis=0))))
    closed = away * float(closure.mean()) / max(float(closure.mean() - closure.min()), 1e-300)
    raise InputError(
        f"joint {j + 1} of {column.name!r} is open at rest: the weight above passes {1000.0 * away:.3g} mm beside "
        f"its middle, "
        f"and it stays closed up to {1000.0 * closed:.3g} mm; modes are of closed joints: correct its offsets, "
        f"tilts, chips or "
        f"base_tilt{'' if where == 'plane' else ', or take it as built'}.",
        f"found.{j + 1}.offset",
    )


# -- the plane ---------------------------------------------------------------------------------------------------------


def _in_plane(structure: Structure, model: DistinctElement2D) -> Vibrating:
    """Columns and assemblies of the plane engine; y is out of the plane."""
    column = structure.stack
    if column is not None and not column.as_found.in_plane:
        raise InputError(
            f"dem2d computes the plane of x and z, and {column.name!r} is found out of it; use dem3d, or "
            "project it onto a plane (`project=AZIMUTH`)."
        )
    kn, ks = joint_stiffnesses(structure, model.block_modulus if column is not None else None)
    if column is None:
        engine_for(model, structure).check_rigid()
    bodies = structure.bodies
    xi, share = contact_points(structure.section or "rectangular", model.points)
    centroids = np.array([(body.place[0], 0.0, body.place[1]) for body in bodies])
    free = np.array([not body.fixed for body in bodies])
    inertias = np.zeros((len(bodies), 3, 3))
    inertias[:, 1, 1] = [0.0 if body.fixed else body.inertia for body in bodies]
    if column is not None:
        inertias[1:, 2, 2] = [drum.axial_inertia for drum in column.drums]
    joints = []
    for j, pair in enumerate(structure.face_pairs):
        ends, frame, lower = _plane_contact(structure, pair)
        length = float(np.linalg.norm(ends[1] - ends[0]))
        middle = 0.5 * (ends[0] + ends[1])
        points = middle + 0.5 * length * xi[:, None] * frame[:, 0]
        area = pair.area / pair.width * length
        torsion = 0.0
        if column is not None:  # of its shear stiffness spread over the face: the plane itself knows no torsion
            deep = column.joint_areas[j] / column.joint_widths[j]
            across = column.joint_second_moments[j] if column.section == "circular" else area * deep**2 / 12.0
            torsion = float(ks[j] * (column.joint_second_moments[j] + across))
        second = math.nan if column is None else float(column.joint_second_moments[j])
        joints.append(
            ClosedJoint(
                name=_between(structure, pair.lower, pair.upper)
                if column is None
                else say("joint {number}", number=j + 1),
                lower=pair.lower,
                upper=pair.upper,
                frame=frame,
                points=points,
                springs=float(kn[j]) * area * share,
                edge=ends,
                shear=float(ks[j]) * area,
                torsion=torsion,
                middle=middle,
                force=np.zeros(3),
                place=middle,
                closure=np.zeros(2),
                follows_lower=lower,
                friction=pair.law.tan_phi,
                lever=DISC_LEVER * 0.5 * length,
                area=area,
                second_moment=second,
            )
        )
    axes = np.array([_upright(body.angle) for body in bodies])
    springs, left_out = _springs(structure, centroids, axes)
    masses = np.array([0.0 if body.fixed else body.mass for body in bodies])
    names = tuple(body.name for body in bodies)
    standing = Vibrating(names, centroids, masses, inertias, free, tuple(joints), springs, left_out=left_out)
    slope = structure.as_found.base_tilt * DEGREE
    down = structure.gravity * np.array([-math.sin(slope), 0.0, -math.cos(slope)])
    if column is None:
        return _at_rest(structure, standing, down, (0, 2, 4))
    return _loaded_column(column, standing, down)


def _plane_contact(structure: Structure, pair: Any) -> tuple[np.ndarray, np.ndarray, float]:
    """Ends of the contact of two faces in the plane [m], shape (2, 3), its axes, and the share that turns with the
    lower body.
    """
    lower, upper = (structure.bodies[i] for i in (pair.lower, pair.upper))

    def of(body: Any, face: Any, side: float) -> tuple[np.ndarray, np.ndarray, float, float]:
        lean = _upright(body.lean)
        way = lean @ np.array([face.direction[0], 0.0, face.direction[1]])
        normal = np.array([-way[2], 0.0, way[0]])
        foot = np.array([body.place[0], 0.0, body.place[1]]) + side * face.height * normal
        return foot, way, -face.left, face.right

    foot, way, low, high = of(lower, pair.below, 1.0)
    other, _, left, right = of(upper, pair.above, -1.0)
    shift = float((other - foot) @ way)
    ends = max(low, shift + left), min(high, shift + right)
    normal = np.array([-way[2], 0.0, way[0]])
    frame = np.column_stack((way, np.cross(normal, way), normal))
    near = 1e-9 * (ends[1] - ends[0])
    inner = (shift + left > low + near) + (shift + right < high - near)
    outer = (shift + left < low - near) + (shift + right > high + near)
    return np.array([foot + end * way for end in ends]), frame, 0.5 + 0.25 * (inner - outer)


def _upright(angle: float) -> np.ndarray:
    """Axes of a body that is inclined counter-clockwise in the plane of x and z, as columns."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])


def _loaded_column(column: Column, standing: Vibrating, down: np.ndarray) -> Vibrating:
    """A column of the plane under its own weight: each joint carries what stands on it."""
    at, joints = space_geometry(column), []
    for j, joint in enumerate(standing.joints):
        load = space_load(column, at, j)
        frame = at.frame[j]
        place = at.origin[j] + frame[:, :2] @ load.place
        along = np.array([joint.frame[:, 0] @ (point - joint.middle) for point in joint.points])
        ends = np.array([joint.frame[:, 0] @ (point - joint.middle) for point in joint.edge])
        where = np.array([float(joint.frame[:, 0] @ (place - joint.middle)), 0.0])
        flat = (np.column_stack((coordinates, np.zeros(len(coordinates)))) for coordinates in (along, ends))
        points, edge = flat
        closure = pressed(points, joint.springs, edge, load.normal, where)
        _refuse_open(column, j, closure, edge, where, "plane")
        friction = column.friction[j] * load.normal + column.joint_laws[j].cohesion * joint.area
        force = frame @ np.array([*(-load.shear), load.normal])
        joints.append(replace(joint, force=force, place=place, closure=closure, friction=friction))
    last = column.drums[-1]
    up = at.axes[-1][:, 2]
    top = at.centroid[-1] + (last.height - last.centroid_height) * up
    names = ("base", *(f"drum {i}" for i in range(1, column.n + 1)))
    return replace(standing, names=names, joints=tuple(joints), top=top, top_body=column.n)


# -- assemblies --------------------------------------------------------------------------------------------------------


def _between(structure: Structure, lower: int, upper: int) -> str:
    """The joint of two bodies in words."""
    return say("{lower} – {upper}", lower=structure.bodies[lower].name, upper=structure.bodies[upper].name)


def _assembly_in_space(structure: Structure) -> Vibrating:
    bodies: Any = structure.bodies
    ground = [getattr(body, "pieces", None) is None for body in bodies]
    centroids = np.array(
        [(0.0, 0.0, 0.0) if flat else body.position for flat, body in zip(ground, bodies, strict=True)]
    )
    axes = np.array([np.eye(3) if flat else body.axes for flat, body in zip(ground, bodies, strict=True)])
    free = np.array([not body.fixed for body in bodies])
    tensors = np.array(
        [np.zeros((3, 3)) if not movable else body.inertia_tensor for movable, body in zip(free, bodies, strict=True)]
    )
    inertias = np.einsum("nab,nbc,ndc->nad", axes, tensors, axes)
    joints = []
    for joint in structure.space_joints or ():
        law, frame, origin = joint.law, joint.frame, joint.origin
        # corners on arcs lie within them: as wide as the whole area, their edge has the squares of places of the arcs
        edge = joint.corners * math.sqrt(joint.area / abs(_area(joint.corners)))
        points, weights = edge_points(edge)
        springs = law.normal_stiffness * joint.area * weights / weights.sum()
        middle = weights @ points / weights.sum()
        spread = float(weights @ ((points - middle) ** 2).sum(axis=1) / weights.sum())
        joints.append(
            ClosedJoint(
                name=_between(structure, joint.lower, joint.upper),
                lower=joint.lower,
                upper=joint.upper,
                frame=frame,
                points=origin + points @ frame[:, :2].T,
                springs=springs,
                edge=origin + edge @ frame[:, :2].T,
                shear=law.shear_stiffness * joint.area,
                torsion=0.5 * law.shear_stiffness * joint.area * spread,
                middle=origin + frame[:, :2] @ middle,
                force=np.zeros(3),
                place=origin + frame[:, :2] @ middle,
                closure=np.zeros(len(edge)),
                follows_lower=0.5,
                friction=law.tan_phi,
                lever=DISC_LEVER * math.sqrt(spread),
                area=joint.area,
            )
        )
    springs, left_out = _springs(structure, centroids, axes)
    masses = np.array([body.mass if movable else 0.0 for movable, body in zip(free, bodies, strict=True)])
    names = tuple(body.name for body in bodies)
    standing = Vibrating(names, centroids, masses, inertias, free, tuple(joints), springs, left_out=left_out)
    return _at_rest(structure, standing, np.array([0.0, 0.0, -structure.gravity]), (0, 1, 2, 3, 4, 5))


def _at_rest(structure: Structure, standing: Vibrating, down: np.ndarray, each: tuple[int, ...]) -> Vibrating:
    """An assembly under its own weight: which points of its joints are pressed, by Newton's method without tension.

    Raises
    ------
    InputError
        No equilibrium is found, or a body is not held.
    """
    coordinates = (6 * np.flatnonzero(standing.free)[:, None] + np.array(each)).ravel()
    weight = np.zeros((len(standing.masses), 6))
    weight[:, :3] = standing.masses[:, None] * down
    load = weight.ravel()[coordinates]
    for spring in standing.springs:
        if spring.tension:
            raise InputError(
                f"modes of assemblies know no pretension, and {spring.name!r} of {structure.name!r} is "
                f"pretensioned; leave its "
                "pretension out."
            )
    _refuse_loose(structure, standing, standing.joints)
    q = _balanced(structure, standing, coordinates, load)
    depths = [_depths(standing, joint, joint.points, q.reshape(-1, 6)) for joint in standing.joints]
    least = BARELY * max((float(depth.max()) for depth in depths), default=0.0)
    pressing = [depth > least for depth in depths]
    joints, notes = [], []
    shape = q.reshape(-1, 6)
    for joint, touch, depth in zip(standing.joints, pressing, depths, strict=True):
        if not touch.any():
            notes.append(say("the joint {joint} is not pressed at rest and counts as open", joint=joint.name))
            continue
        if not touch.all():
            notes.append(say("the joint {joint} is pressed on a part of its edge alone at rest", joint=joint.name))
        part = _part(joint, touch)
        force = joint.springs * np.maximum(depth, 0.0)
        normal = float(force.sum())
        slip = _passing(standing, part, part.middle, shape)
        shear = -part.shear * (part.frame[:, :2].T @ slip)
        place = force @ joint.points / normal
        closure = _depths(standing, joint, joint.edge, shape)
        closed = closure[closure > 0.0]
        law = joint.friction * normal
        if float(np.hypot(*shear)) > law:
            words = say("the joint {joint} would slide at rest if its stones were as stiff as its springs alone")
            notes.append(words.of(joint=joint.name))
        joints.append(
            replace(
                part,
                force=part.frame @ np.array([*shear, normal]),
                place=place,
                friction=law,
                edge=joint.edge[closure > 0.0] if len(closed) else joint.edge,
                closure=closed if len(closed) else closure,
            )
        )
    _refuse_loose(structure, standing, joints)
    return replace(standing, joints=tuple(joints), left_out=(*standing.left_out, *notes))


def _refuse_loose(structure: Structure, standing: Vibrating, joints: Sequence[ClosedJoint]) -> None:
    """Refuse a body that can move and has none of these joints."""
    connected = {joint.upper for joint in joints} | {joint.lower for joint in joints}
    loose = next((i for i in np.flatnonzero(standing.free) if i not in connected), None)
    if loose is not None:
        raise InputError(
            f"block {standing.names[loose]!r} of {structure.name!r} rests on no closed joint, and what is loose has no "
            "natural frequency; rest it on another stone, or leave it out."
        )


def _balanced(structure: Structure, standing: Vibrating, coordinates: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Displacements under the weight of what stands on springs that do not pull, shape (6 N,).

    The energy of such springs is convex, and Newton's method with a search along its step finds the one minimum.
    Joints that are not pressed there hold no slip either: they are left out, and it is looked for again.
    """
    size = 6 * len(standing.masses)
    at = [np.concatenate((6 * joint.upper + np.arange(6), 6 * joint.lower + np.arange(6))) for joint in standing.joints]
    rows = [standing._rises(joint, joint.points) for joint in standing.joints]
    kept, q = [True] * len(rows), np.zeros(size)
    square = np.ix_(coordinates, coordinates)
    for _ in range(ROUNDS):
        slips = np.zeros((size, size))
        for joint, own, keep in zip(standing.joints, at, kept, strict=True):
            if keep:
                slips[np.ix_(own, own)] += standing.joint_matrix(replace(joint, springs=0.0 * joint.springs))
        for spring in standing.springs:
            own = np.concatenate((6 * spring.bodies[1] + np.arange(6), 6 * spring.bodies[0] + np.arange(6)))
            slips[np.ix_(own, own)] += standing.spring_matrix(spring)

        def energy(now: np.ndarray, slips: np.ndarray = slips) -> float:
            total = 0.5 * float(now @ slips @ now) - float(now[coordinates] @ load)
            for joint, own, row in zip(standing.joints, at, rows, strict=True):
                total += 0.5 * float(joint.springs @ np.maximum(-row @ now[own], 0.0) ** 2)
            return total

        for _ in range(ROUNDS):
            force, matrix = slips @ q, slips.copy()
            for joint, own, row in zip(standing.joints, at, rows, strict=True):
                depth = -row @ q[own]
                force[own] -= row.T @ (joint.springs * np.maximum(depth, 0.0))
                touching = joint.springs * ((depth > 0.0) if q.any() else 1.0)
                matrix[np.ix_(own, own)] += row.T @ (touching[:, None] * row)
            missing = load - force[coordinates]
            if float(np.abs(missing).max()) < 1e-9 * float(np.abs(load).max()):
                break
            inner = matrix[square]
            soft = LOOSE * float(np.diag(inner).max()) * np.eye(len(coordinates))
            step, share, before = np.zeros(size), 1.0, energy(q)
            step[coordinates] = np.linalg.solve(inner + soft, missing)
            gain = float(step[coordinates] @ missing)
            while energy(q + share * step) > before - 1e-4 * share * gain and share > 1e-6:
                share *= 0.5
            q = q + share * step
        else:
            raise InputError(
                f"{structure.name!r} finds no equilibrium on closed joints; rest its stones on one another so that each is "
                "carried within its faces."
            )
        pressed_now = [bool((row @ q[own] < 0.0).any()) for own, row in zip(at, rows, strict=True)]
        if all(now or not before for now, before in zip(pressed_now, kept, strict=True)):
            return q
        kept = [now and before for now, before in zip(pressed_now, kept, strict=True)]
    return q


def _part(joint: ClosedJoint, touch: np.ndarray) -> ClosedJoint:
    """What of a joint touches; all its stiffness is of that."""
    if touch.all():
        return joint
    if not touch.any():
        return replace(joint, springs=0.0 * joint.springs, shear=0.0, torsion=0.0)
    share = float(joint.springs[touch].sum() / joint.springs.sum())
    middle = joint.springs[touch] @ joint.points[touch] / joint.springs[touch].sum()
    whole = float(joint.springs @ ((joint.points - joint.middle) ** 2).sum(axis=1))
    touching = float(joint.springs[touch] @ ((joint.points[touch] - middle) ** 2).sum(axis=1))
    return replace(
        joint,
        points=joint.points[touch],
        springs=joint.springs[touch],
        shear=share * joint.shear,
        middle=middle,
        torsion=joint.torsion * touching / max(whole, 1e-300),
    )


def _passing(standing: Vibrating, joint: ClosedJoint, point: np.ndarray, shape: np.ndarray) -> np.ndarray:
    own, other = shape[joint.upper], shape[joint.lower]
    return (
        own[:3]
        + np.cross(own[3:], point - standing.centroids[joint.upper])
        - other[:3]
        - np.cross(other[3:], point - standing.centroids[joint.lower])
    )


def _depths(standing: Vibrating, joint: ClosedJoint, points: np.ndarray, shape: np.ndarray) -> np.ndarray:
    """How deep points of a joint are pressed [m]."""
    return -np.array([_passing(standing, joint, point, shape) @ joint.normal for point in points])


# -- links -------------------------------------------------------------------------------------------------------------


def _springs(
    structure: Structure, centroids: np.ndarray, axes: np.ndarray
) -> tuple[tuple[Spring, ...], tuple[str, ...]]:
    """Links as springs about rest, and which of them do not act in small vibrations."""
    springs, left_out = [], []
    for link in acting(structure):
        places = [
            centroids[body] + axes[body] @ arm for body, arm in zip((link.lower, link.upper), link.arms, strict=True)
        ]
        ways: list[np.ndarray] = []
        stiffness: list[float] = []
        axis = np.array(link.frame[2])
        if link.straight:
            axis = (places[1] - places[0]) / np.linalg.norm(places[1] - places[0])
        elif link.shear_stiffness and not link.clearance:
            ways += [np.array(link.frame[0]), np.array(link.frame[1])]
            stiffness += [link.shear_stiffness] * 2
        both = link.lies == "side" and not link.clearance
        if link.axial_stiffness and (link.pretension or both):
            ways.append(axis)
            stiffness.append(link.axial_stiffness)
        if link.shear_stiffness and not link.straight and link.clearance:
            words = say("{link}: its clearance of {gap:g} mm lets small slips pass")
            left_out.append(words.of(link=link.name, gap=1000.0 * link.clearance))
        if link.axial_stiffness and not (link.pretension or both):
            words = say("{link}: without pretension it does not pull while its joints are closed")
            left_out.append(words.of(link=link.name))
        if ways:
            ends = (places[0], places[1]) if link.straight else (0.5 * (places[0] + places[1]),) * 2
            springs.append(
                Spring(
                    link.name,
                    (link.lower, link.upper),
                    ends,
                    np.array(ways),
                    np.array(stiffness),
                    link.pretension,
                    axis,
                )
            )
    return tuple(springs), tuple(left_out)
