"""Design values of links, their tables, and the best of a few sizes of a measure."""

from __future__ import annotations

import dataclasses
import itertools
import logging
import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..campaign.twins import LAW
from ..column.links.link import PLACES, Link
from ..column.links.placed import PlacedLink
from ..column.structure import Structure
from ..errors import InputError, check_kind
from ..messages import joined, say
from ..models.base import duration
from ..response.links import AT_CAPACITY
from ..response.response import Response
from ..simulate import LONG_WAIT
from ..verdicts import verdict as v
from ..verdicts.compare import Comparison
from ..verdicts.limit_states import shares
from ..verdicts.verdict import few_laws, limits_under_another_law
from .evidence import evidence
from .fragility import FEWEST, SAMPLES
from .states import StateComparison, with_undecided

if TYPE_CHECKING:
    import pandas


#: Why an upper limit is infinite, in words.
OPEN = say(
    "Where it says inf, it is beyond all that was computed, because runs collapse or lose the link, or there are "
    "fewer than 21 records."
)


def basis_of(values: pandas.DataFrame) -> str:
    """What the intervals hold, in words.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`design_values`.
    """
    laws = max(values["laws"].tolist(), default=0) if "laws" in values else 0
    if not laws:
        return say("over records; the law of the joints is taken as known")
    few = few_laws(laws)
    return say("over records and one more law of the joints") + (say("; {few}", few=few) if few else "")


def where(values: pandas.DataFrame) -> str:
    """At which level values are told; empty where there is only one."""
    which = say(" at one level") if "told" in values else say(" at the largest level")
    return which if len(set(values["level"])) > 1 else ""


def worst_of(values: pandas.DataFrame, share: float = 0.84) -> pandas.DataFrame:
    """What has a capacity, at the level of every state that is told; links that are used most come first, else by place.

    A ductile link at its capacity bears no more whatever happens, and is judged by its slip: all quantities of a link stay
    together, and of links that are used as much those come first whose ways are.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`design_values`.
    share : float
        Fractile [-].
    """
    key = f"use_value_{100 * share:g}"
    known: Any = values[values[key].notna()] if len(values) else values
    if not len(known):
        return known
    known = _row_in_words(known)
    links = known.assign(way=known[key].where(known["unit"] == "m", 0.0)).groupby(["state", "link"], sort=False)
    uses = {"most_use": links[key].transform("max"), "most_way": links["way"].transform("max"), "place": links.ngroup()}
    by = {"state": True, "most_use": False, "most_way": False, "place": True, key: False}
    ordered = known.assign(**uses).sort_values(list(by), ascending=list(by.values()), kind="stable")
    return ordered.drop(columns=list(uses))


#: Units in which people read forces and ways, and how many of them are one of the SI.
READ_IN = {"N": ("kN", 1e-3), "m": ("mm", 1e3)}


def as_read(values: pandas.DataFrame) -> pandas.DataFrame:
    """The same in kN and mm, which people read without powers of ten.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`design_values`, some of its rows.
    """
    units = [READ_IN[unit] for unit in values["unit"].tolist()]
    size = np.array([factor for _, factor in units])
    read = [str(name) for name in values if str(name).startswith(("capacity", "value_", "low_", "high_"))]
    scaled = {name: values[name].to_numpy(dtype=float) * size for name in read}
    return values.assign(**scaled, unit=[name for name, _ in units])


def clearances(values: pandas.DataFrame) -> pandas.DataFrame:
    """Slip of layers at the level of every state that is told: the room that an isolated column needs around its foot.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`design_values`.
    """
    if not len(values):
        return values
    layers: Any = values[(values["kind"] == "layer") & (values["quantity"] == "slip")]
    return _row_in_words(layers)


