"""Hazard weighed by several monuments: closed forms, bounds, simulated catalogues, and weights that are calibrated."""

import itertools
import math

import numpy as np
import pytest
from scipy.stats import multivariate_normal, norm

import stylobate as st
from stylobate.errors import InputError
from stylobate.probability.risk import Hazard
from stylobate_ruins.ground_motion import CORRELATED, MODELS, SharedEvents, Source, alike, events_of, rupture_length
from stylobate_ruins.monuments import Branch, Capacity, Monument, Site, Sites
from stylobate_ruins.survival import Pattern, stands, together
from stylobate_ruins.weighing import WAYS, weigh

SITES = (Site("a", (21.63, 37.64)), Site("b", (21.72, 37.60)), Site("c", (22.4, 37.2)))
MODEL = MODELS["akkar-bommer-2010"]


def known(median, beta=0.4, state="collapse", sides=(0.0, 0.0)):
    """A fragility without doubt, or with one."""
    return Capacity("pgv", "m/s", state, math.log(median), math.log(beta), sides, sides)


def power_law(k0, name="power law", k=2.0):
    im = np.geomspace(1e-3, 1e3, 5)
    return Hazard(im, k0 * im**-k, "m/s", name, "pgv")


def faults(rate):
    return (
        Source("fault", ((21.4, 37.75), (21.8, 37.45)), (5.8, 7.0), rate, 1.0, "normal"),
        Source("around", ((21.7, 37.55),), (5.2, 6.2), 3.0 * rate, 1.0, "strike-slip", strike=30.0),
    )


# -- the law of what is seen ------------------------------------------------------------------------------------------


def probability(reached, begin, end, rates, structures, shared):
    pattern = Pattern.of(np.array(reached), np.array(begin, float), np.array(end, float))
    return float(pattern.probability(together(np.array(rates), pattern.sets, np.array(structures), shared)))


def test_states_of_single_structures():
    rate, age = 3e-4, 2400.0
    assert probability([False], [age], [0.0], [rate], [0], False) == pytest.approx(float(stands(rate, age)), rel=1e-14)
    assert probability([True], [age], [0.0], [rate], [0], False) == pytest.approx(-math.expm1(-rate * age), rel=1e-14)
    # reached with 1e-12 of a chance keeps its digits: −expm1 in place of 1 − exp
    assert probability([True], [1.0], [0.0], [1e-12], [0], False) == pytest.approx(1e-12, rel=1e-12)
    # damaged and not collapsed: whatever brings the collapse brings the damage, exp(−λ_c t) − exp(−λ_d t)
    damage, collapse = 1e-3, 2e-4
    chance = probability([True, False], [age, age], [0.0, 0.0], [damage, collapse], [0, 0], False)
    assert chance == pytest.approx(math.exp(-collapse * age) - math.exp(-damage * age), rel=1e-13)


@pytest.mark.parametrize("reached", list(itertools.product([False, True], repeat=3)))
def test_earthquakes_of_their_own_make_a_product(reached):
    rates, begin, end = [3e-4, 1e-4, 8e-4], [2400.0, 900.0, 2000.0], [0.0, 100.0, 1500.0]
    expected = math.prod(
        -math.expm1(-r * (b - e)) if seen else math.exp(-r * (b - e))
        for seen, r, b, e in zip(reached, rates, begin, end, strict=True)
    )
    assert probability(reached, begin, end, rates, [0, 1, 2], False) == pytest.approx(expected, rel=1e-12)


