"""
The critical amplitude of a pulse
=================================

How strong must a pulse be to bring a column down? And does every stronger one bring it down too?
Amplitudes are tried one by one on a grid, not by bisection, which would find one boundary of many.
"""

import stylobate as st
from stylobate import plots

# %%
# A directivity pulse of 1.2 s, as a fault that ruptures towards the site may send it.

column = st.preset("paper-12-drums")
pulse = st.mavroeidis_papageorgiou(1 / 1.2, amplitude=1.0, oscillation=2.0)
grid = {"start": 0.1 * st.g, "stop": 2.0 * st.g, "step": 0.02 * st.g}
result = st.critical_amplitude(column, pulse, st.DistinctElement2D(), **grid)

# %%
# The acceleration that opens a joint is a lower bound, here a distant one. And there is a window far
# above the critical amplitude in which the column stands. Below it the column falls after an impact,
# to the side of the pulse's second half. In the window the first half tilts it so far that the second
# is spent on bringing it back. Above it the column falls at once, to the side of the first half.

print(f"a joint opens at {column.uplift_acceleration / st.g:.3f} g")
print(f"first collapse at {result.critical / st.g:.2f} g")
print(f"all collapse from {result.all_collapse_above / st.g:.2f} g on")
print(result.alternation.to_string(index=False, float_format="{:.2f}".format))

figure = plots.draw_amplitudes(result)
figure.savefig("critical_amplitude.png")
