"""The whole story of the page in a real browser: edit, upload, run, watch, cancel, map, on a desk and on a phone."""

import time
from pathlib import Path

import numpy as np
import pytest
from page_server import REAL, browser, served

playwright = pytest.importorskip("playwright.sync_api", reason="needs playwright")
pytestmark = [
    pytest.mark.skipif(browser() is None, reason="needs Chromium, which this machine does not have"),
    pytest.mark.slow,
]

#: Ratio of the luminances of text and what is behind it, at least (WCAG 2.2, AA): of text, and of large text.
AA, AA_LARGE = 4.5, 3.0

#: Tells what of a page is fainter than that.
FAINT = Path(__file__).with_name("contrast.js").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    with served(tmp_path_factory.mktemp("page"), REAL) as client:
        yield str(client.base_url).rstrip("/")


@pytest.fixture(scope="module")
def chromium():
    with playwright.sync_playwright() as engine:
        found = engine.chromium.launch(executable_path=browser(), args=["--no-sandbox", "--disable-gpu"])
        yield found
        found.close()


@pytest.fixture
def open_page(chromium, site):
    """Opens the page at a width; afterwards nothing has been complained of, and nothing asked of another machine."""
    opened, said, asked = [], [], []

    def opening(width, height=900):
        page = chromium.new_page(viewport={"width": width, "height": height})
        page.set_default_timeout(15_000)
        page.on("console", lambda one: said.append(one.text) if one.type in ("error", "warning") else None)
        page.on("pageerror", lambda one: said.append(str(one)))
        page.on(
            "response",
            lambda one: (
                said.append(f"{one.status} {one.url} {one.request.post_data} {one.text()}")
                if one.status >= 400
                else None
            ),
        )
        page.on("request", lambda one: asked.append(one.url))
        page.goto(site)
        page.wait_for_selector("html[data-ready]")
        opened.append(page)
        return page

    yield opening
    for page in opened:
        page.close()
    assert said == []
    assert [one for one in asked if not one.startswith((site, "data:", "blob:"))] == []


def until(holds, limit=15.0):
    end = time.monotonic() + limit
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.05)


def test_the_whole_story(open_page, tmp_path):
    page = open_page(1440)
    expect = playwright.expect

    # a value that cannot be is marked where it was typed, in the words of the library
    height = page.locator('[data-field="drum.3.height"]')
    height.fill("-1")
    expect(page.locator("#column .error")).to_contain_text("[[drum]] number 3: height of a drum is -1 m")
    expect(height).to_have_attribute("aria-invalid", "true")
    height.fill("0.5")
    expect(page.locator("#column .error")).to_have_count(0)
    expect(page.locator("#column-facts")).to_contain_text("5.08 m")

    # a record without a unit: asked for, then shown
    record = tmp_path / "shaking <b>.txt"
    record.write_text("".join(f"{0.01 * k:.2f} {2.0 * np.sin(0.06 * k):.5f}\n" for k in range(300)))
    page.click("[data-tab=motion]")
    page.locator("#motion input[value=record]").check()
    page.set_input_files("[data-upload=record]", str(record))
    expect(page.locator("#motion .error")).to_contain_text("states no unit")
    page.select_option('[data-field="unit"]', "m/s2")
    expect(page.locator("#motion-facts")).to_contain_text("columns of text")
    expect(page.locator("#motion-name")).to_contain_text("shaking <b>.txt")

    # run it, watch it, come back to it
    page.keyboard.press("Control+Enter")
    expect(page.locator("#run-said .verdict")).to_contain_text("The column", timeout=25_000)
    now = page.locator("#now")
    until(lambda: float(now.inner_text().split()[0]) > 0.2)  # it plays
    page.click("#play")
    page.locator("#place").focus()
    page.keyboard.press("End")
    expect(now).to_have_text("2.99 s")
    page.select_option("select[aria-label=displacements]", "10")
    page.reload()
    expect(page.locator("#film")).to_be_visible()
    expect(page.locator("#run-case")).to_contain_text("shaking <b>.txt")

    # its report, in a tab of its own, where nothing of it can run
    page.click("#run-said button:has-text('Report')")
    report = page.locator("#run-said a:has-text('Open the report')")
    expect(report).to_be_visible(timeout=25_000)
    with page.expect_popup() as opened:
        report.click()
    expect(opened.value.locator("body")).to_contain_text("paper-12-drums")
    assert opened.value.evaluate("window.origin") == "null"
    opened.value.close()

    # a domain streams in; by keyboard to a cell, and to its film
    page.click("[data-tab=domain]")
    for name, value in (("f1", "1"), ("fn", "3"), ("an", "4"), ("duration", "2")):
        page.fill(f'#domain [data-field="{name}"]', value)
    page.click("text=Map it")
    expect(page.locator("#domain-said .verdict")).to_contain_text("of 12 cells collapse", timeout=25_000)
    page.locator("#domain canvas").focus()
    for key in ("ArrowRight", "ArrowUp", "ArrowRight"):
        page.keyboard.press(key)
    expect(page.locator("#domain-cell")).to_contain_text("1 Hz, 0.233 g")
    page.keyboard.press("Enter")
    expect(page.locator("#run-said .verdict")).to_contain_text("The column")

    # a long one is stopped, and says what is kept
    page.click("[data-tab=domain]")
    page.fill('#domain [data-field="fn"]', "40")
    page.fill('#domain [data-field="duration"]', "30")
    page.click("text=Map it")
    expect(page.locator("#domain-said")).to_contain_text("Cancel")
    page.locator("#domain-said button").click()
    expect(page.locator("#domain-said .verdict")).to_contain_text("Cancelled")
    page.click("[data-tab=jobs]")
    expect(page.locator("#jobs li[data-job]")).to_have_count(5)


@pytest.mark.parametrize("width", [1440, 390])
def test_every_part_fits_and_can_be_read(open_page, width):
    page = open_page(width)
    for tab in ("column", "motion", "run", "domain", "fragility", "jobs"):
        page.click(f"[data-tab={tab}]")
        playwright.expect(page.locator(f"#{tab} h1")).to_be_visible()
        assert page.evaluate("document.documentElement.scrollWidth") <= width, tab
        assert page.evaluate(FAINT, [AA, AA_LARGE]) == [], tab


def test_by_keyboard_alone(open_page):
    page = open_page(1440)
    reached = []
    for _ in range(14):
        page.keyboard.press("Tab")
        reached.append(
            page.evaluate("document.activeElement.dataset.tab || document.activeElement.dataset.field || ''")
        )
    for one in ("column", "motion", "run", "domain", "fragility", "jobs", "preset", "name"):
        assert one in reached
    page.locator("[data-tab=motion]").focus()
    page.keyboard.press("Enter")
    page.locator("#motion canvas[role=slider]").focus()
    for _ in range(3):
        page.keyboard.press("ArrowUp")
    playwright.expect(page.locator('[data-field="azimuth"]')).to_have_value("15")
    playwright.expect(page.locator("#motion-facts")).to_contain_text("y 0.0776 g")
