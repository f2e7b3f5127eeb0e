"""``stylobate reproduce`` on tiny grids: everything is there, whole, without a network, and resumed where it was."""

import dataclasses
import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas
import pytest
import xarray
from tiny_study import GRIDS, shorten

import stylobate as st
from stylobate.atomic import LIST, output_folder, own_files, replacing
from stylobate.campaign.ledger import APPLICATION, RUNS_FILE, finished_runs_in
from stylobate.cli.main import call
from stylobate.errors import DamagedFileWarning
from stylobate.verdicts import verdict as v
from stylobate.verdicts.domain import Domain
from stylobate_report.page import Picture, Rows, Section
from stylobate_studies.commands.reproduce import build, describe
from stylobate_studies.paper import literature, pieces, study
from stylobate_studies.paper.cases import BEAM
from stylobate_studies.paper.folder import check_folder, claim
from stylobate_studies.paper.page import write_page
from stylobate_studies.paper.sentences import HOLDS, MEANINGS
from stylobate_studies.paper.statements import statements
from stylobate_studies.paper.study import run_study

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        shorten(patch.setattr)
        folder = tmp_path_factory.mktemp("paper")
        yield folder, build(folder, True, 2, GRIDS), patch


@pytest.mark.slow
def test_everything_is_written(made):
    folder, summary, _ = made
    assert {path.name for path in folder.iterdir()} == {
        LIST, "data", "figures", "tables", "index.html", "reproduce.json", "statements.md",
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
        "space",
    } <= stems
    assert {path.suffix for path in (folder / "figures").iterdir()} == {".png", ".svg"}
    assert len(list((folder / "figures").iterdir())) == 2 * summary["figures"]
    names = {"cases.csv", "certainty.csv", "domains.csv", "statements.csv"}
    assert {path.name for path in (folder / "tables").iterdir()} == names
    assert len(pandas.read_csv(folder / "tables" / "cases.csv")) == 2 * 2 * 4
    assert len(list((folder / "data").glob("*/domain.nc"))) == 2 * (4 + 2 + 3 + 2 + len(GRIDS.variants) + 4) + 4
    assert len(list((folder / "data").glob("*/probability.nc"))) == 2 + 2 + 2 * 3
    assert [path.name for path in (folder / "data").rglob("*.sqlite*")] == [RUNS_FILE]


def test_every_sentence_has_a_verdict(made):
    folder, summary, _ = made
    table = pandas.read_csv(folder / "tables" / "statements.csv")
    assert set(table["verdict"]) <= set(MEANINGS)
    assert len(table) == summary["statements"] == sum(summary["verdicts"].values()) == 68
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
    names, real = [], pieces.collapse_domain

    def counted(*args, **kwargs):
        names.append(kwargs["out"].name)
        return real(*args, **kwargs)

    monkeypatch.setattr(pieces, "collapse_domain", counted)
    run_study(folder, True, 1, grids=GRIDS)
    assert names == [piece.parent.name]
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
    assert (tmp_path / "data" / "study.json").exists()


def claimed(folder, grids=GRIDS):
    check_folder(folder)
    with output_folder(folder), own_files(folder) as own:
        claim(own, grids)
        yield folder / "data"


def snapshot(folder):
    return {
        path.relative_to(folder): (path.read_bytes() if path.is_file() else None, path.lstat().st_mtime_ns)
        for path in [folder, *folder.rglob("*")]
    }


