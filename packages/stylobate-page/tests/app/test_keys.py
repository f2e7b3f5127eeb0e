"""Who may use the page: whoever has the printed address, and the browser that has visited it; nobody else."""

import socket
import stat

import httpx
import pytest
from page_server import FAKE, served

from stylobate_page.guard import CLOSED, Keys


@pytest.fixture(scope="module")
def keys():
    return Keys()


@pytest.fixture(scope="module")
def page(tmp_path_factory, keys):
    """A page that asks for its token, and a browser that has visited it."""
    with served(tmp_path_factory.mktemp("page"), FAKE, keys) as page_client:
        yield page_client


@pytest.fixture
def stranger(page):
    with httpx.Client(base_url=page.base_url) as client:
        yield client


@pytest.mark.parametrize(
    "path", ["/", "/static/main.js", "/api/about", "/api/jobs", "/api/records", "/api/events", "/x"]
)
def test_nothing_is_told_without_the_token(stranger, path):
    for wrong in ("", "?token=", "?token=0123", "?token=%ff%ed%a0%80", "?ticket=", "?token=x&" + "a=1&" * 50):
        answer = stranger.get(path + wrong)
        assert answer.status_code == 403
        assert CLOSED in answer.text
        assert "set-cookie" not in answer.headers
    for cookie in ("stylobate-{}=0123", "stylobate-{}=", "=; ;;stylobate-{}", "stylobate-{}=é"):
        sent = {"cookie": cookie.format(stranger.base_url.port).encode()}
        assert stranger.get(path, headers=sent).status_code == 403


def test_nothing_is_taken_without_the_token(page, stranger, run_request):
    assert stranger.post("/api/jobs", json=run_request).status_code == 403
    assert stranger.post("/api/records", content=b"1 2\n").status_code == 403
    assert page.get("/api/jobs").json() == {"jobs": []}
    assert page.get("/api/records").json() == {"records": []}


def test_the_first_visit_leaves_a_cookie_that_only_this_page_gets(page, stranger, keys):
    answer = stranger.get(keys.printed("/"))
    assert (answer.status_code, "<title>stylobate" in answer.text) == (200, True)
    cookie = answer.headers["set-cookie"]
    assert cookie == f"stylobate-{page.base_url.port}={keys.token}; Path=/; HttpOnly; SameSite=Strict"
    assert stranger.get("/api/jobs").status_code == 200
    assert "set-cookie" not in stranger.get("/").headers


def test_the_token_serves_scripts_without_cookies(page, keys):
    assert httpx.get(str(page.base_url) + keys.printed("/api/about")).status_code == 200


def test_what_a_browser_is_started_with_is_worth_nothing_afterwards(page, stranger, keys):
    """Every user of the machine can read the command line of a process."""
    address = keys.once("/")
    assert keys.token not in address
    assert httpx.get(str(page.base_url) + address).status_code == 200
    assert stranger.get(address).status_code == 403


def test_what_is_kept_is_nobody_elses_to_read(page, tmp_path):
    with served(tmp_path / "kept") as other:
        other.post("/api/records", content=b"1 2\n", headers={"x-name": "a.csv"})
        parts = [part for part in (tmp_path / "kept").iterdir() if part.is_dir()]
        assert sorted(part.name for part in parts) == ["jobs", "records"]
        assert {stat.S_IMODE(part.stat().st_mode) for part in parts} == {0o700}
        assert stat.S_IMODE((tmp_path / "kept" / "worker.log").stat().st_mode) == 0o600


def test_a_body_without_the_token_is_not_read(page):
    port = page.base_url.port
    with socket.create_connection(("127.0.0.1", port), 5.0) as line:
        line.sendall(
            f"POST /api/records HTTP/1.1\r\nhost: 127.0.0.1:{port}\r\ncontent-length: 30000000\r\n\r\n".encode()
        )
        assert line.recv(100).split()[1] == b"403"
