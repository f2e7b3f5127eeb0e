"""``stylobate reproduce`` on tiny grids: everything is there, whole, without a network, and resumed where it was."""

import dataclasses
import json
import re
import subprocess
from pathlib import Path

import numpy as np
import pandas
import pytest

import stylobate as st
from stylobate.analysis import verdicts as v
from stylobate.analysis.domain import Domain
from stylobate.cli.main import call
from stylobate.cli.reproduce import build, describe
from stylobate.paper import cases, pieces, study
from stylobate.paper.cases import BEAM, Grids
from stylobate.paper.reading import CHOICES, FAILS, HOLDS
from stylobate.paper.statements import statements
from stylobate.paper.study import run_study
from stylobate.report.page import Picture, Rows, Section, write_page

ROOT = Path(__file__).parents[2]
GRIDS = dataclasses.replace(
    Grids.of(True),
    frequencies=np.array([0.66, 2.0]),
    amplitudes=np.array([0.15, 0.3, 0.5]) * st.g,
    variant_frequencies=np.array([0.66, 2.0]),
    variant_amplitudes=np.array([0.2, 0.5]) * st.g,
    variants=(
        "beam, as the paper",
        "beam, true drums",
        "beam, β = 0.5 ms",
        "beam with sliding",
        "beam with sliding, tan φ = 10",
        "DEM, two points",
        "DEM, elastic blocks",
        "DEM, tan φ = 10",
    ),
    limit_amplitudes=np.array([0.15, 0.25]) * st.g,
    tail=1.0,
    doubt_frequencies=np.array([0.5, 0.8]),
    doubt_amplitudes=np.array([0.2, 0.3, 0.4]) * st.g,
    replicates=3,
)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cases, "DURATION", 3.0)
        patch.setattr(cases, "FREQUENCIES", np.array([0.66, 2.0]))
        patch.setattr(cases, "AMPLITUDES", np.array([0.2, 0.5]) * st.g)
        folder = tmp_path_factory.mktemp("paper")
        yield folder, build(folder, True, 2, GRIDS), patch


def test_everything_is_written(made):
    folder, summary, _ = made
    assert {path.name for path in folder.iterdir()} == {
        "data", "figures", "tables", "index.html", "reproduce.json", "statements.md",
    }  # fmt: skip
    assert json.loads((folder / "reproduce.json").read_text()) == json.loads(json.dumps(summary))
    stems = {path.stem for path in (folder / "figures").iterdir()}
    for number in (3, 4, 5, 6, 7, 8, 9):
        assert any(stem.startswith(f"figure-{number}-") for stem in stems)
    assert {
        "domains",
        "domains-circular",
        "pushover",
        "certainty-paper-12-drums",
        "probability-paper-monolithic",
    } <= stems
    assert {path.suffix for path in (folder / "figures").iterdir()} == {".png", ".svg"}
    assert len(list((folder / "figures").iterdir())) == 2 * summary["figures"]
    names = {"cases.csv", "certainty.csv", "domains.csv", "statements.csv"}
    assert {path.name for path in (folder / "tables").iterdir()} == names
    assert len(pandas.read_csv(folder / "tables" / "cases.csv")) == 2 * 2 * 4
    assert len(list((folder / "data").glob("*/domain.nc"))) == 2 * (4 + 2 + 3 + 2 + len(GRIDS.variants)) + 4
    assert len(list((folder / "data").glob("*/probability.nc"))) == 4
    assert not list((folder / "data").glob("*/progress.sqlite*"))


def test_every_sentence_has_a_verdict(made):
    folder, summary, _ = made
    table = pandas.read_csv(folder / "tables" / "statements.csv")
    assert set(table["verdict"]) <= {HOLDS, CHOICES, FAILS}
    assert len(table) == summary["statements"] == sum(summary["verdicts"].values()) == 26
    assert not table["ours"].str.contains("nan").any()
    assert table["why"].notna().all()


def test_the_page_needs_no_network(made):
    folder, summary, _ = made
    page = (folder / "index.html").read_text(encoding="utf-8")
    assert not re.findall(r"(?:src|href)=[\"'](?!data:image/png;base64,|#)", page)
    assert "@import" not in page
    assert "url(" not in page
    assert page.count("<img ") == summary["figures"]
    assert 'name="viewport"' in page
    for words in ("holds", "tan φ = 0.70", "a sin 2πft from rest", "What was chosen", "Look first at", "coin toss"):
        assert words in page


def test_finished_pieces_are_not_computed_again(made, monkeypatch):
    folder, _, _ = made
    table = pandas.read_csv(folder / "tables" / "statements.csv")

    def never(*_, **__):
        raise AssertionError("computed again")

    for name in ("collapse_domain", "collapse_probability", "simulate", "simulate_many"):
        monkeypatch.setattr(pieces, name, never)
    again = statements(run_study(folder, True, 2, grids=GRIDS))
    assert [row.ours for row in again] == table["ours"].tolist()


