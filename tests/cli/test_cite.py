"""``stylobate cite``: what a model or a result rests on, as text, BibTeX and JSON, and the source of a record."""

import json
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
import xarray

import stylobate as st
from stylobate.bibliography import bibliography
from stylobate.bibliography.citation import PACKAGE, parse
from stylobate.cli.main import call
from stylobate.column import preset
from stylobate.column.standing import of_column
from stylobate.motion import parse_pulse, stochastic_motion
from stylobate.response import Response
from stylobate.simulate import simulate


def cite(capsys, *arguments, code=0):
    assert call(["cite", *map(str, arguments)]) == code
    return capsys.readouterr()


@pytest.fixture(scope="module")
def record(tmp_path_factory):
    """A response to a record whose file names its source."""
    folder = tmp_path_factory.mktemp("record")
    rows = "\n".join(f"{0.01 * i:.2f},{0.1 * np.sin(0.2 * i):.6f}" for i in range(200))
    notes = "# station: HSES\n# network: NZ\n# event: Waiau\n# terms: CC BY"
    file = folder / "own.csv"
    file.write_text(f"{notes}\ntime_s,ax_g\n{rows}\n")
    response = st.simulate(preset("paper-monolithic"), st.read_motion(file), st.HousnerBlock())
    return response.save(folder / "response.nc")


def test_a_response_names_model_and_record(capsys, record):
    text = cite(capsys, record).out
    for part in ("stylobate developers", "Housner, G. W. (1963)", "HSES", "NZ", "Waiau", "CC BY"):
        assert part in text
    assert text.strip() == Response.load(record).citation()


def test_bibtex_of_a_response_is_read_back(capsys, record):
    entries = {entry.key: entry for entry in parse(cite(capsys, record, "--bibtex").out)}
    assert set(entries) == {"stylobate", *st.HousnerBlock.references}
    assert entries["housner1963"] == bibliography()["housner1963"]
    assert entries["stylobate"].fields["version"] == st.__version__


def test_json_of_a_model_and_files(capsys, tmp_path):
    answer = json.loads(cite(capsys, "--model", "dem2d", "--json", "--out", tmp_path / "c").out)
    assert [reference["key"] for reference in answer["references"]] == ["stylobate", *st.DistinctElement2D.references]
    assert answer["motion"] == {}
    assert (tmp_path / "c" / "citation.bib").read_text() == answer["bibtex"] + "\n"
    assert (tmp_path / "c" / "citation.txt").read_text() == answer["text"] + "\n"


def test_computed_motions_bring_their_sources():
    column = preset("paper-monolithic")
    for motion, key in (
        (parse_pulse("mavroeidis-papageorgiou,1Hz,0.05g,3s"), "mavroeidis2003"),
        (stochastic_motion(5.0, 5e4, "greece"), "margaris1998"),
    ):
        text = st.simulate(column, motion, st.HousnerBlock()).citation()
        assert bibliography()[key].text in text
        assert "source of the ground motion" not in text


def test_an_assembly_names_its_contact(capsys, tmp_path):
    response = simulate(
        of_column(preset("paper-monolithic")), st.harmonic(1.0, 0.01 * st.g, 0.05), st.DistinctElement2D()
    )
    text = cite(capsys, response.save(tmp_path / "assembly.nc")).out
    assert text.strip() == response.citation()
    assert bibliography()["feng2004"].text in text


def test_a_domain_can_be_cited(capsys, tmp_path):
    domain = st.collapse_domain(preset("paper-monolithic"), st.HousnerBlock(), [1.0], [0.1 * st.g], 1.0)
    assert "Housner, G. W. (1963)" in cite(capsys, domain.save(tmp_path / "domain.nc")).out


def test_the_package_alone_and_everything(capsys):
    assert "stylobate developers" in cite(capsys).out
    assert {entry.key for entry in parse(cite(capsys, "--all", "--bibtex").out)} == {"stylobate", *bibliography()}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nowhere.nc"], "there is no file nowhere.nc"),
        (["--model", "dem4d"], "there is no model 'dem4d'; did you mean dem3d?"),
        (["--model", "dem2d", "--all"], "give one of RESULT, --model and --all"),
        (["--threads", "x"], "--threads is 'x'"),
    ],
)
def test_bad_input_is_one_sentence(capsys, arguments, message):
    captured = cite(capsys, *arguments, code=2)
    assert captured.out == ""
    assert re.fullmatch(rf"stylobate: [^\n]*{re.escape(message)}[^\n]*\n", captured.err)


def test_a_file_without_provenance_is_refused(capsys, tmp_path):
    file = tmp_path / "text.nc"
    file.write_text("no netCDF")
    assert "cannot be read as netCDF: it does not begin like one" in cite(capsys, file, code=2).err
    xarray.Dataset({"a": ("x", [1.0])}).to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    assert "is no result of this package" in cite(capsys, tmp_path / "other.nc", code=2).err


def test_the_citation_file_agrees_with_the_package():
    root = Path(__file__).parents[2]
    lines = dict(re.findall(r"^(?:  - )?(\w+): \"?(.*?)\"?$", (root / "CITATION.cff").read_text(), re.MULTILINE))
    project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
    assert project["dynamic"] == ["version"]  # which the build reads where the package does
    assert lines["version"] == st.__version__ == PACKAGE.fields["version"]
    assert lines["title"] == PACKAGE.fields["title"]
    assert (lines["name"],) == PACKAGE.authors == tuple(author["name"] for author in project["authors"])
    assert lines["license"] == project["license"]
