"""What others may try: names of hosts, other sites, sizes, paths, scripts in names."""

import json
import logging
import socket
import time
from contextlib import suppress

import httpx
import pytest
from page_server import ended, served

from stylobate.cli.main import words_of
from stylobate_page import guard, records
from stylobate_page.guard import Guard
from stylobate_page.job_request import JobRequest, requests
from stylobate_page.records import FILE, generated_name


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1.evil.example", "evil.example:8040", "", "localhost.evil"])
def test_other_names_of_hosts_are_refused(client, host):
    """A name of another's, pointed at this machine, would make its page ours."""
    answer = client.get("/api/about", headers={"host": host})
    assert answer.status_code == 403
    assert "none of this machine" in answer.json()["error"]


@pytest.mark.parametrize("host", ["localhost:8040", "127.0.0.1", "[::1]:8040"])
def test_names_of_this_machine_are_taken(client, host):
    assert client.get("/api/about", headers={"host": host}).status_code == 200


@pytest.mark.parametrize("origin", ["https://evil.example", "http://127.0.0.1:9", "null", "https://127.0.0.1"])
def test_other_sites_are_refused(client, run_request, origin):
    for method, path in (("POST", "/api/jobs"), ("GET", "/api/jobs")):
        answer = client.request(method, path, json=run_request, headers={"origin": origin})
        assert answer.status_code == 403
    assert client.get("/api/jobs", headers={"origin": str(client.base_url).rstrip("/")}).status_code == 200


def test_a_picture_on_another_site_gets_nothing(client):
    assert client.get("/api/jobs", headers={"sec-fetch-site": "cross-site"}).status_code == 403
    assert client.get("/", headers={"sec-fetch-site": "cross-site"}).status_code == 200  # a link to the page


def test_every_answer_carries_its_headers(client):
    for path in ("/", "/static/main.js", "/api/about", "/api/jobs/none", "/none"):
        answer = client.get(path)
        assert "script-src 'self'" in answer.headers["content-security-policy"]
        assert "unsafe" not in answer.headers["content-security-policy"]
        assert answer.headers["x-content-type-options"] == "nosniff"
        assert answer.headers["referrer-policy"] == "no-referrer"
    assert client.get("/", headers={"host": "evil"}).headers["x-content-type-options"] == "nosniff"


def test_the_page_has_no_code_inside(client):
    page = client.get("/").text
    assert "<style" not in page
    assert "onclick" not in page
    assert page.count("<script") == page.count("<script src=") == 3


def test_what_is_announced_too_large_is_not_read(client):
    port = client.base_url.port
    for path, size in (("/api/column", guard.BODY + 1), ("/api/records", FILE + 1), ("/api/records", -1)):
        with socket.create_connection(("127.0.0.1", port), 5.0) as line:
            head = f"POST {path} HTTP/1.1\r\nhost: 127.0.0.1:{port}\r\ncontent-length: {size}\r\n\r\n"
            line.sendall(head.encode())
            assert line.recv(100).split()[1] in (b"413", b"400")


def test_a_body_is_cut_off_while_it_comes_in(tmp_path, monkeypatch):
    """A gigabyte without its length is read no farther than the limit, and nothing of it stays."""
    import asyncio

    from stylobate_page.site import create_app

    chunk, taken, sent = b"x" * 100_000, [], []
    monkeypatch.setattr(records, "FILE", 2_000_000)
    app = create_app(tmp_path, ("true",))
    assert isinstance(app, Guard)
    app.uploads["/api/records"] = 2_000_000

    async def receive():
        taken.append(len(chunk))
        return {"type": "http.request", "body": chunk, "more_body": len(taken) < 10_000}

    async def send(message):
        sent.append(message)

    async def story():
        ready, over = asyncio.Event(), asyncio.Event()
        startups = []

        async def lifespan_receive():
            if startups:
                await over.wait()
                return {"type": "lifespan.shutdown"}
            startups.append(1)
            return {"type": "lifespan.startup"}

        async def lifespan_send(message):
            ready.set()

        life = asyncio.create_task(app({"type": "lifespan", "asgi": {}}, lifespan_receive, lifespan_send))
        await ready.wait()
        scope = {
            "type": "http", "method": "POST", "path": "/api/records", "raw_path": b"/api/records", "query_string": b"",
            "headers": [(b"host", b"127.0.0.1:8040")], "scheme": "http", "server": ("127.0.0.1", 8040), "root_path": "",
            "http_version": "1.1", "client": ("127.0.0.1", 1),
        }  # fmt: skip
        await app(scope, receive, send)
        over.set()
        await life

    asyncio.run(story())
    assert sent[0]["status"] == 413
    assert "2 MB" in json.loads(sent[1]["body"])["error"]
    assert sum(taken) <= 2_200_000
    assert list((tmp_path / "records").iterdir()) == []


