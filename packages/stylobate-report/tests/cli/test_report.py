"""``stylobate report``: any results as one page, escaped, whole or not at all; and what the commands leave for it."""

import json
import re
import shutil
from html.parser import HTMLParser
from types import SimpleNamespace

import numpy as np
import pytest

import stylobate as st
from stylobate.atomic import OwnFiles
from stylobate.campaign.ledger import APPLICATION
from stylobate.cli.main import call
from stylobate.column.files import write_column
from stylobate.motion import write_csv
from stylobate.plots import style
from stylobate.results import Kind, read_results
from stylobate_report import page as pdf
from stylobate_report import pictures
from stylobate_report.case import write_report
from stylobate_report.language import LANGUAGES, Language, catalogue_of, file_of
from stylobate_report.project import Project

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
    joint = st.Joint(5e10, 2.5e10, 35.0)
    column = st.Column.tapered(
        height=2.0, bottom_width=0.5, top_width=0.4, drums=2, density=2500.0, joint=joint, section="circular", name=EVIL
    )
    write_column(column, place / "column.toml")
    write_column(column.replace(drums=column.drums[:1], joints=column.joints[:1]), place / "block.toml")
    tie = st.Tie(at=(0.3, 0.0), diameter=0.02, material="titanium")
    write_column(column.replace(links=[tie]), place / "<i>ties.toml")
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
        "[joint]\nnormal_stiffness = 1e9\nshear_stiffness = 5e8\nfriction_angle = 35.0\n"
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
        ("modes", "modes", stone, "--measured", "17Hz±3%,torsion 30Hz±6%", "--ground", "rigid"),
        ("compare", "compare", place / "block.toml", "--models", "housner,dem2d", *SINE),
        (
            "states",
            "states",
            records,
            "--as-built",
            place / "column.toml",
            "--with",
            place / "<i>ties.toml",
        ),
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
    kinds = {result.folder.name[4:-4]: result.kind for folder in folders(place) for result in read_results([folder])}
    expected = {name: Kind(name) for name in kinds if name in {kind.value for kind in Kind}}
    expected |= {"assembly": Kind.RUN, "critical over records": Kind.CRITICAL, "statics": Kind.PUSHOVER}
    assert kinds == expected
    assert {result.kind for result in read_results([place / "out statics <i>"])} == {Kind.PUSHOVER, Kind.LIMIT}
    for folder in folders(place):
        for result in read_results([folder]):
            assert result.request is not None
            assert str(folder) in result.request.command
            assert all(fact.unchanged for fact in result.files), [fact for fact in result.files if not fact.unchanged]


def test_a_command_lists_every_file_that_it_writes(place):
    for folder in folders(place):
        own = OwnFiles(folder)
        others = [
            path.name for path in folder.iterdir() if path.is_file() and path.name[0] != "." and not own.holds(path)
        ]
        assert not {name for name in others if not name.startswith("runs.sqlite")}, (
            folder
        )  # the ledger is kept by itself


@pytest.fixture(scope="module")
def page(place):
    (file,) = write_report(folders(place), place / "report.html")
    return file.read_text(encoding="utf-8")


def test_names_of_strangers_are_text(page):
    document = Page(page)
    assert not document.tags & {"script", "iframe", "object", "embed", "link", "form", "b", "i", "svg"}
    assert all(src.startswith("data:image/png;base64,") for name, src in document.attributes if name == "src")
    assert not [name for name, _ in document.attributes if name.startswith("on")]
    assert not re.search(r"https?://", page)
    for name in (EVIL, "<img src=x onerror=alert(1)>", "a <b>", "out run <i>"):
        assert name in document.text
    assert "default-src 'none'" in page


