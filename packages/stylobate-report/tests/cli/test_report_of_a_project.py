"""``stylobate report --project``: the page that is signed says what the cases say, and refuses what it cannot sign."""

import hashlib
import html
import re

import pytest

from stylobate.cli.main import call
from stylobate.verdicts.critical import sentence
from stylobate.verdicts.population import set_against
from stylobate_report.language import catalogue_of, file_of, language_of

GOOD = """client = "Ministry <b>"
site = "Temple, column 5"
engineer = "A. Engineer"
date = 2026-03-01
assumptions = ["The foundation does not settle."]
"""


@pytest.fixture(scope="module")
def statics(tmp_path_factory):
    """Limit analysis of a column, the cheapest result."""
    place = tmp_path_factory.mktemp("project")
    assert call(["limit", "paper-monolithic", "--out", str(place / "limit")]) == 0
    return place


def test_the_page_repeats_the_answers_as_they_stand_in_the_cases(statics, tmp_path):
    (tmp_path / "p.toml").write_text(GOOD)
    out = tmp_path / "r.html"
    assert call(["report", str(statics / "limit"), "--project", str(tmp_path / "p.toml"), "--out", str(out)]) == 0
    text = html.unescape(re.sub("<[^>]+>", "\n", out.read_text()))
    front, case = text.split("Signature", 1)
    answer = front.split("answer\n")[1].split("Assumptions of this report")[0].strip().splitlines()[-1].strip()
    assert len(answer) > 20
    assert answer in case
    assert "Ministry <b>" in front
    assert "2026-03-01" in front
    assert "The foundation does not settle." in front
    assert "SHA-256 of the list of files" in front
    appendix = text[text.index("Appendix: the results in full") :]
    digests = [line for line in text.splitlines() if re.fullmatch("[0-9a-f]{64}", line)]
    (bound,) = (line for line in front.splitlines() if re.fullmatch("[0-9a-f]{64}", line))
    listed = re.findall(r"\n(limit\.\w+|asked-limit\.json)\n+([0-9a-f]{64})\n", appendix)
    assert len(listed) == len({name for name, _ in listed}) >= 2  # what is signed has one digest, of this list
    assert bound == hashlib.sha256("".join(f"{digest}  {name}\n" for name, digest in listed).encode()).hexdigest()
    assert digests.count(listed[0][1]) == 1
    assert "Checked by, date" not in text
    assert "<h1>Report: Temple, column 5</h1>" in out.read_text()  # its site, and no folder's name


def test_an_answer_of_the_plane_says_so_below_its_caution(tmp_path):
    """The caution stood on the third page, in three wordings, and an answer did not say what it was of."""
    (tmp_path / "round.toml").write_text(
        'name = "round"\nsection = "circular"\nmaterial = "marble"\n[[drum]]\nheight = 2.0\nbottom_width = 0.5\n'
        "top_width = 0.5\n"
    )
    (tmp_path / "p.toml").write_text(GOOD)
    shaking = ["--harmonic", "1Hz,0.1g,0.2s", "--across", "1Hz,0.1g,90deg", "--replicates", "0"]
    run = ["run", str(tmp_path / "round.toml"), "--model", "housner", *shaking, "--out", str(tmp_path / "run")]
    assert call(run) == 0
    out = tmp_path / "r.html"
    assert call(["report", str(tmp_path / "run"), "--project", str(tmp_path / "p.toml"), "--out", str(out)]) == 0
    front = out.read_text(encoding="utf-8").split("Appendix: the results in full")[0]
    assert front.count("Round columns, computed in the plane") == 1
    assert front.index("Round columns") < front.index("In the plane: ") < front.index("Assumptions of this report")


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (None, "p.toml"),
        ("client = 3\nsite = 'a'\nengineer = 'b'\n", "client"),
        (GOOD + "enginer = 'x'\n", "engineer"),
        (GOOD.replace("Temple, column 5", " "), "site is empty"),
        (GOOD.replace("The foundation does not settle.", ""), "assumptions is empty"),
        ("client = 'a'\n", "site"),
    ],
)
def test_a_file_that_cannot_be_signed_is_refused(statics, tmp_path, capsys, text, why):
    if text is not None:
        (tmp_path / "p.toml").write_text(text)
    out = tmp_path / "r.html"
    assert call(["report", str(statics / "limit"), "--project", str(tmp_path / "p.toml"), "--out", str(out)]) == 2
    message = capsys.readouterr().err
    print(message)
    assert why in message
    assert "Traceback" not in message
    assert not out.exists()


