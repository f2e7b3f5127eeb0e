"""Stone and joints by name: published densities, friction and stiffness with their sources and their spread."""

from __future__ import annotations

import math
import re
from dataclasses import asdict, dataclass
from difflib import get_close_matches
from typing import Any

from ..bibliography import bibliography
from ..constants import DEGREE
from ..constants import g as STANDARD_GRAVITY
from ..errors import InputError
from .joint import Joint


@dataclass(frozen=True)
class Quantity:
    """A published number.

    Parameters
    ----------
    value, low, high : float
        What is taken, and the range that the source gives; all in ``unit``. Where it gives none, ``low`` and ``high`` are
        the value.
    unit : str
    source : str
        Key in the bibliography.
    note : str
        What it was measured on, and what this package made of it.
    """

    value: float
    low: float
    high: float
    unit: str
    source: str
    note: str

    @property
    def variation(self) -> float:
        """Coefficient of variation if the range is two standard deviations to either side [-]; 0 without a range."""
        return (self.high - self.low) / (4.0 * self.value)

    @property
    def cited(self) -> str:
        """Author and year of the source."""
        return bibliography()[self.source].cited


#: Parts of a joint that a material may know.
JOINT_VALUES = ("friction_coefficient", "normal_stiffness", "shear_stiffness", "cohesion")


@dataclass(frozen=True)
class Material:
    """A stone with the state of its joints; what nobody is known to have published is None.

    Parameters
    ----------
    stone, state : str
    density : Quantity
        [kg/m³]
    friction_coefficient : Quantity, optional
        [-]
    normal_stiffness, shear_stiffness : Quantity, optional
        [N/m³]
    cohesion : Quantity, optional
        [Pa]; that of a dry joint is 0.
    """

    stone: str
    state: str
    density: Quantity
    friction_coefficient: Quantity | None = None
    normal_stiffness: Quantity | None = None
    shear_stiffness: Quantity | None = None
    cohesion: Quantity | None = None

    @property
    def name(self) -> str:
        """As in files: ``marble, worn``."""
        return f"{self.stone}, {self.state}"

    @property
    def quantities(self) -> dict[str, Quantity]:
        """Known values, by name."""
        quantities = {name: getattr(self, name) for name in ("density", *JOINT_VALUES)}
        return {name: quantity for name, quantity in quantities.items() if quantity is not None}

    def joint_values(self, given: dict[str, Any], where: str = "[joint]") -> dict[str, Any]:
        """Fields of a joint of this material, those given by hand first.

        Parameters
        ----------
        given : dict
            Fields of :class:`Joint` by name; None where nothing is given.
        where : str
            What messages call the table that they come from.

        Raises
        ------
        InputError
            Something is neither given nor published.
        """
        stated = {name: value for name, value in given.items() if value is not None}
        known = {name: quantity.value for name, quantity in self.quantities.items() if name in JOINT_VALUES}
        if "friction_angle" in stated:
            known.pop("friction_coefficient", None)
        joint_values = known | stated
        if "friction_angle" not in joint_values and "friction_coefficient" not in joint_values:
            raise InputError(
                f"no friction of {self.name!r} is published in a source that is known here; add friction_angle to {where}."
            )
        for name in ("normal_stiffness", "shear_stiffness"):
            if name not in joint_values:
                raise InputError(
                    f"no {name} of {self.name!r} is published in a source that is known here; add it to {where} [N/m³]."
                )
        return joint_values

    def joint(self, **given: float) -> Joint:
        """The joint of this material; ``given`` overrides, by the names of :class:`Joint`."""
        return Joint(**self.joint_values(given, "the joint"))

    def to_dict(self) -> dict[str, Any]:
        """Under the names of the JSON object of ``stylobate materials``."""
        known = {name: asdict(quantity) | {"cited": quantity.cited} for name, quantity in self.quantities.items()}
        unknown = [name for name in ("density", *JOINT_VALUES) if name not in known and name != "cohesion"]
        return {"material": self.name, "stone": self.stone, "state": self.state, **known, "not_published": unknown}


def material(name: str) -> Material:
    """The material of that name: a stone, and the state of its joints behind a comma (dry if left out).

    Raises
    ------
    InputError
        There is none; the message gives the nearest names.
    """
    key = ", ".join(part.strip().lower() for part in str(name).split(","))
    entry = MATERIALS.get(key) or MATERIALS.get(f"{key}, dry")
    if entry is None:
        near = _nearest(key)
        nearest = f"the nearest are {', '.join(map(repr, near))}" if near else f"stones are {', '.join(_STONES)}"
        raise InputError(f"there is no material {name!r}; {nearest} (states are {', '.join(_STATES)}).")
    return entry


#: Likeness of two words of which one is taken for a misspelling of the other [-].
ALIKE = 0.75


def _nearest(key: str) -> list[str]:
    """Names of the materials whose stone a name holds, misspelt or not, in the states that it holds; dry without any."""
    words = re.findall(r"[^\W\d_]+", key)
    stones = [stone for word in words for stone in get_close_matches(word, _STONES, 1, ALIKE)]
    states = [state for state in _STATES if any(get_close_matches(word, state.split(), 1, ALIKE) for word in words)]
    return [f"{stone}, {state}" for stone in dict.fromkeys(stones) for state in states or ["dry"]]


def _unit_weight(low: float, high: float, source: str, note: str) -> Quantity:
    """A density from unit weights [kN/m³]."""
    low, high = (1000.0 * unit_weight / STANDARD_GRAVITY for unit_weight in (low, high))
    return Quantity(round(0.5 * (low + high), -1), round(low), round(high), "kg/m³", source, note)


