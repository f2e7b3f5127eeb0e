"""The whole story of the page in a real browser: edit, upload, run, watch, cancel, map, on a desk and on a phone."""

from pathlib import Path

import numpy as np
import pytest
from chromium import browser
from page_server import AA, AA_LARGE, FAINT, until

playwright = pytest.importorskip("playwright.sync_api", reason="needs playwright")
pytestmark = [
    pytest.mark.skipif(browser() is None, reason="needs Chromium, which this machine does not have"),
    pytest.mark.slow,
]

#: Fields of drums that are narrower than what they hold.
CUT_OFF = """[...document.querySelectorAll("table.drums input")]
    .filter(one => one.scrollWidth > one.clientWidth + 1).map(one => one.value)"""

#: Number of jobs, asked on the page.
JOBS = "fetch('/api/jobs').then(answer => answer.json()).then(found => found.jobs.length)"

#: An assembly in space.
STATUE = Path(__file__).parents[4] / "gallery" / "assemblies" / "statue.toml"


def test_the_whole_story(open_page, tmp_path):
    page = open_page(1440)
    expect = playwright.expect

    # a value that cannot be is marked where it was typed, in the words of the library
    height = page.locator('[data-field="drum.3.height"]')
    height.fill("-1")
    expect(page.locator("#column .error")).to_contain_text("Drum 3: height of a drum is -1 m")
    expect(height).to_have_attribute("aria-invalid", "true")
    for width in (390, 1440):  # and no number is cut off
        page.set_viewport_size({"width": width, "height": 900})
        assert page.evaluate(CUT_OFF) == [], width
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
    for name, value in (
        ("frequencies.last", "1"),
        ("frequencies.number", "3"),
        ("amplitudes.number", "4"),
        ("duration", "2"),
    ):
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
    page.fill('#domain [data-field="frequencies.number"]', "40")
    page.fill('#domain [data-field="duration"]', "30")
    page.click("text=Map it")
    expect(page.locator("#domain-said")).to_contain_text("Cancel")
    page.locator("#domain-said button").click()
    expect(page.locator("#domain-said .verdict")).to_contain_text("Cancelled")
    page.click("[data-tab=jobs]")
    expect(page.locator("#jobs li[data-job]")).to_have_count(5)

    # one that is deleted is shown nowhere, and nothing is said to be computed
    page.locator("#jobs li[data-job]").filter(has_text="domain").first.get_by_text("Delete").click()
    expect(page.locator("#jobs li[data-job]")).to_have_count(4)
    page.click("[data-tab=domain]")
    expect(page.locator("#domain-said")).to_be_hidden()
    expect(page.locator("#status")).to_have_text("ready")


@pytest.mark.parametrize("width", [1440, 390])
def test_every_part_fits_and_can_be_read(open_page, width):
    page = open_page(width)
    for tab in ("column", "motion", "run", "domain", "fragility", "analyses", "jobs"):
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
    for name in ("column", "motion", "run", "domain", "fragility", "jobs", "preset", "name"):
        assert name in reached
    page.locator("[data-tab=motion]").focus()
    page.keyboard.press("Enter")
    page.locator("#motion canvas[role=slider]").focus()
    for _ in range(3):
        page.keyboard.press("ArrowUp")
    playwright.expect(page.locator('[data-field="azimuth"]')).to_have_value("15")
    playwright.expect(page.locator("#motion-facts")).to_contain_text("y 0.0776 g")


def test_an_elevation_has_its_own_labels_until_the_next_is_known(open_page):
    page, expect = open_page(1440), playwright.expect
    page.locator("#column input[value=found]").check()
    page.fill('[data-field="found.2.offset"]', "0.05")
    elevation = page.locator("canvas.elevation")
    empty = elevation.evaluate("canvas => canvas.toDataURL()")
    until(lambda: elevation.evaluate("canvas => canvas.toDataURL()") != empty)
    before, routes = elevation.evaluate("canvas => canvas.toDataURL()"), []
    page.route("**/api/column", lambda route: routes.append(route))
    page.select_option("[data-field=preset]", "paper-monolithic")
    expect(elevation).to_have_class("elevation past")
    assert elevation.evaluate("canvas => canvas.toDataURL()") == before
    until(lambda: page.wait_for_timeout(20) or routes)
    routes[0].continue_()
    expect(elevation).to_have_class("elevation")
    expect(page.locator("#column-facts")).to_contain_text("5 m")
    assert elevation.evaluate("canvas => canvas.toDataURL()") != before
    page.unroute("**/api/column")
    page.fill('[data-field="found.1.offset"]', "99")  # refused: nothing of the last column passes for its own
    expect(elevation).to_have_class("elevation past")
    expect(page.locator("#column-facts")).to_be_empty()
    assert "?" not in page.url  # the token is kept in a cookie alone


