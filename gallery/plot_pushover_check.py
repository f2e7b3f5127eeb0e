"""
A pushover and a code check
===========================

What many offices must hand in: the capacity curve, the collapse multiplier checked by a method of
its own, and the capacity spectrum check against a code spectrum.
"""

import stylobate as st
from stylobate import plots
from stylobate.codes.checks import capacity_spectrum_check
from stylobate.codes.spectra import EurocodeSpectrum
from stylobate.models.rigid_block.block_stack import BlockStack

# %%
# The equilibrium path goes over the peak and down to zero. Limit analysis knows neither stiffness
# nor steps, and must find the same peak.

column = st.preset("paper-12-drums")
path, limit = st.pushover(column), st.limit_analysis(column)
print(f"pushover       {path.collapse_multiplier:.4f} g, joint {path.governing_joint}")
print(f"limit analysis {limit.multiplier:.4f} g, joint {limit.governing_joint}")
print(f"no force is left where the top has moved by {path.ultimate_displacement:.2f} m")

# %%
# Nonlinear kinematic analysis after the Italian *Circolare* of 2009, for 0.35 g on ground B of
# EN 1998-1:2004. A rocking column has no period: the check is a convention rather than mechanics, and
# runs in time under records are the better evidence.

stack = BlockStack.of_column(column)
spectrum = EurocodeSpectrum(0.35 * st.g, "B")
check = capacity_spectrum_check(stack, path, spectrum)
print(f"demand {check.demand:.2f} m, usable {check.usable_displacement:.2f} m")
print("passed" if check.passed else "not passed")

figure = plots.draw_pushover(stack, path, limit.multiplier, column.name)
figure.savefig("pushover_check.png")
