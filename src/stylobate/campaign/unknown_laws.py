"""What nobody knows of the joints of a column, drawn for its twins: damping, rolling, stiffness, where a round face carries.

Half of the variance is common to all twins of one law, since all joints of all of them are of one stone; the other half is
each twin's own. Three twins in a row share a law, so that what differs between laws can be told from what differs within.
"""

from __future__ import annotations

import dataclasses
import math
from typing import Any, NamedTuple

import numpy as np

from ..column.column import Column
from ..column.losses import LAWS, Losses
from ..column.materials import CONTACT, ROLLING
from ..column.scatter import WITHIN, Scatter, spread_of, usual_scatter
from ..column.structure import Structure
from ..models.base import Model
from ..models.engine import engine_for

#: Parts of a scatter that are laws of joints, of models in space; those of round faces alone.
PARTS = ("stiffness_damping", "rolling_resistance", "law")
OF_ROUND = PARTS[1:]

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
    losses : tuple of Losses
    """

    groups: tuple[int, ...]
    stiffness: np.ndarray
    losses: tuple[Losses, ...]


def usual_with_laws(structure: Structure, model: Model) -> Scatter:
    """Scatter of what stands where nobody states it: of what a survey does not know, and of the laws of joints in space."""
    usual, column = usual_scatter(structure), structure.stack
    if not engine_for(model, structure).draws_laws:
        return usual
    laws: dict[str, Any] = {"joint_stiffness": 1.0, "stiffness_damping": 0.8}
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
    other = {one: LAWS[1 - i] for i, one in enumerate(LAWS)}[acting.law]
    law = np.where(even[:, 3] < size.law, other, acting.law)
    losses = tuple(Losses(*each) for each in zip(beta.tolist(), c.tolist(), law.tolist(), strict=True))
    return Laws(groups_of(size, number), common[:, 2], losses)
