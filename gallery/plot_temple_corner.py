"""
The corner of a temple in an earthquake
=======================================

Three Doric columns with their capitals carry the architraves and the frieze of a corner: who falls first,
and to which side? Measures after Vitruvius (IV, 3; III, 3), module 0.4 m: shafts thirteen modules high and two thick,
5.5/6.5 as thick at the top, axes five modules apart, architrave one module high, frieze one and a half.
"""

import stylobate as st
from stylobate import plots

# %%
# Shafts in one piece; a capital is one body of three parts: neck, echinus, and an abacus of 2 1/6 modules.

law, density, top = st.Joint(5e9, 2.5e9, friction_coefficient=0.7), 2500.0, 0.677
drums = [(top, top, 0.1333, (0.0, 0.0, 0.0)), (top, 0.867, 0.1333, (0.0, 0.0, 0.1333))]
pieces = [
    *(st.Stone.drum(*sizes, density) for sizes in drums),
    st.Stone.box((0.867, 0.867, 0.1334), (0, 0, 0.2666), density),
]
parts = [part for piece in pieces for part in piece.placed]
middle = st.Stone(parts, (0.0, 0.0, 0.0), density).moments.centroid[2]

stones = []
for number, (x, y) in enumerate([(0.0, 0.0), (2.0, 0.0), (0.0, 2.0)], 1):
    stones.append(st.Stone.drum(0.8, top, 5.2, (x, y, 0.0), density, name=f"shaft {number}"))
    stones.append(st.Stone(parts, (x, y, 5.2 + middle), density, f"capital {number}"))
for name, sides, at in (
    ("architrave along x", (2.772, top, 0.4), (1.0475, 0.0, 5.6)),
    ("architrave along y", (top, 2.095, 0.4), (0.0, 1.386, 5.6)),
    ("frieze along y", (top, 2.772, 0.6), (0.0, 1.0475, 6.0)),
    ("frieze along x", (2.095, top, 0.6), (1.386, 0.0, 6.0)),
):
    stones.append(st.Stone.box(sides, at, density, name=name))
corner = st.SpatialAssembly(stones, law, name="temple corner")

# %%
# A pulse askew, and a second more. One fall is one draw of many: how sure it is, twins tell (``replicates``).

pulse = st.ricker(0.8, 0.6 * st.g)
askew = pulse.replace(lateral=0.6 * pulse.samples)
response = st.simulate(corner, askew, st.DistinctElement3D(), tail=1.0)
print("fallen, in this order:", ", ".join(response.fallen))
print(response.sentence)

figure = plots.draw_filmstrip(response)
figure.savefig("temple_corner.png")
