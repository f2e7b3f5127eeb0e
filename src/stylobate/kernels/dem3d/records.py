"""Records of the lanes of drums in space: every field holds one value per lane.

Legend (i drum, 0 is the base; j joint, between drums j and j + 1; positions at t_n, velocities at t_{n−1/2})::

    drum[i]    x y z          centroid [m];  vx vy vz  its velocity [m/s]
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
    joint[j]   kn ks co       stiffness and cohesion per area [N/m³], [N/m³], [Pa]
               mu             tan φ
               s[3] t         shear force on the drum above in the axes of the drum below [N], torsion moment [N m];
                              with corners one shear force for each of them, x, y, z, and no torsion moment
               kf kt          shear and torsion stiffness that (each) s and t were stored with [N/m], [N m]
               en             elastic energy of the normal pressure [J]
               ox oy ot       slip in the axes of the drum below [m] and twist [rad] at the start
               tw             twist at the last look, full turns counted [rad]
               f[3] up[3] lo[3]  force on the drum above [N], moments on both drums about their centroids [N m]
               d[6]           dashpots: force and moment on the drum above, about the middle of the face below (damped only);
                              with corners the force of each of them, in the axes of the drum below
               lost           what the faces lack. Rings, [3]: radii of the sunken middles of the upper and of the lower face
                              [m], and the limit of torsion over ρ μ N. Chips, [6]: see chipped.py
               w[22]          with corners: what they share within one evaluation, see corner_forces.py
    lane       dt             step [s];  g[3]  gravity, as an acceleration of the base: up is positive [m/s²]
               beta alpha     stiffness- and mass-proportional damping [s], [1/s]; local: local damping [-]
               pivot          share of the torsional friction that acts [-]
               roll           resistance to rolling, a share of the lever of pressure (only where there is some) [-]
               free           1; 0 holds the motion in the plane of x and z
               work shear visc  work of the input, of the friction springs on their surroundings reversed, of dampers [J]
               p[3]           momentum of all drums [kg m/s]
               m…             links, see drums/link_records.py
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
               m x y z px py  running sums over the drums above a joint
               hold           what links hold, see drums/link_records.py
"""

import numpy as np

from ..drums.link_records import hold_field, link_fields
from ..run_codes import LANES

#: Rows of ``lost``.
RINGS, CHIPS = 3, 6

#: Peaks that are kept, see the legend of ``watch``.
PEAKS = ("top", "topx", "topy", "open", "turn", "lean", "spin")


def block_types(damped: bool, corners: int = 1, lost: int = 1, rolling: bool = False) -> tuple[np.dtype, ...]:
    """Record types (drum, joint, lane, ground, feed, watch).

    Whether there are dashpots (``d`` of more than one row), corners (``px``), rings or chips (``lost``, so many rows) and
    resistance to rolling (``roll``) is part of the types: each loop is compiled for what is used. A body with corners may
    have three different moments of inertia.
    """
    dashpots = (3 * corners if corners > 1 else 6) if damped else 1
    row = (LANES,)

    def fields(single: str, **several: int) -> list[tuple]:
        return [(name, np.float64, row) for name in single.split()] + [
            (name, np.float64, (rows, LANES)) for name, rows in several.items()
        ]

    def counts(names: str) -> list[tuple]:
        return [(name, np.int64, row) for name in names.split()]

    axes = " ".join(f"{axis}{c}" for axis in "ijk" for c in "xyz")
    return (
        np.dtype(
            fields(
                f"x y z vx vy vz {axes} lx ly lz wx wy wz m im ia ic ib fx fy fz nx ny nz ax ay az ht rb rt tx ty",
                px=corners,
                py=corners,
                pz=corners,
            )
        ),
        np.dtype(
            fields(
                "kn ks co mu t kf kt en ox oy ot tw",
                s=3 * corners,
                f=3,
                up=3,
                lo=3,
                d=dashpots,
                lost=lost,
                w=22 if corners > 1 else 1,
            )
        ),
        np.dtype(
            fields("dt beta alpha local pivot free work shear visc", g=3, p=3, roll=2 if rolling else 1) + link_fields()
        ),
        np.dtype(fields("", a=3)),
        np.dtype(counts("x y z last step end") + fields("ratio factor", r=9)),
        np.dtype(
            counts("status follow when which parted about")
            + fields("amax vmax sx sy wmax wide ex ey tw going m x y z px py")
            + fields(" ".join(PEAKS) + " k" + " k".join(PEAKS))
            + hold_field()
        ),
    )
