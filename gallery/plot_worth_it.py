"""
Is this measure worth it?
=========================

A column of three drums, as built, with dowels of titanium in its joints, and with a core through all drums. The same
motions shake all three, so that what one measure changes can be told from what the motions do.
"""

import numpy as np

import stylobate as st
from stylobate import plots
from stylobate.motion.intensity import parse_measure

# %%
# Two dowels of 30 mm in each joint between drums, with a millimetre of slack; a bar of 26 mm in the axis, pretensioned to
# a third of the weight. Stiffness and capacity follow from material and size, by formulas that the results name.

joint = st.Joint(1e10, 5e9, friction_coefficient=0.7)
size = {"height": 4.5, "bottom_width": 0.75, "top_width": 0.6, "drums": 3, "density": 2600.0}
column = st.Column.tapered(**size, joint=joint)
dowel = {"diameter": 0.03, "embedment": 0.1, "clearance": 0.001, "material": "titanium"}
dowels = [st.Dowel(joint=j, at=(x, 0.0), **dowel) for j in (2, 3) for x in (-0.15, 0.15)]
core = st.Core(diameter=0.026, material="stainless steel", pretension=column.mass * st.g / 3)
states = {"as built": column, "dowels": column.replace(links=dowels), "core": column.replace(links=[core])}

# %%
# Twelve pulses from 0.5 to 1.6 Hz, each at five peaks. The intervals are over motions, which are the same for all.

motions = [st.ricker(f, st.g).replace(name=f"{f:.1f} Hz") for f in np.linspace(0.5, 1.6, 12)]
levels = [0.2, 0.35, 0.5, 0.7, 0.9]  # g
comparison = st.compare_states(states, motions, st.DistinctElement2D(), levels, parse_measure("pga"), tail=3.0)
for difference in comparison.differences:
    print(difference.sentence)
print(comparison.links.to_string(index=False, float_format="{:.2f}".format))
figure = plots.draw_states(comparison)
figure.savefig("worth_it.png")