@pytest.mark.parametrize("tag", LANGUAGES)
def test_every_kind_of_result_in_another_language_has_no_english_of_the_table(place, tmp_path, tag):
    """No whole sentence, and no piece of four words between placeholders; what is cited and typed is left out."""
    project = Project(client="a", site="b", engineer="c", language=tag)
    (file,) = write_report(folders(place), tmp_path / "r.html", project=project)
    content = re.sub(r'<p class="code">.*?</p>', "", file.read_text(encoding="utf-8"))
    text = " ".join(Page(content).text.replace("\N{NO-BREAK SPACE}", " ").split())
    pieces = {
        piece.strip(" .:;,()") for text in catalogue_of(file_of(tag)) for piece in re.split(r"\{[^{}]*\}|\n", text)
    }
    long = [piece for piece in pieces if len(re.findall("[A-Za-z]{2,}", piece)) >= 4]
    assert len(long) > 300
    assert [piece for piece in long if piece in text] == []
    assert catalogue_of(file_of(tag))["Sources to cite"] in text


def test_the_first_page_tells_how_sure_each_run_is(page):
    front = Page(page[: page.index("</nav>")]).text
    assert "Of 3 columns like this one" in front
    assert "no statement about other" not in front


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


def test_the_first_page_has_the_shares_and_each_doubt_once():
    """Of several results: what a run says of columns like it, and notes with the results that they hold for."""
    from stylobate_report import case
    from stylobate_report.page import Note, Section
    from stylobate_report.record import warnings_of

    result = SimpleNamespace(request=None, files=())
    plane, other = "the plane leaves out what shakes it across.", "it is wide."
    run = Section("Verdict", [Note(["It stands.", "1 of 15 falls.", "Scope."], "verdict", first=2)])
    run = Section("Verdict", [*run.items, *warnings_of(result, [plane])])
    several = Section(
        "Result", [Note(["It falls at 1 g.", "Scope."], "verdict bad"), *warnings_of(result, [plane, other])]
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(case, "_title", lambda result, language: "")
        patch.setattr(case, "_sections_of", lambda result, all_: [result])
        cases = [case._case(result, k, {}, [], Language()) for k, result in enumerate((run, several), start=1)]
    assert [entry["verdict"] for entry in cases] == ["It stands. 1 of 15 falls.", "It falls at 1 g."]
    (note,) = case._notes([entry["notes"] for entry in cases])
    assert note.texts == [f"On all of them: {plane}", f"On 2: {other}"]


def test_a_verdict_says_when_columns_like_it_do_otherwise():
    from stylobate_report.certainty import certainty_sentence

    known = {"collapsed": 4, "stands": 1, "undecided": 0, "failed": 1, "confidence": 0.95}
    summary = {"certainty": known, "collapse_interval_low": 0.3, "collapse_interval_high": 0.99}
    sentence = certainty_sentence(summary | {"collapsed": False})
    assert "Of 5 columns like this one, 4 collapse" in sentence
    assert "the probability of collapse is 30 to 99 %, with 95 % confidence" in sentence
    assert "1 more could not be computed" in sentence
    assert "4 of 6, this one and 5 like it, collapse (95 %: 30 to 90 %); 2 stand." in sentence
    assert "like it" not in certainty_sentence(summary | {"collapsed": True})
    earlier = "13 of 15 columns like it stand though this one falls: take the share, not the single run."
    known = known | {"collapsed": 2, "stands": 13, "failed": 0, "beside": earlier}
    sentence = certainty_sentence(summary | {"collapsed": True, "certainty": known})
    assert "single run" not in sentence
    assert "3 of 16, this one and 15 like it, collapse" in sentence
    assert "was not computed" in certainty_sentence({})


def test_what_was_changed_is_said(place, tmp_path):
    folder = shutil.copytree(place / "out run <i>", tmp_path / "copy")
    table = folder / "replicates.csv"
    table.write_text(table.read_text() + "\n")
    (file,) = write_report([folder], tmp_path / "r.html", title="mine")
    text = Page(file.read_text()).text
    assert "Changed by somebody since stylobate wrote it: replicates.csv" in text
    assert "mine" in text


def test_a_survival_is_told_with_its_interval(place, tmp_path):
    (result,) = read_results([place / "out survival <i>"])
    (hazard,) = result.summary["hazards"]
    ends = [hazard[f"survival_probability{end}"] for end in ("", "_low", "_high")]
    (file,) = write_report([result], tmp_path / "r.html")
    assert "{:.2g} ({:.2g}–{:.2g}, 95 %)".format(*ends) in " ".join(Page(file.read_text(encoding="utf-8")).text.split())


def test_states_have_a_page_of_their_own(place, tmp_path):
    (result,) = read_results([place / "out states <i>"])  # not as a study, whose plan lies there as well
    assert result.kind is Kind.STATES
    assert [structure.digest for structure in result.structures] == [
        result.request.structures[k]["digest"] for k in range(2)
    ]
    (file,) = write_report([result], tmp_path / "r.html")
    page = Page(file.read_text(encoding="utf-8"))
    text = " ".join(page.text.split())
    advice = "“<i>ties”: not shown to be stronger than “as built” against collapse, nor weaker"
    assert text.index(advice) < text.index("What was found") < text.index("The state “as built”")
    assert "no ground to adopt it for safety (it fares better in " in text
    assert "nothing is concluded from fewer than 10 records)" in text
    assert "Drums and joints are those of “as built”. What differs: 1 link instead of none." in text
    assert "states compared" in text
    assert "does not hold the command line" not in text
    assert "study" not in text.lower().split("sources to cite")[0]
    pictures = [value for name, value in page.attributes if name == "alt"]
    assert sum(caption.startswith("Elevation of") for caption in pictures) == 2
    assert sum("Difference of the share, pair by pair" in caption for caption in pictures) == 1  # no curve beside it


def test_states_of_a_version_that_counted_otherwise_are_refused(place, tmp_path, capsys):
    folder = shutil.copytree(place / "out states <i>", tmp_path / "copy")
    content = json.loads((folder / "states.json").read_text())
    content.pop("records")
    (folder / "states.json").write_text(json.dumps(content))
    assert call(["report", str(folder), "--out", str(tmp_path / "r.html")]) == 2
    assert (
        "not what 'stylobate states' of this version writes: it has no 'records'; run again" in capsys.readouterr().err
    )


def test_a_state_of_other_stones_is_listed_in_full():
    from stylobate_report.page import Rows
    from stylobate_report.structure import state_section

    joint = st.Joint(5e10, 2.5e10, 35.0)
    first = st.Column.of_drums([st.Drum(2.0, 1.0, 1.0, 2500.0)] * 2, joint, name="one")
    lean = first.replace(name="two", as_found=st.AsFound([st.FoundDrum(2, offset=0.05)]))
    text, _, table = state_section(lean, "as found", first, "as built").items
    assert text == "Drums and joints are those of “as built”. What differs: as found instead of as built."
    assert isinstance(table, Rows)
    wide = st.Column.of_drums([st.Drum(2.0, 1.2, 1.2, 2500.0)] * 2, joint, name="three")
    text, *rest = state_section(wide, "wide", first, "as built").items
    assert text == "Its drums or joints are not those of “as built”: all of it is listed."
    assert any(isinstance(item, Rows) and item.header[0] == "drum" for item in rest)


def test_a_study_sets_columns_side_by_side_over_the_same_cases():
    """What is undecided or failed for one column is not dropped from its share alone."""
    from types import SimpleNamespace

    from stylobate_report.others import _shares_of_study

    axes = {
        "models": [{"model": "m"}],
        "columns": [{"column": "a"}, {"column": "b"}],
        "motions": [{"record": f"record {k}"} for k in range(10)],
        "levels": [1.0],
        "measure": "pga",
    }
    verdicts = np.array(["collapsed"] * 7 + ["undecided"] * 2 + ["failed"] + ["collapsed"] * 7 + ["stands"] * 3)
    plan = SimpleNamespace(axes=axes, shape=(1, 2, 10, 1, 1))
    rows = _shares_of_study(SimpleNamespace(plan=plan, verdicts=verdicts))
    assert rows.body == [
        ["a", "m", "1", "9", "9", "7", "0", "2", "78 to 100 %", "45 to 100 %", "1"],
        ["b", "m", "1", "9", "9", "7", "2", "0", "78 %", "45 to 94 %", "0"],
    ]


def test_every_share_of_a_suite_has_its_interval_and_its_number():
    """Of the motions, over records; and of the columns like each, undecided ones counted both ways."""
    from types import SimpleNamespace

    from stylobate_report.others import _suite

    ends = ["collapsed"] * 4 + ["stands"] * 3 + ["undecided"]
    runs = [
        {"column": "a", "record": f"r{k // 2}", "motion": f"r{k // 2} at {k % 2}°", "verdict": end, "pga_g": 0.3}
        | {"collapse_probability": 0.4, "replicates": 6, "twins_collapsed": 2, "twins_stands": 2, "twins_undecided": 1,
           "twins_failed": 1, "collapse_interval_low": 0.12, "collapse_interval_high": 0.88}
        for k, end in enumerate(ends)
    ]  # fmt: skip
    (sentence, look), items = _suite(SimpleNamespace(summary={"runs": runs}, pictures={}, tables={}))
    assert sentence == (
        "a collapses in 4 of 8 runs, and 1 more may, which are undecided: 50 to 63 % (95 % interval over 4 records: "
        "15 to 91 %)."
    )
    assert "bad" in look
    assert items[0].body == [["a", "8", "4", "4", "3", "1", "50 to 63 %", "15 to 91 %", "0"]]
    place = items[1].header.index("those like it that collapse")
    assert items[1].body[0][place] == "40 to 60 % of 5 (12 to 88 %); 1 undecided, 1 failed"
    assert items[1].body[1][items[1].header.index("motion")] == "r0 at 1°"


def test_an_undecided_run_of_a_model_is_told_beside_others(place):
    from stylobate_report.others import sections_of

    (result,) = read_results([place / "out compare <i>"])
    result.table["decided"] = [True, False]
    text = sections_of(result, set())[0].items[0].texts[0]
    assert text.count(", undecided") == 1


DAMAGED = '{"runs": 3, "sentence": "It falls.", "lowest_collapse_g": 0.3, "as_recorded": "many"}'

#: A ledger of an earlier version as far as its mark.
OLD = bytes(68) + APPLICATION.to_bytes(4) + bytes(28)


@pytest.mark.parametrize(
    ("arrange", "why"),
    [
        (lambda d: d / "none", "there is no folder"),
        (lambda d: (d / "empty").mkdir() or d / "empty", "is empty"),
        (lambda d: (d / "notes.txt").write_text("x") and d, "holds no result of stylobate"),
        (lambda d: (d / "runs.sqlite").write_text("x") and d, "holds runs of a command that has written no result"),
        (lambda d: (d / "progress.sqlite").write_bytes(OLD) and d, "unfinished runs of an earlier version"),
        (lambda d: (d / "notes.txt").write_text("x") and d / "notes.txt", "is a file"),
        (lambda d: (d / "limit.json").write_text("{") and d, "no JSON"),
        (lambda d: (d / "limit.json").write_text('{"a": 1}') and d, "not what 'stylobate limit'"),
        (lambda d: (d / "asked-limit.json").write_text('{"form": 99}') and d, "is of form 99"),
        (lambda d: (d / "critical.json").write_text(DAMAGED) and d, "does not hold"),
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


def test_a_folder_that_is_named_twice_is_read_once(place, monkeypatch):
    monkeypatch.chdir(place)
    name = "out statics <i>"
    assert len(read_results([name, place / name, f"./{name}"])) == len(read_results([name])) > 0


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
    answer = json.loads(capsys.readouterr().out)
    assert [result["kind"] for result in answer["results"]] == ["limit", "pushover"]
    assert answer["files"] == [str(tmp_path / "r.html"), str(tmp_path / "r.pdf")]
    printed = (tmp_path / "r.pdf").read_bytes()
    assert printed.startswith(b"%PDF-")
    assert len(re.findall(rb"/Type\s*/Page\b", printed)) >= 3
    assert b"/JavaScript" not in printed


def test_what_opens_first_is_told_with_its_direction():
    """A slab opens across its thin side, however it is shaken; its acceleration is that of the thin block, g d / 2 z."""
    from stylobate_report.structure import what_opens

    slab = st.Column.of_drums([st.Drum(2.0, 1.0, 1.0, 2500.0, depth=0.5)], st.Joint(5e10, 2.5e10, 35.0))
    along_x, words = what_opens(slab)
    assert along_x == pytest.approx(0.5 * slab.gravity)
    assert words == "0.5 g (joint 1)"
    least, words = what_opens(slab, in_space=True)
    assert least == pytest.approx(0.25 * slab.gravity, rel=1e-6)
    assert re.fullmatch(r"0\.25 g \(joint 1; pushed towards azimuth (90|270)°, the weakest of all directions\)", words)
    round_ = st.Column.of_drums([st.Drum(2.0, 1.0, 1.0, 2500.0, section="circular")], st.Joint(5e10, 2.5e10, 35.0))
    assert what_opens(round_, in_space=True)[1].endswith("; in every direction)")
    as_found = st.AsFound([st.FoundDrum(1, offset=0.1)])
    assert what_opens(slab.replace(as_found=as_found))[1].endswith("; the weaker side along x)")
    two = st.Column.of_drums(slab.drums * 2, slab.joints[0])
    aside = st.AsFound([st.FoundDrum(2, offset=0.1, offset_azimuth=90.0)])  # its weight is 50 mm off the middle, 2 m up
    least, words = what_opens(two.replace(as_found=aside))
    assert least == pytest.approx(0.1 * slab.gravity, rel=1e-6)
    assert words == "0.1 g (joint 1; pushed towards azimuth 90°, the weakest of all directions)"


def test_a_monolith_has_no_drum_that_could_be_shifted():
    from stylobate.outcome import Outcome

    for outcome in Outcome:
        assert "drum" not in outcome.sentence_of(1)
        assert outcome.sentence_of(2) == outcome.sentence
    block = st.simulate(st.preset("paper-monolithic"), st.harmonic(1.0, 0.5, 0.1), st.DistinctElement2D())
    assert block.sentence == "The block stood still: its joint did not open."


def test_the_worst_direction_and_what_is_undecided_stand_in_the_answer(tmp_path):
    """As the command says it: by how much it is scaled, from where, how many directions are open, and what decides them."""
    time = 0.02 * np.arange(60)
    record = write_csv(st.Motion(0.02, 4.0 * np.sin(3.0 * time), 3.0 * np.cos(3.0 * time)), tmp_path / "r.csv")
    turned = tmp_path / "turned"
    suite = ("suite", "paper-monolithic", str(record), "--model", "housner", "--azimuths", "0:270:4", "--scale", "2")
    assert call([*suite, "--out", str(turned)]) == 0
    sentence = json.loads((turned / "suite.json").read_text())["sentence"]
    assert call(["report", str(turned), "--out", str(tmp_path / "r.html")]) == 0
    page = (tmp_path / "r.html").read_text(encoding="utf-8").replace("\u00a0", " ")
    assert sentence in page
    assert "The motions are multiplied by 2. Most harm" in page
    project = tmp_path / "project.toml"
    project.write_text('client = "c"\nsite = "s"\nengineer = "e"\nlanguage = "it"\n')
    assert call(["report", str(turned), "--out", str(tmp_path / "it.html"), "--project", str(project)]) == 0
    page = (tmp_path / "it.html").read_text(encoding="utf-8")
    assert sentence not in page
    assert re.search("Danno maggiore: moto ruotato a|Nessuna direzione la fa crollare", page)
