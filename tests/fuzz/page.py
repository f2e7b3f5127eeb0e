"""Requests and uploads at the page, as a program that means harm would send them: refused or answered, never a failure.

One page is served on the loopback while the tries go on, with a process of jobs that computes nothing. After each try it
still answers, what lies in its folder is what it lists, and nobody without its token has got in.
"""

from __future__ import annotations

import atexit
import contextlib
import functools
import json
import random
import re
import socket
import tempfile
import time
from pathlib import Path
from typing import Any
from urllib.parse import quote

import httpx
from page_server import FAKE, served

from stylobate_page.columns import presets
from stylobate_page.guard import Keys

from . import odd
from .records import originals
from .target import Fault, Target

#: Texts as JSON, at and beyond every edge.
TEXTS = (
    '""', '" "', r'"\ud800"', r'"a\udfffb"', r'"\u0000"', r'"\u001b[31m"', r'"\n"', '"../../x"', '"/etc/passwd"',
    '"--out=x"', '"-x"',
    '"<script>alert(1)</script>"', '"列柱"', '"' + "x" * 5000 + '"', '"sample:el-centro-1940"',
    '"sample:none"', '"1Hz,0.3g,1s"',
    '"1Hz,nang,1s"', '"1Hz,1e999g,1s"', '"1Hz,0.3g,1e9s"', '"1e9Hz,0.3g,9s"', '"?"', '"0.1g:0.2g:3"',
    '"1:2:999999999"', '"inf"',
)  # fmt: skip

#: Values that are none, as JSON.
OTHERS = (
    "null", "true", "0", "-1", "1e308", "1e999", "NaN", "-Infinity", "9" * 400, "5e-324", "[]", "{}", "[[]]",
    '[{"index": 1}]',
    "[" * 500 + "]" * 500, '{"a": ' * 100 + "1" + "}" * 100, "[1, 2]", '{"x": 1, "x": 2}',
)  # fmt: skip

#: Where bodies go, and what else is asked for.
POSTED = ("/api/column", "/api/column/toml", "/api/motion", "/api/assembly", "/api/jobs", "/api/column/file")
ASKED = ("/", "/api/about", "/api/jobs", "/api/records", "/static/main.js", "/api/jobs/{job}", "/api/jobs/{job}/{part}")
PARTS = (
    "film", "cells", "curves", "zip", "commands.txt", "files/job.json", "files/../job.json", "files/%2e%2e/job.json",
    "files/result",
    "files//etc/passwd", "files/column.toml", "files/%00", "cancel", "again", "report", "none", "", "%ed%a0%80", "..%2f..",
)  # fmt: skip

#: Names of uploaded files beside those of column files.
NAMES = (
    "own.csv",
    "a.xml",
    "b.XML",
    "r.mseed",
    ".hidden",
    ".coming-01234567",
    ".0a0a0a0a.json",
    "x" * 400,
    "a/b\\c.csv",
    "con.",
    "%00",
)

_OPTION = re.compile(r"(?<![\w-])--[a-z]")


@functools.cache
def page() -> tuple[httpx.Client, Path]:
    """The page that all tries of this process share, and its folder."""
    stack = contextlib.ExitStack()
    folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
    client = stack.enter_context(served(folder, FAKE, Keys()))
    atexit.register(stack.close)
    return client, folder


def attempt(rng: random.Random, _: Path) -> str:
    """One try of some kind."""
    client, folder = page()
    came = rng.choice((_posted, _posted, _asked, _uploaded, _uploaded, _broken_off, _raw, _stranger, _half_sent))(
        rng, client
    )
    _sound(client, folder)
    return came


def _posted(rng: random.Random, client: httpx.Client) -> str:
    """A body at one of the addresses that take one: right but for a value or two, damaged, or none at all."""
    path = rng.choice(POSTED)
    body = json.dumps(_right(rng, path))
    for _ in range(rng.randint(0, 2)):
        places = list(re.finditer(r'(?<=: )("[^"]*"|[-\d.e]+|null|\[\]|\{\})', body))
        if places:
            place = rng.choice(places)
            body = body[: place.start()] + rng.choice(TEXTS if rng.random() < 0.5 else OTHERS) + body[place.end() :]
    sent = body.encode("utf-8", "surrogatepass")
    if rng.random() < 0.2:
        sent = odd.damaged(rng, sent)
    if rng.random() < 0.05:
        sent = body.encode(rng.choice(("utf-16", "utf-32")), "surrogatepass")
    return f"posted: {_answered(client.post(path, content=sent))}"


