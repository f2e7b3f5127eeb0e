"""Equations 1 to 8 of the paper and what is assumed beside them, each against the model that carries it out."""

from __future__ import annotations

import dataclasses

import numpy as np
from scipy.integrate import solve_ivp

from stylobate.column import Column, preset
from stylobate.column.catalogue import PAPER
from stylobate.constants import g
from stylobate.kernels.rigid_beam import moment_law
from stylobate.models.base import Model
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.models.rigid_beam.state import BeamMatrices
from stylobate.motion import harmonic
from stylobate.response import Response
from stylobate.simulate import simulate

from .cases import BLOCKS, DEM, DRUMS, MODELS, MONOLITH, SHORT
from .nodal_beam import nodal_accelerations, nodal_matrices, rotation_rates
from .sentences import Statement, judged
from .statics import joint_law

#: Numbers that differ by rounding alone agree within this [-].
ROUNDING = 1e-9

#: Eq. 5 by another Runge–Kutta method: amplitude [g] and length [s] of what is compared, at 0.66 Hz. The monolith rocks.
SOLVED = {MONOLITH: (0.2, 0.7), DRUMS: (0.25, 0.3)}


def equation_statements() -> list[Statement]:
    """Rows of the equations, of Fig. 3, and of what its section 2 assumes, in the order of the paper's text."""
    return [*_beam(), *_joint_law(), *_stiffness(), *_contact()]


def _beam() -> list[Statement]:
    rotations, ground = zip(*(_nodes(name) for name in PAPER), strict=True)
    sums, right, loads = (max(values) for values in zip(*(_accelerations(name) for name in PAPER), strict=True))
    solved = {SHORT[name]: _solved(name) for name in PAPER}
    monolith, many = (preset(name).as_prism() for name in PAPER)
    drums = preset(DRUMS)
    width = max(abs(many.masses / (0.5 * (_faces(drums)[0] + _faces(drums)[1]) * drums.heights * 1600.0) - 1.0))
    return [
        Statement(
            "2.1 ¶1, Fig. 2",
            "A column of n drums is n beam elements and n + 1 nodes that move horizontally; n = 1 is the monolith.",
            f"matrix of the equations of motion: {_shape(many)} for twelve drums, {_shape(monolith)} for the monolith; the "
            "first node is the ground",
            judged(_shape(many) == "12 × 12" and _shape(monolith) == "1 × 1"),
            "Unknown are the rotations of the drums, as many as the displacements of the nodes above the ground (Eq. 1).",
        ),
        Statement(
            "2.1 ¶2, Fig. 2", "Each element has the mass of a prism whose width is the mean of its drum's two widths.",
            f"masses of the twelve elements over those of such prisms: 1 within {width:.0e}",
            judged(bool(width < ROUNDING)), "`idealisation=prism`; `true` keeps the drum's taper.",
        ),
        Statement(
            "2.1 ¶2, Eq. 1, Fig. 2", "The rotation of an element is the difference of its end displacements "
            "over its height.",
            f"in shaken columns, largest difference over the largest rotation: {max(rotations):.0e}",
            judged(max(rotations) < ROUNDING), "Linear: rotations are taken as small.",
        ),
        Statement(
            "2.1 ¶3, Eq. 2", "Forces and moments at the ends of an element give its mass times acceleration, "
            "and its inertia times angular acceleration.",
            f"joint forces by sums of Eq. 2 from the top, with accelerations for velocities: the same "
            f"accelerations as by the "
            f"equations in rotations within {right:.0e}. As printed its first line sets a momentum equal to a force",
            judged(False, {"with ü in place of the printed u̇": right < ROUNDING, "as printed": False}),
            "A slip of print: the text below it and its Eqs. 3 to 5 have ü. The signs of T and M are as printed.",
        ),
        Statement(
            "2.1 ¶4, Eq. 3", "The base node has the acceleration of the ground; nothing pulls or turns the top node.",
            f"largest displacement of the base relative to the ground: {max(ground):.1e} m; the sums of Eq. 4 begin at the "
            "top with nothing",
            judged(max(ground) == 0.0),
            "So base displacements of this model are those of the ground: see the rows on Figs. 4, 5, 7 and 8.",
        ),
        Statement(
            "2.1 ¶5, Eq. 4", "In matrices, T = M_a ü − A_g and M = G T + I_G ü − B_g, with A_g = a_g m₁/2 and "
            "B_g = a_g I_G1/h₁ in the first component.",
            f"entries of A_g and B_g from Eq. 2 over the printed ones: 1 within {loads:.0e}",
            judged(loads < ROUNDING),
            "With the signs of Eq. 2 the entries of M_a and G are negative. “From node i to n” must be from "
            "node 1 to n, and I_a of the printed equation is I_G of the text.",
        ),
        Statement(
            "2.1 ¶6, Eq. 5", "Both together are one system of differential equations in the displacements of the nodes.",
            f"its accelerations against those by equations in rotations, random states of both columns: {sums:.0e}",
            judged(sums < ROUNDING), "A_a and B_a of the printed equation are A_g and B_g of Eq. 4.",
        ),
        Statement(
            "2.1 ¶7", "The system is solved by a Runge–Kutta method, without shear failure.",
            "displacement of the top, fixed steps of order 4 against Eq. 5 by DOP853 (order 8, tolerance 10⁻⁹): largest "
            "difference over the largest value, " + ", ".join(f"{name} {value:.0e}" for name, value in solved.items()),
            judged(max(solved.values()) < 0.01),
            f"Taken as: within 1 %, over {SOLVED[MONOLITH][1]:g} s of rocking of the monolith and "
            f"{SOLVED[DRUMS][1]:g} s of the drums. "
            "Blows follow in which a closed joint vibrates, and any two steps part by some per cent.",
        ),
    ]  # fmt: skip


