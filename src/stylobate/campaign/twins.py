"""Columns that could as well stand there, as far as a model can take them: twins of a column.

What nobody knows of the joints of a column (damping, rolling, stiffness, where a round face carries) is drawn likewise. Half
of its variance is common to all twins of one law, since all joints of all of them are of one stone; the other half is each
twin's own. Three twins in a row share a law, so that what differs between laws can be told from what differs within.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..column.column import Column
from ..column.joint import LAWS, Losses
from ..column.materials import CONTACT, ROLLING, SOFTEST_JOINT, STIFFEST_STONE
from ..column.scatter import WITHIN, Scatter, drawn_twins, spread_of, usual_scatter
from ..column.structure import Structure
from ..errors import InputError, check_kind
from ..messages import joined, say
from ..models.base import Model
from ..models.engine import engine_for
from .campaign import MAX_TWINS, Campaign

#: Column of a table of runs: the number of the law of the joints, where it varies.
LAW = "law_of_joints"


class Twins(NamedTuple):
    """Columns like one, or assemblies, that a model can take: scatter, seed, what of it is left out, what they are.

    ``reduced`` is the number of assemblies whose offsets were halved or left out because their stones would have overlapped;
    ``groups`` the law of the joints of each, where it varies; ``one_law`` says that it could and does not.
    """

    columns: Sequence[Any]
    scatter: Scatter
    seed: int
    left_out: tuple[str, ...]
    like: str = "columns"
    reduced: int | None = None
    groups: tuple[int, ...] = ()
    one_law: bool = False

    def law_of(self, number: int) -> dict[str, int]:
        """Law of the joints of a twin, as a column of a table of runs; empty where all have that of the structure itself."""
        return {LAW: self.groups[number] + 1} if self.groups else {}

    @property
    def words(self) -> str:
        """How many there are and how they differ."""
        reduced = (
            f"; in {self.reduced} the offsets are halved or left out, as stones would overlap" if self.reduced else ""
        )
        law = "; the law of their joints is taken as known" if self.one_law else ""
        return described(len(self.columns), self.scatter, self.seed, self.left_out) + reduced + law

    @property
    def facts(self) -> dict[str, Any]:
        """Differences, under the names of the JSON objects of commands."""
        return {
            "like": self.like,
            "scatter": dataclasses.asdict(self.scatter),
            "left_out": list(self.left_out),
            "seed": self.seed,
            **({"laws": len(set(self.groups))} if self.groups else {}),
            **({"law_taken_as_known": True} if self.one_law else {}),
            **({} if self.reduced is None else {"offsets_reduced": self.reduced}),
        }


def described(number: int, scatter: Scatter, seed: int, left_out: Sequence[str]) -> str:
    """Number of twins and their differences, in words."""
    words = say("{count} that vary by {scatter}; seed {seed}", count=number, scatter=scatter.describe(), seed=str(seed))
    return words + without(left_out)


def without(left_out: Sequence[str]) -> str:
    """Parts of a scatter that a model leaves out, in words."""
    names = joined(", ", (say(name.replace("_", " ")) for name in left_out))
    return say(", without {names}, which the model does not take", names=names) if left_out else ""


def the_twins(column: Structure, model: Model, campaign: Campaign, *, alone: bool = True, laws: bool = True) -> Twins:
    """Twins of a column that the model can take; not ``alone`` where more than the columns differs.

    Where no scatter is asked for, those of columns in space differ by the ``laws`` of their joints as well, unless what is
    made of them takes these as known.
    """
    check_kind("column", column, Structure)
    check_kind("model", model, Model)
    stands, replicates, seed = column.stack or column, campaign.replicates, campaign.seed
    if not stands.scattered:
        raise InputError(
            f"{column.name!r} is {column.described}, and only columns and assemblies in space have twins; leave "
            "`replicates` out.",
            "replicates",
        )
    if not replicates:
        raise InputError(f"replicates is 0; allowed is a whole number from 1 to {MAX_TWINS}.")
    usual = usual_with_laws(stands, model) if laws else usual_scatter(stands)
    scatter = usual if campaign.scatter is None else campaign.scatter
    if unknown := [name for name in scatter.given if name not in stands.scattered]:
        raise InputError(
            f"the scatter has {' and '.join(unknown).replace('_', ' ')}, by which twins of {column.described} such as "
            f"{column.name!r} do not vary; leave it out, known are {', '.join(stands.scattered)}.",
            "scatter",
        )
    left_out = tuple(name for name in scatter.given if name in _not_taken(stands, model))
    size = dataclasses.replace(scatter, **dict.fromkeys(left_out, 0.0))
    if alone and not size.given:  # as many runs of one column are no population
        why = f", as {model.name} does not take {' and '.join(left_out)}" if left_out else ""
        raise InputError(
            f"nothing scatters{why}; give at least one coefficient of variation above 0, such as friction=10%."
        )
    space = not model.is_plane(model.parameters())
    of_laws = drawn_laws(stands, model, size, replicates, seed) if any(getattr(size, name) for name in PARTS) else None
    stiffness = None if of_laws is None else of_laws.stiffness
    drawn = drawn_twins(stands, size, replicates, seed, space=space, stiffness=stiffness)
    reduced = None if stands.space_joints is None else sum(share < 1.0 for _, share in drawn)
    twins = [twin for twin, _ in drawn]
    if of_laws is None:
        one_law = stands.stack is not None and usual_with_laws(stands, model) != usual_scatter(stands)
        return Twins(twins, size, seed, left_out, stands.like, reduced, one_law=one_law)
    laws_of = zip(twins, of_laws.losses, of_laws.factors.tolist(), strict=True)
    twins = [with_stiffness(twin, factor).unwarned(losses=losses) for twin, losses, factor in laws_of]
    return Twins(twins, size, seed, left_out, stands.like, reduced, of_laws.groups)


def _not_taken(stands: Structure, model: Model) -> tuple[str, ...]:
    """Parts of a scatter that change nothing in runs of what stands."""
    engine = engine_for(model, stands)
    laws = PARTS if not engine.draws_laws else () if stands.section == "circular" else OF_ROUND
    return *engine.not_scattered, *laws


#: Parts of a scatter that are laws of joints, of models in space; those of round faces alone.
PARTS = ("stiffness_damping", "unknown_stiffness", "rolling_resistance", "law")
OF_ROUND = PARTS[2:]

#: Twins of one law.
PER_LAW = 3

#: Damping below which joints count as undamped [s]: their twins vary about that of a contact of stone.
UNDAMPED = 1e-6

#: Root of x⁵ = x + 1: its powers spread laws evenly over four unknowns, however many there are.
EVENLY = 1.1673039782614187


class Laws(NamedTuple):
    """Laws of the joints of twins.

    Parameters
    ----------
    groups : tuple of int
        Law of each twin.
    stiffness : array
        Draw of the stiffness of each twin that its law decides [-].
    factors : array
        By which the joints of each twin are stiffer, as their stiffness is unknown [-].
    losses : tuple of Losses
    """

    groups: tuple[int, ...]
    stiffness: np.ndarray
    factors: np.ndarray
    losses: tuple[Losses, ...]


def usual_with_laws(structure: Structure, model: Model) -> Scatter:
    """Scatter of what stands where nobody states it: of what a survey does not know, and of the laws of joints in space."""
    usual, column = usual_scatter(structure), structure.stack
    if not engine_for(model, structure).draws_laws:
        return usual
    laws: dict[str, Any] = {"unknown_stiffness": 1.0, "stiffness_damping": 0.8}
    if column.section == "circular":
        laws |= {"rolling_resistance": 0.8} | ({"law": 0.5} if on_rim_or_bed(column) else {})
    return dataclasses.replace(usual, **laws)


def on_rim_or_bed(column: Column) -> bool:
    """Whether the faces of a column may as well carry on their rims as on their beds: whole round ones without rings."""
    chipped = any(drum.chipped for drum in column.as_found.drums)
    return column.section == "circular" and not column.on_rings and not chipped


def groups_of(size: Scatter, number: int) -> tuple[int, ...]:
    """Law of each of so many twins; empty where all have that of their column."""
    return tuple(k // PER_LAW for k in range(number)) if any(getattr(size, name) for name in PARTS) else ()


def drawn_laws(column: Structure, model: Model, size: Scatter, number: int, seed: int) -> Laws:
    """Laws of so many twins of a column; law g of a seed is the same for any number of them."""
    from scipy.special import ndtri

    acting: Any = model.acting(column)  # type: ignore[attr-defined]
    groups = np.array(groups_of(size, number))
    stream = np.random.default_rng([seed, 1])
    even = (stream.random(4) + np.outer(groups + 1, EVENLY ** -np.arange(1.0, 5.0))) % 1.0
    common = np.clip(ndtri(even[:, :3]), -WITHIN, WITHIN)
    own = np.clip(stream.standard_normal((number, 2)), -WITHIN, WITHIN)
    both = math.sqrt(0.5) * (common[:, :2] + own)
    damping, rolling = acting.damping(column), acting.rolling_resistance
    damping = damping if damping > UNDAMPED or not size.stiffness_damping else CONTACT.value
    rolling = rolling if rolling or not size.rolling_resistance else ROLLING.value
    beta = damping * np.exp(spread_of(size.stiffness_damping) * both[:, 0])
    c = rolling * np.exp(spread_of(size.rolling_resistance) * both[:, 1])
    other = {name: LAWS[1 - i] for i, name in enumerate(LAWS)}[acting.law]
    law = np.where(even[:, 3] < size.law, other, acting.law)
    losses = tuple(Losses(*each) for each in zip(beta.tolist(), c.tolist(), law.tolist(), strict=True))
    factors = unknown_stiffness(column, even[:, 2]) ** size.unknown_stiffness
    stiffness = common[:, 2] * (size.unknown_stiffness == 0.0)
    return Laws(groups_of(size, number), stiffness, factors, losses)


def unknown_stiffness(column: Any, share: np.ndarray) -> np.ndarray:
    """Factors on the stiffness of a column's joints, shape of ``share``.

    Evenly in the logarithm from 1e9 N/m³ (share 0) to that of the stone between joints (1), E over the mean height of the
    drums; of joints that differ the geometric mean has that.
    """
    own = float(np.exp(np.mean([math.log(joint.normal_stiffness) for joint in column.joints])))
    stone = max(STIFFEST_STONE / float(column.heights.mean()), SOFTEST_JOINT)
    return SOFTEST_JOINT * (stone / SOFTEST_JOINT) ** share / own


def with_stiffness(column: Any, factor: float) -> Any:
    """A column with both stiffnesses of all joints multiplied."""
    if factor == 1.0:
        return column
    return column.unwarned(
        joints=tuple(
            joint.changed(
                normal_stiffness=factor * joint.normal_stiffness, shear_stiffness=factor * joint.shear_stiffness
            )
            for joint in column.joints
        )
    )
