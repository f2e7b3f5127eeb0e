"""Studies: nothing is computed twice or mixed; the table is the same to the bit (after kills: ``fuzz/studies.py``)."""

import importlib
import json
import math
import subprocess
import sys
from contextlib import closing

import numpy as np
import pandas
import pytest

import stylobate as st
from stylobate.campaign import digests
from stylobate.campaign.digests import Hasher
from stylobate.campaign.ledger import RUNS_FILE, Ledger
from stylobate.campaign.runs import Request, its_turn
from stylobate.campaign.study_files import read_plan
from stylobate.cli.main import call
from stylobate.column.files import load_column
from stylobate.motion.conditioning import conditioned
from stylobate.motion.intensity import parse_measure
from stylobate.probability.studies import StudyResult, write_table

COLUMN = st.Column.tapered(
    height=2.4, bottom_width=0.5, top_width=0.4, drums=1, density=2600.0, name="one",
    joint=st.Joint(normal_stiffness=2e9, shear_stiffness=1e9, friction_coefficient=0.7),
)  # fmt: skip
PULSE = st.sine_pulse(frequency=0.9, amplitude=1.0, duration=3.0)
FILE = """
column = "three.toml"
model = "dem2d"
[motions]
files = ["wave.csv"]
signs = "both"
[scale]
im = "pga"
levels = ["0.3g", "0.5g", "0.9g"]
[scatter]
realisations = 40
friction = 0.1
width = 0.01
"""
THREE = """name = "three"
section = "circular"
density = 2600.0
[tapered]
height = 2.4
bottom_width = 0.5
top_width = 0.4
drums = 3
[joint]
normal_stiffness = 2.0e9
shear_stiffness = 1.0e9
friction_coefficient = 0.7
"""


def study(*levels, **changes):
    return st.Study([COLUMN], [PULSE], [st.HousnerBlock()], levels or (1.0, 2.0, 3.0, 6.0), **changes)


@pytest.fixture
def folder(tmp_path):
    time_s = np.arange(0.0, 3.005, 0.01)
    lines = [f"{t:.2f},{x:.6f}" for t, x in zip(time_s, 0.4 * np.sin(2 * np.pi * time_s))]
    (tmp_path / "wave.csv").write_text("\n".join(["time_s,ax_g", *lines]))
    (tmp_path / "three.toml").write_text(THREE)
    (tmp_path / "study.toml").write_text(FILE)
    return tmp_path


def test_a_study_that_grows_computes_only_what_is_new(tmp_path):
    first = st.run_study(study(1.0, 2.0, replicates=3), tmp_path)
    assert (first.computed, len(first.plan)) == (6, 6)
    grown = st.run_study(study(1.0, 2.0, 4.0, replicates=5), tmp_path)
    assert (grown.computed, len(grown.plan)) == (9, 15)
    alone = st.run_study(study(1.0, 2.0, 4.0, replicates=5))
    assert grown.table.equals(alone.table)
    assert st.run_study(study(1.0, 2.0, 4.0, replicates=5), tmp_path).computed == 0


def test_a_case_is_what_simulate_many_computes():
    table = st.run_study(study()).table
    again = st.simulate_many(COLUMN, [PULSE.scaled(level) for level in (1.0, 2.0, 3.0, 6.0)], st.HousnerBlock())
    assert table["peak_top_displacement_m"].tolist() == again["peak_top_displacement_m"].tolist()
    assert table["outcome"].tolist() == again["outcome"].tolist()


@pytest.mark.filterwarnings("ignore::stylobate.errors.LeftOutWarning")
def test_a_plan_tells_its_cases_as_any_other_request_does(tmp_path):
    """By what acts and what stands: not by names, nor by the components that the model leaves out."""
    original = study(replicates=2)
    again = Request.of([original.case(number) for number in range(original.size)], Hasher(original.models[0]))
    assert again.digests.digests.tolist() == original.plan().digests.digests.tolist()
    aside = PULSE.replace(name="another", ay=0.3 * PULSE.samples)
    renamed = st.Study([COLUMN.replace(name="another")], [aside], original.models, original.levels, replicates=2)
    assert renamed.plan().digests.digests.tolist() == original.plan().digests.digests.tolist()
    for other in (
        study(replicates=2, seed=1),
        study(replicates=2, tail=1.0),
        study(1.0, 2.0, 3.0, 6.1, replicates=2),
    ):
        assert other.plan().digests.digests.tolist() != original.plan().digests.digests.tolist()


OWN = """
import stylobate as st
class Own(st.HousnerBlock):
    name = "own"
    version = "1"
    def taken(self, motion):
        return super().taken(motion)
"""


