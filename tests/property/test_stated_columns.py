"""Columns of text: our header, or ``columns`` as stated; anything else is refused, and what is proposed reads."""

import re

import numpy as np
import pytest

from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.motion import MotionRequest, read_motion, read_suite

#: Every wave and its reverse, so that no mean is an instrument's offset [any unit].
HALF = np.round(np.random.default_rng(3).normal(0.0, 0.3, (20, 7)), 3)
WAVES = np.concatenate([HALF, -HALF[::-1]])
STEP = 0.01


@pytest.fixture
def put(tmp_path):
    """A file of a text over rows of times and waves."""

    def write(above, columns, *, timed=True, below="", end="\n"):
        time = [[f"{STEP * i:.2f}"] if timed else [] for i in range(len(WAVES))]
        rows = [" ".join([*t, *(f"{value:.3f}" for value in row[:columns])]) for t, row in zip(time, WAVES)]
        path = tmp_path / "record.txt"
        path.write_text(end.join([*([above] if above else []), *rows, below]), encoding="utf-8")
        return path

    return write


def proposed(error):
    """What a refusal proposes, as it can be typed."""
    return re.search(r"`columns='([^']+)'`", str(error))[1]


@pytest.mark.parametrize(
    ("columns", "places"),
    [
        ("t [s], x [g]", {"x": 0}),
        ("t [s], x [g], -, z [g]", {"x": 0, "z": 2}),
        ("t[s],z[g],y[g],x[g]", {"x": 2, "y": 1, "z": 0}),
        ("-, -, -, x [g]", {"x": 2}),
    ],
)
@pytest.mark.parametrize("above", ["", "Zeit N O Z", "# columns: time velocity (cm/s)\n-----", "1. Column: Time\nEnde"])
def test_stated_columns_are_what_is_read(above, columns, places, put):
    path = put(above, columns.count(","))
    motion = read_motion(path, dt=None if "t" in columns else STEP, columns=columns)
    assert motion.dt == STEP
    assert set(motion.components) == set(places)
    for axis, place in places.items():
        assert motion.components[axis] == pytest.approx(g * WAVES[:, place])
    assert (
        MotionRequest(files=(path,), dt=None if "t" in columns else STEP, columns=columns).motion().digest
        == motion.digest
    )


def test_each_column_has_its_unit(put):
    motion = read_motion(put("no header of ours", 3), columns="t [s], x [g/10], y [m/s2], z [mm/s^2]")
    for axis, size, k in (("x", g / 10, 0), ("y", 1.0, 1), ("z", 1e-3, 2)):
        assert motion.components[axis] == pytest.approx(size * WAVES[:, k])
    assert motion.metadata["unit"] == "g/10, m/s2, mm/s2"
    assert read_motion(put("words", 1), "m/s2", columns="t [s], x").pga == pytest.approx(np.abs(WAVES[:, 0]).max())


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ("", "'' is not understood"),
        ("t [s], ax [g]", r"'ax \[g\]' is not understood; allowed are t, x, y and z"),
        ("t [s] x [g]", "is not understood"),
        ("t, x [g]", "'t' states no unit of time"),
        ("t [g], x [g]", "states no unit of time"),
        ("t [s], x [furlong]", "allowed are g, m/s2"),
        ("t [s], x [g], x [g]", "names 2 columns x"),
        ("t [s], y [g]", "names a column y and none x"),
        ("t [s], z [g]", "names no x"),
        ("t [s], -", "names no column of acceleration"),
    ],
)
def test_columns_that_are_not_understood_are_refused_before_a_file_is_opened(columns, message):
    for refused in (
        lambda: read_motion("no such file", columns=columns),
        lambda: MotionRequest(files=("no such file",), columns=columns),
    ):
        with pytest.raises(InputError, match=message) as error:
            refused()
        assert error.value.field.partition(".")[0] == "columns"


@pytest.mark.parametrize(
    ("above", "number", "proposal"),
    [
        ("Zeit N O Z", 3, "t [s], y [g], x [g], z [g]"),
        ("unità: cm/s²\ntempo;NS;EW;UP", 3, "t [s], y [cm/s2], x [cm/s2], z [cm/s2]"),
        ("time, acc_north, acc_east", 2, "t [s], y [g], x [g]"),
        ("time, displacement velocity acceleration", 3, "t [s], -, -, x [g]"),
        ("time; EW (m/s²); NS (m/s²); UD (m/s²)", 3, "t [s], x [m/s2], y [m/s2], z [m/s2]"),
        ("# time [s], vertical [g/10], east [g/10]", 2, "t [s], z [g/10], x [g/10]"),
        ("t x v", 2, "t [s], x [g], -"),
        ("t (s)  NS (cm)  EW (m/s2)", 2, "t [s], -, x [m/s2]"),
        ("time ax foo", 2, "t [s], x [g], y [g]"),
        ("*** Begin data ***", 1, "t [s], x [g]"),
        ("# title: Athens 1999", 1, "t [s], x [g]"),
        ("time_s,ax_g\ns,m/s2", 1, "t [s], x [m/s2]"),
        ("Time, Acc X, Acc Y, Acc Z", 3, "t [s], x [g], y [g], z [g]"),
        ("t;acc_x_m/s2;acc_y_m/s2;acc_z_m/s2", 3, "t [s], x [m/s2], y [m/s2], z [m/s2]"),
        ("Time (s) Acceleration (m/s2)", 1, "t [s], x [m/s2]"),
        ("idő függőleges", 1, "t [s], x [g]"),
        ("", 2, "t [s], x [g], y [g]"),
    ],
)
def test_any_other_header_is_refused_with_its_line_and_a_proposal_that_reads(above, number, proposal, put):
    path = put(above, number)
    with pytest.raises(InputError, match="state what each column holds") as error:
        read_motion(path)
    if above:
        assert f"line {above.count(chr(10)) + 1}: {above.splitlines()[-1]!r} is not a header" in str(error.value)
    assert proposed(error.value) == proposal
    assert read_motion(path, columns=proposal).dt == STEP


