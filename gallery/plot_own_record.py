"""
A record of your own
====================

A record is a file. The formats of strong-motion networks state unit and step; a table needs a
header that names them, and is refused without: a wrong unit is a wrong verdict about a monument.
Here one motion is written in two ways, as a table and in PEER's AT2 format, and read back.
"""

from pathlib import Path
from tempfile import mkdtemp

import stylobate as st
from stylobate import plots

# %%
# A simulated motion takes the place of a record: magnitude 6.5 at 10 km in Greece.

simulated = st.stochastic_motion(6.5, 10e3, "greece", seed=7)
motion = simulated.scaled_to_pga(0.3 * st.g)
shares = motion.acceleration / st.g
folder = Path(mkdtemp())
rows = [f"{t:.3f},{a:.6f}" for t, a in zip(motion.time, shares)]
(folder / "own.csv").write_text("\n".join(["time_s,ax_g", *rows]))
header = ["PEER STRONG MOTION DATABASE RECORD", "SIMULATED, GREECE, 090"]
header += ["ACCELERATION TIME HISTORY IN UNITS OF G"]
header += [f"NPTS= {motion.steps}, DT= {motion.dt:.4f} SEC"]
values = [f"{a:15.7E}" for a in shares]
(folder / "own.at2").write_text("\n".join([*header, *values]))

# %%
# What a file says of itself is kept in ``metadata``; what was done to its numbers, here nothing,
# in ``processing``. ``tail`` goes on until the column is at rest.

responses = []
for name in ("own.csv", "own.at2"):
    record = st.read_motion(folder / name)
    print(record.describe(), record.metadata["format"], record.processing, sep=" | ")
    column = st.preset("paper-12-drums")
    responses.append(st.simulate(column, record, st.DistinctElement2D(), tail=5.0))
    print(f"the top moves by up to {1000 * responses[-1].peak_top_displacement:.0f} mm")

# %%
# The files differ by the rounding of the last digit, and that is enough for another peak: after a few
# impacts rocking is chaotic. That the column stands, and moves by some centimetres, can be relied on.

figure = plots.draw_histories(responses[0])
figure.savefig("own_record.png")
