"""A reference row beside what is computed here: the numbers, their difference, and a verdict by the row's own spread."""

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

#: Verdicts of a row.
MET, MISSED, NONE = "met", "missed", "not applicable"

#: Rows of one case that are computed together.
Rows = list[dict[str, str]]


@dataclass(frozen=True)
class Judged:
    """What is computed beside one row.

    Parameters
    ----------
    ours, difference : str
        For people; empty where there is none.
    verdict : str
        Met, missed or not applicable.
    why : str
        Why a row is missed or not applicable, and what else must be said of it.
    """

    ours: str
    difference: str
    verdict: str
    why: str = ""


#: Families of rows by how their cases begin, and what judges them.
FAMILIES: dict[str, Callable[[Rows], Iterable[Judged]]] = {}


def family(*names: str):
    """Let a function judge all rows whose case begins with one of the names."""

    def add(judge: Callable[[Rows], Iterable[Judged]]):
        FAMILIES.update(dict.fromkeys(names, judge))
        return judge

    return add


def family_of(row: dict[str, str]) -> str:
    """The family of a row: the longest name with which its case begins."""
    return max((name for name in FAMILIES if row["case"].startswith(name)), key=len, default="")


def allowed(row: dict[str, str], of: float | None = None) -> float | None:
    """The spread of a row as an absolute difference; None where it gives no number.

    Per cent, and numbers without a unit, are of the value, or of ``of``; degrees and millimetres, and numbers of angles in
    radians, are themselves.
    """
    match = re.match(r"(\d[\d.e-]*)(?: (%|deg|mm))?(?![\d.])", row["spread"])
    if match is None:
        return None
    size, unit = float(match[1]), match[2]
    if unit == "deg" or (unit is None and row["unit"] == "rad"):
        return size
    if unit == "mm":
        return 1e-3 * size
    whole = float(np.linalg.norm(values(row))) if of is None else abs(of)
    return size * whole * (0.01 if unit == "%" else 1.0)


def values(row: dict[str, str]) -> np.ndarray:
    """The value of a row, or its several ones."""
    return np.array([float(token) for token in row["value"].split()])


def near(row: dict[str, str], ours, of: float | None = None, why: str = "", spread: float | None = None) -> Judged:
    """A number, or several, beside those of a row.

    Parameters
    ----------
    row : dict
    ours : float or array
    of : float, optional
        What the per cent of the spread are of, instead of the value.
    why : str
        What must be said; of a missed row, the reason.
    spread : float, optional
        The spread, where the row says it in words.
    """
    expected, mine = values(row), np.atleast_1d(np.asarray(ours, dtype=float))
    off = float(np.linalg.norm(mine - expected))
    most = allowed(row, of) if spread is None else spread
    shown = " ".join(f"{number:.6g}" for number in mine)
    share = off / float(np.linalg.norm(expected if of is None else [of]))
    absolute = row["unit"] in ("rad", "deg", "m") and not re.match(r"\S+ %", row["spread"])
    difference = f"{off:.2g} {row['unit']}" if absolute else f"{100.0 * share:.2g} %"
    if most is None:
        return Judged(shown, difference, NONE, why or "the row gives no spread")
    return Judged(shown, difference, MET if off <= most and math.isfinite(off) else MISSED, why)


def both_sides(row: dict[str, str], low: bool, high: bool, sides: str, why: str = "") -> Judged:
    """A limit that is met where what is on its safe side stands (``low``) and what is on the other one falls (``high``)."""
    words = {True: "stands", False: "falls"}
    shown = ", ".join(f"{side}: {words[verdict]}" for side, verdict in zip(sides.split("|"), (low, high), strict=True))
    return Judged(shown, "", MET if low and not high else MISSED, why)
