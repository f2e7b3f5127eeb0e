"""A specimen on the base as the kernels want it: principal axes, vertices, equilibrium, stable step, verdict."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from ...column.specimen import Specimen
from ...errors import InputError
from ...kernels.run_codes import COLLAPSED, FAILED
from ...outcome import Outcome, classify
from ...response import Collapse, Measures
from ...response.collapse import OVERTURNED
from ...response.measures import SpaceMeasures
from ...response.poses import rotation_matrices
from ..base import Case
from ..shared import ledger
from ..shared.stable_step import highest_frequency
from ..start import Toss
from .block import SpaceBlock
from .lying import lying, potential, turned
from .packing import damping_rows

#: Vertices of a block's lanes are made up to a multiple of this: specimens of about the same size share a block.
ROUND_UP = 64

#: Share of a body's size within which vertices may strike the base together [-].
TOGETHER = 5e-3

#: Tilt beyond which a body has toppled [rad].
TOPPLED = 0.25 * math.pi


def rows_for(specimen: Specimen) -> int:
    """Rows of vertices that a block for this specimen has."""
    return -(-len(specimen.vertices) // ROUND_UP) * ROUND_UP


def vertex_stiffness(specimen: Specimen) -> tuple[float, float]:
    """Normal and shear stiffness of one vertex [N/m]: those of the resting footprint over its vertices."""
    share = specimen.resting.area / len(specimen.resting.footprint)
    return specimen.joint.normal_stiffness * share, specimen.joint.shear_stiffness * share


def resting_first(specimen: Specimen) -> np.ndarray:
    """Numbers of the vertices in the order of a block's rows: those of the footprint first."""
    foot = specimen.resting.footprint
    return np.concatenate((foot, np.setdiff1d(np.arange(len(specimen.vertices)), foot)))


@lru_cache(maxsize=256)
def principal(specimen: Specimen) -> tuple[np.ndarray, np.ndarray]:
    """Principal moments about body axes i, j, k [kg m²], and those axes as columns in the axes of the vertices.

    The moment that differs most from the other two belongs to k, so that the rotation is nearest to an exact one.
    """
    moments, axes = np.linalg.eigh(specimen.inertia)
    order = [1, 2, 0] if moments[1] - moments[0] > moments[2] - moments[1] else [0, 1, 2]
    moments, axes = moments[order], axes[:, order]
    if np.linalg.det(axes) < 0.0:
        axes[:, 2] = -axes[:, 2]
    return moments, axes


@lru_cache(maxsize=256)
def top_frequency(specimen: Specimen) -> float:
    """Highest angular frequency of the body with all vertices in contact that can strike the base together [rad/s]."""
    from scipy.spatial import ConvexHull

    kn, ks = vertex_stiffness(specimen)
    moments, axes = principal(specimen)
    vertices = specimen.vertices @ axes
    hull: Any = ConvexHull(vertices)
    size = float(np.ptp(vertices, axis=0).max())
    inverse = 1.0 / np.concatenate((np.full(3, specimen.mass), moments))
    highest = 0.0
    for outward in np.unique(np.round(hull.equations, 9), axis=0):
        near = vertices[vertices @ outward[:3] + outward[3] > -TOGETHER * size]
        spring = ks * np.eye(3) + (kn - ks) * np.outer(outward[:3], outward[:3])
        stiffness = np.zeros((6, 6))
        for x, y, z in near:
            skew = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])  # displacement of the vertex per small rotation
            rows = np.hstack((np.eye(3), skew))
            stiffness += rows.T @ spring @ rows
        highest = max(highest, highest_frequency(stiffness, inverse))
    return highest


#: Force that may be left where a body has sunk into its footprint, as a share of its weight.
SUNK = 1e-9


