"""
Probability of collapse
=======================

The boundary of a safe–unsafe domain is a band, not a line. With many columns like this one in
every cell the domain becomes a map of probabilities, and the width of the band can be read off.
"""

import numpy as np

import stylobate as st
from stylobate import plots

# %%
# Twenty columns in each of 16 × 16 cells, 5,120 histories; the same twenty go through every cell.

result = st.collapse_probability(
    st.preset("paper-monolithic"),
    st.DistinctElement2D(),
    frequencies=np.geomspace(0.5, 2.5, 16),
    amplitudes=np.linspace(0.15, 0.9, 16) * st.g,
    duration=6.0,
    replicates=20,
    tail=5.0,
)

# %%
# In a quarter of the cells, or more, a single run would have tossed a coin.

kinds, cells = np.unique(result.kinds, return_counts=True)
print(", ".join(f"{kind} in {count} cells" for kind, count in zip(kinds, cells)))
width = np.nanmedian(result.band_width) / st.g
print(f"the band is {width:.2f} g wide in the median")

figure = plots.draw_probability(result)
figure.savefig("probability.png")
