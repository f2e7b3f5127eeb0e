"""Real records for the tests: those that come with the package, the rest from a folder beside the project.

Files are named as their networks published them. A test that needs one that is in neither place is skipped.
"""

from pathlib import Path

import pytest

from stylobate.motion.readers.source import samples

#: The folder beside the project.
FOLDER = Path(__file__).resolve().parents[2] / "shared" / "records"

#: Samples by the name of their file.
SHIPPED = {sample.file: sample for sample in samples().values()}

needs_folder = pytest.mark.skipif(not FOLDER.is_dir(), reason="no folder ../shared/records with real records")


def record(name: str) -> str | Path:
    """What ``read_motion`` takes for a file of this name."""
    if name in SHIPPED:
        return f"sample:{SHIPPED[name].name}"
    if not (FOLDER / name).is_file():
        pytest.skip(f"{name} does not come with the package and is not in ../shared/records")
    return FOLDER / name


def content(name: str) -> bytes:
    """The bytes of a file of this name."""
    return SHIPPED[name].data if name in SHIPPED else Path(record(name)).read_bytes()
