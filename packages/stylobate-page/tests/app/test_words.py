"""The page speaks of its fields: no sentence that it shows names a parameter or an option of the command line."""

import dataclasses
import json
import re
import threading
import time
import warnings
from pathlib import Path

import pytest
from page_server import HAZARD, RUNS

import stylobate_page
from stylobate.column.links import COLUMN_KINDS
from stylobate.constants import g
from stylobate.errors import InputError, OutOfRangeWarning, check_range
from stylobate_page import worker
from stylobate_page.forms import LABELS, doubted, in_page_words, warned
from stylobate_page.workshop import Job

STATIC = Path(stylobate_page.__file__).parent / "static"
OPTION = re.compile(r"(?<![\w-])--[a-z]")
COMMAND = re.compile(r"\bstylobate [a-z]|command line|same command")


@pytest.mark.parametrize(
    ("sentence", "shown"),
    [
        ("a states no unit: `unit='g'`, or gal.", "a states no unit: “Unit” g, or gal."),
        ("state it: `dt=0.01`.", "state it: “Step” 0.01s."),
        ("`scale` and `pga` are both given.", "“scale” and “Scale to a peak of” are both given."),
        ("give `files`, or several `azimuths`.", "give “Record”, or several “Directions”."),
        ("go on with `tail=5`, or `until_rest`.", "go on with “Tail after the motion” 5s, or “until rest”."),
        ("a drum -- or two--three - is -1 m; <!-- no -->", "a drum -- or two--three - is -1 m; <!-- no -->"),
    ],
)  # fmt: skip
def test_parameters_and_options_become_fields(sentence, shown):
    assert in_page_words(sentence) == shown
    assert in_page_words({"a": [sentence, 1, None]}) == {"a": [shown, 1, None]}


def test_an_error_is_about_a_field_in_its_unit():
    with pytest.raises(InputError) as caught:
        check_range("`pga`", -g, 0.0, 100.0 * g, unit="m/s²")
    assert in_page_words(caught.value) == "“Scale to a peak of” is -1 g; allowed is [0, 100] g."
    with pytest.raises(InputError) as caught:
        check_range("bottom_width", -1.0, 0.0, 2.0, unit="m", of="a drum")
    assert in_page_words(caught.value) == "bottom width of a drum is -1 m; allowed is [0, 2] m."
    assert in_page_words(caught.value, of_text=True) == str(caught.value)


def test_the_scripts_take_the_names_of_fields_from_one_list():
    scripts = "".join(script.read_text(encoding="utf-8") for script in STATIC.glob("*.js"))
    assert {name for name in LABELS if f"labels.{name}" not in scripts} == set()
    assert set(re.findall(r"labels\.(\w+)", scripts)) == set(LABELS)


def test_the_page_itself_names_no_option():
    for path in STATIC.glob("*.*"):
        if path.suffix in (".js", ".html"):
            text = path.read_text(encoding="utf-8")
            assert OPTION.search(text) is None
            assert "command line" not in re.sub(r"(?m)//.*$", "", text)


def test_what_a_job_says_is_in_words_of_the_page(tmp_path):
    job = Job("a", tmp_path, "run", "one", [["run", "--tail=5s"]], {"column": {"name": "--tail"}})
    job.results = [{"certainty": {"sentence": "give `tail=5`"}}]
    contents = job.to_dict()
    assert contents["results"] == [{"certainty": {"sentence": "give “Tail after the motion” 5s"}}]
    assert contents["asked"]["column"]["name"] == "--tail"  # what was typed stays
    assert job.lines() == b"stylobate run --tail=5s\n"


