"""
A study that grows
==================

Columns like this one under several records at several strengths: how large is the share that collapses? What has been
run is kept, so that a larger study computes only what is new.
"""

from pathlib import Path

import stylobate as st
from stylobate import plots
from stylobate.motion.intensity import parse_measure

column = st.preset("paper-monolithic")
records = [st.stochastic_motion(6.5, 15e3, "greece", seed=seed) for seed in range(10)]
levels = [0.2, 0.4, 0.6, 0.8, 1.0, 1.2]  # of the peak velocity [m/s]
Path("study").mkdir(exist_ok=True)

# %%
# Ten records, six levels, four columns that differ as masons would have made them; then twice as many columns.

for replicates in (4, 8):
    study = st.Study([column], records, [st.HousnerBlock()], levels, parse_measure("pgv"), replicates=replicates)
    result = st.run_study(study, "study")
    print(f"{len(result.plan)} cases, {result.computed} of them computed now")

# %%
# The table holds every case with what it is, how strong its motion was in all measures, and what came of it.

print(result.table.groupby("im")["collapsed"].mean().to_string())
curve = st.fragility(st.evidence(result.table, "pgv", name=column.name))
figure = plots.draw_fragility(curve)
figure.savefig("study.png")
