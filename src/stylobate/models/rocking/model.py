"""Housner's block: one rigid block that rocks about its corners; the closed-form ruler for every other model."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from ...column import Column
from ...errors import InputError, check_range, warn
from ...messages import say
from ...motion import Motion
from ...response import Measures, Response
from ..base import Case, Model, RunOptions
from ..engine import Engine
from .block import RockingBlock, warn_of_free_flight, warn_sliding

#: Slenderness beyond which the linearised equation departs visibly from the nonlinear one [rad]; Housner's own limit.
SLENDER = math.radians(20.0)


class Rocking(Engine):
    """One block that rocks, by steps of one length with impacts located; single runs and batches alike."""

    def expected_step(self, motion: Motion) -> tuple[float, float]:
        """Time step of a run, and what a step of a single one costs [s]."""
        from .lanes import COST, steps_of

        return steps_of(self.model, self.model.block(self.structure), motion)[1], COST

    def run(self, motion: Motion, options: RunOptions) -> Response:
        """One run with histories."""
        from .lanes import run_one

        histories, measures = run_one(self.model, self.structure, motion, options)
        return Response(self.structure, histories, measures, self.model.name, {})

    def run_many(self, cases: Sequence[Case], options: RunOptions, threads: int) -> Iterator[tuple[int, Measures]]:
        """Many runs by the lane kernel, impacts located."""
        from .lanes import run_blocks

        return run_blocks(self.model, cases, options, threads)


class HousnerRocking(Rocking):
    """The block of :class:`HousnerBlock`."""

    @property
    def not_scattered(self) -> tuple[str, ...]:
        """Of a block that neither slides nor has elastic joints."""
        return *super().not_scattered, "friction", "joint_stiffness", "density"

    def check(self, motion: Motion) -> None:
        """Refuse columns of several drums; warn outside the declared limits."""
        super().check(motion)
        column, model = self.structure, self.model
        if column.n != 1:
            raise InputError(
                f"the model housner computes one block, and {column.name!r} has {column.n} drums; "
                "use rigid-beam, rigid-block or dem2d."
            )
        block = model.block(column)
        if abs(model.initial_rotation) >= block.alpha:
            raise InputError(
                f"initial_rotation is {model.initial_rotation:g} rad; allowed is less than the slenderness "
                f"{block.alpha:g} rad, beyond which the block falls by itself."
            )
        if model.time_step is not None and model.time_step > 0.2 / block.p:
            raise InputError(
                f"time_step is {model.time_step:g} s; allowed is up to {0.2 / block.p:.3g} s (0.2/p) for this block."
            )
        warn_sliding(column, block.alpha, model.name, say("dem2d has sliding"))
        if model.linear and block.alpha > SLENDER:
            stocky = say("the slenderness is {alpha:.1f}°; the linearised equation is for up to 20°.")
            warn(stocky.of(alpha=math.degrees(block.alpha)))
        if model.restitution is None and column.restitution < 0.0:
            warn(
                say(
                    "Housner's restitution of this stocky block is {column.restitution:.2f}, below zero: 0 is used, and the "
                    "block stops at its first impact.",
                    column=column,
                )
            )
        warn_of_free_flight(column, motion)


@dataclass(frozen=True)
class HousnerBlock(Model):
    """One rigid block on a rigid base, rocking about its two base corners without sliding or bouncing.

    Parameters
    ----------
    restitution : float, optional
        e: angular velocity after an impact over the one before, 0 to 1 [-]. By default Housner's value
        e = 1 − 2 m b²/I₀ from the true inertia of the block.
    linear : bool
        Linearise the equation in the rotation (slender blocks).
    initial_rotation : float
        Rotation from which the block is let go at rest, counter-clockwise positive [rad].
    time_step : float, optional
        Time step [s]. By default 0.01/p, at most 4 samples of the motion, and such that the motion is a whole number of
        steps.

    Raises
    ------
    InputError
        A value outside its range.

    Notes
    -----
    θ̈ = −p² {(1 + a_v/g) sin(α sgn θ − θ) + (a_g/g) cos(α sgn θ − θ)}, p² = m g R/I₀; at θ = 0 the velocity is
    multiplied by e. A block at rest starts to rock when |a_g| cos α > (g + a_v) sin α. After an impact slower than
    1e-5 p α it is at rest.

    *Collapsed* means: rotated beyond α, moving outward, and so far that the largest acceleration left in the motion
    cannot bring it back; or, at the end of the run, moving outward with more energy than it takes to go over.
    *Decided* is a run that collapsed, or that ends with less energy than it takes to go over, what the ledger cannot
    account for included.

    Limits: rigid, no sliding (tan α below the friction coefficient), no free flight (vertical acceleration below g).

    References
    ----------
    Housner 1963; Yim, Chopra and Penzien 1980.
    """

    engines: ClassVar[tuple[Any, ...]] = (HousnerRocking,)

    restitution: float | None = None
    linear: bool = False
    initial_rotation: float = 0.0
    time_step: float | None = None

    name: ClassVar[str] = "housner"
    title: ClassVar[str] = "Housner's rocking block"
    references: ClassVar[tuple[str, ...]] = ("housner1963", "yim1980")
    assumptions: ClassVar[tuple[str, ...]] = (
        "Block and base are rigid; the block has the column's true mass, centroid, inertia and base width.",
        "It pivots about one of its two base corners: no sliding, no bouncing, no free flight.",
        "An impact is instantaneous, acts at the new corner and multiplies the velocity by the restitution e.",
        "Plane motion: a circular column rolls on its rim in truth.",
    )
    limits: ClassVar[tuple[str, ...]] = (
        "Columns of several drums, and columns that are not as built, are refused.",
        "With tan α above the friction coefficient the block would slide before it rocks (a warning).",
        "With a vertical acceleration below −1 g the block leaves the ground: the run fails, unless the block lies by then.",
        "linear=true is for slender blocks; beyond 20° it warns.",
        "For stocky blocks Housner's e is below zero; 0 is used, with a warning.",
    )

    def __post_init__(self) -> None:
        if self.restitution is not None:
            value = check_range(
                "restitution", self.restitution, 0.0, 1.0, remedy="leave it out for Housner's own value"
            )
            object.__setattr__(self, "restitution", value)
        check_range("initial_rotation", self.initial_rotation, -math.pi / 2, math.pi / 2, unit="rad")
        if self.time_step is not None:
            check_range("time_step", self.time_step, 0.0, 1.0, unit="s", open_low=True)

    def block(self, column: Column) -> RockingBlock:
        """The numbers of the rocking equation for a column of one drum."""
        e = max(0.0, column.restitution) if self.restitution is None else self.restitution
        return RockingBlock(
            p=column.frequency_parameter,
            alpha=column.slenderness,
            restitution=e,
            inertia=column.corner_inertia,
            gravity=column.gravity,
            half_width=0.5 * column.base_width,
            height=column.height,
            centroid_height=column.centroid_height,
            linear=self.linear,
        )