def test_a_model_of_ones_own_of_another_version_is_another_law(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    digests = []
    for source in (OWN, f"{OWN}        # edited", OWN.replace('"1"', '"2"')):
        (tmp_path / "own_model.py").write_text(source)
        monkeypatch.delitem(sys.modules, "own_model", raising=False)
        importlib.invalidate_caches()
        own_study = st.Study([COLUMN], [PULSE], [importlib.import_module("own_model").Own()])
        digests.append(own_study.plan().digests[0])
    assert digests[0] == digests[1] != digests[2]


def test_what_is_to_be_said_of_runs_is_said_of_those_in_the_ledger_too(tmp_path):
    aside = PULSE.replace(ay=0.3 * PULSE.samples)
    for made in (4, 0):
        with pytest.warns(st.errors.LeftOutWarning):
            result = st.run_study(st.Study([COLUMN], [aside], [st.HousnerBlock()], (1.0, 2.0, 3.0, 6.0)), tmp_path)
        assert result.computed == made


def test_runs_of_another_law_are_never_mixed_in(tmp_path, monkeypatch):
    st.run_study(study(), tmp_path)
    assert st.run_study(study(tail=1.0), tmp_path).computed == 4
    monkeypatch.setattr(digests, "laws", lambda: ("another law",))
    assert st.run_study(study(), tmp_path).computed == 4


def test_the_same_case_twice_is_run_once():
    result = st.run_study(st.Study([COLUMN], [PULSE, PULSE], [st.HousnerBlock()], (1.0, 1.0)))
    assert result.rows.finished == 4
    assert len({str(row) for row in result.rows}) == 1


def test_levels_of_an_intensity_are_met():
    motion = conditioned(st.sample_motion("el-centro-1940"), "highpass=0.1Hz")  # its peak velocity holds drift
    pgv = st.Study([COLUMN], [motion], [st.HousnerBlock()], (0.1, 0.4), parse_measure("pgv"))
    assert [pgv.case(i).motion.pgv for i in range(2)] == pytest.approx([0.1, 0.4], rel=1e-9)
    arias = st.Study([COLUMN], [motion], [st.HousnerBlock()], (0.5,), parse_measure("arias"))
    assert parse_measure("arias").of(arias.case(0).motion) == pytest.approx(0.5, rel=1e-9)
    with pytest.warns(st.OutOfRangeWarning, match="more than 10 times"):
        st.Study([COLUMN], [motion], [st.HousnerBlock()], (20.0,), parse_measure("pgv"))


def test_several_processes_on_one_folder_run_nothing_twice_and_all_of_them_end(folder):
    small = FILE.replace('"dem2d"', '"housner"').replace("realisations = 40", "realisations = 20")
    (folder / "study.toml").write_text(small)
    (folder / "three.toml").write_text(THREE.replace("drums = 3", "drums = 1"))
    whole = st.run_study(read_plan(folder / "study.toml")[0])
    out = folder / "out"
    out.mkdir()
    command = [sys.executable, "-c", "from stylobate.cli.main import main; main()", "study", "run", "--json"]
    command += ["--threads", "1", folder / "study.toml", "--out", out]
    with closing(Ledger(out / RUNS_FILE)) as first:  # a process at work, which has made some of the runs
        for number in range(50):
            first.record(
                int(whole.plan.digests.keys[number]), {"case": whole.plan.digests[number], **whole.rows[number]}
            )
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
        others = [subprocess.Popen(command, **pipes) for _ in range(2)]
        assert all("another process is at work" in other.stderr.readline() for other in others)
    answers = [json.loads(other.communicate(timeout=120)[0]) for other in others]
    assert [other.returncode for other in others] == [0, 0]
    assert sum(answer["computed"] for answer in answers) == 120 - 50
    assert StudyResult.in_folder(out).table.equals(whole.table)
    assert sorted(path.name for path in out.glob("*-lock")) == []


def test_runs_of_others_in_the_ledger_are_not_counted_while_one_waits(tmp_path):
    digests, counts = study().plan().digests, []
    with closing(Ledger(tmp_path / RUNS_FILE)) as book:
        for number in (1, 2, 3, int(digests.keys[0])):
            book.record(number, {})
    its_turn(tmp_path / RUNS_FILE, digests, lambda *count: counts.append(count), None)()
    assert counts == [(1, 4)]


def test_run_status_and_export_under_their_promised_names(folder, capsys):
    (folder / "study.toml").write_text(FILE.replace("realisations = 40", "realisations = 2"))
    out = folder / "out"

    def answer(*arguments):
        assert call([*map(str, arguments), "--json"]) == 0, capsys.readouterr().err
        return json.loads(capsys.readouterr().out)

    result = answer("study", "run", folder / "study.toml", "--out", out)
    promised = {"cases", "finished", "failed", "undecided", "collapsed", "wall_s", "files"}
    assert promised <= set(result)
    assert result["cases"] == result["finished"] == 12
    assert len(list((out / "histories").iterdir())) == 2
    status = answer("study", "status", out)
    assert promised <= set(status)
    assert {key: status[key] for key in promised - {"files"}} == {key: result[key] for key in promised - {"files"}}
    assert call(["study", "run", str(folder / "study.toml"), "--out", str(out)]) == 0
    written = next(path.name for path in out.glob("study.*") if path.suffix != ".json")
    assert f"5 files in {out}: {written}, asked-study.json, study.json, histories of 2 runs" in capsys.readouterr().out
    exported = answer("study", "export", out, "--to", folder / "t.csv")
    table = pandas.read_csv(folder / "t.csv")
    assert len(table) == exported["finished"] == 12
    assert set(table["record"]) == {"wave.csv"}
    assert sorted(set(table["im"])) == pytest.approx([0.3, 0.5, 0.9])
    assert table["pga_g"].to_numpy() == pytest.approx(table["im"].to_numpy(), rel=1e-9)
    assert table["reversed"].sum() == 6
    column = load_column(folder / "three.toml")
    # an older pandas reads the last digit of a number otherwise
    assert table["base_width_m"].to_numpy() == pytest.approx(column.base_width, rel=1e-12)
    assert table["joint_width_m"].to_numpy() == pytest.approx(column.joint_widths.min(), rel=1e-12)
    motion = read_plan(folder / "study.toml")[0].motions[0]
    relation = math.tan(column.slenderness), column.frequency_parameter
    for name in ("pgv", "sa:1s", "avgsa", "arias", "d5_95", "pgv_p_over_g_tan_alpha", "omega_g_over_p"):
        measure = parse_measure(name)
        for row in table.to_dict("records"):
            value = measure.of(motion.scaled(row["factor"]), relation)
            assert row[measure.key] == pytest.approx(value, rel=1e-9), name


def test_parquet_holds_the_same_numbers_to_the_bit(tmp_path):
    pytest.importorskip("pyarrow")
    table = st.run_study(study(replicates=2)).table
    again = pandas.read_parquet(write_table(table, tmp_path / "t.parquet"))
    for name in table:
        assert [str(value) for value in again[name]] == [str(value) for value in table[name]], name


def test_the_old_study_file_is_a_study_of_harmonics(folder):
    (folder / "grid.toml").write_text(
        'column = "three.toml"\nmodel = "housner"\nfrequencies = "1:2:2"\namplitudes = ["0.1g", "0.3g"]\nduration = 2.0\n'
    )
    grid, refused = read_plan(folder / "grid.toml")
    assert (grid.size, refused) == (4, {})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (('files = ["wave.csv"]', "files = []"), "names no record"),
        (('files = ["wave.csv"]', 'files = ["*.V2"]'), "no file matches '*.V2'"),
        (('im = "pga"', 'im = "pga@geomean"'), "needs a second horizontal component"),
        (('im = "pga"', 'im = "d5_95"'), "level '0.3g'"),
        (('"0.3g"', "0.3"), "has no unit"),
        (("realisations = 40", "realisations = 0"), "realisations in [scatter] is 0"),
        (("friction = 0.1", "friction = 5.0"), "friction of the scatter is 5"),
        (('model = "dem2d"', 'model = "dem4d"'), "there is no model 'dem4d'"),
        (('column = "three.toml"', ""), "names no column"),
    ],
)
def test_a_bad_study_is_refused_in_one_sentence(folder, capsys, change, message):
    (folder / "study.toml").write_text(FILE.replace(*change))
    assert call(["study", "run", str(folder / "study.toml"), "--out", str(folder / "out")]) == 2
    text = capsys.readouterr().err
    assert message in text
    assert text.count("\n") == 1
    assert not (folder / "out").exists()


def test_a_folder_that_is_no_study_says_so(tmp_path, capsys):
    assert call(["study", "status", str(tmp_path)]) == 2
    assert "is no folder of a study" in capsys.readouterr().err
    (tmp_path / "plan.npz").write_bytes(b"nothing")
    assert call(["study", "status", str(tmp_path)]) == 2
    assert "is damaged" in capsys.readouterr().err
