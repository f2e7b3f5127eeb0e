"""
What shaking was it?
====================

Two round columns of one site: the lower one still stands, its drums a few centimetres out of place, the slender one has
fallen. Which earthquake leaves them so? The pulses that may have been are drawn, and those kept that leave what is seen.
"""

import stylobate as st
from stylobate import plots

# %%
# The columns as they were built, and what is seen of them now. Offsets are along x and y, with their error [m].

joint = st.Joint(normal_stiffness=2e9, shear_stiffness=2e9, friction_coefficient=0.67)
sizes = {"stout": (4.0, 0.85), "slender": (6.0, 0.75)}
columns = [
    st.Column.tapered(
        height=h, bottom_width=d, top_width=d, drums=3, density=2600, joint=joint, section="circular", name=n
    )
    for n, (h, d) in sizes.items()
]
seen = [
    st.Observed("stout", "stands", offsets=[(1, 0.012, 0.004, 0.003), (3, 0.030, 0.010, 0.003)]),
    st.Observed("slender", "fell", fell_towards=30.0, towards_sd=15.0),
]

# %%
# PGV and period are even in their logarithms, every direction and phase is as likely; law of contact and losses, which
# nobody has measured, are drawn as well. The stiffness of these joints is taken as known; where it is not, leave
# ``unknown_stiffness`` out: stiff joints take small steps. Several thousand draws are better.

prior = st.Prior(pgv=(0.1, 2.0), period=(0.4, 1.6), unknown_stiffness=0.0)
inference = st.infer(st.Ruin(columns, seen, prior, simulations=1000, seed=2))
print(inference.sentence)

# %%
# What each observation tells: what is left of the spread of PGV with it alone, and without it.

for row in inference.information:
    print(f"{row['observation']}: alone {row['spread_alone']:.2f}, without it {row['spread_without']:.2f}")

# %%
# The posterior, with the prior behind.

figure = plots.draw_posterior(inference)
figure.savefig("what_shaking.png")
