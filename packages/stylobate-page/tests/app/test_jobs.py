"""Jobs: one at a time, a visible queue, cancelled, killed, done again, kept over a restart."""

import io
import os
import signal
import time
import zipfile
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import pytest
from page_server import ended, served

from stylobate_page import worker


def test_a_job_is_done_and_its_files_are_listed(fresh, run_request):
    made = fresh.post("/api/jobs", json=run_request)
    assert made.status_code == 201
    job = ended(fresh, made.json()["id"])
    assert (job["state"], job["warnings"], job["results"]) == ("done", ["a doubt"], [{"outcome": "rocked"}])
    assert job["files"] == ["column.toml", "result/made.txt"]
    assert job["commands"] == [
        "stylobate run column.toml --model=dem2d --harmonic=1Hz,0.3g,2s --no-pictures --out=result"
    ]


def test_what_the_command_refuses_is_said_in_its_words(fresh, run_request):
    job = ended(fresh, fresh.post("/api/jobs", json=run_request | {"model": "refused"}).json()["id"])
    assert (job["state"], job["sentence"]) == ("refused", "the model is 'refused'; allowed is another.")
    assert job["field"] == "model"


def test_ten_jobs_wait_in_a_row_and_can_be_cancelled(fresh, run_request):
    jobs = [fresh.post("/api/jobs", json=run_request | {"model": "slow"}).json() for _ in range(10)]
    end = time.monotonic() + 10.0
    while (listing := fresh.get("/api/jobs").json()["jobs"])[0]["state"] != "running" and time.monotonic() < end:
        time.sleep(0.02)
    assert [job["state"] for job in listing] == ["running"] + ["waiting"] * 9
    assert [job["place"] for job in listing] == list(range(10))
    for job in reversed(jobs):
        assert fresh.post(f"/api/jobs/{job['id']}/cancel").status_code == 200
    assert {ended(fresh, job["id"])["state"] for job in jobs} == {"cancelled"}
    after = ended(fresh, fresh.post("/api/jobs", json=run_request).json()["id"])  # a new process has taken over
    assert after["state"] == "done"


def test_the_field_of_an_error_comes_from_the_process_of_jobs(tmp_path, monkeypatch):
    messages = []
    monkeypatch.chdir(tmp_path)
    for more in (
        {"tail": "-1s"}, {"harmonic": "1Hz,0.3g,-1s"}, {"model": "hausner"}, {"taill": "1s"}, {"column": None},
        {"replicates": "0"},
    ):  # fmt: skip
        request = {"command": "run", "column": "paper-monolithic", "model": "housner", "harmonic": "1Hz,0.01g,0.1s"}
        worker.work({"id": "a", "folder": str(tmp_path)}, [request | more], lambda **what: messages.append(what))
    assert [message["field"] for message in messages if "code" in message] == [
        "tail",
        "duration",
        "model",
        "taill",
        "column",
        None,
    ]


def test_more_jobs_than_can_wait_are_refused(fresh, run_request, monkeypatch):
    monkeypatch.setattr("stylobate_page.workshop.WAIT", 2)
    codes = [fresh.post("/api/jobs", json=run_request | {"model": "slow"}).status_code for _ in range(6)]
    assert 422 in codes
    assert codes[:2] == [201, 201]


@pytest.mark.parametrize("how", ["dies", "slow"])
def test_a_killed_process_costs_one_sentence(fresh, run_request, how, tmp_path):
    job = fresh.post("/api/jobs", json=run_request | {"model": how}).json()["id"]
    if how == "slow":
        end = time.monotonic() + 10.0
        while fresh.get(f"/api/jobs/{job}").json()["total"] == 0 and time.monotonic() < end:
            time.sleep(0.02)
        for process in workers_of(tmp_path):
            os.kill(process, signal.SIGKILL)
    outcome = ended(fresh, job)
    assert outcome["state"] == "failed"
    assert outcome["sentence"].startswith("The process that computes ended before the job was done")
    assert outcome["files"] == ["column.toml", "result/made.txt"]  # what was finished is kept
    assert ended(fresh, fresh.post("/api/jobs", json=run_request).json()["id"])["state"] == "done"