def test_a_row_that_holds_no_number_is_no_title(tmp_path):
    """With its columns stated a first row with nan was passed over, and the record began a sample later."""
    (path := tmp_path / "a.csv").write_text("time_s,ax_g\n0,nan\n0.01,0.1\n0.02,0.1\n")
    for columns in (None, "t [s], x [g]"):
        with pytest.raises(InputError, match="'0,nan' holds no number"):
            read_motion(path, columns=columns)


def test_a_series_written_on_from_line_to_line(tmp_path):
    """El Centro's layout: titles, eight numbers to a line, a short last line, and a mark of the end."""
    values = WAVES.ravel()[:275]
    rows = [" ".join(f"{value:9.5f}" for value in values[i : i + 8]) for i in range(0, 275, 8)]
    path = tmp_path / "record.txt"
    path.write_text("\n".join(["The units are (g)", "*** Begin data ***", *rows, "*** End Data ***", ""]))
    with pytest.raises(InputError, match="and `dt`, the time from sample to sample") as error:
        read_motion(path)
    assert "dt=" not in str(error.value)  # a step in a line to be typed would be believed
    motion = read_motion(path, dt=0.005, columns=proposed(error.value))
    assert motion.acceleration == pytest.approx(g * values)
    with pytest.raises(InputError, match="names 2 columns, the rows hold 8"):
        read_motion(path, columns="t [s], x [g]")


def test_a_table_is_no_series(put):
    path = put("t x y z w", 5)
    with pytest.raises(InputError, match="rise in equal steps as times do, and `columns` names x alone"):
        read_motion(path, dt=STEP, columns="x [g]")
    with pytest.raises(InputError, match="names 1 columns, the rows hold 3"):
        read_motion(put("x y z", 3, timed=False), dt=STEP, columns="x [g]")


def test_a_line_of_count_and_step_is_told_and_its_remedy_works(tmp_path):
    """One number a line under a name and a line of count and step."""
    path = tmp_path / "record.txt"
    rows = [f"{value:.6f}" for value in WAVES[:, 0]]
    path.write_text("\n".join(["hill", f"{len(rows)} 0.005", *rows, ""]))
    with pytest.raises(InputError, match=r"line 2: '40 0\.005' holds the number of samples and the step") as error:
        read_motion(path, unit="g")
    path.write_text("\n".join([*rows, ""]))
    assert "`dt=0.005`" in str(error.value)
    motion = read_motion(path, dt=0.005, columns=proposed(error.value))
    assert motion.acceleration == pytest.approx(g * WAVES[:, 0])


@pytest.mark.parametrize(
    "header",
    ["time_s,ax_g,ay_g", "TIME_S; AX_G; AY_G", '"time_s","ax_g","ay_g"', "# time_s ax_g ay_g", "time_s,ax_g,ay_g,"],
)
def test_our_header_however_it_is_separated(header, put):
    motion = read_motion(put(header, 2))
    assert motion.lateral == pytest.approx(g * WAVES[:, 1])


@pytest.mark.parametrize("mark", ["*** End Data ***", "END", "-- end of file --", "# end", "EOF"])
def test_a_mark_of_the_end_is_no_damage(mark, put):
    assert read_motion(put("time_s,ax_g", 1, below=mark + "\n")).steps == len(WAVES)


@pytest.mark.parametrize("line", ["nan nan", "********* *********", "abc", "Ende 12"])
def test_other_words_behind_the_numbers_are_refused(line, put):
    with pytest.raises(InputError, match="expected numbers"):
        read_motion(put("time_s,ax_g", 1, below=line + "\n"))


def test_what_a_file_states_itself_is_not_overruled(put):
    with pytest.raises(InputError, match=r"names its columns itself.*leave `columns` out"):
        read_motion(put("time_s,ax_g", 1), columns="t [s], x [gal]")
    with pytest.raises(InputError, match="its columns are in g, but unit is given as 'gal'"):
        read_motion(put("time_s,ax_g", 1), "gal")
    with pytest.raises(InputError, match="its columns are in g, but unit is given as 'gal'"):
        read_motion(put("time ax", 1), "gal", columns="t [s], x [g]")


def test_in_a_folder_columns_are_stated_for_the_files_that_need_them(put, tmp_path):
    put("time_s,ax_g", 1).rename(tmp_path / "own.csv")
    put("Zeit v a", 2)
    suite = read_suite(tmp_path, columns="t [s], -, x [m/s2]")
    assert {motion.name: motion.metadata["unit"] for motion in suite} == {"own.csv": "g", "record.txt": "m/s2"}
    alone = read_suite(tmp_path)
    assert "is not a header" in alone.refused["record.txt"]


def test_two_files_of_one_column_are_x_and_y_in_the_order_given(put, tmp_path):
    first = put("Zeit a", 1)
    second = tmp_path / "second.txt"
    second.write_text("\n".join(["Zeit a", *(f"{STEP * i:.2f} {value}" for i, value in enumerate(WAVES[:, 1])), ""]))
    motion = read_motion([first, second], columns="t [s], x [g]")
    assert motion.lateral == pytest.approx(g * WAVES[:, 1])
