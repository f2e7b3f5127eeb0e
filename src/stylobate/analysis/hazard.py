"""Hazard curves: how often a year the shaking at a site is stronger than so much; our own CSV, OpenQuake's, and NRML."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import InputError
from ..messages import say
from ..motion.intensity_specs import ENDS, measure_of_column
from ..reading import read_bytes, shown
from . import tables

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
        if (rate < 0.0).any() or not np.isfinite(rate).all() or not (np.isfinite(im) & (im > 0.0)).all():
            raise InputError(
                f"hazard curve {self.name} has an intensity that is not positive, or a rate below 0; mend the file."
            )
        im, rate = im[positive], rate[positive]
        if len(im) < 2 or (np.diff(im) == 0.0).any():
            raise InputError(
                f"hazard curve {self.name} has {len(np.unique(im))} intensities with a rate; it needs at least two that "
                "differ."
            )
        rises = np.flatnonzero(np.diff(rate) > 0.0)
        if rises.size:
            k, remedy = int(rises[0]), "check its rows and columns"
            if (rate >= 1.0).all() and (np.diff(rate) > 0.0).all():
                remedy = "these look like return periods: give 1 over the period as annual_rate"
            raise InputError(
                f"hazard curve {self.name} rises from {rate[k]:.3g} a year at {im[k]:g} {self.unit} to {rate[k + 1]:.3g} at "
                f"{im[k + 1]:g}, and the rate of exceeding more cannot be larger; {remedy}."
            )
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
        told = ""
        for im, rate, why in ENVELOPE:
            at = self.at(im)
            text = say(
                "by {hazard.name} shaking of {im:g} {hazard.unit} is exceeded {at:.3g} times a year, and where the Earth "
                "shakes most about {rate:g}; {why}", hazard=self, im=im, at=at, rate=rate, why=why,
            )  # fmt: skip
            if at > REFUSED * rate:
                raise InputError(f"{text}.")
            told = told or (text if at > rate else "")
        return told

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
    text = tables.text_of(read_bytes(path, MOST), shown(path))
    if text.lstrip().startswith("<"):
        return _nrml(shown(Path(path).name), text, site)
    lines = [line.strip() for line in text.replace("\r", "").split("\n") if line.strip()]
    comments = [line for line in lines if line.startswith("#")]
    lines = [line for line in lines if not line.startswith("#")]
    head = [part.strip().strip('"') for part in lines[0].split(",")] if lines else []
    if any(_POE.fullmatch(one) for one in head):
        return _openquake(shown(Path(path).name), " ".join(comments), head, lines[1:], site)
    table = tables.read(
        path, MOST, "annual_rate", "im_g or im_m_s, and annual_rate, or to be a hazard curve of OpenQuake"
    )
    name = shown(Path(path).name)
    measures = {column: measure_of_column(column) for column in table.columns}
    keys = [one for one, measure in measures.items() if one in COLUMNS or measure is not None]
    if len(keys) != 1:
        raise InputError(
            f"{name} has the columns {shown(', '.join(table.columns))[:200]}; it needs one intensity beside annual_rate, "
            f"called after its measure, such as pgv_m_s, pga_g or sa_1s_g, or {', '.join(COLUMNS)}."
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
    found = _STATISTIC.fullmatch(kind)
    if kind and found is None:
        raise InputError(
            f"{name} is of the kind {kind!r}; allowed are curves of exceedance (mean, median, quantile-…, max, rlz-…), "
            "and a spread over the logic tree (std) is none: give the mean, or a quantile."
        )
    if found is None:
        return ""
    if found["quantile"]:
        return say("quantile {share:g}", share=float(found["quantile"]))
    if found["number"]:
        return say("realisation {count}", count=int(found["number"]))
    return _WORDS.get(kind, say("branch {name}", name=kind) if found["branch"] else say(kind))


def _openquake(name: str, said: str, head: list[str], rows: list[str], site: tuple[float, float] | None) -> Hazard:
    time, imt = _HEADED.search(said), _IMT.search(said)
    kind_of_curve = _KIND.search(said) or _KIND_OF_NAME.match(name)
    statistic = _statistic(kind_of_curve["kind"] if kind_of_curve else "", name)
    if time is None or float(time[1]) <= 0.0:
        raise InputError(f"{name} does not state its investigation_time; export the curve again with its header.")
    at = [k for k, one in enumerate(head) if _POE.fullmatch(one)]
    im = np.array([_number(name, 1, [head[k].removeprefix("poe-")], 0) for k in at])
    cells = [row.split(",") for row in rows]
    if any(len(row) != len(head) for row in cells):
        raise InputError(f"{name} has rows with more or fewer fields than its header; export the curve again.")
    places = None
    if "lon" in head and "lat" in head:
        places = [[_number(name, k, row, head.index(one)) for one in ("lon", "lat")] for k, row in enumerate(cells, 2)]
    chosen = _nearest(name, len(cells), places if len(cells) > 1 else None, site)
    poe = np.array([_number(name, chosen + 2, cells[chosen], k) for k in at])
    kind = "" if imt is None else imt[1] + (f"({imt[2]})" if imt[2] else "")
    return _of_chances(name, kind, statistic, float(time[1]), im, poe)


def _nearest(name: str, number: int, places: list[list[float]] | None, site: tuple[float, float] | None) -> int:
    """Which of several sites is meant."""
    if number == 1:
        return 0
    if site is None or places is None:
        raise InputError(f"{name} holds {number} sites; choose one with `site=LON,LAT`.", "site")
    away = [_distance_km(place, site) for place in places]
    nearest = int(np.argmin(away))
    if not away[nearest] <= FAR:
        there, asked = (f"{one[0]:g},{one[1]:g}" for one in (places[nearest], site))
        raise InputError(
            f"the site of {name} that is nearest to `site` = {asked} is {there}, {away[nearest]:.0f} km away; allowed is up "
            f"to {FAR:g} km: longitude first, then latitude.",
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
    if ((poe < 0.0) | (poe > 1.0)).any():
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
        return [one for one in element.iter() if one.tag.rpartition("}")[2] == tag]

    def numbers(element: ElementTree.Element, tag: str) -> np.ndarray:
        found = inside(element, tag)
        cells = (found[0].text or "").split() if found else []
        return np.array([_number(f"{tag} of {name}", 1, [cell], 0) for cell in cells])

    sets = inside(root, "hazardCurves")
    if len(sets) != 1:
        raise InputError(f"{name} holds {len(sets)} sets of hazard curves (hazardCurves); give a file of one measure.")
    (found,) = sets
    each, im = inside(found, "hazardCurve"), numbers(found, "IMLs")
    time = _number(f"investigationTime of {name}", 1, [found.get("investigationTime", "")], 0)
    if not time > 0.0 or not each:
        raise InputError(f"{name} has no hazard curve with an investigation time; export it again as NRML.")
    places = [numbers(one, "pos").tolist()[:2] for one in each]
    poe = numbers(each[_nearest(name, len(each), places, site)], "poEs")
    if len(poe) != len(im):
        raise InputError(f"{name} has {len(im)} intensities and {len(poe)} probabilities; mend the file.")
    period, kind = found.get("saPeriod"), found.get("statistics", "")
    if kind == "quantile":
        kind += f"-{found.get('quantileValue', '')}"
    elif not kind and found.get("sourceModelTreePath"):
        kind = f"{found.get('sourceModelTreePath')}~{found.get('gsimTreePath', '')}"
    imt = found.get("IMT", "") + (f"({float(period):g})" if period else "")
    return _of_chances(name, imt, _statistic(kind, name), time, im, poe)


def _number(name: str, line: int, cells: list[str], k: int) -> float:
    try:
        return float(cells[k])
    except (ValueError, IndexError):
        found = cells[k] if k < len(cells) else "nothing"
        raise InputError(f"line {line} of {name} has {found!r} where a number is needed; mend the file.") from None
