"""Real files of many networks: peaks, steps, directions and counts as their publishers state them."""

import csv
import hashlib
import warnings

import numpy as np
import pytest
from records import FOLDER, SHIPPED, content, needs_folder, record

from stylobate.constants import g
from stylobate.errors import InputError, OutOfRangeWarning
from stylobate.motion import bandpass, demean, displacement, integrate, read_motion, response_spectrum, taper


def read(name, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OutOfRangeWarning)
        return read_motion(record(name), **options)


def test_samples_are_the_files_as_published():
    assert len(SHIPPED) == 7
    for name, sample in SHIPPED.items():
        assert hashlib.sha256(sample.data).hexdigest() == sample.sha256
        if (FOLDER / name).is_file():
            assert sample.data == (FOLDER / name).read_bytes()


# file, peaks of x, y, z in g as the file's own header states them, step, azimuths of x and y
STATED = [
    ("csmip_v1_Northridge1994_LA116thSt.RAW", (0.200, 0.143, 0.060), 0.001, (90.0, 0.0)),
    ("csmip_v1_Ridgecrest2019_ChinaLake_CLC.v1", (0.344, 0.511, 0.347), 0.01, (90.0, 0.0)),
    ("csmip_v1_Ridgecrest2019_ChinaLake_CCC.RAW", (0.567, 0.471, 0.361), 0.01, (90.0, 0.0)),
    ("csmip_v2_Coalinga1983_ParkfieldFZ14.V2", (267.957 / 981.0, 256.231 / 981.0, 94.805 / 981.0), 0.02, (90.0, 0.0)),
    ("csmip_v2_SouthNapa2014_CE58667.V2", (27.114 / 981.0, 26.411 / 981.0, 11.244 / 981.0), 0.01, (None, None)),
    ("cosmos_v1_format_example.v1", (161.962 / 981.0,), 0.01, (340.0,)),
    ("geonet_v1a_Kaikoura2016_HSES.V1A", (2394.8 / 9810, 2584.4 / 9810, 1589.9 / 9810), 0.005, (10.0, 280.0)),
    ("geonet_v2a_Waipukurau2018_WPWS.V2A", (41.6 / 9810, 194.0 / 9810, 27.3 / 9810), 0.02, (196.0, 106.0)),
    ("smc_v2_LomaPrieta1989_1295Shafter_360.smc", (104.4078 / 981.0,), 0.005, (0.0,)),
    ("smc_v1_LomaPrieta1989_DelValleDam_065.smc", (80.19088 / 981.0,), 8.75e-5, (65.0,)),
    ("twocol_ElCentro1940_NS.dat", (0.34873739,), 0.02, (None,)),
]


@pytest.mark.parametrize(("name", "peaks", "dt", "azimuths"), STATED, ids=[row[0] for row in STATED])
def test_peaks_steps_and_directions(name, peaks, dt, azimuths):
    motion = read(name)
    actual = [np.abs(values).max() / g for values in motion.components.values()]
    assert len(actual) == len(peaks)
    # Volume 1 rounds to 0.001 g.
    assert actual == pytest.approx(peaks, rel=1e-4, abs=6e-4 if "csmip_v1" in name else 0.0)
    assert motion.dt == dt
    assert tuple(motion.metadata["azimuths"][axis] for axis in "xy"[: len(azimuths)]) == azimuths


@needs_folder
def test_every_peak_of_the_manifest():
    checked = 0
    with (FOLDER / "manifest.csv").open() as table:
        for row in csv.DictReader(table):
            if not row["pga_g"]:
                continue
            name = row["file"]
            motion = read(name, **({"component": 1} if "BNZ" in name else {}))
            horizontal = [np.abs(motion.acceleration).max()] + (
                [np.abs(motion.lateral).max()] if motion.lateral is not None else []
            )
            assert max(horizontal) / g == pytest.approx(float(row["pga_g"]), rel=2e-3, abs=6e-5), name
            checked += 1
    assert checked >= 11


def test_counts_become_acceleration_by_the_header_s_sensitivity():
    motion = read("cosmos_v0c_FortBragg_NP1795.v0c")
    # 0.794729 µV per count over 1.2 V/g, about the mean that the header states; it holds the peak as 985881 counts.
    assert motion.pga / g == pytest.approx((985881 - 982511.90315) * 0.794729e-6 / 1.2, rel=1e-6)
    assert (motion.dt, motion.steps, motion.metadata["stage"]) == (0.005, 20000, "raw counts")
    assert all("zero level" in step for step in motion.processing)


def test_unequal_components_are_cut_and_it_is_said():
    with pytest.warns(OutOfRangeWarning, match="common length of 31932"):
        motion = read_motion(record("csmip_v1_Ridgecrest2019_ChinaLake_CLC.v1"))
    assert "x: 31932, y: 32080, z: 32190" in motion.processing[0]