def test_earthquakes_that_shake_all_make_the_weakest_alone_tell():
    rates, age = [3e-4, 1e-4, 8e-4], [2000.0] * 3
    assert probability([False] * 3, age, [0.0] * 3, rates, [0, 1, 2], True) == pytest.approx(math.exp(-8e-4 * 2000.0))
    # the strongest has fallen, so the weakest has: their order holds all
    both = probability([False, True, False], age, [0.0] * 3, rates, [0, 1, 2], True)
    assert both == 0.0
    fell = probability([True, True, True], age, [0.0] * 3, rates, [0, 1, 2], True)
    assert fell == pytest.approx(-math.expm1(-1e-4 * 2000.0), rel=1e-12)
    # an older one is alone at risk before the others stood: 400 years at 1e-4, then 2000 at the largest
    chance = probability([False] * 3, [2000.0, 2400.0, 2000.0], [0.0] * 3, rates, [0, 1, 2], True)
    assert chance == pytest.approx(math.exp(-1e-4 * 400.0 - 8e-4 * 2000.0), rel=1e-12)


# -- events ------------------------------------------------------------------------------------------------------------


def shaken(rate=0.01, sites=SITES):
    places, soils = [site.at for site in sites], [site.vs30 for site in sites]
    return SharedEvents.of(faults(rate), MODEL, "pgv", places, soils, [site.name for site in sites])


def test_rates_of_what_events_reach_are_those_of_the_hazard_curve():
    # ∫ P(f | im) |dλ| of the curve that the same events make, by its closed form on 200 points: within 0.1 % of its straight
    # stretches
    from stylobate.probability.risk import rates

    events, place = shaken(), np.arange(3)
    theta, beta = np.log(np.array([[0.3], [0.5], [0.2]])), np.full((3, 1), 0.4)
    im = np.geomspace(1e-4, 50.0, 200)
    curves = [rates(Hazard(im, rate, "m/s", "c"), theta[k], beta[k]) for k, rate in enumerate(events.curve(im))]
    assert events.each(place, theta, beta) == pytest.approx(np.array(curves), rel=1e-3)


def test_together_is_the_normal_integral_and_stays_between_its_bounds():
    # one event at three places: P(nothing is reached) is that of a normal vector below thresholds (Genz's integral, 1e-4)
    events = shaken()
    single = SharedEvents(np.array([1.0]), np.log([[0.25, 0.3, 0.1]]), events.between, events.within, events.root)
    place, structures = np.arange(3), np.arange(3)
    theta, beta = np.log(np.array([0.3, 0.35, 0.2])), np.array([0.4, 0.5, 0.3])
    each = single.each(place, theta[:, None], beta[:, None])[:, 0]
    sets = np.array(list(itertools.product([False, True], repeat=3)))
    rng = np.random.default_rng(0)
    rates = single.together(sets, structures, place, theta, beta, each, rng.standard_normal((40_000, 3)))
    cover = events.root @ events.root.T + np.diag(beta**2)
    for chosen, rate in zip(sets, rates, strict=True):
        if not chosen.any():
            assert rate == 0.0
            continue
        below = multivariate_normal(np.zeros(chosen.sum()), cover[np.ix_(chosen, chosen)])
        # 40,000 draws: a standard error of at most 0.5/200 = 0.0025
        assert rate == pytest.approx(1.0 - below.cdf((theta - single.log_median[0])[chosen]), abs=0.01)
    rare = events.each(place, theta[:, None], beta[:, None])[:, 0]
    many = events.together(sets, structures, place, theta, beta, rare, rng.standard_normal((16, 3)))
    own, all_ = (together(rare, sets, structures, how) for how in (False, True))
    assert (many <= own * (1 + 1e-12)).all()
    assert (many >= all_ * (1 - 1e-12)).all()
    assert all_[-1] < 0.98 * many[-1] < 0.98 * own[-1]  # and lies well inside where three are shaken


def test_monuments_that_share_earthquakes_say_less_than_those_that_do_not():
    monuments = tuple(Monument(f"m{k}", "a", known(0.35), "stands", (2400.0, 2400.0)) for k in range(3))
    branches = tuple(Branch(f"{r:g}", 0.5, {}, faults(r), MODEL) for r in (0.002, 0.006))
    weighing = weigh(Sites(SITES, monuments, branches))
    own, shared = (weighing.posterior(weighing.likelihood[way]) for way in WAYS[1:])
    assert shared[0] + 0.02 < weighing.weight[0] < own[0] - 0.02


