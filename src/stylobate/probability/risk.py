"""Risk: hazard curves, and the mean annual rate of a state under them."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.special import log_ndtr, ndtr

from .. import text_tables as tables
from ..errors import InputError, check_kind
from ..messages import digits, joined, percent, say
from ..motion.intensity import ENDS, measure_of_column, parse_measure
from ..notebook import NotebookSummary
from ..text_tables import printable, read_bytes
from .fragility import Fragility
from .lognormal import curve, log_interval

#: Largest file that is read [bytes].
MOST = 50_000_000

#: Columns of an intensity that is not named, by unit; a column of runs, such as ``pgv_m_s``, names it.
COLUMNS = {f"im{end}": unit for unit, end in ENDS.items()}

#: Intensity [g or m/s], how often a year it is exceeded where the Earth shakes most, and why a file may say more.
ENVELOPE = (
    (
        0.1,
        1.0,
        "annual_rate is the number of times a year, no return period, no percentage and no probability in 50 years",
    ),
    (5.0, 1e-3, "im_g is in g and im_m_s in m/s, not in % of g, cm/s² or cm/s"),
)

#: No hazard curve that falls from here less than in proportion is one [g or m/s]: from site to site rates fall by the power
#: 1.5 to 4 of the intensity, and so do intensities by less than the first power of a rate.
FEEBLEST = 2e-3

#: A rate is refused that is larger by more than this factor.
REFUSED = 10.0

_POE = re.compile(r"poe-([0-9.eE+-]+)")

_HEADED = re.compile(r"investigation_time=([0-9.eE+]+)")

_KIND = re.compile(r"kind=['\"]*(?P<kind>[A-Za-z][\w.~-]*)")

_KIND_OF_NAME = re.compile(r"hazard_curve-(?P<kind>[A-Za-z]+(?:-[0-9.]+)?)(?=[-_.])")

#: Statistics of a logic tree that are hazard curves, as files call them.
_STATISTIC = re.compile(
    r"(?P<one>mean|max|median)|quantile-(?P<quantile>0?\.\d+)|rlz-(?P<number>\d+)|(?P<branch>[^~]+~.*)"
)

_WORDS = {"max": say("maximum of all realisations")}

_IMT = re.compile(r"imt='?\"?([A-Za-z]+)(?:\(([0-9.]+)\))?")


#: Farthest that the site of a curve may be from that which is asked for, and mean radius of the Earth [km].
FAR, EARTH_RADIUS_KM = 50.0, 6371.0


@dataclass(frozen=True, eq=False)
class Hazard:
    """A hazard curve: straight between its points in logarithms.

    Parameters
    ----------
    im : array
        Intensity, rising, shape (k,).
    rate : array
        How often a year it is exceeded, falling [1/y], shape (k,).
    unit : str
        Of the intensity.
    name : str
    imt : str
        What the file says the intensity is, such as ``PGA``, or ``pgv`` as it is typed; empty if it does not.
    statistic : str
        What the curve is of a logic tree: ``mean``, ``quantile 0.85``, ``realisation 3``; empty if the file does not say.
    """

    im: np.ndarray
    rate: np.ndarray
    unit: str
    name: str
    imt: str = ""
    statistic: str = ""

    def __post_init__(self) -> None:
        order = np.argsort(self.im, kind="stable")
        im, rate = np.asarray(self.im, dtype=float)[order], np.asarray(self.rate, dtype=float)[order]
        positive = rate > 0.0  # an intensity that is never exceeded is beyond the end of the curve
        wrong = np.flatnonzero(~(np.isfinite(im) & (im > 0.0) & np.isfinite(rate) & (rate >= 0.0)))
        if wrong.size:
            raise InputError(
                f"hazard curve {self.name} has {rate[wrong[0]]:g} a year at {im[wrong[0]]:g} {self.unit}; allowed are rates "
                "from 0 at intensities above 0: mend the file."
            )
        if positive.sum() < 2:
            raise InputError(
                f"hazard curve {self.name} has {positive.sum()} intensities with a rate; it needs at least two."
            )
        twice = im[:-1][np.diff(im) == 0.0]
        if twice.size:
            raise InputError(f"hazard curve {self.name} has {twice[0]:g} {self.unit} twice; leave one out.")
        rises = np.flatnonzero(np.diff(rate) > 0.0)
        if rises.size:
            k, remedy = int(rises[0]), "check its rows and columns"
            if (rate >= 1.0).all() and (np.diff(rate) > 0.0).all():
                remedy = "these look like return periods: give 1 over the period as annual_rate"
            raise InputError(
                f"hazard curve {self.name} rises from {rate[k]:.3g} a year at {im[k]:g} {self.unit} to {rate[k + 1]:.3g} at "
                f"{im[k + 1]:g}, and the rate of exceeding more cannot be larger; {remedy}."
            )
        im, rate = im[positive], rate[positive]
        if im[0] <= FEEBLEST and math.log(rate[0] / rate[-1]) < math.log(im[-1] / im[0]):
            raise InputError(
                f"hazard curve {self.name} begins at {im[0]:g} {self.unit}, exceeded {rate[0]:.3g} times a year, and falls "
                "less than in proportion, which no hazard does: its columns look swapped; give the intensity under its own "
                "name and the rate of exceeding it as annual_rate."
            )
        object.__setattr__(self, "im", im)
        object.__setattr__(self, "rate", rate)

    @property
    def called(self) -> str:
        """Its name, and its statistic where the file states it."""
        return f"{self.name} ({self.statistic})" if self.statistic else self.name

    def doubt(self) -> str:
        """Rates that no site on Earth has, in a clause; empty where they are plausible. For PGA, PGV and spectra in g.

        Raises
        ------
        InputError
            The rates are beyond all that shaking can do.
        """
        first_doubt = ""
        for im, rate, why in ENVELOPE:
            at = self.at(im)
            text = say(
                "by {hazard.name} shaking of {im:g} {hazard.unit} is exceeded {at:.3g} times a year, and where the Earth "
                "shakes most about {rate:g}; {why}", hazard=self, im=im, at=at, rate=rate, why=why,
            )  # fmt: skip
            if at > REFUSED * rate:
                raise InputError(f"{text}.")
            first_doubt = first_doubt or (text if at > rate else "")
        return first_doubt

    def at(self, im: float) -> float:
        """Annual rate at an intensity; before the first one that of the first one, beyond the last one 0."""
        if im > self.im[-1]:
            return 0.0
        return float(np.exp(np.interp(math.log(im), np.log(self.im), np.log(self.rate))))


def read_hazard(path: str | Path, site: tuple[float, float] | None = None) -> Hazard:
    """Read a hazard curve.

    Parameters
    ----------
    path : path
        CSV with the columns ``annual_rate`` and the intensity, called ``pga_g``, ``pgv_m_s``, ``sa_1s_g`` …, or ``im_g`` or
        ``im_m_s`` where it is not said which; or the export ``hazard_curve-*.csv`` or ``.xml`` (NRML) of OpenQuake,
        whose probabilities of exceedance become rates −ln(1 − p)/T, and whose PGV in cm/s become m/s.
    site : (float, float), optional
        Longitude and latitude [degrees], for a file of several sites: the nearest one.

    Raises
    ------
    InputError
        The file cannot be read, has several sites, or holds no hazard curve.
    """
    text = tables.text_of(read_bytes(path, MOST), printable(path))
    if text.lstrip().startswith("<"):
        return _nrml(printable(Path(path).name), text, site)
    lines = [line.strip() for line in text.replace("\r", "").split("\n") if line.strip()]
    comments = [line for line in lines if line.startswith("#")]
    lines = [line for line in lines if not line.startswith("#")]
    head = [part.strip().strip('"') for part in lines[0].split(",")] if lines else []
    if any(_POE.fullmatch(heading) for heading in head):
        return _openquake(printable(Path(path).name), " ".join(comments), head, lines[1:], site)
    table = tables.read(
        path, MOST, "annual_rate", "im_g or im_m_s, and annual_rate, or to be a hazard curve of OpenQuake"
    )
    name = printable(Path(path).name)
    measures = {column: measure_of_column(column) for column in table.columns}
    keys = [key for key, measure in measures.items() if key in COLUMNS or measure is not None]
    if len(keys) != 1:
        raise InputError(
            f"{name} has the columns {printable(', '.join(table.columns))[:200]}; it needs one intensity beside "
            f"annual_rate, called after its measure, such as pgv_m_s, pga_g or sa_1s_g, or {', '.join(COLUMNS)}."
        )
    (key,), measure = keys, measures[keys[0]]
    unit, imt = (COLUMNS[key], "") if measure is None else (measure.unit, measure.name)
    kind = _KIND.search(" ".join(comments))
    statistic = _statistic(kind["kind"] if kind else "", name)
    return Hazard(np.array(table.numbers(key)), np.array(table.numbers("annual_rate")), unit, name, imt, statistic)


def _statistic(kind: str, name: str) -> str:
    """What a curve is of a logic tree, in words; nothing where the file states no kind.

    Raises
    ------
    InputError
        It is no curve of exceedance, such as a standard deviation.
    """
    match = _STATISTIC.fullmatch(kind if "~" in kind else kind.lower())
    if kind and match is None:
        raise InputError(
            f"{name} is of the kind {kind!r}; allowed are curves of exceedance (mean, median, quantile-…, max, rlz-…), "
            "and a spread over the logic tree (std) is none: give the mean, or a quantile."
        )
    if match is None:
        return ""
    if match["quantile"]:
        return say("quantile {share:g}", share=float(match["quantile"]))
    if match["number"]:
        return say("realisation {count}", count=int(match["number"]))
    return _WORDS.get(match[0], say("branch {name}", name=kind) if match["branch"] else say(match[0]))


def _openquake(name: str, comments: str, head: list[str], rows: list[str], site: tuple[float, float] | None) -> Hazard:
    time, imt = _HEADED.search(comments), _IMT.search(comments)
    kind_of_curve = _KIND.search(comments) or _KIND_OF_NAME.match(name)
    statistic = _statistic(kind_of_curve["kind"] if kind_of_curve else "", name)
    if time is None or float(time[1]) <= 0.0:
        raise InputError(f"{name} does not state its investigation_time; export the curve again with its header.")
    at = [k for k, heading in enumerate(head) if _POE.fullmatch(heading)]
    im = np.array([_number(name, 1, [head[k].removeprefix("poe-")], 0) for k in at])
    cells = [row.split(",") for row in rows]
    if any(len(row) != len(head) for row in cells):
        raise InputError(f"{name} has rows with more or fewer fields than its header; export the curve again.")
    places = None
    if "lon" in head and "lat" in head:
        places = [
            [_number(name, k, row, head.index(axis)) for axis in ("lon", "lat")] for k, row in enumerate(cells, 2)
        ]
    chosen = _nearest(name, len(cells), places if len(cells) > 1 else None, site)
    poe = np.array([_number(name, chosen + 2, cells[chosen], k) for k in at])
    kind = "" if imt is None else imt[1] + (f"({imt[2]})" if imt[2] else "")
    return _of_chances(name, kind, statistic, float(time[1]), im, poe)


def _nearest(name: str, number: int, places: list[list[float]] | None, site: tuple[float, float] | None) -> int:
    """Which of several sites is meant."""
    if number == 1:
        return 0
    if places is None or any(len(place) != 2 for place in places):
        raise InputError(f"{name} holds {number} sites without longitude and latitude; give a file of one site.")
    if site is None:
        raise InputError(f"{name} holds {number} sites; choose one with `site=LON,LAT`.", "site")
    away = [_distance_km(place, site) for place in places]
    nearest = int(np.argmin(away))
    if not away[nearest] <= FAR:
        there, site_text = (f"{place[0]:g},{place[1]:g}" for place in (places[nearest], site))
        raise InputError(
            f"the site of {name} that is nearest to `site` = {site_text} is {there}, {away[nearest]:.0f} km away; allowed "
            f"is up to {FAR:g} km: longitude first, then latitude.",
            "site",
        )
    return nearest


def _distance_km(place: Sequence[float], other: Sequence[float]) -> float:
    """Distance of two places of longitude and latitude [degrees] on a sphere [km]."""
    (east, north), (to_east, to_north) = np.radians(place), np.radians(other)
    half = math.sin(0.5 * (to_north - north)) ** 2
    half += math.cos(north) * math.cos(to_north) * math.sin(0.5 * (to_east - east)) ** 2
    return 2.0 * EARTH_RADIUS_KM * math.asin(math.sqrt(min(half, 1.0)))


def _of_chances(name: str, kind: str, statistic: str, time: float, im: np.ndarray, poe: np.ndarray) -> Hazard:
    """The curve of probabilities of exceedance in a time [y]; PGV in cm/s, all else in g."""
    if not ((poe >= 0.0) & (poe <= 1.0)).all():
        raise InputError(f"{name} has a probability of exceedance outside 0 to 1; mend the file.")
    velocity = kind.upper().startswith("PGV")
    sure = poe < 1.0  # a certain exceedance has no rate
    rate = -np.log1p(-poe[sure]) / time
    return Hazard(im[sure] * (0.01 if velocity else 1.0), rate, "m/s" if velocity else "g", name, kind, statistic)


def _nrml(name: str, text: str, site: tuple[float, float] | None) -> Hazard:
    """Hazard curves of one measure, at one site or several, as NRML writes them."""
    from xml.etree import ElementTree

    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise InputError(f"{name} declares entities, which no hazard curve needs; export it again as NRML.")
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise InputError(f"{name} is no XML that can be read ({error}); export it again.") from None

    def inside(element: ElementTree.Element, tag: str) -> list[ElementTree.Element]:
        return [child for child in element.iter() if child.tag.rpartition("}")[2] == tag]

    def numbers(element: ElementTree.Element, tag: str) -> np.ndarray:
        elements = inside(element, tag)
        cells = (elements[0].text or "").split() if elements else []
        return np.array([_number(f"{tag} of {name}", 1, [cell], 0) for cell in cells])

    sets = inside(root, "hazardCurves")
    if len(sets) != 1:
        raise InputError(f"{name} holds {len(sets)} sets of hazard curves (hazardCurves); give a file of one measure.")
    (curve_set,) = sets
    each, im = inside(curve_set, "hazardCurve"), numbers(curve_set, "IMLs")
    time = _number(f"investigationTime of {name}", 1, [curve_set.get("investigationTime", "")], 0)
    if not time > 0.0 or not each:
        raise InputError(f"{name} has no hazard curve with an investigation time; export it again as NRML.")
    places = [numbers(element, "pos").tolist()[:2] for element in each]
    poe = numbers(each[_nearest(name, len(each), places, site)], "poEs")
    if len(poe) != len(im):
        raise InputError(f"{name} has {len(im)} intensities and {len(poe)} probabilities; mend the file.")
    period, kind = curve_set.get("saPeriod"), curve_set.get("statistics", "")
    if kind == "quantile":
        kind += f"-{curve_set.get('quantileValue', '')}"
    elif not kind and curve_set.get("sourceModelTreePath"):
        kind = f"{curve_set.get('sourceModelTreePath')}~{curve_set.get('gsimTreePath', '')}"
    imt, damping = curve_set.get("IMT", ""), curve_set.get("saDamping")
    if damping and _number(f"saDamping of {name}", 1, [damping], 0) not in (0.05, 5.0):
        raise InputError(f"{name} is of a damping of {damping} (saDamping); allowed is 5 %, that of all spectra here.")
    if period:
        imt += f"({_number(f'saPeriod of {name}', 1, [period], 0):g})"
    return _of_chances(name, imt, _statistic(kind, name), time, im, poe)


def _number(name: str, line: int, cells: list[str], k: int) -> float:
    try:
        return float(cells[k])
    except (ValueError, IndexError):
        cell = cells[k] if k < len(cells) else "nothing"
        raise InputError(f"line {line} of {name} has {cell!r} where a number is needed; mend the file.") from None


#: Share of the rate beyond the ends of a hazard curve above which it is said [-].
BEYOND = 0.05

#: Times the rate from which on it is not told how much weaker shaking would add.
MANY = 10.0

#: A rate of a state above which it is said that something is wrong [1/y].
OFTEN = 1.0

#: Kinds of intensity whose hazard is known well enough to doubt one.
ENVELOPED = ("pga", "pgv", "sa", "avgsa")

#: Parts of a decade of the intensity by which a rate is deaggregated.
PARTS = 10


@dataclass(frozen=True, eq=False)
class Risk(NotebookSummary):
    """Mean annual rate of a state.

    Parameters
    ----------
    fragility : Fragility
    hazard : Hazard
    rate : float
        [1/y], of shaking from the first intensity of the hazard curve on; beyond its last one all counts with the
        probability that it has there.
    low, high : float
        Interval by the bootstrap of the fragility, whatever its runs without a verdict come to; its upper end holds what
        shaking beyond both ends of the hazard curve may add [1/y].
    beyond : float
        What stronger shaking than the last intensity could add at most [1/y].
    weaker : float
        What shaking below the first intensity would add, with the first slope of the curve carried on [1/y].
    edges, parts : array
        Intensities, shape (k + 1,), and the rate that comes from between them [1/y], shape (k,); the last part is that of
        the shaking beyond the curve.
    extremes : (float, float)
        Rates if all undecided and failed runs exceed the state, and if none does [1/y]; NaN where they make no curve.
    doubt : str
        What about the hazard curve is not plausible.
    """

    fragility: Fragility
    hazard: Hazard
    rate: float
    low: float
    high: float
    beyond: float
    weaker: float
    edges: np.ndarray
    parts: np.ndarray
    extremes: tuple[float, float]
    doubt: str = ""

    @property
    def warnings(self) -> list[str]:
        """Doubts about the result, and limits of the hazard curve, in sentences."""
        warnings = [*self.fragility.warnings, *([joined("", [self.doubt, "."])] if self.doubt else [])]
        warnings += [self._without_verdict] if self._without_verdict else []
        if self.fragility.evidence.measure == "im" and self.hazard.unit != "-":
            words = say(
                "the runs do not say what their intensity is; it is taken for that of {hazard.name}, in {hazard.unit}: "
                "state the intensity of the runs."
            )
            warnings.append(words.of(hazard=self.hazard))
        elif self.fragility.evidence.measure != "im" and not self.hazard.imt:
            measure, end = parse_measure(self.fragility.evidence.measure), ENDS[self.hazard.unit]
            words = say(
                "{hazard} does not say of which intensity its column im{end} is; it is taken for {im.name}: name the column "
                "{im.key} if it is."
            )
            warnings.append(words.of(hazard=self.hazard.name, end=end, im=measure))
        if self.rate > OFTEN:
            words = say(
                "{state} {rate:.3g} times a year leaves no such column to ask about: check the intensities of the runs and "
                "{hazard}."
            )
            state = say(self.fragility.evidence.state)
            warnings.append(words.of(state=state, rate=self.rate, hazard=self.hazard.name))
        if self.beyond > BEYOND * self.rate:
            words = say("{hazard} ends at {im:g} {unit}; stronger shaking could add up to {share} to the rate.")
            much = percent(self.beyond / max(self.rate, 1e-300))
            known = {"hazard": self.hazard.name, "im": self.hazard.im[-1], "unit": self.hazard.unit}
            warnings.append(words.of(share=much, **known))
        return warnings + ([late] if (late := begins_late(self.hazard, self.weaker, self.rate)) else [])

    @property
    def _without_verdict(self) -> str:
        """Rate with the runs that the curve leaves out; empty where there are none."""
        summary = self.fragility.summary()
        names = {"undecided": say("{count} undecided"), "failed": say("{count} failed")}
        counts = [words.of(count=summary[verdict]) for verdict, words in names.items() if summary[verdict]]
        if not counts:
            return ""
        most, least = (digits(rate, ".3g") if math.isfinite(rate) else say("not known") for rate in self.extremes)
        return say(
            "{counts} of {all} runs: counted as {state} the annual rate by {hazard} is {most}, counted as none {least}; the "
            "curve leaves them out, its interval holds both.",
            counts=joined(say(" and "), counts), all=summary["runs"], state=say(self.fragility.evidence.state),
            hazard=self.hazard.name, most=most, least=least,
        )  # fmt: skip

    @property
    def sentence(self) -> str:
        """How often it comes to the state, in a sentence."""
        e = self.fragility.evidence
        message = say("{name}: {state} never.") if self.rate == 0.0 else say("{name}: {state} once in {years}.")
        message = message.of(name=e.name, state=say(e.state), years=years(1.0 / self.rate) if self.rate else "")
        statistic = self.hazard.statistic
        return joined(
            " ", [message, say("The hazard curve is the {statistic}.", statistic=statistic) if statistic else ""]
        )

    def summary(self) -> dict[str, Any]:
        """The JSON object of ``stylobate risk``."""
        f = self.fragility
        return {
            "sentence": self.sentence,
            "annual_rate": self.rate,
            "annual_rate_low": self.low,
            "annual_rate_high": self.high,
            "return_period_y": 1.0 / self.rate if self.rate > 0.0 else None,
            "return_period_low_y": 1.0 / self.high if self.high > 0.0 else None,
            "return_period_high_y": 1.0 / self.low if self.low > 0.0 else None,
            "annual_rate_if_open_exceed": self.extremes[0],
            "annual_rate_if_open_do_not": self.extremes[1],
            "beyond_hazard_at_most": self.beyond,
            "state": f.evidence.state,
            "im": f.evidence.measure,
            "unit": f.evidence.unit,
            "median": f.median,
            "beta": f.beta,
            "hazard": self.hazard.name,
            "hazard_statistic": self.hazard.statistic or None,
            "name": f.evidence.name,
            "fragility": {key: value for key, value in f.summary().items() if key not in ("curve", "points")},
            "deaggregation": [
                {"from": a, "to": b, "annual_rate": p}
                for a, b, p in zip(self.edges[:-1].tolist(), self.edges[1:].tolist(), self.parts.tolist())
            ],
            "warnings": self.warnings,
        }


def risk(fragility: Fragility, hazard: Hazard) -> Risk:
    """Mean annual rate of a state, Eq. (G4).

    Raises
    ------
    InputError
        Fragility and hazard are of different intensities.
    """
    check_kind("fragility", fragility, Fragility)
    check_kind("hazard", hazard, Hazard)
    doubt = check_intensity(fragility.evidence.measure, fragility.evidence.unit, hazard)
    rate, edges, parts = _rate(hazard, fragility.log_median, fragility.beta)
    low, high = _limits(hazard, fragility)
    beyond = check_reach(hazard, fragility.log_median, fragility.beta, rate, fragility.evidence.state)
    least = fragility.median_interval[0]
    may_add = weaker_than(hazard, math.log(least) if least > 0.0 else -math.inf, fragility.beta)
    # no rate is above that of all shaking in the curve, and what is beyond its ends may add to it
    return Risk(
        fragility,
        hazard,
        rate,
        low,
        min(high + beyond, float(hazard.rate[0])) + may_add,
        beyond,
        weaker_than(hazard, fragility.log_median, fragility.beta),
        edges,
        parts,
        tuple(_rate(hazard, *extreme, split=False)[0] for extreme in fragility.extremes),  # type: ignore[arg-type]
        doubt,
    )


def check_intensity(measure: str, unit: str, hazard: Hazard) -> str:
    """Doubt about the rates of a hazard curve for a fragility over an intensity, in a clause; empty where there is none.

    Raises
    ------
    InputError
        Fragility and hazard are of different intensities.
    """
    if hazard.unit not in ("-", unit) and unit != "-":
        raise InputError(
            f"the fragility is over {measure} in {unit} and {hazard.name} is in {hazard.unit}; give a hazard curve of "
            f"{measure}, or another `im`."
        )
    imt = hazard.imt.upper()
    if imt and measure != "im" and not _same(imt, measure):
        raise InputError(
            f"the fragility is over {measure} and {hazard.name} is of {hazard.imt}; give one of {measure}."
        )
    kind = measure.partition("@")[0].partition(":")[0]
    kind = hazard.imt.lower().partition("(")[0] if kind == "im" else kind  # what the runs do not say, the hazard may
    return hazard.doubt() if kind in ENVELOPED and hazard.unit in ("g", "m/s") else ""


def check_reach(hazard: Hazard, log_median: float, beta: float, rate: float, state: str) -> float:
    """What stronger shaking than the last intensity of a curve could add to a rate at most [1/y].

    Raises
    ------
    InputError
        That is most of it.
    """
    last = float(curve(hazard.im[-1:], log_median, beta)[0])
    beyond = float(hazard.rate[-1]) * (1.0 - last)
    if beyond > rate:
        enough = math.exp(log_median + beta)
        rare = years(1.0 / float(hazard.rate[-1]))
        raise InputError(
            f"{hazard.name} ends at {hazard.im[-1]:g} {hazard.unit}, once in {rare}, where the probability of {state} is "
            f"{last:.2g}: most of the rate comes from stronger shaking, of which it says nothing; give a curve to "
            f"{enough:.2g} {hazard.unit} or more."
        )
    return beyond


def doubts(
    hazard: Hazard, measure: str, unit: str, log_median: float, beta: float, rate: float, state: str
) -> list[str]:
    """Doubts about a hazard curve for a fragility, in sentences; refusals as of the checks of intensity and of reach."""
    doubt = check_intensity(measure, unit, hazard)
    check_reach(hazard, log_median, beta, rate, state)
    late = begins_late(hazard, weaker_than(hazard, log_median, beta), rate)
    return [text for text in (doubt and joined("", [doubt, "."]), late) if text]


def weaker_than(hazard: Hazard, log_median: float, beta: float) -> float:
    """Rate from shaking below the first intensity of a curve, with its first slope carried on [1/y].

    With λ = λ₁ (x/x₁)⁻ᵏ below the first point it is ∫ P dλ = λ₁ (e^{k (y₁ − ln θ) + k²β²/2} Φ(z₁ + kβ) − Φ(z₁)) of
    y₁ = ln x₁, z₁ = (y₁ − ln θ)/β: Eq. (G5) from −∞ on.
    """
    if math.isinf(log_median):
        return 0.0 if log_median > 0.0 else math.inf
    y, log_rate = np.log(hazard.im[:2]), np.log(hazard.rate[:2])
    slope = float(-np.diff(log_rate)[0] / np.diff(y)[0])
    z, shift = (float(y[0]) - log_median) / beta, slope * beta
    exponent = float(log_rate[0]) + slope * (float(y[0]) - log_median) + 0.5 * shift**2 + float(log_ndtr(z + shift))
    return max((math.exp(exponent) if exponent < 700.0 else math.inf) - float(hazard.rate[0]) * float(ndtr(z)), 0.0)


def begins_late(hazard: Hazard, weaker: float, rate: float) -> str:
    """Caveat on a curve that begins above shaking which matters, in a sentence; empty where it does not."""
    if weaker <= BEYOND * rate:
        return ""
    many = say("more than {many:g} times as much", many=MANY)
    much = percent(weaker / rate) if 0.0 < rate and weaker < MANY * rate else many
    return say(
        "{hazard.name} begins at {hazard.im[0]:g} {hazard.unit}; weaker shaking, with its first slope carried on, would add "
        "{share} to the rate.", hazard=hazard, share=much,
    )  # fmt: skip


def years(value: float) -> str:
    """A time for people."""
    if value < 10.0:
        return say("{number:.2g} years", number=value)
    return say("{number:,.0f} years", number=float(f"{value:.2g}"))


def rates(hazard: Hazard, log_median: np.ndarray, beta: np.ndarray) -> np.ndarray:
    """Rates of lognormal fragilities under one hazard curve [1/y], the shape of ``log_median`` and ``beta``."""
    y, log_rate = np.log(hazard.im), np.log(hazard.rate)
    parts = _stretches(y, log_rate, log_median[..., None], beta[..., None])
    return parts.sum(axis=-1) + hazard.rate[-1] * ndtr((y[-1] - log_median) / beta)


def _stretches(y: np.ndarray, log_rate: np.ndarray, log_median: Any, beta: Any) -> np.ndarray:
    """The closed solution on every straight stretch of a hazard curve.  # Eq. (G5)"""
    slope = -np.diff(log_rate) / np.diff(y)
    z = (y - log_median) / beta
    own = np.exp(log_rate[:-1]) * ndtr(z[..., :-1]) - np.exp(log_rate[1:]) * ndtr(z[..., 1:])
    shift = slope * beta
    # k₀ exp(−k ln θ + k²β²/2) with k₀ from the left end, in one exponent
    exponent = log_rate[:-1] + slope * (y[:-1] - log_median) + 0.5 * shift**2
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        gain = np.nan_to_num(np.exp(exponent + log_interval(z[..., :-1] + shift, z[..., 1:] + shift)))
    return np.maximum(own + gain, 0.0)


