"""Sources of the core and of the packages beside it, for tests that read them."""

from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

#: Folders of the core and of the packages, each named as it is imported.
FOLDERS = (ROOT / "src" / "stylobate", *(path.parent for path in sorted(ROOT.glob("packages/*/src/*/__init__.py"))))


def sources(*endings: str) -> Iterator[tuple[str, Path]]:
    """Files with one of the endings, such as ``py``, by name: ``stylobate/cli/run.py``, ``stylobate_report/page.py``."""
    for folder in FOLDERS:
        for path in sorted(folder.rglob("*")):
            if path.suffix[1:] in endings:
                yield path.relative_to(folder.parent).as_posix(), path
