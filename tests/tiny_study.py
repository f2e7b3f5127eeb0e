"""The paper's study on tiny grids: every piece of it, of a few runs each."""

import dataclasses

import numpy as np

import stylobate as st
from stylobate_studies.paper import cases, literature
from stylobate_studies.paper.cases import Grids

GRIDS = dataclasses.replace(
    Grids.of(True),
    frequencies=np.array([0.66, 2.0]),
    amplitudes=np.array([0.15, 0.3, 0.5]) * st.g,
    variant_frequencies=np.array([0.66, 2.0]),
    variant_amplitudes=np.array([0.2, 0.5]) * st.g,
    variants=(
        "beam, as the paper",
        "beam, true drums",
        "beam, β = 0.5 ms",
        "beam with sliding",
        "beam with sliding, tan φ = 10",
        "DEM, two points",
        "DEM, elastic blocks",
        "DEM, tan φ = 10",
    ),
    limit_amplitudes=np.array([0.15, 0.25]) * st.g,
    tail=1.0,
    doubt_frequencies=np.array([0.5, 0.8]),
    doubt_amplitudes=np.array([0.2, 0.3, 0.4]) * st.g,
    replicates=3,
    space_frequencies=np.array([0.66]),
    space_amplitudes=np.array([0.2, 0.5]) * st.g,
    space_replicates=2,
)


def shorten(setattr=setattr):
    """Make the thirty cases four short ones; ``setattr`` may be that of ``monkeypatch``."""
    setattr(cases, "DURATION", 3.0)
    setattr(cases, "FREQUENCIES", np.array([0.66, 2.0]))
    setattr(cases, "AMPLITUDES", np.array([0.2, 0.5]) * st.g)
    setattr(literature, "SHAKING", (1.0, 0.3 * st.g, 2.0, 0.5))


def play():
    """Make ``stylobate reproduce`` of this process compute the tiny study, and neither draw nor take the time of models."""
    from collections import defaultdict

    from stylobate_studies.paper import figures, pieces

    shorten()
    cases.Grids.of = classmethod(lambda cls, quick: GRIDS)
    figures.draw = lambda results, folder: defaultdict(list)
    pieces._seconds = lambda shaking, model: 1.0
