"""
A podium in every direction
===========================

Four columns under a slab rock together, whichever way they are pushed. Square ones bear most over a
corner, round ones the same all round: limit analysis in space against b/h over the larger cosine.
"""

import numpy as np

import stylobate as st
from stylobate import plots

# %%
# Columns of 0.8 × 4.0 m at the corners of a square, square or round, and a slab over them [m].

law = st.Joint(5e9, 2.5e9, friction_coefficient=0.7)
feet = [(x, y, 0.0) for x in (-1.2, 1.2) for y in (-1.2, 1.2)]
names = ["south-west", "north-west", "south-east", "north-east"]
slab = st.Stone.box((3.4, 3.4, 0.3), (0.0, 0.0, 4.0), 2700.0, name="slab")
square = [st.Stone.box((0.8, 0.8, 4.0), at, 2700.0, name=name) for at, name in zip(feet, names)]
drums = [st.Stone.drum(0.8, 0.8, 4.0, at, 2700.0, name=name) for at, name in zip(feet, names)]

# %%
# Forces in proportion to mass, towards every fifteen degrees.

azimuths = np.arange(0.0, 360.0, 15.0)
for name, columns in (("square", square), ("round", drums)):
    podium = st.SpatialAssembly([*columns, slab], law, name=f"podium of {name} columns")
    limits = st.limit_directions(podium, azimuths)
    weak, most = limits.weakest, limits.multipliers.max()
    print(
        f"{name}: {weak.multiplier:.4f} g at {weak.azimuth:g}°, at most {most:.4f} g; moving: {', '.join(weak.moving)}"
    )

# %%
# What stands, from two sides and from above.

figure = plots.draw_views(podium, podium.name)
plots.save(figure, "in_space")
