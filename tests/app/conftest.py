import pytest
from page_server import FAKE, served

from stylobate.app.columns import presets


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
