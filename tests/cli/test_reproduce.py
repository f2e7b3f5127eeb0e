"""``stylobate reproduce`` on tiny grids: everything is there, whole, without a network, and resumed where it was."""

import dataclasses
import json
import re

import numpy as np
import pandas
import pytest

import stylobate as st
from stylobate.analysis import paper_study
from stylobate.analysis.domain import Domain
from stylobate.analysis.paper_statements import CHOICES, FAILS, HOLDS, statements
from stylobate.analysis.paper_study import BEAM, Grids, run_study
from stylobate.cli.main import call
from stylobate.cli.reproduce import build
from stylobate.report.page import Picture, Rows, Section, write_page

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
        "DEM, tan φ = 10",
    ),
    limit_amplitudes=np.array([0.15, 0.25]) * st.g,
)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(paper_study, "DURATION", 3.0)
        patch.setattr(paper_study, "FREQUENCIES", np.array([0.66, 2.0]))
        patch.setattr(paper_study, "AMPLITUDES", np.array([0.2, 0.5]) * st.g)
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
    assert {path.suffix for path in (folder / "figures").iterdir()} == {".png", ".svg"}
    assert len(list((folder / "figures").iterdir())) == 2 * summary["figures"]
    assert {path.name for path in (folder / "tables").iterdir()} == {"cases.csv", "domains.csv", "statements.csv"}
    assert len(pandas.read_csv(folder / "tables" / "cases.csv")) == 2 * 2 * 4
    assert len(list((folder / "data").glob("*/domain.nc"))) == 2 * (4 + 1 + 3 + len(GRIDS.variants))
    assert not list((folder / "data").glob("*/progress.sqlite*"))


def test_every_sentence_has_a_verdict(made):
    folder, summary, _ = made
    table = pandas.read_csv(folder / "tables" / "statements.csv")
    assert set(table["verdict"]) <= {HOLDS, CHOICES, FAILS}
    assert len(table) == summary["statements"] == sum(summary["verdicts"].values()) >= 20
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
    for words in ("holds", "tan φ = 0.70", "a sin 2πft from rest", "What was chosen"):
        assert words in page


def test_finished_pieces_are_not_computed_again(made, monkeypatch):
    folder, _, _ = made
    table = pandas.read_csv(folder / "tables" / "statements.csv")

    def never(*_, **__):
        raise AssertionError("computed again")

    monkeypatch.setattr(paper_study, "collapse_domain", never)
    monkeypatch.setattr(paper_study, "simulate", never)
    again = statements(run_study(folder, True, 2, grids=GRIDS))
    assert [row.ours for row in again] == table["ours"].tolist()


def test_a_piece_that_is_missing_is_computed_alone(made, monkeypatch):
    folder, _, _ = made
    piece = folder / "data" / paper_study.slug("domain", "paper-monolithic", BEAM, "circular") / "domain.nc"
    before = Domain.load(piece)
    piece.unlink()
    asked, real = [], paper_study.collapse_domain

    def counted(*args, **kwargs):
        asked.append(kwargs["out"].name)
        return real(*args, **kwargs)

    monkeypatch.setattr(paper_study, "collapse_domain", counted)
    run_study(folder, True, 1, grids=GRIDS)
    assert asked == [piece.parent.name]
    np.testing.assert_array_equal(Domain.load(piece).verdicts, before.verdicts)


def test_another_study_in_the_folder_is_refused(made):
    folder, _, _ = made
    with pytest.raises(st.InputError, match="another study"):
        build(folder, True, 1, dataclasses.replace(GRIDS, tail=1.0))


def test_an_interrupt_says_what_is_kept(tmp_path, monkeypatch, capsys):
    def stopped(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(paper_study, "_histories", stopped)
    assert call(["reproduce", "--quick", "--out", str(tmp_path)]) == 130
    assert "the same command goes on from there" in capsys.readouterr().err


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
