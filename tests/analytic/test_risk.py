"""Risk against its closed form, hazard curves of others, and what an age says."""

import dataclasses
import itertools
import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import norm

from stylobate.errors import InputError
from stylobate.probability.evidence import Evidence
from stylobate.probability.fragility import fragility
from stylobate.probability.risk import Hazard, read_hazard, risk
from stylobate.verdicts.limit_states import FAILED, OPEN


@pytest.fixture(scope="module")
def curve():
    rng = np.random.default_rng(3)
    levels = np.geomspace(0.2, 3.0, 8)
    codes = (np.log(levels) >= rng.normal(0.0, 0.5, (15, 1))).astype(np.int8)
    names = np.repeat(np.array([f"r{i}" for i in range(15)], dtype=object), 8)
    return fragility(Evidence(names, np.tile(levels, 15), codes.ravel(), "pgv", "m/s", "collapse", "a"), samples=200)


@pytest.mark.parametrize("points", [2, 7, 60])
def test_a_power_law_has_a_closed_form(curve, points):
    # k₀ θ^−k exp(k²β²/2) (Cornell et al. 2002); the curve is straight in logarithms, so that its points do not matter.
    k0, k = 1e-3, 2.5
    x = np.geomspace(1e-4, 1e4, points)
    collapse_risk = risk(curve, Hazard(x, k0 * x**-k, "m/s", "power law", "PGV"))
    exact = k0 * math.exp(-k * curve.log_median + 0.5 * (k * curve.beta) ** 2)
    assert collapse_risk.rate == pytest.approx(exact, rel=1e-10)
    assert collapse_risk.parts.sum() == pytest.approx(collapse_risk.rate, rel=1e-12)
    assert collapse_risk.low < collapse_risk.rate < collapse_risk.high
    assert collapse_risk.warnings == []


def test_any_curve_is_the_integral(curve):
    # ∫ λ(x) dP(x) by quadrature, straight between the points in logarithms; beyond the last one the probability stays.
    x, rate = np.array([0.05, 0.2, 0.6, 1.5]), np.array([0.2, 0.03, 0.002, 0.0001])
    collapse_risk = risk(curve, Hazard(x, rate, "m/s", "four points"))
    y = np.log(x)

    def integrand(z):
        return math.exp(np.interp(z, y, np.log(rate))) * norm.pdf((z - curve.log_median) / curve.beta) / curve.beta

    inside = sum(quad(integrand, a, b, epsabs=1e-14)[0] for a, b in itertools.pairwise(y))
    first, last = (norm.cdf((end - curve.log_median) / curve.beta) for end in (y[0], y[-1]))
    assert collapse_risk.rate == pytest.approx(inside + rate[0] * first, rel=1e-9)
    assert collapse_risk.beyond == pytest.approx(rate[-1] * (1.0 - last), rel=1e-9)
    assert len(collapse_risk.edges) == len(collapse_risk.parts) + 1


def test_the_ends_of_a_hazard_curve_are_said(curve):
    short = risk(curve, Hazard(np.array([0.1, 1.2]), np.array([0.1, 0.05]), "m/s", "short", "PGV"))
    assert "ends at 1.2 m/s" in short.warnings[0]
    assert short.rate < short.high <= 0.1  # all shaking that the curve has
    with pytest.raises(
        InputError, match=r"shorter ends at 0\.2 m/s, once in 20 years, .* give a curve to .* m/s or more"
    ):
        risk(curve, Hazard(np.array([0.1, 0.2]), np.array([0.1, 0.05]), "m/s", "shorter"))
    late = risk(curve, Hazard(np.array([1.0, 9.0]), np.array([0.1, 1e-9]), "m/s", "late", "PGV"))
    assert "begins at 1 m/s" in late.warnings[0]


