"""Joints: the law of contact between two faces, and what a rocking joint loses."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any

from ..constants import DEGREE
from ..errors import InputError, as_typed, check_choice, check_range, no_field, warn
from ..messages import say
from .drum import LENGTHS

#: A friction angle below this looks like a coefficient [degrees]; without friction both are 0.
SLIPPERIEST = 3.0

#: The two forms in which a joint holds its friction.
FRICTION = ("friction_angle", "friction_coefficient")


@dataclass(frozen=True)
class Joint:
    """Stiffness and strength of a dry joint, per unit of area; no tension.

    Parameters
    ----------
    normal_stiffness, shear_stiffness : float
        k_n and k_s [N/m³].
    friction_angle : float, optional
        φ [degrees].
    friction_coefficient : float, optional
        tan φ [-], instead of the angle; one of the two is needed, both are known afterwards.
    cohesion : float
        c [Pa], acts while the joint is in contact.
    ring_width : float, optional
        Width of the ring on which round faces carry, from their rims inward [m]: the middle of both faces is sunk
        (anathyrosis). The whole faces if left out. Known to ``dem3d`` with ``law="bed"``.

    Raises
    ------
    InputError
        A value is not finite or outside its range, or there is no friction, or angle and coefficient are not of the same.

    Warns
    -----
    OutOfRangeWarning
        A friction angle as small as a coefficient.
    """

    normal_stiffness: float
    shear_stiffness: float
    friction_angle: float | None = None
    friction_coefficient: float | None = None
    cohesion: float = 0.0
    ring_width: float | None = None

    def __post_init__(self) -> None:
        if self.ring_width is not None:
            width = check_range("ring_width", self.ring_width, *LENGTHS, unit="m", remedy="use SI units", of="a joint")
            object.__setattr__(self, "ring_width", width)
        remedy = "a rigid joint is approached by a large stiffness, such as 5e10"
        for name in ("normal_stiffness", "shear_stiffness"):
            value = check_range(name, getattr(self, name), 1.0, 1e15, unit="N/m³", remedy=remedy, of="a joint")
            object.__setattr__(self, name, value)
        object.__setattr__(self, "cohesion", check_range("cohesion", self.cohesion, 0.0, 1e9, unit="Pa", of="a joint"))
        angle, mu = self.friction_angle, self.friction_coefficient
        if mu is not None:
            mu = check_range("friction_coefficient", mu, 0.0, 1e6 if angle is None else math.inf, of="a joint")
        if angle is None:
            if mu is None:
                raise InputError(
                    "a joint has neither friction_angle [degrees] nor friction_coefficient [-]; give one of the two, such "
                    "as friction_angle = 35.0 of dry marble, or in a file the name of a material.",
                    "friction_angle",
                )
            angle = math.atan(mu) / DEGREE
        angle = check_range("friction_angle", angle, 0.0, 90.0, unit="degrees", open_high=True, of="a joint")
        if mu is None and 0.0 < angle < SLIPPERIEST:
            words = say(
                "friction_angle is {angle:g} degrees, and a coefficient is friction_coefficient: is the unit right?"
            )
            warn(words.of(angle=angle))
        if mu is None:
            mu = math.tan(angle * DEGREE)
        elif not math.isclose(angle, math.atan(mu) / DEGREE, rel_tol=1e-12, abs_tol=1e-12):
            raise InputError(
                f"friction_angle = {as_typed(self.friction_angle)} and friction_coefficient = "
                f"{as_typed(self.friction_coefficient)} are both given; give one of the two.",
                "friction_coefficient",
            )
        object.__setattr__(self, "friction_angle", angle)
        object.__setattr__(self, "friction_coefficient", mu)

    def changed(self, **changes: Any) -> Joint:
        """A copy with some fields changed; a friction given in one of its two forms takes the place of both."""
        own = [field.name for field in dataclasses.fields(self)]
        if unknown := changes.keys() - own:
            raise TypeError(no_field("a joint", min(unknown), own))
        if any(changes.get(name) is not None for name in FRICTION):
            changes = dict.fromkeys(FRICTION) | changes
        else:  # a friction of None is none that is given
            changes = {name: value for name, value in changes.items() if name not in FRICTION}
        return dataclasses.replace(self, **changes)

    @property
    def tan_phi(self) -> float:
        """tan φ [-]."""
        assert self.friction_coefficient is not None
        return self.friction_coefficient


def stated_fields(described: Any) -> dict[str, Any]:
    """Fields of a dataclass by name, less those that are None where None is what leaves them out.

    What is added to a description later, and not given, so leaves its digest what it was.
    """
    values = ((field, getattr(described, field.name)) for field in dataclasses.fields(described))
    return {field.name: value for field, value in values if value is not None or field.default is not None}


# -- What a rocking joint loses ---------------------------------------------------------------------------------------


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
