"""Meshes of drums, whole and damaged: each becomes a stone of the same mass and stability, or is refused in one sentence."""

from __future__ import annotations

import math
import random
import re
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import trimesh

from stylobate.column.shapes import CircularFrustum, cut
from stylobate.errors import InputError
from stylobate.exchange.compas_files import compas_json
from stylobate.exchange.convert import Reading, read_model
from stylobate.exchange.mesh_writers import TEXTS, Glb, Named
from stylobate.column.shapes import Mesh

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
    if rng.random() < 0.5 or kind == "flutes":
        faces = fans(vertices, faces, n)
    return Drum(Mesh(vertices, tuple(faces)), damage, flat, noise)