@pytest.mark.parametrize(("times", "state"), [(1, "done"), (2, "failed")])
def test_a_job_that_its_process_never_took_goes_to_the_next(fresh, run_request, tmp_path, times, state):
    """Once: what ends two processes would end the third."""
    (tmp_path / "gone").write_text("." * times)
    job = ended(fresh, fresh.post("/api/jobs", json=run_request | {"model": "gone"}).json()["id"])
    assert job["state"] == state, job["sentence"]


def test_jobs_of_a_page_in_a_relative_folder_are_done_one_after_another(tmp_path, run_request, monkeypatch):
    """The process of jobs works in the folder of each, from which the next must be reached as well."""
    monkeypatch.chdir(tmp_path)
    with served(Path("store")) as page:
        jobs = [ended(page, page.post("/api/jobs", json=run_request).json()["id"]) for _ in range(3)]
        assert [job["state"] for job in jobs] == ["done"] * 3


def workers_of(folder):
    """The processes whose log lies in a folder: that which does jobs, and the one that stands by."""
    log, processes = os.path.realpath(folder / "worker.log"), set()
    for process in filter(str.isdecimal, os.listdir("/proc") if os.path.isdir("/proc") else ()):
        with suppress(OSError):
            if os.readlink(f"/proc/{process}/fd/2") == log:
                processes.add(int(process))
    if not processes:
        pytest.skip("this system does not say which process writes a file")
    return processes


def test_a_job_is_done_again_and_deleted(fresh, run_request, tmp_path):
    job = fresh.post("/api/jobs", json=run_request).json()["id"]
    ended(fresh, job)
    assert fresh.post(f"/api/jobs/{job}/again").status_code == 200
    assert ended(fresh, job)["results"] == [{"outcome": "rocked"}]
    assert fresh.delete(f"/api/jobs/{job}").status_code == 200
    assert fresh.get(f"/api/jobs/{job}").status_code == 404
    assert list((tmp_path / "jobs").iterdir()) == []


def test_jobs_are_there_after_a_restart(tmp_path, run_request):
    with served(tmp_path) as first:
        done = first.post("/api/jobs", json=run_request).json()["id"]
        ended(first, done)
        slow = first.post("/api/jobs", json=run_request | {"model": "slow"}).json()["id"]
    with served(tmp_path) as second:
        jobs = {job["id"]: job for job in second.get("/api/jobs").json()["jobs"]}
        assert jobs[done]["state"] == "done"
        assert second.get(f"/api/jobs/{done}").json()["results"] == [{"outcome": "rocked"}]
        assert jobs[slow]["state"] in ("cancelled", "failed")


def test_the_end_of_a_job_is_the_last_word(tmp_path, run_request, monkeypatch):
    """A job that ends while its beginning is still being written is kept as ended."""
    from stylobate_page.workshop import Job

    with served(tmp_path) as page:
        written = Job.save

        def late(job):
            begun = job.state == "waiting"
            if begun:
                copy = replace(job)
                time.sleep(0.3)
                return written(copy)
            return written(job)

        monkeypatch.setattr(Job, "save", late)
        done = page.post("/api/jobs", json=run_request).json()["id"]
        ended(page, done)
    assert Job.load(tmp_path / "jobs" / done).state == "done"


def test_a_domain_is_a_study_file(fresh, run_request, tmp_path):
    """What is kept of a domain is what the command line takes, and says the same."""
    from stylobate.campaign.grid import read_grid

    grid = {"frequencies": "0.5:2:4", "amplitudes": "0.1g:0.4g:3", "duration": "3s", "tail": "1s"}
    domain = run_request | {"kind": "domain", "motion": None, "settings": {"points": "3"}} | grid
    job = fresh.post("/api/jobs", json=domain).json()
    assert job["commands"] == ["stylobate domain study.toml --out=result"]
    study = read_grid(tmp_path / "jobs" / job["id"] / "study.toml")
    assert (study.frequencies.tolist(), study.duration, study.tail) == ([0.5, 1.0, 1.5, 2.0], 3.0, 1.0)
    assert (study.column.n, study.model.name, study.model.parameters()["points"]) == (3, "dem2d", 3)
    for wrong, field in (
        ({"duration": "long"}, "duration"),
        ({"frequencies": "4:1:5"}, "frequencies"),
        ({"amplitudes": "0.1:0.4:3"}, "amplitudes"),
        ({"frequencies": "0.5:2:9000"}, "frequencies.number"),
    ):
        answer = fresh.post("/api/jobs", json=domain | wrong)
        assert (answer.status_code, answer.json()["field"]) == (422, field), answer.json()
    assert "no frequencies" in fresh.post("/api/jobs", json=domain | {"frequencies": None}).json()["error"]


