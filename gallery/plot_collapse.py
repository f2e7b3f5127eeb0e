"""
A collapse, followed to the ground
==================================

Which drums fall, to which side, and when? Distinct elements go on after the verdict is certain: drums
roll, strike one another and the ground, and come to rest.
"""

import stylobate as st
from stylobate import plots

# %%
# Twelve drums under a slow and strong shaking.

column = st.preset("paper-12-drums")
motion = st.harmonic(frequency=0.66, amplitude=0.35 * st.g, duration=6.0)
response = st.simulate(column, motion, st.DistinctElement2D(), until_rest=True)

# %%
# The mechanism in words, and the energy that the ledger misses, of all that the fall released.

print(response.mechanism.describe())
missed = response.energy_imbalance
print(f"energy not accounted for: {100 * missed:.2f} % of the released")

# %%
# Where each drum lies is one of many possible ends, not a prediction. On the command line,
# ``stylobate animate response.nc`` makes a film of it.

figure = plots.draw_filmstrip(response)
figure.savefig("collapse.png")
