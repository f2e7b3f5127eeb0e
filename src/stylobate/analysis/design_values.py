"""Design values of a measure: what every link bears and moves, not exceeded by a share of the records, with intervals."""

from __future__ import annotations

import logging
import math
import time
from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..campaign.twins import LAW
from ..column.links.placed import PlacedLink
from ..column.structure import Structure
from ..errors import InputError, check_kind
from ..messages import say
from ..models.base import duration
from ..response.response import Response
from ..simulate import TOLD_WAIT
from . import verdicts as v
from .compare import Comparison
from .states import StateComparison
from .unknown_law import limits_under_another_law

if TYPE_CHECKING:
    import pandas

#: Shares of the motions that a design value is not exceeded under [-].
FRACTILES = (0.5, 0.84, 0.95)

#: Share of runs that collapse from which on a level is none to design for: beyond it 84 % of the motions have no slip [-].
MOST_COLLAPSED = 0.16

#: The level at which values are told, in words.
WHICH_LEVEL = say(
    "Unless another one was asked for, the level is the highest at which fewer than 16 % of the runs of a state collapse, "
    "or the lowest where there is none."
)

#: What is told of each: itself, and the limits of its interval.
WHICH = ("value", "low", "high")

#: Time between the states among which the instant of a peak is sought [s].
FINE = 0.002

#: A force has an azimuth with at least this share of it level [-].
LEVEL = 1e-6

#: A limit that is farther from its value than by this factor is none.
FARTHEST = 1e3

#: Levels that agree to so many decimals are one.
DIGITS = 9


class Quantity(NamedTuple):
    """What a link is designed for: name, unit, key in the row of a run, field of the link that limits it, and whether it
    acts along the link."""

    name: str
    unit: str
    key: str
    limit: str
    along: bool


QUANTITIES = (
    Quantity("shear force", "N", "link_peak_shear_n", "shear_capacity", False),
    Quantity("tension", "N", "link_peak_tension_n", "axial_capacity", True),
    Quantity("slip", "m", "link_peak_slip_m", "ultimate_slip", False),
    Quantity("elongation", "m", "link_peak_elongation_m", "ultimate_elongation", True),
)


def design_values(
    found: StateComparison | Comparison, confidence: float = 0.95, *, level: float | None = None, instants: bool = True
) -> pandas.DataFrame:
    """Peak force, slip and elongation of every link over records and twins, level by level, with utilisation.

    Parameters
    ----------
    found : StateComparison or Comparison
        As of :func:`stylobate.compare_states`; or of :func:`stylobate.compare_models`, whose models are the states then and
        whose one motion leaves every upper limit open. Those of a suite are told by ``stylobate.suite_table`` itself.
    confidence : float
        Of the intervals.
    level : float, optional
        At which values are told; by default for every state as :data:`WHICH_LEVEL` says.
    instants : bool
        Whether to compute the runs that govern at that level once more, to tell when and where to their force acts.

    Returns
    -------
    pandas.DataFrame
        One row per state, level (1 of motions as they are), link with its ``kind``, and quantity: ``unit``, ``runs``,
        ``records``, ``laws`` of the joints (0: taken as known), ``collapsed``, ``gone`` (runs that collapse or lose the
        link), ``undecided``, ``told`` (whether values are told at this level); for 50, 84 and 95 %, ``value_84`` with
        ``low_84`` and ``high_84``, the value that this share of the motions does not exceed and its interval; ``capacity``
        of the link in its stone, as it is computed (``limited_by``: link or stone), and ``use_value_84`` with
        ``use_low_84`` and ``use_high_84``, the same over it. Infinite: beyond all that was computed; NaN where there is no
        capacity. ``record_84`` is the record of the run whose force or way ``value_84`` is, None where that is none that
        stands or is open. Of forces at the level that is told ``instant_84_s``, when it acts in that run [s], and of shear
        ``azimuth_84_deg``, where it pushes the body above in plan, from x towards y, as seen from the body below; NaN where
        it is not told.

    Raises
    ------
    InputError
        No state ran at ``level``.

    Notes
    -----
    A run that collapses, or in which the link is lost, exceeds every slip; its force is the capacity of the link, which no
    force exceeds.
    An undecided run counts with its peaks so far in the value and the lower limit, and as a collapse in the upper one.
    Every record counts once, however many twins it has. The interval holds the values x for which Wilson's interval of the
    share of records that stay below x holds the fractile: with n records the upper limit of 84 % is finite from 21 of
    them on, n/(n + z²) ≥ 0.84. Where twins have several laws of the joints the interval holds one more of them, see
    :func:`_with_laws`.
    """
    check_kind("found", found, (StateComparison, Comparison), allowed="a comparison of states or of models")
    if isinstance(found, StateComparison):
        again = partial(found.response, output_interval=FINE) if instants else None
        return values_of_runs(
            dict(zip(found.labels, found.columns, strict=True)), found.table, confidence, again, level
        )
    table = found.table.rename(columns={"model": "state"})
    table["verdict"] = [v.verdict(row) for row in table.to_dict("records")]
    stood = {label: one.structure for label, one in zip(found.labels, found.responses, strict=True)}
    return values_of_runs(stood, table.assign(im=1.0, record=""), confidence, found.responses.__getitem__, level)


