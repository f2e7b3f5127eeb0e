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
    with served(home, FAKE) as page_client:
        yield page_client


@pytest.fixture
def fresh(tmp_path):
    """The same, without anything that other tests have left."""
    with served(tmp_path, FAKE) as page_client:
        yield page_client


@pytest.fixture
def table():
    """A column of three drums as the page holds it."""
    column = presets()["paper-12-drums"]
    return column | {"drum": column["drum"][:3]}


@pytest.fixture
def run_request(table):
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
        chrome = engine.chromium.launch(executable_path=browser(), args=["--no-sandbox", "--disable-gpu"])
        yield chrome
        chrome.close()


@pytest.fixture
def open_page(chromium, site):
    """Opens the page at a width; afterwards nothing has been complained of, and nothing asked of another machine."""
    opened, complaints, urls = [], [], []

    def opening(width, height=900):
        page = chromium.new_page(viewport={"width": width, "height": height})
        page.set_default_timeout(15_000)
        page.on(
            "console", lambda message: complaints.append(message.text) if message.type in ("error", "warning") else None
        )
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on(
            "response",
            lambda response: (
                complaints.append(f"{response.status} {response.url} {response.request.post_data} {response.text()}")
                if response.status >= 400
                else None
            ),
        )
        page.on("request", lambda request: urls.append(request.url))
        page.goto(site + KEYS.printed("/"))
        page.wait_for_selector("html[data-ready]")
        opened.append(page)
        return page

    yield opening
    for page in opened:
        page.close()
    assert complaints == []
    assert [url for url in urls if not url.startswith((site, "data:", "blob:"))] == []
