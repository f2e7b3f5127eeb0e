"""Spectra and checks of codes against values worked out by hand from their tables."""

import json
import math

import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate.codes.checks import CodeSite, code_check
from stylobate.codes.spectra import EurocodeSpectrum, NtcSpectrum
from stylobate.models.rigid_block.block_stack import BlockStack


def test_the_eurocodes_second_type_by_hand():
    # EN 1998-1, Table 3.3, ground C: S = 1.5, T_B = 0.1, T_C = 0.25, T_D = 1.2 s
    spectrum = EurocodeSpectrum(2.0, "C", kind=2)
    assert spectrum.acceleration(0.2) == pytest.approx(2.0 * 1.5 * 2.5)
    assert spectrum.acceleration(1.0) == pytest.approx(2.0 * 1.5 * 2.5 * 0.25)
    assert spectrum.acceleration(2.4) == pytest.approx(2.0 * 1.5 * 2.5 * 0.25 * 1.2 / 2.4**2)
    assert spectrum(2.4) == pytest.approx(spectrum.acceleration(2.4) * (2.4 / 2.0 / math.pi) ** 2)


def test_the_italian_spectrum_by_hand():
    # NTC 2018, Tables 3.2.IV and V, soil C, T2: S_S = 1.7 − 0.6 · 2.5 · 0.2 = 1.40, C_C = 1.05 · 0.3^−0.33
    spectrum = NtcSpectrum(0.2 * st.g, 2.5, 0.3, "C", "T2")
    tc = 1.05 * 0.3**-0.33 * 0.3
    assert spectrum.soil_factor == pytest.approx(1.40 * 1.2)
    assert spectrum.corners == pytest.approx((tc / 3.0, tc, 4.0 * 0.2 + 1.6))
    top = 0.2 * st.g * 1.68 * 2.5
    assert spectrum.acceleration(0.5 * tc) == pytest.approx(top)
    assert spectrum.acceleration(2.0) == pytest.approx(top * tc / 2.0)
    assert spectrum.acceleration(3.0) == pytest.approx(top * tc * 2.4 / 9.0)
    assert spectrum.acceleration(0.0) == pytest.approx(0.2 * st.g * 1.68)
    # limits of S_S: soil D at 0.5 g, 2.4 − 1.5 · 2.5 · 0.5 = 0.525, not below 0.9; soil B at 0.05 g, 1.35, not above 1.2
    assert NtcSpectrum(0.5 * st.g, 2.5, 0.3, "D").soil_factor == 0.9
    assert NtcSpectrum(0.05 * st.g, 2.5, 0.3, "B").soil_factor == 1.2


def test_a_block_checked_by_hand():
    # one block: e* = 1, a0* = g tan α / FC; q = 2
    column = st.preset("paper-monolithic")
    path, stack = st.pushover(column), BlockStack.of_column(column)
    check = code_check(stack, path, CodeSite.typed("ntc2018,ag=0.2g,F0=2.5,Tc*=0.3s,soil=C,knowledge=LC2"))
    m = check.displacement
    assert m.acceleration == pytest.approx(math.tan(column.slenderness) * st.g / m.participation / 1.2, rel=1e-3)
    assert check.demand_acceleration == pytest.approx(0.2 * st.g * 1.4 / 2.0)
    assert check.acceleration_factor == pytest.approx(m.acceleration / check.demand_acceleration)
    assert {coefficient.source for coefficient in check.coefficients} >= {
        "NTC 2018, Table 3.2.IV",
        "Circolare 617/2009, C8A.4.2.3",
    }
    assert all(coefficient.source for coefficient in check.coefficients)
    assert any("7/2019" in omission for omission in check.left_out)
    eurocode = code_check(stack, path, CodeSite.typed("ec8,ag=0.2g,soil=C,knowledge=KL2"))
    assert eurocode.demand_acceleration == pytest.approx(0.2 * st.g * 1.15 / 2.0)
    assert any("EN 1998-3" in omission for omission in eurocode.left_out)


def test_the_command_tells_every_coefficient_with_its_source(capsys):
    arguments = ["pushover", "paper-monolithic", "--check", "ec8,ag=0.25g,soil=B"]
    assert call([*arguments, "--json"]) == 0
    check = json.loads(capsys.readouterr().out)["check"]
    assert {"name": "S", "value": 1.2, "source": "EN 1998-1:2004, Table 3.2"} in check["coefficients"]
    assert check["passed"] in (True, False)
    assert call(arguments) == 0
    assert "(EN 1998-3:2005, Table 3.1, KL1)" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("check", "words"),
    [
        ("ntc", "code 'ntc' is not known here; did you mean ntc2018"),
        ("ec8,soil=B", "ec8 needs ag"),
        ("ec8,ag=0.2g", "ec8 needs soil"),
        ("ec8,ag=0.2g,soil=F", "ground_type is 'F'; allowed are A"),
        ("ec8,ag=0.2g,ground=B", "'ground=B' says nothing"),
        ("ntc2018,ag=0.2g,F0=2.0,Tc*=0.3s,soil=B", "F0 is 2; allowed is [2.2"),
        ("ntc2018,ag=0.2g,F0=2.4,Tc*=0.3s,soil=B,knowledge=KL1", "knowledge is 'KL1'; allowed by ntc2018 are LC1"),
    ],
)
def test_a_check_that_cannot_be_made_is_said_in_one_sentence(check, words, capsys):
    assert call(["pushover", "paper-monolithic", "--check", check]) == 2
    assert words in capsys.readouterr().err
