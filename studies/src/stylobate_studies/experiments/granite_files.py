"""Shaking-table tests of boulders as files: specimens, motions, outcomes; what cannot be used is said and left out."""

from __future__ import annotations

import json
import math
import zipfile
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.column.joint import Joint
from stylobate.column.specimen import Specimen
from stylobate.constants import g
from stylobate.errors import InputError

from . import choices as c
from .measured_files import csv_rows

#: The two specimens, and another scan of the first.
NAMES, OTHER_SCAN = ("SP1", "SP2"), "SP1_alternative_mesh"

#: A peak that is farther from that of the sheet than this factor is in another unit.
SAME_UNIT = 1.2


@dataclass(frozen=True, eq=False)
class Scan:
    """A specimen as scanned: mass [kg], inertia about the centroid [kg m²], vertices and centroid, z up [m].

    The centroid is the origin, but for a scan in the frame of another one.
    """

    name: str
    mass: float
    inertia: np.ndarray
    vertices: np.ndarray
    centroid: np.ndarray = field(default_factory=lambda: np.zeros(3))

    def specimen(
        self, friction: float = c.FRICTION, restitution: float = c.RESTITUTION, like: Specimen | None = None
    ) -> Specimen:
        """The body on the table; its vertices as stiff as those of another one, if given, that stands on as many."""
        joint = Joint(c.STIFFNESS, 0.5 * c.STIFFNESS, friction_coefficient=friction)
        body = Specimen(self.mass, self.inertia, self.vertices - self.centroid, self.name, joint, restitution)
        if like is None:
            return body
        kn = like.joint.normal_stiffness * like.resting.area / body.resting.area
        return replace(body, joint=Joint(kn, 0.5 * kn, friction_coefficient=friction))


@dataclass(frozen=True, eq=False)
class Test:
    """One motion of the table [m/s²] and what it did."""

    number: int
    record: str
    dt: float
    acceleration: np.ndarray
    toppled: dict[str, bool]
    logit: dict[str, float]
    facts: dict[str, float]


@dataclass
class Granite:
    """Usable and refused parts of a folder."""

    scans: dict[str, Scan] = field(default_factory=dict)
    tests: list[Test] = field(default_factory=list)
    refused: list[str] = field(default_factory=list)
    without_motion: int = 0


def read_granite(folder: Path) -> Granite:
    """Read ``specimens.json``, ``motions.npz`` and ``tests.csv`` of a folder.

    Raises
    ------
    InputError
        A file is missing or is no such file. Single specimens and tests that cannot be used are refused in the result.
    """
    granite = Granite()
    specimens = _json(folder / "specimens.json")
    mass = None
    for name in (*NAMES, OTHER_SCAN):
        if name not in specimens:
            granite.refused += [f"specimen {name} is not in specimens.json"] * (name in NAMES)
            continue
        specimen = specimens[name]
        mass = specimen.get("mass_kg", mass) if isinstance(specimen, dict) else None
        try:
            granite.scans[name] = _scan(name, specimen, mass)
        except InputError as error:
            granite.refused.append(str(error).rstrip("."))
    _read_tests(folder, granite)
    return granite


def _scan(name: str, specimen: Any, mass: Any) -> Scan:
    missing = [
        key
        for key in ("inertia_about_com_kg_m2", "com_height_at_rest_m", "hull_vertices_m")
        if not isinstance(specimen, dict) or key not in specimen
    ]
    if missing or mass is None:
        raise InputError(f"specimen {name} has no {(missing or ['mass_kg'])[0]} in specimens.json and is left out")
    try:
        vertices = np.array(specimen["hull_vertices_m"], dtype=float) - (
            0.0,
            0.0,
            float(specimen["com_height_at_rest_m"]),
        )
        scan = Scan(name, float(mass), np.array(specimen["inertia_about_com_kg_m2"], dtype=float), vertices)
    except (TypeError, ValueError):
        raise InputError(
            f"specimen {name} has no numbers where they should be in specimens.json and is left out"
        ) from None
    try:
        scan.specimen()
    except InputError as error:
        raise InputError(f"specimen {name} is left out: {error}") from None
    return scan


