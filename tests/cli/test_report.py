"""``stylobate report``: any results as one page, escaped, whole or not at all; and what the commands leave for it."""

import json
import re
import shutil
from html.parser import HTMLParser

import numpy as np
import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate.column.files import write_column
from stylobate.motion import write_csv
from stylobate.own_files import OwnFiles
from stylobate.plots import style
from stylobate.report import pdf, pictures
from stylobate.report.case import write_report
from stylobate.results import Kind, read_results

EVIL = '<script>alert("x")</script> & <b onclick=1>'
SINE = ("--harmonic", "2Hz,0.3g,0.5s")


class Page(HTMLParser):
    """Elements of a page, their attributes, and all of its text."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.attributes, self.text = set(), [], ""
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.add(tag)
        self.attributes += attrs

    def handle_data(self, data):
        self.text += data


@pytest.fixture(scope="module", autouse=True)
def coarse():
    """Pictures of few points, which are written sooner."""
    with pytest.MonkeyPatch.context() as patch:
        for module in (style, pictures):
            patch.setattr(module, "DOTS_PER_INCH", 30)
        yield


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder of results of every kind, of a column and records with names that would be script."""
    place = tmp_path_factory.mktemp("report")
    joint = st.Joint(5e10, 2.5e10)
    column = st.Column.tapered(
        height=2.0, bottom_width=0.5, top_width=0.4, drums=2, density=2500.0, joint=joint, section="circular", name=EVIL
    )
    write_column(column, place / "column.toml")
    write_column(column.replace(drums=column.drums[:1], joints=column.joints[:1]), place / "block.toml")
    records = place / "records"
    records.mkdir()
    time = np.arange(40) * 0.02
    for k, name in enumerate(("<img src=x onerror=alert(1)>", "plain")):
        motion = st.Motion(0.02, 3.0 * np.sin((6.0 + k) * time), name=EVIL)
        write_csv(motion, records / f"{name}.csv")
    (place / "study.toml").write_text(
        'column = "block.toml"\nmodel = "housner"\n[motions]\nfiles = ["records/*.csv"]\n'
    )
    rng = np.random.default_rng(5)
    lines = ["record,im,collapsed"]
    for k in range(12):
        capacity = rng.normal(-0.7, 0.4)
        lines += [f"{EVIL.replace(',', '')}{k},{x:.4f},{int(np.log(x) > capacity)}" for x in np.geomspace(0.1, 2.0, 8)]
    (place / "runs.csv").write_text("\n".join(lines) + "\n")
    hazard = ["im_m_s,annual_rate", *(f"{x:.5g},{1e-3 * x**-2:.5g}" for x in np.geomspace(0.02, 3.0, 12))]
    (place / "hazard.csv").write_text("\n".join(hazard) + "\n")
    portal = (
        '[[block]]\nname = "a <b>"\nvertices = [[0, 0], [1, 0], [1, 1], [0, 1]]\n'
        "[joint]\nnormal_stiffness = 1e9\nshear_stiffness = 5e8\n"
    )
    (place / "blocks.toml").write_text(f"name = 'blocks {EVIL}'\ndensity = 2500.0\n{portal}")
    grid = ("--from", "0.2g", "--to", "0.6g", "--step", "0.2g")
    stone, block = place / "column.toml", (place / "block.toml", "--model", "housner")
    cells = ("--frequencies", "1:2:2", "--amplitudes", "0.2g:0.8g:2", "--duration", "1s")
    for name, *arguments in (
        ("run", "run", stone, *SINE, "--replicates", "3"),
        ("assembly", "run", place / "blocks.toml", *SINE),
        ("runs", "run", *block, "--motion", records),
        ("critical", "critical", *block, "--harmonic", "1Hz,?g,1s", *grid),
        ("critical over records", "critical", *block, "--motion", records, *grid),
        ("domain", "domain", *block, *cells),
        ("probability", "domain", *block, *cells, "--replicates", "2"),
        ("statics", "pushover", stone),
        ("statics", "limit", stone),
        ("compare", "compare", place / "block.toml", "--models", "housner,dem2d", *SINE),
        ("suite", "suite", *block, records),
        ("ida", "ida", *block, records, "--runs", "6"),
        ("fragility", "fragility", place / "runs.csv", "--im", "pgv"),
        ("risk", "risk", place / "runs.csv", "--im", "pgv", "--hazard", place / "hazard.csv"),
        ("survival", "survival", place / "runs.csv", "--im", "pgv", "--age", "2400y", "--hazard", place / "hazard.csv"),
        ("study", "study", "run", place / "study.toml"),
    ):
        out = place / f"out {name} <i>"
        assert call([*map(str, arguments), "--out", str(out), "--json"]) == 0, name
    return place


def folders(place):
    return sorted(place.glob("out *"))


