"""``stylobate survival`` of several sites: files, words, pictures, the report, and what is refused."""

import json

import numpy as np
import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate.probability.risk import read_hazard
from stylobate.results import read_results

SITES = """
branches = "tree.csv"
[[sites]]
name = "Hill"
at = [21.63, 37.64]
vs30 = 400.0
[[sites]]
name = "Valley"
at = [21.90, 37.43]
[[monuments]]
name = "column"
site = "Hill"
seen = "stands"
age = [2300, 2450]
im = "pgv"
median = 0.9
median_95 = [0.6, 1.3]
beta = 0.5
beta_95 = [0.35, 0.7]
[[monuments]]
name = "temple"
site = "Valley"
seen = "reached"
age = 2400
until = [1400, 1500]
fragility = "runs.csv"
im = "pgv"
"""

SOURCES = """source,lon,lat,lon2,lat2,radius_km,magnitude_min,magnitude_max,rate,b,mechanism
fault,21.45,37.85,21.75,37.45,,5.8,7.0,{rate},1,normal
around,21.8,37.5,,,10,5.2,5.4,{rate},1,strike-slip
"""


@pytest.fixture
def place(tmp_path):
    rng = np.random.default_rng(5)
    lines = ["record,im,collapsed"]
    for k in range(12):
        capacity = rng.normal(-0.9, 0.4)
        lines += [f"r{k},{x:.4f},{int(np.log(x) > capacity)}" for x in np.geomspace(0.1, 2.0, 8)]
    (tmp_path / "runs.csv").write_text("\n".join(lines) + "\n")
    for name, k0 in (("A", 1e-4), ("B", 2e-3)):
        rows = [f"{a:.5g},{k0 * a**-2:.5g}" for a in np.geomspace(0.02, 5.0, 12)]
        (tmp_path / f"{name}.csv").write_text("\n".join(["pgv_m_s,annual_rate", *rows]) + "\n")
        (tmp_path / f"{name}-sources.csv").write_text(SOURCES.format(rate=100.0 * k0))
    (tmp_path / "tree.csv").write_text("branch,weight,Hill,Valley\nlow,0.67,A.csv,A.csv\nhigh,0.33,B.csv,B.csv\n")
    (tmp_path / "shared.csv").write_text(
        "branch,weight,sources,model\nlow,0.67,A-sources.csv,akkar-bommer-2010\nhigh,0.33,B-sources.csv,bindi-2014\n"
    )
    (tmp_path / "sites.toml").write_text(SITES)
    return tmp_path


def output_of(capsys, *arguments, code=0):
    assert call([str(argument) for argument in arguments]) == code
    got = capsys.readouterr()
    return json.loads(got.out) if code == 0 and "--json" in arguments else got


def test_sites_with_hazard_curves(place, capsys):
    answer = output_of(capsys, "survival", place / "sites.toml", "--out", place / "out", "--json")
    low, high = answer["hazards"]
    assert (low["prior_weight"], high["prior_weight"]) == pytest.approx((0.67, 0.33))
    assert low["weight"] + high["weight"] == pytest.approx(1.0)
    assert low["weight_if_own"] == low["weight"] != low["weight_if_shared"]
    assert low["probability_low"] < low["probability"] < low["probability_high"]
    assert answer["earthquakes"] == "each site its own"
    assert "did all shake every site" in answer["sentence"]
    assert [row["monument"] for row in answer["monuments"]] == ["column", "temple"]
    assert {file.rpartition("/")[2] for file in answer["files"]} == {
        "survival.csv", "hazard.csv", "survival.png", "survival.svg", "survival.json", "asked-survival.json"}  # fmt: skip
    (result,) = read_results([place / "out"])
    assert {"mean_before", "fractile_95_after"} <= set(result.tables["hazard"].columns)
    output_of(capsys, "report", place / "out", "--out", place / "page.html")
    page = (place / "page.html").read_text()
    assert "temple has come to collapse" in page
    assert "bits" in page
    text = output_of(capsys, "survival", place / "sites.toml").out
    assert "once in 475 years before" in text


def test_sites_that_share_earthquakes(place, capsys):
    (place / "sites.toml").write_text(SITES.replace("tree.csv", "shared.csv"))
    answer = output_of(capsys, "survival", place / "sites.toml", "--json")
    assert answer["earthquakes"] == "from sources, shared"
    assert any("geometric mean" in warning for warning in answer["warnings"])
    assert all(row["weight_error"] < 0.05 for row in answer["hazards"])
    again = st.weigh(st.read_sites(place / "sites.toml"))  # the same numbers, whoever asks
    assert again.weight == pytest.approx([row["weight"] for row in answer["hazards"]], rel=1e-12)


def test_a_kept_fragility_is_the_one_that_its_runs_make(place, capsys):
    output_of(capsys, "fragility", place / "runs.csv", "--im", "pgv", "--out", place / "kept")
    direct = st.weigh(st.read_sites(place / "sites.toml"))
    (place / "sites.toml").write_text(SITES.replace("runs.csv", "kept"))
    assert st.weigh(st.read_sites(place / "sites.toml")).weight == pytest.approx(direct.weight, rel=1e-12)


