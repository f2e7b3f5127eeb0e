"""Lines that name columns: every word is understood, and every number goes where its name says; or the file is refused."""

import numpy as np
import pytest

from stylobate.constants import g
from stylobate.errors import InputError
from stylobate.motion import read_motion

WAVES = np.round(np.random.default_rng(3).normal(0.0, 0.2, (30, 6)), 3)


@pytest.fixture
def read(tmp_path):
    """The motion of a file with a header over times and as many of the waves as it names."""

    def of(header, columns, unit="g", *, timed=True, dt=None):
        time = [[f"{0.01 * i:.2f}"] if timed else [] for i in range(len(WAVES))]
        rows = [" ".join([*t, *(f"{value:.3f}" for value in row[:columns])]) for t, row in zip(time, WAVES)]
        path = tmp_path / "record.txt"
        path.write_text("\n".join([header, *rows, ""]), encoding="utf-8")
        return read_motion(path, unit, dt)

    return of


def places(motion):
    """Which wave each axis holds, from 1, negative where it was turned."""
    found = {}
    for axis, values in motion.components.items():
        [place] = [
            sign * (k + 1)
            for k in range(6)
            for sign in (1, -1)
            if np.allclose(values, sign * g * WAVES[:, k], rtol=1e-12)
        ]
        found[axis] = place
    return found


@pytest.mark.parametrize(
    ("header", "wanted"),
    [
        ("time az ax ay", {"x": 2, "y": 3, "z": 1}),
        ("time ay ax", {"x": 2, "y": 1}),
        ("time vertical longitudinal transverse", {"x": 2, "y": 3, "z": 1}),
        ("Zeit Z N E", {"x": 2, "y": 3, "z": 1}),
        ("time, L, V, T", {"x": 1, "y": 3, "z": 2}),
        ("T L V", {"x": 1, "z": 2}),
        ("time, E; up | N", {"x": 1, "y": 3, "z": 2}),
        ("time acc Z acc Y acc X", {"x": 3, "y": 2, "z": 1}),
        ("time accUD accN accE", {"x": 2, "y": 3, "z": 1}),
        ("time Up Down North South East West", {"x": 2, "y": 3, "z": 1}),
        ("time HNZ HN1 HN2", {"x": 2, "y": 3, "z": 1}),
        ("time N10E UP N80W", {"x": 1, "y": 3, "z": 2}),
        ("time down east north", {"x": 2, "y": 3, "z": -1}),
        ("time Z(-) E N", {"x": 2, "y": 3, "z": -1}),
        ("time radial vertical transverse", {"x": 1, "y": 3, "z": 2}),
        ("time H1 V H2", {"x": 1, "y": 3, "z": 2}),
        ("Zeit N O Z", {"x": 1, "y": 2, "z": 3}),
        ("temps haut nord est", {"x": 2, "y": 3, "z": 1}),
        ("tempo verticale longitudinale trasversale", {"x": 2, "y": 3, "z": 1}),
        ("tiempo arriba norte oeste", {"x": 2, "y": 3, "z": 1}),
        ("Χρόνος Κατακόρυφη Β-Ν Α-Δ", {"x": 2, "y": 3, "z": 1}),
        ("ZAMAN DÜŞEY KUZEY DOĞU", {"x": 2, "y": 3, "z": 1}),
        ("zaman D-B K-G düşey", {"x": 1, "y": 2, "z": 3}),
    ],
)
def test_numbers_go_where_their_names_say(read, header, wanted):
    columns = max(map(abs, wanted.values()))
    for mark in ("", "# ", "%"):
        assert places(read(mark + header, columns)) == wanted
    assert places(read(f"{header}\n# station: Athens\n---------", columns)) == wanted


@pytest.mark.parametrize(
    ("header", "wanted"),
    [
        ("% time[s] accZ[g] accX[g] accY[g]", {"x": 2, "y": 3, "z": 1}),
        ("time_s,UD_g,EW_g,NS_g", {"x": 2, "y": 3, "z": 1}),
        ("t/s az/g ax/g", {"x": 2, "z": 1}),
        ("Time, s; UD, g; EW, g", {"x": 2, "z": 1}),
        ("time az ax\ns g g", {"x": 2, "z": 1}),
        ("# unit: g\ntime az ax", {"x": 2, "z": 1}),
    ],
)
def test_units_in_names_count_and_so_do_the_names(read, header, wanted):
    columns = max(wanted.values())
    motion = read(header, columns, None)
    assert places(motion) == wanted
    assert places(read(header, columns, "g")) == wanted
    with pytest.raises(InputError, match="says g, but unit is given as 'gal'"):
        read(header, columns, "gal")


def test_each_column_has_its_own_unit(read):
    motion = read("time_s,EW_gal,NS_cm/s2,UD_m_s2", 3, None)
    assert motion.acceleration == pytest.approx(0.01 * WAVES[:, 0])
    assert motion.lateral == pytest.approx(0.01 * WAVES[:, 1])
    assert motion.vertical == pytest.approx(WAVES[:, 2])
    assert motion.metadata["azimuths"] == {"x": 90.0, "y": 0.0, "z": None}


@pytest.mark.parametrize(
    ("header", "columns", "said"),
    [
        ("time, displacement velocity acceleration", 3, "names column 2 as a displacement"),
        ("time displacement velocity acceleration", 3, "names column 2 as a displacement"),
        ("#t u v a", 3, "only accelerations are read"),
        ("# time vel acc", 2, "names column 2 as a velocity"),
        ("time_s,ax_g,vx", 2, "names column 3 as a velocity"),
        ("time (s), EW (cm/s)", 1, "names column 2 as a velocity"),
        ("time (s)  NS (cm)  EW (cm)", 2, "names column 2 as a displacement"),
        ("Zeit Geschwindigkeit", 1, "velocity"),
        ("χρόνος ταχύτητα", 1, "velocity"),
        ("zaman hız", 1, "velocity"),
        ("t x v", 2, "name the columns as in"),
        ("time D N E", 3, "name the columns as in"),
        ("time x y v", 3, "may mean a displacement or a velocity by 'V'"),
        ("time acceleration [V]", 1, "holds 'V'"),
        ("t ẋ", 1, "holds 'ẋ'"),
        ("time N O Z", 3, "holds 'O'"),
        ("idő függőleges", 1, "holds 'idő'"),
        ("time ax foo", 2, "line 1: 'time ax foo' holds 'foo'"),
        ("time BHZ BHN", 2, "holds 'BHZ'"),
        ("time N S", 2, "not at right angles"),
        ("time X N", 2, "do not belong together"),
        ("time ay az", 2, "no column holds the horizontal acceleration"),
        ("time Z V N", 3, "1 horizontal and 2 vertical"),
        ("time N", 1, "may mean something else than a direction"),
        ("time ax ay", 3, "names 3 columns"),
        ("Recorded in Athens", 1, "holds 'Recorded'"),
        ("# Column 1: time\n# Column 2: vertical\n# Column 3: east", 2, "line 3"),
        ("time az ax ay\ntime ax ay az", 3, "name different columns"),
        ("ax ay", 1, "the first column grows in equal steps"),
    ],
)
def test_what_is_not_understood_is_refused_with_its_line(read, header, columns, said):
    with pytest.raises(InputError, match=said):
        read(header, columns)


def test_facts_of_the_whole_record_are_no_names(read):
    for header in ("# station: North Bay", "NPTS= 30, DT= 0.01 SEC", "# date: 1999-08-17", "acceleration in g"):
        assert places(read(header, 3)) == {"x": 1, "y": 2, "z": 3}