@pytest.mark.parametrize(
    "name",
    [
        "../../etc/passwd",
        "..\\..\\boot.ini",
        "/etc/passwd",
        "a\x00b.txt",
        "<script>alert(1)</script>.csv",
        "-rf",
        "",
        "con.",
        "é" * 500,
        "..",
    ],
)
def test_names_of_files_are_made_here(client, home, name):
    made = generated_name(name, "0123abcd")
    assert set(made) <= set("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-.")
    assert made[0] not in "-."
    assert made.count(".") <= 1
    assert len(made) < 70
    from urllib.parse import quote

    kept = client.post("/api/records", content=b"1 2\n", headers={"x-name": quote(name)}).json()
    assert sum(path.name.split(".")[0].endswith(kept["id"]) for path in (home / "records").iterdir()) == 1


PATHS = (
    "../job.json",
    "..%2fjob.json",
    "%2e%2e/job.json",
    "/etc/passwd",
    "result/../../job.json",
    "job.json",
    "result",
)


@pytest.mark.parametrize("path", PATHS)
def test_paths_lead_nowhere(client, run_request, path):
    job = client.post("/api/jobs", json=run_request).json()["id"]
    ended(client, job)
    assert client.get(f"/api/jobs/{job}/files/result/made.txt").text == "kept"
    assert client.get(f"/api/jobs/{job}/files/{path}").status_code in (404, 405)
    assert client.get(f"/static/{path}").status_code == 404
    assert client.get(f"/api/jobs/..%2f..%2f{path}").status_code == 404


def test_scripts_in_names_stay_text(client, run_request):
    evil = "</script><img src=x onerror=alert(1)>"
    run_request["column"]["name"] = evil
    answer = client.post("/api/jobs", json=run_request)
    assert answer.headers["content-type"] == "application/json"
    job = ended(client, answer.json()["id"])
    assert job["title"].startswith(evil)
    column = client.get(f"/api/jobs/{job['id']}/files/column.toml")
    assert column.headers["content-disposition"].startswith("attachment")
    assert column.headers["content-security-policy"].startswith("sandbox")


@pytest.mark.parametrize("value", ["--out=/tmp/elsewhere", "dem2d --out=/tmp", "-x", "--json"])
def test_values_do_not_become_options(client, run_request, value):
    """Each value stays that of its own option, in the request and on the command line."""
    run_request |= {"model": value, "replicates": value, "settings": {"law": value}}
    line = client.post("/api/jobs", json=run_request).json()["commands"][0]
    assert "--out=result" in line
    (request,) = requests(JobRequest(**run_request), {})
    assert (request["model"], request["set"], request["out"]) == (value, [f"law={value}"], "result")
    words = words_of(request)
    assert words[:2] == ["run", "column.toml"]
    assert sum(word.startswith("--out") for word in words) == 1
    assert all(word.startswith("--") for word in words[2:])


@pytest.mark.parametrize("body", [b"", b"[]", b"null", b"{" * 50_000, b"[" * 200_000, b'{"a": NaN', b"\xff\xfe"])
def test_what_is_no_object_is_refused_in_a_sentence(client, body):
    for path in ("/api/column", "/api/motion", "/api/jobs", "/api/column/toml"):
        answer = client.post(path, content=body)
        assert answer.status_code == 422
        assert answer.json()["error"]


@pytest.mark.parametrize(
    "text",
    [r'"\ud800"', r'"a\udfffb"', "NaN", "-Infinity", "1e999", "1" * 400, "[" * 30 + "]" * 30, r'{"\ud800": 1}'],
)
def test_what_no_file_can_hold_is_refused_before_it_is_kept(client, run_request, text):
    """A job that held it could be shown to nobody, nor could the list that it is in."""
    body = json.dumps(run_request | {"page": {"x": "HERE"}}).replace('"HERE"', text)
    for path in ("/api/column", "/api/motion", "/api/jobs", "/api/assembly"):
        answer = client.post(path, content=body)
        assert answer.status_code == 422, answer.text
        assert answer.json()["error"].startswith("the request ")
    assert client.get("/api/jobs").status_code == 200