def test_a_report_in_a_language_of_a_file_beside_the_project(statics, tmp_path):
    """What the file translates is translated; the rest is English, and the page says so at its start."""
    assert call(["report", "--translation-template", str(tmp_path / "de.po")]) == 0
    text = (tmp_path / "de.po").read_text(encoding="utf-8").replace("Language: ", "Language: de")
    signature = 'msgid "Signature"\nmsgstr ""'
    text = text.replace(signature, signature[:-1] + 'Unterschrift"')
    (tmp_path / "de.po").write_text(text, encoding="utf-8")
    (tmp_path / "p.toml").write_text(f'{GOOD}language = "de.po"\n')
    out = tmp_path / "r.html"
    assert call(["report", str(statics / "limit"), "--project", str(tmp_path / "p.toml"), "--out", str(out)]) == 0
    page = out.read_text(encoding="utf-8")
    assert '<html lang="de">' in page
    assert "<h3>Unterschrift</h3>" in page
    start = page[: page.index("<h3>")]
    assert "Parts in English" in start
    assert "What was asked" in start


def test_a_template_needs_no_results_and_a_report_does(tmp_path, capsys):
    assert call(["report", "--out", str(tmp_path / "r.html")]) == 2
    assert "give the folders of the results" in capsys.readouterr().err
    (tmp_path / "mine.po").write_text("mine")
    assert call(["report", "--translation-template", str(tmp_path / "mine.po")]) == 2
    assert (tmp_path / "mine.po").read_text() == "mine"


def test_a_table_of_two_results_stands_once(statics, tmp_path):
    """The column and the model of a second result of the same column are those of the first one."""
    assert call(["pushover", "paper-monolithic", "--out", str(tmp_path / "pushed")]) == 0
    out = tmp_path / "r.html"
    assert call(["report", str(statics / "limit"), str(tmp_path / "pushed"), "--out", str(out)]) == 0
    page = out.read_text(encoding="utf-8")
    assert page.count("Drums and the joints under them") == 1
    assert page.count("As in case 1.") >= 2
    assert page.count("asked-limit.json") == 1


@pytest.mark.parametrize("language", ["it", "el"])
def test_what_is_said_of_undecided_runs_is_all_in_its_language(language):
    """A column that may have fallen below its first collapse, with columns like it and alone."""
    stretches = [("stands", 0.1, 0.2, 2), ("undecided", 0.3, 0.3, 1), ("collapsed", 0.4, 0.6, 3)]
    summary = {
        "amplitudes_g": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6], "runs": 6, "undecided": 1, "failed": 0, "replicates": 4,
        "lowest_collapse_g": 0.3, "lowest_collapse_factor": 0.75, "critical_g": 0.4, "open_below": 2,
        "alternation": [{"verdict": v, "from_g": a, "to_g": b, "runs": n} for v, a, b, n in stretches],
    }  # fmt: skip
    twins = {"undecided": 3, "failed": 0, "critical_16_g": 0.3, "critical_50_g": 0.4, "bounds": {}}
    run = {"collapsed": False, "decided": False, "outcome": "displaced"}
    sentences = [sentence(summary | {"certainty": certainty}) for certainty in (twins, None)]
    sentences.append(set_against(run, {"collapsed": 3, "stands": 0, "undecided": 0}, 0.95))
    spoken = language_of(language)
    for text in sentences:
        assert "collapse" in text
        assert re.findall(r"\b(?:the|of|and|is|are)\b", spoken.say(text)) == []
    assert not spoken.missing


@pytest.mark.parametrize("language", ["it", "el"])
def test_the_executive_page_is_all_in_its_language(statics, tmp_path, language):
    (tmp_path / "p.toml").write_text(f'{GOOD}language = "{language}"\n')
    out = tmp_path / "r.html"
    assert call(["report", str(statics / "limit"), "--project", str(tmp_path / "p.toml"), "--out", str(out)]) == 0
    page = html.unescape(out.read_text(encoding="utf-8"))
    catalogue = catalogue_of(file_of(language))
    for english in ("Signature", "Answers", "Limits: what is not covered", "Assumptions of this report", "Verdict"):
        assert f"<h3>{english}</h3>" not in page
    for english in ("Signature", "Answers", "Limits: what is not covered", "Sources of the results"):
        assert f"<h3>{catalogue[english]}</h3>" in page
    assert (
        "<h1>" + catalogue["Report: {names}"].format(names="Temple, column 5") + "</h1>" in page
    )  # its site is a name
    number = re.search(r"[\d.,]+ (?=volte il suo peso|φορές το βάρος)", page)
    assert number, page[:3000]
    assert re.fullmatch(r"\d,\d+ ", number[0])  # as the readers of the language write it