def _joint_law() -> list[Statement]:
    column = preset(MONOLITH)
    seen, model = column.as_prism(), RigidBeam.paper(moment_law="trilinear", xi=0.7)
    ultimate, alpha = 0.5 * seen.joint_weights[0] * seen.joint_widths[0], np.arctan(seen.joint_widths[0] / seen.height)
    stiffness = column.joints[0].normal_stiffness * seen.joint_second_moments[0]
    phi = np.concatenate([np.geomspace(1e-8, 1e-4, 50), np.linspace(1e-4, 1.2 * alpha, 100)])
    lines = np.minimum(stiffness * phi, ultimate * np.minimum(0.7, 1.0 - phi / alpha))
    off = float(np.abs(joint_law(model, column, 1, phi) - lines).max() / ultimate)
    drums = preset(DRUMS).as_prism()
    flat = RigidBeam.paper().joints(drums)[1]
    printed = np.array([0.5 * drums.joint_widths[i] * drums.masses[i:].sum() * g for i in range(drums.n)])
    eq6 = float(np.abs(flat / printed - 1.0).max())
    angles = RigidBeam.paper().critical_angles(drums)
    block = float(np.abs(angles / np.arctan(drums.joint_widths / drums.heights) - 1.0).max())
    return [
        Statement(
            "2.1 ¶7, Fig. 3", "Each joint follows a bi- or tri-linear law of moment and rotation, with an "
            "initial stiffness K_M and a factor ξ ≤ 1.",
            f"tri-linear law, ξ = 0.7, against the figure's three lines: {off:.0e} of M_u at most",
            judged(off < ROUNDING), "The figure is drawn again on the page of `reproduce`. K_M and ξ are not printed.",
        ),
        Statement(
            "2.1 ¶8, Eq. 6, Fig. 3", "The largest moment of a joint is half of its width times the weight above it.",
            f"twelve joints: 1 within {eq6:.0e}",
            judged(eq6 < ROUNDING), "The weight is that at rest, times 1 + a_v/g where the motion has a vertical component.",
        ),
        Statement(
            "2.1 ¶9, Fig. 3", "α_i, where the law of a joint comes to zero, is the critical angle of the drum above it.",
            f"twelve joints, against arctan d/h of each drum: 1 within {block:.0e}; "
            f"{np.degrees(angles[0]):.0f}° for the lowest drum, 9° for the whole column",
            judged(block < ROUNDING),
            "So read, a joint between drums loses its moment only when the drum alone would fall. "
            "`critical_angle=stack` takes all that stands on the joint.",
        ),
    ]  # fmt: skip


