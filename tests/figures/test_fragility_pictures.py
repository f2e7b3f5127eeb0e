"""Pictures of IDA, fragility, risk and survival: axes with units, what they show, and names of strangers."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import stylobate as st
from stylobate import plots
from stylobate.motion import half_sine_pulse
from stylobate.probability.evidence import Evidence
from stylobate.probability.ida import which_tells_most
from stylobate.probability.risk import Hazard
from stylobate.verdicts.rocking_spectrum import rocking_block


@pytest.fixture(scope="module")
def curve():
    rng = np.random.default_rng(3)
    levels = np.geomspace(0.2, 3.0, 8)
    codes = (np.log(levels) >= rng.normal(0.0, 0.5, (15, 1))).astype(np.int8)
    codes[::4, 3] = -1
    names = np.repeat(np.array([f"r{i}" for i in range(15)], dtype=object), 8)
    return st.fragility(
        Evidence(names, np.tile(levels, 15), codes.ravel(), "pgv", "m/s", "collapse", "$x$_{"), samples=100
    )


def texts(figure: Figure) -> str:
    from matplotlib.text import Text

    return "\n".join(text.get_text() for text in figure.findobj(Text))


def test_fragility(curve, tmp_path):
    figure = plots.draw_fragility([curve, curve])
    labels = texts(figure)
    assert "peak ground velocity [m/s]" in labels
    assert "probability of collapse" in labels
    assert r"\$x\$_{" in labels
    assert labels.count("if all that is undecided did, or none") == 1
    # two bands, and for each curve the two extremes that its open runs leave
    assert len(figure.axes[0].lines) >= 2 * (1 + 2)
    assert all(file.stat().st_size > 5000 for file in plots.save(figure, tmp_path / "f"))


def test_risk_and_survival(curve):
    x = np.geomspace(0.02, 5.0, 10)
    hazard = Hazard(x, 1e-3 * x**-2.0, "m/s", "site.csv")
    figure = plots.draw_risk(st.risk(curve, hazard))
    labels = texts(figure)
    for text in ("[1/y]", "share of the rate [%]", "peak ground velocity [m/s]", "once in"):
        assert text in labels
    labels = texts(plots.draw_survival(st.survival(curve, 2400.0, [hazard])))
    assert "2,400 years without collapse" in labels
    assert "site.csv" in labels


def test_ida():
    pulses = [
        half_sine_pulse(f, 0.4 * st.g, 10.0).replace(name=f"{f}", metadata={"format": "made"}) for f in (0.6, 0.9, 1.4)
    ]
    analysis = st.ida(rocking_block(2.0, 0.2), pulses, st.HousnerBlock(), "pga", runs=8, threads=1)
    figure = plots.draw_ida(analysis)
    labels = texts(figure)
    assert "peak ground acceleration [g]" in labels
    assert "peak top displacement [base widths]" in labels
    assert "50 % of the records" in labels
    best = which_tells_most(analysis.runs)
    labels = texts(plots.draw_efficiency(best))
    assert "β [-]" in labels
    assert all(name in labels for name in best["measure"])
