"""
Models side by side
===================

One column, one motion, four models. They tell the same story for the first swings; then each loses
energy in its own way, and single histories part. What can be compared is how often a column falls.
"""

import numpy as np

import stylobate as st
from stylobate import plots
from stylobate.verdicts.compare import compare_domains

# %%
# The paper's monolith under a sine of 1 Hz and 0.3 g. The rigid beam is the paper's own model: a
# prism of mean width, more slender than the column, which loses nothing at impacts.

column = st.preset("paper-monolithic")
blocks = [st.HousnerBlock(), st.RigidBlock(), st.DistinctElement2D()]
models = [st.RigidBeam(), *blocks]
comparison = st.compare_models(column, st.harmonic(1.0, 0.3 * st.g, 4.0), models)
columns = ["model", "outcome", "peak_top_displacement_m"]
print(comparison.table[columns].to_string(index=False))
figure = plots.draw_comparison(comparison.responses)
figure.savefig("compare_models.png")

# %%
# Over a domain of 288 cells: the share that collapses, and in how many cells a pair disagrees.

cells = np.geomspace(0.33, 2.0, 12), np.linspace(0.15, 0.6, 24) * st.g
comparison = compare_domains(column, models, *cells, duration=6.0, tail=5.0)
for domain in comparison.domains:
    share = np.mean(domain.verdicts == "collapsed")
    print(f"{domain.model:12s} {100 * share:.0f} % of the cells")
print(comparison.table.to_string(index=False, columns=["first", "second", "differing"]))

figure = plots.draw_boundaries(comparison.domains)
figure.savefig("compare_domains.png")
