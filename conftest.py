"""Marks the tests of ``pytest -m quick``: files of every room that are cheap and telling, listed in ``tests/quick.txt``."""

from pathlib import Path

ROOT = Path(__file__).parent
QUICK = {ROOT / line for line in (ROOT / "tests" / "quick.txt").read_text(encoding="utf-8").splitlines()}


def pytest_ignore_collect(collection_path, config):
    """Leave other files unread where nothing but the quick tests is asked for: reading all of them takes longer."""
    other = collection_path.name.startswith("test_") and collection_path not in QUICK
    return True if config.option.markexpr == "quick" and other else None


def pytest_collection_modifyitems(items):
    """Mark them, but for single tests that are slow."""
    for item in items:
        if item.path in QUICK and item.get_closest_marker("slow") is None:
            item.add_marker("quick")
