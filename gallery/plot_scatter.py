"""
What a survey does not know
===========================

A per cent of a drum's width or of a friction coefficient is within every survey's error. Two
hundred columns that differ by less than that do not do the same under one and the same motion:
after a few impacts rocking is chaotic, and one run is one draw.
"""

import matplotlib.pyplot as plt

import stylobate as st
from stylobate.column.scatter import twins_of
from stylobate.verdicts.verdict import wilson_interval

# %%
# Widths, heights, friction and stiffness of each drum and joint differ by 0.4 %; draws end at 2.5
# standard deviations, at a per cent.

column = st.preset("paper-12-drums")
size = 0.004
scatter = st.Scatter(friction=size, joint_stiffness=size, density=0.0, width=size, height=size, offset=0.0)
columns = twins_of(column, scatter, number=200, seed=1)
motions = [st.harmonic(frequency=0.8, amplitude=0.32 * st.g, duration=8.0)] * 200
table = st.simulate_many(columns, motions, st.DistinctElement2D(), tail=5.0)

# %%
# The answer is a count with a confidence interval, and a distribution for the columns that stand.

fallen = int(table["collapsed"].sum())
low, high = wilson_interval(fallen, len(table))
print(f"{fallen} of 200 collapse, {100 * low:.0f} to {100 * high:.0f} % (95 % confidence)")
stands = table[~table["collapsed"]]
peaks = stands["peak_top_displacement_m"] / column.base_width
print(f"the others lean by {peaks.min():.2f} to {peaks.max():.2f} base widths")

figure, axes = plt.subplots(figsize=(7.0, 3.0), layout="constrained")
axes.hist(peaks, bins=15, color="#efe6d2", edgecolor="#8c6d3f")
axes.set_title(f"{fallen} of 200 collapse; peaks of the others", loc="left")
axes.set(xlabel="peak top displacement / base width [-]", ylabel="columns")
figure.savefig("scatter.png")