def test_where_a_hazard_curve_begins_is_in_the_interval(curve):
    """One power law, written from far below the fragility and from within it: what is left out is told and held."""
    whole, late = (
        risk(curve, Hazard(x, 1e-3 * x**-3.0, "m/s", name, "PGV"))
        for x, name in ((np.geomspace(0.01, 30.0, 40), "whole"), (np.geomspace(0.8, 30.0, 40), "late"))
    )
    exact = 1e-3 * math.exp(-3.0 * curve.log_median + 4.5 * curve.beta**2)  # k₀ θ⁻ᵏ e^{k²β²/2}
    assert whole.rate == pytest.approx(exact, rel=1e-3)
    assert late.rate + late.weaker == pytest.approx(exact, rel=1e-3)
    assert late.rate < 0.8 * exact
    assert late.low < exact < late.high
    assert [warning for warning in late.warnings if "begins at 0.8 m/s; weaker shaking" in warning]
    assert not [warning for warning in whole.warnings if "begins at" in warning]


def test_runs_that_the_curve_leaves_out_are_told_with_the_rate(curve):
    """The rate and its interval were told without a word of them."""
    codes = curve.evidence.codes.copy()
    codes[10:13], codes[20] = OPEN, FAILED
    open_ = fragility(dataclasses.replace(curve.evidence, codes=codes), samples=200)
    x = np.geomspace(0.01, 10.0, 9)
    collapse_risk = risk(open_, Hazard(x, 1e-3 * x**-2.0, "m/s", "a", "PGV"))
    most, least = collapse_risk.extremes
    assert least < most
    assert collapse_risk.warnings == [
        f"3 undecided and 1 failed of {len(codes)} runs: counted as collapse the annual rate by a is {most:.3g}, counted as "
        f"none {least:.3g}; the curve leaves them out, its interval holds both."
    ]


def test_the_interval_of_a_rate_holds_those_of_both_ends_of_open_runs(curve):
    """It was that of the decided runs alone, as if nobody had looked at the others."""
    middle = (curve.evidence.im > 0.5) & (curve.evidence.im < 2.0) & np.isin(curve.evidence.records, ["r0", "r1", "r2"])
    open_ = dataclasses.replace(curve.evidence, codes=np.where(middle, OPEN, curve.evidence.codes))
    hazard = Hazard(x := np.geomspace(0.01, 10.0, 9), 1e-3 * x**-2.0, "m/s", "a", "PGV")
    open_curve = fragility(open_, samples=200)
    collapse_risk = risk(open_curve, hazard)
    most, least = (risk(extreme_curve, hazard) for extreme_curve in open_curve.ends)
    assert (most.rate, least.rate) == pytest.approx(collapse_risk.extremes)
    assert (
        0.0
        < collapse_risk.low
        == least.low
        < least.rate
        < collapse_risk.rate
        < most.rate
        < most.high - most.beyond
        < collapse_risk.high
        < 1.0
    )
    alone = risk(dataclasses.replace(open_curve, ends=()), hazard)
    assert collapse_risk.low < 0.98 * alone.low
    assert collapse_risk.high > 1.02 * alone.high
    nothing = risk(dataclasses.replace(open_curve, ends=(None, None)), hazard)  # neither end makes a curve
    assert (nothing.low, nothing.high) == (0.0, math.inf)  # nor does anything limit what weaker shaking adds


def test_hazards_of_one_name_are_refused(curve):
    survival = pytest.importorskip("stylobate_ruins.survival").survival
    hazard = Hazard(np.geomspace(0.01, 10.0, 9), 1e-4 * np.geomspace(0.01, 10.0, 9) ** -2.0, "m/s", "site.csv", "PGV")
    with pytest.raises(InputError, match=r"two hazard curves are called 'site\.csv'"):
        survival(curve, 2400.0, [hazard, hazard])


