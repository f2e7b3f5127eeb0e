"""Prints a page to PDF with a Chromium that is found on this machine."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from stylobate.atomic import replacing
from stylobate.errors import StylobateError

#: Names under which a Chromium is looked for, the first that is found.
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "msedge")

#: Longest time that printing may take [s].
PATIENCE = 120.0


def find_browser() -> str | None:
    """Path of a Chromium; None where there is none."""
    return next((path for name in BROWSERS if (path := shutil.which(name))), None)


def needs_browser() -> str:
    """Path of a Chromium.

    Raises
    ------
    StylobateError
        There is none.
    """
    found = find_browser()
    if found is None:
        raise StylobateError(
            f"no Chromium is found to print with (looked for {', '.join(BROWSERS[:3])}); install one, or open the HTML file "
            "in any browser and print it from there."
        )
    return found


def print_pdf(page: Path, target: Path) -> Path:
    """Print a page of this package; the PDF appears whole or not at all.

    Notes
    -----
    Chromium refuses its sandbox to root. As root it is run without: what it is given is a page that this package has just
    written, in which all text is escaped and whose own policy allows no script and no request, and names of other machines
    lead nowhere: nothing strange reaches the browser. As anybody else the sandbox stays on.

    Raises
    ------
    StylobateError
        There is no Chromium, or it fails.
    """
    browser = needs_browser()
    with tempfile.TemporaryDirectory(prefix="stylobate-print-") as place, replacing(target) as partial:
        printed = Path(place) / "page.pdf"
        command = [
            browser,
            "--headless=new",
            *(["--no-sandbox"] if is_root() else []),
            "--disable-gpu",
            "--disable-extensions",
            "--disable-dev-shm-usage",
            "--no-first-run",
            "--host-resolver-rules=MAP * ~NOTFOUND",
            f"--user-data-dir={place}/profile",
            "--no-pdf-header-footer",
            f"--print-to-pdf={printed}",
            page.resolve().as_uri(),
        ]
        try:
            done = subprocess.run(command, capture_output=True, timeout=PATIENCE, stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            raise StylobateError(
                f"{browser} did not print {page} in {PATIENCE:.0f} s; open the HTML file in a browser and print it there."
            ) from None
        if done.returncode or not printed.is_file() or printed.read_bytes()[:5] != b"%PDF-":
            said = done.stderr.decode("utf-8", "replace").strip().splitlines()
            why = said[-1][:200] if said else f"it ended with code {done.returncode}"
            raise StylobateError(
                f"{browser} could not print {page}: {why}; open the HTML file in a browser and print it from there."
            )
        shutil.copyfile(printed, partial)
    return target


def is_root() -> bool:
    """Whether this process is root's, to which Chromium refuses its sandbox."""
    return hasattr(os, "geteuid") and os.geteuid() == 0
