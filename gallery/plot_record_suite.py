"""
A suite of records
==================

Which is the safer one, the monolith or the column of drums? One record cannot say. A suite shows each
column under each record, beside how strong the record is.

``python gallery/plot_record_suite.py FOLDER`` takes the records of a folder, of whatever format.
Without one, motions are simulated.
"""

import sys

import stylobate as st
from stylobate import plots
from stylobate.motion import with_directivity_pulse

# %%
# Simulated: magnitude 6.5 at 15 km, with a directivity pulse of 0.3 g. All have nearly the same PGA;
# the period of the pulse grows from 0.6 to 2.7 s.


def near_fault(period, seed):
    pulse = st.mavroeidis_papageorgiou(frequency=1 / period, amplitude=0.3 * st.g)
    far = st.stochastic_motion(6.5, 15e3, "greece", seed=seed)
    return with_directivity_pulse(far, pulse)


if len(sys.argv) > 1:
    suite = st.read_suite(sys.argv[1])
    motions = suite.motions
    print("not used:", suite.refused)
else:
    motions = [near_fault(0.6 + 0.3 * seed, seed) for seed in range(8)]

# %%
# What grows with the period, and decides, is the velocity of the ground, not its acceleration.

columns = [st.preset("paper-monolithic"), st.preset("paper-12-drums")]
table = st.suite_table(columns, motions, st.DistinctElement2D(), tail=5.0)
shown = ["number", "column", "pga_g", "pgv_m_s", "verdict"]
shown.append("peak_top_over_base_width")
print(table[shown].to_string(index=False, float_format="{:.2f}".format))

figure = plots.draw_suite(table, against="pgv_m_s")
figure.savefig("record_suite.png")