def values_of_runs(
    stood: Mapping[str, Structure],
    runs: pandas.DataFrame,
    confidence: float = 0.95,
    again: Callable[[int], Response] | None = None,
    level: float | None = None,
) -> pandas.DataFrame:
    """The table of :func:`design_values` of any runs.

    Parameters
    ----------
    stood : mapping of str to Structure
        By state.
    runs : pandas.DataFrame
        One row per run: ``state``, ``im`` (its level), ``record``, ``verdict``, what links measure, and, where it varies,
        ``law_of_joints`` from 1, 0 where it is that of the structure itself.
    confidence : float
    again : callable, optional
        The run of a row with its histories; without it no instants are told.
    level : float, optional
    """
    import pandas

    levels = [] if level is None else np.unique(np.round(runs["im"].to_numpy(dtype=float), DIGITS)).tolist()
    if level is not None and not np.isclose(levels, level).any():
        known = ", ".join(f"{one:g}" for one in levels)
        raise InputError(f"the level of design values is {level:g}; allowed is one that was run: {known}.", "level")
    rows: list[dict[str, Any]] = []
    for label, structure in stood.items():
        links = [link for link in structure.placed_links if link.acts]
        if not links or QUANTITIES[0].key not in runs:
            continue
        table: Any = runs[runs["state"] == label]
        table = table[table["verdict"].isin((v.STANDS, v.COLLAPSED, v.UNDECIDED))]
        sizes = np.round(table["im"].to_numpy(dtype=float), DIGITS)
        at = _told_level(sizes, table["verdict"].to_numpy() == v.COLLAPSED) if level is None else level
        for size in np.unique(sizes).tolist():
            told = _of_level(table[sizes == size], links, confidence)
            rows += [{"state": label, "level": size, "told": bool(np.isclose(size, at))} | one for one in told]
        if again is not None:
            _tell_instants([row for row in rows if row["state"] == label and row["told"]], links, again)
    for row in rows:
        del row["run"], row["place"]
    return pandas.DataFrame(rows)


def _told_level(sizes: np.ndarray, collapsed: np.ndarray) -> float:
    """The highest level at which few runs collapse, else the lowest."""
    few = [one for one in np.unique(sizes) if collapsed[sizes == one].mean() < MOST_COLLAPSED]
    return float(max(few, default=sizes.min(initial=math.inf)))


def _tell_instants(rows: list[dict[str, Any]], links: list[PlacedLink], again: Callable[[int], Response]) -> None:
    """Adds to the forces of one state at one level when and where to they act; every run is made once."""
    forces = [row for row in rows if row["run"] is not None and row["unit"] == "N" and row["value_84"] > 0.0]
    numbers, began = sorted({row["run"] for row in forces}), time.monotonic()
    governing: dict[int, Response] = {}
    for done, run in enumerate(numbers):
        if done == 1 and (left := (time.monotonic() - began) * (len(numbers) - 1)) > TOLD_WAIT:
            logging.getLogger("stylobate").info(
                "%d more runs that govern design values are computed once more, to tell when: about %s to go.",
                len(numbers) - 1,
                duration(left),
            )
        governing[run] = again(run)
    for row in forces:
        row |= _instant(governing[row["run"]], row["place"], links[row["place"]], row["quantity"])


def _instant(response: Response, k: int, link: PlacedLink, quantity: str) -> dict[str, float]:
    """When the force of link k is largest in a run, by its recorded states, and the azimuth of shear about then."""
    held = response.histories.links
    if held is None:
        return {}
    shear = quantity == QUANTITIES[0].name
    force = (held.shear if shear else held.tension)[:, k]
    at = int(np.argmax(force) if held.reached is None else held.reached[0 if shear else 1, k])
    at = max((at, max(at - 1, 0)), key=force.__getitem__)  # the larger one of the states on either side of the peak
    told = {"instant_84_s": float(response.time[at])}
    if shear and held.angle is not None:
        angle = float(held.angle[at, k])
        x, y, _ = math.cos(angle) * np.array(link.frame[0]) + math.sin(angle) * np.array(link.frame[1])
        if math.hypot(x, y) > LEVEL:
            told["azimuth_84_deg"] = math.degrees(math.atan2(y, x)) % 360.0
    return told


