"""``stylobate experiments`` on small folders made here: what it writes and says, bad input, going on where it stopped."""

import csv
import json

import numpy as np
import pytest

from stylobate.cli.main import call
from stylobate_studies.experiments import cube, study
from stylobate_studies.experiments.choices import CUBE_FRICTION, CUBE_RESTITUTION
from stylobate_studies.experiments.cube_files import HALF, Recorded

KEYS = {"tests", "accuracy", "hard_tests", "hard_accuracy", "matthews", "predicted_over_observed", "brier"}
DT = 0.005


def boulder():
    corners = [(x, 0.8 * y, z) for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (0.0, 0.7)]
    inertia = np.diag([13.0, 12.5, 1.5]).tolist()
    return {
        "mass_kg": 300.0,
        "com_height_at_rest_m": 0.35,
        "inertia_about_com_kg_m2": inertia,
        "hull_vertices_m": corners,
    }


def granite(folder, change=lambda specimens, motions, rows: None):
    """Four pushes of which the two strong ones topple."""
    folder = folder / "granite"
    folder.mkdir()
    specimens = {"SP1": boulder(), "SP2": boulder(), "common": {}}
    motions, rows = {"dt": np.array(DT)}, []
    for number, peak in ((2, 0.05), (4, 0.1), (6, 0.8), (8, 1.2)):
        t = np.arange(200) * DT
        samples = 9.80665 * peak * np.where(t < 0.4, np.sin(np.pi * np.minimum(t / 0.4, 1.0)), 0.0)
        motions[f"a{number:03d}"] = samples.astype(np.float32)
        rows.append(
            {"id": number, "record": "pulse", "motion": 1, "duration_s": 199 * DT, "t_on_s": 0.0, "t_off_s": 0.9}
            | {"pga_g": peak, "pga_10hz_g": peak, "pgv_ms": 2.5 * peak}
            | {"toppled_sp1": int(peak > 0.5), "toppled_sp2": int(peak > 0.5), "p_logit_sp1": 0.5, "p_logit_sp2": 0.99}
        )
    change(specimens, motions, rows)
    (folder / "specimens.json").write_text(json.dumps(specimens))
    np.savez(folder / "motions.npz", **motions)
    with open(folder / "tests.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)


def run(capsys, *arguments):
    code = call(["experiments", *map(str, arguments)])
    return code, capsys.readouterr()


def test_tables_pictures_and_the_keys_that_were_promised(tmp_path, capsys):
    granite(tmp_path)
    out = tmp_path / "out"
    code, captured = run(
        capsys, tmp_path, "--out", out, "--realisations", "2", "--calibration", "off", "--threads", "1", "--json"
    )
    assert code == 0, captured.err
    answer = json.loads(captured.out)
    for name in ("SP1", "SP2"):
        assert set(answer["granite"][name]) >= KEYS
        assert answer["granite"][name]["tests"] == 4
        assert answer["granite"][name]["accuracy"] == 1.0
    assert answer["granite"]["SP1"]["hard_tests"] == 4
    assert answer["granite"]["SP2"]["hard_tests"] == 0
    assert answer["granite"]["SP1"]["brier"] < 0.26
    for name in ("granite_tests.csv", "granite_verdicts.png", "granite_reliability.svg", "experiments.json"):
        assert (out / name).is_file()
    assert [path.name for path in out.glob("*.sqlite*")] == ["runs.sqlite"]


def refuse_inertia(specimens, motions, rows):
    del specimens["SP2"]["inertia_about_com_kg_m2"]


def other_unit(specimens, motions, rows):
    motions["a004"] = motions["a004"] / 9.80665


def other_step(specimens, motions, rows):
    motions["a004"] = motions["a004"][::2]


def missing(specimens, motions, rows):
    del motions["a004"]


def unlisted(specimens, motions, rows):
    del rows[1]


@pytest.mark.parametrize(
    ("change", "sentence", "names", "tests"),
    [
        (refuse_inertia, "specimen SP2 has no inertia_about_com_kg_m2", {"SP1"}, 4),
        (other_unit, "test 4 peaks at 0.0102 g if in m/s², and its sheet says 0.1 g: another unit", {"SP1", "SP2"}, 3),
        (other_step, "another time step", {"SP1", "SP2"}, 3),
        (missing, "test 4 has no motion", {"SP1", "SP2"}, 3),
        (unlisted, "motion a004 has no row", {"SP1", "SP2"}, 3),
    ],
)
def test_what_cannot_be_used_is_one_sentence_and_the_rest_goes_on(tmp_path, capsys, change, sentence, names, tests):
    granite(tmp_path, change)
    code, captured = run(capsys, tmp_path, "--calibration", "off", "--threads", "1", "--json")
    assert code == 0, captured.err
    answer = json.loads(captured.out)
    assert sum(sentence in refusal for refusal in answer["refused"]) == 1
    assert {name for name, result in answer["granite"].items() if isinstance(result, dict)} == names
    assert answer["granite"]["SP1"]["tests"] == tests


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda folder: None, "holds no experiment"),
        (lambda folder: (folder / "granite").mkdir(), "specimens.json cannot be read"),
        (lambda folder: granite(folder, lambda s, m, r: m.pop("dt")), "no time step dt"),
        (lambda folder: np.savez(folder / "tosses.npz", dt=1 / 148, t000=np.zeros((3, 13))), "has the shape"),
    ],
)
def test_a_folder_of_no_use_is_refused(tmp_path, capsys, make, sentence):
    make(tmp_path)
    code, captured = run(capsys, tmp_path)
    assert code == 2
    assert sentence in captured.err
    assert "Traceback" not in captured.err


