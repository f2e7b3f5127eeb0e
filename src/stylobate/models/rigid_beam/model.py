"""Rigid beam: every drum a rigid beam, every joint a moment–rotation law; the paper's model, with sliding added."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ...column import Column
from ...errors import InputError, check_choice, check_range, warn
from ...messages import say
from ...motion import Motion
from ...response import Measures, Response
from ..base import Case, Model, RunOptions
from ..engine import Engine
from ..rocking.block import RockingBlock, warn_of_free_flight, warn_sliding
from ..rocking.model import Rocking
from ..shared.lanes import MOST_SAMPLES, run_alike
from .state import BeamMatrices

if TYPE_CHECKING:
    from .state import PackedBeam

LAWS = ("winkler", "bilinear", "trilinear", "housner")

#: Step times the highest rate of the closed column: default, and what is refused beyond (stable to 2.8 undamped).
STEP_FACTOR = 1.5
STABLE = 2.6


class Beam(Engine):
    """Chains of rigid beams, single runs and batches in lanes."""

    @property
    def not_scattered(self) -> tuple[str, ...]:
        """Friction too, where nothing slides."""
        return super().not_scattered + (() if self.model.sliding else ("friction",))

    def check(self, motion: Motion) -> None:
        """Refuse what cannot be computed; warn outside the declared limits."""
        super().check(motion)
        column, model = self.structure, self.model
        seen = model.idealised(column)
        if model.moment_law == "housner" and column.n > 1:
            raise InputError(
                f"moment_law=housner is for one drum, and {column.name!r} has {column.n}; "
                "use bilinear, trilinear or winkler."
            )
        if model.rotation == "absolute" and model.flutters(seen):
            raise InputError(
                f"with rotation=absolute the column {column.name!r} flutters while all its joints are closed, so that the "
                "smallest vibration grows without end; use rotation=relative, or fewer or more slender drums."
            )
        if model.time_step is not None:
            p = seen.frequency_parameter
            passed = f"{MOST_SAMPLES} samples of the motion"
            limits = {"0.02/p of this column": 0.02 / p, passed: MOST_SAMPLES * motion.dt}
            if model.moment_law == "housner":
                limits = {"0.2/p of this column": 0.2 / p}
            else:
                limits["what is stable"] = model.stable_step(seen)
            which, largest = min(limits.items(), key=lambda item: item[1])
            if model.time_step > largest * (1.0 + 1e-9):
                raise InputError(
                    f"time_step is {model.time_step:g} s; allowed is up to {largest:.3g} s ({which}), or leave it out."
                )
        if not model.sliding:
            warn_sliding(seen, seen.slenderness, model.name, say("with sliding=true the beam slides"))
        if abs(model.initial_rotation) >= seen.slenderness:
            raise InputError(
                f"initial_rotation is {model.initial_rotation:g} rad; allowed is less than the slenderness "
                f"{seen.slenderness:.4g} rad, beyond which the column falls by itmodel."
            )
        opening = float(model.opening_rotations(seen).max())
        if model.moment_law != "housner" and opening > 0.1 * float(model.critical_angles(seen).min()):
            warn(
                say(
                    "the joints of {column.name!r} open only at {opening:.3g} rad, more than a tenth of the critical angle: "
                    "the beam is for stiff joints; raise normal_stiffness.",
                    column=column,
                    opening=opening,
                )
            )
        warn_of_free_flight(column, motion)

    def expected_step(self, motion: Motion) -> tuple[float, float]:
        """Time step and its cost [s]."""
        from .lanes import COST

        step = self.model.step_for(self.model.idealised(self.structure), motion)
        return min(step, motion.duration), COST * self.structure.n

    def run(self, motion: Motion, options: RunOptions) -> Response:
        """One run with histories."""
        from .lanes import run_one

        column = self.structure
        histories, measures = run_one(self.model.pack(column), column, motion, options)
        return Response(column, histories, measures, self.model.name, {})

    def run_many(self, cases: Sequence[Case], options: RunOptions, threads: int) -> Iterator[tuple[int, Measures]]:
        """Many runs through blocks of lanes."""
        from .lanes import BeamLanes, loop_for

        pack = self.model.pack
        return run_alike(
            lambda case: loop_for(pack(case.column), case.motion),
            lambda loop: BeamLanes(pack, loop, options),
            cases,
            threads,
        )


class RockingBeam(Rocking, Beam):
    """A beam of one drum that rocks as a block does."""

    @classmethod
    def computes_for(cls, model: Any, structure: Any) -> bool:
        """Whether it computes a structure with a model: with Housner's law."""
        return super().computes_for(model, structure) and model.moment_law == "housner"