_STONES = {
    "marble": Quantity(
        2700.0, 2680.0, 2710.0, "kg/m³", "anthony2003", "calcite without pores, less up to 1 % of pores (chosen here)"
    ),
    "limestone": _unit_weight(20.0, 29.0, "en1991", "dense limestone, unit weight 20 to 29 kN/m³"),
    "tuff": _unit_weight(13.0, 16.0, "circolare2019", "masonry of soft stone (tuff, calcarenite), 13 to 16 kN/m³"),
    "granite": Quantity(2667.0, 2516.0, 2809.0, "kg/m³", "daly1966", "mean and range of 155 samples"),
    "sandstone": _unit_weight(21.0, 27.0, "en1991", "sandstone, unit weight 21 to 27 kN/m³"),
}

#: Basic friction angles of flat unweathered surfaces, from and to [degrees]: dry, wet, and what they were measured on.
_BASIC = {
    "marble": ((31.0, 37.0), (27.0, 35.0), "limestone, the same mineral; none of marble is in the source"),
    "limestone": ((31.0, 37.0), (27.0, 35.0), "limestone"),
    "granite": ((31.0, 35.0), (29.0, 33.0), "fine and coarse granite"),
    "sandstone": ((26.0, 35.0), (25.0, 34.0), "sandstone"),
}

#: Rebound of a Schmidt hammer on a worn face over that on a fresh one, from and to [-]: chosen here, not measured.
WORN = (0.7, 0.9)

_STATES = ("dry", "wet", "worn", "mortared", "lead sheet")


def _friction(stone: str, state: str) -> Quantity | None:
    if state == "mortared":
        return Quantity(0.4, 0.4, 0.4, "-", "en1996", "characteristic value in Eq. 3.5, general purpose mortar")
    if state == "lead sheet" or stone not in _BASIC:
        return None
    dry, wet, what = _BASIC[stone]
    low, high = wet if state == "wet" else dry
    note = f"flat {'wet' if state == 'wet' else 'dry'} surfaces of {what}, {low:g} to {high:g} degrees"
    if state == "worn":
        # Barton and Choubey (1977): residual angle (φ_b − 20°) + 20° r/R
        low, high = (basic - 20.0 + 20.0 * ratio for basic, ratio in zip((low, high), WORN, strict=True))
        note += (
            f"; weathered, rebound {WORN[0]:g} to {WORN[1]:g} of the fresh stone's (chosen here): {low:g} to {high:g}"
        )
    middle, least, most = (math.tan(angle * DEGREE) for angle in (0.5 * (low + high), low, high))
    return Quantity(middle, least, most, "-", "barton1977", note)


def _stiffness(state: str, value: float) -> Quantity | None:
    if state in ("mortared", "lead sheet"):
        return None
    note = "what the column of drums was computed with there; measured ones scatter by orders of magnitude"
    return Quantity(value, value, value, "N/m³", "baraldi", note)


def _cohesion(state: str) -> Quantity | None:
    if state != "mortared":
        return None
    note = "initial shear strength of dimensioned natural stone, general purpose mortar, Table 3.4: M1 to M20"
    return Quantity(1.0e5, 1.0e5, 2.0e5, "Pa", "en1996", note + "; that of the weakest mortar is taken")


#: Velocity restitution of an impact of a rocking block of stone over Housner's [-].
IMPACT = Quantity(
    1.0, 0.95, 1.05, "-", "elgawady2007",
    "concrete on concrete 0.95 (aspect ratio 5) and 0.97 (3); other tests lie above 1 (Kalliontzis et al. 2016), "
    "by how much is chosen here as 0.05: Housner's own value lies between, and joints here lose no more than that",
)  # fmt: skip

#: Resistance to rolling c of a round face of stone on its rim, see ``DistinctElement3D`` [-].
ROLLING = Quantity(
    0.003, 0.0005, 0.03, "-", "petrie2002",
    "nobody is known to have measured it on stone: chosen here, between discs of polished metal, whose coin wobbles for ten "
    "seconds and whose toy for a hundred (c = 3e-3 and 5e-4), and ten times as much",
)  # fmt: skip

#: Damping β of a contact of stone [s]: how long one lasts.
CONTACT = Quantity(
    3e-4, 1e-4, 1e-3, "s", "srinivasan2008",
    "nobody is known to have measured it on drums: chosen here, as verdicts of round columns hang on it between these; "
    "a can that seems to rock rolls round its rim if its contact is shorter than that takes",
)  # fmt: skip

#: What stone loses, whatever its kind, by name.
LOST = {"impact_over_housner": IMPACT, "rolling_resistance": ROLLING, "stiffness_damping": CONTACT}

#: Stiffness of joints that nobody has measured: k_n from a third of the softest that a published model of a monument has
#: (the temple of Évora, 2.95e9) [N/m³] to that of the stone between two joints, E/h of a drum of height h, with a modulus
#: of elasticity [Pa] that is chosen here, as no source of the stiffest stone could be read.
SOFTEST_JOINT, STIFFEST_STONE = 1e9, 100e9

#: All materials by name.
MATERIALS = {
    f"{stone}, {state}": Material(
        stone,
        state,
        density,
        _friction(stone, state),
        _stiffness(state, 5.0e10),
        _stiffness(state, 2.5e10),
        _cohesion(state),
    )
    for stone, density in _STONES.items()
    for state in _STATES
}
