"""
Fragility and survival
======================

How probable is the collapse of this column in an earthquake of a given strength? And how probable is it
then that it has stood since antiquity? Each record is scaled until the column collapses.
"""

import numpy as np

import stylobate as st
from stylobate import plots
from stylobate.motion import with_directivity_pulse
from stylobate.probability.ida import which_tells_most
from stylobate.probability.risk import Hazard

# %%
# Twelve simulated near-fault motions: magnitude 6.5 at 15 km, with pulses of 1.2 to 2.5 s.


def near_fault(period, seed):
    pulse = st.mavroeidis_papageorgiou(frequency=1 / period, amplitude=0.3 * st.g)
    far = st.stochastic_motion(6.5, 15e3, "greece", seed=seed)
    return with_directivity_pulse(far, pulse).replace(name=f"pulse of {period:.2f} s")


motions = [near_fault(1.2 + 0.12 * seed, seed) for seed in range(12)]
column = st.preset("paper-monolithic")
analysis = st.ida(column, motions, st.DistinctElement2D(), "pgv", runs=12, tail=5.0)

# %%
# Which number of a motion says most? The velocity of the ground: capacities scatter by a fifteenth in PGV, by three
# times as much in PGA, given which the length of the pulse still matters (its p is small).

best = which_tells_most(analysis.runs)
print(best[["measure", "beta", "p_pgv_over_pga_s"]].to_string(index=False, float_format="{:.3f}".format))

# %%
# The curve over the peak velocity, with an interval over records. It is that of one kind of motion from one fault:
# records of many earthquakes scatter five times as much.

curve = st.fragility(st.evidence(analysis.runs, "pgv", name=column.name))
low, high = curve.median_interval
print(f"half of the records collapse it at {curve.median:.2f} m/s ({low:.2f} to {high:.2f}), β {curve.beta:.2f}")
figure = plots.draw_fragility(curve)
figure.savefig("fragility.png")

# %%
# Two opinions about a site, and a column that has stood on it for 2,400 years: it speaks for the milder one.

pgv = np.geomspace(0.02, 3.0, 12)
hazards = [Hazard(pgv, rate * pgv**-2.2, "m/s", name) for name, rate in (("severe", 4e-4), ("mild", 4e-5))]
stood = st.survival(curve, 2400.0, hazards)
for hazard, probability in zip(hazards, stood.probability):
    print(f"{hazard.name}: would still stand with a probability of {probability:.2f}")
