"""
A safe–unsafe domain
====================

What falls, over frequency and amplitude of a harmonic shaking: the picture by which the literature
compares columns. Every cell is one history of ten seconds, and five more to come to rest.
"""

import numpy as np

import stylobate as st
from stylobate import plots

# %%
# Four drums of 4.2 m in all, in 24 × 24 cells.

joint = st.Joint(normal_stiffness=5e10, shear_stiffness=2.5e10, friction_angle=33.0)
column = st.Column.tapered(
    height=4.2,
    bottom_width=0.80,
    top_width=0.66,
    drums=4,
    density=2500.0,
    section="circular",
    joint=joint,
    name="four drums",
)
cells = np.geomspace(0.4, 4.0, 24), np.linspace(0.1, 1.0, 24) * st.g
domain = st.collapse_domain(column, st.DistinctElement2D(), *cells, tail=5.0)

# %%
# A slow shaking acts like a static push: the boundary begins at the acceleration that opens a joint.
# The faster it turns round, the stronger it must be. Cells whose run ended while the column was
# still far from rest would be *undecided*, neither safe nor unsafe.

print(domain.counts)
first = np.nanmin(domain.first_collapse)
print(f"smallest amplitude that collapses it {first / st.g:.2f} g", end=", ")
print(f"a joint opens at {column.uplift_acceleration / st.g:.2f} g")

figure = plots.draw_domain(domain)
figure.savefig("domain.png")
