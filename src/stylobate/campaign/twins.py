"""Columns that could as well stand there, as far as a model can take them: twins of a column."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any, NamedTuple

from ..column.scatter import Scatter, usual_scatter
from ..column.structure import Structure
from ..column.twins import drawn_twins
from ..errors import InputError, check_kind
from ..messages import joined, say
from ..models.base import Model
from .campaign import MAX_TWINS, Campaign
from .unknown_laws import OF_ROUND, PARTS, drawn_laws, usual_with_laws

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
    asked = usual if campaign.scatter is None else campaign.scatter
    if unknown := [name for name in asked.given if name not in stands.scattered]:
        raise InputError(
            f"the scatter has {' and '.join(unknown).replace('_', ' ')}, by which twins of {column.described} such as "
            f"{column.name!r} do not vary; leave it out, known are {', '.join(stands.scattered)}.",
            "scatter",
        )
    left_out = tuple(name for name in asked.given if name in _not_taken(stands, model))
    size = dataclasses.replace(asked, **dict.fromkeys(left_out, 0.0))
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
    twins = [one for one, _ in drawn]
    if of_laws is None:
        one_law = stands.stack is not None and usual_with_laws(stands, model) != usual_scatter(stands)
        return Twins(twins, size, seed, left_out, stands.like, reduced, one_law=one_law)
    twins = [one.unwarned(losses=losses) for one, losses in zip(twins, of_laws.losses, strict=True)]
    return Twins(twins, size, seed, left_out, stands.like, reduced, of_laws.groups)


def _not_taken(stands: Structure, model: Model) -> tuple[str, ...]:
    """Parts of a scatter that change nothing in runs of what stands."""
    if model.is_plane(model.parameters()) or not model.varies_law:
        return (*model.not_scattered, *PARTS)
    return model.not_scattered if stands.section == "circular" else (*model.not_scattered, *OF_ROUND)
