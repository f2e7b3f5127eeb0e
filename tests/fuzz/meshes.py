"""Meshes of drums, whole and damaged: each becomes a stone of the same mass and stability, or is refused in one sentence."""

from __future__ import annotations

import math
import random
import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
import trimesh

from stylobate.column.shapes import CircularFrustum, Mesh, cut
from stylobate.errors import InputError
from stylobate_exchange.compas_files import compas_json
from stylobate_exchange.convert import Reading, read_model
from stylobate_exchange.mesh_writers import TEXTS, Glb, Named

from .target import Fault, Target, sentence

#: Endings of files, and the metres of their units.
ENDINGS, UNITS = (".obj", ".ply", ".stl", ".glb", ".json"), {"m": 1.0, "cm": 0.01, "mm": 0.001}


class Drum(NamedTuple):
    """A drum as it is drawn: its mesh [m], how deep its damage is, what lies between its corners, and its noise [m]."""

    mesh: Mesh
    damage: float
    flat: float
    noise: float


def drum(rng: random.Random) -> Drum:
    """A drum of rings of corners, upright on the origin."""
    sides, rows = rng.choice((8, 12, 16, 20, 24, 32, 48, 64, 72)), rng.choice((1, 1, 1, 2, 6))
    bottom, height = rng.uniform(0.3, 1.0), rng.uniform(0.3, 1.5)
    top = bottom * rng.choice((1.0, 1.0, rng.uniform(0.8, 1.0)))
    first = rng.uniform(0.0, 2.0 * math.pi)
    angle = first + np.arange(sides) * 2.0 * math.pi / sides
    ring = np.column_stack((np.cos(angle), np.sin(angle)))
    flat, damage = bottom * (1.0 - math.cos(math.pi / sides)), 0.0
    kind = rng.choice(("whole", "whole", "chip", "corners", "flutes"))
    if kind == "chip":  # a plane cuts it off, between corners of its own
        deep = rng.uniform(0.002, 0.1)
        way = rng.uniform(0.0, 2.0 * math.pi)
        ring = cut(ring, np.array([math.cos(way), math.sin(way)]), 1.0 - deep)
        damage = max(0.0, bottom * deep - flat)
    elif kind == "corners":  # corners in it are moved onto it
        deep, way = rng.uniform(0.002, 0.1), np.array([math.cos(first), math.sin(first)])
        over = np.maximum(ring @ way - 1.0 + deep, 0.0)
        ring = ring - over[:, None] * way
        damage = bottom * deep
    elif kind == "flutes":
        deep = rng.uniform(0.005, 0.05)
        ring = ring * np.where(np.arange(sides) % 2, 1.0 - deep, 1.0)[:, None]
        damage = 0.5 * bottom * deep
    levels = np.linspace(0.0, 1.0, rows + 1)
    points = [np.column_stack(((bottom + (top - bottom) * z) * ring, np.full(len(ring), height * z))) for z in levels]
    vertices, n = np.concatenate(points), len(ring)
    noise = rng.choice((0.0, 0.0, rng.uniform(0.0, 0.004)))
    vertices = vertices + noise * np.array([rng.uniform(-1.0, 1.0) for _ in range(vertices.size)]).reshape(-1, 3)
    faces: list[tuple[int, ...]] = [tuple(range(n - 1, -1, -1)), tuple(range(rows * n, (rows + 1) * n))]
    for row in range(rows):
        for i in range(n):
            k = (i + 1) % n
            faces.append((row * n + i, row * n + k, (row + 1) * n + k, (row + 1) * n + i))
    if rng.random() < 0.5 or kind == "flutes" or noise:
        vertices, faces = fans(vertices, faces)
    return Drum(Mesh(vertices, tuple(faces)), damage, flat, noise)


def fans(vertices: np.ndarray, faces: list[tuple[int, ...]]) -> tuple[np.ndarray, list[tuple[int, ...]]]:
    """Faces in triangles around their middles, which become vertices: ends of any outline, sides out of plane."""
    middles = np.array([vertices[list(face)].mean(axis=0) for face in faces])
    n = len(vertices)
    triangles = [(a, b, n + k) for k, face in enumerate(faces) for a, b in zip(face, (*face[1:], face[0]), strict=True)]
    return np.concatenate((vertices, middles)), triangles


def place(mesh: Mesh, turn: np.ndarray, shift: np.ndarray) -> Mesh:
    """A mesh that is turned and moved."""
    return Mesh(mesh.vertices @ turn.T + shift, mesh.faces)


def written(path: Path, surfaces: list[tuple[str, Mesh]], factor: float, up: str) -> None:
    """A file of surfaces [m] in a unit, in the axes that it has."""
    if path.suffix == ".json":
        path.write_text(compas_json("scene", [(name, mesh, False, 0.0) for name, mesh in surfaces]))
        return
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]) if up == "y" else np.eye(3)
    if path.suffix == ".glb":
        file = Glb("scene")
        for name, mesh in surfaces:
            middle = mesh.vertices.mean(axis=0)
            moved = Mesh((mesh.vertices - middle) / factor, mesh.faces)
            file.add(Named(name, moved), (middle / factor).tolist())
        path.write_bytes(file.content())
        return
    path.write_text(TEXTS[path.suffix]([Named(n, Mesh(m.vertices @ turn.T / factor, m.faces)) for n, m in surfaces]))