def test_survival(curve):
    parse_age = pytest.importorskip("stylobate_ruins.survival").parse_age
    survival = pytest.importorskip("stylobate_ruins.survival").survival
    x = np.geomspace(0.01, 10.0, 9)
    hazards = [Hazard(x, k0 * x**-2.0, "m/s", name) for name, k0 in (("a", 1e-4), ("b", 1e-3))]
    result = survival(curve, 2400.0, hazards)
    rates = np.array([hazard_risk.rate for hazard_risk in result.risks])
    assert result.probability == pytest.approx(np.exp(-2400.0 * rates))
    s = result.summary()
    assert s["survival_probability"] == pytest.approx(dict(zip("ab", np.exp(-2400.0 * rates))))
    assert s["hazards"][1]["relative_likelihood"] == pytest.approx(math.exp(-2400.0 * (rates[1] - rates[0])))
    assert sum(hazard["weight"] for hazard in s["hazards"]) == pytest.approx(1.0)
    for text in ("2400", "-1y", "0y", "ages"):
        with pytest.raises(InputError, match="age"):
            parse_age(text)
    assert parse_age("2400y") == parse_age("2.4e3 years") == 2400.0


def test_our_own_hazard_files(tmp_path):
    path = tmp_path / "h.csv"
    path.write_text("# Somewhere, 2013\nim_m_s,annual_rate\n0.5,0.001\n0.1,0.02\n2.0,0\n")
    hazard = read_hazard(path)
    assert (hazard.unit, hazard.im.tolist(), hazard.rate.tolist()) == ("m/s", [0.1, 0.5], [0.02, 0.001])
    for text, why in (
        ("im_g,annual_rate\n0.1,0.01\n0.2,0.02\n", "rises"),
        ("im_g,annual_rate\n0.1,0.01\n0.2,0\n0.4,0.0001\n", "rises from 0 a year at 0.2 g to 0.0001 at 0.4"),
        ("im_g,annual_rate\n0.1,0.01\n", "at least two"),
        ("im_g,annual_rate\n-0.1,0.01\n0.2,0.001\n", "has 0.01 a year at -0.1 g; allowed are"),
        ("im_g,annual_rate\n0.1,0.01\n0.2,-0.001\n", "has -0.001 a year at 0.2 g; allowed are"),
        ("im_g,annual_rate\n0.1,0.01\n0.1,0.01\n0.2,0.001\n", "has 0.1 g twice; leave one out"),
        ("im_g,annual_rate\n0.1,often\n0.2,0.001\n", "'often'"),
        ("pga,rate\n0.1,0.01\n", "needs im_g or im_m_s"),
        ("", "no column .annual_rate"),
    ):
        path.write_text(text)
        with pytest.raises(InputError, match=why):
            read_hazard(path)


OPENQUAKE = """#,,,,,"generated_by='OpenQuake engine 3.16.0', kind='mean', investigation_time=50.0, imt='{imt}'"
lon,lat,depth,poe-0.1000000,poe-0.2000000,poe-0.4000000
21.90000,37.43000,0.00000,{first},2.0E-01,5.0E-02
23.70000,38.00000,0.00000,9.0E-01,5.0E-01,1.0E-01
"""


def test_hazard_curves_that_openquake_exports(tmp_path):
    path = tmp_path / "hazard_curve-mean-PGA_12.csv"
    path.write_text(OPENQUAKE.format(imt="PGA", first="1.0"))
    with pytest.raises(InputError, match="2 sites"):
        read_hazard(path)
    hazard = read_hazard(path, (22.0, 37.4))  # a certain exceedance has no rate
    assert (hazard.unit, hazard.imt) == ("g", "PGA")
    assert hazard.im.tolist() == [0.2, 0.4]
    assert hazard.rate == pytest.approx(-np.log(1.0 - np.array([0.2, 0.05])) / 50.0)
    path.write_text(OPENQUAKE.format(imt="PGV", first="4.0E-01"))
    assert read_hazard(path, (22.0, 37.4)).im.tolist() == pytest.approx([0.001, 0.002, 0.004])
    path.write_text(OPENQUAKE.format(imt="SA(1.0)", first="4.0E-01").replace("investigation_time", "time"))
    with pytest.raises(InputError, match="investigation_time"):
        read_hazard(path, (22.0, 37.4))


