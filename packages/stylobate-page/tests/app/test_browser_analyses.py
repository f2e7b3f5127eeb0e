"""Analyses of the page, fragilities that grow, and texts and lists that are typed in, in a real browser."""

import json

import numpy as np
import pytest
from chromium import browser
from page_server import AA, AA_LARGE, FAINT, HAZARD, RUNS, until

playwright = pytest.importorskip("playwright.sync_api", reason="needs playwright")
pytestmark = [
    pytest.mark.skipif(browser() is None, reason="needs Chromium, which this machine does not have"),
    pytest.mark.slow,
]


def choose(page, kind):
    page.click("[data-tab=analyses]")
    page.select_option("[data-field=analysis]", kind)


def fits(page):
    """Nothing is wider than a phone, and all can be read, on it and on a desk."""
    for width in (390, 1440):
        page.set_viewport_size({"width": width, "height": 900})
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert page.evaluate(FAINT, [AA, AA_LARGE]) == []


def test_every_analysis_is_asked_and_answered(open_page, tmp_path):
    page, expect = open_page(1440), playwright.expect
    page.select_option("[data-field=preset]", "paper-monolithic")
    page.click("[data-tab=motion]")
    page.fill("[data-field=duration]", "1")
    panel, compute = page.locator("#analyses-found"), page.locator("#analyses-asked button.primary")

    # in one click from where a run is asked for; from there the film of the worst direction
    choose(page, "directions")
    page.select_option("#analyses [data-field=model]", "dem2d")
    page.fill("[data-field=azimuths]", "0:90:2")
    page.click("[data-tab=run]")
    page.click("text=From all directions")
    expect(panel.locator("tbody tr")).to_have_count(2, timeout=60_000)
    expect(panel.locator("img.figure")).to_be_visible()
    fits(page)
    page.click("text=Run it at 0")
    expect(page.locator("#film")).to_be_visible(timeout=30_000)
    expect(page.locator("#run-said")).to_contain_text("at 0")

    # a field that is wrong is marked where it is
    choose(page, "directions")
    page.fill("[data-field=azimuths]", "0:360:13")
    compute.click()
    expect(page.locator("[data-field=azimuths]")).to_have_attribute("aria-invalid", "true", timeout=30_000)
    expect(page.locator("#analyses .error")).to_contain_text("360")

    choose(page, "compare")
    page.locator("[data-key='models.rigid-block']").uncheck()
    compute.click()
    expect(panel.locator("tbody tr")).to_have_count(2, timeout=30_000)
    expect(panel.locator("tbody th")).to_have_text(["dem2d", "rigid-beam"])
    expect(panel.locator("img.figure")).to_be_visible()

    choose(page, "sequence")
    page.fill("[data-field=rest]", "1")
    compute.click()
    expect(panel.locator(".verdict:not(.sentence)")).to_contain_text("It falls in earthquake 2 of 2", timeout=30_000)
    fits(page)
    page.click("text=Watch it")
    expect(page.locator("#film")).to_be_visible()

    # runs and hazard curves from files
    choose(page, "survival")
    page.set_input_files("[data-upload=table]", {"name": "t.csv", "mimeType": "text/csv", "buffer": RUNS.encode()})
    curves = [{"name": name, "mimeType": "text/csv", "buffer": HAZARD.encode()} for name in ("A.csv", "B <b>.csv")]
    page.set_input_files("[data-upload=hazard]", curves)
    page.fill("#analyses [data-field=im]", "pgv")
    compute.click()
    expect(panel.locator("tbody tr")).to_have_count(2, timeout=30_000)
    fits(page)
    choose(page, "risk")
    page.fill("#analyses [data-field=im]", "pgv")
    page.locator("[aria-label='leave out A.csv']").click()
    compute.click()
    expect(panel.locator(".verdict:not(.sentence)")).to_contain_text("collapse once in", timeout=30_000)
    page.reload()
    expect(panel.locator(".verdict:not(.sentence)")).to_contain_text("collapse once in")

    # what a job was asked comes back, the files that it was given among it
    page.click("[data-tab=jobs]")
    page.locator("#jobs li[data-job]").first.get_by_text("Take its settings").click()
    expect(page.locator("#analyses")).to_contain_text("B <b>.csv")
    expect(page.locator("#analyses")).to_contain_text("a table of runs is open")


