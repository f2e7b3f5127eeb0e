"""
From a survey to a verdict
==========================

A notebook from the table of a survey to a verdict with its certainty: everything shows itself, the
figures, the response and its film. Download it below and put your own numbers in.
"""

import pandas

import stylobate as st
from stylobate import plots

# %%
# The survey as a table, bottom to top: sizes in m. The third drum is displaced by an old earthquake.

survey = pandas.DataFrame(
    [(0.92, 1.08, 1.05), (0.88, 1.05, 1.02), (1.04, 1.02, 0.98), (0.79, 0.98, 0.95), (0.46, 1.08, 1.08)],
    columns=["height", "bottom_width", "top_width"],
)
drums = [st.Drum(**sizes, density=2650.0, section="circular") for sizes in survey.to_dict("records")]
as_found = st.AsFound((st.FoundDrum(3, offset=0.05),))
column = st.Column.of_drums(drums, st.Joint(5e10, 2.5e10, 35.0), name="north side, column 5").replace(as_found=as_found)
survey

# %%
# The dimensioned elevation is the first thing to check: what is as found is red.

figure = plots.draw_elevation(column)
figure.savefig("notebook_survey.png")

# %%
# The verdict under one motion, and how sure it is: fifteen columns that differ by as much as a survey leaves
# open are computed beside the column.

sure = st.certainty(column, st.ricker(1.0, 0.45 * st.g, duration=6.0), st.DistinctElement2D())
print(sure.sentence)

# %%
# The response shows itself, in the plane and in space.

response = sure.response
response

# %%
# And so does its film, as slowly as you want to look. ``response.to_xarray()`` has every number of it.

response.animate(window=(0.0, 4.0))