def governing(values: pandas.DataFrame) -> pandas.DataFrame:
    """All quantities of the link of one state that governs, at the level that is told.

    It is the one that is used most; where nothing has a capacity the layer that slips most, or what bears the largest force.

    Parameters
    ----------
    values : pandas.DataFrame
        As of :func:`design_values`, of one state.
    """
    table: Any = worst_of(values)
    if not len(table):
        table = clearances(values)
        table = (table if len(table) else _row_in_words(values)).sort_values("value_84", ascending=False, kind="stable")
    return table[table["link"] == table["link"].iloc[0]]


def _row_in_words(values: Any) -> Any:
    largest = values.groupby("state")["level"].transform("max")  # as earlier versions told them
    return values[values["told"] if "told" in values else values["level"] == largest]


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
    comparison: StateComparison | Comparison,
    confidence: float = 0.95,
    *,
    level: float | None = None,
    instants: bool = True,
) -> pandas.DataFrame:
    """Peak force, slip and elongation of every link over records and twins, level by level, with utilisation.

    Parameters
    ----------
    comparison : StateComparison or Comparison
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
    check_kind("comparison", comparison, (StateComparison, Comparison), allowed="a comparison of states or of models")
    if isinstance(comparison, StateComparison):
        again = partial(comparison.response, output_interval=FINE) if instants else None
        return values_of_runs(
            dict(zip(comparison.labels, comparison.columns, strict=True)), comparison.table, confidence, again, level
        )
    table = comparison.table.rename(columns={"model": "state"})
    table["verdict"] = [v.verdict(row) for row in table.to_dict("records")]
    stood = {label: response.structure for label, response in zip(comparison.labels, comparison.responses, strict=True)}
    return values_of_runs(stood, table.assign(im=1.0, record=""), confidence, comparison.responses.__getitem__, level)


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
        known = ", ".join(f"{run_level:g}" for run_level in levels)
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
            level_rows = _of_level(table[sizes == size], links, confidence)
            rows += [{"state": label, "level": size, "told": bool(np.isclose(size, at))} | row for row in level_rows]
        if again is not None:
            _tell_instants([row for row in rows if row["state"] == label and row["told"]], links, again)
    for row in rows:
        del row["run"], row["place"]
    return pandas.DataFrame(rows)


def _told_level(sizes: np.ndarray, collapsed: np.ndarray) -> float:
    """The highest level at which few runs collapse, else the lowest."""
    few = [size for size in np.unique(sizes) if collapsed[sizes == size].mean() < MOST_COLLAPSED]
    return float(max(few, default=sizes.min(initial=math.inf)))


def _tell_instants(rows: list[dict[str, Any]], links: list[PlacedLink], again: Callable[[int], Response]) -> None:
    """Adds to the forces of one state at one level when and where to they act; every run is made once."""
    forces = [row for row in rows if row["run"] is not None and row["unit"] == "N" and row["value_84"] > 0.0]
    numbers, began = sorted({row["run"] for row in forces}), time.monotonic()
    governing: dict[int, Response] = {}
    for done, run in enumerate(numbers):
        if done == 1 and (remaining := (time.monotonic() - began) * (len(numbers) - 1)) > LONG_WAIT:
            logging.getLogger("stylobate").info(
                "%d more runs that govern design values are computed once more, to tell when: about %s to go.",
                len(numbers) - 1,
                duration(remaining),
            )
        governing[run] = again(run)
    for row in forces:
        row |= _instant(governing[row["run"]], row["place"], links[row["place"]], row["quantity"])


def _instant(response: Response, k: int, link: PlacedLink, quantity: str) -> dict[str, float]:
    """When the force of link k is largest in a run, by its recorded states, and the azimuth of shear about then."""
    link_histories = response.histories.links
    if link_histories is None:
        return {}
    shear = quantity == QUANTITIES[0].name
    force = (link_histories.shear if shear else link_histories.tension)[:, k]
    at = int(np.argmax(force) if link_histories.reached is None else link_histories.reached[0 if shear else 1, k])
    at = max((at, max(at - 1, 0)), key=force.__getitem__)  # the larger one of the states on either side of the peak
    facts = {"instant_84_s": float(response.time[at])}
    if shear and link_histories.angle is not None:
        angle = float(link_histories.angle[at, k])
        x, y, _ = math.cos(angle) * np.array(link.frame[0]) + math.sin(angle) * np.array(link.frame[1])
        if math.hypot(x, y) > LEVEL:
            facts["azimuth_84_deg"] = math.degrees(math.atan2(y, x)) % 360.0
    return facts


def _of_level(table: Any, links: list[PlacedLink], confidence: float) -> list[dict[str, Any]]:
    """The rows of one state at one level."""
    verdicts = table["verdict"].to_numpy(dtype=str)
    owner = np.unique(table["record"].to_numpy(dtype=str), return_inverse=True)[1]
    law = (
        np.nan_to_num(table[LAW].to_numpy(dtype=float)).astype(int) if LAW in table else np.zeros(len(table), dtype=int)
    )
    broken = np.array([[instant is not None for instant in run] for run in table["link_broken_s"]])
    rows = []
    for k, link in enumerate(links):
        gone = (verdicts == v.COLLAPSED) | broken[:, k]
        for quantity in QUANTITIES:
            if not _has(link, quantity):
                continue
            capacity = float(getattr(link, quantity.limit))
            most = capacity if quantity.unit == "N" else math.inf
            peak = np.minimum(np.array([run[k] for run in table[quantity.key]], dtype=float), most)
            low = np.where(gone, most, peak)
            high = np.where(verdicts == v.UNDECIDED, most, low)
            row: dict[str, Any] = {
                "link": link.name, "kind": link.kind, "quantity": quantity.name, "unit": quantity.unit, "runs": len(table),
                "records": int(owner.max()) + 1, "laws": len(np.unique(law[law > 0])),
                "collapsed": int((verdicts == v.COLLAPSED).sum()), "gone": int(gone.sum()),
                "undecided": int((verdicts == v.UNDECIDED).sum()), "capacity": capacity,
                "limited_by": link.limited_by(quantity.limit),
                "record_84": None, "instant_84_s": math.nan, "azimuth_84_deg": math.nan, "run": None, "place": k,
            }  # fmt: skip
            for share in FRACTILES:
                estimate = fractile(low, high, owner, share, confidence)
                estimate = [min(x, most) for x in _with_laws(estimate, low, high, owner, law, share, confidence)]
                use = [x / capacity if math.isfinite(capacity) else math.nan for x in estimate]
                for name, values in (("", estimate), ("use_", use)):
                    row |= {f"{name}{which}_{100 * share:g}": x for which, x in zip(WHICH, values, strict=True)}
            alike = np.flatnonzero((peak == row["value_84"]) & ~gone)
            if len(alike):
                row |= {"run": int(table.index[alike[0]]), "record_84": str(table["record"].iloc[alike[0]])}
            rows.append(row)
    return rows


def _with_laws(
    estimate: tuple[float, float, float],
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
        return estimate

    def of_laws(values: np.ndarray) -> np.ndarray:
        each = []
        for group in groups:
            mine = law == group
            number = np.unique(owner[mine], return_inverse=True)[1]
            each.append(fractile(values[mine], values[mine], number, share)[0])
        return np.array(each)

    def limit(values: np.ndarray, end: int) -> float:
        if len(groups) > 1 and (values == values[0]).all():
            return float(values[0])
        with np.errstate(divide="ignore"):
            return _exp(limits_under_another_law(np.log(values), confidence)[end])

    value, lower, upper = estimate
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


def _has(link: PlacedLink, quantity: Quantity) -> bool:
    """Whether a link does anything in the way of this quantity."""
    if quantity.along:
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


#: Fields of a placed link by which candidates must differ: how it looks and how it finds its hole again is too little.
LINK_PROPERTIES = (
    "shear_stiffness", "shear_capacity", "axial_stiffness", "axial_capacity", "clearance", "damping", "lift", "pretension",
    "ultimate_slip", "ultimate_elongation", "friction_coefficient", "bed_stiffness", "bed_shear_stiffness", "failure",
)  # fmt: skip

#: The same of its place.
PLACE = ("kind", "lower", "upper", "low", "high")

#: Most candidates: each is run under all records, levels and twins.
MOST = 64

#: Entry for the distance of a place in plan from the axis of a column; others are x, y and z.
RADIUS = "radius"


def candidates(structure: Structure, vary: Mapping[str, Sequence[float]]) -> dict[str, Structure]:
    """The structure with each combination of the numbers of its links.

    Parameters
    ----------
    structure : Column, Assembly or SpatialAssembly
        With the measure.
    vary : mapping of str to sequence of float
        Values [SI] by ``kind.field``, such as ``dowel.diameter`` or ``dowel.joint``; of a place by coordinate,
        ``dowel.at.x``, of a column also ``dowel.at.radius``. All links of that kind take them.

    Returns
    -------
    dict of str to Structure
        By the numbers in words.

    Raises
    ------
    InputError
        A kind that the structure does not have, what is no number of it, a value that the kind refuses, numbers that change
        nothing because others are given beside them, two links at one place, or more than 64 candidates.
    """
    stands: Any = check_kind("structure", structure, Structure).stack or structure
    if not vary:
        raise InputError("no number is varied; give one, such as dowel.diameter.", "vary")
    for name in vary:
        _check_number(name, stands)
    every = list(itertools.product(*vary.values()))
    if not 2 <= len(every) <= MOST:
        raise InputError(f"{len(every)} candidates are asked for; allowed are from 2 to {MOST}.", "vary")
    structures: dict[str, Structure] = {}
    for values in every:
        numbers = {name: float(value) for name, value in zip(vary, values, strict=True)}
        links = list(stands.links)
        for name, value in numbers.items():
            kind, _, field = name.partition(".")
            links = [_changed(link, field, value) if link.kind == kind else link for link in links]
        label = ", ".join(f"{name}={value:g}" for name, value in numbers.items())
        remade: Any = stands.unwarned if structure.stack is not None else partial(dataclasses.replace, stands)
        structures[label] = remade(links=tuple(links))
        if len(set(_places(structures[label]))) < len(set(_places(stands))):
            raise InputError(
                f"{label} puts two links at one place; vary what keeps them apart, or one of them.", "vary"
            )
    if len(
        {
            tuple(_properties_of(link, LINK_PROPERTIES + PLACE) for link in candidate.placed_links)
            for candidate in structures.values()
        }
    ) < len(every):
        raise InputError(
            f"two of the candidates by {' and '.join(vary)} are the same: a value is given twice, or what the links hold is "
            "given beside it and does not follow from it; leave that out of the file.",
            "vary",
        )
    return structures


def _check_number(name: str, stands: Structure) -> None:
    """Refuse what is no number of the links of a kind, or of a place that is not given."""
    kind, _, field = name.partition(".")
    mine = [link for link in stands.links if link.kind == kind]
    if not mine:
        known = ", ".join(sorted({link.kind for link in stands.links})) or "none"
        raise InputError(f"{name!r} is varied, and {stands.name!r} has no link {kind!r}; it has {known}.", "vary")
    for link in mine:
        if link.numbers is not None and link.made is None:
            raise InputError(
                f"{name!r} is varied, and a {kind} of {stands.name!r} comes with a column, or only in numbers; write a file "
                "for each candidate and compare them as states.",
                "vary",
            )
        made = link.made or link
        words = {parameter.name: set(str(parameter.type).split(" | ")) for parameter in dataclasses.fields(made)}
        numbers = [parameter for parameter, types in words.items() if types & {"float", "int"}]
        if link.between is not None:
            numbers = [parameter for parameter in numbers if parameter not in PLACES]
        for end, place in zip(("at", "to"), link.ends, strict=True):
            numbers += [f"{end}.{axis}" for axis in _axes(link, place)]
        if field not in numbers:
            raise InputError(f"{name!r} is no number of a {kind}; those are {', '.join(numbers)}.", "vary")


def _axes(link: Link, place: tuple[float, ...] | None) -> tuple[str, ...]:
    """Names of the coordinates of a place that is given."""
    if place is None:
        return ()
    if link.between is None:
        return "x", "y", RADIUS
    return ("x", "z") if len(place) == 2 else ("x", "y", "z")


def _changed(link: Link, field: str, value: float) -> Link:
    """A link with another number, as made of material and size."""
    made = link
    if link.made is not None:
        ends = {name: end for name, end in zip(("at", "to"), link.ends, strict=True) if end is not None}
        made = dataclasses.replace(link.made, **ends, name=link.name, between=link.between)
    name, _, axis = field.partition(".")
    if not axis:
        return dataclasses.replace(made, **{name: int(value) if value.is_integer() and name in PLACES else value})
    place = getattr(made, name)
    if axis == RADIUS:
        size = math.hypot(*place)
        way = (1.0, 0.0) if size == 0.0 else (place[0] / size, place[1] / size)
        place = value * way[0], value * way[1]
    else:
        k = _axes(link, place).index(axis)
        place = (*place[:k], value, *place[k + 1 :])
    return dataclasses.replace(made, **{name: place})


def _properties_of(link: PlacedLink, names: Sequence[str]) -> tuple[Any, ...]:
    return tuple(getattr(link, name) for name in names)


def _places(stands: Structure) -> list[tuple[Any, ...]]:
    return [_properties_of(link, PLACE) for link in stands.placed_links]


@dataclass(frozen=True)
class Best:
    """The best of some candidates, as far as these records tell.

    Parameters
    ----------
    best : str or None
        Label of the smallest share of runs that exceed the limit state, undecided ones counted in, of those whose links stay
        below their capacity; the first of equal ones. None where all reach it.
    alike : tuple of str
        Candidates that cannot be told from it, itself among them: their share is not shown to be larger, nor that their
        links come to their capacity.
    table : pandas.DataFrame
        One row per candidate: ``candidate``, ``share_low`` and ``share_high`` (undecided out and in),
        ``interval_low`` and ``interval_high``, ``use``, ``use_low`` and ``use_high`` of its links (84 %, largest level),
        ``within`` its capacity; ``difference_low`` and ``difference_high`` of its share from that of the best; ``alike``.
        The last three are missing where no candidate is allowed.
    runs, records : int
    words : str
        What it comes to, in sentences.
    """

    best: str | None
    alike: tuple[str, ...]
    table: pandas.DataFrame
    runs: int
    records: int
    words: str

    def summary(self) -> dict[str, Any]:
        """Under the names of the JSON object of ``stylobate states``."""
        rows = self.table.astype(object).where(self.table.notna(), None).to_dict("records")
        facts = {"best": self.best, "alike": list(self.alike), "runs": self.runs, "records": self.records}
        return facts | {"words": self.words, "candidates": rows}


def best_of(
    comparison: StateComparison,
    labels: Sequence[str],
    *,
    samples: int = SAMPLES,
    seed: int = 0,
    confidence: float = 0.95,
) -> Best:
    """The best of candidates that were run as states, and the set of those that cannot be told from it.

    Parameters
    ----------
    comparison : StateComparison
        The same records, levels and twins for all.
    labels : sequence of str
        States that are candidates.
    samples, seed, confidence
        Of the bootstrap over records.

    Notes
    -----
    A candidate is told from the best where the interval of the paired difference of their shares does not hold zero. Which
    one is best is itself chance, so that the intervals are those of all pairs of K candidates together: each has the
    confidence 1 − (1 − c)/(K (K − 1)/2) (Bonferroni). Nothing is told of fewer than ten records. A candidate whose links
    come to their capacity in these runs, but need not under others, is not the best one and stays in the set.
    """
    import pandas

    check_kind("comparison", comparison, StateComparison)
    if unknown := [label for label in labels if label not in comparison.labels]:
        raise InputError(f"no state is called {unknown[0]!r}; there are {', '.join(comparison.labels)}.", "labels")
    table: Any = comparison.table
    evidences = {
        label: evidence(table[table["state"] == label], None, comparison.state, label, doubt=comparison.doubt)
        for label in labels
    }
    first = next(iter(evidences.values()))
    designed = design_values(comparison, level=float(table["im"].max()), instants=False)
    most: Any = worst_of(designed)
    rows = []
    for share in shares(
        {label: state_evidence.codes for label, state_evidence in evidences.items()}, first.records, first.laws
    ):
        mine = most[most["state"] == share.label] if len(most) else most
        use, use_low, use_high = (float(mine[f"use_{which}_84"].max()) if len(mine) else 0.0 for which in WHICH)
        rows.append({
            "candidate": share.label, "share_low": share.low, "share_high": share.high, "interval_low": share.interval[0],
            "interval_high": share.interval[1], "use": use, "use_low": use_low, "use_high": use_high,
            "within": use < AT_CAPACITY,
        })  # fmt: skip
    within = [row for row in rows if row["within"] and np.isfinite(row["share_high"])]
    best = min(within, key=lambda row: row["share_high"])["candidate"] if within else None
    pairs = len(labels) * (len(labels) - 1) // 2
    each, records = 1.0 - (1.0 - confidence) / max(pairs, 1), len(np.unique(first.records))
    for row in rows:
        low, high = (0.0, 0.0) if best is not None else (math.nan, math.nan)
        if best is not None and row["candidate"] != best:
            difference = with_undecided(evidences[best], evidences[row["candidate"]], None, None, samples, seed, each)
            low, high = difference.share_low, difference.share_high
        row |= {"difference_low": low, "difference_high": high}
        may = row["use_low"] < AT_CAPACITY and np.isfinite(row["share_high"])
        row["alike"] = None if best is None else may and (records < FEWEST or not low > 0.0)
    alike = tuple(row["candidate"] for row in rows if row["alike"])
    sure = all(row["use_high"] < AT_CAPACITY for row in rows if row["alike"])
    words = say(
        "{advice} {runs} runs; {confidence:g} % intervals for all pairs together, {basis}.",
        advice=_words(best, alike, len(labels), records, comparison.state),
        runs=len(comparison.table),
        confidence=100 * confidence,
        basis=basis_of(designed) if len(designed) else say("over records"),
    )
    if best is not None and not sure:
        unsure = say(
            "That the links, and the stone around them, stay below their capacity is not sure: the upper limit of their "
            "use reaches it."
        )
        words = joined(" ", [words, unsure])
    return Best(best, alike, pandas.DataFrame(rows), len(comparison.table), records, words)


def _words(best: str | None, alike: Sequence[str], number: int, records: int, state: str) -> str:
    """What the comparison comes to."""
    if best is None:
        return say(
            "None of the {number} candidates is allowed: at the largest level each collapses or comes to the capacity of a "
            "link, or of the stone around it, under 16 % of the motions or more; strengthen the links, or run lower levels. "
            "That one is stronger than another state only compares collapses under these motions: it is no leave to build "
            "it.",
            number=number,
        )
    few = say("; nothing is told from fewer than {fewest} records", fewest=FEWEST) if records < FEWEST else ""
    sentence = say("Least {state} of {number} candidates: {best}", state=state, number=number, best=best)
    others = len(alike) - 1
    if not others:
        return sentence + say("; the others are worse or reach their capacity.")
    more = say("; {others} more cannot be told from it under {records}{few}.")
    counted_records = say("one record") if records == 1 else say("{records} records", records=records)
    return sentence + more.of(others=others, records=counted_records, few=few)