def _stiffness() -> list[Statement]:
    (dem_top, dem_base), (block_top, block_base) = (_quasi_static(label) for label in (DEM, BLOCKS))
    drums = preset(DRUMS)
    seen = drums.as_prism()
    states = simulate(drums, harmonic(2.0, 0.1 * g, 0.1), MODELS[BLOCKS], output_interval=0.05)
    moving = states.drum_x.shape[1] + states.drum_z.shape[1] + states.drum_rotation.shape[1]
    same = float(
        np.abs(
            RigidBeam.paper().joints(seen)[0] / (seen.joint_second_moments * drums.joints[0].normal_stiffness) - 1.0
        ).max()
    )
    return [
        Statement(
            "2.2 ¶1, Eq. 7", "Contact forces grow by k_n A_c and k_s A_c times the relative displacements.",
            f"monolith at 0.05 g and 0.5 Hz over statics with two contacts at the edges: top {dem_top:.3f}, "
            f"base {dem_base:.3f}",
            judged(abs(dem_top - 1.0) < 0.02 and abs(dem_base - 1.0) < 0.02),
            "Taken as: within 2 %; the sine starts abruptly. Each of two contacts has half of the joint's area, so a joint "
            "bends three times as stiffly as by Eq. 8.",
        ),
        Statement(
            "2.3 ¶1", "Degrees of freedom of the rigid block model are two translations and a rotation of each block.",
            f"{moving} for twelve drums", judged(moving == 36), "As many histories are recorded of each drum.",
        ),
        Statement(
            "2.3 ¶1, Eq. 8", "Interface actions grow by k_n A, k_s A and k_n I.",
            f"monolith at 0.05 g and 0.5 Hz over statics: top {block_top:.3f}, base {block_base:.3f}",
            judged(abs(block_top - 1.0) < 0.02 and abs(block_base - 1.0) < 0.02),
            "Taken as: within 2 %. The last line of the equation calls the bending stiffness K_n, which its "
            "first line has for k_n A.",
        ),
        Statement(
            "2.3 ¶2, Fig. 3", "Bending stiffness and law of moments can be the same as in the rigid beam.",
            f"K_M of the beam's twelve joints over k_n I of the same widths: 1 within {same:.0e}; largest "
            f"moment N d/2 in both",
            judged(same < ROUNDING),
            "In the rigid block N is that of the moment, and moments on the way down follow from its displacements.",
        ),
    ]  # fmt: skip


def _contact() -> list[Statement]:
    bound = {tan: _friction_used(tan) for tan in (0.1, 0.7)}
    pulled = min(least for _, least in bound.values())
    deep = [_depth(depth) for depth in (1.0, 2.0)]
    return [
        Statement(
            "2.2 ¶2, 2.3 ¶1", "Joints are dry: they carry no tension and no cohesion, and friction up to f_n tan φ.",
            "drums at 0.3 g and 1 Hz, largest shear over normal force of any joint: "
            + ", ".join(f"{most:.3f} with tan φ = {tan:g}" for tan, (most, _) in bound.items())
            + f"; smallest normal force {max(0.0, pulled):.2f} of the weight above",
            judged(all(most <= 1.001 * tan for tan, (most, _) in bound.items()) and pulled > -1e-6),
            "Distinct elements; means over 20 ms. φ is not printed.",
        ),
        Statement(
            "4 ¶1", "The plane DEM takes the column one unit deep, and so of rectangular section.",
            f"peak displacement of the top, drums at 0.3 g and 1 Hz, {deep[1]:.4f} m with twice the depth, {deep[0]:.4f} m "
            "without",
            judged(abs(deep[1] / deep[0] - 1.0) < ROUNDING),
            "Stiffness is per area, so the depth cancels out. `dem2d` takes circular sections too.",
        ),
    ]  # fmt: skip


def _nodes(name: str) -> tuple[float, float]:
    """Largest difference between Eq. 1 and the rotations of a response [-], and its largest base displacement [m]."""
    column = preset(name)
    seen, response = column.as_prism(), simulate(column, harmonic(1.0, 0.1 * g, 1.0), RigidBeam.paper())
    moved, node, turned = response.drum_x - response.drum_x[0], np.zeros(response.time.size), []
    for i in range(seen.n):  # the centre of a prism moves by the mean of its ends
        following = 2.0 * moved[:, i] - node
        turned.append((following - node) / seen.heights[i])
        node = following
    # Rotations of a response are anticlockwise, those of Eq. 1 clockwise.
    off = np.abs(np.stack(turned, axis=1) + response.drum_rotation).max() / np.abs(response.drum_rotation).max()
    return float(off), float(np.abs(response.base_displacement).max())


def _accelerations(name: str) -> tuple[float, float, float]:
    """Largest relative differences of random states [-]: Eq. 5 from the equations in rotations; joint forces of Eq. 2 summed
    drum by drum from Eq. 4; A_g and B_g of Eq. 4 from the printed ones."""
    seen = preset(name).as_prism()
    matrices, random = BeamMatrices(seen), np.random.default_rng(seen.n)
    theta, moments = 0.05 * random.standard_normal(seen.n), 2e4 * random.standard_normal(seen.n)
    ground = float(3.0 * random.standard_normal())
    by_nodes = nodal_accelerations(matrices, moments, theta, ground, 0.0)
    by_turns = ground + np.cumsum(seen.heights * rotation_rates(matrices, moments, theta, ground, 0.0))
    geometry, mass, inertia, load, turning = nodal_matrices(seen)
    all_nodes = np.append(ground, by_nodes)
    # Eq. 2 solved for the lower end, from the top down; signs of T and M as in the matrices: actions on the drum above.
    shear, moment = np.zeros(seen.n + 1), np.zeros(seen.n + 1)
    for i in reversed(range(seen.n)):
        h = seen.heights[i]
        shear[i] = shear[i + 1] + seen.masses[i] * 0.5 * (all_nodes[i] + all_nodes[i + 1])
        turn = (all_nodes[i + 1] - all_nodes[i]) / h
        moment[i] = moment[i + 1] + seen.inertias[i] * turn + 0.5 * h * (shear[i] + shear[i + 1])
    summed = mass @ by_nodes + load * ground
    bent = geometry @ summed + inertia @ by_nodes + turning * ground
    sums = max(_apart(shear[:-1], summed), _apart(moment[:-1], bent), _apart(-moment[:-1], moments))
    printed = [0.5 * seen.masses[0], -seen.inertias[0] / seen.heights[0]]
    loads = max(
        abs(load[0] / printed[0] - 1.0), abs(turning[0] / printed[1] - 1.0), *np.abs([*load[1:], *turning[1:], 0.0])
    )
    return _apart(by_nodes, by_turns), sums, float(loads)


