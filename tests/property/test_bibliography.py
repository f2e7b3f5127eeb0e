"""The bibliography against what is cited: every key and every author and year has an entry, and every entry a use."""

import re
from pathlib import Path

import pytest

from stylobate.bibliography import bibliography
from stylobate.bibliography.citation import FILE
from stylobate.models.registry import MODELS, model_class
from stylobate.motion import REGIONS, parse_pulse, stochastic_motion
from stylobate.motion.specs import PULSES

ROOT = Path(__file__).parents[2]
TEXTS = {
    path: path.read_text(encoding="utf-8")
    for folder, ending in (
        ("src", "*.py"),
        ("packages", "*.py"),
        ("docs", "*.md"),
        ("tests", "*.py"),
        ("gallery", "*.py"),
    )
    for path in sorted((ROOT / folder).rglob(ending))
    if "_build" not in path.parts and path != Path(__file__)
}

#: "Yim, Chopra and Penzien (1980)", "Ancheta et al. (2014)", "Wilson 1927"; the year may stand in parentheses.
CITED = re.compile(
    r"(?P<first>[A-ZČŠ][\w-]+)(?:, [A-Z]\w+)*(?: and [A-Z]\w+| et al\.)?,? \(?(?P<year>(?:18|19|20)\d\d)\b"
)

#: An item of the list of references at the end of a page.
LISTED = re.compile(
    r"^- (?P<first>[^,(]+),?[^(]*\((?P<year>\d{4})\)\. \*?(?P<title>.+?)(?:\. \*|\*, |\.$)", re.MULTILINE
)


def family(reference):
    return reference.fields.get("shorttitle", reference.authors[0].split(",")[0])


def test_every_entry_has_author_title_and_year():
    for one in bibliography().values():
        assert one.authors
        assert all(one.authors)
        assert one.fields["title"]
        assert one.year or "not verified" in one.fields["note"], one.key


def test_the_whole_file_is_read():
    # What is printed as BibTeX is the entry as it stands in the file; nothing of the file is passed over.
    text = FILE.read_text(encoding="utf-8")
    assert all(one.bibtex in text for one in bibliography().values())
    left = text
    for one in bibliography().values():
        left = left.replace(one.bibtex, "")
    assert all(line.startswith("%") for line in left.split("\n") if line)


def test_keys_in_the_code_are_in_the_bibliography():
    used = {key for name in MODELS for key in model_class(name).references}
    used |= {key for name in REGIONS for key in stochastic_motion(6.0, 2e4, name).metadata["references"]}
    used |= {key for kind in PULSES for key in parse_pulse(f"{kind},1Hz,0.1g").metadata["references"]}
    code = "".join(text for path, text in TEXTS.items() if "src" in path.parts)
    used |= set(re.findall(r'"([a-z]+(?:18|19|20)\d\d)"', code))
    assert used <= set(bibliography())
    assert {"baraldi", "housner1963", "wilson1927", "feng2004", "campbell2003", "ricker1943"} <= used


def test_sources_of_docstrings_are_in_the_bibliography():
    known = {(family(one), one.year) for one in bibliography().values()}
    found = set()
    for path, text in TEXTS.items():
        if "src" in path.parts:
            for section in re.findall(r"References\n +-{10}\n(.*?)\"\"\"", text, re.DOTALL):
                found |= {(one["first"], int(one["year"])) for one in CITED.finditer(" ".join(section.split()))}
    assert len(found) > 15
    assert found <= known


def test_lists_of_the_pages_agree_with_the_bibliography():
    titles = {(family(one), one.year, one.fields["title"]) for one in bibliography().values()}
    pages = [text for path, text in TEXTS.items() if "docs" in path.parts]
    listed = {(one["first"].strip(), int(one["year"]), one["title"]) for text in pages for one in LISTED.finditer(text)}
    assert listed
    assert listed <= titles


@pytest.mark.parametrize("key", bibliography())
def test_every_entry_is_cited(key):
    one, everything = bibliography()[key], "\n".join(TEXTS.values())
    name, year = re.escape(family(one)), one.year or ""
    near = rf"{name}[^\n]{{0,60}}{year}" if str(year) not in family(one) else name
    assert re.search(rf'"{key}"', everything) or re.search(near, everything), f"nothing cites {key}"