def _read_tests(folder: Path, granite: Granite) -> None:
    motions = arrays(folder / "motions.npz")
    dt = float(motions["dt"]) if "dt" in motions and np.ndim(motions["dt"]) == 0 else math.nan
    if not 0.0 < dt <= 0.1:
        raise InputError(f"{folder / 'motions.npz'} has no time step dt between 0 and 0.1 s; the tests cannot be used.")
    listed = set()
    for row in csv_rows(folder / "tests.csv"):
        try:
            number = int(row["id"])
        except (KeyError, TypeError, ValueError):
            granite.refused.append("a row of tests.csv has no number under id")
            continue
        listed.add(f"a{number:03d}")
        if f"a{number:03d}" not in motions:
            if row.get("motion") == "1":
                granite.refused.append(f"test {number} has no motion in motions.npz")
            granite.without_motion += 1
            continue
        try:
            granite.tests.append(_test(number, row, dt, np.asarray(motions[f"a{number:03d}"], dtype=float)))
        except InputError as error:
            granite.refused.append(str(error))
        except (KeyError, TypeError, ValueError):
            granite.refused.append(f"the row of test {number} in tests.csv lacks a number")
    unlisted = sorted(name for name in motions if name[:1] == "a" and name[1:].isdecimal() and name not in listed)
    granite.refused += [f"motion {name} has no row in tests.csv" for name in unlisted]


def _test(number: int, row: dict[str, str], dt: float, samples: np.ndarray) -> Test:
    facts = {
        key: float(row[key])
        for key in ("duration_s", "t_on_s", "t_off_s", "pga_g", "pga_10hz_g", "pgv_ms")
        if row.get(key) not in (None, "")
    }
    if samples.ndim != 1 or len(samples) < 10 or not np.isfinite(samples).all():
        raise InputError(f"the motion of test {number} is not a row of finite numbers")
    lasts, stated = (len(samples) - 1) * dt, facts.get("duration_s", math.nan)
    if abs(lasts - stated) > max(0.02 * stated, 2.0 * dt):
        raise InputError(
            f"the motion of test {number} lasts {lasts:.4g} s and its sheet says {stated:.4g} s: another time step"
        )
    peak, sheet = float(np.abs(samples).max()) / g, facts["pga_g"]
    if not sheet / SAME_UNIT <= peak <= sheet * SAME_UNIT:
        raise InputError(
            f"the motion of test {number} peaks at {peak:.3g} g if in m/s², and its sheet says {sheet:.3g} g: another unit"
        )
    first = max(0, int((facts["t_on_s"] - c.BEFORE) / dt))
    last = min(len(samples), int((facts["t_off_s"] + c.AFTER) / dt))
    toppled, logit = {}, {}
    for name in NAMES:
        toppled[name] = bool(_flag(number, row, f"toppled_{name.lower()}"))
        logit[name] = float(row.get(f"p_logit_{name.lower()}") or math.nan)
    return Test(number, row.get("record", ""), dt, samples[first:last], toppled, logit, facts)


def _flag(number: int, row: dict[str, str], key: str) -> int:
    if row.get(key) not in ("0", "1"):
        raise InputError(f"test {number} has {row.get(key)!r} as {key}; 0 or 1 is expected")
    return int(row[key])


def _json(path: Path) -> dict:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, json.JSONDecodeError) as error:
        raise InputError(f"{path} cannot be read ({error}).") from None
    if not isinstance(content, dict):
        raise InputError(f"{path} holds no table of specimens.")
    return content


def arrays(path: Path) -> dict[str, np.ndarray]:
    """Arrays of an npz file, without anything that is not a plain array."""
    try:
        with np.load(path, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise InputError(f"{path} cannot be read as a file of arrays ({error}).") from None
