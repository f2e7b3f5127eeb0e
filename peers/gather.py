"""All engines on all cases, a few processes at a time, into ``results.json``, from which the page on other codes is written.

Called by ``make peers`` with the Python of stylobate; the other engines run with the one of ``.venv-peers``. With the
name of an engine as its argument only that one runs, and what is stored of the others stays.
"""

import hashlib
import json
import os
import platform
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from datetime import date
from pathlib import Path

HERE = Path(__file__).parent
RESULTS = HERE / "results.json"
OTHERS = HERE.parent / ".venv-peers" / "bin" / "python"

#: Parts of each variant: plane cases, round drums, passes nearly in a plane, facets of a round column (0: truly round).
PARTS = {
    ("stylobate", "stylobate"): ("plane", "drums", "passes", "0"),
    ("stylobate", "stylobate, β = 10⁻⁴ s"): ("plane", "passes", "0"),
    ("stylobate", "stylobate, β = 10⁻³ s"): ("passes",),
    ("stylobate", "stylobate, losses of stone"): ("plane", "passes", "0"),
    ("stylobate", "stylobate, rigid beam"): ("plane",),
    ("mujoco", "MuJoCo, stiff contact"): ("plane", "drums", "passes", "0", "12", "16", "24", "48"),
    ("mujoco", "MuJoCo, default contact"): ("plane", "drums", "passes", "0"),
    ("mujoco", "MuJoCo, sharp contact"): ("passes",),
    ("mujoco", "MuJoCo, ringing contact"): ("passes",),
    ("pybullet", "PyBullet"): ("plane", "drums", "passes", "0", "24"),
    ("pybullet", "PyBullet, short steps"): ("passes",),
    ("lmgc90", "LMGC90"): ("plane", "12", "16", "24", "48"),
}

#: Processes at a time.
WORKERS = 4

#: Longest time of a part [s].
LIMIT = 1500


def parts_folder(name: str) -> Path:
    """Where an engine's finished parts are kept, so that a call that was stopped goes on; another one for other code."""
    sources = [HERE / f"{stem}.py" for stem in (f"engine_{name}", "measures", "run", "scenes")]
    if name == "stylobate":
        sources += sorted((HERE.parent / "src").rglob("*.py"))
    else:
        sources.append(HERE.parent / "requirements" / "peers.lock")
    digest = hashlib.sha256(b"".join(file.read_bytes() for file in sources)).hexdigest()[:12]
    folder = HERE.parent / "build" / "peers" / digest
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def run_part(job: tuple[str, str, str]) -> tuple[tuple[str, str, str], dict]:
    """Run a part, or take it if it is there; what went wrong is a result."""
    name, variant, part = job
    began = time.perf_counter()
    fingerprint = hashlib.sha256(variant.encode()).hexdigest()[:6]
    file = parts_folder(name) / f"{name}-{fingerprint}-{part}.json"
    ended = [""]
    if not file.exists():
        python = sys.executable if name == "stylobate" else str(OTHERS)
        settings = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": str(HERE)}
        with tempfile.TemporaryDirectory() as folder:
            try:
                done = subprocess.run(
                    [python, str(HERE / "run.py"), name, variant, part, str(file)],
                    capture_output=True, cwd=folder, env=settings, timeout=LIMIT, check=False,
                )  # fmt: skip
                ended = (done.stderr + done.stdout).decode(errors="replace").split("\n")
            except subprocess.TimeoutExpired:
                ended = [f"not ready within {LIMIT} s"]
    seen = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {"failed": reason(ended)}
    print(f"{variant}, {part}: {seen.get('failed', 'done')} ({time.perf_counter() - began:.0f} s)", flush=True)
    return job, seen


def reason(lines: list[str]) -> str:
    """The line that says best why a process ended."""
    plain = [" ".join(line.replace("\0", " ").split()) for line in lines]
    complaints = [line for line in plain if "rror" in line or "ready" in line or "reach" in line or "rich" in line]
    return (complaints or [line for line in plain if line] or ["ended without a word"])[-1][:160]


def main(*names: str) -> None:
    selection = {which: parts for which, parts in PARTS.items() if not names or which[0] in names}
    jobs = [(name, variant, part) for (name, variant), parts in selection.items() for part in parts]
    jobs.sort(key=lambda job: (job[0] != "lmgc90", job[2] != "plane"))  # the longest first
    stored = json.loads(RESULTS.read_text(encoding="utf-8"))["engines"] if names else {}
    table: dict = {
        variant: {"engine": name, "parts": {}} if (name, variant) in selection else stored[variant]
        for name, variant in PARTS
    }
    with ThreadPoolExecutor(WORKERS) as pool:
        for (_, variant, part), seen in pool.map(run_part, jobs):
            entry = table[variant]
            if "found" in seen:
                entry |= {"version": seen["version"], "settings": seen["settings"]}
                entry["parts"][part] = seen["found"]
            else:
                entry["parts"][part] = {"failed": seen["failed"]}
    machine = f"{platform.machine()}, {platform.system()}, Python {platform.python_version()}"
    result = {"date": date.today().isoformat(), "machine": machine, "engines": table}
    fresh = RESULTS.with_suffix(".new")
    fresh.write_text(json.dumps(result, ensure_ascii=False, indent=1) + "\n", encoding="utf-8")
    fresh.replace(RESULTS)


if __name__ == "__main__":
    main(*sys.argv[1:])
