"""``stylobate report --project``: the page that is signed says what the cases say, and refuses what it cannot sign."""

import html
import re

import pytest

from stylobate.cli.main import call

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
    assert "SHA-256" in front
    assert "Checked by, date" not in text


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
    said = capsys.readouterr().err
    print(said)
    assert why in said
    assert "Traceback" not in said
    assert not out.exists()
