"""
From records to a fragility curve
=================================

A notebook from a folder of records to the probability of collapse over the intensity of the shaking.
Download it below, and give it your own folder.
"""

from pathlib import Path

from matplotlib.figure import Figure

import stylobate as st
from stylobate import plots
from stylobate.motion import write_csv

# %%
# A folder of records: here ten simulated ones, yours in any strong-motion format.

folder = Path("records")
folder.mkdir(exist_ok=True)
for seed in range(10):
    write_csv(st.stochastic_motion(6.6 + 0.1 * seed, 6e3, "greece", seed=seed), folder / f"record-{seed}.csv")
motions = [st.read_motion(path) for path in sorted(folder.glob("*.csv"))]

# %%
# Every record scaled until the column collapses: the levels are hunted. The runs are a pandas table.

drum = st.Drum(2.4, 0.42, 0.36, density=2600.0, section="circular")
column = st.Column.of_drums([drum], st.Joint(5e10, 2.5e10, 35.0), name="stele")
analysis = st.ida(column, motions, st.HousnerBlock(), "pgv", runs=12, tail=5.0)
analysis.runs[["record", "pgv_m_s", "verdict", "peak_top_displacement_m"]].head()

# %%
# A lognormal curve by maximum likelihood, with an interval over records.

curve = st.fragility(st.evidence(analysis.runs, "pgv", name=column.name))
low, high = curve.median_interval
print(f"half of the records collapse it at {curve.median:.2f} m/s ({low:.2f} to {high:.2f}), β {curve.beta:.2f}")

# %%
# Figures of one axes take ``ax=``: side by side, the curves of the records and what they come to.

figure = Figure(figsize=(10.0, 4.2), layout="constrained")
left, right = figure.subplots(1, 2)
plots.draw_ida(analysis, title="each record", ax=left)
plots.draw_fragility(curve, title="the curve", ax=right)
figure.savefig("notebook_fragility.png")
