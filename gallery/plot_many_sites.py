"""
Which hazard do old monuments admit?
====================================

A column on a hill stands since antiquity, a temple in the valley has come down, an arch beside it has not moved in eight
centuries. Three hazard curves are proposed for the region. Together the monuments say which of them is too high.
"""

from pathlib import Path

import numpy as np

import stylobate as st
from stylobate import plots

# %%
# Three proposals: how often a year a PGV is exceeded, the same at both sites. The branches of a logic tree are rows.

speeds = np.geomspace(0.02, 3.0, 20)
for name, often in {"low": 0.004, "middle": 0.012, "high": 0.036}.items():
    rows = [f"{v:.4g},{often * (0.1 / v) ** 2:.4g}" for v in speeds]
    Path(f"{name}.csv").write_text("\n".join(["pgv_m_s,annual_rate", *rows]) + "\n")
tree = "".join(
    f"{name},{weight},{name}.csv,{name}.csv\n" for name, weight in [("low", 0.3), ("middle", 0.5), ("high", 0.2)]
)
Path("tree.csv").write_text("branch,weight,Hill,Valley\n" + tree)

# %%
# The monuments: what is seen of each, since when, and the PGV that half of its like do not bear, with limits that hold 95 %.

sites = ['[[sites]]\nname = "Hill"\nat = [21.90, 37.43]\n', '[[sites]]\nname = "Valley"\nat = [22.20, 37.30]\n']
for name, site, seen, median, low, high in [
    ("column", "Hill", 'seen = "stands"\nage = [2380, 2450]', 0.70, 0.45, 1.0),
    ("temple", "Valley", 'seen = "reached"\nage = 2480\nuntil = [1400, 1500]', 0.60, 0.4, 0.9),
    ("arch", "Valley", 'seen = "stands"\nstate = "drums:0.01d"\nage = 800', 0.30, 0.2, 0.45),
]:
    bears = f'im = "pgv"\nmedian = {median}\nmedian_95 = [{low}, {high}]\nbeta = 0.5\nbeta_95 = [0.35, 0.7]'
    sites.append(f'[[monuments]]\nname = "{name}"\nsite = "{site}"\n{seen}\n{bears}\n')
Path("sites.toml").write_text('branches = "tree.csv"\n' + "".join(sites))

# %%
# ``stylobate survival sites.toml`` does the same.

weighing = st.weigh(st.read_sites("sites.toml"))
for branch, before, after in zip(weighing.sites.branches, weighing.prior, weighing.weight):
    print(f"{branch.name}: {before:.2f} before, {after:.3f} after")
figure = plots.draw_weighing(weighing)
figure.savefig("many_sites.png")