def test_points_of_a_fragility_grow(open_page, tmp_path):
    page, expect = open_page(1440), playwright.expect
    page.click("[data-tab=fragility]")
    time = 0.01 * np.arange(800)
    for k in range(10):
        ground = np.sin(2.0 * np.pi * (0.5 + 0.1 * k) * time)
        (tmp_path / f"r{k}.txt").write_text("\n".join(f"{t:.2f} {a:.5f}" for t, a in zip(time, ground)))
    page.set_input_files("[data-upload=records]", sorted(map(str, tmp_path.glob("r*.txt"))))
    expect(page.locator("#fragility-asked")).to_contain_text("10 records")
    page.select_option("#fragility [data-field=unit]", "m/s2")
    page.click("#fragility-asked button.primary")
    growing, pictures = page.locator("canvas[data-curves=growing]"), set()

    def grown():
        picture = page.evaluate("document.querySelector('canvas[data-curves=growing]')?.toDataURL()")
        pictures.update([picture] if picture else [])
        return page.locator("canvas[data-curves=fragility]").count()

    until(grown, 240.0)
    assert len(pictures) > 1  # how many are drawn hangs on how busy the machine is
    assert growing.count() == 0
    warned = page.locator("#fragility-found .warning").all_text_contents()
    assert len(warned) == len(set(warned))  # an analysis and its fragility say the same of a record
    fits(page)


def test_a_list_is_typed_in_although_it_draws_the_form_anew(open_page):
    page = open_page(1440)
    page.focus("[data-field=preset]")
    page.keyboard.type("paper-m", delay=30)  # on the way others that begin so
    playwright.expect(page.locator("[data-field=preset]")).to_have_value("paper-monolithic")
    playwright.expect(page.locator("[data-field=name]")).to_have_value("paper-monolithic")
    page.locator("#column input[name=view]").first.focus()
    for _ in range(2):
        page.keyboard.press("ArrowRight")
    playwright.expect(page.locator("#column input[value=chips]")).to_be_focused()
    page.fill("[data-field='found.1.chip_left']", "0.01")
    page.click("[data-tab=run]")
    playwright.expect(page.locator("#run-case")).to_contain_text("paper-monolithic, changed")


def test_an_assembly_is_written_on_the_page(open_page):
    page, expect = open_page(1440), playwright.expect
    page.click("text=Write an assembly")
    facts, text = page.locator("#column-facts"), page.locator("[data-field=assembly]")
    expect(facts).to_contain_text("two posts and a beam", timeout=60_000)
    good = text.input_value()
    text.fill(good.replace("[[5, 0]", "[[5, 0]").replace("[5, 3], [4, 3]]", "[5, 3], [4.9, 1]]"))
    expect(page.locator("#column .error")).to_contain_text("Block 'right post' is not convex")
    expect(facts).to_be_empty()
    expect(page.locator("canvas.elevation")).to_have_class("elevation past")
    fits(page)
    page.click("#column .error button")
    assert page.evaluate(
        "document.activeElement.value.slice(document.activeElement.selectionStart).split('\\n')[0]"
    ) == ('name = "right post"')
    text.fill(good.replace("two posts", "three posts") + "[[block]]\nvertices = [[7, 0], [8, 0], [8, 1], [7, 1]]\n")
    expect(facts).to_contain_text("three posts")
    expect(page.locator("canvas.elevation")).to_have_class("elevation")
    page.reload()
    expect(text).to_have_value(
        good.replace("two posts", "three posts") + "[[block]]\nvertices = [[7, 0], [8, 0], [8, 1], [7, 1]]\n"
    )
    assert json.loads(
        page.evaluate("JSON.stringify({ model: document.querySelector('#run [data-field=model]').value })")
    ) == {"model": "dem2d"}