def _rate(hazard: Hazard, log_median: float, beta: float, split: bool = True) -> tuple[float, np.ndarray, np.ndarray]:
    """Rate, edges and parts, over parts of a decade where it is to be split."""
    y = np.log(hazard.im)
    bins = y[[0, -1]]
    if split:
        step = math.log(10.0) / PARTS
        inner = step * np.arange(math.floor(y[0] / step) + 1, math.ceil(y[-1] / step))
        bins = np.concatenate((y[:1], inner, y[-1:]))
        y = np.unique(np.concatenate((y, inner)))
    log_rate = np.interp(y, np.log(hazard.im), np.log(hazard.rate))
    if math.isinf(log_median):
        ends = curve(np.exp(y), log_median, beta)
        parts = -np.diff(np.exp(log_rate)) * ends[1:]
    else:
        parts = _stretches(y, log_rate, log_median, beta)
    last = float(np.exp(log_rate[-1]) * curve(np.exp(y[-1:]), log_median, beta)[0])
    rate = float(parts.sum()) + last
    parts = np.add.reduceat(parts, np.searchsorted(y, bins[:-1] - 1e-12))
    return rate, np.append(np.exp(bins), np.inf), np.append(parts, last)


def _limits(hazard: Hazard, fragility: Fragility) -> tuple[float, float]:
    """Confidence limits of the rate [1/y], whatever open runs come to; 0 and +inf where none is known."""
    rate = _rate(hazard, fragility.log_median, fragility.beta, split=False)[0]
    samples, plausible = (
        np.array([_rate(hazard, float(m), math.exp(s), split=False)[0] for m, s in pairs])
        for pairs in (fragility.samples, fragility.region)
    )
    with np.errstate(divide="ignore"):
        low, high = fragility.limits(math.log(max(rate, 1e-300)), np.log(samples), np.log(plausible))
    low, high = math.exp(low), math.exp(min(high, 700.0))
    if fragility.ends:
        most, least = fragility.ends
        low = 0.0 if least is None else min(low, _limits(hazard, least)[0])
        high = math.inf if most is None else max(high, _limits(hazard, most)[1])
    return low, high


def _same(imt: str, measure: str) -> bool:
    if imt == measure.upper():
        return True
    kind = measure.partition("@")[0]
    if kind.startswith("sa:"):
        return imt.startswith("SA(") and math.isclose(float(imt[3:-1]), float(kind[3:-1]), rel_tol=1e-3)
    return imt == kind.upper()
