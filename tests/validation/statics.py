"""Closed forms of static collapse: pushover and limit analysis."""

import math
from functools import cache

import numpy as np
from oracles.quadrilaterals import stack_of_quadrilaterals

from stylobate.column import Column, Joint, preset
from stylobate.column.spatial.assembly import SpatialAssembly
from stylobate.column.spatial.stone import Stone
from stylobate.models.rigid_block.block_stack import BlockStack
from stylobate.statics.limit import limit_analysis, limit_directions
from stylobate.statics.pushover import PushoverResult, pushover

from .case import AtMost, Case, Near, collected

CASES: list[Case] = []
case = collected("closed forms", CASES)

JOINT = Joint(5e10, 2.5e10, friction_angle=35.0)


def tapered(drums: int, section: str = "rectangular") -> Column:
    """The paper's column with some drums."""
    return Column.tapered(
        height=5.0, bottom_width=0.96, top_width=0.66, drums=drums, density=1600.0, joint=JOINT, section=section
    )


#: Columns of the pushover, and their tan α by geometry.
COLUMNS = {
    "trapezium, 1 drum": tapered(1),
    "trapezium, 12 drums": tapered(12),
    "cone, 1 drum": tapered(1, "circular"),
    "cone, 12 drums": tapered(12, "circular"),
    "prism of mean width": preset("paper-monolithic").as_prism(),
}
MULTIPLIERS = (0.20463, 0.20463, 0.21869, 0.21869, 0.16200)


@cache
def paths() -> dict[str, PushoverResult]:
    """Equilibrium paths down to zero."""
    return {name: pushover(column) for name, column in COLUMNS.items()}


@case(
    "pushover",
    "peak of the path [g]: trapezium of 1 and 12 drums, cone of 1 and 12, prism",
    Near(MULTIPLIERS, rel=2.5e-4),
    source="statics: $d / 2 z_C$",
    reason="the joints' elasticity lowers the peak",
)
def peaks():
    return [path.collapse_multiplier for path in paths().values()]


@case(
    "pushover",
    "rotation at which the path comes down to zero, over α, these five columns",
    Near((1.0,) * 5, rel=2e-4),
    source="the centroid stands above the corner",
    reason="the elastic joints above turn as well",
)
def zeros():
    curves = paths()
    return [-curves[name].rotation_at_zero(1) / column.slenderness for name, column in COLUMNS.items()]


@case(
    "pushover",
    "softening branch against $\\tan(\\alpha - \\theta)$: largest difference [g]",
    AtMost(2e-4),
    source="statics",
    reason="the joints' elasticity",
)
def softening():
    worst = 0.0
    for name, path in paths().items():
        behind = slice(path.peak + 5, None)
        exact = np.tan(COLUMNS[name].slenderness + path.rotation[behind, 0])
        worst = max(worst, float(np.abs(path.multiplier[behind] - exact).max()))
    return worst


@case(
    "limit",
    "lower and upper bound, these five columns: largest relative difference to $d / 2 z_C$",
    AtMost(1e-9),
    source="statics",
    reason="tolerance of the linear programme",
)
def overturning():
    worst = 0.0
    for column in COLUMNS.values():
        exact = float((column.joint_uplift_accelerations / column.gravity).min())
        for flow in ("associated", "non-associated"):
            result = limit_analysis(column, flow=flow)
            worst = max(worst, abs(result.lower / exact - 1.0), abs(result.upper / exact - 1.0))
    return worst


def inclined() -> BlockStack:
    """Two blocks with a joint inclined by 10°, downhill to the right, φ = 15°."""
    drop = math.tan(math.radians(10.0))
    outlines = [
        [[-2.0, 0.0], [2.0, 0.0], [2.0, 1.0 - drop], [-2.0, 1.0 + 3 * drop]],
        [[-1.0, 1.0 + 2 * drop], [1.0, 1.0], [1.0, 1.5], [-1.0, 1.5 + drop]],
    ]
    return stack_of_quadrilaterals(outlines, [JOINT, Joint(5e10, 2.5e10, friction_angle=15.0)], density=2000.0)


