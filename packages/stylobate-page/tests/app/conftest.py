import pytest
from chromium import browser
from page_server import FAKE, REAL, served

from stylobate_page.columns import presets
from stylobate_page.guard import Keys


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    """Where the page of :func:`client` keeps records and jobs."""
    return tmp_path_factory.mktemp("page")


@pytest.fixture(scope="module")
def client(home):
    """The page with a process that computes nothing."""
    with served(home, FAKE) as found:
        yield found


@pytest.fixture
def fresh(tmp_path):
    """The same, without anything that other tests have left."""
    with served(tmp_path, FAKE) as found:
        yield found


@pytest.fixture
def table():
    """A column of three drums as the page holds it."""
    found = presets()["paper-12-drums"]
    return found | {"drum": found["drum"][:3]}


@pytest.fixture
def asked(table):
    """A run."""
    return {"kind": "run", "column": table, "motion": {"kind": "harmonic", "text": "1Hz,0.3g,2s"}, "model": "dem2d"}


#: What lets the browser in.
KEYS = Keys()


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    with served(tmp_path_factory.mktemp("page"), REAL, KEYS) as client:
        yield str(client.base_url).rstrip("/")


@pytest.fixture(scope="module")
def chromium():
    playwright = pytest.importorskip("playwright.sync_api", reason="needs playwright")
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
        page.goto(site + KEYS.printed("/"))
        page.wait_for_selector("html[data-ready]")
        opened.append(page)
        return page

    yield opening
    for page in opened:
        page.close()
    assert said == []
    assert [one for one in asked if not one.startswith((site, "data:", "blob:"))] == []
