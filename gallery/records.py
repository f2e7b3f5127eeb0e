"""
The paper's columns under recorded earthquakes
==============================================

What does a real earthquake do to the monolithic column and to the one of twelve drums? Every record that lies in a folder is
read, whatever its format. Each shakes both columns, as plane distinct elements, in the direction of its first horizontal
component, with its vertical component and without it.

``python gallery/records.py FOLDER`` takes a folder of your own. Without one, the folder ``shared/records`` beside
the project
is taken where there is one, and else a few simulated motions.
"""

import sys
import warnings
from pathlib import Path

from stylobate.analysis.suite import suite_table
from stylobate.column import preset
from stylobate.errors import OutOfRangeWarning
from stylobate.models.distinct_element_2d import DistinctElement2D
from stylobate.motion import read_suite, stochastic_motion

COLUMNS = [preset("paper-monolithic"), preset("paper-12-drums")]


def motions_in(folder):
    """Records of a folder, with what was cut, resampled or left out said in their history."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OutOfRangeWarning)  # unequal lengths are cut, and stand in the history
        suite = read_suite(folder, unit="g")
    for name, reason in suite.refused.items():
        print(f"not used: {name}: {reason}")
    return list(suite.motions)


def simulated():
    """Motions of a moderate earthquake near a site on rock in Greece."""
    return [stochastic_motion(6.8, distance, "greece", seed=seed) for distance in (5e3, 15e3) for seed in (1, 2)]


# %%
# The table
# ---------
# A column whose ratio PGA/(g tan α) stays below one is rigid, and hardly opens a joint. Beyond it the peak
# displacement follows
# the velocity of the ground, hence the length of its pulses, more than its acceleration.


def table_of(motions):
    """One row per record and column; records with a vertical component once more without it."""
    plain = [motion.without_vertical() for motion in motions if motion.vertical is not None]
    return suite_table(COLUMNS, [*motions, *plain], DistinctElement2D())


def compare_verticals(table):
    """Peak displacement with and without the vertical component, where a record has one and a joint opened."""
    both = table[table["outcome"] != "at_rest"].pivot_table(
        index=["record", "column"], columns="vertical", values="peak_top_displacement_m"
    )
    return both.dropna().rename(columns={True: "with", False: "without"})


def draw(table):
    """Peak top displacement against the peak velocity of the ground."""
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6.0, 4.0), layout="constrained")
    for (column, rows), marker in zip(table.groupby("column"), "os"):
        width = next(one.base_width for one in COLUMNS if one.name == column)
        axes.loglog(rows["pgv_m_s"], rows["peak_top_displacement_m"] / width, marker, label=column, mfc="none")
    axes.set_xlabel("peak ground velocity [m/s]")
    axes.set_ylabel("peak top displacement / base width [-]")
    axes.legend()
    return figure


# %%
# What it means
# -------------
# Under the thirteen records of that folder neither column falls: they are what recorded shaking mostly is, not what a column
# of this size fears, which is a pulse of a second and more. Below PGA/(g tan α) = 1 the monolith stays closed. The column of
# drums mostly moves less than the monolith under the strong records, because it loses energy at every joint. The vertical
# component changes the peak of a rocking column by between a few per cent and a factor of two and a half, mostly but not
# always upward: no more than other small changes of the input do, once a column of drums rocks.

if __name__ == "__main__":
    beside = Path.cwd().parent / "shared" / "records"
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else beside
    motions = motions_in(folder) if folder.is_dir() else simulated()
    found = table_of(motions)
    shown = [
        "record",
        "column",
        "vertical",
        "pga_g",
        "pgv_m_s",
        "pga_over_g_tan_alpha",
        "outcome",
        "peak_top_displacement_m",
    ]
    print(found[shown].to_string(float_format="{:.3g}".format))
    print(compare_verticals(found).to_string(float_format="{:.3g}".format))
    monolith = found[(found["column"] == COLUMNS[0].name) & (found["pga_over_g_tan_alpha"] < 0.95)]
    assert (monolith["outcome"] == "at_rest").all()  # rigid below its static uplift acceleration
    draw(found)
