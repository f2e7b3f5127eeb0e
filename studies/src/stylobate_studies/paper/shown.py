"""What the paper is given, draws and announces: input data, figures, new contacts, and the work that it leaves for later."""

from __future__ import annotations

import numpy as np

from stylobate.column import preset
from stylobate.column.catalogue import PAPER_BLOCK_MODULUS
from stylobate.constants import g
from stylobate.motion import harmonic
from stylobate.simulate import simulate
from stylobate.statics.limit import limit_analysis

from .cases import AMPLITUDES, BEAM, DEM, DRUMS, FREQUENCIES, MODELS, MONOLITH, REFERENCE
from .reading import Reader, percent, share
from .sentences import DONE, HOLDS, UNDECIDED, Statement, Verdict, judged

#: Height, widths at base and top [m], density [kg/m³], joint stiffnesses [N/m³] and blocks' modulus [Pa], as printed.
PRINTED = (5.0, 0.96, 0.66, 1600.0, 5e10, 2.5e10, 2500e6)

#: A figure of the paper is known by its caption and its text alone.
LOST = "Its curves are not at hand as numbers; what the text says of them has rows of its own."


def shown_statements(r: Reader) -> list[Statement]:
    """Rows of what is not an equation and needs no interval."""
    return [*_given(), *_abstract(r), *_figures(r), *_announced(r)]


def _given() -> list[Statement]:
    monolith, drums = preset(MONOLITH), preset(DRUMS)
    law = monolith.joints[0]
    ours = (
        monolith.height, monolith.drums[0].bottom_width, monolith.drums[-1].top_width, monolith.drums[0].density,
        law.normal_stiffness, law.shear_stiffness, PAPER_BLOCK_MODULUS,
    )  # fmt: skip
    equal = float(np.ptp(drums.heights))
    alike = np.allclose((drums.height, drums.drums[0].bottom_width, drums.drums[-1].top_width), PRINTED[:3], rtol=1e-12)
    return [
        Statement(
            "1, Fig. 1", "A monolithic column and one of drums of the same size; free-standing columns in Athens.",
            "drawings by `stylobate draw`, of the presets `paper-monolithic` and `paper-12-drums`",
            Verdict(DONE), "The photograph shows no numbers.",
        ),
        Statement(
            "1 ¶3", "Three-dimensional analysis gives a more realistic and accurate representation.",
            "the two differ: see the rows on round columns and on contact parameters; which is nearer to a real column, no "
            "measured history of a column at hand decides",
            Verdict(UNDECIDED), "Boulders and cubes, measured, were computed in space only.",
        ),
        Statement(
            "3 ¶1", "Height 5 m, widths 0.96 m and 0.66 m, twelve equal drums, 1600 kg/m³, 2500 MPa, 5·10¹⁰ "
            "and 2.5·10¹⁰ N/m³.",
            "the presets have these numbers",
            judged(bool(np.allclose(ours, PRINTED, rtol=1e-12)) and bool(alike) and drums.n == 12 and equal < 1e-12),
            "Friction, ξ and damping are not printed: tan φ = 0.7, ξ = 1 and none.",
        ),
        Statement(
            "3 ¶1", "Thirty analyses, 0.66 to 4 Hz and 0.1 g to 0.5 g.",
            f"{FREQUENCIES.size} frequencies, {FREQUENCIES[0]:g} to {FREQUENCIES[-1]:g} Hz, and "
            f"{AMPLITUDES.size} amplitudes, {AMPLITUDES[0] / g:g} g to {AMPLITUDES[-1] / g:g} g",
            Verdict(HOLDS), "Only the ranges and the number are printed; so chosen, they make thirty.",
        ),
    ]  # fmt: skip