def test_a_run_is_done_before_a_map_that_pauses_for_it(fresh, run_request):
    grid = {"frequencies": "0.5:2:4", "amplitudes": "0.1g:0.4g:3", "motion": None, "kind": "domain"}
    maps = [fresh.post("/api/jobs", json=run_request | grid | {"model": "slow"}).json()["id"] for _ in range(2)]
    end = time.monotonic() + 10.0
    while fresh.get(f"/api/jobs/{maps[0]}").json()["total"] == 0 and time.monotonic() < end:
        time.sleep(0.02)
    runs = [fresh.post("/api/jobs", json=run_request).json()["id"] for _ in range(2)]
    assert [ended(fresh, run_id)["state"] for run_id in runs] == ["done", "done"]
    while fresh.get(f"/api/jobs/{maps[0]}").json()["state"] != "running" and time.monotonic() < end:
        time.sleep(0.02)
    assert [fresh.get(f"/api/jobs/{map_id}").json()["state"] for map_id in maps] == ["running", "waiting"]
    for map_id in maps:
        fresh.post(f"/api/jobs/{map_id}/cancel")
    assert {ended(fresh, map_id)["state"] for map_id in maps} == {"cancelled"}


def test_a_run_is_not_given_to_a_process_that_is_ending(fresh, run_request):
    """It has said that the map is interrupted, and is gone a little later."""
    grid = {"frequencies": "0.5:2:4", "amplitudes": "0.1g:0.4g:3", "motion": None, "kind": "domain"}
    late = fresh.post("/api/jobs", json=run_request | grid | {"model": "late"}).json()["id"]
    end = time.monotonic() + 10.0
    while fresh.get(f"/api/jobs/{late}").json()["total"] == 0 and time.monotonic() < end:
        time.sleep(0.02)
    run = fresh.post("/api/jobs", json=run_request).json()["id"]
    assert ended(fresh, run)["state"] == "done"
    fresh.post(f"/api/jobs/{late}/cancel")


def test_a_report_is_a_job_on_copies(fresh, run_request, tmp_path):
    job = fresh.post("/api/jobs", json=run_request).json()["id"]
    ended(fresh, job)
    made = fresh.post(f"/api/jobs/{job}/report").json()
    assert made["commands"] == ["stylobate report result --out=report.html"]
    fresh.delete(f"/api/jobs/{job}")
    assert (tmp_path / "jobs" / made["id"] / "result" / "made.txt").read_text() == "kept"
    slow = fresh.post("/api/jobs", json=run_request | {"model": "slow"}).json()["id"]
    assert "not over" in fresh.post(f"/api/jobs/{slow}/report").json()["error"]


def test_few_records_give_the_analysis_alone(fresh, run_request):
    few = run_request | {"kind": "ida", "motion": None, "records": [f"sample:{k}" for k in range(9)], "im": "pga"}
    assert len(fresh.post("/api/jobs", json=few).json()["commands"]) == 1
    many = fresh.post("/api/jobs", json=few | {"records": [f"sample:{k}" for k in range(10)], "state": "collapse"})
    assert many.json()["commands"][1] == "stylobate fragility result --state=collapse --out=fragility"


def test_a_run_needs_a_motion_and_a_fragility_records(fresh, run_request):
    assert "no motion" in fresh.post("/api/jobs", json=run_request | {"motion": None}).json()["error"]
    assert "no record" in fresh.post("/api/jobs", json=run_request | {"kind": "ida", "motion": None}).json()["error"]
    answer = fresh.post("/api/jobs", json=run_request | {"column": run_request["column"] | {"gravity": -1}})
    assert answer.json()["field"] == "gravity"


def test_a_job_has_copies_of_its_records(fresh, run_request, tmp_path):
    kept = fresh.post("/api/records", content=b"time_s,ax_g\n0,0.1\n0.01,0.2\n", headers={"x-name": "a.csv"}).json()
    job = fresh.post("/api/jobs", json=run_request | {"motion": {"kind": "record", "text": kept["id"]}}).json()
    fresh.delete(f"/api/records/{kept['id']}")
    name = f"records/{kept['id']}/a-{kept['id']}.csv"
    assert f"--motion={name}" in job["commands"][0]
    assert name in ended(fresh, job["id"])["files"]
    assert "a.csv" in job["title"]


