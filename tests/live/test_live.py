"""The page of ``make live``: its module has the bits of the processor's loop, its verdicts are those of the command."""

import json
import os
import platform
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from chromium import browser
from live.data import COLUMNS
from live.link import leb, linked
from live.module import GENERIC
from live.motions import earthquake, pulse, sine
from page_server import AA, AA_LARGE, FAINT

from stylobate.cli.main import call
from stylobate.constants import g

pytestmark = pytest.mark.slow
HERE, ROOT = Path(__file__).parent, Path(__file__).parents[2]

needs_node = pytest.mark.skipif(shutil.which("node") is None, reason="needs Node, which this machine does not have")
needs_browser = pytest.mark.skipif(browser() is None, reason="needs Chromium, which this machine does not have")

#: Motions as the page asks for them, and as Python makes them.
MOTIONS = [
    ({"kind": "sine", "frequency": 0.37, "amplitude": 0.45}, sine(0.37, 0.45 * g)),
    ({"kind": "sine", "frequency": 4.0, "amplitude": 1.5}, sine(4.0, 1.5 * g)),
    ({"kind": "pulse", "frequency": 0.3, "amplitude": 0.05}, pulse(0.3, 0.05 * g)),
    ({"kind": "pulse", "frequency": 1.99, "amplitude": 0.33}, pulse(1.99, 0.33 * g)),
    ({"kind": "earthquake", "name": "el-centro-1940", "amplitude": 0.7}, None),
    ({"kind": "earthquake", "name": "ridgecrest-2019", "amplitude": 0.2}, None),
]


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Folder of the page, with what the same code does on a generic processor."""
    folder = tmp_path_factory.mktemp("live")
    env = os.environ | GENERIC | {"PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-W", "ignore", str(HERE / "reference.py"), str(folder)]
    subprocess.run(command, env=env, cwd=ROOT, check=True)
    return folder


@pytest.fixture(scope="module")
def by_node(built):
    """What the module does in Node."""
    request = json.dumps([item for item, _ in MOTIONS])
    subprocess.run(["node", str(HERE / "node.mjs"), str(built), request], check=True)
    return json.loads((built / "node.json").read_text()) | {"cases": json.loads((built / "cases.json").read_text())}


@needs_node
@pytest.mark.skipif(platform.machine().lower() not in ("x86_64", "amd64"), reason="others contract products and sums")
def test_the_module_has_the_bits_of_the_generic_loop(built, by_node):
    assert {item["column"] for item in by_node["cases"]} == set(COLUMNS)
    for number, case in enumerate(by_node["cases"]):
        native, ours = (np.fromfile(built / f"{number}.{kind}", np.uint64) for kind in ("native", "wasm"))
        assert len(native) == len(ours) > 1500
        differ = native != ours
        assert not ((native | ours)[differ] << np.uint64(1)).any(), (
            case
        )  # but for the sign of zero, which is the compiler's


@needs_node
@pytest.mark.skipif(platform.machine().lower() not in ("x86_64", "amd64"), reason="others contract products and sums")
def test_verdicts_are_those_of_python_to_the_last_bit(by_node):
    outcomes = set()
    for case, result in zip(by_node["cases"], by_node["results"], strict=True):
        if case["verdicts"] is not None:
            ours = [[item["outcome"], item["decided"], item["time"]] for item in result["verdicts"]]
            assert ours == case["verdicts"], case
            outcomes |= {item[0] for item in ours}
    assert len(outcomes) > 1


@needs_node
def test_a_lane_that_is_used_again_begins_anew(by_node):
    assert all(item == by_node["refilled"][0] for item in by_node["refilled"])


@needs_node
@pytest.mark.filterwarnings("ignore:ridgecrest-2019. cut to the common length")
def test_motions_are_those_of_python(by_node):
    for (request, motion), ours in zip(MOTIONS, by_node["motions"], strict=True):
        motion = (motion or earthquake(request["name"], request["amplitude"] * g)).multiplied
        exact = request["kind"] != "sine"  # whose sines Python takes of long times, and the page of one cycle
        np.testing.assert_allclose(ours["x"], motion.samples, rtol=0.0, atol=0.0 if exact else 1e-12)
        assert (ours["z"] is None) == (motion.z_samples is None)
        if ours["z"] is not None:
            np.testing.assert_array_equal(ours["z"], motion.z_samples)
        assert ours["facts"]["sample"] == motion.dt
        assert ours["facts"]["peak"] == motion.pga
        assert ours["facts"]["vertical"] == motion.peaks.get("z", 0.0)


def test_numbers_of_the_linker():
    # the examples of the specification's appendix and of the DWARF standard
    assert leb(624485) == bytes([0xE5, 0x8E, 0x26])
    assert leb(-123456, signed=True) == bytes([0xC0, 0xBB, 0x78])
    assert leb(64, signed=True) == bytes([0xC0, 0x00])
    assert leb(1024, width=5) == bytes([0x80, 0x88, 0x80, 0x80, 0x00])
    with pytest.raises(AssertionError):
        linked(b"no object", [])


# -- in a browser -----------------------------------------------------------------------------------------------------


@pytest.fixture
def open_live(chromium, built):
    """Opens the page from its file at a width; afterwards nothing has been complained of, and nothing asked of a network."""
    opened, output, request = [], [], []

    def opening(width, height=900, script=""):
        page = chromium.new_page(viewport={"width": width, "height": height})
        page.set_default_timeout(120_000)
        page.on("console", lambda item: output.append(item.text) if item.type in ("error", "warning") else None)
        page.on("pageerror", lambda item: output.append(str(item)))
        page.on("request", lambda item: request.append(item.url))
        page.add_init_script(script)
        page.goto((built / "column.html").as_uri())
        opened.append(page)
        return page

    yield opening
    for page in opened:
        page.close()
    assert output == []
    assert [item for item in request if not item.startswith(("file:", "data:", "blob:"))] == []


def over(page):
    page.wait_for_selector("#verdict-text[data-over=true]")
    return page.evaluate("state.film.verdicts")


def command_of(page):
    return page.inner_text("#command")


@needs_browser
@pytest.mark.parametrize(
    ("column", "kind", "of", "amplitude"),
    [
        ("parthenon", "sine", 0.6, 1.0),  # falls, as do all like it
        ("segesta", "pulse", 0.4, 1.3),  # falls
        ("olympieion", "earthquake", "el-centro-1940", 0.3),  # stands
        ("trajan", "pulse", 4.0, 0.2),  # stands
        ("paper-12-drums", "sine", 0.5, 1.2),  # falls
        ("paper-monolithic", "pulse", 2.0, 0.5),  # stands, shifted
        ("paper-monolithic", "earthquake", "hanmer-springs-2016", 1.5),  # falls; with a vertical component
    ],
)
def test_a_verdict_is_that_of_the_command(open_live, capsys, column, kind, of, amplitude):
    page = open_live(1280)
    page.wait_for_selector("html[data-ready]")
    page.check(f"input[value={column}]", force=True)
    page.check(f"input[value={kind}]", force=True)
    if kind == "earthquake":
        page.select_option("#earthquake", of)
    else:
        page.evaluate("one => { $('frequency').value = placeOf(one) }", of)
    page.evaluate("one => { $('amplitude').value = one; shake() }", amplitude)
    ours, line = over(page), command_of(page)
    assert f"run {column} " in line
    assert call([*shlex.split(line)[1:], "--json"]) == 0
    theirs = json.loads(capsys.readouterr().out)
    names = ["at_rest", "rocked", "displaced", "collapsed", "failed"]
    assert names[ours[0]["outcome"]] == theirs["outcome"]
    assert ours[0]["decided"] == theirs["decided"]
    assert sum(item["outcome"] == 3 for item in ours[1:]) == round(15 * theirs["collapse_probability"])
    if theirs["collapsed"]:  # last bits are those of each processor, and grow
        assert ours[0]["time"] == pytest.approx(theirs["collapse_time_s"], rel=0.15)


@needs_browser
def test_it_falls_as_soon_as_it_is_opened_and_the_map_fills(open_live):
    page = open_live(1280)
    page.wait_for_selector("html[data-ready]")
    page.wait_for_function("state.film.fell[0] < 100 && state.film.time > state.film.fell[0] - 0.6")
    assert page.evaluate("state.playing")
    over(page)
    assert "falls after" in page.inner_text("#verdict-text")
    page.wait_for_function("document.querySelectorAll('#sixteen .fell').length === 16")
    page.wait_for_function("state.map.cells.filter(one => one !== null).length > 30")
    # slow and strong brings it down, fast and weak does not
    page.check("input[value=paper-monolithic]", force=True)
    page.wait_for_selector("#map[data-over=true]")
    cells = np.array(page.evaluate("state.map.cells")).reshape(10, 12)
    assert cells[-1, 0] == 3
    assert cells[0, -1] < 3
    fallen = (cells == 3).sum(axis=0)
    assert fallen[0] > fallen[-1]
    weakest, slowest = np.argwhere(cells == 3)[0]
    level, frequency = page.evaluate("([j, i]) => [state.map.up[j], state.map.across[i]]", [int(weakest), int(slowest)])
    text = f"{(cells == 3).sum()} of 120 bring it down; the weakest: {level:g} g, once in {1.0 / frequency:.1f} s"
    assert page.inner_text("#map-text").startswith(text)


@needs_browser
@pytest.mark.parametrize(("width", "height"), [(1280, 800), (390, 844)])
def test_what_is_chosen_on_the_map_is_seen(open_live, width, height):
    page = open_live(width, height)
    page.wait_for_selector("html[data-ready]")
    page.evaluate("$('map').scrollIntoView({ block: 'end' })")
    box = page.locator("#map").bounding_box()
    page.mouse.click(box["x"] + 0.7 * box["width"], box["y"] + 0.3 * box["height"])
    seen = page.locator("#stage").bounding_box()
    assert 0 <= seen["y"] <= height - seen["height"]


@needs_browser
def test_nothing_lies_over_the_text_where_the_page_is_scrolled(open_live):
    page = open_live(1280, 800)
    page.wait_for_selector("html[data-ready]")
    for place in (300, 500, 700):
        page.evaluate("place => scrollTo(0, place)", place)
        ends = page.evaluate(
            "['see', 'about'].map(id => $(id).getBoundingClientRect()).map(one => [one.top, one.bottom])"
        )
        assert ends[0][1] <= ends[1][0]


@needs_browser
def test_a_map_is_kept_while_another_one_is_seen(open_live):
    page = open_live(1280)
    page.wait_for_selector("html[data-ready]")
    page.check("input[value=paper-monolithic]", force=True)
    page.wait_for_function("state.map.cells.filter(one => one !== null).length > 3")
    page.check("input[value=pulse]", force=True)
    assert page.evaluate("state.map.cells.filter(one => one !== null).length") == 0
    page.check("input[value=sine]", force=True)
    assert page.evaluate("state.map.cells.filter(one => one !== null).length") > 3


@needs_browser
def test_earthquakes_are_named_with_their_recorded_strength(open_live):
    page = open_live(1280)
    page.wait_for_selector("html[data-ready]")
    page.check("input[value=earthquake]", force=True)
    assert page.inner_text("#amplitude-text") == "1.00 g (recorded: 0.35 g)"
    page.focus("#map")
    page.keyboard.press("ArrowRight")
    assert "g, Loma Prieta in San Francisco, 1989: not yet computed" in page.inner_text("#map-text")


@needs_browser
def test_the_page_keeps_its_pace_while_it_computes(open_live):
    page = open_live(1280)
    page.wait_for_selector("html[data-ready]")
    page.check("input[value=earthquake]", force=True)
    page.select_option("#earthquake", "hanmer-springs-2016")
    page.wait_for_function("state.film.times.length > 10")
    # what the page itself does for a picture; what a machine without a graphics card paints is not its doing
    spent = page.evaluate("""() => new Promise(done => { const taken = []; const draw = state.stage.draw.bind(state.stage);
        state.stage.draw = (...what) => { const t = performance.now(); draw(...what); taken.push(performance.now() - t);
            if (taken.length === 60) done([taken.sort((a, b) => a - b)[30], state.film.over]); }; })""")
    assert not spent[1]  # it still computed
    assert spent[0] < 1000.0 / 60.0


@needs_browser
@pytest.mark.parametrize("width", [1280, 390])
def test_it_fits_and_can_be_read(open_live, width):
    page = open_live(width)
    over(page)
    for kind in ("earthquake", "sine"):
        page.check(f"input[value={kind}]", force=True)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert page.evaluate(FAINT, [AA, AA_LARGE]) == []
    small = page.evaluate(
        "[...document.querySelectorAll('button, select, input[type=range]')].filter(one => one.offsetParent && "
        "one.getBoundingClientRect().height < 24).map(one => one.id)"
    )
    assert small == []  # what a thumb can hit (WCAG 2.2, 2.5.8)


@needs_browser
def test_by_keyboard_alone(open_live):
    page = open_live(1280)
    over(page)
    reached = set()
    for _ in range(40):
        page.keyboard.press("Tab")
        reached.add(page.evaluate("document.activeElement.id || document.activeElement.name || ''"))
    assert {"play", "time", "speed", "column", "kind", "frequency", "amplitude", "shake", "map", "copy"} <= reached
    page.focus("input[value=parthenon]")
    page.keyboard.press("ArrowRight")
    assert "run segesta" in command_of(page)
    page.focus("#amplitude")
    page.keyboard.press("ArrowRight")
    assert "1.01g" in command_of(page)
    page.focus("#map")
    page.keyboard.press("Home")
    for key in ("ArrowUp", "ArrowUp", "ArrowLeft"):
        page.keyboard.press(key)
    assert re.match(r"1.35 g, once in 2.1 s .*: (falls|stands|not yet)", page.inner_text("#map-text"))
    before = command_of(page)
    page.keyboard.press("Enter")
    assert command_of(page) != before
    over(page)


@needs_browser
@pytest.mark.parametrize(
    ("script", "lacks"),
    [
        ("delete window.WebAssembly", "WebAssembly"),
        ("WebAssembly.validate = () => false", "the vector instructions of WebAssembly"),
        ("delete window.DecompressionStream", "DecompressionStream"),
    ],
)
def test_an_old_browser_is_told(open_live, script, lacks):
    page = open_live(390, script=script)
    note = page.locator("#lacking-note")
    assert note.is_visible()
    assert f"it lacks {lacks}." in note.inner_text()
    assert not page.locator("main").is_visible()
