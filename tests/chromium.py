"""A browser for tests: Chromium, where it is installed."""

import shutil


def browser():
    """Path of Chromium; None where there is none."""
    paths = (shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome"))
    return next((path for path in paths if path), None)
