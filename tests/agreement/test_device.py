"""Campaigns on a graphics card: what their rows say, and which finished runs they go on from.

The card is one that has the processor compute: what is tested is who is asked for what, and what is kept of it.
"""

import dataclasses
import json

import pytest

import stylobate as st
from stylobate.campaign.campaign import Campaign
from stylobate.cli.main import call
from stylobate.models import devices
from stylobate.models.drums.stepped import StackEngine
from stylobate.models.engine import engine_for

COLUMN = st.preset("paper-monolithic")
GRID = COLUMN, st.DistinctElement2D(), [1.0, 2.0], [0.5, 4.0], 1.0


@pytest.fixture
def card(monkeypatch):
    """A card that takes all columns of the plane; the numbers of runs that it has made, batch by batch."""
    made = []

    def run(engine, device, cases, options, threads):
        assert device == "the card"
        on_card = [engine_for(engine.model, case.column).on_card(device) for case in cases]
        made.append(sum(on_card))
        for index, measures in engine.run_many(cases, options, threads):
            by = "gpu (a card)" if on_card[index] else "cpu"
            yield index, dataclasses.replace(measures, computed_by=by)

    monkeypatch.setattr(devices, "gpu", lambda: "the card")
    monkeypatch.setattr(StackEngine, "run_on_card", run)
    monkeypatch.setattr(StackEngine, "on_card", lambda engine, device: not engine.structure.links)
    return made


def by(table):
    """What computed the runs of a table."""
    return sorted(set(table["computed_by"]))


def test_rows_say_what_computed_them(card):
    motions = [st.harmonic(frequency=1.0, amplitude=0.5 + 0.5 * i, duration=1.0) for i in range(3)]
    here = st.simulate_many(COLUMN, motions, st.DistinctElement2D())
    there = st.simulate_many(COLUMN, motions, st.DistinctElement2D(), device="gpu")
    assert by(here) == ["cpu"]
    assert by(there) == ["gpu (a card)"]
    assert card == [3]


def test_a_single_run_says_it_too():
    motion = st.harmonic(frequency=1.0, amplitude=0.5, duration=0.5)
    response = st.simulate(COLUMN, motion, st.DistinctElement2D())
    assert response.provenance["computed_by"] == "cpu"
    assert response.summary()["computed_by"] == "cpu"


def test_models_without_kernels_are_computed_by_the_processor_and_it_is_said(card, caplog):
    motions = [st.harmonic(frequency=1.0, amplitude=0.5, duration=1.0)] * 2
    with caplog.at_level("INFO", "stylobate"):
        table = st.simulate_many(COLUMN, motions, st.HousnerBlock(), device="gpu")
    assert by(table) == ["cpu"]
    assert not card
    assert "2 of 2 runs were computed by the processor: the graphics card has no kernel" in caplog.text


def test_finished_runs_of_the_other_kind_are_not_gone_on_from_unless_asked(card, tmp_path):
    ledger = tmp_path / "runs.sqlite"
    for first, second, words in (("cpu", "gpu", "computed by cpu, and `device` is gpu"),
                                 ("gpu", "cpu", r"computed by gpu \(a card\), and `device` is cpu")):  # fmt: skip
        ledger.unlink(missing_ok=True)
        st.collapse_domain(*GRID, device=first, ledger=ledger)
        with pytest.raises(st.InputError, match=words):
            st.collapse_domain(*GRID, device=second, ledger=ledger)
        made = len(card)
        again = st.collapse_domain(*GRID, device=second, ledger=ledger, mix_devices=True)
        assert len(card) == made, "nothing is computed again"
        assert by(again.table) == (["cpu"] if first == "cpu" else ["gpu (a card)"])


def test_what_the_processor_has_computed_for_the_card_is_gone_on_from(card, tmp_path, monkeypatch):
    monkeypatch.setattr(StackEngine, "on_card", lambda engine, device: False)
    first = st.collapse_domain(*GRID, device="gpu", ledger=tmp_path / "runs.sqlite")
    assert by(first.table) == ["cpu"]
    again = st.collapse_domain(*GRID, device="gpu", ledger=tmp_path / "runs.sqlite")
    assert again.table.equals(first.table)


def test_a_study_is_computed_by_the_card_and_resumed_there(card, tmp_path, monkeypatch, capsys):
    (tmp_path / "study.toml").write_text(
        'column = "paper-monolithic"\nmodel = "dem2d"\nfrequencies = "1:2:2"\namplitudes = "0.05g:0.4g:2"\nduration = 1.0\n'
    )
    monkeypatch.chdir(tmp_path)
    assert call(["study", "run", "study.toml", "--out", "out", "--device", "gpu", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["finished"] == 4
    assert call(["study", "run", "study.toml", "--out", "out", "--json"]) == 2
    assert "--mix-devices" in capsys.readouterr().err
    assert call(["study", "run", "study.toml", "--out", "out", "--device", "gpu", "--json"]) == 0
    assert sum(card) == 4


def test_the_card_is_asked_for_before_anything_is_made(tmp_path, monkeypatch, capsys):
    def none():
        raise st.InputError("`device` is gpu, and no NVIDIA card is found.", "device")

    monkeypatch.setattr(devices, "gpu", none)
    out = tmp_path / "out"
    options = ["--model", "dem2d", "--frequencies", "1:2:2", "--amplitudes", "0.1g:0.2g:2", "--out", str(out)]
    assert call(["domain", "paper-monolithic", *options, "--device", "gpu"]) == 2
    assert "--device is gpu, and no NVIDIA card is found" in capsys.readouterr().err
    assert not out.exists()


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"device": "tpu"}, "`device` is 'tpu'"),
        ({"device": "gpu", "dask": "local"}, "`dask` and a `device` of gpu are both given"),
        ({"mix_devices": 1}, "`mix_devices` is 1"),
    ],
)
def test_a_device_that_is_none_is_refused(fields, words):
    with pytest.raises(st.InputError, match=words):
        Campaign(**fields)


def test_one_run_is_not_for_a_card(capsys):
    command = [
        "compare",
        "paper-monolithic",
        "--models",
        "dem2d,housner",
        "--harmonic",
        "1Hz,0.1g,1s",
        "--device",
        "gpu",
    ]
    assert call(command) == 2
    assert "--device is for domains, and one motion is run here" in capsys.readouterr().err
