"""
A rocking spectrum
==================

A response spectrum says what a motion does to oscillators, a rocking spectrum what it does to blocks
that stand freely: statues, stelae, monoliths (Makris and Konstantinidis 2003). Of two blocks of one
shape the larger is the more stable one, which no response spectrum would tell.
"""

import numpy as np

import stylobate as st
from stylobate import plots

# %%
# A near-fault pulse of 1 s and 0.4 g, and 1600 blocks: size on one axis, slenderness on the other.

pulse = st.mavroeidis_papageorgiou(frequency=1.0, amplitude=0.4 * st.g)
blocks = np.geomspace(1.0, 8.0, 40), np.linspace(0.08, 0.45, 40)  # p [rad/s], α [rad]
spectrum = st.rocking_spectrum(pulse, *blocks)

# %%
# Where g tan α is above the peak of the motion, a block stays closed, whatever its size.

closed = spectrum.slenderness[spectrum.closed.all(axis=0)].min()
print(f"blocks of {np.degrees(closed):.0f}° and more stay closed")
for i in (0, 20, 39):
    half_diagonal = 0.75 * st.g / spectrum.frequency_parameter[i] ** 2
    fallen = np.degrees(spectrum.slenderness[spectrum.collapsed[i]])
    outcome = f"falls up to {fallen.max():.0f}°" if len(fallen) else "always stands"
    print(f"half diagonal {half_diagonal:.2f} m: {outcome}")

figure = plots.draw_rocking_spectrum(spectrum)
figure.savefig("rocking_spectrum.png")
