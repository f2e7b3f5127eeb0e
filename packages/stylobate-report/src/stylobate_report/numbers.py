"""Numbers with their units, as an engineer writes them."""

from __future__ import annotations

import math
from typing import Any

from stylobate.constants import g

#: Text where there is no value.
NONE = "–"


def length(value: float | None) -> str:
    """A length in m, or in mm below a tenth of a metre."""
    if value is None or not math.isfinite(value):
        return NONE
    return f"{value:.3f} m" if value == 0.0 or abs(value) >= 0.1 else f"{1000.0 * value:.3g} mm"


def acceleration(value: float | None) -> str:
    """An acceleration given in m/s², in g."""
    return NONE if value is None or not math.isfinite(value) else f"{value / g:.3g} g"


def angle(value: float | None) -> str:
    """An angle given in rad, in rad and degrees."""
    return NONE if value is None or not math.isfinite(value) else f"{value:.4f} rad ({math.degrees(value):.2f}°)"


#: Units that names of keys end in.
UNITS = {"_m_s": "m/s", "_m": "m", "_s": "s", "_g": "g", "_y": "years", "_rad": "rad", "_deg": "°"}


def named(key: str) -> str:
    """A key of a JSON object or a table as a name, its unit behind: ``tail_s`` is ``tail [s]``."""
    end = next((unit for unit in UNITS if key.endswith(unit) and key != unit), "")
    return key.removesuffix(end).replace("_", " ") + (f" [{UNITS[end]}]" if end else "")


def plain(value: Any) -> str:
    """Any value of a JSON object or a table."""
    if value is None or value == "" or (isinstance(value, float) and math.isnan(value)):
        return NONE
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, (list, tuple)):
        return ", ".join(plain(one) for one in value) or NONE
    if isinstance(value, dict):
        return ", ".join(f"{key}: {plain(one)}" for key, one in value.items()) or NONE
    return str(value)
