"""Presets: the columns of the catalogue by name."""

from __future__ import annotations

from pathlib import Path

from ..errors import InputError, suggest
from .catalogue import CATALOGUE, KnownColumn
from .column import Column

#: Young's modulus of the blocks in the paper [Pa]; see ``DistinctElement2D(block_modulus=…)``.
PAPER_BLOCK_MODULUS = 2.5e9

#: The paper's two columns (Baraldi et al., section 3).
PAPER = ("paper-monolithic", "paper-12-drums")

PRESETS = tuple(CATALOGUE)

#: Assemblies by name: files, with source and licence in their first lines.
ASSEMBLIES = {"evora": Path(__file__).with_name("evora.toml")}


def known_column(name: str) -> KnownColumn:
    """What the catalogue knows of the column of that name: its figures with their sources.

    Raises
    ------
    InputError
        There is no preset of that name.
    """
    if name not in CATALOGUE:
        raise InputError(
            f"there is no column preset {name!r}; {suggest(name, PRESETS)}presets are {', '.join(PRESETS)}.", "columns"
        )
    return CATALOGUE[name]


def preset(name: str) -> Column:
    """The column preset of that name.

    Raises
    ------
    InputError
        There is no preset of that name.
    """
    return known_column(name).column