def test_odd_options_are_refused(tmp_path, capsys):
    for option, value in (("--realisations", "-1"), ("--realisations", "many"), ("--calibration", "maybe")):
        assert run(capsys, tmp_path, option, value)[0] == 2


def test_it_goes_on_from_its_ledger(tmp_path):
    granite(tmp_path)
    experiments, ledger, seen = study.read(tmp_path), tmp_path / "runs.sqlite", []
    assert experiments.granite is not None
    from stylobate_studies.experiments import granite as room

    variants = room.variants(experiments.granite, 0, False)
    first = room.run(experiments.granite, variants, threads=1, ledger=ledger)
    again = room.run(
        experiments.granite, variants, threads=1, ledger=ledger, progress=lambda done, total: seen.append(done)
    )
    assert again.equals(first)
    assert seen[-1] == len(first)


def thrown(name="t000"):
    """A cube that was computed here, as if it had been measured: dropped flat, sliding."""
    from stylobate import DistinctElement3D, Motion, Toss, simulate

    dt = 1 / 148
    body = cube.cube(CUBE_FRICTION, CUBE_RESTITUTION)
    response = simulate(
        body,
        Motion(120 * dt, np.zeros(2)),
        DistinctElement3D(),
        start=Toss((0.0, 0.0, 0.12), (0.96, 0.1, 0.2, 0.1), (0.5, 0.2, -0.3), (1.0, 2.0, 0.5)),
        until_end=True,
        output_interval=1e-4,
    )
    at = [int(np.argmin(np.abs(response.time - k * dt))) for k in range(120)]
    return Recorded(name, dt, response.body_position[at, 0], response.body_orientation[at, 0])


def test_a_toss_that_was_computed_is_met():
    """What is left is the state at the start, read from frames 7 ms apart."""
    toss = thrown()
    row = cube.compare(toss, CUBE_FRICTION, CUBE_RESTITUTION)
    assert row["impacts"] >= 1
    assert row["first impact: position [widths]"] < 0.02
    assert row["first impact: rotation [deg]"] < 5.0
    assert row["rest face right"]


def test_faces_and_rotation_vectors():
    for axis in range(3):
        for sign in (-1, 1):
            turn = np.roll(np.eye(3), axis + 1, axis=1)  # body axis `axis` stands upright
            turn = turn if sign > 0 else turn @ np.diag([1.0 if index != axis else -1.0 for index in range(3)])
            assert cube.face_down(turn) == -sign * (axis + 1)
    vector = np.array([0.3, -0.4, 1.1])
    angle = np.linalg.norm(vector)
    k = np.array([[0, -vector[2], vector[1]], [vector[2], 0, -vector[0]], [-vector[1], vector[0], 0]]) / angle
    turn = np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k
    assert cube.vector_of(turn) == pytest.approx(vector, abs=1e-12)


def test_half_width_is_that_of_the_data_set():
    assert HALF == 0.0524