def tab_to(page, selector):
    """Go on with the tabulator until what is wanted has the focus, as somebody without a mouse does."""
    for _ in range(120):
        page.keyboard.press("Tab")
        if page.evaluate("selector => document.activeElement.matches(selector)", selector):
            return
    raise AssertionError(f"{selector} is not reached")


def seen(page):
    """The film as it is drawn now."""
    return page.locator("#film").evaluate("canvas => canvas.toDataURL()")


def test_a_run_in_space_and_its_film_by_keyboard_alone(open_page):
    page, expect = open_page(1440), playwright.expect
    tab_to(page, "[data-field=preset]")
    page.keyboard.press("ArrowUp")  # to the preset before, paper-monolithic
    expect(page.locator('[data-field="drum.2.height"]')).to_have_count(0)
    tab_to(page, '[data-field="drum.1.height"]')
    page.keyboard.press("Control+A")
    page.keyboard.type("4")
    expect(page.locator("#column-facts")).to_contain_text("4 m")
    tab_to(page, "[data-tab=motion]")
    page.keyboard.press("Enter")
    tab_to(page, "[data-field=duration]")
    page.keyboard.press("Control+A")
    page.keyboard.type("1")
    tab_to(page, "[data-field=azimuth]")
    page.keyboard.type("30")
    tab_to(page, "[data-tab=run]")
    page.keyboard.press("Enter")
    tab_to(page, "[data-field=model]")
    page.keyboard.type("dem3d")
    tab_to(page, "#go")
    page.keyboard.press("Enter")
    expect(page.locator("#run-said .verdict:not(.sentence)")).to_contain_text("The block", timeout=60_000)

    # play and pause, turn, zoom, and back; what is drawn changes, and is the same again in the end
    play, now = page.locator("#play"), page.locator("#now")
    tab_to(page, "#film")
    if play.inner_text() == "Pause":
        page.keyboard.press("Space")
    expect(play).to_have_text("Play")
    page.keyboard.press("0")
    views = [seen(page)]
    for key in ("ArrowLeft", "ArrowUp", "+", "-", "0"):
        page.keyboard.press(key)
        views.append(seen(page))
    assert len(set(views[:4])) == 4
    assert views[0] == views[-1]

    # scrub, at another speed, with larger displacements
    tab_to(page, "#place")
    page.keyboard.press("Home")
    expect(now).to_have_text("0.00 s")
    page.keyboard.press("ArrowRight")
    expect(now).not_to_have_text("0.00 s")
    page.keyboard.press("End")
    expect(now).to_have_text("1.00 s")
    tab_to(page, "select[aria-label=speed]")
    page.keyboard.press("ArrowUp")
    expect(page.locator("select[aria-label=speed]")).to_have_value("0.5")
    before = seen(page)
    tab_to(page, "select[aria-label=displacements]")
    page.keyboard.press("End")
    expect(page.locator("select[aria-label=displacements]")).to_have_value("100")
    assert seen(page) != before
    tab_to(page, "#joints")
    page.keyboard.type("twist")
    expect(page.locator("#joints")).to_have_value("twist")
    tab_to(page, "#play")
    page.keyboard.press("Enter")
    expect(play).to_have_text("Pause")
    until(lambda: 0.1 < float(now.inner_text().split()[0]) < 1.0)


