"""Records of the lanes of drums in space: every field holds one value per lane; the number of lanes is in the types.

Legend (i body, 0 is the base; j joint, between bodies j and j + 1; positions at t_n, velocities at t_{n−1/2})::

    body[i]    x y z          centroid [m];  vx vy vz  its velocity [m/s]
               i. j. k.       axes of the body (x, y, z each), k its axis of symmetry, j = k × i   [-]
               lx ly lz       angular momentum about the centroid, in space [kg m²/s]
               wx wy wz       angular velocity that goes with it at t_n [rad/s]
               m im           mass and its inverse [kg]
               ia ic          1/A, and 1/C − 1/A, with the inertia A about j and C about k           [1/(kg m²)]
               ib             1/B − 1/A, with the inertia B about i (0 for round drums)                    [1/(kg m²)]
               fx fy fz       middle of the lower face from the centroid, in the axes of the body [m]
               nx ny nz       normal of the lower face (up), in the axes of the body [-]
               ht             centroid to the middle of the upper face, along k [m]
               ax ay az       the axis k at the start [-]
               rb rt          radii of the lower and the upper face [m]; to the farthest corner, if they have corners
               px py pz [4]   corners of the lower face from its middle, in the axes of the body, in order round it [m]
               tx ty          half widths of the upper face along i and j [m] (round drums: unused)
               f[3] mo[3]     force and moment of all its contacts at t_n, where the ledger is asked for [N], [N m]
    joint[j]   kn ks co       stiffness and cohesion per area [N/m³], [N/m³], [Pa]
               mu             tan φ
               s[3] t kc jc   core of the shear, see shared/friction.py: force on the drum above in the axes of that below
                              [N], torsion [N m], its k [N/m] and j [N m];  at[3]  its place from the middle of the face
                              below, in the same axes [m];  fs[3] ft kf jf  the same of the fresh layer;
                              tm[3]  moment of both about the middle of the face below, in space [N m];
                              with corners ``s`` is one shear force for each of them, x, y, z, and all else but kc is 0
               en             elastic energy of the normal pressure [J]
               ox oy ot       slip in the axes of the drum below [m] and twist [rad] at the start
               tw             twist at the last look, full turns counted [rad]
               d[6]           dashpots: force and moment on the drum above, about the middle of the face below (damped only);
                              with corners the force of each of them, in the axes of the drum below
               chip[6]        what the upper face lacks, with chips: see rim.py
               ring[3]        on an elastic bed: radii of the sunken middles of the upper and of the lower face [m], and the
                              limit of torsion over ρ μ N; of one row without sunken middles
               w[22]          with corners: what they share within one evaluation, see corner.py
    load[n]    f[3] up[3] lo[3]  force of contact n on its upper body [N], moments on both about their centroids [N m]
                              the last two rows: a sum of several, and nothing
    link[m] bond[m]           see shared/records.py; of type ``none`` without links
    lane       dt             step [s];  g[3]  gravity, as an acceleration of the base: up is positive [m/s²]
               damp[3]        damped only, rows BETA, ALPHA, LOCAL: stiffness- and mass-proportional damping [s], [1/s];
                              Cundall's local damping [-]
               pivot          share of the torsional friction that acts [-]
               roll           resistance to rolling, a share of the lever of pressure (only where there is some) [-]
               free           1; 0 holds the motion in the plane of x and z
               work shear visc  work of the input, of the friction springs on their surroundings reversed, of dampers [J]
               p[3]           momentum of all bodies [kg m/s]
    ground[k]  a[3]           acceleration of the base at step k of the chunk [m/s²]
    feed       x y z          addresses of the samples of the lane's motion (0: no such component)
               last step end  index of the last sample, step now, last step
               ratio factor   step over sample interval, factor of the samples
               r[9]           turns the motion's axes into those of the base
    watch      status         RUNNING, ENDED, COLLAPSED, FAILED or FREE;  follow  1: go on after a collapse
               amax vmax      largest acceleration of the motion along the base and normal to it [m/s²]
               sx sy          where the middle of the topmost face stood [m]
               top topx topy  largest displacement of the middle of the topmost face in plan, and of each component [m]
               open turn      largest opening of a joint [m], 1 − cos of a drum's tilt [-]
               lean           1 − cos of the largest turn of a drum's axis since the start [-]
               spin wmax      largest twist of a joint [rad]; largest |input work| [J]
               when which     collapse: step, joint; −1 while there is none
               parted about wide  1 if the faces have parted; the joint that is widest open then, and how wide [m]
               ex ey          direction of the collapse [-]
               tw             twist of a specimen at the last look, full turns counted [rad]
               going          1 while some part is beyond its support and moves outward
               ktop … kspin   the peaks as they were when last no part was on its way out
               m x y z px py  running sums over the bodies above a joint
    hold[j]    moment         what whole links hold about joint j [N m]; no such rows without links
    pair span touch           contacts of bodies, see shared/records.py: joints first, then links
"""

