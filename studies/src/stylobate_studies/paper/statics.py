"""The paper's sentences that need no time history: moment–rotation laws, pushover and limit analysis."""

from __future__ import annotations

from itertools import pairwise, product

import numpy as np

from stylobate.column import Column, preset
from stylobate.column.assembly import Assembly, Block
from stylobate.column.catalogue import PAPER
from stylobate.kernels.rigid_beam import moment_law
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.statics.limit import limit_analysis, limit_directions
from stylobate.statics.pushover import pushover

from .cases import DRUMS, MONOLITH, SHORT, paper_column
from .sentences import Statement, judged


def static_values() -> dict[str, float]:
    """Multipliers of pushover and limit analysis [g], and how far the bi-linear law is from Housner's.

    ``elastic`` is the rotation at which the joint under the monolith reaches its largest moment, over the critical angle;
    ``work`` and ``opening`` the parts of the work to overturn and of the largest moment that ξ = 0.9 takes away.
    """
    values = {"prism": limit_analysis(preset(MONOLITH).as_prism()).multiplier}
    for name, section in product(PAPER, ("rectangular", "circular")):
        column = paper_column(name, section)
        values[f"limit, {name}, {section}"] = limit_analysis(column).multiplier
        values[f"pushover, {name}, {section}"] = pushover(column).collapse_multiplier
        values[f"polygons, {name}"] = limit_directions(as_polygons(preset(name)), [0.0]).weakest.multiplier
    column, model = preset(MONOLITH), RigidBeam.paper()
    seen = column.as_prism()
    alpha = float(model.critical_angles(seen)[0])
    rotation = np.linspace(0.0, alpha, 100_001)
    moment, cut = (
        joint_law(beam, column, 1, rotation) for beam in (model, RigidBeam.paper(moment_law="trilinear", xi=0.9))
    )
    stiffness = joint_law(model, column, 1, np.array([1e-7]))[0] / 1e-7
    values["elastic"] = 0.5 * float(seen.joint_widths[0] * seen.joint_weights[0]) / stiffness / alpha
    values["work"] = 1.0 - float(np.trapezoid(cut, rotation) / np.trapezoid(moment, rotation))
    values["opening"] = 1.0 - float(cut.max() / moment.max())
    return values


def as_polygons(column: Column) -> Assembly:
    """The drums of a column as built as polygons of an assembly: trapezia of unit depth."""
    levels = [*column.joint_heights.tolist(), column.height]
    blocks = [
        Block(
            ((-0.5 * drum.bottom_width, low), (0.5 * drum.bottom_width, low),
             (0.5 * drum.top_width, high), (-0.5 * drum.top_width, high)),
            drum.density, f"drum {i}", depth=drum.depth,
        )
        for i, (drum, (low, high)) in enumerate(zip(column.drums, pairwise(levels), strict=True), 1)
    ]  # fmt: skip
    return Assembly(tuple(blocks), column.joints[0], name=f"{column.name}, polygons")