NRML = """<?xml version="1.0" encoding="UTF-8"?>
<nrml xmlns:gml="http://www.opengis.net/gml" xmlns="http://openquake.org/xmlns/nrml/0.5">
<hazardCurves IMT="PGV" investigationTime="50.0" statistics="mean">
<IMLs>10.0 20.0 40.0</IMLs>
<hazardCurve><gml:Point><gml:pos>21.90 37.43</gml:pos></gml:Point><poEs>0.4 0.2 0.05</poEs></hazardCurve>
<hazardCurve><gml:Point><gml:pos>23.70 38.00</gml:pos></gml:Point><poEs>0.9 0.5 0.1</poEs></hazardCurve>
</hazardCurves></nrml>
"""


def test_hazard_curves_in_nrml(tmp_path):
    path = tmp_path / "curve.xml"
    path.write_text(NRML)
    hazard = read_hazard(path, (22.0, 37.4))
    assert (hazard.unit, hazard.imt) == ("m/s", "PGV")
    assert hazard.im == pytest.approx([0.1, 0.2, 0.4])  # cm/s
    assert hazard.rate == pytest.approx(-np.log1p(-np.array([0.4, 0.2, 0.05])) / 50.0)
    for old, new, why in (
        ("</nrml>", "", "no XML"),
        ('investigationTime="50.0" ', "", "investigationTime"),
        ("0.4 0.2 0.05", "0.4 0.2", "3 intensities and 2"),
        ("0.4 0.2 0.05", "nan 0.2 0.05", "outside 0 to 1"),
        ('IMT="PGV"', 'IMT="SA" saPeriod="1 s"', "saPeriod of curve.xml has '1 s' where a number"),
        ('IMT="PGV"', 'IMT="SA" saPeriod="1.0" saDamping="2.0"', "damping of 2.0"),
        ("21.90 37.43", "", "2 sites without longitude and latitude"),
        ("<nrml", "<!DOCTYPE x [<!ENTITY a 'b'>]><nrml", "entities"),
        ("hazardCurves", "other", "0 sets"),
    ):
        path.write_text(NRML.replace(old, new))
        with pytest.raises(st.InputError, match=why):
            read_hazard(path, (22.0, 37.4))
    path.write_text(NRML.replace('"mean"', '"Mean"'))
    assert read_hazard(path, (22.0, 37.4)).statistic == hazard.statistic == "mean"
    with pytest.raises(st.InputError, match="2 sites"):
        read_hazard(path)


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ('seen = "stands"', 'seen = "cracked"', "`seen`"),
        ("age = 2400", "age = 1450", "was as it was for no more than 1450"),
        ("age = 2400", 'age = "old"', "list of two numbers"),
        ('site = "Valley"', 'site = "Sea"', "site"),
        ('im = "pgv"\nmedian', 'im = "pga"\nmedian', "different intensities"),
        ("median = 0.9", "median = 1.9", "median_95"),
        ("runs.csv", "nothing.csv", "no file"),
        ('name = "temple"', 'name = "column"', "two states of monuments are called"),
        ("tree.csv", "none.csv", "no file"),
        ("vs30 = 400.0", "vs = 400.0", "unknown key 'vs'"),
        ('im = "pgv"\nmedian = 0.9', "median = 0.9", "needs `fragility`"),
    ],
)  # fmt: skip
def test_bad_files_are_one_sentence(place, capsys, old, new, why):
    (place / "sites.toml").write_text(SITES.replace(old, new))
    got = output_of(capsys, "survival", place / "sites.toml", "--out", place / "out", code=2)
    assert why.replace("`", "") in got.err.replace("`", "")
    assert got.err.count("\n") == 1
    assert not (place / "out").exists() or not any((place / "out").iterdir())


def test_bad_branches_and_options_are_one_sentence(place, capsys):
    tree, shared = place / "tree.csv", place / "shared.csv"
    for text, why in (
        ("branch,weight,Hill\nlow,1,A.csv\n", "hazard curve of site"),
        ("branch,weight,Hill,Sea\nlow,1,A.csv,A.csv\n", "is 'sea'"),
        ("branch,weight,Hill,Valley\nlow,-1,A.csv,A.csv\n", "weight"),
        ("branch,weight,Hill,Valley,sources,model\nlow,1,A.csv,A.csv,,\nb,1,,,A-sources.csv,bindi-2014\n", "one kind"),
        ("branch,weight,Hill,Valley\nlow,0.5,A.csv,A.csv\nhigh,0.8,B.csv,B.csv\n", "sum to 1.3"),
        ("branch,weight,sources,model\nlow,1,A-sources.csv,mine\n", "model"),
        ("branch,weight,sources,model\nlow,1,A-sources.csv,\n", "ground-motion model"),
    ):
        tree.write_text(text)
        got = output_of(capsys, "survival", place / "sites.toml", code=2)
        assert why in got.err
        assert got.err.count("\n") == 1
    (place / "A-sources.csv").write_text(SOURCES.format(rate=0.01).replace("21.8,37.5", "24.8,37.5"))
    (place / "sites.toml").write_text(SITES.replace("tree.csv", shared.name))
    got = output_of(capsys, "survival", place / "sites.toml", code=2)
    assert "distance" in got.err
    assert "which holds from 0 to 100 km" in got.err
    got = output_of(capsys, "survival", place / "sites.toml", "--age", "9y", code=2)
    assert "leave out --age" in got.err
    got = output_of(capsys, "survival", place / "runs.csv", "--age", "9y", code=2)
    assert "--hazard" in got.err
