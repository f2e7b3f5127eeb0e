"""Uploaded records: there after a restart, each with its own name and its own station, within the limits."""

import io
import json
import os
import threading
import warnings
from urllib.parse import quote

import numpy as np
import pytest
from page_server import ended, served

from stylobate_page import records as kept_records

LINES = b"time_s,ax_g\n0,0.1\n0.01,0.2\n0.02,0.1\n0.03,0.2\n"


def put(page, name, content=LINES, **where):
    answer = page.post("/api/records", params=where, content=content, headers={"x-name": quote(name)})
    assert answer.status_code == 200, answer.text
    return answer.json()


def listed(page):
    return page.get("/api/records").json()["records"]


def test_records_are_there_after_a_restart(tmp_path, run_request):
    with served(tmp_path) as first:
        own = put(first, "own.csv")
        two = put(first, "é <b>.csv")
        put(first, "second.csv", **{"with": two["id"]})
        before = listed(first)
    with served(tmp_path) as second:
        assert listed(second) == before
        assert [record["files"] for record in before] == [1, 2]
        job = second.post("/api/jobs", json=run_request | {"motion": {"kind": "record", "text": own["id"]}})
        assert job.status_code == 201
        for record in before:
            second.delete(f"/api/records/{record['id']}")
    assert list((tmp_path / "records").iterdir()) == []


def test_files_without_a_note_count_and_can_be_removed(tmp_path):
    """As an earlier version kept them, as a kill may leave them, and what it had not received to its end."""
    place = tmp_path / "records"
    (place / "0a0a0a0a").mkdir(parents=True)
    (place / "own-01234567.csv").write_bytes(LINES)
    (place / "0a0a0a0a" / "other-0a0a0a0a.csv").write_bytes(LINES)
    (place / "0a0a0a0a" / ".0a0a0a0a.json").write_text("{damaged")
    (place / ".coming-89abcdef").write_bytes(b"half")
    with served(tmp_path) as page:
        records = {record["id"]: (record["name"], record["size"]) for record in listed(page)}
        assert records == {"01234567": ("own.csv", len(LINES)), "0a0a0a0a": ("other.csv", len(LINES))}
        assert page.post("/api/motion", json={"motion": {"kind": "record", "text": "01234567"}}).json()["duration"] > 0
        for record_id in records:
            page.delete(f"/api/records/{record_id}")
    assert [path.name for path in place.rglob("*")] == []


def test_a_note_names_no_file_elsewhere(tmp_path):
    place = tmp_path / "records" / "0a0a0a0a"
    place.mkdir(parents=True)
    (tmp_path / "secret.csv").write_bytes(LINES)
    (place / "x-0a0a0a0a.csv").symlink_to(tmp_path / "secret.csv")
    note = {"name": "a", "files": ["../../secret.csv"]}
    (place / ".0a0a0a0a.json").write_text(json.dumps(note))
    with served(tmp_path) as page:
        assert listed(page) == []


def test_what_is_uploaded_twice_has_two_names(fresh):
    names = [put(fresh, "own.csv")["name"] for _ in range(3)] + [put(fresh, "plain")["name"] for _ in range(2)]
    assert names == ["own.csv", "own (2).csv", "own (3).csv", "plain", "plain (2)"]
    assert len({record["name"] for record in listed(fresh)}) == 5


def mseed():
    """Some seconds of counts of a station."""
    obspy = pytest.importorskip("obspy")
    counts = np.round(1e5 * np.sin(np.arange(900) * 0.05)).astype(np.int32)
    trace = obspy.Trace(counts, {"network": "XX", "station": "ABC", "channel": "HNE", "sampling_rate": 100.0})
    data = io.BytesIO()
    obspy.Stream([trace]).write(data, format="MSEED", encoding="STEIM2", reclen=512)
    return data.getvalue()


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_station_is_described_by_what_came_with_its_record(fresh, run_request):
    """Neither a broken description of another person's makes a record unreadable, nor a wrong one changes its size."""
    from fuzz.records import STATION

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        data = mseed()
    put(fresh, "a.xml", b'<FDSNStationXML xmlns="http://www.fdsn.org/xml/station/1"><broken')
    put(fresh, "b.xml", STATION.replace("100000", "1").encode())
    own = put(fresh, "own.mseed", data)
    put(fresh, "station.xml", STATION.encode(), beside=own["id"])
    asked_for = {"motion": {"kind": "record", "text": own["id"]}}
    answer = fresh.post("/api/motion", json=asked_for).json()
    # 1 m/s², less the mean of a sine that is not whole, a hundredth; b.xml would make it a hundred thousand times that
    assert answer["summary"]["pga_g"]["x"] == pytest.approx(1.0 / 9.80665, rel=0.02)
    job = fresh.post("/api/jobs", json=run_request | asked_for).json()
    copied = [name.rpartition(".")[2] for name in ended(fresh, job["id"])["files"] if name.startswith("records/")]
    assert sorted(copied) == ["mseed", "xml"]
    alone = put(fresh, "alone.mseed", data)
    refused = fresh.post("/api/motion", json={"motion": {"kind": "record", "text": alone["id"]}}).json()
    assert "put the station's StationXML beside the file" in refused["error"]


def test_open_uploads_are_no_kept_records(tmp_path, monkeypatch):
    """They count with what has come in of them, and what is said tells the two apart."""
    monkeypatch.setattr(kept_records, "ALL", 1000)
    monkeypatch.setattr(kept_records, "COMING", 3)
    with served(tmp_path) as page:
        go_on = threading.Event()

        def slow():
            yield b"1 2\n"
            go_on.wait(10.0)
            yield b"3 4\n"

        answers = []
        open_ones = [
            threading.Thread(target=lambda: answers.append(page.post("/api/records", content=slow()).status_code))
            for _ in range(3)
        ]
        for thread in open_ones:
            thread.start()
        for _ in range(500):
            if len(list((tmp_path / "records").glob(".coming-*"))) == 3:
                break
            threading.Event().wait(0.01)
        fourth = page.post("/api/records", content=LINES)
        assert fourth.status_code == 422
        assert fourth.json()["error"] == "3 files are coming in at this moment; send this one after them."
        go_on.set()
        for thread in open_ones:
            thread.join()
        assert answers == [200] * 3
        put(page, "own.csv", b"1" * 900)
        full = page.post("/api/records", content=b"1" * 200).json()["error"]
        assert full == "there is no room for the file: 4 records are kept, with 0.000924 of 0.001 MB; remove some."
        assert os.listdir(tmp_path / "records") != []
        assert len(listed(page)) == 4
