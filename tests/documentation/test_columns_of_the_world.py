"""The page on columns of the world says what the catalogue says, and shows a fragility of each."""

import re
from pathlib import Path

from stylobate.bibliography import bibliography
from stylobate.column.catalogue import CATALOGUE

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "columns_of_the_world.md").read_text(encoding="utf-8")


def test_the_page_has_every_figure_and_every_source():
    """Whoever changes the catalogue runs the command that the page names."""
    for known in CATALOGUE.values():
        for name, figure in known.figures.items():
            assert f"- {name.replace('_', ' ')}: {figure.text}\n" in PAGE
        assert all(f"{bibliography()[key].text}\n" in PAGE for key in known.sources)


def test_the_page_has_a_fragility_of_every_column():
    rows = dict(re.findall(r"^\| `([\w-]+)` \|.*\| ([^|]+ m/s \([^|]+\)) \| \d+ \|$", PAGE, re.MULTILINE))
    assert list(rows) == list(CATALOGUE)
