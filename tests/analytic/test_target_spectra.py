"""Target spectra against what their definitions say, and the correlations against a table that others have fitted."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from stylobate import InputError, g, target_spectrum
from stylobate.codes.records import select_records
from stylobate.codes.spectra import EurocodeSpectrum, correlation
from stylobate.motion import harmonic
from stylobate.plots import draw_record_selection


def test_a_code_as_typed_is_its_spectrum():
    """``ec8`` is EN 1998-1:2004, Eq. 3.2 to 3.5; two accelerations to the bit."""
    target, same = target_spectrum("ec8,ag=0.25g,soil=C"), EurocodeSpectrum(0.25 * g, "C")
    assert [target.acceleration(t) for t in (0.0, 0.1, 0.5, 1.0, 3.0)] == [
        same.acceleration(t) for t in (0.0, 0.1, 0.5, 1.0, 3.0)
    ]
    assert target.from_zero


def test_the_second_generation():
    """prEN 1998-1-1:2019, 5.2.2.2: S_α/2.5 at rest, the plateau, S_β at 1 s, a constant displacement beyond T_D."""
    target = target_spectrum("ec8-2,S_alpha=6m/s2,S_beta=2m/s2,F_alpha=1.35,F_beta=2.25")
    top, at_one_second = 6.0 * 1.35, 2.0 * 2.25
    assert target.acceleration(0.0) == pytest.approx(top / 2.5)
    assert target.acceleration(0.3) == pytest.approx(top)
    assert target.acceleration(1.0) == pytest.approx(at_one_second)
    at = target.at(np.array([3.0, 3.5, 4.0]))  # T_D = 1 s + S_β,RP over 1 m/s² = 3 s, on rock
    assert at * np.array([3.0, 3.5, 4.0]) ** 2 == pytest.approx([at_one_second * 3.0] * 3)
    rise = target.at(np.array([0.02, 0.06, 0.1]))  # linear from T_A to T_B = 0.1 s
    assert rise == pytest.approx([top / 2.5, top * 0.7, top])


@pytest.mark.parametrize(
    ("periods", "fitted"), [((0.5, 1.0), 0.7561), ((1.0, 3.0), 0.6714), ((0.2, 1.0), 0.4188), ((0.5, 2.0), 0.5217)]
)
def test_correlations_beside_others(periods, fitted):
    """Baker and Jayaram (2008) beside Al Atik's table (2011), of other ground-motion models: within 0.07."""
    assert correlation(*periods) == pytest.approx(fitted, abs=0.07)
    assert correlation(*reversed(periods)) == correlation(*periods)
    assert correlation(periods[0], periods[0]) == pytest.approx(1.0)


def test_a_conditional_mean_spectrum(tmp_path):
    """It is what is asked for at its period, the median where ε = 0, and nearer to the median the farther away."""
    t = np.array([0.1, 0.2, 0.5, 0.9, 1.2, 2.0, 3.0])
    table = tmp_path / "model.csv"
    rows = "\n".join(f"{a:g},{0.3 / a**0.5:.17g},0.6" for a in t)
    table.write_text(f"period_s,median_g,sigma_ln\n{rows}\n")
    target = target_spectrum(f"cms:{table},T=1s,sa=0.6g")
    assert target.acceleration(1.0) == pytest.approx(0.6 * g)
    above = np.log(target.at(t) / (0.3 / np.sqrt(t) * g)) / 0.6
    epsilon = above / np.array([correlation(float(period), 1.0) for period in t])
    assert epsilon == pytest.approx(np.full(7, epsilon[0]))
    assert epsilon[0] == pytest.approx(math.log(2.0) / 0.6, rel=1e-3)  # the median at 1 s is between two rows
    median = target_spectrum(f"cms:{table},T=0.5s,sa={0.3 / math.sqrt(0.5):.17g}g")
    assert median.at(t) == pytest.approx(0.3 / np.sqrt(t) * g)


def test_a_table_is_linear_in_logarithms(tmp_path):
    """1/T between two rows of 1/T, in either unit; a row at 0 s is the peak ground acceleration, and left out."""
    file = tmp_path / "uhs.csv"
    file.write_text("period_s,sa_m_s2\n0,2\n0.2,5\n2,0.5\n")
    target = target_spectrum(str(file))
    assert target.acceleration(1.0) == pytest.approx(1.0)
    assert (target.shortest, target.longest) == (0.2, 2.0)
    file.write_text(f"period_s;sa_g\n0.2;{5 / g:.17g}\n2;{0.5 / g:.17g}\n")
    assert target_spectrum(str(file)).acceleration(0.7) == pytest.approx(1.0 / 0.7)


@pytest.mark.parametrize(
    ("text", "assumed"),
    [
        ("ec8,ag=0.25g,soil=B", "type=1 assumed"),
        ("ec8,ag=0.25g,soil=B,type=1", ""),
        ("ntc2018,ag=0.25g,F0=2.4,Tc*=0.3s,soil=C", "topography=T1 assumed"),
        ("ec8-2,S_alpha=0.6g,S_beta=0.2g,F_alpha=1,F_beta=1", ""),
    ],
)
def test_what_is_assumed_is_told(text, assumed):
    """In words, of which lines, JSON object and report are made, and in the title of the picture."""
    target = target_spectrum(text)
    assert target.assumed == assumed
    assert (f"({assumed})" in target.words) is bool(assumed)
    chosen = select_records([harmonic(1.0, 2.0, 10.0)], target, 1, factors=(0.01, 100.0))
    assert (f"({assumed})" in draw_record_selection(chosen).axes[0].get_title(loc="left")) is bool(assumed)
    assert chosen.summary()["target_words"] == target.words


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("ec9,ag=0.2g", "did you mean ec8"),
        ("ec8,ag=0.2g,ag=0.3g", "twice"),
        ("ec8-2,S_alpha=0.6g", "needs S_beta"),
        ("ec8,ag=0.25g", "ec8 needs soil, the ground of the site, A (rock) to E; write it as ec8,ag=0.25g,soil=B"),
        ("ntc2018,ag=0.25g,F0=2.4,Tc*=0.3s", "ntc2018 needs soil, the ground of the site"),
        ("ec8-2,S_alpha=0.6g,S_beta=0.2g,F_beta=1.5", "needs F_alpha, the site factor of the plateau, 1 on rock"),
        ("ec8,ag=25g,soil=B", "ag is 25 g; allowed is (0, 2] g"),
        ("ec8-2,S_alpha=60m/s2,S_beta=2m/s2,F_alpha=1,F_beta=1", "S_alpha is 6.11"),
        ("ec8-2,S_alpha=0.2g,S_beta=0.9g,F_alpha=1,F_beta=1", "on the site makes T_C 4.5 s"),
        ("ntc2018,ag=0.2g,F0=2.4", "needs Tc*"),
        ("cms:a.csv,sa=1g", "write it as cms:FILE.csv,T=1s,sa=0.4g"),
        ("nowhere.csv", "nowhere.csv"),
    ],
)
def test_what_is_refused(text, words):
    with pytest.raises(InputError, match=re.escape(words)):
        target_spectrum(text)