def test_records_to_a_fragility_and_what_brings_it_down(open_page, tmp_path):
    """Ten records from a folder, and one that is none; curves of both analyses; then the smallest amplitude."""
    page, expect = open_page(1440), playwright.expect
    folder = tmp_path / "records"
    folder.mkdir()
    for k in range(10):
        time_ = 0.01 * np.arange(150)
        ground = (1.0 + 0.1 * k) * np.sin(2.0 * np.pi * (0.8 + 0.1 * k) * time_)
        rows = [f"{t:.2f} {a:.5f}" for t, a in zip(time_, ground)]
        (folder / f"record-{k}.txt").write_text("\n".join(rows))
    (folder / "notes <i>.txt").write_text("no record\n")
    page.select_option("[data-field=preset]", "paper-monolithic")
    page.click("[data-tab=run]")
    page.select_option("[data-field=model]", "housner")
    page.click("[data-tab=fragility]")
    page.set_input_files("[data-upload=folder]", str(folder))
    expect(page.locator("#fragility-asked")).to_contain_text("11 records")
    page.select_option("#fragility [data-field=unit]", "m/s2")
    page.fill("#fragility [data-field=runs]", "4")
    page.keyboard.press("Tab")
    page.click("#fragility-asked button.primary")
    panel = page.locator("#fragility-found")
    expect(panel.locator(".verdict").first).to_contain_text("half of the records bring collapse", timeout=60_000)
    expect(panel).to_contain_text("of 10 records")
    expect(panel).to_contain_text("notes <i>.txt was left out")
    expect(panel.locator("canvas[data-curves=ida]")).to_be_visible()
    expect(panel.locator("canvas[data-curves=fragility]")).to_be_visible()
    blank = """one => [...one.querySelectorAll('canvas')].map(canvas => {
        const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
        return data.filter((value, k) => k % 4 === 3 && value > 0).length; })"""
    assert min(panel.evaluate(blank)) > 2000

    page.click("[data-tab=run]")
    page.locator("#critical summary").click()
    for name, value in (("start", "0.1"), ("stop", "0.5"), ("step", "0.1")):
        page.fill(f'[data-field="{name}"]', value)
    page.click("text=Find it")
    answer = page.locator("#run-said")
    expect(answer.locator(".verdict:not(.sentence)")).to_contain_text("collapses at 0.4 g", timeout=30_000)
    expect(page.locator("canvas[data-curves=critical]")).to_be_visible()
    page.click("text=Run it at this amplitude")
    expect(answer.locator(".verdict:not(.sentence)")).to_contain_text("The block collapsed", timeout=30_000)

    # another page takes up the settings of a job
    other = open_page(390)
    other.click("[data-tab=jobs]")
    other.locator("#jobs li[data-job]").filter(has_text="11 records").get_by_text("Take its settings").click()
    expect(other.locator("[data-field=preset]")).to_have_value("")
    other.click("[data-tab=fragility]")
    expect(other.locator("#fragility [data-field=runs]")).to_have_value("4")


def test_an_assembly_and_links_through_the_page(open_page, tmp_path):
    page, expect = open_page(1440), playwright.expect
    page.locator("#column summary:has-text('Strengthening')").click()
    page.click("text=Add a link")
    page.fill('[data-field="link.1.diameter"]', "7")
    expect(page.locator("#column .error")).to_contain_text("diameter of a dowel is 7 m; allowed is")
    expect(page.locator('[data-field="link.1.diameter"]')).to_have_attribute("aria-invalid", "true")
    page.fill('[data-field="link.1.diameter"]', "0.04")
    expect(page.locator("#column .error")).to_have_count(0)
    page.fill('[data-field="link.1.joint"]', "all")
    expect(page.locator("#column .error")).to_have_count(0)
    page.click("text=Add a link")  # what was typed stays
    page.locator("[aria-label='remove link 2']").click()
    expect(page.locator('[data-field="link.1.joint"]')).to_have_value("all")
    with page.expect_download() as saved:
        page.click("text=Save column file")
    assert saved.value.path().read_text().count('kind = "dowel"') == 12

    portal = tmp_path / "portal.toml"
    joint = "[joint]\nnormal_stiffness = 5e9\nshear_stiffness = 2.5e9\nfriction_angle = 35\n"
    blocks = [(0, 1, 0, 3), (4, 5, 0, 3), (0, 5, 3, 4)]
    corners = ["[[block]]\nvertices = [[{0},{2}],[{1},{2}],[{1},{3}],[{0},{3}]]\n".format(*block) for block in blocks]
    portal.write_text('name = "portal <b>"\ndensity = 2500.0\n' + joint + "".join(corners))
    page.set_input_files("[data-upload=column]", str(portal))
    expect(page.locator("#column-facts")).to_contain_text("portal <b>", timeout=60_000)
    page.click("[data-tab=motion]")
    page.fill("[data-field=duration]", "1")
    page.keyboard.press("Control+Enter")
    expect(page.locator("#run-said .verdict:not(.sentence)")).to_contain_text("blocks", timeout=60_000)
    expect(page.locator("#film")).to_be_visible()
    page.reload()
    expect(page.locator("#film")).to_be_visible()
    page.click("[data-tab=column]")
    page.click("text=Back to the column")
    expect(page.locator('[data-field="link.1.diameter"]')).to_have_value("0.04")