class SpecimenBlock(SpaceBlock):
    """A block of lanes of specimens; parameters as for :class:`SpaceBlock`.

    Parameters
    ----------
    rows : int
        Rows of vertices.
    damping : tuple of float
        β and α of the model [s], [1/s].
    step_for : callable
        Time step for a specimen [s].
    """

    def __init__(
        self,
        rows: int,
        damping: tuple[float, float],
        step_for: Callable[[Any], float],
        *arguments: Any,
        planar: bool,
    ) -> None:
        super().__init__(*arguments, rows=rows, planar=planar)
        self.damping, self.step_for = damping, step_for

    def base(self, case: Case) -> np.ndarray:
        """The base under a specimen is level."""
        return np.eye(3)

    def place(self, lane: int, case: Case) -> float:
        """Put a specimen at rest into a lane; its step [s]."""
        specimen: Any = case.column
        rest = specimen.resting
        moments, axes = principal(specimen)
        up = rest.rotation.T[:, 2] @ axes
        vertices = specimen.vertices[resting_first(specimen)] @ axes
        kn, ks = vertex_stiffness(specimen)
        for array in (self.drum, self.joint, self.lane):
            for name in array.dtype.names or ():
                array[name][..., lane] = 0.0
        joint, drum = self.joint, self.drum
        m = len(vertices)
        every = np.arange(len(self.joint))
        self.lane["near"][0].reshape(-1)[every] = every
        self.lane["count"][:] = len(every)
        for c, name in enumerate("xyz"):
            joint[name][:m, lane] = vertices[:, c]
        joint["kn"][:m, lane], joint["ks"][:m, lane] = kn, ks
        self.lane["mu"][0, lane], self.lane["lost"][0, lane] = specimen.joint.tan_phi, 1.0 - specimen.restitution**2
        joint["rest"][: len(rest.footprint), lane] = 1.0
        turn = rest.rotation @ axes
        values = {"m": specimen.mass, "im": 1.0 / specimen.mass, "z": rest.height}
        values |= {
            "ia": 1.0 / moments[1],
            "ib": 1.0 / moments[0] - 1.0 / moments[1],
            "ic": 1.0 / moments[2] - 1.0 / moments[1],
        }
        values |= {"rb": float(np.linalg.norm(vertices, axis=1).max()), "ht": float((vertices @ up).max())}
        values |= {"n" + c: up[i] for i, c in enumerate("xyz")}
        for name, value in values.items():
            drum[name][1, lane] = value
        self._turn(lane, turn)
        self.lane["g"][0, 2, lane] = specimen.gravity
        self.lane["damp"][0, :, lane] = damping_rows(True, *self.damping)
        self.lane["free"][0, lane] = 1.0
        self._settle(lane, turn, specimen)
        return self.step_for(specimen)

    def _turn(self, lane: int, turn: np.ndarray) -> None:
        for a, axis in enumerate("ijk"):
            for c, name in enumerate("xyz"):
                self.drum[axis + name][1, lane] = turn[c, a]

    def _settle(self, lane: int, turn: np.ndarray, specimen: Specimen) -> None:
        """Sink and tilt the body until its footprint carries it; where that is not stable, let it lie where it is."""
        kn, weight = vertex_stiffness(specimen)[0], specimen.mass * specimen.gravity
        arms = (specimen.vertices @ specimen.resting.rotation.T)[specimen.resting.footprint]
        rows = np.stack((np.ones(len(arms)), arms[:, 1], -arms[:, 0]), axis=1)  # rise of a vertex per z, θx, θy
        found = self._sunk(lane, turn, kn * rows.T @ rows, weight)
        vertices, height = specimen.vertices @ principal(specimen)[1], float(self.drum["z"][1, lane])
        if found is not None and np.linalg.eigvalsh(potential(vertices, found, height, kn, weight)[2])[0] > 0.0:
            return
        turn, height = lying(vertices, turn, specimen.resting.height, kn, weight)
        self.drum["z"][1, lane] = height
        self._turn(lane, turn)
        self._sunk(lane, turn, potential(vertices, turn, height, kn, weight)[2], weight)

    def _sunk(self, lane: int, turn: np.ndarray, stiffness: np.ndarray, weight: float) -> np.ndarray | None:
        """Newton's method on depth and two small rotations with one stiffness; the turn it ends with, None without end."""
        force = np.full(3, np.inf)
        for _ in range(9):
            carried, moment = self.net(lane)
            force = np.array([weight - carried[0, 2], -moment[0, 0], -moment[0, 1]])
            if np.abs(force).max() < 1e-12 * weight:
                break
            step = -np.linalg.lstsq(stiffness, force, rcond=1e-12)[0]
            self.drum["z"][1, lane] += step[0]
            turn = turned(turn, step)
            self._turn(lane, turn)
        return turn if np.abs(force).max() < SUNK * weight else None

    def check_start(self, column: Any) -> None:
        """Refuse a start that is not one for a specimen."""
        if not isinstance(self.options.start, Toss):
            raise InputError(f"the specimen {column.name!r} starts at rest or tossed; give a Toss, or leave start out.")

    def take_pose(self, lane: int, column: Any, start: Any) -> None:
        """Put a specimen where it is tossed from, with its velocities."""
        toss: Toss = start
        moments, axes = principal(column)
        turn = rotation_matrices(np.array(toss.orientation)) @ axes
        self._turn(lane, turn)
        drum, spin = self.drum, np.array(toss.angular_velocity)
        momentum = turn @ (moments * (turn.T @ spin))
        for c, name in enumerate("xyz"):
            drum[name][1, lane] = toss.position[c]
            drum["v" + name][1, lane] = toss.velocity[c]
            drum["w" + name][1, lane] = spin[c]
            drum["l" + name][1, lane] = momentum[c]

    def mark_start(self, lane: int) -> None:
        """Keep where the body stood."""
        drum = self.drum
        for c, place in zip("xyz", self.foot(lane), strict=True):
            drum[c][0, lane] = place
            for axis in "ijk":
                drum[axis + c][0, lane] = drum[axis + c][1, lane]

    def up(self, lane: int) -> np.ndarray:
        """Direction that was up at rest, in the axes of the body."""
        return np.array([self.drum["n" + c][1, lane] for c in "xyz"])

    def foot(self, lane: int) -> np.ndarray:
        """Where the point of the body is that was under the centroid at rest [m], shape (3,)."""
        specimen: Any = self.cases[lane].column  # type: ignore[union-attr]
        place = np.array([self.drum[c][1, lane] for c in "xyz"])
        return place - specimen.resting.height * self.axes(lane)[0] @ self.up(lane)

    def top_place(self, lane: int) -> np.ndarray:
        """Place in plan of the point that is as high as the highest vertex, above the centroid at rest [m], shape (2,)."""
        place = np.array([self.drum[c][1, lane] for c in "xyz"])
        return (place + self.drum["ht"][1, lane] * self.axes(lane)[0] @ self.up(lane))[:2]

    def joints(self, lane: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Height of the highest vertex of the footprint [m], its shift where it is lowest [m], and the twist [rad].

        Where it is lowest, so that a body that only leans has not slipped; shapes (1,), (1, 2), (1,).
        """
        specimen: Any = self.cases[lane].column  # type: ignore[union-attr]
        foot = len(specimen.resting.footprint)
        arms = np.stack([self.joint[c][:foot, lane] for c in "xyz"], axis=-1)
        axes = self.axes(lane)[0]
        places = np.array([self.drum[c][1, lane] for c in "xyz"]) + arms @ axes.T
        foot = np.array([self.drum[c][0, lane] for c in "xyz"])
        first = np.stack([[self.drum[a + c][0, lane] for c in "xyz"] for a in "ijk"], axis=-1)
        turn = axes @ first.T
        twist = math.atan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1])
        last = self.watch["tw"][0, lane]
        twist += 2.0 * math.pi * math.floor((last - twist) / (2.0 * math.pi) + 0.5)
        low = int(places[:, 2].argmin())
        c, s = math.cos(twist), math.sin(twist)
        x, y, _ = first @ arms[low]  # where that vertex was at rest, from the middle
        slip = places[low, :2] - foot[:2] - (c * x - s * y, s * x + c * y)
        return np.array([max(places[:, 2].max(), 0.0)]), slip[None], np.array([twist])

    def since_start(self, lane: int) -> tuple[np.ndarray, np.ndarray]:
        """Slip [m] and twist [rad] since the start."""
        return self.joints(lane)[1:]

    def residual_acceleration(self, lane: int) -> float:
        """Largest acceleration in the present position without input [m/s²]."""
        force, moment = self.net(lane)
        drum = self.drum[1]
        least = 1.0 / principal(self.cases[lane].column)[0].min()  # type: ignore[union-attr, arg-type]
        linear = force[0] * drum["im"][lane] - self.lane["g"][0, :, lane]
        return float(max(np.abs(linear).max(), np.abs(moment).max() * least * drum["rb"][lane]))

    def snapshot(self, lane: int) -> dict[str, Any]:
        """Everything that a history keeps of the present state; axes are those of the specimen's vertices."""
        specimen: Any = self.cases[lane].column  # type: ignore[union-attr]
        opening, slip, twist = self.joints(lane)
        return {
            "time": self.time(lane),
            "position": np.stack([self.drum[c][1:, lane] for c in "xyz"], axis=-1),
            "axes": self.axes(lane) @ principal(specimen)[1].T,
            "opening": opening,
            "slip": slip,
            "twist": twist,
            "base": self.foot(lane)[:2],
            "top": self.top_place(lane) - [self.watch[c][0, lane] for c in ("sx", "sy")],
            "energy": self.energies(lane),
        }

    def collect(self, lane: int) -> Measures:
        """Measures of a lane whose run is over."""
        case = self.cases[lane]
        assert case is not None
        specimen, watch = case.column, self.watch[0]
        assert isinstance(specimen, Specimen)
        change = self.energies(lane) - self.start[lane]
        barrier = height_barrier(specimen)
        lowest = specimen.mass * specimen.gravity * (barrier.max() - specimen.resting.height)
        imbalance = ledger.imbalance(
            ledger.unaccounted(change),
            work=float(watch["wmax"][lane]),
            start=self.begun(lane, change),
            barrier=max(lowest, 0.0),
            released=ledger.released(change),
        )
        _, slip, twist = self.joints(lane)
        shift, width = float(np.hypot(*slip[0])), math.sqrt(specimen.resting.area)
        collapsed = watch["status"][lane] == COLLAPSED
        failed = watch["status"][lane] == FAILED or bool(ledger.out_of_balance(imbalance))
        outcome = classify(collapsed, failed, float(watch["open"][lane]) / width, shift / width)
        top = self.top_place(lane) - (watch["sx"][lane], watch["sy"][lane])
        return Measures(
            outcome=outcome,
            decided=outcome is Outcome.COLLAPSED or (not failed and self._stays(lane, specimen, change, barrier)),
            collapse_time=float(watch["when"][lane] * self.dt[lane]) if watch["when"][lane] >= 0 else math.nan,
            peak_top_displacement=float(watch["top"][lane]),
            residual_top_displacement=float(np.hypot(*top)),
            peak_rotation=math.acos(max(-1.0, 1.0 - float(watch["turn"][lane]))),
            peak_joint_opening=float(watch["open"][lane]),
            residual_joint_slip=shift,
            energy_imbalance=imbalance,
            time_step=float(self.dt[lane]),
            steps=int(self.feed["step"][0, lane]),
            reason=self.reason(lane, outcome, imbalance),
            collapse=self.collapse(lane) if outcome is Outcome.COLLAPSED else None,
            space=SpaceMeasures(
                peak_top_x=float(watch["topx"][lane]),
                peak_top_y=float(watch["topy"][lane]),
                peak_tilt=math.acos(max(-1.0, 1.0 - float(watch["turn"][lane]))),
                peak_twist=float(watch["spin"][lane]),
                residual_slip_per_joint=(shift,),
                residual_twist_per_joint=(float(twist[0]),),
            ),
        )

    def _stays(self, lane: int, specimen: Specimen, change: np.ndarray, barrier: np.ndarray) -> bool:
        """Whether the energy that is left lifts the body over no ring of tilts between its own and 45°."""
        tilt = math.acos(max(-1.0, min(1.0, float((self.axes(lane)[0] @ self.up(lane))[2]))))
        energy = float(change[1] + change[2] + change[3] + self.rest[lane])
        beyond = barrier[np.linspace(0.0, TOPPLED, len(barrier)) > tilt]
        rise = specimen.mass * specimen.gravity * (beyond - specimen.resting.height)
        return len(beyond) > 0 and energy < float(rise.max())

    def collapse(self, lane: int) -> Collapse:
        """The toppling of a lane, with its direction in plan."""
        watch = self.watch[0]
        return Collapse(
            time=float(watch["when"][lane] * self.dt[lane]),
            joint=1,
            mechanism=OVERTURNED,
            azimuth=math.atan2(watch["ey"][lane], watch["ex"][lane]),
        )

    def reason(self, lane: int, outcome: Outcome, imbalance: float) -> str:
        """Why a run failed, or which way the body toppled; empty for one that stands."""
        if outcome is Outcome.COLLAPSED:
            return f"toppled, its tilt is beyond {math.degrees(TOPPLED):.0f}°, {self.direction(lane)}"
        return super().reason(lane, outcome, imbalance)


@lru_cache(maxsize=256)
def height_barrier(specimen: Specimen) -> np.ndarray:
    """Least height of the centroid over the base at tilts from 0 to 45°, over all azimuths [m], shape (91,)."""
    vertices = specimen.vertices @ specimen.resting.rotation.T
    azimuth = np.arange(180) * (math.pi / 90.0)
    out = []
    for tilt in np.linspace(0.0, TOPPLED, 91):
        down = np.stack(
            (math.sin(tilt) * np.cos(azimuth), math.sin(tilt) * np.sin(azimuth), np.full(180, -math.cos(tilt))), axis=1
        )
        out.append(float((vertices @ down.T).max(axis=0).min()))
    return np.array(out)