def _right(rng: random.Random, path: str) -> dict[str, Any]:
    """What the page itself would send."""
    table = presets()["paper-12-drums"]
    table = table | {"drum": table["drum"][: rng.randint(1, 4)]}
    motion = {
        "kind": rng.choice(("harmonic", "pulse", "sample", "record", "synthetic")),
        "text": "1Hz,0.3g,1s",
        "unit": "g",
        "dt": "0.01s",
    }
    assembly = "[[block]]\nvertices = [[0,0],[1,0],[1,3],[0,3]]\ndensity = 2500\n[joint]\nnormal_stiffness = 5e9\n"
    if path == "/api/motion":
        return {"motion": motion, "column": table}
    if path == "/api/assembly":
        return {"assembly": assembly}
    if path == "/api/jobs":
        kind = rng.choice(("run", "critical", "domain", "ida"))
        job = {
            "kind": kind,
            "column": table,
            "motion": motion,
            "model": "dem2d",
            "settings": {"points": "3"},
            "page": {"x": "y"},
        }
        return job | {
            "frequencies": "1:2:2",
            "amplitudes": "0.1g:0.2g:2",
            "duration": "1s",
            "records": ["sample:el-centro-1940"],
        }
    return table


def _asked(rng: random.Random, client: httpx.Client) -> str:
    """An address, of a job that is there or not."""
    job = client.post(
        "/api/jobs", json=_right(rng, "/api/jobs") | {"motion": {"kind": "harmonic", "text": "1Hz,0.3g,1s"}}
    ).json()
    path = rng.choice(ASKED).format(
        job=rng.choice((job.get("id", "none"), "none", "..%2f..", "%ff")), part=rng.choice(PARTS)
    )
    path += rng.choice(("", "", "?x=%ff&x=", "?token=%ed%a0%80", "?" + "a=1&" * 100))
    method = rng.choice(("GET", "GET", "GET", "POST", "DELETE", "PUT", "HEAD", "OPTIONS"))
    return f"asked: {_answered(client.request(method, path))}"


def _uploaded(rng: random.Random, client: httpx.Client) -> str:
    """A file, damaged or not, of some name, alone or with others; then its motion is asked for."""
    kept = client.get("/api/records").json()["records"]
    where = {}
    for key in ("with", "beside"):
        if rng.random() < 0.3:
            where[key] = rng.choice([*(record["id"] for record in kept[-3:]), "none", "../x", ""])
    name = rng.choice(NAMES) if rng.random() < 0.6 else rng.choice(odd.NAMES).strip('"')
    named = quote(name, errors="replace") if rng.random() < 0.8 else name
    data, options = originals()[rng.choice(sorted(originals()))]
    data = odd.damaged(rng, data) if rng.random() < 0.7 else data
    answer = client.post(
        "/api/records",
        params=where,
        content=data,
        headers={"x-name": re.sub(r"[\x00-\x1f\x7f]", "", named).strip().encode("utf-8", "replace")},
    )
    came = _answered(answer)
    if came == "200":
        motion = {"kind": "record", "text": answer.json()["id"], **options}
        came = _answered(client.post("/api/motion", json={"motion": motion}))
    return f"uploaded: {came}"


def _broken_off(rng: random.Random, client: httpx.Client) -> str:
    """An upload that ends before its announced end."""
    size, given = (
        rng.choice((100, 10_000, 31_000_000, 32_000_001, 10**15)),
        rng.randbytes(rng.choice((0, 1, 90, 9_000))),
    )
    key = f"cookie: stylobate-{client.base_url.port}={client.cookies[f'stylobate-{client.base_url.port}']}\r\n"
    with _line(client) as line:
        _send(
            line,
            f"POST /api/records HTTP/1.1\r\nhost: 127.0.0.1\r\n{key}content-length: {size}\r\n\r\n".encode() + given,
        )
    return "broken off"


def _raw(rng: random.Random, client: httpx.Client) -> str:
    """Bytes that are nearly a request, or far from one."""
    port = client.base_url.port
    key = f"cookie: stylobate-{port}={client.cookies[f'stylobate-{port}']}\r\n" if rng.random() < 0.7 else ""
    path = rng.choice(
        (
            "/",
            "/api/jobs",
            "/api/records",
            "/api/events",
            "*",
            "http://evil/",
            "//evil",
            "/%00",
            "/\xff",
            "/" + "a" * 70_000,
        )
    )
    host = rng.choice(("127.0.0.1", f"localhost:{port}", "evil.example", "", "127.0.0.1\r\nhost: evil"))
    more = rng.choice(("", "transfer-encoding: chunked\r\n", "content-length: -1\r\n",
                       "content-length: 5\r\ncontent-length: 6\r\n",
                       "upgrade: websocket\r\nconnection: upgrade\r\n", "expect: 100-continue\r\n",
                       "x: " + "y" * 90_000 + "\r\n",
                       "origin: null\r\n", "cookie: =;=\r\n", "range: bytes=0-,0-,0-\r\n"))  # fmt: skip
    method = rng.choice(("GET", "POST", "TRACE", "CONNECT", "G\x00T"))
    sent = f"{method} {path} HTTP/1.{rng.choice('019')}\r\nhost: {host}\r\n{key}{more}\r\n".encode("latin-1")
    sent += rng.choice((b"", b"zz\r\n\r\n", b"0\r\n\r\n", b"5\r\nabcde\r\n", rng.randbytes(100)))
    if rng.random() < 0.4:
        sent = odd.damaged(rng, sent)
    with _line(client) as line:
        _send(line, sent)
        line.shutdown(socket.SHUT_WR)
        with contextlib.suppress(OSError):
            reply = line.recv(12)
            if reply[9:12] == b"500":
                raise Fault(f"500 after {sent[:300]!r}")
    return "raw"