def test_what_a_killed_run_left_half_written_is_removed_by_the_next_and_nothing_else(tmp_path):
    script = (
        "import os, signal, sys\n"
        "from stylobate.atomic import replacing\n"
        "with replacing(sys.argv[1]) as partial:\n"
        "    partial.write_text('half')\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    target = tmp_path / "domain.nc"
    assert subprocess.run([sys.executable, "-c", script, str(target)], check=False).returncode == -9
    (remnant,) = tmp_path.iterdir()
    foreign = [".domain-ab_3.nc", ".domain.1-0123abcd-0123456789ab.nc", ".env-local.sh", ".pre-commit-config.yaml"]
    for name in foreign:
        (tmp_path / name).write_text("mine")
    with replacing(tmp_path / "other.nc") as partial:
        partial.write_text("whole")
    assert remnant.exists()  # of another file
    with replacing(target) as partial:
        partial.write_text("whole")
    assert {path.name for path in tmp_path.iterdir()} == {*foreign, "domain.nc", "other.nc"}


def test_pieces_of_another_version_are_computed_anew_and_what_is_not_ours_stays(tmp_path, monkeypatch):
    folder = tmp_path / "study"
    for data in claimed(folder):
        with replacing(data / "old.nc") as partial:
            partial.write_text("a piece")
        (data / "mine.nc").write_text("not a piece")
        (data / ".env-local.sh").write_text("not a piece")
        with replacing(data / "edited.csv") as partial:
            partial.write_text("a piece")
        (data / "edited.csv").write_text("edited by a person")
    for data in claimed(folder):
        assert (data / "old.nc").exists()
    monkeypatch.setattr("stylobate_studies.paper.folder.source_digest", lambda: "another law")
    for data in claimed(folder):
        assert {path.name for path in data.iterdir()} == {"study.json", "mine.nc", ".env-local.sh", "edited.csv"}


def test_unfinished_runs_of_an_earlier_version_are_refused(tmp_path):
    for data in claimed(tmp_path / "study"):
        (data / "domain-a").mkdir()
        (data / "domain-a" / "progress.sqlite").write_bytes(bytes(68) + APPLICATION.to_bytes(4) + bytes(28))
        (data / "mine.sqlite").write_bytes(b"no ledger")
    with pytest.raises(st.InputError, match=r"domain-a.progress\.sqlite keeps unfinished runs of an earlier version"):
        check_folder(tmp_path / "study")


def test_a_foreign_folder_is_refused_and_nothing_in_it_is_touched(tmp_path, capsys):
    home = tmp_path / "home"
    (home / "data" / "repo").mkdir(parents=True)
    for name in (".env-local.sh", ".pre-commit-config.yaml", "data/.a-b.c", "data/repo/.gitlab-ci.yml", "data/x.csv"):
        (home / name).write_text("mine")
    # what it was once taken for: a study of other code
    (home / "data" / "study.json").write_text('{"grids": {}, "code": {}}')
    (tmp_path / "link").symlink_to(home)
    (tmp_path / "only-hidden").mkdir()
    (tmp_path / "only-hidden" / ".a-b.c").write_text("mine")
    before = snapshot(tmp_path)
    for place in ("home", "link", "only-hidden", "home/data/x.csv"):
        assert call(["reproduce", "--quick", "--out", str(tmp_path / place)]) == 2
        assert capsys.readouterr().err.count("\n") == 1
    assert snapshot(tmp_path) == before


def test_a_link_in_the_folder_of_a_study_leads_nowhere(tmp_path, capsys):
    folder, foreign = tmp_path / "study", tmp_path / "foreign"
    for _ in claimed(folder):
        pass
    foreign.mkdir()
    (foreign / "domain.nc").write_text("mine")
    (folder / "figures").symlink_to(foreign)
    assert call(["reproduce", "--quick", "--out", str(folder)]) == 2
    assert "is a link to another folder" in capsys.readouterr().err
    (folder / "data" / "domain-x").symlink_to(foreign)
    for data in claimed_without_check(folder):
        with pytest.raises(st.InputError, match="is a link to another folder"):
            pieces.is_ready(data / "domain-x" / "domain.nc")
    assert [path.name for path in foreign.iterdir()] == ["domain.nc"]


def claimed_without_check(folder):
    with own_files(folder) as own:
        claim(own, GRIDS)
        yield folder / "data"


def test_a_damaged_piece_is_kept_aside_and_computed_anew(tmp_path):
    for data in claimed(tmp_path / "study"):
        with replacing(data / "cost.json") as partial:
            partial.write_text("{}")
        assert pieces.is_ready(data / "cost.json")
        (data / "cost.json").write_text("")
        with pytest.warns(DamagedFileWarning, match=r"kept as cost\.json\.damaged-1"):
            assert not pieces.is_ready(data / "cost.json")


def test_histories_go_on_in_the_middle(made, monkeypatch):
    folder, _, _ = made
    name = pieces.slug("histories", "paper-monolithic", BEAM)
    place = folder / "data" / f"{name}.nc"
    before = xarray.load_dataset(place, engine="h5netcdf")
    place.unlink()
    (folder / "data" / RUNS_FILE).unlink()
    real, calls = pieces.simulate, []

    def simulate(*args, **kwargs):
        calls.append(args)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return real(*args, **kwargs)

    monkeypatch.setattr(pieces, "simulate", simulate)
    with pytest.raises(KeyboardInterrupt):
        run_study(folder, True, 1, grids=GRIDS)
    kept = finished_runs_in(folder / "data" / RUNS_FILE)
    assert 2 <= kept <= 3  # the others of the pool may have come in
    run_study(folder, True, 1, grids=GRIDS)
    assert len(calls) <= 3 + 4 - kept + 1
    xarray.testing.assert_identical(before, xarray.load_dataset(place, engine="h5netcdf"))
    place.unlink()
    calls.clear()
    run_study(folder, True, 1, grids=GRIDS)
    assert calls == []  # the ledger has them all
    xarray.testing.assert_identical(before, xarray.load_dataset(place, engine="h5netcdf"))


def test_the_table_in_markdown_says_how_it_was_made_and_what_its_verdicts_mean(made):
    folder, summary, _ = made
    text = (folder / "statements.md").read_text(encoding="utf-8")
    assert "Written by `stylobate reproduce --quick`" in text
    for verdict, number in summary["verdicts"].items():
        assert f"- **{verdict}** ({number}): " in text
    prefixes = ("| §", "| Abstract", "| Mouzakis", "| arXiv")
    assert sum(line.startswith(prefixes) for line in text.splitlines()) == summary["statements"]


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
    results = run_study(folder, True, 1, grids=GRIDS)
    single, population = 6 * (4 + 2) + 2 * 3 + 4 * len(GRIDS.variants), 3 * 6
    tested = len(literature.QUESTIONS) * literature.NUMBER
    space = 2 * (3 * 2 + 4)  # two cells: three populations of two columns, four plane domains
    assert (
        summary["runs"] == results.runs == 2 * (single + 2 * 6 + population + space) + 2 * 50 + 4 * 4 + 4 * 4 + tested
    )
    assert list(results.shaken) == ["beam, as the paper", "beam, true drums", "beam, β = 0.5 ms", "DEM, two points"]
    for name, doubt in results.doubts.items():
        assert doubt.steps.halved.provenance["parameters"]["step_factor"] == 0.5 * st.DistinctElement2D().step_factor
        assert doubt.another.shape == doubt.differing.shape == (2, 3)
        assert (doubt.another == np.array(v.VERDICTS, dtype=object)[doubt.population.codes[..., 0]]).all()
        assert doubt.population.column.name == name


def test_the_page_escapes_what_it_is_given(tmp_path):
    picture = tmp_path / "one.png"
    picture.write_bytes(b"\x89PNG")
    rows = Rows(("a", "b"), [("1 < 2", "does not hold"), ("K_M 5 Hz", "holds")], mark=1, looks={"does not hold": "bad"})
    page = write_page(tmp_path / "x.html", "a & b", ["<p>"], [Section("s", ["t<", Picture(picture, 'c"'), rows])])
    text = page.read_text(encoding="utf-8")
    assert "a &amp; b" in text
    assert "<p>&lt;p&gt;</p>" in text
    assert 'alt="c&#34;"' in text
    assert '<td class="bad" data-name="b">✗ does not hold</td>' in text
    assert (
        '<td class="" data-name="a">K<sub>M</sub> 5\N{NO-BREAK SPACE}Hz</td><td class="fair" data-name="b">! holds'
        in text
    )
    assert "{{" not in text
