"""What a rocking joint loses: losses by name, and those of one column where they differ from its model's."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import check_choice, check_range

#: Losses of a model by name; those of stone are in the table of materials.
NAMED = ("none", "stone")

#: Laws of round joints in space.
LAWS = ("rim", "bed")


@dataclass(frozen=True)
class Losses:
    """Losses and law of the joints of one column, in place of its model's (models in space).

    Parameters
    ----------
    stiffness_damping : float
        β [s].
    rolling_resistance : float
        c [-]; of round faces.
    law : {"rim", "bed"}, optional
        Of round faces; None for the model's.
    """

    stiffness_damping: float
    rolling_resistance: float = 0.0
    law: str | None = None

    def __post_init__(self) -> None:
        check_range("stiffness_damping of losses", self.stiffness_damping, 0.0, 1.0, unit="s")
        check_range("rolling_resistance of losses", self.rolling_resistance, 0.0, 1.0)
        if self.law is not None:
            check_choice("law of losses", self.law, LAWS)