def test_digitised_film_keeps_every_sample():
    motion = read("csmip_v1_Northridge1994_LA116thSt.RAW")
    assert motion.metadata["unit"] == "g/10"
    assert motion.acceleration[11576] / g == pytest.approx(-0.2003, abs=1e-9)
    assert any("unequal steps" in step for step in motion.processing)


def test_a_single_vertical_component_is_refused_unless_chosen():
    name = "cosmos_v2c_Anchorage2018_AK.BMR.BNZ.V2c"
    with pytest.raises(InputError, match="only the vertical component 'BNZ'"):
        read(name)
    motion = read(name, component="BNZ")
    assert motion.pga == pytest.approx(0.06851512, rel=1e-5)


def test_a_file_without_unit_is_refused_but_that_of_a_sample_is_known(tmp_path):
    path = tmp_path / "elcentro.dat"
    path.write_bytes(content("twocol_ElCentro1940_NS.dat"))
    with pytest.raises(InputError, match="`unit='g'`"):
        read_motion(path)
    assert read_motion(path, "g").digest == read("twocol_ElCentro1940_NS.dat").digest
    with pytest.raises(InputError, match="leave the unit out"):
        read("twocol_ElCentro1940_NS.dat", unit="gal")


def test_both_components_of_miniseed_with_the_station_s_sensitivity():
    pytest.importorskip("obspy")
    names = ["mseed_Ridgecrest2019_CI.CLC.HNE.mseed", "mseed_Ridgecrest2019_CI.CLC.HNN.mseed"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        motion = read_motion([record(name) for name in names])
        described = read_motion([record(name) for name in [*names, "mseed_Ridgecrest2019_CI.CLC.stationxml.xml"]])
    # The same station's volume 1 states 0.344 g and 0.511 g for the instrument's nominal sensitivity.
    assert motion.pga / g == pytest.approx(0.344, rel=5e-3)
    assert np.abs(motion.lateral).max() / g == pytest.approx(0.511, rel=5e-3)
    assert motion.metadata["azimuths"] == {"x": 90.0, "y": 0.0}
    assert described.digest == motion.digest
    with pytest.raises(InputError, match="describes a station"):
        read("mseed_Ridgecrest2019_CI.CLC.stationxml.xml")


def test_a_stray_line_beyond_the_promised_numbers_is_left_out_and_said():
    motion = read("smc_v1_LomaPrieta1989_DelValleDam_065.smc")
    assert "8 numbers beyond the 41240 that the header promises" in motion.processing[0]
    assert motion.duration == pytest.approx(29.655, abs=1e-3)


@pytest.mark.parametrize("name", [row[0] for row in STATED])
def test_a_file_that_ends_early_is_refused(name, tmp_path):
    lines = content(name).splitlines(keepends=True)
    path = tmp_path / name
    path.write_bytes(b"".join(lines[: len(lines) * 2 // 5]))
    if name.startswith("twocol"):
        assert read_motion(path, unit="g").steps < 2688  # nothing in it says how long it should be
        return
    with pytest.raises(InputError, match=r"promises|ends within|describes|expected|without the mark"):
        read_motion(path)


def test_spectrum_of_el_centro_against_the_matrix_exponential():
    from scipy.linalg import expm

    motion = read("twocol_ElCentro1940_NS.dat")
    a, z = motion.acceleration, 0.05
    for period, parts in ((0.1, 40), (0.5, 20), (2.0, 20)):
        w, h = 2.0 * np.pi / period, motion.dt / parts
        system = np.array([[0, 1, 0, 0], [-w * w, -2 * z * w, 1, 0], [0, 0, 0, 1], [0, 0, 0, 0]], dtype=float)
        step, state, peak = expm(system * h), np.zeros(4), 0.0
        for i in range(1500):  # its strong part is over after 30 s
            state[2], state[3] = -a[i], -(a[i + 1] - a[i]) / motion.dt
            for _ in range(parts):
                state = step @ state
                peak = max(peak, abs(state[0]))
        assert response_spectrum(motion, [period], z).sd[0] == pytest.approx(peak, rel=1e-3)


@pytest.mark.parametrize("name", ["csmip_v1_Ridgecrest2019_ChinaLake_CLC.v1", "geonet_v1a_Kaikoura2016_HSES.V1A"])
def test_a_processed_record_returns_to_rest(name):
    motion = bandpass(taper(demean(read(name), 5.0), 2.0), 0.05, 40.0)
    for values in motion.components.values():
        v, d = integrate(values, motion.dt), displacement(values, motion.dt)
        assert abs(v[-1]) < 1e-6 * np.abs(v).max()
        assert abs(d[-1]) < 1e-4 * np.abs(d).max()
    assert len(motion.processing) >= 3