def _solved(name: str) -> float:
    """Largest difference of the top displacement from DOP853 on Eq. 5, over the largest displacement [-]."""
    amplitude, length = SOLVED[name]
    model, column = RigidBeam.paper(), preset(name)
    response = simulate(column, harmonic(0.66, amplitude * g, 4.0), model, output_interval=0.01, until_end=True)
    seen = column.as_prism()
    geometry, mass, inertia, load, turning = nodal_matrices(seen)
    inverse, base = np.linalg.inv(geometry @ mass + inertia), geometry @ load + turning
    turn = (np.eye(seen.n) - np.eye(seen.n, k=-1)) / seen.heights[:, None]
    joints, bed, moments = model.joints(seen), model.bed(seen), np.empty(seen.n)

    def rates(time: float, state: np.ndarray) -> np.ndarray:
        moment_law.moments(turn @ state[: seen.n], 1.0, joints, bed, moments)
        ground = amplitude * g * np.sin(2.0 * np.pi * 0.66 * time)
        return np.concatenate((state[seen.n :], inverse @ (-moments - base * ground) - ground))

    at = response.time[response.time <= length]
    solution = solve_ivp(rates, (0.0, length), np.zeros(2 * seen.n), "DOP853", at, rtol=1e-9, atol=1e-13)
    return _apart(response.top_displacement[: at.size], solution.y[seen.n - 1])


def _quasi_static(label: str) -> tuple[float, float]:
    """Peaks of top and base of the monolith in a slow weak motion over those of statics [-]."""
    column, a = preset(MONOLITH), 0.05 * g
    response = _shaken(column, MODELS[label], 0.5, 0.05, 2.0)
    law, width = column.joints[0], float(column.joint_widths[0])
    second = width**3 / (4.0 if label == DEM else 12.0)  # two contacts at the edges; the whole joint
    base = column.mass * a / (law.shear_stiffness * width)
    tilt = column.mass * a * float(column.centroid_heights[0]) / (law.normal_stiffness * second)
    peaks = (np.abs(response.top_displacement).max(), np.abs(response.base_displacement).max())
    return float(peaks[0] / (base + tilt * column.height)), float(peaks[1] / base)


def _friction_used(tangent: float) -> tuple[float, float]:
    """Largest shear over normal force of a shaken column of drums, and the smallest normal force over the "
    "weight above [-]."""
    column = preset(DRUMS).with_joint(friction_coefficient=tangent)
    forces = _shaken(column, MODELS[DEM], 1.0, 0.3, 5.0).joint_forces()
    weighs = column.joint_weights
    carries = forces.normal > 1e-3 * weighs
    return float((np.abs(forces.shear)[carries] / forces.normal[carries]).max()), float((forces.normal / weighs).min())


def _depth(depth: float) -> float:
    """Peak displacement of the top of the drums with another depth [m]."""
    column = preset(DRUMS)
    column = column.replace(drums=tuple(dataclasses.replace(drum, depth=depth) for drum in column.drums))
    return float(np.abs(_shaken(column, MODELS[DEM], 1.0, 0.3, 5.0).top_displacement).max())


def _shaken(column: Column, model: Model, frequency: float, amplitude: float, length: float) -> Response:
    return simulate(column, harmonic(frequency, amplitude * g, length), model, output_interval=0.01)


def _faces(column: Column) -> tuple[np.ndarray, np.ndarray]:
    return (np.array([drum.bottom_width for drum in column.drums]), np.array([drum.top_width for drum in column.drums]))


def _shape(column: Column) -> str:
    return " × ".join(map(str, BeamMatrices(column).mass.shape))


def _apart(values: np.ndarray, other: np.ndarray) -> float:
    return float(np.abs(values - other).max() / np.abs(other).max())
