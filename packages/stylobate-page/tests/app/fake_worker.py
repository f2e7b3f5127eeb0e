"""A process of jobs that computes nothing: what the model of a job says decides what becomes of it."""

import json
import os
import pathlib
import signal
import sys
import time
from functools import partial


def said_late(job, *_):
    print(json.dumps({"id": job, "number": 0, "code": 130, "said": "", "complained": ["interrupted"]}), flush=True)
    time.sleep(0.4)
    os._exit(130)


print(json.dumps({"ready": True}), flush=True)
for line in sys.stdin:
    job = json.loads(line)
    requests = json.loads((pathlib.Path(job["folder"]) / "job.json").read_text())["requests"]
    how = requests[0].get("model", "")
    gone = pathlib.Path(job["folder"]).parents[1] / "gone"
    if how == "gone" and gone.read_text():  # as if it had been killed while it had nothing to do
        gone.write_text(gone.read_text()[1:])
        os.kill(os.getpid(), signal.SIGKILL)
    print(json.dumps({"id": job["id"], "begun": True}), flush=True)
    os.chdir(job["folder"])
    study = pathlib.Path(job["folder"]) / "study.toml"
    if study.is_file():
        how = study.read_text().partition('model = "')[2].partition('"')[0]
    result = pathlib.Path(job["folder"]) / "result"
    result.mkdir(exist_ok=True)
    (result / "made.txt").write_text("kept")
    if how == "late":  # told to stop, it says so at once, and ends a little later
        signal.signal(signal.SIGTERM, partial(said_late, job["id"]))
    print("no line of ours", flush=True)
    for k in range(3):
        print(json.dumps({"id": job["id"], "progress": [k, 3], "what": "cells"}), flush=True)
    if how in ("slow", "late"):
        time.sleep(30)
    if how == "dies":
        os._exit(7)
    code = 2 if how == "refused" else 0
    complained = ["warning: a doubt", "the model is 'refused'; allowed is another."] if code else ["warning: a doubt"]
    answer = {"id": job["id"], "number": 0, "code": code, "said": '{"outcome": "rocked"}', "complained": complained}
    answer |= {"field": "model" if code else None}
    print(json.dumps(answer), flush=True)
    if not code:
        print(json.dumps({"id": job["id"], "done": True}), flush=True)