KINDS = {
    "mean": "mean",
    "median": "median",
    "max": "maximum of all realisations",
    "quantile-0.85": "quantile 0.85",
    "rlz-003": "realisation 3",
}
NRML_CURVES = """<nrml xmlns="http://openquake.org/xmlns/nrml/0.5">
<hazardCurves {kind} investigationTime="50.0" IMT="PGV"><IMLs>10.0 20.0 40.0</IMLs>
<hazardCurve><gml:Point xmlns:gml="http://www.opengis.net/gml"><gml:pos>21.9 37.43</gml:pos></gml:Point>
<poEs>4.0E-01 2.0E-01 5.0E-02</poEs></hazardCurve></hazardCurves></nrml>"""


def one_site(kind):
    lines = OPENQUAKE.format(imt="PGV", first="4.0E-01").splitlines()[:3]
    return "\n".join([lines[0].replace("kind='mean'", kind), *lines[1:]])


def test_what_a_hazard_curve_is_of_its_logic_tree_is_told(curve, tmp_path):
    """By the comment of a CSV, its name, or the attributes of NRML; where none states it, nothing is told."""
    survival = pytest.importorskip("stylobate_ruins.survival").survival
    path = tmp_path / "h.csv"
    files = [(one_site(f"kind='{kind}'"), statistic) for kind, statistic in KINDS.items()]
    files += [(NRML_CURVES.format(kind='statistics="mean"'), "mean")]
    files += [(NRML_CURVES.format(kind='statistics="quantile" quantileValue="0.15"'), "quantile 0.15")]
    files += [(NRML_CURVES.format(kind='sourceModelTreePath="b1" gsimTreePath="b2"'), "branch b1~b2")]
    files += [("# kind='rlz-12'\npgv_m_s,annual_rate\n0.1,0.02\n0.5,0.001\n", "realisation 12")]
    files += [(one_site("x"), ""), ("pgv_m_s,annual_rate\n0.1,0.02\n0.5,0.001\n", "")]
    for text, statistic in files:
        path.write_text(text)
        hazard = read_hazard(path)
        assert hazard.statistic == statistic
        x = np.geomspace(0.02, 3.0, 12)
        collapse_risk = risk(curve, dataclasses.replace(hazard, im=x, rate=1e-3 * x**-2))
        assert collapse_risk.summary()["hazard_statistic"] == (statistic or None)
        assert (f"The hazard curve is the {statistic}." in collapse_risk.sentence) == bool(statistic)
        assert survival(collapse_risk.fragility, 100.0, [collapse_risk.hazard]).summary()["hazards"][0][
            "hazard_statistic"
        ] == (statistic or None)
    named = tmp_path / "hazard_curve-rlz-002-PGV_1.csv"
    named.write_text(one_site("x"))
    assert read_hazard(named).statistic == "realisation 2"


@pytest.mark.parametrize("kind", ["std", "cov", "variance", "stddev", "beta"])
def test_a_spread_over_a_logic_tree_is_no_hazard_curve(kind, tmp_path):
    path = tmp_path / "h.csv"
    for text in (
        one_site(f"kind='{kind}'"),
        NRML_CURVES.format(kind=f'statistics="{kind}"'),
        f"# kind='{kind}'\npgv_m_s,annual_rate\n0.1,0.02\n0.5,0.001\n",
    ):
        path.write_text(text)
        with pytest.raises(InputError, match=rf"is of the kind '{kind}'; allowed are .* give the mean, or a quantile"):
            read_hazard(path)
    named = tmp_path / f"hazard_curve-{kind}-PGV.csv"
    named.write_text(one_site("x"))
    with pytest.raises(InputError, match=f"of the kind '{kind}'"):
        read_hazard(named)


def test_fragility_and_hazard_are_of_one_intensity(curve):
    x = np.array([0.1, 1.0])
    with pytest.raises(InputError, match="in m/s and other is in g"):
        risk(curve, Hazard(x, 1e-3 / x, "g", "other"))
    with pytest.raises(InputError, match="is of SA"):
        risk(curve, Hazard(x, 1e-3 / x, "m/s", "other", "SA(1.0)"))
