"""Columns as they are found: drums offset and leaning, edges chipped, the base out of level."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import InputError, check_range


@dataclass(frozen=True)
class FoundDrum:
    """What is not as built at one drum.

    Parameters
    ----------
    drum : int
        Number of the drum, from 1 at the base.
    offset : float
        Of this drum, and of all that stands on it, along the joint under it [m]; positive to the right.
    tilt : float
        Lean of this drum, and of all that stands on it, out of the normal of the joint under it [degrees];
        counter-clockwise positive (the top goes to the left). The drum rests on its whole face: its bed is worn askew.
    chip_left, chip_right : float
        Width that its lower face has lost at an edge [m]; the mass is taken as if nothing were lost.

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

    def __post_init__(self) -> None:
        if isinstance(self.drum, bool) or not isinstance(self.drum, (int, np.integer)) or self.drum < 1:
            raise InputError(
                f"a drum as found has number {self.drum!r}; allowed is a whole number from 1 (at the base)."
            )
        for name, low, high, unit in (
            ("offset", -10.0, 10.0, "m"),
            ("tilt", -30.0, 30.0, "degrees"),
            ("chip_left", 0.0, 10.0, "m"),
            ("chip_right", 0.0, 10.0, "m"),
        ):
            value = check_range(f"{name} of drum {self.drum}", getattr(self, name), low, high, unit=unit)
            object.__setattr__(self, name, value)


@dataclass(frozen=True)
class AsFound:
    """What is not as built; positions are described along and normal to the base.

    Parameters
    ----------
    drums : sequence of FoundDrum
        Each drum at most once; drums left out are as built.
    base_tilt : float
        Slope of the base, counter-clockwise positive (it rises to the right) [degrees]. Pushover and limit analysis count
        theirs downhill to the right, where their forces push.

    Raises
    ------
    InputError
        A drum is given twice, or a value is outside its range.
    """

    drums: tuple[FoundDrum, ...] = ()
    base_tilt: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "drums", tuple(sorted(self.drums, key=lambda one: one.drum)))
        numbers = [one.drum for one in self.drums]
        twice = next((number for number in numbers if numbers.count(number) > 1), None)
        if twice is not None:
            raise InputError(f"drum {twice} is given twice as found; give all of it at once.")
        tilt = check_range("base_tilt", self.base_tilt, -45.0, 45.0, unit="degrees")
        object.__setattr__(self, "base_tilt", tilt)

    def __bool__(self) -> bool:
        return self.base_tilt != 0.0 or any(one != FoundDrum(one.drum) for one in self.drums)

    def of(self, drum: int) -> FoundDrum:
        """What is found at a drum, numbered from 1."""
        return next((one for one in self.drums if one.drum == drum), FoundDrum(drum))


#: A column exactly as it was built: no offset, tilt, chip or slope.
AS_BUILT = AsFound()
