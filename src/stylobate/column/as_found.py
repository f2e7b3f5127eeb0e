"""Columns as they are found: drums offset and leaning, edges chipped, the base out of level."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from ..constants import DEGREE
from ..errors import InputError, check_range, check_whole

#: Edges that may be chipped.
SIDES = ("left", "right", "front", "back")


@dataclass(frozen=True)
class FoundDrum:
    """State as found of one drum.

    Parameters
    ----------
    drum : int
        Number of the drum, from 1 at the base.
    offset : float
        Of this drum, and of all that stands on it, along the joint under it [m]; positive to the right.
    tilt : float
        Lean of this drum, and of all that stands on it, out of the normal of the joint under it [degrees];
        counter-clockwise positive (the top goes to the left). The drum rests on its whole face: its bed is worn askew.
    offset_azimuth, tilt_azimuth : float
        The vertical plane of the offset and of the lean: its "right" lies at this azimuth, from x towards y [degrees].
        180 turns left and right round; every other one than 0 and 180 takes a model in space.
    turn : float
        Of this drum, and of all that stands on it, about its axis on the joint under it, from x towards y [degrees];
        takes a model in space.
    chip_left, chip_right : float
        Width that its lower face has lost along an edge, towards −x and x of the drum's own axes [m]; of a round face, the
        depth of the segment beyond a chord. The mass is taken as if nothing were lost.
    chip_front, chip_back : float
        The same towards −y and y [m]; of rectangular faces only, and they take a model in space.
    chip_azimuth : float
        Of a round drum: its "right" for chips lies at this azimuth, from its own x axis towards y [degrees]; every other one
        than 0 and 180 takes a model in space.

    Raises
    ------
    InputError
        A value outside its range.
    """

    drum: int
    offset: float = 0.0
    tilt: float = 0.0
    chip_left: float = 0.0
    chip_right: float = 0.0
    offset_azimuth: float = 0.0
    tilt_azimuth: float = 0.0
    turn: float = 0.0
    chip_front: float = 0.0
    chip_back: float = 0.0
    chip_azimuth: float = 0.0

    def __post_init__(self) -> None:
        check_whole("number of a drum as found", self.drum, 1, remedy="1 is at the base", field="found")
        for name, low, high, unit in (
            ("offset", -10.0, 10.0, "m"),
            ("tilt", -30.0, 30.0, "degrees"),
            *((f"chip_{side}", 0.0, 10.0, "m") for side in SIDES),
            ("offset_azimuth", -360.0, 360.0, "degrees"),
            ("tilt_azimuth", -360.0, 360.0, "degrees"),
            ("turn", -180.0, 180.0, "degrees"),
            ("chip_azimuth", -360.0, 360.0, "degrees"),
        ):
            value = check_range(
                name,
                getattr(self, name),
                low,
                high,
                unit=unit,
                of=f"drum {self.drum}",
                field=f"found.{self.drum}.{name}",
            )
            object.__setattr__(self, name, value)
        left = self.chip_left
        _into_plane(self, "offset", "offset_azimuth")
        _into_plane(self, "tilt", "tilt_azimuth")
        if abs(self.chip_azimuth) == 180.0:
            object.__setattr__(self, "chip_left", self.chip_right)
            object.__setattr__(self, "chip_right", left)
        if not self.chipped or self.chip_azimuth % 180.0 == 0.0:
            object.__setattr__(self, "chip_azimuth", 0.0)

    @property
    def in_plane(self) -> bool:
        """Whether a plane model can take it."""
        return not any(getattr(self, name) for name in _IN_SPACE)

    @property
    def chips(self) -> tuple[float, float, float, float]:
        """Widths lost to the left, the right, the front and the back [m]."""
        return self.chip_left, self.chip_right, self.chip_front, self.chip_back

    @property
    def chipped(self) -> bool:
        """Whether anything is lost."""
        return any(self.chips)


def _into_plane(state: Any, value: str, azimuth: str) -> None:
    """Give what lies in the plane of x and z the azimuth 0."""
    angle, amount = getattr(state, azimuth), getattr(state, value)
    if abs(angle) == 180.0:
        object.__setattr__(state, value, -amount)
    if amount == 0.0 or angle % 180.0 == 0.0:
        object.__setattr__(state, azimuth, 0.0)


@dataclass(frozen=True)
class AsFound:
    """State as found; positions are described along and normal to the base.

    Parameters
    ----------
    drums : sequence of FoundDrum
        Each drum at most once; drums left out are as built.
    base_tilt : float
        Slope of the base, counter-clockwise positive (it rises to the right) [degrees]. Pushover and limit analysis count
        theirs downhill to the right, where their forces push.
    base_azimuth : float
        Where the base rises to, from x towards y [degrees]; every other azimuth than 0 and 180 takes a model in space.

    Raises
    ------
    InputError
        A drum is given twice, or a value is outside its range.
    """

    drums: tuple[FoundDrum, ...] = ()
    base_tilt: float = 0.0
    base_azimuth: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "drums", tuple(sorted(self.drums, key=lambda drum: drum.drum)))
        numbers = [drum.drum for drum in self.drums]
        twice = next((number for number in numbers if numbers.count(number) > 1), None)
        if twice is not None:
            raise InputError(f"drum {twice} is given twice as found; give all of it at once.", f"found.{twice}")
        tilt = check_range("base_tilt", self.base_tilt, -45.0, 45.0, unit="degrees")
        object.__setattr__(self, "base_tilt", tilt)
        azimuth = check_range("base_azimuth", self.base_azimuth, -360.0, 360.0, unit="degrees")
        object.__setattr__(self, "base_azimuth", azimuth)
        _into_plane(self, "base_tilt", "base_azimuth")

    def __bool__(self) -> bool:
        return self.base_tilt != 0.0 or any(drum != _as_built(drum.drum) for drum in self.drums)

    @property
    def in_plane(self) -> bool:
        """Whether all of it lies in the plane of x and z, so that a plane model can take it."""
        return self.base_azimuth == 0.0 and all(drum.in_plane for drum in self.drums)

    def to_dict(self) -> dict[str, Any]:
        """All of it as plain values; what takes a model in space only where there is some."""
        drums = [
            {key: value for key, value in dataclasses.asdict(drum).items() if key not in _IN_SPACE or value != 0.0}
            for drum in self.drums
        ]
        plain: dict[str, Any] = {"drums": drums, "base_tilt": self.base_tilt}
        return plain | ({"base_azimuth": self.base_azimuth} if self.base_azimuth else {})

    def place(self, drum: int) -> tuple[float, float]:
        """How far the offsets up to a drum leave it from its place as built: amount [m], azimuth from 0 to 360 [degrees]."""
        each = [(state.offset, state.offset_azimuth * DEGREE) for state in self.drums if state.drum <= drum]
        x, y = (sum(size * way(angle) for size, angle in each) for way in (math.cos, math.sin))
        far = math.hypot(x, y)
        return (0.0, 0.0) if far < IN_LINE else (far, math.degrees(math.atan2(y, x)) % 360.0)

    def displaced(self, drum: int) -> bool:
        """Whether a drum is not where it was built on its base: shifted, leaning or turned, or on one that leans."""
        below = [state for state in self.drums if state.drum <= drum]
        turned = any(state.turn for state in below if state.drum == drum)
        return turned or any(state.tilt for state in below) or self.place(drum)[0] > 0.0

    def of(self, drum: int) -> FoundDrum:
        """State as found of a drum, numbered from 1."""
        return next((state for state in self.drums if state.drum == drum), None) or _as_built(drum)


@lru_cache(maxsize=256)
def _as_built(drum: int) -> FoundDrum:
    """A drum of this number with nothing found at it."""
    return FoundDrum(drum)


#: A drum that is nearer to its place than this stands in line: what a survey does not tell [m].
IN_LINE = 5e-4

#: Parts of a drum that a plane model cannot take.
_IN_SPACE = ("offset_azimuth", "tilt_azimuth", "turn", "chip_front", "chip_back", "chip_azimuth")

#: A column exactly as it was built: no offset, tilt, chip or slope.
AS_BUILT = AsFound()