def test_simulated_catalogues_show_what_is_seen_as_often_as_it_is_probable():
    """Earthquakes drawn one by one, with their residuals, against Eq. (G8); and weights are calibrated.

    Worlds come from the prior of branch, fragility and age. That a branch is the true one is as frequent as its weight: over
    N worlds the mean weight of the truth is that of Σ w², and reliability in five classes has a chi-square of five degrees.
    """
    sides = (0.25, 0.25)
    monuments = (
        Monument("m", "a", known(0.45, sides=sides), "stands", (1000.0, 2400.0)),
        Monument("n", "b", known(0.5, sides=sides), "stands", (2000.0, 2000.0)),
        Monument("o", "c", known(0.2, sides=sides), "stands", (800.0, 800.0), (0.0, 300.0)),
    )
    rates, prior = (0.004, 0.012, 0.036), np.array([0.3, 0.5, 0.2])
    branches = tuple(Branch(f"{r:g}", float(w), {}, faults(r), MODEL) for r, w in zip(rates, prior, strict=True))
    rng, worlds = np.random.default_rng(7), 4000
    truth = rng.choice(3, worlds, p=prior)
    felt = [shaken(rate) for rate in rates]
    codes = np.array([_catalogue(rng, monuments, felt[branch]) for branch in truth]) @ [1, 2, 4]
    weight, likelihood = np.empty((8, 3)), np.empty((8, 3))
    for code in range(8):
        seen = [
            Monument(
                monument.name,
                monument.site,
                monument.capacity,
                "reached" if code >> k & 1 else "stands",
                monument.age,
                monument.until,
            )
            for k, monument in enumerate(monuments)
        ]
        weighing = weigh(Sites(SITES, tuple(seen), branches))
        weight[code], likelihood[code] = weighing.weight, weighing.likelihood[WAYS[0]].mean(axis=1)
    # something is seen; residuals are drawn, and what comes out below 0 for what is hardly ever seen counts as 0
    assert likelihood.sum(axis=0) == pytest.approx(np.ones(3), abs=1e-3)
    for branch in range(3):  # each pattern as often as it is probable: chi-square of 7, p > 0.001
        counted = np.bincount(codes[truth == branch], minlength=8)
        expected = counted.sum() * likelihood[:, branch]
        frequent = expected > 5.0
        assert (((counted - expected) ** 2 / expected)[frequent]).sum() < 24.3
    mine = weight[codes]
    of_truth = mine[np.arange(worlds), truth]
    assert abs(of_truth.mean() - (mine**2).sum(axis=1).mean()) < 4.0 * of_truth.std() / math.sqrt(worlds)
    assert of_truth.mean() > (prior**2).sum() + 0.05  # and they tell something
    hit = np.equal.outer(truth, np.arange(3)).ravel().astype(float)
    classes = np.digitize(mine.ravel(), [0.1, 0.25, 0.4, 0.6])
    score = 0.0
    for class_number in range(5):
        inside = classes == class_number
        chances = mine.ravel()[inside]
        score += (hit[inside].sum() - chances.sum()) ** 2 / max((chances * (1.0 - chances)).sum(), 1e-9)
    assert score < 20.5  # p = 0.001


def _catalogue(rng, monuments, events):
    """What one world shows of each monument."""
    result = []
    middle = [monument.capacity.draw(rng.standard_normal((1, 2))) for monument in monuments]
    begin, end = (
        np.array([rng.uniform(*getattr(monument, name)) for monument in monuments]) for name in ("age", "until")
    )
    number = rng.poisson(events.rate.sum() * begin.max())
    which = rng.choice(len(events.rate), number, p=events.rate / events.rate.sum())
    when = rng.uniform(0.0, begin.max(), number)
    felt = events.log_median[which] + rng.standard_normal((number, 3)) @ events.root.T
    for k, (theta, beta) in enumerate(middle):
        at_risk = (when < begin[k]) & (when > end[k])
        chance = norm.cdf((felt[:, k] - theta) / beta)
        result.append(bool((at_risk & (rng.random(number) < chance)).any()))
    return result


