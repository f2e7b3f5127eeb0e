"""
A column as found
=================

Centuries leave drums out of place, edges chipped and bases out of level. These are not random variations
but facts of one column, and they make it weaker towards one side. A survey can tell; the column as it
was built cannot.
"""

import stylobate as st
from stylobate import plots

# %%
# The base has lost 12 cm of its right edge, the fifth drum and what it carries stand 40 mm to the right,
# and the ground falls by half a degree to that side.

built = st.preset("paper-12-drums").replace(name="as built")
drums = st.FoundDrum(1, chip_right=0.12), st.FoundDrum(5, offset=0.04)
damaged = built.replace(as_found=st.AsFound(drums, base_tilt=-0.5), name="as found")
for column in (built, damaged):
    uplift = column.uplift_acceleration / st.g
    print(f"{column.name}: a joint opens at {uplift:.3f} g")

# %%
# What cannot stand by itself is refused, with the joint and the moment that is missing.

try:
    built.replace(as_found=st.AsFound(base_tilt=-15.0))
except st.InputError as refusal:
    print("refused:", refusal)

# %%
# The smallest pulse that brings it down: as built, as found, and as found with the pulse turned round.

pulse = st.ricker(0.8, 1.0, duration=8.0)
grid = {"start": 0.1 * st.g, "stop": 0.9 * st.g, "step": 0.02 * st.g}
for column, sign in ((built, 1), (damaged, 1), (damaged, -1)):
    turned = pulse.scaled(sign)
    result = st.critical_amplitude(column, turned, st.DistinctElement2D(), **grid)
    print(f"{column.name}, pulse × {sign:+d}: {result.critical / st.g:.2f} g")

response = st.simulate(damaged, st.ricker(0.8, 0.4 * st.g), st.DistinctElement2D())
figure = plots.draw_filmstrip(response)
figure.savefig("as_found.png")
