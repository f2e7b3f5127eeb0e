"""The paper's two columns by name (Baraldi et al., section 3)."""

from __future__ import annotations

from ..errors import InputError
from .column import Column
from .joint import Joint

_DRUMS = {"paper-monolithic": 1, "paper-12-drums": 12}

#: Young's modulus of the blocks in the paper [Pa]; see ``DistinctElement2D(block_modulus=…)``.
PAPER_BLOCK_MODULUS = 2.5e9

PRESETS = tuple(_DRUMS)


def preset(name: str) -> Column:
    """The column preset of that name.

    Raises
    ------
    InputError
        There is no preset of that name.
    """
    if name not in _DRUMS:
        raise InputError(f"there is no column preset {name!r}; presets are {', '.join(PRESETS)}.")
    # Baraldi et al., section 3. The friction coefficient is not printed in the paper; 0.70 is this package's choice.
    return Column.tapered(
        height=5.0,
        bottom_width=0.96,
        top_width=0.66,
        drums=_DRUMS[name],
        density=1600.0,
        joint=Joint(normal_stiffness=5.0e10, shear_stiffness=2.5e10, friction_coefficient=0.70),
        section="rectangular",
        depth=1.0,
        name=name,
    )