@dataclass(frozen=True)
class RigidBeam(Model):
    """Drums as rigid beams that rotate, joints as moment–rotation laws; small rotations, no vertical freedom.

    Parameters
    ----------
    moment_law : {"winkler", "bilinear", "trilinear", "housner"}
        ``winkler``: elastic bed without tension. ``bilinear``, ``trilinear``: the paper's. ``housner``: rigid until M_u,
        impacts with restitution; one drum only.
    xi : float
        ξ: plateau of the tri-linear law over M_u, in (0, 1] [-].
    second_order : {"geometric", "law"}
        Where the weight's loss of lever arm stands: in the equations of motion, or in a falling branch of the law.
    rotation : {"relative", "absolute"}
        What the law is in: the joint's rotation, or the rotation of the drum above (the paper's wording).
    idealisation : {"true", "prism"}
        Drums as they are, or prisms of their mean width (the paper).
    critical_angle : {"stack", "drum"}
        α of the laws' branches: of all that stands on the joint as one body, or of the drum above it alone (the paper).
    sliding : bool
        A slip at every joint, elastic up to Mohr–Coulomb's limit.
    stiffness_damping : float
        β: a closed joint of stiffness K resists the velocity of the law's rotation by βK [s].
    restitution : float, optional
        For ``housner``: velocity after an impact over the one before; Housner's own by default.
    initial_rotation : float
        Rotation of the whole column about its base joint from which it is let go at rest, counter-clockwise [rad].
    time_step : float, optional
        [s]. By default 1.5/ω_max, ω_max of the column with all joints closed, at most 4 samples of the motion and 0.01/p;
        allowed is up to 2.6/ω_max, 4 samples and 0.02/p.

    Raises
    ------
    InputError
        A value outside its range, or options that contradict each other.

    Notes
    -----
    Equations F1 to F3 and R1 to R9 of ``docs/theory/rigid_beam.md``.

    *Collapsed* means that the part above some joint is lost: its centroid is beyond the edge of the joint, moves
    outward, and its weight has a larger moment about that edge than the strongest acceleration left in the motion
    (for joints between drums, 1 g more, because the drum below can move) could set against it; with
    ``second_order="law"`` the same of the joint's own moment. Or that a drum has turned by a right angle, or has slid off
    the one below. At the end, without input, also that the centroid of a part has slid beyond the edge of its joint, or
    that the column is past its lowest barrier and has less energy than it takes to come back.

    References
    ----------
    Baraldi, Sarhosis and Milani; Housner 1963.
    """

    engines: ClassVar[tuple[Any, ...]] = (RockingBeam, Beam)

    moment_law: str = "winkler"
    xi: float = 1.0
    second_order: str = "geometric"
    rotation: str = "relative"
    idealisation: str = "true"
    critical_angle: str = "stack"
    sliding: bool = False
    stiffness_damping: float = 0.0
    restitution: float | None = None
    initial_rotation: float = 0.0
    time_step: float | None = None

    name: ClassVar[str] = "rigid-beam"
    title: ClassVar[str] = "rigid beam model"
    references: ClassVar[tuple[str, ...]] = ("baraldi", "housner1963")
    assumptions: ClassVar[tuple[str, ...]] = (
        "Every drum is a rigid beam that turns about the middle of its joint; rotations are small.",
        "Drums do not move up and down: the compression of a joint is the static one, times 1 + a_v/g.",
        "A joint is a law between moment and rotation: an elastic bed without tension, or two or three lines.",
        "An impact takes no energy by itself; stiffness damping, friction and Housner's law do.",
        "Drums do not slip unless sliding=true.",
        "Plane motion.",
    )
    limits: ClassVar[tuple[str, ...]] = (
        "Against a block that turns about its corner the inertia lacks m b²: 2 % for the paper's column, more if stocky.",
        "Without damping and without sliding a stack of drums keeps all energy and is too prone to collapse.",
        "rotation=absolute and second_order=law are the paper's reading: there to reproduce it, wrong for a stack.",
        "With rotation=absolute a stack is decided only where no joint can open any more; one that flutters is refused.",
        "With a vertical acceleration below −1 g the column leaves the ground: the run fails, unless it had collapsed.",
        "Slip does not shorten a joint in the equations, only in the verdict.",
        "moment_law=housner is for one drum.",
        "Joints too soft to hold the column upright under its own weight give no verdict: the run fails.",
        "Without sliding=true it warns where the friction is below the slenderness.",
        "A drum touches its neighbours only; what comes down is not followed.",
        "Columns that are not as built are refused.",
    )

    def __post_init__(self) -> None:
        for key, allowed in (
            ("moment_law", LAWS),
            ("second_order", ("geometric", "law")),
            ("rotation", ("relative", "absolute")),
            ("idealisation", ("true", "prism")),
            ("critical_angle", ("stack", "drum")),
        ):
            check_choice(key, getattr(self, key), allowed)
        check_range("xi", self.xi, 0.0, 1.0, open_low=True, remedy="1 is the bi-linear law")
        check_range("stiffness_damping", self.stiffness_damping, 0.0, 1.0, unit="s")
        check_range("initial_rotation", self.initial_rotation, -1.0, 1.0, unit="rad")
        if self.restitution is not None:
            check_range("restitution", self.restitution, 0.0, 1.0, remedy="leave it out for Housner's own value")
        if self.time_step is not None:
            check_range("time_step", self.time_step, 0.0, 1.0, unit="s", open_low=True)
        housner = self.moment_law == "housner"
        if self.xi != 1.0 and self.moment_law != "trilinear":
            raise InputError(
                f"xi = {self.xi:g} is for moment_law=trilinear, not {self.moment_law}; leave one of them out."
            )
        if self.restitution is not None and not housner:
            raise InputError(
                f"restitution = {self.restitution:g} is for moment_law=housner, not {self.moment_law}: "
                "the other laws have no impact; leave it out, or use stiffness_damping."
            )
        if self.rotation == "absolute" and self.sliding:
            raise InputError(
                "rotation=absolute and sliding=true contradict each other: use rotation=relative with sliding."
            )
        if housner and (self.sliding or self.stiffness_damping > 0.0):
            raise InputError(
                "moment_law=housner is rigid and has no sliding or stiffness_damping; use bilinear or winkler."
            )

    @classmethod
    def paper(cls, **changes) -> RigidBeam:
        """As the paper has it: prisms of mean width, falling branch in the law with each drum's own α, no damping.

        The paper prints neither ξ nor whether it used two lines or three; ξ = 1 here. Keywords change single options.
        """
        settings: dict[str, Any] = {
            "moment_law": "bilinear", "second_order": "law", "rotation": "absolute", "idealisation": "prism",
            "critical_angle": "drum",
        }  # fmt: skip
        return cls(**(settings | changes))

    # -- the column as the model sees it ---------------------------------------------------------------------------

    def idealised(self, column: Column) -> Column:
        """The column with prisms of mean width, if the model is to see them."""
        return column.as_prism() if self.idealisation == "prism" else column

    def critical_angles(self, column: Column) -> np.ndarray:
        """α_i of the laws' branches [rad], shape (n,); ``column`` idealised."""
        matrices = BeamMatrices(column)
        if self.critical_angle == "drum":
            height = column.centroid_heights - column.joint_heights
        else:
            height = matrices.overturning * column.gravity / column.joint_weights
        return np.arctan2(0.5 * column.joint_widths, height)

    def joints(self, column: Column) -> np.ndarray:
        """The five numbers of each joint's law (``moment_law.py``), shape (5, n); ``column`` idealised."""
        stiffness = np.array([joint.normal_stiffness for joint in column.joints]) * column.joint_second_moments
        ultimate = column.joint_weights * 0.5 * column.joint_widths  # Baraldi et al., Eq. 6
        fall = ultimate / self.critical_angles(column)
        none = np.zeros(column.n)
        law = self.second_order == "law"
        if self.moment_law == "winkler":
            # N = k_n A φ_d d/2, for a rectangle and for a circle
            opening = column.joint_weights * 0.5 * column.joint_widths * column.joint_second_moments
            opening = opening / (stiffness * column.joint_areas * (0.5 * column.joint_widths) ** 2)
            return np.array([stiffness, ultimate, opening, none, -fall if law else none])
        if law:  # min(K|φ|, ξ M_u, M_u (1 − |φ|/α))
            return np.array([stiffness, self.xi * ultimate, none, ultimate, -fall])
        # the same, less what gravity does in the equations of motion: min(K|φ|, M_u (ξ + |φ|/α), M_u)
        rise = fall if self.moment_law == "trilinear" and self.xi < 1.0 else none
        return np.array([stiffness, self.xi * ultimate, rise, ultimate, none])

    def bed(self, column: Column) -> tuple[float, ...] | bool | None:
        """Choice of the law of lines or of the bed, see ``kernels/rigid_beam/moment_law.py``."""
        if self.moment_law != "winkler":
            return None
        from ...kernels.rigid_beam import moment_law

        return moment_law.circle() if column.section == "circular" else True

    def opening_rotations(self, column: Column) -> np.ndarray:
        """Rotation at which each joint leaves its elastic branch [rad], shape (n,); ``column`` idealised."""
        k, m1, s1, m2, s2 = self.joints(column)
        return s1 if self.moment_law == "winkler" else np.minimum(m1 / (k - s1), m2 / (k - s2))

    def stable_step(self, column: Column) -> float:
        """Largest time step that is not refused [s]; ``column`` idealised."""
        return STABLE / self.highest_rate(column)

    def longest_step(self, column: Column) -> float:
        """Time step for a column under a motion that is sampled finely enough [s]; ``column`` idealised."""
        return self.time_step or min(STEP_FACTOR / self.highest_rate(column), 0.01 / column.frequency_parameter)

    def step_for(self, column: Column, motion: Motion) -> float:
        """Time step for a column under a motion, whose samples it may pass over by a few [s]; ``column`` idealised."""
        return self.time_step or min(self.longest_step(column), MOST_SAMPLES * motion.dt)

    def highest_rate(self, column: Column) -> float:
        """Highest rate of the column with all joints closed, ω_max or faster where damped [1/s]; ``column`` idealised."""
        shear = None
        if self.sliding:
            shear = np.array([joint.shear_stiffness for joint in column.joints]) * column.joint_areas
        relative = self.rotation == "relative"
        highest = BeamMatrices(column).highest_frequency(self.joints(column)[0], 0.0, relative, shear)
        ratio = 0.5 * self.stiffness_damping * highest  # of critical damping; beyond 1 the faster of two rates counts
        return highest * max(1.0, ratio + math.sqrt(max(0.0, ratio**2 - 1.0)))

    def flutters(self, column: Column) -> bool:
        """Whether the closed column has complex frequencies, as laws in the rotations of single drums can have them."""
        return self.pack(column).flutters

    def block(self, column: Column) -> RockingBlock:
        """For ``housner``: the beam of one drum as a rocking block; rotation about the middle of its base."""
        seen = self.idealised(column)
        inertia = float(BeamMatrices(seen).mass[0, 0])
        arm, height = 0.5 * seen.base_width, seen.centroid_height
        alpha = arm / height if self.second_order == "geometric" else math.atan2(arm, height)
        e = max(0.0, seen.restitution) if self.restitution is None else self.restitution
        return RockingBlock(
            p=math.sqrt(seen.mass * seen.gravity * arm / (inertia * alpha)),
            alpha=alpha, restitution=e, inertia=inertia, gravity=seen.gravity, half_width=arm, height=seen.height,
            centroid_height=height, linear=True, push=alpha * height / arm,
        )  # fmt: skip

    def pack(self, column: Column) -> PackedBeam:
        """Everything about a column that the lanes need, computed once."""
        return _packed(self, column)


@lru_cache(64)
def _packed(model: RigidBeam, column: Column) -> PackedBeam:
    from .state import PackedBeam

    seen = model.idealised(column)
    return PackedBeam(
        column=seen,
        joints=model.joints(seen),
        bed=model.bed(seen),
        alpha=model.critical_angles(seen),
        opening=model.opening_rotations(seen),
        geometric=model.second_order == "geometric",
        relative=model.rotation == "relative",
        sliding=model.sliding,
        shear=np.array([joint.shear_stiffness for joint in seen.joints]) * seen.joint_areas,
        longest_step=model.longest_step(seen),
        fixed_step=model.time_step,
        stiffness_damping=model.stiffness_damping,
        initial_rotation=model.initial_rotation,
    )
