"""Closed forms of round columns in space: rocking and rolling on the rim, and uplift on a slope."""

import math

import numpy as np

from stylobate.column import AsFound
from stylobate.constants import g
from stylobate.models.start import Start

from .case import Case, Near, collected
from .space import released, round_column, wobble

CASES: list[Case] = []
case = collected("closed forms", CASES)

STIFF = 5e12
RIGID = "rigid body, by hand and by quadrature"


@case(
    "dem3d",
    "time to upright of the paper's column with circular section, released at α/2 and 3α/4 towards azimuth 0.6 [s]",
    Near((0.74849162, 1.17190153), rel=1.5e-4),
    source=r"$\ddot\theta = -p^2 \sin(\alpha - \theta)$, integrated",
    reason="what the joint gives at $k_n = 5\\cdot 10^{12}$ N/m³",
)
def quarter_periods():
    column, out = round_column(stiffness=STIFF), []
    for share in (0.5, 0.75):
        times, axes = released(column, Start(share * column.slenderness, 0.6), 1.3)
        lean = axes[:, 0, 2] * math.cos(0.6) + axes[:, 1, 2] * math.sin(0.6)
        i = int(np.argmax(lean < 0.0))
        out.append(times[i - 1] + (times[i] - times[i - 1]) * lean[i - 1] / (lean[i - 1] - lean[i]))
    return out


@case(
    "dem3d",
    "steady rolling at a tilt of 0.1: tilt, and precession over 2 s [rad]",
    Near((0.1, 2.0 * 1.9129969655), rel=3e-3),
    source=f"balance of moments about the contact; {RIGID}",
    reason="the rim rolls over ever new points of the joint",
)
def steady_rolling():
    _, axes = released(round_column(stiffness=STIFF), wobble(0.1, 1.9129969655), 2.0, pivot_friction=0.0)
    azimuth = np.unwrap(np.arctan2(axes[:, 1, 2], axes[:, 0, 2]))
    return math.acos(axes[-1, 2, 2]), azimuth[-1]


@case(
    "dem3d",
    "released almost in a plane it rolls round its rim: azimuth when it leans out again after 1.406 s [rad]",
    Near(3.218624, abs=1e-3),
    source=f"lateral rate 0.01 rad/s; {RIGID}",
    reason="what the joint gives",
)
def almost_planar():
    times, axes = released(round_column(stiffness=STIFF), wobble(0.1, 0.01), 1.6, pivot_friction=0.0)
    return np.interp(1.405973, times, np.unwrap(np.arctan2(axes[:, 1, 2], axes[:, 0, 2])))


@case(
    "column",
    "static uplift of the same column on a base that rises by 2° towards azimuth 0° and 70° [g]",
    Near((math.tan(round_column().slenderness - math.radians(2.0)),) * 2, rel=1e-9),
    source=r"$\tan(\alpha - \beta)$",
    reason="bisection to rounding",
)
def uplift_on_a_slope():
    slopes = (AsFound((), 2.0, azimuth) for azimuth in (0.0, 70.0))
    return [round_column().replace(as_found=slope).uplift_acceleration / g for slope in slopes]