def tangent(degrees: float) -> float:
    """Tangent of an angle in degrees."""
    return math.tan(math.radians(degrees))


SLIPPERY = preset("paper-monolithic").with_joint(friction_angle=8.0)
STICKY = preset("paper-monolithic").with_joint(friction_angle=8.0, cohesion=1000.0)
TILT = math.radians(3.0)


@case(
    "limit",
    "multiplier: φ = 8°; the same with c = 1 kPa; joint inclined by 10°, φ = 15°; base tilted by 3°",
    Near(
        (
            tangent(8.0),
            tangent(8.0) + 1000.0 * 0.96 / (SLIPPERY.mass * SLIPPERY.gravity),
            tangent(5.0),
            math.cos(TILT) * math.tan(SLIPPERY.slenderness) - math.sin(TILT),
        ),
        rel=1e-9,
    ),
    source="$\\tan\\varphi$; $\\tan\\varphi + cA/W$; $\\tan(\\varphi - \\beta)$; $\\cos\\tau\\tan\\alpha - \\sin\\tau$",
    reason="tolerance of the linear programme",
)
def other_mechanisms():
    multipliers = [limit_analysis(column).multiplier for column in (SLIPPERY, STICKY, inclined())]
    return [*multipliers, limit_analysis(preset("paper-monolithic"), base_tilt=3.0).multiplier]


@case(
    "limit",
    "multiplier with a compressive strength of 0.3 MPa, 1 and 12 drums",
    Near((math.tan(tapered(1).slenderness) * (1.0 - tapered(1).joint_weights[0] / (3e5 * 0.96)),) * 2, rel=1e-6),
    source="$\\tan\\alpha\\,(1 - N/f_cA)$",
    reason="tolerance of the cutting planes",
)
def compressive_strength():
    return [limit_analysis(tapered(drums), compressive_strength=3e5).multiplier for drums in (1, 12)]


def frame(kind: str, feet: tuple[tuple[float, float], ...], cap: tuple[float, float, float]) -> SpatialAssembly:
    """Columns of 0.8 × 4 m at these places, square or round, under a block of three sides [m]."""
    stones = [
        Stone.box((0.8, 0.8, 4.0), (x, y, 0.0), 2700.0, name=f"column {i}")
        if kind == "square"
        else Stone.drum(0.8, 0.8, 4.0, (x, y, 0.0), 2700.0, name=f"column {i}")
        for i, (x, y) in enumerate(feet)
    ]
    return SpatialAssembly([*stones, Stone.box(cap, (0.0, 0.0, 4.0), 2700.0, name="cap")], JOINT)


PORTAL = ((-1.2, 0.0), (1.2, 0.0)), (3.2, 0.8, 0.6)
PODIUM = ((-1.2, -1.2), (1.2, -1.2), (1.2, 1.2), (-1.2, 1.2)), (3.4, 3.4, 0.3)


@case(
    "limit",
    "multiplier in space [g]: square portal along and across its beam, square podium pushed at 0, 30 and 45°",
    Near((0.2, 0.15805471, 0.2, 0.2 / math.cos(math.radians(30.0)), 0.2 * math.sqrt(2.0)), rel=1e-6),
    source="statics: $b/h$ over the larger cosine (Makris and Vassiliou 2013); across, $(b/2)/z_C$ of all as one body",
    reason="tolerance of the linear programme",
)
def frames_in_space():
    portal = limit_directions(frame("square", *PORTAL), (0.0, 90.0)).multipliers
    return [*portal, *limit_directions(frame("square", *PODIUM), (0.0, 30.0, 45.0)).multipliers]


@case(
    "limit",
    "multiplier in space [g]: podium of four round columns pushed at 0, 30, 45 and 50°",
    Near((0.2,) * 4, rel=2.2e-3),
    source="statics: $d/h$ in every direction",
    reason="rims are cut into 48 corners: 1 − cos 3.75° at most",
)
def round_podium():
    return limit_directions(frame("round", *PODIUM), (0.0, 30.0, 45.0, 50.0)).multipliers
