"""Risk: how often a year a column comes to a state, and where in the hazard this comes from."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import log_ndtr, ndtr

from ..errors import InputError, check_kind
from ..messages import digits, joined, say
from ..motion.intensity_specs import ENDS, parse_measure
from ..notebook import Shown
from ..percent import percent
from .fragility_curve import Fragility
from .hazard import Hazard
from .lognormal import curve, log_interval

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
class Risk(Shown):
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
        told = self.fragility.summary()
        names = {"undecided": say("{count} undecided"), "failed": say("{count} failed")}
        counts = [words.of(count=told[one]) for one, words in names.items() if told[one]]
        if not counts:
            return ""
        most, least = (digits(one, ".3g") if math.isfinite(one) else say("not known") for one in self.extremes)
        return say(
            "{counts} of {all} runs: counted as {state} the annual rate by {hazard} is {most}, counted as none {least}; the "
            "curve leaves them out, its interval holds both.",
            counts=joined(say(" and "), counts), all=told["runs"], state=say(self.fragility.evidence.state),
            hazard=self.hazard.name, most=most, least=least,
        )  # fmt: skip

    @property
    def sentence(self) -> str:
        """How often it comes to the state, in a sentence."""
        e = self.fragility.evidence
        said = say("{name}: {state} never.") if self.rate == 0.0 else say("{name}: {state} once in {years}.")
        said = said.of(name=e.name, state=say(e.state), years=years(1.0 / self.rate) if self.rate else "")
        statistic = self.hazard.statistic
        return joined(
            " ", [said, say("The hazard curve is the {statistic}.", statistic=statistic) if statistic else ""]
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
    said = hazard.imt.upper()
    if said and measure != "im" and not _same(said, measure):
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
    return [one for one in (doubt and joined("", [doubt, "."]), late) if one]


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
        np.array([_rate(hazard, float(m), math.exp(s), split=False)[0] for m, s in one])
        for one in (fragility.samples, fragility.region)
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