# -- weights -----------------------------------------------------------------------------------------------------------


def test_one_rock_of_known_age_is_the_rule_of_precarious_rocks():
    # Anooshehpoor, Brune and Zeng (2004): a rock that topples at θ has stood for T; a hazard curve passes with exp(−λ(θ) T).
    # A dispersion of 0.01 is a step: λ of k = 2 grows by exp(k²β²/2) = 1.0002
    hazards = {name: power_law(k0, name) for name, k0 in (("low", 1e-5), ("mid", 1e-4), ("high", 1e-3))}
    rock = Monument("rock", "a", known(0.5, 0.01), "stands", (8000.0, 8000.0))
    branches = tuple(Branch(name, 0.333, {"a": hazard}) for name, hazard in hazards.items())
    weighing = weigh(Sites((Site("a"),), (rock,), branches))
    passes = np.exp([-8000.0 * hazard.at(0.5) for hazard in hazards.values()])
    assert weighing.likelihood[WAYS[0]].mean(axis=1) == pytest.approx(passes, rel=8000.0 * 4e-3 * 3e-4, abs=1e-13)
    assert weighing.weight == pytest.approx(passes / passes.sum(), rel=1e-2, abs=1e-10)
    assert weighing.weight[2] < 1e-10
    assert "against high" in weighing.sentence


def test_what_is_not_known_of_age_and_fragility_is_averaged_before_branches_are_compared():
    # uniform age: ∫ exp(−λ t) dt / (b − a), in closed form; 64 ages evenly spread: within 0.2 %
    rate = float(power_law(1e-4).at(0.5)) * math.exp(0.5 * (2.0 * 0.4) ** 2)
    monument = Monument("m", "a", known(0.5), "stands", (500.0, 3000.0))
    sites = Sites((Site("a"),), (monument,), (Branch("b", 1.0, {"a": power_law(1e-4)}),))
    exact = (math.exp(-500.0 * rate) - math.exp(-3000.0 * rate)) / (2500.0 * rate)
    assert weigh(sites).likelihood[WAYS[0]].mean() == pytest.approx(exact, rel=2e-3)
    # an uncertain median tells branches less apart than one that is exact
    branches = tuple(Branch(f"{k0:g}", 0.5, {"a": power_law(k0)}) for k0 in (1e-5, 1e-3))
    sharp, blunt = (
        weigh(Sites((Site("a"),), (Monument("m", "a", known(0.5, sides=sides), "stands", (2000.0, 2000.0)),), branches))
        for sides in ((0.0, 0.0), (0.8, 0.8))
    )
    assert blunt.weight[1] > 3.0 * sharp.weight[1]
    assert sharp.weight_error.max() < 1e-12  # nothing is drawn


def test_weights_that_do_not_sum_to_one_are_refused():
    """0.5 and 0.8 are no 0.38 and 0.62; thirds that are rounded are thirds, and the remedy works."""
    monument = Monument("m", "a", known(0.5), "stands", (2000.0, 2000.0))

    def weighed(*weights):
        branches = tuple(Branch(str(k), w, {"a": power_law(1e-4)}) for k, w in enumerate(weights))
        return weigh(Sites((Site("a"),), (monument,), branches)).prior

    with pytest.raises(st.InputError, match=r"weights of the branches sum to 1\.3; .* divide each by 1\.3"):
        weighed(0.5, 0.8)
    with pytest.raises(st.InputError, match=r"sum to 0\.6"):
        weighed(0.2, 0.4)
    assert weighed(0.5 / 1.3, 0.8 / 1.3) == pytest.approx([0.5 / 1.3, 0.8 / 1.3])
    assert weighed(0.33, 0.33, 0.33) == pytest.approx([1 / 3] * 3)


