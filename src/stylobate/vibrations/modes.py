"""Natural frequencies and shapes of what stands on closed joints: an eigenvalue problem about the state at rest."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from ..column.materials import STIFFEST_STONE
from ..column.structure import Structure
from ..errors import InputError, check_range, check_whole
from ..messages import joined, say
from ..notebook import NotebookSummary
from .closed_joints import vibrating
from .small_vibrations import Vibrating

#: Coordinates of a body that take part in bending in the plane of x and z, across it, in axial motion and in torsion.
ALONG, ACROSS, UPWARD, AROUND = (0, 4), (1, 3), (2,), (5,)

#: Kinds of modes.
KINDS = ("bending", "torsion", "axial")

#: Two groups of coordinates are apart where the stiffness that couples them is below this share of their own [-].
APART = 1e-9

#: Two planes of bending are alike to this [-].
ALIKE = 1e-9

#: Most modes of an assembly that are computed.
MOST = 60


@dataclass(frozen=True, eq=False)
class Mode:
    """One natural vibration.

    Parameters
    ----------
    kind : {"bending", "torsion", "axial"}
        How most of what moves moves: sideways, about the vertical, up and down.
    number : int
        Among those of its kind, and of its plane where a column has two, from 1.
    frequency : float
        [Hz]
    azimuth : float or None
        Where the top moves to, from x towards y [degrees], 0 up to 180; None of round columns, which bend alike in all
        directions, and of what does not bend.
    shape : array
        Displacement [m] and rotation [rad] of every body per unit motion of the top (sideways or upward [m], turned [rad]),
        shape (N, 6).
    standing : Vibrating
        What vibrates.
    """

    kind: str
    number: int
    frequency: float
    azimuth: float | None
    shape: np.ndarray
    standing: Vibrating

    @cached_property
    def joint_shares(self) -> np.ndarray:
        """Share of every joint in its elastic energy [-], shape (J,)."""
        return self.standing.shares(self.shape)

    @cached_property
    def _limit(self) -> tuple[float, int, str]:
        return self.standing.limit_of(self.shape)

    @property
    def holds_to(self) -> float:
        """Motion of the top at which the first joint opens or slides [m], of torsion [rad]."""
        return self._limit[0]

    @property
    def limited_by(self) -> str:
        """Which joint that is, and what it does."""
        size, joint, how = self._limit
        return "" if math.isinf(size) else say("{joint} {mode}", joint=self.standing.joints[joint].name, mode=say(how))

    def row(self, joints: tuple[str, ...]) -> dict[str, Any]:
        """Its entry in the JSON object of ``stylobate modes``."""
        most = int(self.joint_shares.argmax())
        return {
            "kind": self.kind,
            "number": self.number,
            "frequency_hz": self.frequency,
            "azimuth_deg": self.azimuth,
            "bent_joint": joints[most],
            "joint_shares": self.joint_shares.tolist(),
            ("holds_to_rad" if self.kind == "torsion" else "holds_to_m"): self.holds_to,
            "limited_by": self.limited_by,
        }


@dataclass(frozen=True, eq=False)
class Modes(NotebookSummary):
    """Result of :func:`modes`.

    Parameters
    ----------
    structure : Column, Assembly or SpatialAssembly
    model : str
        Its name, and law of round faces where it has several.
    modes : tuple of Mode
        Of each kind by rising frequency.
    standing : Vibrating
        Bodies, joints and links about rest.
    joint_bending_stiffness : array
        k_b/J_A of each joint of a column [N/m³], shape (n,); empty of assemblies.
    joint_normal_stiffness, joint_shear_stiffness : array
        k_n and k_s of each joint [N/m³].
    """

    structure: Structure
    model: str
    modes: tuple[Mode, ...]
    standing: Vibrating
    joint_bending_stiffness: np.ndarray
    joint_normal_stiffness: np.ndarray
    joint_shear_stiffness: np.ndarray

    def of(self, kind: str) -> tuple[Mode, ...]:
        """Those of a kind."""
        return tuple(mode for mode in self.modes if mode.kind == kind)

    def _frequencies(self, kind: str) -> np.ndarray:
        return np.array([mode.frequency for mode in self.of(kind)])

    @property
    def bending(self) -> np.ndarray:
        """Frequencies of bending [Hz], rising; of a round column as built each once, of others those of both planes."""
        return self._frequencies("bending")

    @property
    def torsion(self) -> np.ndarray:
        """Frequencies of torsion [Hz], rising."""
        return self._frequencies("torsion")

    @property
    def axial(self) -> np.ndarray:
        """Frequencies of axial motion [Hz], rising."""
        return self._frequencies("axial")

    @property
    def solid_modulus(self) -> np.ndarray:
        """Young's modulus of a solid column that bends as this one, drum by drum: k_b h/J_A [Pa], shape (n,).  # Eq. (M6)"""
        stack = self.structure.stack
        return np.zeros(0) if stack is None else self.joint_bending_stiffness * stack.heights

    @property
    def doubt(self) -> str:
        """What no stone is, in a sentence; empty where stone can be so."""
        most = float(self.solid_modulus.max(initial=0.0))
        if most <= STIFFEST_STONE:
            return ""
        return say(
            "{joint:capital} and the drum on it bend as solid stone of {modulus:.3g} GPa, stiffer than any stone: the drum "
            "alone is softer; a normal_stiffness up to {share:.2g} of it is what stone allows.",
            joint=self.joints[int(self.solid_modulus.argmax())],
            modulus=most / 1e9,
            share=STIFFEST_STONE / most,
        )

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the joints."""
        return tuple(joint.name for joint in self.standing.joints)

    @property
    def sentence(self) -> str:
        """The lowest frequency of each kind, in words."""
        first = [own[0] for kind in KINDS if (own := self.of(kind))]
        phrases = (say("{kind} {value:.4g} Hz", kind=say(mode.kind), value=mode.frequency) for mode in first)
        words = say("The lowest natural frequencies of “{name}” on closed joints: ", name=self.structure.name)
        return joined("", [words, joined(", ", phrases), "."])

    def summary(self, number: int | None = None) -> dict[str, Any]:
        """The JSON object of ``stylobate modes``, with so many of each kind."""
        rows = []
        for kind in KINDS:
            rows += [mode.row(self.joints) for mode in self.of(kind)[:number]]
        return {
            "name": self.structure.name,
            "model": self.model,
            "modes": rows,
            "joint_bending_stiffness": _plain(self.joint_bending_stiffness),
            "joint_normal_stiffness": _plain(self.joint_normal_stiffness),
            "joint_shear_stiffness": _plain(self.joint_shear_stiffness),
            "solid_modulus_pa": _plain(self.solid_modulus),
            "doubt": self.doubt,
            "sentence": self.sentence,
            "left_out": list(self.standing.left_out),
        }


def _plain(values: np.ndarray) -> Any:
    """A number where all are the same, none where there is none, else a list."""
    if not len(values):
        return None
    alike = bool(np.allclose(values, values[0], rtol=1e-9, atol=0.0))
    return float(values[0]) if alike else values.tolist()


def modes(column: Structure, model: Any) -> Modes:
    """Natural frequencies and shapes of a column or an assembly on closed joints, about rest.

    Parameters
    ----------
    column : Column, Assembly or SpatialAssembly
    model : DistinctElement2D or DistinctElement3D
        Where its joints carry.

    Raises
    ------
    InputError
        A joint of a column is open at rest, something is not held, or the joints are too soft for the weight on them.

    Notes
    -----
    Rigid bodies on the springs of their joints, with gravity's second order (P-delta); friction holds, nothing is damped.
    Eqs. (M1) to (M3). The engines, whose joints sink under the weight, have frequencies within 0.04 % of these.
    """
    standing = vibrating(column, model)
    stack = column.stack
    plane = model.is_plane(model.parameters()) and model.axes == "xz"
    all_modes = _of_column(standing, stack, plane) if stack is not None else _of_assembly(standing, plane)
    areas = np.array([joint.area for joint in standing.joints])
    normal = np.array([joint.springs.sum() for joint in standing.joints]) / areas
    shear = np.array([joint.shear for joint in standing.joints]) / areas
    bending = (
        np.array([joint.bending / joint.second_moment for joint in standing.joints]) if stack is not None else areas[:0]
    )
    called = model.name
    if stack is not None and stack.section == "circular" and not plane:
        called = f"{model.name}, law {model.acting(stack).law}"
    return Modes(column, called, tuple(all_modes), standing, bending, normal, shear)


def _of_column(standing: Vibrating, stack: Any, plane: bool) -> list[Mode]:
    """Modes of a column: its planes of bending, torsion and axial motion, each by itself where nothing couples them."""
    groups = {"along": ALONG, "across": ACROSS, "upward": UPWARD, "around": AROUND}
    if plane:
        in_plane = _kinds(standing, [(0, 2, 4)] if _coupled(standing, ALONG, UPWARD) else [ALONG, UPWARD], plane=True)
        return _numbered(
            [*in_plane, *(_kinds(standing, [AROUND]) if not stack.as_found and not standing.springs else [])]
        )
    if any(
        _coupled(standing, group, other) for group in groups.values() for other in groups.values() if group != other
    ):
        return _numbered(_kinds(standing, [(0, 1, 2, 3, 4, 5)]), pairs=stack.section == "circular")
    along, across = _kinds(standing, [ALONG]), _kinds(standing, [ACROSS])
    others = _kinds(standing, [UPWARD, AROUND])
    alike = all(
        math.isclose(mode.frequency, other.frequency, rel_tol=ALIKE) for mode, other in zip(along, across, strict=True)
    )
    if alike:
        return [*_numbered([replace(mode, azimuth=None) for mode in along]), *_numbered(others)]
    both = sorted([*_numbered(along), *_numbered(across)], key=lambda mode: mode.frequency)
    return [*both, *_numbered(others)]


def _of_assembly(standing: Vibrating, plane: bool) -> list[Mode]:
    return _numbered(_kinds(standing, [(0, 2, 4) if plane else (0, 1, 2, 3, 4, 5)], most=MOST, plane=plane))


def _coupled(standing: Vibrating, first: tuple[int, ...], other: tuple[int, ...]) -> bool:
    """Whether two groups of coordinates of each body act on one another."""
    free = np.flatnonzero(standing.free)[:, None] * 6
    a, b = ((free + np.array(group)).ravel() for group in (first, other))
    for matrix in (standing.stiffness_matrix, standing.mass_matrix):
        size = np.sqrt(np.outer(np.diag(matrix)[a], np.diag(matrix)[b]))
        if (np.abs(matrix[np.ix_(a, b)]) > APART * np.abs(size)).any():
            return True
    return False


def _kinds(
    standing: Vibrating, groups: list[tuple[int, ...]], *, most: int | None = None, plane: bool = False
) -> list[Mode]:
    """Modes of groups of coordinates of each body."""
    result = []
    for group in groups:
        coordinates = (6 * np.flatnonzero(standing.free)[:, None] + np.array(group)).ravel()
        frequencies, shapes = standing.solve(coordinates, most)
        result += [_mode(standing, float(f), shape, plane) for f, shape in zip(frequencies, shapes, strict=True)]
    return result


def _mode(standing: Vibrating, frequency: float, shape: np.ndarray, plane: bool) -> Mode:
    """A mode of its kind, scaled to a unit motion of the top."""
    spins = np.einsum("n,nc->nc", standing.masses, shape[:, :3] ** 2)
    turning = np.einsum("na,nab,nb->n", shape[:, 3:], standing.inertias, shape[:, 3:])
    around = standing.inertias[:, 2, 2] * shape[:, 5] ** 2
    energy = {
        "bending": float(spins[:, :2].sum() + turning.sum() - around.sum()),
        "axial": float(spins[:, 2].sum()),
        "torsion": 0.0 if plane else float(around.sum()),
    }
    kind = max(energy, key=lambda name: energy[name])
    top = standing.top_motion(shape)
    azimuth = None
    if kind == "bending":
        size = float(np.hypot(*top[:2]))
        sign = 1.0 if (top[0] > 0.0 if abs(top[0]) > 1e-9 * size else top[1] > 0.0) else -1.0
        azimuth = math.degrees(math.atan2(sign * top[1], sign * top[0])) % 180.0
        azimuth = 0.0 if 180.0 - azimuth < 1e-6 else azimuth
    else:
        size, sign = (abs(float(top[2])), math.copysign(1.0, top[2])) if kind == "axial" else (abs(float(top[5])), 1.0)
        sign = sign if kind == "axial" else math.copysign(1.0, top[5])
    if size < 1e-12 * float(np.abs(shape).max()):  # its top is a node
        size, sign = float(np.abs(shape).max()), 1.0
    return Mode(kind, 0, frequency, azimuth, sign / size * shape, standing)


def _numbered(unnumbered: list[Mode], *, pairs: bool = False) -> list[Mode]:
    """Modes with their numbers, each kind by rising frequency; bending in pairs of both planes where a column is round."""
    out = []
    for kind in KINDS:
        own = sorted((mode for mode in unnumbered if mode.kind == kind), key=lambda mode: mode.frequency)
        two = pairs and kind == "bending"
        out += [replace(mode, number=(i // 2 if two else i) + 1) for i, mode in enumerate(own)]
    return out


def frequency_drops(modes: Modes, left: float = 0.5, number: int = 3) -> list[dict[str, Any]]:
    """By how much the loss of stiffness of each joint lowers each mode, one joint at a time.

    Parameters
    ----------
    modes : Modes
    left : float
        Share of a joint's stiffness that is left, in bending, shear, torsion and closing alike [-].
    number : int
        How many modes of each kind.

    Returns
    -------
    list of dict
        For each joint ``joint``, and ``drops``: for each mode ``kind``, ``number`` and ``drop`` [-], negative.

    Raises
    ------
    InputError
        A value outside its range, or joints so soft that nothing stands on them.
    """
    check_range("left", left, 0.0, 1.0, open_low=True, open_high=True, remedy="0.5 is half of its stiffness")
    check_whole("number", number, 1)
    rows = []
    for j, joint in enumerate(modes.standing.joints):
        soft = [other if i != j else joint.softened(left) for i, other in enumerate(modes.standing.joints)]
        standing = modes.standing.with_joints(soft)
        try:
            changed = _modes_of(modes, standing)
        except InputError as error:
            raise InputError(
                f"with {left:g} of its stiffness left, {joint.name} no longer carries what stands on it; give a "
                f"larger share.",
                "left",
            ) from error
        drop = {mode: other.frequency / mode.frequency - 1.0 for mode, other in _followed(modes, changed)}
        listed = [mode for kind in KINDS for mode in modes.of(kind)[:number]]
        drops = [
            {"kind": mode.kind, "number": mode.number, "azimuth_deg": mode.azimuth, "drop": drop[mode]}
            for mode in listed
        ]
        rows.append({"joint": joint.name, "drops": drops})
    return rows


def _followed(original: Modes, changed: Sequence[Mode]) -> Iterator[tuple[Mode, Mode]]:
    """Each mode and that of the changed joints which moves alike: order and kind may change where motions are coupled."""
    from scipy.optimize import linear_sum_assignment

    old, new = (np.array([mode.shape.ravel() for mode in modes]) for modes in (original.modes, changed))
    mass = original.standing.mass_matrix
    new /= np.sqrt(np.einsum("mi,ij,mj->m", new, mass, new))[:, None]
    alike = np.abs(old @ mass @ new.T) / np.sqrt(np.einsum("mi,ij,mj->m", old, mass, old))[:, None]
    yield from ((original.modes[i], changed[j]) for i, j in zip(*linear_sum_assignment(-alike), strict=True))


def _modes_of(original: Modes, standing: Vibrating) -> list[Mode]:
    stack = original.structure.stack
    plane = original.model == "dem2d"
    return _of_column(standing, stack, plane) if stack is not None else _of_assembly(standing, plane)