def _abstract(r: Reader) -> list[Statement]:
    peaks = r.results.histories[DRUMS, DEM]["peak_top"].sel(frequency=2.0, method="nearest")
    shaken = np.asarray(peaks["amplitude"].values, dtype=float)
    slope = np.asarray(peaks.values, dtype=float) / shaken * (shaken[0] / float(peaks[0]))
    slip = r.domain(DRUMS, DEM).grid("residual_joint_slip_m")
    fall = simulate(preset(DRUMS), harmonic(0.66, 0.5 * g, 10.0), MODELS[DEM], until_rest=True)
    touch = None if fall.collapse is None else fall.collapse.touched
    bodies = None if touch is None else touch.bodies
    return [
        Statement(
            "Abstract ¶1", "The behaviour of columns is strongly nonlinear, by sliding and rocking.",
            "drums at 2 Hz, distinct elements, peak of the top over amplitude, relative to that at "
            f"{shaken[0] / g:g} g: "
            + ", ".join(f"{value:.0f} at {a / g:g} g" for value, a in zip(slope[1:], shaken[1:], strict=True))
            + f"; drums left shifted by more than 1 mm in {percent(float(np.mean(slip > 1e-3)))} of the cells of the domain",
            judged(bool(np.nanmax(slope) > 2.0 and np.mean(slip > 1e-3) > 0.1)),
            "Taken as: twice the linear answer, and shifts in a cell of ten. A linear column has 1 throughout.",
        ),
        Statement(
            "Abstract ¶2, 2.2 ¶1", "The DEM detects new contacts, continuously.",
            "drums at 0.5 g and 0.66 Hz, followed to the ground: "
            + ("nothing new touches" if touch is None or bodies is None else f"{' and '.join(bodies)} touch "
            f"after {touch.time:.1f} s"),
            judged(touch is not None),
            "While every drum is on its neighbours only their faces are looked at; from then on everything.",
        ),
    ]  # fmt: skip


def _figures(r: Reader) -> list[Statement]:
    cells = {label: r.domain(DRUMS, label) for label in (BEAM, DEM)}
    size = "; ".join(
        f"{label} {domain.frequencies.size} frequencies and {domain.amplitudes.size} amplitudes"
        for label, domain in cells.items()
    )
    drift = "also in space, where the drift a t/ω of a sine of acceleration from rest is drawn"
    return [
        Statement(
            "3.1 ¶1, Figs. 4, 5", "Base and top displacements of the monolith, rigid beam and DEM.",
            f"drawn for all thirty cases, {drift}", Verdict(DONE), LOST,
        ),
        Statement(
            "3.1 ¶2, Fig. 6", "Safe–unsafe domain of the monolith, rigid beam and DEM.",
            f"drawn: {size}", Verdict(DONE),
            f"{LOST} Line styles: the beam is continuous and the DEM dashed here, the other way round in Fig. 9.",
        ),
        Statement(
            "3.2 ¶1, Figs. 7, 8", "Base and top displacements of the drums, rigid beam and DEM.",
            f"drawn for all thirty cases, {drift}", Verdict(DONE), LOST,
        ),
        Statement(
            "3.2 ¶2, Fig. 9", "Safe–unsafe domain of the drums, rigid beam and DEM.",
            f"drawn: {size}", Verdict(DONE),
            f"{LOST} The text beside it has rigid block where the figure has rigid beam.",
        ),
    ]  # fmt: skip


def _announced(r: Reader) -> list[Statement]:
    """What it compares with another model, and what it leaves for later."""
    free, slips, dem = (
        share(r.results.variants[DRUMS, key]) for key in ("beam, true drums", "beam with sliding", REFERENCE)
    )
    rough = [limit_analysis(preset(MONOLITH).with_joint(friction_coefficient=tan)).multiplier for tan in (0.7, 10.0)]
    return [
        Statement(
            "1 ¶5", "Comparing the rigid beam with a rigid block model shows the influence of the no-sliding hypothesis.",
            f"pushover and limit analysis: {rough[0]:.4f} g with tan φ = 0.7, {rough[1]:.4f} g with tan φ = "
            "10. Histories of beam with and without sliding: the row on the effect of sliding",
            judged(
                False,
                {
                    "histories": abs(slips / free - 1.0) > 0.01,
                    "the pushover that the paper makes": abs(rough[1] / rough[0] - 1.0) > 0.01,
                },
            ),
            "In statics nothing slides while tan φ is above the multiplier.",
        ),
        Statement(
            "4 ¶1", "Harmonic tests with the rigid block model are announced.",
            "all cells of both domains: the row on its intermediate behaviour", Verdict(DONE),
            "The paper itself uses this model for its pushover only.",
        ),
        Statement(
            "4 ¶2", "Comparisons with numerical and laboratory results are announced.",
            "thresholds of three codes and runs of three engines; boulders on a shaking table and tossed cubes",
            judged(False, {"numerical results": True, "laboratory results of columns": False}),
            "Measured histories of columns are not published; the form in which they can be read is documented.",
        ),
        Statement(
            "4 ¶2", "Sliding between the drums of the rigid beam by a law of Mohr and Coulomb is announced.",
            f"unsafe share on the grid of the open parameters: {percent(slips)} instead of {percent(free)}; "
            f"DEM {percent(dem)}",
            Verdict(DONE), "`sliding=on`, with friction and cohesion.",
        ),
    ]  # fmt: skip
