"""Open measurements from beside the project, for the tests that need them; these are skipped where they are missing."""

from pathlib import Path

import pytest

#: The folder beside the project.
FOLDER = Path(__file__).resolve().parents[2] / "shared" / "experiments"

needs_granite = pytest.mark.skipif(
    not (FOLDER / "granite").is_dir(), reason="no folder ../shared/experiments/granite with measured tests"
)
needs_cube = pytest.mark.skipif(
    not (FOLDER / "cube").is_dir(), reason="no folder ../shared/experiments/cube with measured tosses"
)
