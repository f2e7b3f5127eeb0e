"""How soon the page is there: first paint, from a click to the film of a plane run, and frames while a domain streams in.

Usage: ``.venv/bin/python benchmarks/page.py [RUNS]``, with Chromium on this machine and nothing else computing on it.
"""

import sys
import tempfile
import time
from pathlib import Path
from statistics import median

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
sys.path.insert(0, str(Path(__file__).parents[1] / "packages" / "stylobate-page" / "tests"))

from chromium import browser
from page_server import REAL, served
from playwright.sync_api import Page, sync_playwright

#: Looks at the page: when something was asked for, when its film was painted, and the times between frames.
WATCH = """() => {
  window.seen = { asked: 0, painted: 0, gaps: [] };
  const painted = () => { if (!seen.painted) seen.painted = performance.now(); };
  const ask = () => {
    seen.asked = performance.now(); seen.painted = 0;
    document.querySelector("#run-film").replaceChildren();
  };
  new MutationObserver(() => {
    if (!seen.painted && document.querySelector("#film")) requestAnimationFrame(() => requestAnimationFrame(painted));
  }).observe(document.body, { subtree: true, childList: true });
  document.addEventListener("click", event => { if (event.target.id === "go") ask(); }, true);
  document.addEventListener("keydown", event => { if (event.key === "Enter") ask(); }, true);
  let last = 0;
  const frame = now => { if (last) seen.gaps.push(now - last); last = now; requestAnimationFrame(frame); };
  requestAnimationFrame(frame);
}"""


def until(page: Page, holds: str, limit: float = 120.0) -> None:
    """Wait until an expression holds; the page lets no text be code, so it is asked again and again."""
    end = time.monotonic() + limit
    while not page.evaluate(holds):
        if time.monotonic() > end:
            raise SystemExit(f"{holds} has not come true within {limit:g} s.")
        time.sleep(0.02)


def film_after(page: Page) -> float:
    """From what was asked for to its film on the screen [ms]."""
    until(page, "seen.painted > 0")
    return float(page.evaluate("seen.painted - seen.asked"))


def show_times(name: str, values: list[float]) -> None:
    """Print the middle and the largest one."""
    print(f"{name}: median {median(values):.0f} ms, largest {max(values):.0f} ms")


def measure(page: Page, address: str, runs: int) -> None:
    """Print what was measured."""
    page.goto(address)
    page.wait_for_selector("html[data-ready]")
    (paint,) = page.evaluate("performance.getEntriesByName('first-contentful-paint').map(one => one.startTime)")
    print(f"first paint: {paint:.0f} ms")
    until(page, "document.querySelector('#status').textContent === 'ready'", 600.0)  # code may have to be compiled
    page.evaluate(WATCH)
    page.click("[data-tab=run]")
    times = []
    for _ in range(runs):
        page.click("#go")
        times.append(film_after(page))
        time.sleep(0.5)
    show_times("from a click to the film, twelve drums for ten seconds with fifteen columns like it", times)

    page.click("[data-tab=domain]")
    page.fill('#domain [data-field="frequencies.number"]', "24")
    page.fill('#domain [data-field="amplitudes.number"]', "32")
    page.click("text=Map it")
    until(page, "parseFloat(document.querySelector('#domain-said .sentence')?.textContent) > 50")
    page.locator("#domain canvas").focus()
    for key in ("ArrowRight", "ArrowRight", "ArrowUp"):
        page.keyboard.press(key)
    page.keyboard.press("Enter")
    show_times("the same for a cell, while 24 by 32 others are computed", [film_after(page)])
    page.evaluate("seen.gaps.length = 0")
    time.sleep(5.0)
    gaps = sorted(page.evaluate("seen.gaps"))
    print(
        f"frames while it plays and cells stream in: {len(gaps)} in 5 s, median {median(gaps):.1f} ms, "
        f"95 % {gaps[int(0.95 * len(gaps))]:.1f} ms, largest {gaps[-1]:.1f} ms"
    )


def main() -> None:
    """Serve the page, and look at it."""
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 6
    with tempfile.TemporaryDirectory() as folder, served(Path(folder), REAL) as client, sync_playwright() as engine:
        chromium = engine.chromium.launch(executable_path=browser(), args=["--no-sandbox", "--disable-gpu"])
        measure(chromium.new_page(viewport={"width": 1440, "height": 900}), str(client.base_url), runs)
        chromium.close()


if __name__ == "__main__":
    main()