def test_fractiles_and_means_are_over_branches():
    branches = tuple(Branch(str(k), w, {"a": power_law(k * 1e-5)}) for k, w in ((1, 0.2), (2, 0.5), (5, 0.3)))
    monument = Monument("m", "a", known(0.5), "stands", (2000.0, 2000.0))
    weighing = weigh(Sites((Site("a"),), (monument,), branches))
    at = weighing.curves["a"][:, 7]
    low, middle, high = weighing.fractiles("a", weighing.prior)[:, 7]
    assert (low, middle, high) == (at[0], at[1], at[2])
    assert weighing.mean("a", weighing.prior)[7] == pytest.approx(0.2 * at[0] + 0.5 * at[1] + 0.3 * at[2])
    assert weighing.mean("a", weighing.weight)[7] < weighing.mean("a", weighing.prior)[7]
    assert weighing.information[0]["bits_alone"] == pytest.approx(weighing.bits)


# -- ground motion and sources -----------------------------------------------------------------------------------------


#: Medians of Bindi et al. (2014), PGV [cm/s] and PGA [g]: magnitude, distance [km], vs30 [m/s], mechanism; the test table
#: that the OpenQuake engine keeps for them (BINDI2014/B14_Rjb_Vs30_MEAN.csv). Its g is 9.80665 m/s².
BINDI = (
    (4.5, 0.0, 850.0, "strike-slip", 2.40241049, 0.0908947719),
    (4.5, 100.0, 150.0, "reverse", 0.100321375, 0.00211221104),
    (5.5, 20.0, 300.0, "normal", 3.33852437, 0.0541186615),
    (6.5, 20.0, 570.0, "reverse", 9.83779389, 0.127564380),
    (6.5, 50.0, 850.0, "normal", 2.85958062, 0.0320979514),
    (7.5, 0.0, 150.0, "strike-slip", 118.776127, 0.856057129),
    (7.5, 100.0, 300.0, "normal", 7.47491913, None),
)


@pytest.mark.parametrize(("magnitude", "distance", "vs30", "mechanism", "pgv", "pga"), BINDI)
def test_bindi_and_others(magnitude, distance, vs30, mechanism, pgv, pga):
    model, where = MODELS["bindi-2014"], (magnitude, distance, vs30, mechanism)
    assert 100.0 * math.exp(model.log_median("pgv", *where)) == pytest.approx(pgv, rel=1e-7)
    if pga is not None:
        assert math.exp(model.log_median("pga", *where)) == pytest.approx(pga * 9.80665 / 9.81, rel=1e-7)


def test_akkar_and_bommer():
    # Total standard deviations of their tables: 0.2782 of PGV (2010, table 1), 0.2816 of PGA (Bommer et al. 2012, table 5).
    for measure, total in (("pgv", 0.278149834), ("pga", 0.281646179)):
        assert math.hypot(*MODEL.spread(measure)) / math.log(10.0) == pytest.approx(total, rel=1e-8)
    # Rock, strike-slip, M 6.5 at 10 km by hand: log PGV = −2.12833 + 1.21448·6.5 − 0.08137·42.25 +
    # (−2.46942 + 0.22349·6.5)·log10 √(100 + 41.1449) = 2.32808 − 1.01675·1.07484 = 1.23524, 17.19 cm/s
    assert 100.0 * math.exp(MODEL.log_median("pgv", 6.5, 10.0, 800.0, "strike-slip")) == pytest.approx(17.19, abs=0.01)
    # Two models of one region: within a factor of two of each other
    m, r = np.meshgrid([5.5, 6.0, 6.5, 7.0], [5.0, 20.0, 80.0])
    for measure in ("pga", "pgv"):
        apart = MODEL.log_median(measure, m, r, 800.0, "normal") - MODELS["bindi-2014"].log_median(
            measure, m, r, 800.0, "normal"
        )
        assert np.abs(apart).max() < math.log(2.0)


