"""Ground-motion models: PGA and PGV at a distance from an earthquake, and how far events and places differ from them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from stylobate.constants import g
from stylobate.errors import InputError, check_choice, check_range

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
    one.name: one
    for one in (
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