from collections.abc import Callable
from functools import partial

import numpy as np

from ..run_codes import LANES
from ..shared.records import BOND_TYPE, NO_LINK, PAIR_TYPE, SPAN_TYPE, TOUCH_TYPE, link_types

#: Rows of ``damp``.
BETA, ALPHA, LOCAL = range(3)

#: Rows of ``ring`` and of ``chip``, and those of ``w`` with corners.
RINGS, CHIPS, SHARED = 3, 6, 22

#: Corners of a rectangular face.
CORNERS = 4

#: Peaks that are kept, see the legend of ``watch``.
PEAKS = ("top", "topx", "topy", "open", "turn", "lean", "spin")


#: Fields of so many rows of lanes, by their names.
Fields = Callable[..., list[tuple]]


def fields(names: str, *rows: int, kind: type = np.float64, lanes: int = LANES) -> list[tuple]:
    """Fields of so many rows of lanes."""
    return [(name, kind, (*rows, lanes)) for name in names.split()]


def types(
    face: str, damped: bool = False, rolling: bool = False, linked: bool = False, lanes: int = LANES
) -> dict[str, np.dtype]:
    """Record types by their names in ``STATE`` (``shared/frame.py``).

    They tell what is computed: each loop is compiled for what is used. A body with corners may have three different moments
    of inertia.

    Parameters
    ----------
    face : {"rim", "chip", "bed", "ring", "corner", "vertex"}
        On what bodies stand: on whole or chipped rims, on an elastic bed of discs or of rings, on the corners of their
        faces; or one body on its vertices.
    damped, rolling, linked : bool
        Whether there are dashpots, resistance to rolling, links.
    lanes : int
    """
    corners = CORNERS if face in ("corner", "vertex") else 1
    axes = " ".join(f"{axis}{c}" for axis in "ijk" for c in "xyz")
    link, hold = link_types(lanes)
    lane_fields = partial(fields, lanes=lanes)
    return {
        "body": np.dtype(
            lane_fields(
                f"x y z vx vy vz {axes} lx ly lz wx wy wz m im ia ic ib fx fy fz nx ny nz ax ay az ht rb rt tx ty"
            )
            + lane_fields("px py pz", corners)
            + lane_fields("f mo", 3)
        ),
        "joint": vertex_type(lane_fields) if face == "vertex" else joint_type(face, damped, lane_fields),
        "load": np.dtype(lane_fields("f up lo", 3)),
        "link": link if linked else NO_LINK,
        "bond": BOND_TYPE,
        "lane": np.dtype(
            lane_fields("dt pivot free work shear visc")
            + lane_fields("g p", 3)
            + lane_fields("damp", 3 if damped else 1)
            + lane_fields("roll", 2 if rolling else 1)
            + (vertex_fields(lane_fields) if face == "vertex" else [])
        ),
        "ground": np.dtype(lane_fields("a", 3)),
        "feed": np.dtype(
            lane_fields("x y z last step end", kind=np.int64) + lane_fields("ratio factor") + lane_fields("r", 9)
        ),
        "watch": np.dtype(
            lane_fields("status follow when which parted about", kind=np.int64)
            + lane_fields("amax vmax sx sy wmax wide ex ey tw going m x y z px py")
            + lane_fields(" ".join(PEAKS) + " k" + " k".join(PEAKS))
        ),
        "hold": hold,
        "pair": PAIR_TYPE,
        "span": SPAN_TYPE,
        "touch": TOUCH_TYPE,
    }


def joint_type(face: str, damped: bool, lane_fields: Fields) -> np.dtype:
    """Record type of a joint between faces; ``lane_fields`` as :func:`fields`, for a number of lanes."""
    cornered = face == "corner"
    dashpots = (3 * CORNERS if cornered else 6) if damped else 1
    own = {
        "chip": lane_fields("chip", CHIPS),
        "bed": lane_fields("chip ring", 1),
        "ring": lane_fields("chip", 1) + lane_fields("ring", RINGS),
        "corner": lane_fields("chip", 1) + lane_fields("w", SHARED),
    }
    return np.dtype(
        lane_fields("kn ks co mu t kc jc en ox oy ot tw ft kf jf")
        + lane_fields("s", 3 * CORNERS if cornered else 3)
        + lane_fields("fs at tm", 1 if cornered else 3)
        + lane_fields("d", dashpots)
        + own.get(face, lane_fields("chip", 1))
    )


def vertex_type(lane_fields: Fields) -> np.dtype:
    """Record type of a vertex of a specimen, see ``vertices.py``."""
    return np.dtype(lane_fields("x y z kn ks rest") + lane_fields("s d", 3))


def vertex_fields(lane_fields: Fields) -> list[tuple]:
    """Fields that a lane has besides, of a specimen, see ``vertices.py``."""
    return lane_fields("mu lost reach above en st count") + lane_fields("near", MOST_ROWS // LANES)


#: Most rows of vertices that a body may have.
MOST_ROWS = 5120