def test_every_kind_is_told_from_its_files(place):
    kinds = {one.folder.name[4:-4]: one.kind for folder in folders(place) for one in read_results([folder])}
    expected = {name: Kind(name) for name in kinds if name in {kind.value for kind in Kind}}
    expected |= {"assembly": Kind.RUN, "critical over records": Kind.CRITICAL, "statics": Kind.PUSHOVER}
    assert kinds == expected
    assert {one.kind for one in read_results([place / "out statics <i>"])} == {Kind.PUSHOVER, Kind.LIMIT}
    for folder in folders(place):
        for one in read_results([folder]):
            assert one.asked is not None
            assert str(folder) in one.asked.command
            assert all(fact.unchanged for fact in one.files), [fact for fact in one.files if not fact.unchanged]


def test_a_command_lists_every_file_that_it_writes(place):
    for folder in folders(place):
        own = OwnFiles(folder)
        others = [
            path.name for path in folder.iterdir() if path.is_file() and path.name[0] != "." and not own.holds(path)
        ]
        assert not {one for one in others if not one.startswith("runs.sqlite")}, folder  # the ledger is kept by itself


@pytest.fixture(scope="module")
def page(place):
    (file,) = write_report(folders(place), place / "report.html")
    return file.read_text(encoding="utf-8")


def test_names_of_strangers_are_text(page):
    found = Page(page)
    assert not found.tags & {"script", "iframe", "object", "embed", "link", "form", "b", "i", "svg"}
    assert all(src.startswith("data:image/png;base64,") for name, src in found.attributes if name == "src")
    assert not [name for name, _ in found.attributes if name.startswith("on")]
    assert not re.search(r"https?://", page)
    for name in (EVIL, "<img src=x onerror=alert(1)>", "a <b>", "out run <i>"):
        assert name in found.text
    assert "default-src 'none'" in page


def test_what_an_engineer_signs_is_there(page, place):
    text = " ".join(Page(page).text.replace("\N{NO-BREAK SPACE}", " ").split())
    run = json.loads((place / "out run <i>" / "run.json").read_text())
    for words in (
        "stylobate run", "--replicates 3", "Of 3 columns like this one", "with 95 % confidence", "no statement about other",
        "What the model assumes, and where it ends", "It ends here:", "Energy balance", "Sources to cite",
        "Capacity spectrum check", "Nonlinear kinematic analysis", "Prepared by", "as written", "seed",
        st.__version__, "peak acceleration [g]", "static acceleration that opens the first joint", "Cundall",
    ):  # fmt: skip
        assert words in text, words
    assert run["outcome"].replace("_", " ") in text
    opens = read_results([place / "out run <i>"])[0].response.column.uplift_acceleration / st.g
    assert f"{opens:.3g} g (joint 1)" in text


def test_a_verdict_says_when_columns_like_it_do_otherwise():
    from stylobate.report.certainty import certainty_sentence

    known = {"collapsed": 4, "stands": 1, "undecided": 0, "failed": 1, "confidence": 0.95}
    found = {"certainty": known, "collapse_interval_low": 0.3, "collapse_interval_high": 0.99}
    said = certainty_sentence(found | {"collapsed": False})
    assert "Of 5 columns like this one, 4 collapse" in said
    assert "between 30 % and 99 %" in said
    assert "1 more could not be computed" in said
    assert "take the share, not the single run" in said
    assert "take the share" not in certainty_sentence(found | {"collapsed": True})
    assert "was not computed" in certainty_sentence({})


def test_what_was_changed_is_said(place, tmp_path):
    folder = shutil.copytree(place / "out run <i>", tmp_path / "copy")
    table = folder / "replicates.csv"
    table.write_text(table.read_text() + "\n")
    (file,) = write_report([folder], tmp_path / "r.html", title="mine")
    text = Page(file.read_text()).text
    assert "Changed by somebody since stylobate wrote it: replicates.csv" in text
    assert "mine" in text


@pytest.mark.parametrize(
    ("arrange", "why"),
    [
        (lambda d: d / "none", "there is no folder"),
        (lambda d: (d / "empty").mkdir() or d / "empty", "is empty"),
        (lambda d: (d / "notes.txt").write_text("x") and d, "holds no result of stylobate"),
        (lambda d: (d / "notes.txt").write_text("x") and d / "notes.txt", "is a file"),
        (lambda d: (d / "limit.json").write_text("{") and d, "no JSON"),
        (lambda d: (d / "limit.json").write_text('{"a": 1}') and d, "not what 'stylobate limit'"),
        (lambda d: (d / "asked-limit.json").write_text('{"form": 99}') and d, "is of form 99"),
        (lambda d: (d / "critical.json").write_text('{"runs": 3, "first_collapse_g": "many"}') and d, "does not hold"),
    ],
)
def test_bad_folders_are_one_sentence(place, tmp_path, capsys, arrange, why):
    if "form 99" in why:
        shutil.copy(place / "out statics <i>" / "limit.json", tmp_path)
    given = arrange(tmp_path)
    out = tmp_path / "report.html"
    assert call(["report", str(given), "--out", str(out)]) == 2
    err = capsys.readouterr().err
    assert why in err
    assert err.count("\n") == 1
    assert not out.exists()


