"""Models of 3DEC: its data files of polyhedra, read command by command; one that is not known is refused by its line."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from stylobate.column.spatial.stone import LARGEST, MeshPart, check_closed
from stylobate.errors import InputError
from stylobate.text_tables import printable, read_bytes

#: What is read, in the words of messages.
COMMANDS = (
    "poly [region N] prism a (…) b (…), poly [region N] face (…) face (…), range name, property material density, property "
    "jmat, change material range, fix range, gravity"
)

#: Properties of joints that are read, by the names of a file here; others have to be 0.
JOINTS = {
    "jkn": "normal_stiffness",
    "jks": "shear_stiffness",
    "jfriction": "friction_angle",
    "jcohesion": "cohesion",
}

#: Corners nearer than this in faces of one polyhedron are one [m].
SAME = 1e-6


class Polyhedron(NamedTuple):
    """A block: its surface [m], its region, and the middle of its corners, by which ranges know it."""

    part: MeshPart
    region: int | None
    middle: np.ndarray


class Model(NamedTuple):
    """What a file holds: parts with whether they are fixed and their densities [kg/m³], and what it says of the whole."""

    parts: list[tuple[MeshPart, bool, float | None]]
    stated: dict[str, Any]


class _Unknown(Exception):
    """A command, or a word of one, that is not known."""


Range = Callable[[Polyhedron], bool]


def read_three_dec(path: Path) -> Model:
    """The polyhedra of a file, which of them are fixed, and their densities; the joint of all, and gravity.

    Raises
    ------
    InputError
        A command that is not known, by its line; a range or a material without definition; no polyhedra.
    """
    where = printable(path)
    blocks: list[Polyhedron] = []
    ranges: dict[str, Range] = {}
    regions: dict[int, str] = {}
    densities: dict[str, float] = {}
    materials: dict[int, str] = {}
    fixed: set[int] = set()
    stated: dict[str, Any] = {}

    def chosen(words: list[str]) -> list[int]:
        test = _range(words, ranges)
        return [i for i, block in enumerate(blocks) if test(block)]

    for line, command in _commands(path):
        try:
            match command.lower().split():
                case [word, *_] if word in ("poly", "polyhedron"):
                    blocks.append(_polyhedron(command, line))
                case ["range", "name", name, *words]:
                    ranges[name] = _range(words, ranges)
                    if words[:1] == ["region"] and len(words) == 2:
                        regions[int(words[1])] = command.split()[2]
                case [word, kind, number, "density", value] if word in PROPERTY and kind in MATERIAL:
                    densities[number] = float(value)
                case [word, "jmat", _, *pairs] if word in PROPERTY and "joint" not in stated and len(pairs) % 2 == 0:
                    stated["joint"] = _joint(pairs)
                case ["change", kind, number, "range", *words] if kind in MATERIAL:
                    materials |= dict.fromkeys(chosen(words), number)
                case ["fix", "range", *words]:
                    fixed |= set(chosen(words))
                case ["gravity", x, y, z] if float(x) == float(y) == 0.0 and float(z) <= 0.0:
                    stated["gravity"] = -float(z)
                case _:
                    raise _Unknown
        except (ValueError, KeyError, _Unknown) as error:
            what = f", for {error} is not defined before it" if isinstance(error, KeyError) else ""
            raise InputError(
                f"line {line} of {where} is {command[:60]!r}, which is not read{what}; known are {COMMANDS}: leave it out, "
                "or write the polyhedra as closed meshes, in OBJ for one."
            ) from None
    if not blocks:
        raise InputError(f"{where} holds no polyhedra; give a data file of 3DEC with poly commands.")
    parts, counts = [], {}
    for i, block in enumerate(blocks):
        called = "block" if block.region is None else regions.get(block.region, f"region {block.region}")
        counts[called] = counts.get(called, 0) + 1
        number = materials.get(i, "1")  # that of blocks that no change names
        if number not in densities and i not in fixed:
            raise InputError(
                f"{where} gives no density of material {number}, of which {called} is; add a property line."
            )
        name = f"{called} {counts[called]}"
        check_closed(block.part, f"{name} of {where}")
        parts.append((replace(block.part, name=name), i in fixed, densities.get(number)))
    return Model(parts, stated)


#: Words of one meaning.
PROPERTY, MATERIAL = ("prop", "property"), ("mat", "material")


def _commands(path: Path) -> Iterator[tuple[int, str]]:
    """Commands and the numbers of their first lines; ``;`` begins a comment and ``&`` goes on in the next line."""
    text, first, whole = read_bytes(path, LARGEST).decode("utf-8", "replace"), 0, ""
    for number, line in enumerate(text.splitlines(), 1):
        words = line.partition(";")[0].strip()
        first = first if whole else number
        whole = f"{whole} {words.removesuffix('&')}".strip()
        if whole and not words.endswith("&"):
            yield first, whole
            whole = ""
    if whole:
        yield first, whole


def _polyhedron(command: str, line: int) -> Polyhedron:
    match = re.fullmatch(r"\w+(?:\s+region\s+(\d+))?\s+(prism|face)\b(.*)", command, re.IGNORECASE | re.DOTALL)
    if match is None:
        raise _Unknown
    region, kind, rest = match.groups()
    loops = [_points(loop) for loop in re.split(r"\bface\b|\b[ab]\b", rest, flags=re.IGNORECASE) if loop.strip()]
    if kind.lower() == "prism":
        lower, upper = loops
        n = len(lower)
        if len(upper) != n or n < 3:
            raise _Unknown
        sides = [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
        points = np.concatenate((lower, upper))
        faces = (tuple(range(n - 1, -1, -1)), tuple(range(n, 2 * n)), *sides)
    else:
        every = np.concatenate(loops)
        apart = np.linalg.norm(every[:, None] - every[None], axis=2) > SAME
        own = (~apart).argmax(axis=1)
        used, numbers = np.unique(own, return_inverse=True)
        points, ends = every[used], np.cumsum([len(loop) for loop in loops])
        faces = tuple(tuple(part.tolist()) for part in np.split(numbers, ends[:-1]))
    middle = points.mean(axis=0)
    centre = np.array([points[list(face)].mean(axis=0) for face in faces]) - middle
    areas = [np.cross(points[list(face)], points[[*face[1:], face[0]]]).sum(axis=0) for face in faces]
    if float((centre * areas).sum()) < 0.0:  # either sense around is allowed there
        faces = tuple(face[::-1] for face in faces)
    part = MeshPart("", points, faces, (line,) * len(faces))
    return Polyhedron(part, None if region is None else int(region), middle)


def _points(text: str) -> np.ndarray:
    points = re.findall(r"\(([^()]*)\)", text)
    if re.sub(r"\([^()]*\)", "", text).strip():
        raise _Unknown
    return np.array([[float(number) for number in point.replace(",", " ").split()] for point in points]).reshape(-1, 3)


def _range(words: list[str], ranges: dict[str, Range]) -> Range:
    """The blocks that all parts of a range name, or with ``union`` one of them."""
    union, rest, tests = words[:1] == ["union"], list(words), []
    rest = rest[1:] if union else rest
    while rest:
        match rest:
            case ["region", number, *rest]:
                tests.append(lambda block, number=int(number): block.region == number)
            case ["nrange", *names]:
                tests += [ranges[name] for name in names]
                rest = []
            case [("x" | "y" | "z") as axis, low, high, *rest]:
                bounds = "xyz".index(axis), float(low), float(high)
                tests.append(lambda block, bounds=bounds: bounds[1] <= block.middle[bounds[0]] <= bounds[2])
            case _:
                raise _Unknown
    if not tests:
        raise _Unknown
    return lambda block: (any if union else all)(test(block) for test in tests)


def _joint(pairs: list[str]) -> dict[str, float]:
    values = {name: float(value) for name, value in zip(pairs[::2], pairs[1::2], strict=True)}
    if any(value for name, value in values.items() if name not in JOINTS) or not {"jkn", "jks", "jfriction"} <= set(
        values
    ):
        raise _Unknown
    return {JOINTS[name]: value for name, value in values.items() if name in JOINTS}
