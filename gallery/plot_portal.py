"""
Two columns and an architrave
=============================

Any set of convex blocks can be shaken: here two monolithic columns that carry an architrave, nothing
mortared. A rocking frame surprises: a heavy beam on top does not make it rock earlier. It begins at
g tan α of its columns, as each of them would alone (Makris and Vassiliou 2013).
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as st

# %%
# Blocks by their corners [m]; the ground is there by itself. Columns of 0.8 × 4.0 m: tan α = 0.2.


def box(name, left, low, width, height):
    corners = [(0, 0), (width, 0), (width, height), (0, height)]
    corners = [(left + x, low + z) for x, z in corners]
    return st.Block(corners, density=2500.0, name=name, depth=0.8)


blocks = [box("left", 0.0, 0.0, 0.8, 4.0), box("right", 3.2, 0.0, 0.8, 4.0)]
blocks.append(box("architrave", -0.1, 4.0, 4.2, 0.7))
portal = st.Assembly(blocks, st.Joint(5e10, 2.5e10, friction_angle=35.0), name="portal")

# %%
# Half a second of constant acceleration on either side of 0.2 g.

for amplitude in (0.19, 0.21):
    push = st.rectangular_pulse(1.0, amplitude * st.g, duration=1.5)
    moved = st.simulate(portal, push, st.DistinctElement2D()).summary()["peak_displacement_m"]
    print(f"{amplitude} g: moves by {1000 * moved:.1f} mm")

# %%
# And until it lies on the ground, under a sine of 0.7 Hz and 0.4 g.

shaking = st.harmonic(0.7, 0.4 * st.g, duration=6.0)
response = st.simulate(portal, shaking, st.DistinctElement2D(), until_rest=True)
print("fallen:", ", ".join(response.fallen))

figure, panels = plt.subplots(1, 5, figsize=(9.0, 1.8), layout="constrained")
for panel, time in zip(panels, (0.0, 2.7, 3.9, 4.6, response.time[-1])):
    index = int(np.abs(response.time - time).argmin())
    for body in (1, 2, 3):  # body 0 is the ground
        panel.fill(*response.outline(index, body).T, color="#efe6d2", ec="#8c6d3f")
    panel.axhline(0.0, color="black")
    panel.set(xlim=(-1, 11), ylim=(-0.2, 5), aspect="equal", title=f"{time:.1f} s")
    panel.set_axis_off()
figure.savefig("portal.png")
