"""What the stone around an anchor bears: cone, edge and bearing, by formulas of concrete that are transferred to stone."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

from ...errors import InputError, check_range
from ...messages import say
from .link import Numbers

#: k of the cone (EN 1992-4, 7.2.1.4, post-installed) and of the edge (7.2.2.5), cracked and not; in N and mm.
CONE, EDGE = {True: 7.7, False: 11.0}, {True: 1.7, False: 2.4}

#: An edge is far from a cone from so many embedments on (EN 1992-4).
FAR = 1.5

#: A bar counts along the edge for so many diameters; one thicker than so much [mm] for so many, or so much [mm]
#: (EN 1992-4, 7.2.2.5).
LONGEST, THICK, LONGEST_OF_THICK = 12.0, 24.0, (8.0, 300.0)

#: Allowed range of each input, in SI.
RANGES = {
    "diameter": (1e-3, 0.2, "m"),
    "embedment": (1e-2, 5.0, "m"),
    "edge": (1e-2, 100.0, "m"),
    "stone_strength": (1e6, 5e8, "Pa"),
    "yield_strength": (1e6, 2e9, "Pa"),
}


def stone_at_anchor(
    *,
    diameter: float | None = None,
    embedment: float | None = None,
    edge: float | None = None,
    stone_strength: float | None = None,
    yield_strength: float | None = None,
    cracked: bool = True,
) -> dict[str, float]:
    """What the stone around a single straight anchor bears [N], by how it fails.

    Parameters
    ----------
    diameter, embedment : float
        Of the bar in this stone [m].
    edge : float
        From its axis to the nearest edge; for shear the edge that it is pushed towards [m].
    stone_strength : float
        Compressive strength, f_c [Pa].
    yield_strength : float
        Of the bar, f_y [Pa].
    cracked : bool
        Whether the stone is cracked, which is the lower value.

    Returns
    -------
    dict of str to float
        ``cone`` against pull; ``edge`` and ``bearing`` against shear [N].

    Raises
    ------
    InputError
        A value is missing, which is never guessed, or out of its range.

    Notes
    -----
    All three were measured on concrete. Of stone they are an estimate: bedding planes and veins are not in them, they have
    no partial factors, and an anchor that matters is to be tested in the stone itself. The cone is that of a fastener that
    bears at its end: of a straight bar that only adheres it is an upper bound, as it may be pulled out of its grout first.
    How each constant was checked is told on the page on strengthening. With mm and MPa:

    * cone, EN 1992-4, 7.2.1.4: N = k √f_c h^1.5, times (c + 1.5 h)/(3 h) and 0.7 + 0.3 c/(1.5 h) where the edge is nearer
      than 1.5 h; other edges and anchors are far;
    * edge, EN 1992-4, 7.2.2.5: V = k d^α l^β √f_c c^1.5 with α = 0.1 √(l/c), β = 0.1 (d/c)^0.2, l the embedment, at most
      12 d, of bars beyond 24 mm at most the larger of 8 d and 300 mm; the stone is at least 1.5 c thick and wide;
    * bearing with a hinge in the bar, CEB-FIP Model Code 1990 after Rasmussen (1963), without eccentricity:
      V = 1.3 d² √(f_c f_y), at most A f_y/√3, far from any edge and with an embedment that lets the hinge form.
    """
    given = {
        "diameter": diameter, "embedment": embedment, "edge": edge, "stone_strength": stone_strength,
        "yield_strength": yield_strength,
    }  # fmt: skip
    missing = [name for name, value in given.items() if value is None]
    if missing:
        what = "it" if len(missing) == 1 else "them"
        raise InputError(f"what the stone at an anchor bears needs {' and '.join(missing)}; give {what}.", missing[0])
    values = {name: float(value) for name, value in given.items() if value is not None}
    for name, value in values.items():
        low, high, unit = RANGES[name]
        check_range(name, value, low, high, unit=unit, field=name)
    d, h, c = (1e3 * values[name] for name in ("diameter", "embedment", "edge"))
    strength, steel = 1e-6 * values["stone_strength"], 1e-6 * values["yield_strength"]
    if c < 0.5 * d:
        raise InputError(
            f"edge is {c:g} mm and half the diameter {0.5 * d:g} mm: the anchor is not in the stone.", "edge"
        )
    near = min(c / (FAR * h), 1.0)
    length = min(h, LONGEST * d if d <= THICK else max(LONGEST_OF_THICK[0] * d, LONGEST_OF_THICK[1]))
    return {
        "cone": CONE[cracked] * math.sqrt(strength) * h**1.5 * 0.5 * (1.0 + near) * (0.7 + 0.3 * near),
        "edge": EDGE[cracked] * d ** (0.1 * math.sqrt(length / c)) * length ** (0.1 * (d / c) ** 0.2)
        * math.sqrt(strength) * c**1.5,
        "bearing": d * d * min(1.3 * math.sqrt(strength * steel), 0.25 * math.pi * steel / math.sqrt(3.0)),
    }  # fmt: skip


#: By which formula the stone governs in shear and in tension.
GOVERNS = "edge of the stone (EN 1992-4, 7.2.2.5)", "cone of the stone (EN 1992-4, 7.2.1.4)"


class StoneAround(NamedTuple):
    """What the stone around a link across a joint bears at least.

    Parameters
    ----------
    shear, pull : float
        Towards the nearest edge, and of the cone [N]; a pull is infinite where the link holds none.
    edge : float
        Distance of that edge from the axis [m].
    strength : float
        Compressive strength of the stone [Pa].
    """

    shear: float
    pull: float
    edge: float
    strength: float

    @property
    def source(self) -> str:
        """What it rests on, in words."""
        words = say("EN 1992-4, carried over from concrete; edge as built {edge:.3g} m, stone of {strength:g} MPa")
        return words.of(edge=self.edge, strength=1e-6 * self.strength)


def in_stone(alone: Numbers) -> tuple[Numbers, StoneAround | None]:
    """What a link across a joint holds in its stone, cracked, and what that bears; None where it cannot be told.

    Capacities that are given stay. Where the stone bears less it breaks: the link snaps in shear, and is lost at the
    elongation at which the cone breaks out.

    Parameters
    ----------
    alone : Numbers
        Of the link by itself.
    """
    if not (alone.diameter and alone.stone_strength and math.isfinite(alone.lift) and math.isfinite(alone.edge)):
        return alone, None
    forces = stone_at_anchor(  # the bearing, which alone needs the yield strength, is in the capacity of the link already
        diameter=alone.diameter, embedment=alone.lift, edge=alone.edge, stone_strength=alone.stone_strength,
        yield_strength=RANGES["yield_strength"][1],
    )  # fmt: skip
    edge, cone = forces["edge"], forces["cone"] if alone.axial_stiffness else math.inf
    stone = StoneAround(edge, cone, alone.edge, alone.stone_strength)
    changes: dict[str, Any] = {}
    governs = alone.governs.split("; ")
    if edge < alone.shear_capacity and "shear_capacity" not in alone.stated:
        changes |= {"shear_capacity": edge, "failure": "brittle"}
        governs[0] = GOVERNS[0]
    if cone < alone.axial_capacity and "axial_capacity" not in alone.stated:
        lost = (cone - alone.pretension) / alone.axial_stiffness
        changes |= {"axial_capacity": cone, "ultimate_elongation": min(alone.ultimate_elongation, max(lost, 0.0))}
        governs[-1] = GOVERNS[1]
    return replace(alone, **changes, governs="; ".join(governs)) if changes else alone, stone
