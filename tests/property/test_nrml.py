"""Fragility models of NRML 0.5: what OpenQuake reads of them is the curve that was written."""

import math
from xml.etree import ElementTree

import numpy as np
import pytest
from scipy.stats import lognorm

from stylobate.cli.main import call
from stylobate.errors import InputError
from stylobate.probability.evidence import Evidence
from stylobate.probability.fragility import fragility
from stylobate.results.fragilities import write_nrml

TAG = "{http://openquake.org/xmlns/nrml/0.5}"


def curve(measure="pga", unit="g", name="column 1", state="collapse", seed=3):
    rng = np.random.default_rng(seed)
    levels = np.geomspace(0.1, 2.0, 8)
    codes = (np.log(levels) >= rng.normal(-0.7, 0.4, (12, 1))).astype(np.int8)
    names = np.repeat(np.array([f"r{i}" for i in range(12)], dtype=object), 8)
    return fragility(Evidence(names, np.tile(levels, 12), codes.ravel(), measure, unit, state, name), samples=50)


def as_openquake_reads(path):
    """Limit states, and by function its intensity, ends, and probability: attributes and formulas as its manual has them."""
    model = ElementTree.parse(path).getroot().find(f"{TAG}fragilityModel")
    assert {"id", "assetCategory", "lossCategory"} <= set(model.attrib)
    assert model.find(f"{TAG}description").text
    states = model.find(f"{TAG}limitStates").text.split()
    functions = {}
    for function in model.findall(f"{TAG}fragilityFunction"):
        assert (function.get("format"), function.get("shape")) == ("continuous", "logncdf")
        imls, *params = function
        assert imls.tag == f"{TAG}imls"
        assert [param.get("ls") for param in params] == states
        mean, stddev = (float(params[0].get(key)) for key in ("mean", "stddev"))
        spread = math.sqrt(math.log(stddev**2 / mean**2 + 1.0))
        median = mean**2 / math.sqrt(stddev**2 + mean**2)
        ends = float(imls.get("minIML")), float(imls.get("maxIML"))
        functions[function.get("id")] = (imls.get("imt"), ends, lognorm(spread, scale=median).cdf)
    return states, functions


@pytest.mark.parametrize(
    ("measure", "unit", "imt", "size"),
    [
        ("pga", "g", "PGA", 1.0),
        ("pgv", "m/s", "PGV", 100.0),  # OpenQuake counts velocities in cm/s
        ("sa:1.0s", "g", "SA(1)", 1.0),
        ("sa:0.25s", "g", "SA(0.25)", 1.0),
    ],
)
def test_what_is_read_back_is_the_curve(measure, unit, imt, size, tmp_path):
    original = curve(measure, unit, "two columns & a beam")
    path = write_nrml([original], tmp_path / "f.xml")
    states, functions = as_openquake_reads(path)
    assert states == ["collapse"]
    name, (low, high), probability = *functions["two columns & a beam"][:2], functions["two columns & a beam"][2]
    assert name == imt
    x = np.geomspace(0.05, 3.0, 30)
    exact = [
        0.5 * math.erfc(-(math.log(intensity) - original.log_median) / original.beta / math.sqrt(2.0))
        for intensity in x
    ]
    assert probability(size * x) == pytest.approx(exact, abs=1e-9)
    assert low <= size * 0.1
    assert high >= size * 2.0
    assert probability(low) < 1e-4
    assert probability(high) > 1.0 - 1e-4


def test_several_curves_of_one_state_are_one_model(tmp_path):
    both = [curve(name="a", state="top:0.35d"), curve(name="b", state="top:0.35d", seed=4)]
    states, functions = as_openquake_reads(write_nrml(both, tmp_path / "f.xml"))
    assert states == ["top_0_35d"]
    assert list(functions) == ["a", "b"]


def test_what_nrml_does_not_hold_is_refused_and_nothing_is_written(tmp_path):
    names = np.repeat(np.array([f"r{i}" for i in range(12)], dtype=object), 2)
    codes = np.tile(np.array([0, 1], dtype=np.int8), 12)
    sharp = Evidence(names, np.tile([0.1, 0.2], 12), codes, "pga", "g", "collapse", "c")
    for curves, message in (
        ([curve("cav", "m/s")], "NRML has names for pga, pgv and sa"),
        ([curve("im", "-")], "NRML has names"),
        ([curve(), curve(name="b", state="top:1d")], "are of 2 states"),
        ([curve(), curve("pgv", "m/s", "b")], "are of 2 intensities"),
        ([curve(), curve()], "two curves are called 'column 1'"),
        ([fragility(sharp, samples=50)], "do not show how capacities scatter"),
    ):
        with pytest.raises(InputError, match=message):
            write_nrml(curves, tmp_path / "f.xml")
    with pytest.raises(InputError, match=r"ends in \.xml"):
        write_nrml([curve()], tmp_path / "f.txt")
    assert list(tmp_path.iterdir()) == []


def test_the_command_writes_it_and_overwrites_nothing(tmp_path, capsys):
    rows = "".join(f"r{k},{x:.4f},{int(x > 0.4 + 0.05 * k)}\n" for k in range(12) for x in np.geomspace(0.1, 2.0, 9))
    (tmp_path / "runs.csv").write_text("record,pga_g,collapsed\n" + rows)
    command = ["fragility", str(tmp_path / "runs.csv"), "--im", "pga", "--nrml", str(tmp_path / "f.xml")]
    assert call(command) == 0
    assert f"written: {tmp_path / 'f.xml'}" in capsys.readouterr().out
    assert list(as_openquake_reads(tmp_path / "f.xml")[1]) == ["runs"]
    assert call(command) == 2
    assert "is there already" in capsys.readouterr().err
