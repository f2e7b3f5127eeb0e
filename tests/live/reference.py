"""The page with its module, and the same runs by the same code compiled for this processor, into a folder: for its tests.

Runs in a process of its own, as ``live.module`` does: for a generic processor.
"""

import json
import sys
from pathlib import Path

import numpy as np
from live import kernel
from live.__main__ import write
from live.columns import LANES, lanes_of
from live.data import COLUMNS, MODEL, columns_like
from live.module import module
from live.motions import earthquake, pulse, sine

import stylobate as st
from stylobate.kernels.plane import step
from stylobate.kernels.run_codes import RUNNING
from stylobate.kernels.shared.records import FEED, STATE, WATCH

#: Columns, motions as the page asks for them, chunks of steps, and for how long a run is shown after its verdict [s].
CASES = [
    *((name, {"kind": "pulse", "frequency": 0.5, "amplitude": 1.2}, 400, 0.0) for name in COLUMNS),
    ("paper-12-drums", {"kind": "pulse", "frequency": 0.6, "amplitude": 1.5}, 1500, 0.2),
    ("paper-monolithic", {"kind": "pulse", "frequency": 1.0, "amplitude": 0.8}, 100_000, 0.5),
    ("paper-monolithic", {"kind": "earthquake", "name": "ridgecrest-2019", "amplitude": 0.5}, 100_000, 0.0),
    ("olympieion", {"kind": "earthquake", "name": "el-centro-1940", "amplitude": 0.6}, 100_000, 0.0),
]


def motion_of(request):
    """The motion of a case, as Python makes it."""
    level = request["amplitude"] * st.g
    if request["kind"] == "earthquake":
        return earthquake(request["name"], level)
    return {"sine": sine, "pulse": pulse}[request["kind"]](request["frequency"], level)


def advance(room, chunks):
    """Let all lanes go on, whichever runs end on the way: as ``Engine.advance`` of the page does."""
    watch, feed = room.state[WATCH][0], room.state[FEED][0]

    def now():
        return int(feed["step"][watch["status"] == RUNNING].max(initial=0))

    goal, rest = now() + 32 * chunks, chunks
    while rest > 0:
        step.advance(room.state, rest)
        kernel.judge(*room.arguments("judge"))
        if not (watch["status"] == RUNNING).any():
            break
        rest = round((goal - now()) / 32)


def run(name, request, chunks, shown):
    """What the case leaves in the records; words that hold addresses are left out."""
    motion, room = motion_of(request).multiplied, lanes_of(columns_like(name), MODEL)
    z = motion.z_samples
    room.kept["shown"] = shown
    for lane in range(LANES):
        kernel.begin(
            *room.arguments("begin")[:-7], lane, motion.samples.ctypes.data, 0 if z is None else z.ctypes.data,
            motion.steps - 1, motion.dt, motion.pga, motion.peaks.get("z", 0.0),
        )  # fmt: skip
    advance(room, chunks)
    room.state[FEED]["x"] = room.state[FEED]["z"] = 0
    return {item: np.asarray(room.state[STATE.index(item)]) for item in ("body", "joint", "lane", "feed", "watch")} | {
        "kept": room.kept
    }


def verdicts(name, request):
    """What Python says of the column and of those like it: outcome, whether it is certain, time of the collapse."""
    own, *others = columns_like(name)
    result = st.simulate(own, motion_of(request), MODEL, twins=others, until_decided=True, quiet=0.0)
    return [
        [int(item.outcome), item.decided, item.collapse_time if item.outcome == st.Outcome.COLLAPSED else None]
        for item in (result.measures, *result.twins)
    ]


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    write(folder, module())
    cases = []
    for number, (name, request, chunks, shown) in enumerate(CASES):
        records = run(name, request, chunks, shown)
        (folder / f"{number}.native").write_bytes(b"".join(item.tobytes() for item in records.values()))
        whole = chunks >= 100_000
        cases.append(
            {
                "column": name, "request": request, "chunks": chunks, "shown": shown,
                "verdicts": verdicts(name, request) if whole else None,
            }
        )  # fmt: skip
    (folder / "cases.json").write_text(json.dumps(cases))
