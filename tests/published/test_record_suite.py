"""Suites of records: a folder read at once, and the table of what it does to columns."""

import warnings

import numpy as np
import pytest
from records import FOLDER, needs_folder, record

from stylobate.constants import g
from stylobate.errors import InputError, OutOfRangeWarning
from stylobate.models.rocking.model import HousnerBlock
from stylobate.motion import half_sine_pulse, read_suite, write_csv
from stylobate.probability.suite import suite_table
from stylobate.verdicts.rocking_spectrum import rocking_block


def test_a_folder_with_a_file_that_is_no_record(tmp_path):
    for name, size in (("b.csv", 0.3), ("a.csv", 0.1)):
        write_csv(half_sine_pulse(1.0 + size, size * g, 4.0), tmp_path / name)
    (tmp_path / "README.md").write_text("# Records\n")
    (tmp_path / "bare.txt").write_text("0.1\n-0.1\n0.1\n-0.1\n")
    suite = read_suite(tmp_path)
    assert [motion.name for motion in suite.motions] == ["a.csv", "b.csv"]
    assert set(suite.refused) == {"README.md", "bare.txt"}
    assert "`unit='g'`" in suite.refused["bare.txt"]
    assert len(read_suite(tmp_path, "g", 0.01).motions) == 3
    for wrong in (tmp_path / "missing", tmp_path / "a.csv"):
        with pytest.raises(InputError, match="not a folder"):
            read_suite(wrong)
    with pytest.raises(InputError, match="no record that can be used"):
        read_suite([tmp_path / "README.md"])


def test_a_record_that_is_there_twice_counts_once(tmp_path):
    for folder, name, size in (("a", "one", 1.0), ("a", "copy", 1.0), ("b", "one", 2.0)):
        (tmp_path / folder).mkdir(exist_ok=True)
        write_csv(half_sine_pulse(1.0, size, 4.0), tmp_path / folder / f"{name}.csv")
    suite = read_suite(tmp_path / "a")
    assert [motion.name for motion in suite.motions] == ["copy.csv"]
    assert suite.refused == {"one.csv": "it holds the motion of 'copy.csv' once more; a record counts once"}
    with pytest.raises(InputError, match=r"two records are called 'one\.csv'"):
        read_suite([tmp_path / folder / "one.csv" for folder in "ab"])


def test_a_recording_in_two_files_of_different_size_is_told(tmp_path):
    """As a suite of motions as they are it may be meant; where intervals are over records it is one."""
    for name, length, size in (("a", 1.0, 1.0), ("b", 1.0, 2.0), ("c", 1.3, 1.0)):
        write_csv(half_sine_pulse(length, size, 4.0), tmp_path / f"{name}.csv")
    with pytest.warns(OutOfRangeWarning, match=r"1 of 3 records .* \('b\.csv' of 'a\.csv'\): .* narrower"):
        assert len(read_suite(tmp_path)) == 3


def test_the_table_holds_outcomes_and_measures(tmp_path):
    motions = [half_sine_pulse(1.0, size * g, 12.0) for size in (0.05, 0.8)]
    columns = [rocking_block(p, 0.1) for p in (1.0, 2.0)]
    table = suite_table(columns, motions, HousnerBlock(), threads=1)
    assert table["outcome"].tolist() == ["at_rest", "collapsed"] * 2
    assert table["pga_over_g_tan_alpha"].to_numpy() == pytest.approx(np.array([0.05, 0.8] * 2) / np.tan(0.1), rel=1e-4)
    assert table["uniform_duration_s"][0] == 0.0
    assert {"record", "column", "pgv_m_s", "arias_m_s", "psa_1s_g", "peak_rotation_rad", "model"} <= set(table.columns)


def test_samples_make_a_suite(tmp_path):
    own = tmp_path / "own.csv"
    write_csv(half_sine_pulse(1.0, 0.3 * g, 4.0), own)
    suite = read_suite([record("twocol_ElCentro1940_NS.dat"), own, "sample:nonsense"])
    assert [motion.name for motion in suite.motions] == ["el-centro-1940", "own.csv"]
    assert "sample:nonsense" in suite.refused


@needs_folder
def test_the_folder_of_real_records():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OutOfRangeWarning)
        suite = read_suite(FOLDER, "g")
    assert len(suite.motions) >= 11
    assert any("only the vertical" in reason for reason in suite.refused.values())
    assert any("StationXML" in reason for reason in suite.refused.values())