def reach(points: np.ndarray, ways: np.ndarray) -> np.ndarray:
    """How far points reach in directions [m]."""
    return (points @ ways.T).max(axis=0)


def attempt(rng: random.Random, folder: Path) -> str:
    """A stack of drums in a file, and what is read from it: volume, extents, kinds, or a refusal that helps."""
    column = rng.random() < 0.3
    drums = [drum(rng) for _ in range(rng.choice((1, 1, 2, 3)))]
    rounded = rng.choice((12, 12, 6, 4))
    lean = rng.choice((0.0, 0.0, 0.0, rng.uniform(0.0, 0.1))) if len(drums) == 1 else 0.0
    gap = rng.choice((0.0, rng.uniform(-0.0005, 0.0005)))
    where = np.array([rng.choice((0.0, rng.uniform(-50.0, 50.0), rng.uniform(4e5, 5e6))) for _ in "xy"] + [0.0])
    ending, unit, up = rng.choice(ENDINGS), rng.choice(tuple(UNITS)), rng.choice("yz")
    up, unit = ("y" if ending == ".glb" else "z" if ending == ".json" else up), ("m" if ending == ".json" else unit)
    surfaces, level, turn = [], 0.0, np.array(trimesh.transformations.rotation_matrix(lean, [1.0, 0.0, 0.0]))[:3, :3]
    for number, each in enumerate(drums, 1):
        mesh = place(each.mesh, turn, where + np.array([0.0, 0.0, level]))
        mesh = Mesh(np.round(mesh.vertices / UNITS[unit], rounded) * UNITS[unit], mesh.faces)
        level += float(each.mesh.vertices[:, 2].max()) + gap
        surfaces.append((f"drum {number}", mesh))
    path = folder / f"a{ending}"
    written(path, surfaces, UNITS[unit], up)
    tolerance = rng.choice((0.001, 0.001, 0.003, 0.01))
    reading = Reading("marble", "column" if column else "assembly", unit, tolerance, up=up)
    try:
        structure, _, words = read_model(path, reading)
    except InputError as error:
        text = sentence(error)
        advice = re.search(r"`tolerance=([0-9.e-]+)`", text)
        if advice is None:
            return "refused: " + re.sub(r"[\d.]+|'[^']*'|/\S+:", "", text)[:50]
        try:
            again = Reading("marble", reading.becomes, unit, float(advice[1]), up=up)
            read_model(path, again)
        except InputError as second:
            if "`tolerance=" not in str(second):  # of another stone of the file
                raise Fault(f"advice {advice[1]} m of {text!r} leads to {second}") from None
        return "refused, with an advice that works"
    bodies = [body for body in structure.bodies if not body.fixed or body.size < 1e3]
    if len(bodies) != len(drums):
        raise Fault(f"{len(bodies)} bodies of {len(drums)} drums")
    ways = np.array([[rng.gauss(0.0, 1.0) for _ in "xyz"] for _ in range(40)])
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    bodies.sort(key=lambda body: float(body.placed[0].place[2]))
    apart = []
    for body, each, (_, mesh) in zip(bodies, drums, surfaces, strict=True):
        (part,) = body.placed
        flat, noise = each.flat, 3.0 * each.noise + UNITS[unit] * 10.0**-rounded
        if isinstance(part.shape, CircularFrustum) and each.damage > 1.5 * tolerance + flat + noise:
            raise Fault(f"damage of {each.damage} m is gone at a tolerance of {tolerance} m: {words}")
        (made, at), (drawn, there) = solid(part.mesh(720)), solid(mesh)
        allowed = 2.0 * tolerance + flat + noise
        off = np.abs(reach(made.vertices, ways) - reach(drawn.vertices, ways))
        if off.max() > allowed:
            raise Fault(f"a stone reaches {off.max()} m from where it is drawn to, allowed are {allowed} m: {words}")
        if abs(made.volume - drawn.volume) > (tolerance + flat) * drawn.area:
            raise Fault(f"a stone of {drawn.volume} m³ became one of {made.volume} m³: {words}")
        apart.append(at - there)
    if np.ptp(apart, axis=0).max() > 4.0 * tolerance + 2.0 * max(each.noise for each in drums):
        raise Fault(f"stones were moved to one another: {apart}, {words}")
    kinds = {type(body.placed[0].shape).__name__ for body in bodies}
    return f"read as {'column' if column else 'assembly'} of {' and '.join(sorted(kinds))}"


def solid(mesh: Mesh) -> tuple[trimesh.Trimesh, np.ndarray]:
    """A surface around its centroid for trimesh, which counts its volume in a second way, and where that is [m]."""
    middle = mesh.vertices.mean(axis=0)
    vertices, faces = fans(mesh.vertices - middle, list(mesh.faces))
    surface = trimesh.Trimesh(vertices, faces, process=False)
    centroid = np.array(surface.center_mass)
    surface.apply_translation(-centroid)
    return surface, middle + centroid


TARGET = Target("meshes", 2000, 20, attempt, limit=60.0)