@pytest.mark.parametrize(
    "motion",
    [
        {"kind": "harmonic", "text": "1Hz,abc,4s"},
        {"kind": "pulse", "text": "ricker"},
        {"kind": "synthetic", "text": "nowhere"},
        {"kind": "harmonic", "text": "1Hz,0.3g,4s", "azimuth": "xdeg"},
        {"kind": "harmonic", "text": "1Hz,0.3g,4s", "unit": "g"},
        {"kind": "harmonic", "text": "1Hz,?g,4s"},
        {"kind": "pulse", "text": "ricker,1Hz,0.1g", "across": "1Hz,0.1g,90deg"},
        {"kind": "record"},
    ],
)
def test_no_error_names_an_option(client, motion):
    if motion["kind"] == "record":
        motion = motion | {"text": client.post("/api/records", content=b"0 1\n1 2\n2 3\n3 4\n").json()["id"]}
    error = client.post("/api/motion", json={"motion": motion}).json()["error"]
    assert OPTION.search(error) is None, error


def test_every_request_hears_its_own_warnings():
    """Many threads at once: none misses one of its warnings or hears another's."""
    heard = {}

    def ask(number):
        for _ in range(5):
            with doubted() as doubts:
                warnings.warn(f"doubt {number}", OutOfRangeWarning, stacklevel=1)
                time.sleep(0.001)
                warnings.warn(f"more {number}", OutOfRangeWarning, stacklevel=1)
            heard.setdefault(number, []).append(warned(doubts))

    threads = [threading.Thread(target=ask, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert heard == {number: [[f"doubt {number}", f"more {number}"]] * 5 for number in range(8)}


def lists(name):
    """Lists by name of an object of lists in the form of a column, with the lists that it takes in."""
    text = (STATIC / "column.js").read_text(encoding="utf-8")
    shared = {word: re.findall(r'"(\w+)"', items) for word, items in re.findall(r"\b([A-Z]+) = \[(.*?)\]", text)}
    body = re.search(rf"const {name} = \{{(.*?)\}};", text, re.DOTALL).group(1)
    keys_by_kind = {}
    for kind, items, whole in re.findall(r"(\w+): (?:\[(.*?)\]|([A-Z]+))", body):
        taken = [key for word in re.findall(r"\.\.\.([A-Z]+)", items) for key in shared[word]]
        keys_by_kind[kind] = {*re.findall(r'"(\w+)"', items), *taken, *shared.get(whole, ())}
    return keys_by_kind


def test_the_form_of_a_column_knows_every_kind_of_link_by_what_it_has():
    shown, more = lists("LINKS"), lists("MORE")
    assert {*shown} == {*more} == {*COLUMN_KINDS}
    text = (STATIC / "column.js").read_text(encoding="utf-8")
    words = {*re.findall(r'(\w+): "', re.search(r"const WORDS = \{(.*?)\};", text, re.DOTALL).group(1))}
    for kind, made in COLUMN_KINDS.items():
        fields = {field.name for field in dataclasses.fields(made)} - {"between", "numbers", "name"}
        assert shown[kind] | more[kind] <= fields & words
        assert not shown[kind] & more[kind]


#: Bad input of every kind of job: what it has instead of good input.
ODD = {
    "run": [
        *({"replicates": replicates} for replicates in ("x", "-1", "1e9", "0.5")),
        *({"tail": tail} for tail in ("x", "-1s", "5", "1e9s")),
        *({"model": model} for model in ("hausner", "housner", "")),
        *({"settings": settings} for settings in ({"points": "0"}, {"point": "2"}, {"law": "bed"}, {"losses": "wood"})),
    ],
    "critical": [
        {"first": "0.5g", "last": "0.1g", "step": "0.1g"},
        {"first": "0.1g", "last": "0.5g", "step": "0g"},
        {"first": "x", "last": "0.5g", "step": "0.1g"},
        {"first": "0.1", "last": "0.5", "step": "0.1"},
        {"first": "0.1g", "last": "0.2g", "step": "0.1g"},
    ],
    "domain": [
        {"frequencies": "4:1:5", "amplitudes": "0.1g:0.2g:2", "duration": "1s"},
        {"frequencies": "1:2:2", "amplitudes": "0.1:0.2:2", "duration": "1s"},
        {"frequencies": "1:2:2", "amplitudes": "0.1g:0.2g:2", "duration": "x"},
        {"frequencies": "1:2:2", "amplitudes": "0.1g:0.2g:2", "duration": "-1s"},
    ],
    "ida": [
        {"records": []},
        *({"records": ["sample:el-centro-1940"], "runs": runs} for runs in ("x", "2", "1e9")),
        *({"records": ["sample:el-centro-1940"], "im": measure} for measure in ("x", "d5_95", "sa:x")),
        {"records": ["sample:nowhere"]},
        {"records": ["sample:el-centro-1940", "sample:el-centro-1940"]},
        {"records": ["sample:el-centro-1940"], "unit": "furlong"},
    ],
    "directions": [{"options": {"azimuths": angles}} for angles in ("x", "0:360:13", "0:330", "0:330:0", "0:330:1000000")],
    "compare": [
        *({"options": {"models": models}} for models in ("", "dem2d,dem2d", "dem2d,hausner", "dem2d,housner")),
        {"options": {"models": "dem2d"}, "tail": "x"},
    ],
    "sequence": [
        *({"options": {"repeat": repeats}} for repeats in ("x", "0", "-1", "1000000")),
        *({"options": {"rest": rest}} for rest in ("x", "-1", "1e9")),
        *({"options": {"factors": factors}} for factors in ("x", "1,,2", "-1", "0")),
        {"options": {"factors": "1,2,3"}, "records": ["sample:el-centro-1940", "sample:waipukurau-2018"]},
        {"options": {"unit": "g"}, "records": ["sample:el-centro-1940"]},
        {"options": {"replicates": "x"}},
    ],
    "risk": [
        *({"hazards": {"a.csv": hazard}} for hazard in ("", "x", "im,rate\n1,2\n", HAZARD.replace("pgv_m_s", "pga_g"))),
        *({"table": table} for table in ("", "x", "record,im\na,1\n", RUNS[:80], RUNS.replace("0.4", "x", 1))),
        *({"options": options} for options in ({"im": "x"}, {"im": "pga"}, {"state": "x"}, {"state": "top:0.35d"}, {})),
    ],
    "survival": [{"options": {"im": "pgv", "age": age}} for age in ("x", "-1", "0", "1e9", "")],
    "modes": [
        *({"options": {"number": number}} for number in ("x", "0", "")),
        *({"options": {"measured": mode, "ground": "rigid"}} for mode in ("x", "12Hz", "12s±3%", "1e9Hz±3%", "900Hz±3%")),
        *({"options": {"measured": "12Hz±3%", "ground": ground}} for ground in ("", "x", "vs=200", "vs=1m/s,half_width=4m")),
        {"options": {"ground": "rigid"}},
    ],
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("kind", ODD)
def test_no_job_names_an_option_or_a_command(fresh, run_request, tmp_path, monkeypatch, kind):
    """What the page refuses, and what the process of jobs says of the rest."""
    good = (
        {"table": RUNS, "hazards": {"a.csv": HAZARD}, "options": {"im": "pgv"}} if kind in ("risk", "survival") else {}
    )
    good |= {"motion": run_request["motion"] | {"text": "1Hz,?g,1s"}} if kind == "critical" else {}
    refused = 0
    for change in ODD[kind]:
        answer, messages = fresh.post("/api/jobs", json=run_request | {"kind": kind} | good | change), []
        if answer.status_code == 422:
            messages.append(answer.json()["error"])
        else:
            folder = tmp_path / "jobs" / answer.json()["id"]
            requests = json.loads((folder / "job.json").read_text())["requests"]
            monkeypatch.chdir(folder)
            worker.work({"id": "a", "folder": str(folder)}, requests, lambda log=messages, **what: log.append(what))
            messages = [
                in_page_words(what[key]) for what in messages if "code" in what for key in ("said", "complained")
            ]
        text = str(messages)
        refused += bool(messages)
        assert OPTION.search(text) is None, (change, text)
        assert COMMAND.search(text) is None, (change, text)
        assert "`" not in text, (change, text)
    assert refused