def test_a_piece_that_is_missing_is_computed_alone(made, monkeypatch):
    folder, _, _ = made
    piece = folder / "data" / pieces.slug("domain", "paper-monolithic", BEAM, "circular") / "domain.nc"
    before = Domain.load(piece)
    piece.unlink()
    asked, real = [], pieces.collapse_domain

    def counted(*args, **kwargs):
        asked.append(kwargs["out"].name)
        return real(*args, **kwargs)

    monkeypatch.setattr(pieces, "collapse_domain", counted)
    run_study(folder, True, 1, grids=GRIDS)
    assert asked == [piece.parent.name]
    np.testing.assert_array_equal(Domain.load(piece).verdicts, before.verdicts)


def test_another_study_in_the_folder_is_refused(made):
    folder, _, _ = made
    with pytest.raises(st.InputError, match="another study"):
        build(folder, True, 1, dataclasses.replace(GRIDS, tail=2.0))


def test_an_interrupt_says_what_is_kept(tmp_path, monkeypatch, capsys):
    def stopped(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(study, "histories_piece", stopped)
    assert call(["reproduce", "--quick", "--out", str(tmp_path)]) == 130
    assert "the same command goes on from there" in capsys.readouterr().err


def test_what_a_killed_run_left_half_written_is_swept_away(tmp_path):
    (tmp_path / "domain").mkdir()
    for left in (tmp_path / ".study-x1y2.json", tmp_path / "domain" / ".domain-ab_3.nc"):
        left.touch()
    (tmp_path / "domain" / "domain.nc").touch()
    pieces.claim(tmp_path, GRIDS)
    assert {path.name for path in tmp_path.rglob("*")} == {"domain", "domain.nc", "study.json"}


def test_pieces_of_another_version_are_computed_anew(tmp_path, monkeypatch):
    (tmp_path / "old.nc").touch()
    pieces.claim(tmp_path, GRIDS)
    pieces.claim(tmp_path, GRIDS)
    assert (tmp_path / "old.nc").exists()
    monkeypatch.setattr(pieces, "source_digest", lambda: "another law")
    pieces.claim(tmp_path, GRIDS)
    assert [path.name for path in tmp_path.iterdir()] == ["study.json"]


def test_the_table_in_markdown_says_how_it_was_made_and_what_its_verdicts_mean(made):
    folder, summary, _ = made
    text = (folder / "statements.md").read_text(encoding="utf-8")
    assert "Written by `stylobate reproduce --quick`" in text
    for verdict, number in summary["verdicts"].items():
        assert f"- **{verdict}** ({number}): " in text
    assert sum(line.startswith(("| §", "| Abstract")) for line in text.splitlines()) == summary["statements"]


def test_the_demonstration_is_the_coarse_study():
    done = subprocess.run(["make", "-n", "demo"], cwd=ROOT, capture_output=True, text=True, check=True)
    assert any(line.endswith("bin/stylobate reproduce --quick --out demo") for line in done.stdout.splitlines())


def test_a_person_is_told_what_holds_and_at_last_where_the_pictures_are(made, capsys):
    folder, summary, _ = made
    describe(summary)
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith(f"The paper's two columns by all models: {summary['runs']} histories in ")
    assert any(line.split() == ["holds", str(summary["verdicts"][HOLDS])] for line in lines)
    assert f"Open {folder / 'index.html'} in a browser." in lines
    assert lines[-1] == str((folder / "figures").resolve())


def test_runs_are_counted_and_certainty_is_what_its_domains_say(made):
    folder, summary, _ = made
    found = run_study(folder, True, 1, grids=GRIDS)
    single, population = 6 * (4 + 2) + 2 * 3 + 4 * len(GRIDS.variants), 3 * 6
    assert summary["runs"] == found.runs == 2 * (single + 2 * 6 + population) + 2 * 50 + 4 * 4 + 4 * 4
    assert list(found.shaken) == ["beam, as the paper", "beam, true drums", "beam, β = 0.5 ms", "DEM, two points"]
    for name, doubt in found.doubts.items():
        assert doubt.steps.halved.provenance["parameters"]["step_factor"] == 0.5 * st.DistinctElement2D().step_factor
        assert doubt.another.shape == doubt.differing.shape == (2, 3)
        assert (doubt.another == np.array(v.VERDICTS, dtype=object)[doubt.population.codes[..., 0]]).all()
        assert doubt.population.column.name == name


def test_the_page_escapes_what_it_is_given(tmp_path):
    picture = tmp_path / "one.png"
    picture.write_bytes(b"\x89PNG")
    rows = Rows(("a", "b"), [("1 < 2", "does not hold")], mark=1)
    page = write_page(tmp_path / "x.html", "a & b", ["<p>"], [Section("s", ["t<", Picture(picture, 'c"'), rows])])
    text = page.read_text(encoding="utf-8")
    assert "a &amp; b" in text
    assert "<p>&lt;p&gt;</p>" in text
    assert 'alt="c&quot;"' in text
    assert '<td class="fails" data-name="b">✗ does not hold</td>' in text