def test_all_files_of_a_job_come_in_one(fresh, run_request):
    """What a job took and made, with its command line; no file of the page's own, and no name that leads elsewhere."""
    run_request["column"]["name"] = "../../evil <b>"
    job = ended(fresh, fresh.post("/api/jobs", json=run_request).json()["id"])
    answer = fresh.get(f"/api/jobs/{job['id']}/zip")
    assert answer.headers["content-disposition"] == f'attachment; filename="stylobate-run-{job["id"]}.zip"'
    with zipfile.ZipFile(io.BytesIO(answer.content)) as packed:
        assert packed.testzip() is None
        names = [f"{job['id']}/{file}" for file in ("commands.txt", "column.toml", "result/made.txt")]
        assert packed.namelist() == names
        assert packed.read(names[0]).decode() == job["commands"][0] + "\n"
        assert packed.read(names[2]) == b"kept"
    assert fresh.get("/api/jobs/none/zip").status_code == 404


def test_the_process_says_that_it_is_ready(fresh):
    """Before its first job: whoever opens the page sees when it may be asked."""
    end = time.monotonic() + 10.0
    with fresh.stream("GET", "/api/events") as stream:
        for line in stream.iter_lines():
            if line == "data: true":
                return
            assert time.monotonic() < end, line


def test_a_run_takes_over_a_process_that_stands_by(fresh, run_request, tmp_path):
    """The map that pauses leaves, and the run does not wait for another process to load its libraries."""
    grid = {"frequencies": "0.5:2:4", "amplitudes": "0.1g:0.4g:3", "motion": None, "kind": "domain"}
    slow = fresh.post("/api/jobs", json=run_request | grid | {"model": "slow"}).json()["id"]
    end = time.monotonic() + 10.0
    while fresh.get(f"/api/jobs/{slow}").json()["total"] == 0 and time.monotonic() < end:
        time.sleep(0.02)
    both = workers_of(tmp_path)
    assert len(both) == 2
    run = fresh.post("/api/jobs", json=run_request).json()["id"]
    assert ended(fresh, run)["state"] == "done"
    assert len(both & workers_of(tmp_path)) == 1
    fresh.post(f"/api/jobs/{slow}/cancel")


def test_files_that_come_together_are_one_record(fresh, run_request):
    """Components in files of their own; a description of the station goes with the records that it came together with."""
    first = fresh.post("/api/records", content=b"1 2\n", headers={"x-name": "a.at2"}).json()
    both = fresh.post(f"/api/records?with={first['id']}", content=b"3 4\n", headers={"x-name": "b.at2"}).json()
    assert (both["id"], both["name"], both["files"]) == (first["id"], "a.at2, b.at2", 2)
    fresh.post(f"/api/records?beside={first['id']}", content=b"<xml/>", headers={"x-name": "station.xml"})
    fresh.post("/api/records", content=b"<xml/>", headers={"x-name": "of-others.xml"})
    job = fresh.post("/api/jobs", json=run_request | {"motion": {"kind": "record", "text": both["id"]}}).json()
    assert job["commands"][0].count("--motion=records/") == 2
    suffixes = [name.rpartition(".")[2] for name in ended(fresh, job["id"])["files"] if name.startswith("records/")]
    assert sorted(suffixes) == ["at2", "at2", "xml"]
    several = run_request | {"kind": "ida", "motion": None, "records": [both["id"]]}
    assert "one file for each record" in fresh.post("/api/jobs", json=several).json()["error"]
    gone = fresh.post("/api/records?with=none", content=b"5 6\n")
    assert (gone.status_code, "upload it again" in gone.json()["error"]) == (422, True)
    assert fresh.delete(f"/api/records/{both['id']}").status_code == 200
    assert len(fresh.get("/api/records").json()["records"]) == 2


def test_what_the_page_asks_is_refused_without_a_failure_that_a_browser_notes(client, run_request):
    wrong = run_request | {"column": None}
    plain, marked = (client.post("/api/jobs", json=wrong, headers=given) for given in ({}, {"x-page": "yes"}))
    assert (plain.status_code, marked.status_code, marked.headers["x-refused"]) == (422, 200, "yes")
    assert plain.json() == marked.json()
    assert "x-refused" not in client.post("/api/jobs", json=run_request, headers={"x-page": "yes"}).headers
