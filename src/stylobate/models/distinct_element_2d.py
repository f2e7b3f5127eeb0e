"""Plane distinct elements: rigid drums on soft frictional joints, stepped explicitly (Cundall; the paper's UDEC)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from ..column import Column
from ..errors import InputError, OutOfRangeWarning, check_range
from ..motion import Motion
from ..outcome import Outcome, classify
from ..response import Histories, Measures, Response
from .base import Case, Model, RunOptions, ground_history
from .lanes import aligned_zeros, run_lanes

#: Half width of the base, wide enough to be a half-plane [m].
BASE_HALF_WIDTH = 1.0e4

#: A run whose ledger is out of balance by more than this share of the input work has failed.
LARGEST_IMBALANCE = 0.25

MAX_POINTS = 32

#: Steps of one call of the kernel, as a share of a run; lanes that are over wait that long at most.
CALLS_PER_RUN = 100


@dataclass(frozen=True)
class DistinctElement2D(Model):
    """Rigid drums with contact points on every joint: penalty springs, no tension, Coulomb friction.

    Parameters
    ----------
    points : int
        Contact points per joint. 2 are at the corners with half of the area each (UDEC's); more follow Gauss–Lobatto's
        rule over the joint's section, which is exact for the elastic closed joint from 3 on.
    block_modulus : float, optional
        Young's modulus of the stone [Pa]: half of each drum's height acts as a spring in series with its joints. None for
        rigid drums.
    step_factor : float
        Time step as a share of the largest stable one.
    time_step : float, optional
        Time step [s], instead of ``step_factor``.
    stiffness_damping : float
        β: dashpots of β times each contact's stiffness, in parallel, while the contact is closed and does not slide [s].
    mass_damping : float
        α: force −α m v on every drum, v relative to the base [1/s].
    start : {"static", "settle"}
        Joints closed by their static weight at once, or settled with local damping from there.

    Notes
    -----
    A run ends as ``collapsed`` when the part above some joint is lost for good: its centroid is beyond the end of the
    contact, moves outward, and its weight has a larger moment about that end than the strongest acceleration of the
    motion could set against it (for a joint between drums, with 1 g in reserve, because the drum below can move); or
    when a drum has left its support.

    Drums touch their neighbours and the base only; with ``until_end`` a run goes on to its end all the same.
    """

    name: ClassVar[str] = "dem2d"
    title: ClassVar[str] = "distinct elements in the plane"
    references: ClassVar[tuple[str, ...]] = ("baraldi", "cundall1971", "cundall1979", "psycharis2000")

    points: int = 2
    block_modulus: float | None = None
    step_factor: float = 0.4
    time_step: float | None = None
    stiffness_damping: float = 0.0
    mass_damping: float = 0.0
    start: str = "static"

    def __post_init__(self) -> None:
        if isinstance(self.points, bool) or int(self.points) != self.points or not 2 <= self.points <= MAX_POINTS:
            raise InputError(f"points is {self.points!r}; allowed is a whole number from 2 to {MAX_POINTS}.")
        if self.block_modulus is not None:
            check_range("block_modulus", self.block_modulus, 0.0, 1e14, unit="Pa", open_low=True)
        check_range(
            "step_factor", self.step_factor, 0.0, 1.0, open_low=True, open_high=True, remedy="0.4 is the default"
        )
        if self.time_step is not None:
            check_range("time_step", self.time_step, 0.0, 1.0, unit="s", open_low=True)
        check_range("stiffness_damping", self.stiffness_damping, 0.0, 1.0, unit="s")
        check_range("mass_damping", self.mass_damping, 0.0, 1e3, unit="1/s")
        if self.start not in ("static", "settle"):
            raise InputError(f"start is {self.start!r}; allowed are static, settle.")

    @property
    def damped(self) -> bool:
        """Whether any damping acts during the run."""
        return self.stiffness_damping > 0.0 or self.mass_damping > 0.0

    # -- before the run ------------------------------------------------------------------------------------------

    def check(self, column: Column, motion: Motion) -> None:
        """Refuse an unstable step; say what a plane model leaves out."""
        self.step_for(column)
        if motion.lateral is not None:
            import warnings

            warnings.warn(
                f"the second horizontal component of {motion.name!r} is left out: dem2d is a plane model.",
                OutOfRangeWarning,
                stacklevel=3,
            )

    def step_for(self, column: Column) -> float:
        """Time step for a column [s].

        Raises
        ------
        InputError
            The step asked for is above the largest stable one.
        """
        stable = _stable_step(column, self)
        if self.time_step is None:
            return self.step_factor * stable
        if self.time_step >= stable:
            raise InputError(
                f"time_step is {self.time_step:g} s; the largest stable step for this column is {stable:.4g} s: "
                f"give at most {0.9 * stable:.3g} s, or leave it out."
            )
        return self.time_step

    # -- one run -------------------------------------------------------------------------------------------------

    def run(self, column: Column, motion: Motion, options: RunOptions) -> Response:
        """One run with histories, through the same kernel as a batch."""
        block = _Block(self, column.n, options)
        block.load(0, Case(column, motion))
        chunks = math.ceil(block.steps[0] / block.chunk)
        stride = max(1, min(chunks, round(options.output_interval / (block.chunk * block.dt[0]))))
        residual = block.residual_acceleration(0)
        states = [block.snapshot(0)]
        while not block.is_over(0):
            block.advance(stride)
            states.append(block.snapshot(0))
        provenance = {"time_step_s": block.dt[0], "residual_acceleration_at_start_m_s2": residual}
        measures = block.collect(0)
        return Response(column, _histories(column, motion, states), measures, self.name, provenance)

    # -- many runs -----------------------------------------------------------------------------------------------

    def run_many(self, cases: Sequence[Case], options: RunOptions, threads: int) -> Iterator[tuple[int, Measures]]:
        """Many runs through blocks of lanes; columns, joints and motions may differ from lane to lane."""
        by_drums: dict[int, list[int]] = {}
        for index, case in enumerate(cases):
            by_drums.setdefault(case.column.n, []).append(index)
        for drums, indices in by_drums.items():
            some = [cases[index] for index in indices]
            for k, measures in run_lanes(lambda drums=drums: _Block(self, drums, options), some, threads):
                yield indices[k], measures


class _Block:
    """A block of lanes: kernel arrays, and the way of a case into and out of them."""

    def __init__(self, model: DistinctElement2D, drums: int, options: RunOptions) -> None:
        self.model = model
        self.kernel = kernel = self.its_kernel()
        self.options = options
        self.lanes = kernel.LANES
        self.chunk = kernel.CHUNK
        types = self.its_types()
        self.drum = aligned_zeros(drums + 1, types[0])
        self.joint = aligned_zeros(drums + 1, types[1])
        self.lane = aligned_zeros(1, types[2])
        self.ground = aligned_zeros(kernel.CHUNK + 1, types[3])
        self.feed = aligned_zeros(1, types[4])
        self.watch = aligned_zeros(1, types[5])
        self.watch["status"] = kernel.FREE
        self.dt = np.zeros(self.lanes)
        self.steps = np.zeros(self.lanes, dtype=np.int64)
        self.start = np.zeros((self.lanes, 6))
        self.cases: list[Case | None] = [None] * self.lanes
        self.chunks_per_call = 1

    # What differs where drums are stepped alike but their joints follow another law (the rigid block model).

    def its_kernel(self) -> Any:
        """Module of kernels."""
        from ..kernels import distinct_element_2d as kernel

        return kernel

    def its_types(self) -> tuple:
        """Record types of the arrays."""
        return self.kernel.block_types(self.model.points, self.model.damped)

    def its_column(self, column: Column) -> _Packed:
        """A column as the kernel wants it."""
        return _pack(column, self.model)

    def load(self, lane: int, case: Case) -> None:
        """Start a case in a lane."""
        column, motion = case
        packed = self.its_column(column)
        for array, fields in zip((self.drum, self.joint, self.lane), packed.fields, strict=True):
            for name, values in fields.items():
                array[name][..., lane] = values
        if self.model.start == "settle":
            for name, values in _settled(column, self.model).items():
                (self.joint if name == "fs" else self.drum)[name][..., lane] = values
        self.joint["dn"][..., lane] = self.joint["ds"][..., lane] = 0.0
        duration = motion.duration + self.options.tail
        chunks = max(1, math.ceil(duration / (self.chunk * packed.step)))
        steps = chunks * self.chunk
        dt = duration / steps
        self.lane["dt"][0, lane] = dt
        x, z = motion.samples, motion.z_samples
        feed, watch = self.feed[0], self.watch[0]
        feed["x"][lane] = x.ctypes.data
        feed["z"][lane] = 0 if z is None else z.ctypes.data
        feed["last"][lane] = len(x) - 1
        feed["step"][lane] = 0
        feed["end"][lane] = steps
        feed["ratio"][lane] = dt / motion.dt
        feed["factor"][lane] = motion.factor
        for name in watch.dtype.names:
            watch[name][lane] = 0
        watch["status"][lane] = self.kernel.RUNNING
        watch["follow"][lane] = self.options.until_end
        watch["when"][lane] = watch["which"][lane] = -1
        watch["amax"][lane] = motion.pga
        watch["vmax"][lane] = 0.0 if z is None else _peak(z) * abs(motion.factor)
        # velocities half a step before the start, of drums that do not move yet in a base that may
        self.drum["vx"][1:, lane] = 0.5 * dt * motion.factor * x[0]
        self.drum["vz"][1:, lane] = 0.0 if z is None else 0.5 * dt * motion.factor * z[0]
        self.dt[lane] = dt
        self.steps[lane] = steps
        self.cases[lane] = case
        self.chunks_per_call = max(1, chunks // CALLS_PER_RUN)
        self.start[lane] = self.energies(lane)

    def advance(self, chunks: int | None = None) -> None:
        """Advance all lanes by some chunks of steps."""
        count = self.chunks_per_call if chunks is None else chunks
        self.kernel.advance(self.drum, self.joint, self.lane, self.ground, self.feed, self.watch, count)

    def is_over(self, lane: int) -> bool:
        """Whether the lane's run has ended."""
        return self.watch["status"][0, lane] != self.kernel.RUNNING

    def time(self, lane: int) -> float:
        """Time of the lane's present state [s]."""
        return float(self.feed["step"][0, lane]) * self.dt[lane]

    def energies(self, lane: int) -> np.ndarray:
        """Ledger of a lane now: input, kinetic, gravitational, elastic, friction, viscous; the middle two absolute [J]."""
        case = self.cases[lane]
        assert case is not None
        place = self.time(lane) / case.motion.dt
        ground = np.zeros(1, self.ground.dtype)
        ground["ax"][0, lane] = _sample(case.motion.samples, place) * case.motion.factor
        if case.motion.z_samples is not None:
            ground["az"][0, lane] = _sample(case.motion.z_samples, place) * case.motion.factor
        # the forces at the present positions, found as the next step will find them, on a copy
        joint, state = self.joint.copy(), self.lane.copy()
        state["dt"][0, lane] = self.dt[lane]
        self.kernel.forces(self.drum, joint, state)
        out = np.empty(6)
        self.kernel.ledger(self.drum, joint, state, ground, 0, self.dt[lane], lane, out)
        return out

    def residual_acceleration(self, lane: int) -> float:
        """Largest acceleration of a drum in its present position without input; of its edge, where it turns [m/s²]."""
        joint, state = self.joint.copy(), self.lane.copy()
        self.kernel.forces(self.drum, joint, state)
        d = {name: self.drum[name][1:, lane] for name in ("im", "ii", "b")}
        net = {name: joint[name][:, lane] for name in ("fx", "fz", "mu_", "ml")}
        ax = (net["fx"][:-1] - net["fx"][1:]) * d["im"]
        az = (net["fz"][:-1] - net["fz"][1:]) * d["im"] - state["g"][0, lane]
        turn = (net["mu_"][:-1] - net["ml"][1:]) * d["ii"] * d["b"]
        return float(np.abs(np.concatenate((ax, az, turn))).max())

    def snapshot(self, lane: int) -> dict[str, Any]:
        """Everything that a history keeps of the present state."""
        drum, joints = self.drum, len(self.drum) - 1
        opening, slip = np.empty(joints), np.empty(joints)
        self.kernel.joint_state(drum, lane, opening, slip)
        bottom, top = drum[1], drum[-1]
        return {
            "time": self.time(lane),
            "x": drum["x"][1:, lane].copy(),
            "z": drum["z"][1:, lane].copy(),
            "rotation": drum["th"][1:, lane].copy(),
            "opening": opening,
            "slip": slip,
            "base": bottom["x"][lane] + bottom["s"][lane] * bottom["hb"][lane],
            "top": top["x"][lane] - top["s"][lane] * top["ht"][lane],
            "energy": self.energies(lane),
        }

    def collect(self, lane: int) -> Measures:
        """Measures of a lane whose run is over."""
        case = self.cases[lane]
        assert case is not None
        watch, drum = self.watch[0], self.drum
        status = watch["status"][lane]
        now = self.energies(lane)
        change = now - self.start[lane]
        imbalance = _imbalance(change, float(watch["wmax"][lane]), float(self.start[lane, 3]))
        opening, slip = np.empty(case.column.n), np.empty(case.column.n)
        self.kernel.joint_state(drum, lane, opening, slip)
        collapsed = status == self.kernel.COLLAPSED
        failed = status == self.kernel.FAILED or not imbalance <= LARGEST_IMBALANCE
        widths = case.column.joint_widths
        outcome = classify(
            collapsed, failed, float(watch["open"][lane] / widths.min()), float((np.abs(slip) / widths).max())
        )
        mechanical = float(change[1] + change[2] + change[3])
        top = drum[-1]
        return Measures(
            outcome=outcome,
            decided=outcome is Outcome.COLLAPSED or (not failed and mechanical < _barrier(case.column, slip)),
            collapse_time=float(watch["when"][lane] * self.dt[lane]) if watch["when"][lane] >= 0 else math.nan,
            peak_top_displacement=float(watch["top"][lane]),
            residual_top_displacement=float(top["x"][lane] - top["s"][lane] * top["ht"][lane]),
            peak_rotation=float(watch["turn"][lane]),
            peak_joint_opening=float(watch["open"][lane]),
            residual_joint_slip=float(np.abs(slip).max()),
            energy_imbalance=imbalance,
            time_step=float(self.dt[lane]),
            steps=int(self.feed["step"][0, lane]),
            reason=self._reason(lane, outcome, imbalance, opening),
        )

    def _reason(self, lane: int, outcome: Outcome, imbalance: float, opening: np.ndarray) -> str:
        watch = self.watch[0]
        if outcome is Outcome.FAILED:
            if watch["status"][lane] == self.kernel.FAILED:
                return f"the state is not finite at {self.time(lane):.4g} s; try a smaller step_factor"
            return (
                f"the energy ledger is out of balance by {imbalance:.2g} of the input work; try a smaller step_factor"
            )
        if outcome is not Outcome.COLLAPSED:
            return ""
        side = "right" if watch["side"][lane] > 0 else "left"
        lost, drums = int(watch["which"][lane]), len(self.drum) - 1
        parted = self.joint["kn"][lost, lane] == 0.0
        # what is lost above some joint turns about the joint that is widest open, there or higher up
        joint = 1 + (lost if parted else lost + int(np.argmax(opening[lost:])))
        part = "the whole column" if joint == 1 else f"drums {joint} to {drums}" if joint < drums else f"drum {drums}"
        how = f"left the support at joint {joint}" if parted else f"overturned about joint {joint}"
        return f"{part} {how}, to the {side}"


@dataclass(frozen=True)
class _Packed:
    """A column as the kernel wants it."""

    fields: tuple[dict[str, np.ndarray], dict[str, np.ndarray], dict[str, Any]]
    step: float


@lru_cache(maxsize=4096)
def _pack(column: Column, model: DistinctElement2D) -> _Packed:
    n = column.n
    drums = column.drums
    below = lambda values, base: np.concatenate(([base], values))  # noqa: E731
    centroid = np.array([drum.centroid_height for drum in drums])
    kn, ks = joint_stiffnesses(column, model.block_modulus)
    width, area = column.joint_widths, column.joint_areas
    closure = column.joint_weights / (kn * area)
    xi, share = contact_points(column.section, model.points)
    drum_fields = {
        "x": np.zeros(n + 1),
        "z": below(column.centroid_heights - np.cumsum(closure), 0.0),
        "th": np.zeros(n + 1),
        "c": np.ones(n + 1),
        "s": np.zeros(n + 1),
        "vx": np.zeros(n + 1),
        "vz": np.zeros(n + 1),
        "w": np.zeros(n + 1),
        "m": below(column.masses, 0.0),
        "i": below(column.inertias, 0.0),
        "im": below(1.0 / column.masses, 0.0),
        "ii": below(1.0 / column.inertias, 0.0),
        "hb": below(centroid, 0.0),
        "ht": below(column.heights - centroid, 0.0),
        "b": below(np.array([drum.bottom_width / 2 for drum in drums]), 0.0),
        "t": below(np.array([drum.top_width / 2 for drum in drums]), BASE_HALF_WIDTH),
    }
    above = lambda values: np.concatenate((values, [0.0]))  # noqa: E731
    joint_fields = {
        "kn": above(kn * area / width),
        "ks": above(ks * area / width),
        "co": above(np.array([joint.cohesion for joint in column.joints]) * area / width),
        "mu": above(np.array([joint.tan_phi for joint in column.joints])),
        "fs": np.zeros((n + 1, model.points)),
        "over": np.zeros(n + 1),
    }
    lane_fields = {
        "g": column.gravity,
        "beta": model.stiffness_damping,
        "alpha": model.mass_damping,
        "local": 0.0,
        "work": 0.0,
        "shear": 0.0,
        "visc": 0.0,
        "xi": xi,
        "sh": share,
    }
    return _Packed((drum_fields, joint_fields, lane_fields), model.step_for(column))


#: Local damping while settling, the residual acceleration at which a column has settled [m/s²], and the most chunks.
SETTLE_DAMPING, SETTLED, SETTLE_CHUNKS = 0.8, 1e-7, 20_000


@lru_cache(maxsize=256)
def _settled(column: Column, model: DistinctElement2D) -> dict[str, np.ndarray]:
    """Positions and shear forces after settling under gravity with local damping, by field and drum or joint."""
    block = _Block(replace(model, start="static", mass_damping=max(model.mass_damping, 1e-300)), column.n, RunOptions())
    block.load(0, Case(column, Motion(1e3, np.zeros(2))))
    block.lane["local"][0, 0] = SETTLE_DAMPING
    for _ in range(SETTLE_CHUNKS // 100):
        block.advance(100)
        if block.residual_acceleration(0) < SETTLED:
            break
    else:
        raise InputError(
            f"column {column.name!r} does not come to rest under its weight: {block.residual_acceleration(0):.2g} m/s² "
            f"remain, allowed is {SETTLED:g}; check that every drum is supported under its centroid."
        )
    state = {name: block.drum[name][:, 0].copy() for name in ("x", "z", "th", "c", "s")}
    return state | {"fs": block.joint["fs"][..., 0].copy()}


def joint_stiffnesses(column: Column, block_modulus: float | None) -> tuple[np.ndarray, np.ndarray]:
    """Normal and shear stiffness per area of each joint [N/m³], with the stone in series if its modulus is given.

    1/k_n′ = 1/k_n + h/2E of the drum above + h/2E of the drum below (the base is rigid); k_s keeps its ratio to k_n.
    """
    kn = np.array([joint.normal_stiffness for joint in column.joints])
    ks = np.array([joint.shear_stiffness for joint in column.joints])
    if block_modulus is None:
        return kn, ks
    half = 0.5 * column.heights / block_modulus
    soft = 1.0 / (1.0 / kn + half + np.concatenate(([0.0], half[:-1])))
    return soft, ks * soft / kn


def contact_points(section: str, points: int) -> tuple[np.ndarray, np.ndarray]:
    """Places (−1 … 1) and shares of the area of a joint's contact points.

    Gauss–Lobatto's rule for the chord of the section: weight 1 for a rectangle, √(1 − ξ²) for a circle. Its inner points
    are the roots of the Jacobi polynomial for the weight times 1 − ξ²; the ends take what is left.
    """
    if points == 2:
        return np.array([-1.0, 1.0]), np.array([0.5, 0.5])
    from scipy.special import roots_jacobi

    power, total = (1.5, math.pi / 2.0) if section == "circular" else (1.0, 2.0)
    inner, weight = roots_jacobi(points - 2, power, power)
    inner = 0.5 * (inner - inner[::-1])
    weight = 0.5 * (weight + weight[::-1]) / (1.0 - inner**2)
    end = 0.5 * (total - weight.sum())
    return np.concatenate(([-1.0], inner, [1.0])), np.concatenate(([end], weight, [end])) / total


@lru_cache(maxsize=4096)
def _stable_step(column: Column, model: DistinctElement2D) -> float:
    """Largest stable step of central differences for the closed column [s].

    From the highest frequency of the contact stiffness matrix: 2/ω (√(1 + ζ²) − ζ), ζ = β ω / 2, where the dashpots act
    with the velocity half a step back.
    """
    n = column.n
    kn, ks = joint_stiffnesses(column, model.block_modulus)
    xi, share = contact_points(column.section, model.points)
    stiffness = np.zeros((3 * n, 3 * n))
    for j in range(n):
        below = column.drums[j - 1].height - column.drums[j - 1].centroid_height if j else 0.0
        above = column.drums[j].centroid_height
        for place, part in zip(xi, share, strict=True):
            arm = 0.5 * column.joint_widths[j] * place
            # relative displacement of the contact per degree of freedom (x, z, θ) of the drum above and of the one below
            normal, shear = np.zeros(3 * n), np.zeros(3 * n)
            normal[3 * j + 1], normal[3 * j + 2] = 1.0, arm
            shear[3 * j], shear[3 * j + 2] = 1.0, above
            if j:
                normal[3 * j - 2], normal[3 * j - 1] = -1.0, -arm
                shear[3 * j - 3], shear[3 * j - 1] = -1.0, below
            area = part * column.joint_areas[j]
            stiffness += kn[j] * area * np.outer(normal, normal) + ks[j] * area * np.outer(shear, shear)
    root = 1.0 / np.sqrt(np.stack((column.masses, column.masses, column.inertias), axis=1).ravel())
    omega = math.sqrt(float(np.linalg.eigvalsh(stiffness * np.outer(root, root))[-1]))
    zeta = 0.5 * model.stiffness_damping * omega
    return 2.0 / omega * (math.sqrt(1.0 + zeta * zeta) - zeta)


def _histories(column: Column, motion: Motion, states: list[dict[str, Any]]) -> Histories:
    stack = {key: np.array([state[key] for state in states]) for key in states[0]}
    energy = stack["energy"]
    acceleration, displacement = ground_history(motion, stack["time"])
    return Histories(
        time=stack["time"],
        drum_x=stack["x"] - stack["x"][0],
        drum_z=stack["z"] - stack["z"][0],
        drum_rotation=stack["rotation"],
        joint_opening=stack["opening"],
        joint_slip=stack["slip"] - stack["slip"][0],
        base_displacement=stack["base"],
        top_displacement=stack["top"],
        ground_acceleration=acceleration,
        ground_displacement=displacement,
        energy={
            "input": energy[:, 0],
            "kinetic": energy[:, 1],
            "gravitational": energy[:, 2] - energy[0, 2],
            "elastic": energy[:, 3] - energy[0, 3],
            "friction": energy[:, 4] - energy[0, 4],
            "viscous": energy[:, 5] - energy[0, 5],
        },
    )


def _imbalance(change: np.ndarray, largest_work: float, elastic: float) -> float:
    """What the ledger cannot account for, relative to the largest input work, or to the static closure's if larger."""
    missing = change[0] - change[1:].sum()
    return float(abs(missing) / max(largest_work, elastic))


def _barrier(column: Column, slip: np.ndarray) -> float:
    """Smallest energy that overturns the part above some joint as one body [J], its support shortened by the slip."""
    lowest = math.inf
    for j in range(column.n):
        mass = column.masses[j:]
        height = float(mass @ (column.centroid_heights[j:] - column.joint_heights[j]) / mass.sum())
        half = max(0.5 * column.joint_widths[j] - abs(slip[j]), 0.0)
        lowest = min(lowest, column.gravity * float(mass.sum()) * (math.hypot(half, height) - height))
    return lowest


def _sample(values: np.ndarray, place: float) -> float:
    """Linear between samples, zero after the last one."""
    i = min(int(place), len(values) - 2)
    return float(values[i] + (values[i + 1] - values[i]) * (place - i)) if place <= len(values) - 1 else 0.0


def _peak(values: np.ndarray) -> float:
    return float(np.abs(values).max())
