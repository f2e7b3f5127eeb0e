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
    for entry in bibliography().values():
        assert entry.authors
        assert all(entry.authors)
        assert entry.fields["title"]
        assert entry.year or "not verified" in entry.fields["note"], entry.key


def test_the_whole_file_is_read():
    # What is printed as BibTeX is the entry as it stands in the file; nothing of the file is passed over.
    text = FILE.read_text(encoding="utf-8")
    assert all(entry.bibtex in text for entry in bibliography().values())
    rest = text
    for entry in bibliography().values():
        rest = rest.replace(entry.bibtex, "")
    assert all(line.startswith("%") for line in rest.split("\n") if line)


def test_keys_in_the_code_are_in_the_bibliography():
    used = {key for name in MODELS for key in model_class(name).references}
    used |= {key for name in REGIONS for key in stochastic_motion(6.0, 2e4, name).metadata["references"]}
    used |= {key for kind in PULSES for key in parse_pulse(f"{kind},1Hz,0.1g").metadata["references"]}
    code = "".join(text for path, text in TEXTS.items() if "src" in path.parts)
    used |= set(re.findall(r'"([a-z]+(?:18|19|20)\d\d)"', code))
    assert used <= set(bibliography())
    assert {"baraldi", "housner1963", "wilson1927", "feng2004", "campbell2003", "ricker1943"} <= used


def test_sources_of_docstrings_are_in_the_bibliography():
    known = {(family(entry), entry.year) for entry in bibliography().values()}
    cited = set()
    for path, text in TEXTS.items():
        if "src" in path.parts:
            for section in re.findall(r"References\n +-{10}\n(.*?)\"\"\"", text, re.DOTALL):
                cited |= {(match["first"], int(match["year"])) for match in CITED.finditer(" ".join(section.split()))}
    assert len(cited) > 15
    assert cited <= known


def test_lists_of_the_pages_agree_with_the_bibliography():
    titles = {(family(entry), entry.year, entry.fields["title"]) for entry in bibliography().values()}
    pages = [text for path, text in TEXTS.items() if "docs" in path.parts]
    listed = {
        (match["first"].strip(), int(match["year"]), match["title"])
        for text in pages
        for match in LISTED.finditer(text)
    }
    assert listed
    assert listed <= titles


@pytest.mark.parametrize("key", bibliography())
def test_every_entry_is_cited(key):
    entry, everything = bibliography()[key], "\n".join(TEXTS.values())
    name, year = re.escape(family(entry)), entry.year or ""
    near = rf"{name}[^\n]{{0,60}}{year}" if str(year) not in family(entry) else name
    assert re.search(rf'"{key}"', everything) or re.search(near, everything), f"nothing cites {key}"