def test_an_assembly_in_space_from_its_file_to_its_film_and_its_critical_amplitude(open_page):
    page, expect = open_page(1440), playwright.expect
    page.set_input_files("[data-upload=column]", str(STATUE))
    expect(page.locator("#column-facts")).to_contain_text("statue", timeout=60_000)
    painted = "one => new Set(one.getContext('2d').getImageData(0, 0, one.width, one.height).data).size"
    until(lambda: page.locator("canvas.elevation").evaluate(painted) > 20)
    page.click("[data-tab=motion]")
    page.fill("[data-field=duration]", "1")
    page.click("[data-tab=run]")
    expect(page.locator("#run [data-field=model] option")).to_have_text(["dem3d"])
    page.fill("[data-field=replicates]", "2")
    page.click("#go")
    expect(page.locator("#run-said .verdict:not(.sentence)")).to_contain_text("2 assemblies like this", timeout=120_000)
    expect(page.locator("#film")).to_be_visible()
    page.fill("[data-field=replicates]", "")
    page.click("text=What amplitude brings it down?")
    for field, value in (("start", "0.1"), ("stop", "0.2"), ("step", "0.1")):
        page.fill(f"[data-field={field}]", value)
    page.click("text=Find it")
    expect(page.locator("canvas[data-curves=critical]")).to_be_visible(timeout=120_000)
    page.click("[data-tab=fragility]")
    expect(page.locator("#fragility-asked input[type=radio]")).to_have_count(1)
    page.locator("#fragility-asked input[type=checkbox]").nth(4).check()
    page.fill("[data-field=runs]", "2")
    page.locator("#fragility-asked button.primary").click()
    expect(page.locator("#fragility-found")).to_contain_text("Runs is 2; allowed is [4, 1000]", timeout=60_000)
    page.click("[data-tab=domain]")
    expect(page.locator("#domain-case")).to_contain_text("domains are of columns")


def test_what_the_process_of_jobs_refuses_is_marked_at_its_field(open_page):
    page, expect = open_page(1440), playwright.expect
    page.select_option("[data-field=preset]", "paper-monolithic")
    page.click("[data-tab=domain]")
    page.fill('#domain [data-field="amplitudes"]', "-1")
    page.fill('#domain [data-field="amplitudes.number"]', "2")
    page.click("text=Map it")
    expect(page.locator('#domain [data-field="amplitudes"]')).to_have_attribute("aria-invalid", "true", timeout=25_000)
    expect(page.locator("#domain .error")).to_have_text("One of the amplitudes is -1 g; allowed is (0, 1019.37] g.")


def test_what_is_no_number_is_told_in_the_words_of_its_field(open_page):
    """Before anything is asked for: no job is made, and no message speaks of how a command line writes it."""
    page, expect = open_page(1440), playwright.expect
    jobs = page.evaluate(JOBS)
    page.click("[data-tab=motion]")
    page.fill("#motion [data-field=frequency]", "0,5")
    expect(page.locator("#motion .error")).to_have_text(
        "“Frequency” is “0,5”; it must be a number [Hz], with a point: 0.5."
    )
    expect(page.locator("#motion-facts")).to_contain_text("No motion yet")
    page.fill("#motion [data-field=frequency]", "1")
    expect(page.locator("#motion .error")).to_have_count(0)
    for tab, button, field, typed, message in (
        ("run", "#go", "tail", "1 s", "“Tail after the motion” is “1 s”; it must be a number [s], such as 5."),
        ("domain", "text=Map it", "frequencies", "", "“Hz, from” is empty; give a number [Hz], such as 0.33."),
        ("domain", "text=Map it", "frequencies.last", "0.1", "“to” is 0.1; it must be above “Hz, from”, which is 0.33"),
        ("domain", "text=Map it", "amplitudes.number", "2.5", "“values” is “2.5”; it must be a whole number"),
        ("fragility", "#fragility-asked button.primary", "runs", "x", "“Runs of a record” is “x”; it must be a whole"),
    ):
        page.click(f"[data-tab={tab}]")
        box = page.locator(f'#{tab} [data-field="{field}"]')
        before = box.input_value()
        box.fill(typed)
        page.click(button)
        expect(page.locator(f"#{tab} .error")).to_contain_text(message)
        expect(box).to_have_attribute("aria-invalid", "true")
        box.fill(before)
    assert page.evaluate(JOBS) == jobs
