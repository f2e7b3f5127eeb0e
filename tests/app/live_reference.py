"""The page with its module, and the same runs by the same code compiled for this processor, into a folder: for its tests.

Runs in a process of its own, as ``live.module`` does: for a generic processor and with an empty cache.
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


def motion_of(asked):
    """The motion of a case, as Python makes it."""
    level = asked["amplitude"] * st.g
    if asked["kind"] == "earthquake":
        return earthquake(asked["name"], level)
    return {"sine": sine, "pulse": pulse}[asked["kind"]](asked["frequency"], level)


def advance(room, chunks):
    """Let all lanes go on, whichever runs end on the way: as ``Engine.advance`` of the page does."""
    watch, feed = room.state[WATCH][0], room.state[FEED][0]

    def now():
        return int(feed["step"][watch["status"] == RUNNING].max(initial=0))

    goal, left = now() + 32 * chunks, chunks
    while left > 0:
        step.advance(room.state, left)
        kernel.judge(*room.arguments("judge"))
        if not (watch["status"] == RUNNING).any():
            break
        left = round((goal - now()) / 32)


def run(name, asked, chunks, shown):
    """What the case leaves in the records; words that hold addresses are left out."""
    motion, room = motion_of(asked).multiplied, lanes_of(columns_like(name), MODEL)
    z = motion.z_samples
    room.kept["shown"] = shown
    for lane in range(LANES):
        kernel.begin(
            *room.arguments("begin")[:-7], lane, motion.samples.ctypes.data, 0 if z is None else z.ctypes.data,
            motion.steps - 1, motion.dt, motion.pga, motion.peaks.get("z", 0.0),
        )  # fmt: skip
    advance(room, chunks)
    room.state[FEED]["x"] = room.state[FEED]["z"] = 0
    return {one: np.asarray(room.state[STATE.index(one)]) for one in ("body", "joint", "lane", "feed", "watch")} | {
        "kept": room.kept
    }


def verdicts(name, asked):
    """What Python says of the column and of those like it: outcome, whether it is certain, time of the collapse."""
    own, *others = columns_like(name)
    found = st.simulate(own, motion_of(asked), MODEL, twins=others, until_decided=True, quiet=0.0)
    return [
        [int(one.outcome), one.decided, one.collapse_time if one.outcome == st.Outcome.COLLAPSED else None]
        for one in (found.measures, *found.twins)
    ]


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    write(folder, module())
    cases = []
    for number, (name, asked, chunks, shown) in enumerate(CASES):
        records = run(name, asked, chunks, shown)
        (folder / f"{number}.native").write_bytes(b"".join(one.tobytes() for one in records.values()))
        whole = chunks >= 100_000
        cases.append(
            {
                "column": name, "asked": asked, "chunks": chunks, "shown": shown,
                "verdicts": verdicts(name, asked) if whole else None,
            }
        )  # fmt: skip
    (folder / "cases.json").write_text(json.dumps(cases))