def static_statements() -> list[Statement]:
    """The sentences, in the order of the paper's text."""
    s = static_values()
    both = [s[f"pushover, {name}, rectangular"] for name in (MONOLITH, DRUMS)]
    circular = [s[f"pushover, {name}, circular"] for name in (MONOLITH, DRUMS)]
    limit = [s[f"limit, {name}, rectangular"] for name in (MONOLITH, DRUMS)]
    return [
        Statement(
            "2.1 ¶7, Fig. 3",
            "The moment–rotation law differs only slightly from Housner's.",
            f"the largest moment is reached at {1e6 * s['elastic']:.0f} millionths of the critical angle; ξ = 0.9 "
            f"takes {100.0 * s['work']:.1f} % off the work to overturn, and {100.0 * s['opening']:.0f} % off "
            "the acceleration that opens a joint",
            judged(
                False,
                {
                    "elastic branch": s["elastic"] < 0.001,
                    "work to overturn": s["work"] < 0.02,
                    "acceleration that opens a joint": s["opening"] < 0.02,
                },
            ),
            "Taken as: elastic branch below a thousandth of the critical angle; work, and acceleration that "
            "opens a joint, which falls in proportion to ξ, within 2 %.",
        ),
        Statement(
            "2.3 ¶2",
            "The rigid block model can consider quadrilateral or polygonal elements, and so the trapezoidal sections.",
            "limit analysis of the same stones as polygons of an assembly: "
            + ", ".join(f"{SHORT[name]} {s[f'polygons, {name}']:.4f} g" for name in PAPER)
            + f"; as drums {limit[0]:.4f} g and {limit[1]:.4f} g",
            judged(all(abs(s[f"polygons, {name}"] - factor) < 1e-6 for name, factor in zip(PAPER, limit, strict=True))),
            "Blocks of an assembly are any convex polygons of up to 24 corners, from a file; `limit` and `dem2d` take them.",
        ),
        Statement(
            "3.1 ¶2",
            "The collapse acceleration obtained with the rigid block model is 0.205 g (monolith).",
            f"pushover {both[0]:.4f} g, limit analysis {limit[0]:.4f} g",
            judged(abs(both[0] - 0.205) < 0.0005 and abs(limit[0] - 0.205) < 0.0005),
            "The trapezium overturns about its base corner: B₁/(2 z_C) = 0.2046; joint stiffness lowers the peak of "
            "the path in the fourth digit.",
            f"Circular sections: {circular[0]:.4f} g. No effect of friction as long as tan φ is above 0.205.",
        ),
        Statement(
            "3.1 ¶2",
            "The rigid beam's 0.16 g against 0.205 g is due to its approximated rectangular shape.",
            f"limit analysis with prisms of mean width {s['prism']:.4f} g, with the true taper {limit[0]:.4f} g",
            judged(abs(s["prism"] - 0.16) < 0.0025 and abs(limit[0] - 0.205) < 0.0005),
            "(B₁ + B₂)/(2 H) = 0.162: the shape alone explains the difference.",
        ),
        Statement(
            "3.2 ¶2",
            "The pushover of the multi-drum column collapses at the acceleration of the monolith: under static actions it "
            "behaves as one piece.",
            f"pushover {both[1]:.4f} g against {both[0]:.4f} g, limit analysis {limit[1]:.4f} g",
            judged(abs(limit[1] - limit[0]) < 1e-6 and abs(both[1] - both[0]) < 0.002),
            "Every joint above the base needs a larger acceleration to open. The peaks of the paths differ by the "
            "stiffness of twelve joints instead of one.",
            f"Circular sections: {circular[1]:.4f} g.",
        ),
        Statement(
            "4 ¶1",
            "Rigid beam and rigid block model can account for the circular section.",
            f"rigid block: {circular[0]:.4f} g with circular, {both[0]:.4f} g with rectangular sections; domains of "
            "both models with circular sections are on this page",
            judged(circular[0] > both[0]),
            "A cone's centroid lies lower than a trapezium's. Whether the results are the more accurate "
            "ones is asked in a row of its own.",
            "In the rigid beam of prisms the section changes nothing at low frequency: tan α is 0.162 with both.",
        ),
    ]  # fmt: skip


def joint_law(model: RigidBeam, column: Column, joint: int, rotation: np.ndarray) -> np.ndarray:
    """Moment of a joint (from 1) of the rigid beam for given rotations [N m], shape of ``rotation`` [rad]."""
    seen = model.idealised(column)
    if model.moment_law == "housner":
        half = 0.5 * seen.joint_widths[joint - 1] * seen.joint_weights[joint - 1]
        return np.sign(rotation) * half * (1.0 - np.abs(rotation) / model.critical_angles(seen)[joint - 1])
    numbers = np.repeat(model.joints(seen)[:, joint - 1 : joint], rotation.size, axis=1)
    out = np.empty(rotation.size)
    moment_law.moments(np.ascontiguousarray(rotation, dtype=float), 1.0, numbers, model.bed(seen), out)
    return out
