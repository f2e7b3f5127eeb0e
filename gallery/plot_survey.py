"""
A column as surveyed
====================

A column on an ancient site, measured drum by drum: heights and diameters of both faces, the
density of a sample, and one joint that is known to be smoother than the others. When does it
begin to rock, at which joint, and does it stand a pulse of 2 Hz and 0.4 g?
"""

import stylobate as st
from stylobate import plots

# %%
# The survey, bottom to top. Column files say the same, with one ``[[drum]]`` for each.

survey = [  # height, lower and upper diameter [m]
    (0.92, 1.08, 1.05),
    (0.88, 1.05, 1.02),
    (1.04, 1.02, 0.98),
    (0.79, 0.98, 0.95),
    (0.97, 0.95, 0.90),
    (0.46, 1.08, 1.08),  # the capital
]
drums = [st.Drum(*sizes, density=2650.0, section="circular") for sizes in survey]
dry = st.Joint(normal_stiffness=5e10, shear_stiffness=2.5e10, friction_angle=35.0)
smooth = {4: st.Joint(5e10, 2.5e10, friction_angle=22.0)}
column = st.Column.of_drums(drums, dry, overrides=smooth, name="north side, column 5")

# %%
# Before anything is computed in time: the horizontal acceleration that opens each joint, if the
# column were pushed slowly. Rocking begins at the smallest of them.

for joint, acceleration in enumerate(column.joint_uplift_accelerations, 1):
    print(f"joint {joint} opens at {acceleration / st.g:.3f} g")
print(f"{column.height:.2f} m, {column.mass / 1000:.1f} t", end=", ")
print(f"rocks from {column.uplift_acceleration / st.g:.3f} g on")

# %%
# The pulse is strong enough to rock it, and too short to overturn it: the acceleration that opens
# a joint is not the one that makes a column fall. It comes to rest with its drums shifted.

response = st.simulate(column, st.ricker(2.0, 0.4 * st.g), st.DistinctElement2D())
print(response.outcome.sentence)
print(f"the top moves by up to {1000 * response.peak_top_displacement:.0f} mm", end=", ")
print(f"at the end by {1000 * response.residual_top_displacement:.0f} mm")
figure = plots.draw_histories(response)
figure.savefig("survey.png")