def test_a_later_format_and_a_bad_place(place, tmp_path, capsys):
    folder = tmp_path / "later"
    folder.mkdir()
    content = (place / "out run <i>" / "response.nc").read_bytes()
    (folder / "response.nc").write_bytes(
        re.sub(rb"stylobate result 0002 sha256", b"stylobate result 0003 sha256", content)
    )
    (tmp_path / "mine.html").write_text("mine")
    for arguments, why in (
        ((folder, "--out", tmp_path / "r.html"), "is of format 3"),
        ((place / "out limit <i>", "--out", tmp_path / "no" / "r.html"), "there is no folder"),
        ((place / "out statics <i>", "--out", tmp_path / "mine.html"), "was not written by stylobate"),
        ((place / "out statics <i>", "--out", tmp_path / "mine.html" / "r.html"), "cannot be written to"),
        ((place / "out statics <i>", "--out", tmp_path / "r.pdf"), "such as report.html"),
        ((place / "out statics <i>", "--out", folder), "such as report.html"),
    ):
        assert call(["report", *map(str, arguments)]) == 2
        err = capsys.readouterr().err
        assert why in err
        assert err.count("\n") == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == ["later", "mine.html"]
    assert (tmp_path / "mine.html").read_text() == "mine"


def test_without_a_chromium_nothing_is_written(place, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(pdf, "find_browser", lambda: None)
    assert call(["report", str(place / "out statics <i>"), "--out", str(tmp_path / "r.html"), "--pdf"]) == 1
    assert "no Chromium is found" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(pdf.find_browser() is None, reason="no Chromium is found on this machine")
def test_pdf(place, tmp_path, capsys):
    assert call(["report", str(place / "out statics <i>"), "--out", str(tmp_path / "r.html"), "--pdf", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert [one["kind"] for one in told["results"]] == ["limit", "pushover"]
    assert told["files"] == [str(tmp_path / "r.html"), str(tmp_path / "r.pdf")]
    printed = (tmp_path / "r.pdf").read_bytes()
    assert printed.startswith(b"%PDF-")
    assert len(re.findall(rb"/Type\s*/Page\b", printed)) >= 3
    assert b"/JavaScript" not in printed


def test_what_opens_first_is_told_with_its_direction():
    """A slab opens across its thin side, however it is shaken; its acceleration is that of the thin block, g d / 2 z."""
    from stylobate.report.structure import what_opens

    slab = st.Column.of_drums([st.Drum(2.0, 1.0, 1.0, 2500.0, depth=0.5)], st.Joint(5e10, 2.5e10))
    along_x, words = what_opens(slab)
    assert along_x == pytest.approx(0.5 * slab.gravity)
    assert words == "0.5 g (joint 1)"
    least, words = what_opens(slab, in_space=True)
    assert least == pytest.approx(0.25 * slab.gravity, rel=1e-6)
    assert re.fullmatch(r"0\.25 g \(joint 1; pushed towards (90|270)°, the weakest of all directions\)", words)
    round_ = st.Column.of_drums([st.Drum(2.0, 1.0, 1.0, 2500.0, section="circular")], st.Joint(5e10, 2.5e10))
    assert what_opens(round_, in_space=True)[1].endswith("; in every direction)")
    found = st.AsFound([st.FoundDrum(1, offset=0.1)])
    assert what_opens(slab.replace(as_found=found))[1].endswith("; the weaker side along x)")
    two = st.Column.of_drums(slab.drums * 2, slab.joints[0])
    aside = st.AsFound([st.FoundDrum(2, offset=0.1, offset_azimuth=90.0)])  # its weight is 50 mm off the middle, 2 m up
    least, words = what_opens(two.replace(as_found=aside))
    assert least == pytest.approx(0.1 * slab.gravity, rel=1e-6)
    assert words == "0.1 g (joint 1; pushed towards 90°, the weakest of all directions)"


def test_a_monolith_has_no_drum_that_could_be_shifted():
    from stylobate.outcome import Outcome

    for one in Outcome:
        assert "drum" not in one.sentence_of(1)
        assert one.sentence_of(2) == one.sentence
    block = st.simulate(st.preset("paper-monolithic"), st.harmonic(1.0, 0.5, 0.1), st.DistinctElement2D())
    assert block.sentence == "The block stood still: its joint did not open."
