"""The engine of bodies in space of which any two may touch, and what an impact of one that rocks alone leaves."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from ...column import Column
from ...column.spatial.assembly import SpatialAssembly
from ...column.spatial.stone import Stone
from ...errors import InputError
from ...motion import Motion
from ...response import Measures, Response
from ..base import Case, RunOptions
from ..drums.impact import TRIED, longest, undamped
from ..drums.losses import with_provenance
from ..drums.stepped import StackEngine, SteppedEngine
from ..engine import engine_for
from .assemblies import COST, SpatialNumbers, engine_of, run_in_space, step_for
from .lanes import IntactLanes, measures_in_space


def rocking_stone(body: Column, model: Any, tilt: float) -> Iterator[np.ndarray]:
    """Leans of a stone of the same sides; see :data:`stylobate.models.drums.impact.Rocking`."""
    drum, foot = body.drums[0], (0.0, 0.0, 0.0)
    width, height = drum.bottom_width, drum.height
    if drum.section == "circular":
        stone = Stone.drum(width, drum.top_width, height, foot, drum.density, name=body.name)
    else:
        stone = Stone.box((width, drum.depth, height), foot, drum.density, name=body.name)
    alone = SpatialAssembly((stone,), body.joint_laws[0], gravity=body.gravity)
    numbers = engine_for(replace(model, **undamped()), alone).numbers
    lanes = IntactLanes(lambda _: numbers, RunOptions())
    case = Case(alone, longest(alone))
    for lane in range(len(TRIED)):
        lanes.load(lane, case)
    _lean(lanes, tilt, 0.5 * width)
    lanes.lane["beta"][0, : len(TRIED)] = TRIED
    while not lanes.is_over(0):
        lanes.kernel.advance(lanes.state, 1)
        yield np.arcsin(_axes(lanes)[: len(TRIED), 0, 2])


def _axes(lanes: IntactLanes) -> np.ndarray:
    """Axes of the stone in each lane as columns, shape (lanes, 3, 3)."""
    stone = lanes.body[1]
    principal = np.array([[stone[axis + c] for axis in "ijk"] for c in "xyz"])
    return np.einsum("cal,bal->lcb", principal, lanes.turn[1])


def _lean(lanes: IntactLanes, tilt: float, half: float) -> None:
    """Turn the stone in all lanes about its edge (or the point of its rim) at ``half`` towards +x."""
    stone, (c, s) = lanes.body[1], (math.cos(tilt), math.sin(tilt))
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    principal = np.einsum("dc,lcb,bal->dal", turn, _axes(lanes), lanes.turn[1])
    for (d, name), (a, axis) in itertools.product(enumerate("xyz"), enumerate("ijk")):
        stone[axis + name][:] = principal[d, a]
    stone["x"][:], stone["z"][:] = half - half * c + stone["z"] * s, half * s + stone["z"] * c


class BodiesInSpace(SteppedEngine):
    """Assemblies in space: in lanes as long as nothing of them comes loose, one by one from there on."""

    computes = (SpatialAssembly,)
    takes = frozenset({"as found", "rings"})
    links = StackEngine.links | {"clamp"}
    rocking = staticmethod(rocking_stone)

    #: Parameters of a model in space that act on columns alone.
    of_columns = ("law", "pivot_friction", "rolling_resistance", "planar", "block_modulus", "mass_damping")

    def check(self, motion: Motion) -> None:
        """Refuse parameters that do nothing."""
        super().check(motion)
        default = {field.name: field.default for field in fields(self.model)}
        given = next((name for name in self.of_columns if getattr(self.model, name) != default[name]), None)
        if given is not None:
            name = self.structure.name
            raise InputError(
                f"{given} is {getattr(self.model, given)!r}, which assemblies in space such as {name!r} do not know; "
                "leave it out."
            )

    def check_start(self) -> None:
        """Refuse a start from a pose."""
        what = self.structure
        raise InputError(
            f"a start from a pose is for columns, and {what.name!r} is {what.described}; give its bodies "
            "orientations and velocities, and leave start out."
        )

    def check_length(self, motion: Motion, options: RunOptions) -> None:
        """The step of what may come loose is known once its contacts are: each run asks for itself."""

    def followed(self) -> SpatialAssembly:
        """The assembly: any two bodies may strike each other."""
        return self.structure

    @property
    def numbers(self) -> SpatialNumbers:
        """What the assembly is computed with."""
        model = self.model
        damping = self.acting.stiffness_damping
        return SpatialNumbers(model.name, damping, model.step_factor, model.time_step, model.restitution)

    def expected_step(self, motion: Motion) -> tuple[float, float]:
        """Time step, and about what a step costs on one core as long as all stands, both [s]; what falls is dearer."""
        del motion
        numbers = self.numbers
        loose = engine_of(self.structure, numbers, 1.0)
        return step_for(loose, self.structure, numbers), COST * len(loose.body)

    def run(self, motion: Motion, options: RunOptions) -> Response:
        """One run with histories, down to the ground."""
        return with_provenance(self, motion, run_in_space(self.structure, motion, self.numbers, options))

    def run_many(self, cases: Sequence[Case], options: RunOptions, threads: int) -> Iterator[tuple[int, Measures]]:
        """Many runs in lanes, as long as nothing comes loose."""
        return measures_in_space(lambda one: engine_for(self.model, one).numbers, cases, options, threads)