def test_soil_and_style_as_in_the_tables():
    def ratio(vs30, mechanism="strike-slip"):
        where = (6.0, 30.0)
        return (
            MODEL.log_median("pgv", *where, vs30, mechanism) - MODEL.log_median("pgv", *where, 800.0, "strike-slip")
        ) / math.log(10.0)

    assert [ratio(300.0), ratio(500.0), ratio(800.0, "normal"), ratio(800.0, "reverse")] == pytest.approx(
        [0.20354, 0.08484, -0.05856, 0.01305]
    )


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("pgv", 4.5, 10.0, 800.0, "normal"), "magnitude 4.5 is beyond the model of Akkar and Bommer"),
        (("pgv", 7.7, 10.0, 800.0, "normal"), "holds from 5 to 7.6"),
        (("pga", 6.0, 101.0, 800.0, "normal"), "distance 101 km is beyond"),
        (("sa", 6.0, 10.0, 800.0, "normal"), "allowed are pga, pgv"),
        (("pgv", 6.0, 10.0, 90.0, "normal"), "vs30"),
        (("pgv", 6.0, 10.0, 800.0, "oblique"), "mechanism"),
    ],
)
def test_beyond_a_model_nothing_is_told(arguments, message):
    with pytest.raises(InputError, match=message):
        MODEL.log_median(*arguments)


def test_residuals_are_alike_nearby():
    # Esposito and Iervolino (2011): exp(−3h/range), 5 % at the range
    assert alike("pgv", np.array([0.0, CORRELATED["pgv"]])) == pytest.approx([1.0, math.exp(-3.0)])
    events = shaken()
    cover = events.root @ events.root.T
    assert np.diag(cover) == pytest.approx(np.full(3, events.spread**2))
    assert cover[0, 1] > cover[0, 2] > events.between**2  # 9 km and 84 km apart


def test_sources():
    source = Source("s", ((21.0, 38.0),), (5.0, 7.0), 0.1, 1.0)
    size, rate = source.sizes()
    assert rate.sum() == pytest.approx(0.1)
    above = [rate[size > edge].sum() for edge in (5.0, 6.0)]
    # truncated Gutenberg and Richter: (10^-b(m - m0) − 10^-2b) / (1 − 10^-2b) = 0.0909 of them are above 6
    assert above[1] / above[0] == pytest.approx((0.1 - 0.01) / (1.0 - 0.01))
    # Wells and Coppersmith (1994): log10 of the length = −2.44 + 0.59 M, 49 km at magnitude 7
    assert rupture_length(7.0) == pytest.approx(10.0**1.69)
    point_source = Source("p", ((21.0, 38.0),), (7.0, 7.0), 0.01, strike=0.0)
    events = events_of(point_source, (21.0, 38.0))
    half = 0.5 * rupture_length(7.0)
    for place, far in (((0.0, 0.0), 0.0), ((10.0, 0.0), 10.0), ((0.0, half + 30.0), 30.0), ((3.0, half + 4.0), 5.0)):
        assert events.distance(np.array(place)) == pytest.approx([far], abs=1e-9)
    fault = events_of(Source("f", ((21.0, 38.0), (22.0, 38.0)), (6.0, 6.0), 0.01), (21.5, 38.0))
    assert fault.rate.sum() == pytest.approx(0.01)
    assert np.linalg.norm(fault.ends[:, 1] - fault.ends[:, 0], axis=1) == pytest.approx(rupture_length(6.0), rel=1e-9)
    assert np.abs(fault.ends[..., 0]).max() == pytest.approx(
        0.5 * np.radians(1.0) * 6371.0 * math.cos(math.radians(38.0))
    )
    disc = events_of(Source("d", ((21.0, 38.0),), (5.0, 5.0), 0.01, radius=30.0), (21.0, 38.0))
    assert disc.ends.mean(axis=1).__pow__(2).sum(axis=1).mean() == pytest.approx(0.5 * 30.0**2)  # evenly over the area