def _of_level(table: Any, links: list[PlacedLink], confidence: float) -> list[dict[str, Any]]:
    """The rows of one state at one level."""
    said = table["verdict"].to_numpy(dtype=str)
    owner = np.unique(table["record"].to_numpy(dtype=str), return_inverse=True)[1]
    law = (
        np.nan_to_num(table[LAW].to_numpy(dtype=float)).astype(int) if LAW in table else np.zeros(len(table), dtype=int)
    )
    broken = np.array([[one is not None for one in run] for run in table["link_broken_s"]])
    rows = []
    for k, link in enumerate(links):
        gone = (said == v.COLLAPSED) | broken[:, k]
        for one in QUANTITIES:
            if not _has(link, one):
                continue
            capacity = float(getattr(link, one.limit))
            most = capacity if one.unit == "N" else math.inf
            peak = np.minimum(np.array([run[k] for run in table[one.key]], dtype=float), most)
            low = np.where(gone, most, peak)
            high = np.where(said == v.UNDECIDED, most, low)
            row: dict[str, Any] = {
                "link": link.name, "kind": link.kind, "quantity": one.name, "unit": one.unit, "runs": len(table),
                "records": int(owner.max()) + 1, "laws": len(np.unique(law[law > 0])),
                "collapsed": int((said == v.COLLAPSED).sum()), "gone": int(gone.sum()),
                "undecided": int((said == v.UNDECIDED).sum()), "capacity": capacity,
                "limited_by": link.limited_by(one.limit),
                "record_84": None, "instant_84_s": math.nan, "azimuth_84_deg": math.nan, "run": None, "place": k,
            }  # fmt: skip
            for share in FRACTILES:
                told = fractile(low, high, owner, share, confidence)
                told = [min(x, most) for x in _with_laws(told, low, high, owner, law, share, confidence)]
                use = [x / capacity if math.isfinite(capacity) else math.nan for x in told]
                for name, values in (("", told), ("use_", use)):
                    row |= {f"{name}{which}_{100 * share:g}": x for which, x in zip(WHICH, values, strict=True)}
            alike = np.flatnonzero((peak == row["value_84"]) & ~gone)
            if len(alike):
                row |= {"run": int(table.index[alike[0]]), "record_84": str(table["record"].iloc[alike[0]])}
            rows.append(row)
    return rows


def _with_laws(
    told: tuple[float, float, float],
    low: np.ndarray,
    high: np.ndarray,
    owner: np.ndarray,
    law: np.ndarray,
    share: float,
    confidence: float,
) -> tuple[float, float, float]:
    """A fractile with limits that hold one more law of the joints, where runs are of several.

    Every law g has its own fractile q_g over the same records. ln q of one more lies within t(G − 1) s √(1 + 1/G) of their
    mean; how far that is from the value and how far the limit over records is are added as independent errors are, by their
    squares. A law under which the link bears nothing leaves the lower limit at 0, one beyond all that was computed the upper
    one open, and fewer than two laws both; so does a limit a thousand times off.
    """
    groups = np.unique(law[law > 0])
    if not len(groups):
        return told

    def of_laws(values: np.ndarray) -> np.ndarray:
        each = []
        for one in groups:
            mine = law == one
            number = np.unique(owner[mine], return_inverse=True)[1]
            each.append(fractile(values[mine], values[mine], number, share)[0])
        return np.array(each)

    def limit(values: np.ndarray, end: int) -> float:
        if len(groups) > 1 and (values == values[0]).all():
            return float(values[0])
        with np.errstate(divide="ignore"):
            return _exp(limits_under_another_law(np.log(values), confidence)[end])

    value, lower, upper = told
    below, above = limit(of_laws(low), 0), limit(of_laws(high), 1)
    if value == 0.0 or math.isinf(value):  # it has no middle to go from: the wider of both
        return value, min(lower, below), max(upper, above)
    return value, value / _together(value, lower, below), value * _together(value, upper, above)


def _together(value: float, *limits: float) -> float:
    """By which factor independent errors to these limits on one side of a value take it off together."""
    logs = [math.inf if x in (0.0, math.inf) else abs(math.log(x / value)) for x in limits]
    far = math.hypot(*logs)
    return math.inf if far > math.log(FARTHEST) else math.exp(far)


def _exp(value: float) -> float:
    """Power of e, infinite where it is too large for a number."""
    return math.inf if value > 700.0 else math.exp(value)


def _has(link: PlacedLink, one: Quantity) -> bool:
    """Whether a link does anything in the way of this quantity."""
    if one.along:
        return link.axial_stiffness > 0.0
    return not link.straight and (link.shear_stiffness > 0.0 or link.damping > 0.0)


def fractile(
    low: np.ndarray, high: np.ndarray, owner: np.ndarray, share: float, confidence: float = 0.95
) -> tuple[float, float, float]:
    """Value that a share of the records does not exceed, and the limits of its interval.

    Parameters
    ----------
    low, high : array, shape (n,)
        Of every run what it comes to at least, and at most.
    owner : array of int, shape (n,)
        Number of its record, from 0 without gaps; each record counts once.
    share, confidence : float

    Returns
    -------
    value, lower, upper : float
        The first two of ``low``, the last of ``high``; infinite where no value is large enough.
    """
    runs = np.bincount(owner)
    number = len(runs)

    def below(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        order = np.argsort(values, kind="stable")
        passed = np.round(np.cumsum(1.0 / runs[owner[order]]), 9)
        return np.append(values[order], math.inf), passed

    ends, passed = below(low)
    most, passed_most = below(high)
    trials = np.full(len(low), number)
    return (
        float(ends[np.searchsorted(passed / number, share - 1e-9)]),
        float(ends[np.searchsorted(v.wilson_interval(passed, trials, confidence)[1], share)]),
        float(most[np.searchsorted(v.wilson_interval(passed_most, trials, confidence)[0], share)]),
    )
