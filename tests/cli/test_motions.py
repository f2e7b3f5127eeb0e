"""Commands on ground motions: spectra, suites, directions, conditioning; what is left out and done is said."""

import csv
import json
import math

import numpy as np
import pytest

import stylobate as st
from stylobate.cli.main import call
from stylobate.column.catalogue import preset
from stylobate.errors import OutOfRangeWarning
from stylobate.motion import along, bandpass, conditioning, parse_synthetic, ricker, rotated_spectrum, write_csv
from stylobate.probability.suite import INTENSITIES, suite_table
from stylobate.verdicts.rocking_spectrum import rocking_spectrum

RUN = ["run", "paper-monolithic", "--model", "housner"]


@pytest.fixture
def command(capsys):
    """Runs a command line that must succeed; returns its JSON object, or its text without ``--json``."""

    def run(*arguments):
        code = call([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        assert code == 0, err
        assert err == ""
        return json.loads(out) if "--json" in arguments else out

    return run


@pytest.fixture
def refused(capsys):
    """Runs a command line that must be refused; returns its one sentence."""

    def run(*arguments):
        code = call([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        assert (code, out) == (2, ""), err
        (line,) = err.splitlines()
        return line

    return run


def shaking(size=0.4, pace=1.0):
    """Three components towards 30°, 300° and up: two pulses, and a short vertical one in the middle of the first."""
    time = np.arange(1201) * 0.01
    pulses = (
        (ricker(0.8 * pace, size * st.g), 0.0),
        (ricker(1.3 * pace, 0.6 * size * st.g), 0.0),
        (ricker(3.0, 0.25 * size * st.g), 1.6),
    )
    parts = [np.interp(time - late, pulse.time, pulse.acceleration, left=0.0, right=0.0) for pulse, late in pulses]
    return st.Motion(0.01, *parts, name="three", metadata={"azimuths": {"x": 30.0, "y": 300.0}})


@pytest.fixture
def record(tmp_path):
    return write_csv(shaking(), tmp_path / "three.csv")


@pytest.fixture
def folder(tmp_path):
    place = tmp_path / "records"
    place.mkdir()
    for name, size, pace in (("strong.csv", 1.2, 1.0), ("weak.csv", 0.05, 1.1)):
        write_csv(shaking(size, pace), place / name)
    (place / "README.txt").write_text("words only\n")
    return place


# -- spectra --------------------------------------------------------------------------------------------------------


def test_the_response_spectrum_of_every_component_and_of_all_directions(command, record, tmp_path):
    out = tmp_path / "out"
    result = command("spectrum", record, "--periods", "0.2:4:9", "--damping", "0.02", "--out", out, "--json")
    assert result["kind"] == "response"
    assert result["period_s"] == pytest.approx(np.geomspace(0.2, 4.0, 9))
    names = {path.name for path in out.glob("[!.]*")}
    assert names == {"spectrum.csv", "spectrum.json", "spectrum.png", "spectrum.svg"}
    expected = rotated_spectrum(shaking(), (50.0, 100.0), result["period_s"], 0.02)
    assert result["psa_rotd100_g"] == pytest.approx(expected[100.0] / st.g, rel=1e-9)
    for axis in "xyz":
        assert len(result[f"psa_{axis}_g"]) == 9
    with (out / "spectrum.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [float(row["psa_rotd50_g"]) for row in rows] == pytest.approx(result["psa_rotd50_g"])
    assert json.loads((out / "spectrum.json").read_text())["psa_x_g"] == result["psa_x_g"]


def test_the_rocking_spectrum_is_that_of_python(command, record, tmp_path):
    grid = ["--p", "1:4:3", "--alpha", "0.1:0.5:5"]
    result = command("spectrum", record, "--kind", "rocking", *grid, "--out", tmp_path / "out", "--json")
    motion = shaking()
    with pytest.warns(OutOfRangeWarning, match="second horizontal component"):
        spectrum = rocking_spectrum(motion, np.geomspace(1.0, 4.0, 3), np.linspace(0.1, 0.5, 5), threads=1)
    assert np.array(result["peak_rotation_over_slenderness"]) == pytest.approx(spectrum.ratio, rel=1e-12)
    assert (result["cells"], result["collapsed_cells"]) == (15, int(spectrum.collapsed.sum()))
    assert 0 < result["collapsed_cells"] < 15
    assert result["closed_cells"] == 6  # α = 0.4 and 0.5, whose tangents are beyond the peak of 0.4 g
    assert result["vertical"] is True
    assert any("second horizontal" in text for text in result["left_out"])
    with (tmp_path / "out" / "spectrum.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert float(rows[-1]["pga_over_g_tan_alpha"]) == pytest.approx(motion.pga / st.g / math.tan(0.5))
    text = command("spectrum", record, "--kind", "rocking", *grid, "--vertical", "off")
    assert "left out" in text
    assert "vertical component" in text
    assert "15: 6 stay closed" in text


def test_spectra_of_pulses_and_simulated_motions(command):
    pulse = command("spectrum", "--pulse", "ricker,1Hz,0.3g", "--periods", "0.5:2:3", "--json")
    assert pulse["motion"].startswith("ricker")
    simulated = command("spectrum", "--synthetic", "greece,6.5Mw,20km,seed=3", "--periods", "1:2:2", "--json")
    assert simulated["motion"] == parse_synthetic("greece,6.5Mw,20km,seed=3").name


# -- suites ---------------------------------------------------------------------------------------------------------


def test_a_suite_is_a_table_a_figure_and_the_files_that_were_not_used(command, folder, tmp_path):
    arguments = ["suite", "paper-monolithic", folder, "--model", "housner"]
    out = tmp_path / "out"
    result = command(*arguments, "--against", "pga_over_g_tan_alpha", "--out", out, "--json")
    assert [row["record"] for row in result["runs"]] == ["strong.csv", "weak.csv"]
    assert [row["outcome"] for row in result["runs"]] == ["collapsed", "at_rest"]
    assert result["verdicts"] == {"paper-monolithic": {"collapsed": 1, "stands": 1}}
    assert set(result["refused"]) == {"README.txt"}
    assert {path.name for path in out.glob("[!.]*")} == {
        "suite.csv", "suite.json", "suite.png", "suite.svg", "asked-suite.json", "runs.sqlite"}  # fmt: skip
    assert set(INTENSITIES) <= set(result["runs"][0])
    motions = [st.read_motion(folder / name) for name in ("strong.csv", "weak.csv")]
    with pytest.warns(OutOfRangeWarning, match="second horizontal component"):
        table = suite_table(preset("paper-monolithic"), motions, st.HousnerBlock(), threads=1)
    assert [row["peak_top_displacement_m"] for row in result["runs"]] == table["peak_top_displacement_m"].tolist()
    text = command(*arguments)
    assert "paper-monolithic collapses in 1 of 2 runs: 50 % (95 % interval over 2 records: 9 to 91 %)." in text
    assert "left out of strong.csv: second horizontal component (azimuth 300°" in text
    assert "not used: README.txt" in text


def test_a_suite_of_two_columns_scaled_and_turned(command, folder, tmp_path):
    stone = tmp_path / "stone.toml"
    stone.write_text(
        'name = "stone"\ndensity = 2000.0\n[tapered]\nheight = 2.0\nbottom_width = 0.6\ntop_width = 0.6\ndrums = 1\n'
        "[joint]\nnormal_stiffness = 5e10\nshear_stiffness = 2.5e10\nfriction_angle = 35.0\n"
    )
    result = command("suite", "paper-monolithic", folder / "weak.csv", folder, "--also", stone, "--model", "housner",
                     "--azimuth", "75deg", "--pga", "0.25g", "--vertical", "off", "--json")  # fmt: skip
    assert "once more; a record counts once" in result["refused"]["weak.csv"]
    assert [row["column"] for row in result["runs"]] == ["paper-monolithic"] * 2 + ["stone"] * 2
    assert [row["number"] for row in result["runs"]] == [1, 2] * 2
    assert {round(row["pga_g"], 9) for row in result["runs"]} == {0.25}
    factors = [row["factor"] for row in result["runs"]]
    assert factors[1] < 0.5 < 2.0 < factors[0] == factors[2]  # strong.csv is scaled down, weak.csv up
    assert [entry["factor"] for entry in result["inputs"]] == factors[:2]
    assert any("multiplied by" in text for text in result["inputs"][0]["processing"])
    assert {row["vertical"] for row in result["runs"]} == {False}
    assert all(entry["azimuth_deg"] == 75.0 for entry in result["inputs"])


def test_records_that_cannot_be_turned_are_refused_and_the_others_used(command, refused, folder):
    (folder / "unknown.csv").write_text("time_s,ax_g\n0,0.1\n0.01,-0.2\n0.02,0.1\n")
    result = command("suite", "paper-monolithic", folder, "--model", "housner", "--azimuth", "10deg", "--json")
    assert len(result["runs"]) == 2
    assert "one horizontal component" in result["refused"]["unknown.csv"]
    message = refused("suite", "paper-monolithic", folder / "unknown.csv", "--model", "housner", "--azimuth", "10deg")
    assert "no record of the suite can be used" in message


def test_critical_over_a_folder_of_records(command, folder, tmp_path):
    grid = ["--from", "0.2g", "--to", "1.2g", "--step", "0.2g"]
    arguments = ["critical", "paper-monolithic", "--model", "housner", "--motion", folder, *grid]
    result = command(*arguments, "--out", tmp_path / "out", "--json")
    assert result["runs"] == 14  # six amplitudes of each, and each as it is
    assert [row["record"] for row in result["records"]] == ["strong.csv", "weak.csv"]
    names = {path.name for path in (tmp_path / "out").glob("[!.]*")}
    results = {"critical.csv", "critical.json", "critical.png", "critical.svg", "runs.csv", "asked-critical.json"}
    assert names == results | {"runs.sqlite"}
    # Each record alone has the same answer; of all of them, the lowest counts, and the highest.
    alone = [command(*arguments[:5], folder / row["record"], *grid, "--json") for row in result["records"]]
    assert [row["critical_g"] for row in result["records"]] == [answer["critical_g"] for answer in alone]
    assert result["critical_g"] == min(answer["critical_g"] for answer in alone)
    assert result["all_collapse_above_g"] == max(answer["all_collapse_above_g"] for answer in alone)
    assert 0.0 <= min(result["share_collapsed"]) < max(result["share_collapsed"]) == 1.0
    assert "strong.csv" in command(*arguments)


def test_run_over_a_folder_of_records(command, folder, tmp_path):
    result = command(*RUN, "--motion", folder, "--out", tmp_path / "out", "--json")
    assert [run["outcome"] for run in result["runs"]] == ["collapsed", "at_rest"]
    assert set(result["refused"]) == {"README.txt"}
    assert {path.name for path in (tmp_path / "out").glob("[!.]*")} == {"strong.csv", "weak.csv", "runs.sqlite"}
    written = json.loads((tmp_path / "out" / "weak.csv" / "run.json").read_text())
    assert written | {"messages": None} == result["runs"][1] | {"messages": None}


# -- directions, conditioning, simulated motions -----------------------------------------------------------------------


def test_a_plane_model_says_what_it_leaves_out(command, record):
    both = command(*RUN, "--motion", record, "--json")
    assert both["vertical"] is True
    (component,) = both["left_out"]
    assert component == "second horizontal component (azimuth 300°, peak 0.24 g)"
    off = command(*RUN, "--motion", record, "--vertical", "off", "--json")
    assert (len(off["left_out"]), off["vertical"]) == (2, False)
    assert off["left_out"][0] == "vertical component (peak 0.1 g)"  # by wish, and then y by the model
    assert off["peak_top_displacement_m"] != both["peak_top_displacement_m"]
    assert "left out" in command(*RUN, "--motion", record)
    assert command(*RUN, "--harmonic", "1Hz,0.1g,1s", "--json")["left_out"] == []


def test_azimuth_and_component_choose_the_direction(command, record):
    turned = command(*RUN, "--motion", record, "--azimuth", "75deg", "--vertical", "off", "--json")
    motion = along(shaking(), 75.0).without_vertical()
    expected = st.simulate(preset("paper-monolithic"), motion, st.HousnerBlock())
    assert turned["peak_top_displacement_m"] == pytest.approx(expected.peak_top_displacement, rel=1e-9)
    assert turned["azimuth_deg"] == 75.0
    assert any("turned to azimuth 75°" in step for step in turned["processing"])
    second = command(*RUN, "--motion", record, "--component", "2", "--json")
    assert second["azimuth_deg"] == 300.0
    assert len(second["left_out"]) == 2


def test_a_sine_along_y_is_named_by_a_plane_model(command):
    alone = command(*RUN, "--harmonic", "1Hz,0.3g,4s", "--json")
    both = command(*RUN, "--harmonic", "1Hz,0.3g,4s", "--across", "2Hz,0.15g,90deg", "--json")
    assert both["left_out"] == ["second horizontal component (peak 0.15 g)"]
    assert both["motion"] == "harmonic 1 Hz, 0.3 g along x, 2 Hz, 0.15 g, 90° along y"
    assert both["outcome"] == alone["outcome"]
    text = command(*RUN, "--harmonic", "1Hz,0.3g,4s", "--across", "2Hz,0.15g,90deg")
    assert "left out" in text
    assert "second horizontal component (peak 0.15 g)" in text


def test_the_whole_of_a_harmonic_is_turned(command):
    turned = command(*RUN, "--harmonic", "1Hz,0.4g,4s", "--azimuth", "60deg", "--json")
    half = command(*RUN, "--harmonic", "1Hz,0.2g,4s", "--json")
    assert turned["peak_top_displacement_m"] == pytest.approx(half["peak_top_displacement_m"], rel=1e-6)
    assert turned["left_out"] == ["second horizontal component (azimuth 330°, peak 0.346 g, more than along x)"]
    assert turned["azimuth_deg"] == 60.0


def test_one_record_in_several_directions(command, record, tmp_path):
    ways = ["--motion", record, "--azimuths", "75:165:2", "--signs", "both"]
    result = command(*RUN, *ways, "--out", tmp_path / "out", "--json")
    assert [run["azimuth_deg"] for run in result["runs"]] == [75.0, 75.0, 165.0, 165.0]
    assert {path.name for path in (tmp_path / "out").glob("three*")} == {
        f"three.csv_at_{angle}{sign}" for angle in (75, 165) for sign in ("", "__reversed")
    }
    once = command(*RUN, "--motion", record, "--azimuth", "75deg", "--json")
    assert result["runs"][0]["peak_top_displacement_m"] == once["peak_top_displacement_m"]
    # reversed is turned by half a turn, but for the rounding of its samples
    turned = command(*RUN, "--motion", record, "--azimuth", "255deg", "--json")["peak_top_displacement_m"]
    assert result["runs"][1]["peak_top_displacement_m"] == pytest.approx(turned, rel=1e-3)
    grid = ["--from", "0.3g", "--to", "0.9g", "--step", "0.3g", "--json"]
    critical = command("critical", *RUN[1:], *ways[:4], *grid)
    assert len(critical["records"]) == 2
    assert len(command("suite", "paper-monolithic", record, *RUN[2:], *ways[2:], "--json")["runs"]) == 4
    plain = tmp_path / "plain.txt"  # which names no azimuth
    plain.write_text("\n".join(f"{0.01 * k:.2f} {0.1 * np.sin(0.1 * k):.5f}" for k in range(300)))
    command(
        "suite", "paper-monolithic", plain, *RUN[2:], *ways[4:], "--unit", "g", "--out", tmp_path / "plain", "--json"
    )
    assert not list((tmp_path / "plain").glob("directions*"))


def test_conditioning_is_done_in_order_and_said(command, record, tmp_path):
    steps = ["--condition", "demean", "--condition", "bandpass=0.1Hz,20Hz", "--condition", "sa=1s,0.3g"]
    result = command("motion", record, *steps, "--out", tmp_path / "out", "--json")
    assert [text.split()[0] for text in result["processing"][-3:]] == ["mean", "acausal", "scaled"]
    assert result["psa_5_percent_g"]["1 s"] == pytest.approx(0.3, rel=1e-6)
    # What was written is read back as it was: the whole history is in the file.
    back = st.read_motion(tmp_path / "out" / "motion.csv")
    assert back.pga / st.g == pytest.approx(result["pga_g"]["x"], rel=1e-12)
    assert "bandpass" not in command("motion", record)
    low, high = (bandpass(shaking(), 0.1, 20.0).pga / st.g, result["pga_g"]["x"])
    assert low != high


@pytest.mark.parametrize("name", sorted(conditioning.STEPS))
def test_every_step_of_conditioning_can_be_typed(name):
    for example in conditioning.STEPS[name].example.split(" or "):
        motion = conditioning.conditioned(shaking(), example.replace("20s", "10s"))
        assert len(motion.processing) == 1


def test_a_record_scaled_by_more_than_ten_is_warned_about(record, capsys):
    assert call([*RUN, "--motion", str(record), "--scale", "12"]) == 0
    assert "three.csv is scaled by 12, more than 10 times what was recorded" in capsys.readouterr().err
    assert call([*RUN, "--harmonic", "1Hz,0.01g", "--scale", "12"]) == 0
    assert "more than 10" not in capsys.readouterr().err


def test_the_motion_is_named_after_the_file_of_the_chosen_component(command, tmp_path):
    files = [
        write_csv(st.Motion(0.01, np.sin(np.arange(300) * 0.1) * size), tmp_path / f"{size}.csv") for size in (1, 2)
    ]
    result = command(*RUN, "--motion", files[0], "--motion", files[1], "--component", "2", "--json")
    assert result["motion"] == "2.csv"


def test_a_simulated_motion(command):
    result = command(*RUN, "--synthetic", "greece,5Mw,10km,seed=2", "--pga", "0.3g", "--json")
    motion = parse_synthetic("greece,5Mw,10km,seed=2").scaled_to_pga(0.3 * st.g)
    expected = st.simulate(preset("paper-monolithic"), motion, st.HousnerBlock())
    assert result["peak_top_displacement_m"] == pytest.approx(expected.peak_top_displacement, rel=1e-9)
    grid = ["--from", "0.3g", "--to", "0.4g", "--step", "0.1g", "--json"]
    critical = command("critical", *RUN[1:], "--synthetic", "greece,5Mw,10km,seed=2", *grid)
    assert critical["runs"] == 3  # with the motion as it is
    compared = command("compare", "paper-monolithic", "--models", "housner", "--synthetic", "greece,5Mw,50km", "--json")
    assert compared["runs"][0]["outcome"] == "at_rest"


def test_the_files_of_the_components_make_one_record(command, tmp_path):
    for stream, size in (("HNE", 1.0), ("HNN", 0.5), ("HNZ", 0.2)):
        head = ("EVENT_NAME: SMALL", "NETWORK: IT", "STATION_CODE: ABC", "SAMPLING_INTERVAL_S: 0.01", "NDATA: 300",
                f"STREAM: {stream}", "UNITS: cm/s^2", "DATA_TYPE: ACCELERATION")  # fmt: skip
        values = (f"{size * 300 * math.cos(0.06 * i):.6f}" for i in range(300))
        (tmp_path / f"{stream}.asc").write_text("\n".join([*head, *values]) + "\n")
    paths = [tmp_path / f"{stream}.asc" for stream in ("HNE", "HNN", "HNZ")]
    assert command("motion", *paths, "--json")["components"] == ["x", "y", "z"]
    files = [part for path in paths for part in ("--motion", path)]
    result = command(*RUN, *files, "--azimuth", "45deg", "--json")
    assert result["vertical"] is True
    assert result["azimuth_deg"] == 45.0


# -- refused --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["spectrum", "RECORD", "--kind", "fourier"], ["--kind is 'fourier'", "response or rocking"]),
        (["spectrum"], ["no motion is given"]),
        (["spectrum", "RECORD", "--pulse", "ricker,1Hz,1g"], ["both given"]),
        (["spectrum", "RECORD", "--p", "1:2:3"], ["--p belongs to --kind rocking"]),
        (["spectrum", "RECORD", "--kind", "rocking", "--damping", "0.1"], ["--damping belongs to --kind response"]),
        (["spectrum", "RECORD", "--damping", "1.5"], ["damping is 1.5"]),
        (["spectrum", "RECORD", "--periods", "0.1:2"], ["first:last:number"]),
        (["spectrum", "RECORD", "--periods", "2:1:5"], ["the first below the last"]),
        (["spectrum", "RECORD", "--periods", "1e-5:1:5"], ["0.001 to 1000 s"]),
        (["spectrum", "RECORD", "--kind", "rocking", "--alpha", "0.1:2:4"], ["slendernesses", "from 0.01 to 1"]),
        (["spectrum", "FOLDER"], ["is a folder"]),
        (["suite", "paper-monolithic", "FOLDER", "--model", "housner", "--against", "pgx"], ["'pgx'", "pgv_m_s"]),
        (["suite", "paper-monolithic", "nowhere", "--model", "housner"], ["nowhere"]),
        (["suite", "paper-12-drums", "FOLDER", "--model", "housner"], ["12 drums"]),
        (["suite", "paper-monolithic", "FOLDER", "--model", "housner", "--also", "paper-monolithic"], ["same name"]),
        ([*RUN, "--motion", "RECORD", "--condition", "bandpas=0.1Hz,20Hz"], ["did you mean bandpass?"]),
        ([*RUN, "--motion", "RECORD", "--condition", "bandpass=0.1Hz"], ["write it as bandpass=0.1Hz,25Hz"]),
        ([*RUN, "--motion", "RECORD", "--condition", "bandpass=0.1,25"], ["'0.1' has no unit"]),
        ([*RUN, "--motion", "RECORD", "--condition", "highpass=80Hz"], ["low corner frequency is 80 Hz"]),
        ([*RUN, "--motion", "RECORD", "--condition", "pgv=0.3"], ["'0.3'", "0.3m/s"]),
        ([*RUN, "--motion", "RECORD", "--azimuth", "north"], ["--azimuth: 'north'"]),
        ([*RUN, "--motion", "RECORD", "--azimuth", "900deg"], ["azimuth is 900"]),
        ([*RUN, "--motion", "RECORD", "--component", "7"], ["no component '7'"]),
        ([*RUN, "--harmonic", "1Hz,0.1g,1s", "--component", "1"], ["--component describes a record"]),
        (
            [*RUN, "--motion", "RECORD", "--azimuth", "75"],
            ["--azimuth: '75' has no unit; write it with one, such as 75deg."],
        ),
        ([*RUN, "--motion", "RECORD", "--azimuth", "1deg", "--azimuths", "0:90:2"], ["both given"]),
        ([*RUN, "--pulse", "ricker,1Hz,1g", "--across", "1Hz,0.1g"], ["--across", "give --harmonic as well"]),
        ([*RUN, "--harmonic", "1Hz,1g", "--across", "1Hz,0.1g,5s"], ["--across", "holds a time", "1.0Hz,0.15g,90deg"]),
        ([*RUN, "--harmonic", "1Hz,1g,90deg"], ["--harmonic", "holds an angle"]),
        ([*RUN, "--harmonic", "1Hz,1g", "--across", "1Hz,?g"], ["--harmonic and --across", "write ?g for both"]),
        (
            ["compare", *RUN[1:2], "--models", "housner", "--motion", "RECORD", "--component", "all"],
            ["several motions"],
        ),
        ([*RUN, "--motion", "RECORD", "--signs", "-"], ["--signs is '-'; allowed are +, both."]),
        ([*RUN, "--motion", "RECORD", "--vertical", "down"], ["--vertical is 'down'; allowed are on, off."]),
        ([*RUN, "--synthetic", "atlantis,6Mw,20km"], ["atlantis"]),
        ([*RUN, "--synthetic", "greece,6Mw"], ["no distance"]),
        ([*RUN, "--synthetic", "greece,6Mw,20km", "--harmonic", "1Hz,0.1g,1s"], ["both given"]),
        ([*RUN, "--motion", "FOLDER", "--motion", "RECORD"], ["a folder, and other paths"]),
        (["compare", "paper-monolithic", "--models", "housner", "--motion", "FOLDER"], ["is a folder"]),
    ],
)
def test_what_cannot_be_done_is_refused(arguments, words, refused, record, folder):
    places = {"RECORD": record, "FOLDER": folder}
    message = refused(*(places.get(argument, argument) for argument in arguments))
    for word in words:
        assert word in message, message


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"\x1f\x8b\x08\x00rest", ["compressed (gzip)", "unpack"]),
        (b"\x00\x01\x02\x03" * 100, ["binary"]),
        (b"time_s,ax_furlong\n0,1\n1,1\n", ["allowed are g, m/s2"]),
        (b"time_s,ax_g\n0,1\n1,abc\n", ["line 3", "expected numbers"]),
        (b"time_s,ax_g\n0,1\n0,1\n", ["line 3", "0 s to 0 s"]),
        (b"time_s,ax_g\n", ["file"]),
        (b"PEER NGA\nA, B, C, 90\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 9, DT= .01 SEC\n1 2\n", ["promises 9"]),
        (b"PEER NGA\nA, B, C, 90\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 100000000, DT= .01\n", ["promises"]),
    ],
    ids=["compressed", "binary", "unit", "text", "step of zero", "empty", "truncated", "10⁸ samples"],
)
def test_bad_files_end_with_2_and_one_sentence(content, words, refused, tmp_path):
    path = tmp_path / "file"
    path.write_bytes(content)
    for arguments in (["motion", path], ["spectrum", path], [*RUN, "--motion", path]):
        message = refused(*arguments)
        for word in words:
            assert word in message, message


def test_what_a_record_does_not_tell_has_no_row(tmp_path, capsys):
    """An azimuth that is not known, and a label that is the axis; those that are known stand."""
    (tmp_path / "own.csv").write_text("time_s,ax_g\n0,0\n0.01,0.1\n0.02,-0.1\n0.03,0\n")
    assert call(["motion", str(tmp_path / "own.csv")]) == 0
    output = capsys.readouterr().out
    assert "azimuths" not in output
    assert "labels" not in output
    assert call(["motion", "sample:ridgecrest-2019"]) == 0
    output = " ".join(capsys.readouterr().out.split())
    assert "azimuths [degrees] x 90, y 0 labels x 90 Deg, y 360 Deg, z Up" in output