def _stranger(rng: random.Random, client: httpx.Client) -> str:
    """Somebody without the token."""
    port, token = client.base_url.port, client.cookies[f"stylobate-{client.base_url.port}"]
    near = rng.choice((token[:-1], token.upper() + "x", token[::-1] + "x", "", "\ud800", token + ".", "é"))
    headers = {"cookie": f"stylobate-{port}={near}".encode("utf-8", "surrogatepass")}
    with httpx.Client(base_url=client.base_url) as other:
        path = rng.choice((*POSTED, "/", "/api/jobs", "/api/records", "/static/main.js"))
        answer = other.request(
            rng.choice(("GET", "POST")), f"{path}?token={quote(near, errors='replace')}", headers=headers
        )
    if answer.status_code != 403:
        raise Fault(f"a stranger got {answer.status_code} from {path} with {near!r}")
    return "stranger: 403"


def _half_sent(rng: random.Random, client: httpx.Client) -> str:
    """Many beginnings of requests at a time."""
    with contextlib.ExitStack() as stack:
        for _ in range(rng.randint(1, 40)):
            _send(stack.enter_context(_line(client)), b"GET / HTTP/1.1\r\nhost: 127.0.0.1\r\n"[: rng.randint(0, 32)])
        with httpx.Client(base_url=client.base_url, cookies=dict(client.cookies), timeout=10.0) as other:
            _answered(other.get("/api/jobs"))
    return "half sent"


def _line(client: httpx.Client) -> socket.socket:
    return socket.create_connection(("127.0.0.1", client.base_url.port or 0), 5.0)


def _send(line: socket.socket, data: bytes) -> None:
    with contextlib.suppress(OSError):  # it may be cut off meanwhile
        line.sendall(data)


def _answered(answer: httpx.Response) -> str:
    """The code of an answer, which is none of a failure; a refusal is one sentence without options of the command line."""
    where = f"{answer.request.method} {answer.request.url}: {answer.status_code} {answer.text[:300]!r}"
    if answer.status_code >= 500:
        raise Fault(where)
    if not answer.content or answer.request.method == "HEAD":
        return str(answer.status_code)
    content = answer.json() if answer.headers["content-type"] == "application/json" else {}
    error = content.get("error") if isinstance(content, dict) else None
    if answer.status_code >= 400 and error is None:
        raise Fault(f"no sentence from {where}")
    if error is not None and ("\n" in error or not error.endswith((".", "?")) or _OPTION.search(error)):
        raise Fault(f"not one sentence of the page: {error[:500]!r} from {where}")
    return str(answer.status_code) if error is None else f"{answer.status_code}, refused"


def _sound(client: httpx.Client, folder: Path) -> None:
    """The page answers, lists what lies in its folder, and is cleared of it now and then."""
    jobs = client.get("/api/jobs").json()["jobs"]
    for _ in range(20):  # what somebody sent without waiting for the answer may come in between
        records = client.get("/api/records").json()["records"]
        kept = [path for path in (folder / "records").rglob("*") if path.is_file() and path.name[0] != "."]
        if len(kept) == sum(record["files"] for record in records):
            break
        time.sleep(0.05)
    else:
        raise Fault(f"{len(kept)} files lie there, {records} are listed")
    if {path.name for path in folder.iterdir()} - {"jobs", "records", "worker.log"}:
        raise Fault(f"there is more in the folder: {sorted(folder.iterdir())}")
    names = [record["name"] for record in records]
    if len(set(names)) != len(names):
        raise Fault(f"two records are called the same: {names}")
    for record in records if len(records) > 8 else ():
        client.delete(f"/api/records/{record['id']}").raise_for_status()
    for job in jobs if len(jobs) > 8 else ():
        client.delete(f"/api/jobs/{job['id']}").raise_for_status()


TARGET = Target("page", 3_000, 40, attempt)