def test_a_job_that_an_earlier_page_kept_is_shown_and_can_be_removed(tmp_path):
    """Whatever it holds."""
    for name, title in (("a1", "\ud800"), ("b2", "well")):
        (tmp_path / "jobs" / name).mkdir(parents=True)
        kept = {"id": name, "folder": None, "kind": "run", "title": title, "commands": [["run", title]],
                "asked": {"x": title},
                "state": "done", "created": 1.0, "results": [{"x": float("nan"), "y": title}]}  # fmt: skip
        (tmp_path / "jobs" / name / "job.json").write_text(json.dumps(kept))
    (tmp_path / "jobs" / "c3").mkdir()
    (tmp_path / "jobs" / "c3" / "job.json").write_text(json.dumps(kept | {"id": "c3", "created": "yesterday"}))
    with served(tmp_path) as page:
        assert [job["title"] for job in page.get("/api/jobs").json()["jobs"]] == ["\ud800", "well"]
        assert page.get("/api/jobs/a1").json()["results"] == [{"x": None, "y": "\ud800"}]
        assert page.get("/api/jobs/a1/zip").status_code == 200
        assert page.get("/api/jobs/a1/commands.txt").text == "stylobate run '\\ud800'\n"
        assert "is of an earlier version" in page.post("/api/jobs/a1/again").json()["error"]
        assert page.delete("/api/jobs/a1").status_code == 200
        assert [job["id"] for job in page.get("/api/jobs").json()["jobs"]] == ["b2"]


def half_sent(port, head=b"GET / HTTP/1.1\r\nhost: 127"):
    """A connection with the beginning of a request."""
    line = socket.create_connection(("127.0.0.1", port), 5.0)
    line.sendall(head)
    return line


def test_half_sent_heads_lock_nobody_out(client, monkeypatch):
    """Those that have been silent for longest are cut off where there are too many."""
    monkeypatch.setattr(guard, "SILENT", 20)
    lines = [half_sent(client.base_url.port) for _ in range(50)]
    try:
        with suppress(ConnectionResetError):
            assert lines[0].recv(1) == b""
        with httpx.Client(base_url=client.base_url) as other:
            assert other.get("/api/jobs").status_code == 200
        lines[-1].sendall(b".0.0.1\r\n\r\n")
        assert lines[-1].recv(12) == b"HTTP/1.1 200"
    finally:
        for line in lines:
            line.close()


def test_a_head_has_a_limited_time_and_size(client, monkeypatch):
    monkeypatch.setattr(guard, "PATIENCE", 0.4)
    port, started = client.base_url.port, time.monotonic()
    with half_sent(port) as silent, half_sent(port, b"") as mute, half_sent(port) as slow:
        with suppress(OSError):
            while time.monotonic() - started < 3.0:  # one byte after the other does not make it last
                slow.sendall(b"1")
                time.sleep(0.02)
        assert time.monotonic() - started < 2.0
        assert [connection.recv(1) for connection in (silent, mute)] == [b"", b""]
    with half_sent(port, b"GET / HTTP/1.1\r\nhost: 127.0.0.1\r\nx: " + b"y" * (2 * guard.HEAD)) as large:
        assert large.recv(12) == b"HTTP/1.1 400"
    with half_sent(
        port, b"GET /api/jobs HTTP/1.1\r\nhost: 127.0.0.1\r\n\r\n"
    ) as again:  # the next one on a line as well
        assert again.recv(12) == b"HTTP/1.1 200"
        again.sendall(b"GET /api/jo")
        while again.recv(1000):
            pass
    assert time.monotonic() - started < 4.0


def test_a_body_that_is_none_is_refused_without_a_complaint(client):
    """Whoever reaches the port could fill the terminal of the person who serves the page."""
    heard, logger = [], logging.getLogger("uvicorn.error")
    handler = logging.Handler(logging.ERROR)
    handler.emit = heard.append
    logger.addHandler(handler)
    try:
        for path in (b"/api/records", b"/api/jobs", b"/none"):
            for host in (b"127.0.0.1", b"evil.example"):
                head = b"POST %b HTTP/1.1\r\nhost: %b\r\ntransfer-encoding: chunked\r\n\r\nzz\r\n\r\n" % (path, host)
                with half_sent(client.base_url.port, head) as line:
                    assert line.recv(12) == b"HTTP/1.1 400"
        assert client.get("/api/jobs").status_code == 200
    finally:
        logger.removeHandler(handler)
    assert heard == []


def test_a_body_that_stops_is_given_up(client, home, monkeypatch):
    monkeypatch.setattr(guard, "SILENCE", 0.2)
    head = b"POST /api/records HTTP/1.1\r\nhost: 127.0.0.1\r\ncontent-length: 100\r\n\r\n1 2\n"
    with half_sent(client.base_url.port, head) as line:
        assert line.recv(12) == b"HTTP/1.1 408"
    assert list((home / "records").glob(".*")) == []


def test_thousands_of_drums_are_refused_at_once(client, table):
    table["drum"] = [{"height": 1}] * 20_000
    assert "allowed is up to 1000" in client.post("/api/column", json=table).json()["error"]


def test_many_requests_are_answered(client):
    assert all(client.get("/api/jobs").status_code == 200 for _ in range(300))
