"""Ground motions of earthquakes: models of PGA and PGV at a distance, and the sources by magnitude, rate and place."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import log_ndtr, ndtr

from stylobate.constants import g
from stylobate.errors import InputError, check_choice, check_range, within
from stylobate.motion.motion import Motion

#: Styles of faulting.
MECHANISMS = ("normal", "reverse", "strike-slip")

#: Mean velocities of shear waves in the upper 30 m for which a site is taken [m/s].
VS30 = (150.0, 2000.0)

#: Distance at which residuals within one event are no longer alike, by measure [km]: of European records, exp(−3h/range)
#: (Esposito and Iervolino 2011, data set ESD).
CORRELATED = {"pga": 13.5, "pgv": 21.5}

_LN10 = math.log(10.0)


@dataclass(frozen=True, eq=False)
class GroundMotionModel:
    """A published model of the geometric mean of both horizontal components.

    Parameters
    ----------
    name : str
        As it is typed.
    words, reference : str
        What a person calls it, and its key in the bibliography.
    magnitudes, distances : (float, float)
        Moment magnitudes, and Joyner–Boore distances [km] for which it holds.
    coefficients : mapping
        By measure.
    median : callable
        Decimal logarithm of the median in cm/s² or cm/s, of coefficients, magnitude, distance, vs30 and mechanism.
    between, within : mapping
        Standard deviations of decimal logarithms from event to event, and from place to place in an event.
    """

    name: str
    words: str
    reference: str
    magnitudes: tuple[float, float]
    distances: tuple[float, float]
    coefficients: Mapping[str, Mapping[str, float]]
    median: Callable[[Mapping[str, float], np.ndarray, np.ndarray, float, str], np.ndarray]
    between: Mapping[str, float]
    within: Mapping[str, float]

    def log_median(
        self, measure: str, magnitude: np.ndarray, distance: np.ndarray, vs30: float, mechanism: str
    ) -> np.ndarray:
        """Natural logarithm of the median [g or m/s], shape of ``magnitude`` and ``distance`` together.

        Parameters
        ----------
        measure : str
            ``pga`` or ``pgv``.
        magnitude, distance : array
            Moment magnitude; distance from the surface projection of the rupture [km].
        vs30 : float
            [m/s]
        mechanism : str
            ``normal``, ``reverse`` or ``strike-slip``.

        Raises
        ------
        InputError
            Something lies beyond what the model was made for.
        """
        check_choice("intensity", measure, self.coefficients, of=self.words)
        check_choice("mechanism", mechanism, MECHANISMS)
        check_range("vs30", vs30, *VS30, unit="m/s")
        magnitude, distance = np.asarray(magnitude, dtype=float), np.asarray(distance, dtype=float)
        for what, values, (least, most), unit in (
            ("magnitude", magnitude, self.magnitudes, ""),
            ("distance", distance, self.distances, " km"),
        ):
            if values.size and not least <= values.min() <= values.max() <= most:
                worst = values.max() if values.max() > most else values.min()
                raise InputError(
                    f"{what} {worst:.4g}{unit} is beyond {self.words}, which holds from {least:g} to {most:g}{unit}; "
                    "choose another model, or leave out what it cannot tell.",
                    what,
                )
        of = self.coefficients[measure]
        unit = math.log(100.0 * (g if measure == "pga" else 1.0))
        return _LN10 * self.median(of, magnitude, distance, vs30, mechanism) - unit

    def spread(self, measure: str) -> tuple[float, float]:
        """Standard deviations of the natural logarithm, between events and within one [-]."""
        return _LN10 * self.between[measure], _LN10 * self.within[measure]


def alike(measure: str, apart: np.ndarray) -> np.ndarray:
    """Correlation of residuals within one event, by the distance of places from one another [km]."""
    return np.exp(-3.0 * np.asarray(apart, dtype=float) / CORRELATED[measure])


def _akkar_bommer(
    c: Mapping[str, float], m: np.ndarray, r: np.ndarray, vs30: float, mechanism: str
) -> np.ndarray:  # Akkar and Bommer 2010, Eq. 1
    soil = c["b7"] if vs30 < 360.0 else c["b8"] if vs30 <= 750.0 else 0.0
    style = {"normal": c["b9"], "reverse": c["b10"], "strike-slip": 0.0}[mechanism]
    path = (c["b4"] + c["b5"] * m) * np.log10(np.hypot(r, c["b6"]))
    return c["b1"] + c["b2"] * m + c["b3"] * m**2 + path + soil + style


def _bindi(
    c: Mapping[str, float], m: np.ndarray, r: np.ndarray, vs30: float, mechanism: str
) -> np.ndarray:  # Bindi et al. 2014, Eqs. 1 to 4 with Vs30; Mref = 5.5, Mh = 6.75, Rref = 1 km
    over = m - 6.75
    size = np.where(over <= 0.0, c["b1"] * over + c["b2"] * over**2, c["b3"] * over)
    far = np.hypot(r, c["h"])
    path = (c["c1"] + c["c2"] * (m - 5.5)) * np.log10(far) - c["c3"] * (far - 1.0)
    return c["e1"] + path + size + c["gamma"] * math.log10(vs30 / 800.0) + c[mechanism]


_AB = ("b1", "b2", "b3", "b4", "b5", "b6", "b7", "b8", "b9", "b10")
_B14 = ("e1", "c1", "c2", "h", "c3", "b1", "b2", "b3", "gamma", *MECHANISMS)

#: Models by the name that is typed. PGA of the first one has the coefficients of Bommer et al. (2012, table 5), PGV those of
#: the paper (table 1); of the second one both are those of its electronic supplement, which the erratum confirms.
MODELS = {
    model.name: model
    for model in (
        GroundMotionModel(
            "akkar-bommer-2010",
            "the model of Akkar and Bommer (2010)",
            "akkar2010",
            (5.0, 7.6),
            (0.0, 100.0),
            {
                "pga": dict(zip(_AB, (
                    1.43525, 0.74866, -0.06520, -2.72950, 0.25139, 7.74959, 0.08320, 0.00766, -0.05823, 0.07087))),
                "pgv": dict(zip(_AB, (
                    -2.12833, 1.21448, -0.08137, -2.46942, 0.22349, 6.41443, 0.20354, 0.08484, -0.05856, 0.01305))),
            },
            _akkar_bommer,
            {"pga": 0.1056, "pgv": 0.1083},
            {"pga": 0.2611, "pgv": 0.2562},
        ),
        GroundMotionModel(
            "bindi-2014",
            "the model of Bindi et al. (2014)",
            "bindi2014",
            (4.0, 7.6),
            (0.0, 300.0),
            {
                "pga": dict(zip(_B14, (
                    3.32819, -1.2398, 0.21732, 5.26486, 0.00118624, -0.0855045, -0.0925639, 0.0, -0.301899,
                    -0.0397695, 0.0775253, -0.0377558))),
                "pgv": dict(zip(_B14, (
                    2.26481, -1.22408, 0.202085, 5.06124, 0.0, 0.162802, -0.0926324, 0.0440301, -0.529443,
                    -0.00947675, 0.0400574, -0.0305805))),
            },
            _bindi,
            {"pga": 0.149977, "pgv": 0.156062},
            {"pga": 0.282398, "pgv": 0.277714},
        ),
    )
}  # fmt: skip


# -- Seismic sources --------------------------------------------------------------------------------------------------


#: Widest class of magnitudes, and farthest that two ruptures of one magnitude lie apart along a fault [km].
CLASS, ALONG = 0.1, 5.0

#: Rings and rays of epicentres in a disc; strikes of ruptures whose strike nobody knows.
RINGS, RAYS, STRIKES = 8, 16, 8

#: Radius of the Earth [km].
EARTH = 6371.0


@dataclass(frozen=True)
class Source:
    """A fault, a point or a disc of epicentres, whose ruptures are straight and upright.

    Parameters
    ----------
    name : str
    ends : tuple of (float, float)
        Longitude and latitude of a point or centre, or of both ends of a fault [degrees].
    magnitudes : (float, float)
        Smallest and largest moment magnitude; equal for earthquakes of one size.
    rate : float
        Of earthquakes of the smallest magnitude or more [1/y].
    b : float
        Slope of Gutenberg and Richter: from magnitude to magnitude there are 10^b times fewer.
    mechanism : str
        ``normal``, ``reverse`` or ``strike-slip``.
    radius : float
        Of the disc in which epicentres are spread evenly [km].
    strike : float, optional
        Of ruptures about a point, from north [degrees]; all are as likely where nobody knows it.
    """

    name: str
    ends: tuple[tuple[float, float], ...]
    magnitudes: tuple[float, float]
    rate: float
    b: float = 1.0
    mechanism: str = "strike-slip"
    radius: float = 0.0
    strike: float | None = None

    def __post_init__(self) -> None:
        of = f"source {self.name!r}"
        check_range("magnitude", self.magnitudes[0], 3.0, 9.5, of=of)
        check_range("largest magnitude", self.magnitudes[1], self.magnitudes[0], 9.5, of=of)
        check_range("rate", self.rate, 0.0, 100.0, unit="a year", of=of, open_low=True)
        check_range("b", self.b, 0.1, 3.0, of=of)
        check_range("radius", self.radius, 0.0, 300.0, unit="km", of=of)
        check_choice("mechanism", self.mechanism, MECHANISMS, of=of)
        for lon, lat in self.ends:
            check_range("longitude", lon, -180.0, 180.0, unit="degrees", of=of)
            check_range("latitude", lat, -85.0, 85.0, unit="degrees", of=of)
        if len(self.ends) == 2 and (self.radius or self.strike is not None):
            raise InputError(f"{of} has two ends, and a radius or a strike; a fault needs neither, leave them out.")

    def sizes(self) -> tuple[np.ndarray, np.ndarray]:
        """Magnitudes in the middle of classes, and how often a year each comes, shape (m,)."""
        least, most = self.magnitudes
        if most == least:
            return np.array([least]), np.array([self.rate])
        edges = np.linspace(least, most, math.ceil((most - least) / CLASS - 1e-9) + 1)
        above = 10.0 ** (-self.b * (edges - least))  # truncated at both ends
        return 0.5 * (edges[1:] + edges[:-1]), self.rate * -np.diff(above) / (1.0 - above[-1])


@dataclass(frozen=True, eq=False)
class Events:
    """Ruptures of one source: straight, seen from above.

    Parameters
    ----------
    magnitude, rate : array
        Moment magnitude, and how often a year each comes, shape (e,).
    ends : array
        Of each rupture, shape (e, 2, 2), in the plane of :func:`plane` [km].
    """

    magnitude: np.ndarray
    rate: np.ndarray
    ends: np.ndarray

    def distance(self, place: np.ndarray) -> np.ndarray:
        """Shortest distance from a place on the ground [km], shape (e,): that of Joyner and Boore for upright ruptures."""
        first, along = self.ends[:, 0], self.ends[:, 1] - self.ends[:, 0]
        length = np.maximum((along**2).sum(axis=1), 1e-12)
        share = np.clip(((place - first) * along).sum(axis=1) / length, 0.0, 1.0)
        return np.linalg.norm(first + share[:, None] * along - place, axis=1)


def plane(places: Sequence[tuple[float, float]], middle: tuple[float, float]) -> np.ndarray:
    """East and north of a middle [km] of longitudes and latitudes [degrees], shape (n, 2); right within some 300 km."""
    angles = np.radians(np.asarray(places, dtype=float) - np.asarray(middle))
    return EARTH * angles * [math.cos(math.radians(middle[1])), 1.0]


def rupture_length(magnitude: float) -> float:
    """Length of a rupture below the ground [km] (Wells and Coppersmith 1994, all mechanisms)."""
    return 10.0 ** (0.59 * magnitude - 2.44)


def events_of(source: Source, middle: tuple[float, float]) -> Events:
    """Ruptures of a source: evenly along a fault, never beyond its ends; about a point or in a disc by their strike."""
    ends = plane(source.ends, middle)
    ruptures = []
    for magnitude, rate in zip(*source.sizes(), strict=True):
        length = rupture_length(float(magnitude))
        if len(ends) == 2:
            whole = float(np.linalg.norm(ends[1] - ends[0]))
            run = max(whole - length, 0.0)
            number = math.ceil(run / ALONG) + 1
            begin = np.linspace(0.0, run, number)[:, None] / whole
            end = begin + min(length, whole) / whole
            pieces = np.stack([ends[0] + share * (ends[1] - ends[0]) for share in (begin, end)], axis=1)
        else:
            strikes = np.arange(STRIKES) * 180.0 / STRIKES if source.strike is None else np.array([source.strike])
            turned = np.radians(strikes)
            half = 0.5 * length * np.stack((np.sin(turned), np.cos(turned)), axis=1)
            middles = _disc(ends[0], source.radius)[:, None]
            pieces = np.stack((middles - half, middles + half), axis=2).reshape(-1, 2, 2)
        ruptures.append((np.full(len(pieces), magnitude), np.full(len(pieces), rate / len(pieces)), pieces))
    return Events(*(np.concatenate(parts) for parts in zip(*ruptures, strict=True)))


def _disc(centre: np.ndarray, radius: float) -> np.ndarray:
    """Epicentres, each for the same area."""
    if radius == 0.0:
        return centre[None]
    far = radius * np.sqrt((np.arange(RINGS) + 0.5) / RINGS)
    turned = 2.0 * np.pi * (np.arange(RAYS) + 0.5 * (np.arange(RINGS)[:, None] % 2)) / RAYS
    return centre + np.stack((far[:, None] * np.cos(turned), far[:, None] * np.sin(turned)), axis=2).reshape(-1, 2)


# Pulses in two horizontal directions: the ground's velocity goes round an ellipse under a bell that rises and falls.

#: Samples in a period; the acceleration is linear between them.
IN_A_PERIOD = 100


def elliptical_pulse(
    period: float,
    velocity: float,
    *,
    azimuth: float = 0.0,
    ellipticity: float = 0.0,
    cycles: float = 2.0,
    phase: float = 90.0,
) -> Motion:
    """The near-fault pulse of Mavroeidis and Papageorgiou along one axis, a quarter of a cycle late across it.

    Parameters
    ----------
    period : float
        T, of the carrier [s].
    velocity : float
        Largest length of the ground's velocity vector [m/s].
    azimuth : float
        α: direction of the strong axis, from x towards y [degrees].
    ellipticity : float
        e: peak velocity across the strong axis over that along it [-]; 0 for straight shaking.
    cycles : float
        γ: length of the pulse in periods, above 1 [-].
    phase : float
        ν: of the carrier in the middle of the pulse [degrees].

    Returns
    -------
    Motion
        Samples of a pulse of 1 m/s, scaled by ``velocity``.

    Raises
    ------
    InputError
        A number outside its range.

    Notes
    -----
    With τ the time from the middle, along and across the strong axis,

        v = (A/2) [1 + cos(2πτ/(γT))] (cos(2πτ/T + ν), e sin(2πτ/T + ν))

    for |τ| ≤ γT/2 and zero elsewhere. To turn by 180° is to add 180° to the phase: where every phase is as likely, the
    strong axis has no sense, and azimuths that differ by 180° are the same.

    References
    ----------
    Mavroeidis and Papageorgiou (2003).
    """
    length = check_range("period", period, 1e-3, 1e3, unit="s")
    peak = check_range("velocity", velocity, 0.0, 1e3, unit="m/s")
    alpha = np.radians(check_range("azimuth", azimuth, -360.0, 360.0, unit="degrees"))
    aside = check_range("ellipticity", ellipticity, 0.0, 1.0)
    gamma = check_range("cycles", cycles, 1.0, 20.0, open_low=True)
    nu = np.radians(check_range("phase", phase, -360.0, 360.0, unit="degrees"))
    steps = int(np.ceil(gamma * IN_A_PERIOD))
    time = np.linspace(-0.5 * gamma, 0.5 * gamma, steps + 1)  # in periods
    bell, slope = 1.0 + np.cos(2.0 * np.pi * time / gamma), -np.sin(2.0 * np.pi * time / gamma) / gamma
    angle = 2.0 * np.pi * time + nu
    carrier, rate = np.stack((np.cos(angle), aside * np.sin(angle))), np.stack((-np.sin(angle), aside * np.cos(angle)))
    unit = float(np.hypot(*(bell * carrier)).max())  # of the velocity, times 2/A
    flat = 2.0 * np.pi / length * (slope * carrier + bell * rate) / unit  # dv/dt of a pulse of 1 m/s
    x = np.cos(alpha) * flat[0] - np.sin(alpha) * flat[1]
    y = np.sin(alpha) * flat[0] + np.cos(alpha) * flat[1]
    facts = {"pulse_length": gamma * length, "references": ("mavroeidis2003",)}
    name = f"pulse {length:.3g} s, {peak:.3g} m/s, towards {azimuth:.3g}°"
    return Motion(gamma * length / steps, x, y, factor=peak, name=name, metadata=facts)


# Earthquakes that shake several places at once: rates of what they reach there, one by one and together.

#: Events whose medians differ at no place by more than this count as one [-], in the logarithm.
CELL = 0.1

#: Share of the rate whose events are taken for ones that reach one state at most [-].
NEGLIGIBLE_SHARE = 2e-3


@dataclass(frozen=True, eq=False)
class SharedEvents:
    """Events as places feel them: ln im = μ + τη + φε, η one number for an event, ε alike at places that are near.

    Parameters
    ----------
    rate : array, shape (e,)
        [1/y]
    log_median : array, shape (e, s)
        μ at each place.
    between, within : float
        τ, φ.
    root : array, shape (s, s)
        Of the covariance of τη + φε from place to place: it is ``root @ root.T``.
    """

    rate: np.ndarray
    log_median: np.ndarray
    between: float
    within: float
    root: np.ndarray

    @property
    def spread(self) -> float:
        """Standard deviation of ln im at one place."""
        return float(np.hypot(self.between, self.within))

    @classmethod
    def of(
        cls, sources: Sequence[Source], model: GroundMotionModel, measure: str,
        places: Sequence[tuple[float, float]], vs30: Sequence[float], names: Sequence[str],
    ) -> SharedEvents:  # fmt: skip
        """Events of sources at places.

        Parameters
        ----------
        sources : sequence of Source
        model : GroundMotionModel
        measure : str
            ``pga`` or ``pgv``.
        places : sequence of (float, float)
            Longitude and latitude [degrees].
        vs30 : sequence of float
            [m/s]
        names : sequence of str
            Of the places.

        Raises
        ------
        InputError
            The model does not hold for a magnitude, or as far as a place lies from a source.
        """
        middle = (float(np.mean([point[0] for point in places])), float(np.mean([point[1] for point in places])))
        flat = plane(places, middle)
        rates, medians = [], []
        for source in sources:
            events = events_of(source, middle)
            rates.append(events.rate)
            felt = []
            for place, soil, name in zip(flat, vs30, names, strict=True):
                with within(f"source {source.name!r} at {name!r}"):
                    far = events.distance(place)
                    felt.append(model.log_median(measure, events.magnitude, far, soil, source.mechanism))
            medians.append(np.stack(felt, axis=1))
        rate, median = _gathered(np.concatenate(rates), np.concatenate(medians))
        apart = np.linalg.norm(flat[:, None] - flat[None], axis=2)
        between, inside = model.spread(measure)
        values, vectors = np.linalg.eigh(between**2 + inside**2 * alike(measure, apart))
        return cls(rate, median, between, inside, vectors * np.sqrt(np.maximum(values, 0.0)))

    def curve(self, im: np.ndarray) -> np.ndarray:
        """How often a year intensities are exceeded at each place, shape (s, k)."""
        z = (self.log_median[:, :, None] - np.log(im)) / self.spread
        return np.tensordot(self.rate, ndtr(z), axes=1)

    def each(self, place: np.ndarray, log_median: np.ndarray, beta: np.ndarray) -> np.ndarray:
        """Rate of each state by itself, in closed form, shape (n, k).

        Parameters
        ----------
        place : array of int, shape (n,)
        log_median, beta : array, shape (n, k)
            ln θ and β of the states.
        """
        wide = np.sqrt(beta**2 + self.spread**2)
        return np.array(
            [
                self.rate @ ndtr((self.log_median[:, at, None] - theta) / width)
                for at, theta, width in zip(place, log_median, wide, strict=True)
            ]
        )

    def together(
        self, sets: np.ndarray, structures: np.ndarray, place: np.ndarray, log_median: np.ndarray, beta: np.ndarray,
        each: np.ndarray, normal: np.ndarray,
    ) -> np.ndarray:  # fmt: skip
        """Rate of events that reach any state of each set, shape (m,).

        Σ_e ν_e E[1 − Π_structures (1 − max P(state | im))], the mean over drawn η and ε; what one event reaches twice is
        drawn, what it reaches by itself is exact, and Eq. (G9) bounds it.

        Parameters
        ----------
        sets : array of bool, shape (m, n)
        structures, place : array of int, shape (n,)
        log_median, beta, each : array, shape (n,)
            Of the states; ``each`` as :meth:`each` gives it.
        normal : array, shape (q, s)
            Independent standard normal numbers.
        """
        # Events that make all but :data:`LEFT_OUT` of what is reached: of the others nothing is reached twice.
        z = (self.log_median[:, place] - log_median) / np.hypot(beta, self.spread)
        part = (self.rate[:, None] * ndtr(z)).sum(axis=1)
        order = np.argsort(part)
        matter = order[np.cumsum(part[order]) > NEGLIGIBLE_SHARE * part.sum()]
        shaken = self.log_median[matter, None, :] + normal @ self.root.T  # (e, q, s)
        missed = log_ndtr((log_median - shaken[..., place]) / beta).reshape(-1, len(place))
        survived = np.zeros((len(missed), len(sets)))
        for structure in np.unique(structures):
            mine = np.flatnonzero(structures == structure)
            if len(mine) == 1:
                survived += missed[:, mine] * sets[:, mine].T
            else:
                survived += np.where(sets[None][:, :, mine], missed[:, None, mine], 0.0).min(axis=2)
        reached = -np.expm1(missed) @ sets.T  # the sum of what each reaches, for every set
        twice = (-np.expm1(survived) - reached).reshape(-1, len(normal), len(sets)).mean(axis=1)
        rates = sets @ each + self.rate[matter] @ twice
        least = np.where(sets, each, 0.0).max(axis=1)
        return np.clip(rates, least, np.maximum(sets @ each, least))


def _gathered(rate: np.ndarray, median: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Events that shake all places nearly alike, as one with their mean."""
    _, cell = np.unique(np.round(median / CELL), axis=0, return_inverse=True)
    cell = cell.ravel()
    total = np.bincount(cell, rate)
    mean = np.stack([np.bincount(cell, rate * medians) / total for medians in median.T], axis=1)
    return total, mean
