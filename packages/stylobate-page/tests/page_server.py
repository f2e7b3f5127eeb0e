"""The page served at a free port of this machine, for its tests; with the process of its jobs, or one that only pretends."""

import sys
import threading
import time
from contextlib import contextmanager
from pathlib import Path

import httpx

from stylobate_page.server import listening_at, server_of
from stylobate_page.site import create_app

#: Processes of jobs: one that computes nothing, and the real one.
FAKE = (sys.executable, str(Path(__file__).parent / "app" / "fake_worker.py"))
REAL = (sys.executable, "-m", "stylobate_page.worker")


@contextmanager
def served(folder, worker=FAKE, keys=None):
    """A client of the page while it is served from a folder; with keys it has visited the address that holds the token."""
    with listening_at("127.0.0.1", 0) as listening:
        server = server_of(create_app(folder, worker, keys=keys))
        thread = threading.Thread(target=server.run, args=([listening],), daemon=True)
        thread.start()
        try:
            with httpx.Client(base_url=f"http://127.0.0.1:{listening.getsockname()[1]}", timeout=30.0) as client:
                if keys is not None:
                    client.get(keys.printed("/")).raise_for_status()
                yield client
        finally:
            server.should_exit = True
            thread.join()


def ended(client, job, limit=15.0):
    """A job when it is over."""
    end = time.monotonic() + limit
    while time.monotonic() < end:
        answer = client.get(f"/api/jobs/{job}").json()
        if answer["state"] not in ("waiting", "running"):
            return answer
        time.sleep(0.02)
    raise AssertionError(answer)


#: Ratio of the luminances of text and what is behind it, at least (WCAG 2.2, AA): of text, and of large text; and what tells
#: what of a page is fainter.
AA, AA_LARGE = 4.5, 3.0
FAINT = (Path(__file__).parent / "app" / "contrast.js").read_text(encoding="utf-8")

#: A hazard curve, and runs of ten records, one stronger than the other.
HAZARD = "pgv_m_s,annual_rate\n0.01,1.0\n0.1,0.02\n1,2e-4\n10,1e-6\n"
RUNS = "record,im,collapsed\n" + "".join(
    f"r{k},{x},{int(x > 0.5 + 0.05 * k)}\n" for k in range(10) for x in (0.4, 0.8, 1.2)
)


def until(holds, limit=15.0):
    """Wait until something holds."""
    end = time.monotonic() + limit
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.05)
