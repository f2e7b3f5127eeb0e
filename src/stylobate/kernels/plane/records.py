"""Records of bodies in the plane over lanes: what a run of stacked drums, of an assembly or of a collapse is computed with.

A block advances as many independent runs together as its records have lanes: sixteen in batches, one where something has
come loose. The innermost loops run over lanes, without a branch that depends on one, so that they fill the vector
registers. Every array is one of records whose fields hold one value per lane: distances in memory are then known to the
compiler. A lane whose run is over has ``dt = 0`` and stands still; it is taken out before the block goes on.

Legend (contacts, lists of them and links: ``shared/records.py``; body 0 of a column is its base;
positions at t_n, velocities at t_{n−1/2})::

    body[i]    x z th c s     centroid [m], rotation [rad], its cosine and sine
               vx vz w        velocities [m/s], [rad/s]
               m i im ii      mass [kg], inertia [kg m²], and their inverses (0 where fixed)
               fx fz mo       force [N] and moment about the centroid [N m] of all contacts; not on graphics cards
    load[k]    fx fz mu_ ml   force of contact k on its upper body [N], moments on the upper and the lower one about their
                              centroids [N m]
    joint[j]   ht wl wr       of the lower body: centroid to its face; from the centroid's foot to the face's left and right
                              end [m];  lc ls  direction of the face in the axes of that body
               hb bl br       the same of the upper body;  turned[2]  direction of its face; one row, unused, where all upper
                              faces lie along the axes of their bodies, as those of columns do
               mu             tan φ
               fs fn dn ds    spring and dashpot forces [N]
      with contact points (a row for each point):
               kn ks co       k_n, k_s, cohesion × area per length of overlap      [N/m²], [N/m²], [N/m]
               over           length of overlap of the two faces                   [m]
      with one interface: interface_joint.py
    lane       dt g gx        step [s], gravity normal to the base and along it (down to the left) [m/s²]
               damp           stiffness- and mass-proportional damping [s], [1/s], Cundall's local damping [-]; one row,
                              unused, where nothing is damped
               xi[p] sh[p]    place (−1 … 1) and share of the area of contact point p
               work shear visc  work of the input, of the shear springs on their surroundings reversed, of the dampers [J]
               px pz          momentum of all bodies [kg m/s]
    ground[k]  ax az          acceleration of the base at step k of the chunk [m/s²]
    feed       x z            addresses of the samples of the lane's motion (z 0: no vertical component)
               last step end  index of the last sample, step now, last step
               ratio factor   step over sample interval, factor of the samples
               bc bs          cosine and sine of the base's slope, along which the motion is taken
    watch      status         RUNNING, ENDED, COLLAPSED, FAILED or FREE
               follow         1: go on after a collapse
               amax           largest horizontal acceleration of the motion, and of its vertical part vmax [m/s²]
               th tc ts       topmost face: centroid to it [m], its direction in the axes of the topmost drum
               top open turn wmax   peaks: |top displacement| [m], joint opening [m], |rotation| [rad], |input work| [J]
               going          1 while some part is beyond its support and moves outward
               ktop kopen kturn     the peaks as they were when last no part was on its way out
               when which side      collapse: step, joint, side (±1); −1 while there is none
               stood          where the middle of the topmost face stood [m]
               m x z px link_moment  running sums over the drums above a joint; what links hold about it [N m]
"""

import numpy as np

from ..shared.records import BOND_TYPE, NO_LINK, PAIR_TYPE, SPAN_TYPE, TOUCH_TYPE, link_types

#: Rows of ``damp``.
BETA, ALPHA, LOCAL = range(3)


def _fields(names, *shape):
    return [(name, np.float64, shape) for name in names.split()]


def point_joint(points, damped, lanes, turned=False):
    """Record type of a joint with contact points; ``turned`` where upper faces may be inclined to their bodies' axes."""
    return np.dtype(
        _fields("ht wl wr lc ls hb bl br kn ks co mu over", lanes)
        + _fields("turned", 2 if turned else 1, lanes)
        + _fields("fs fn", points, lanes)
        + _fields("dn ds", points if damped else 1, lanes)
    )


def interface_joint(crushing, damped, lanes):
    """Record type of a joint that is one interface."""
    return np.dtype(
        _fields("ht wl wr lc ls hb bl br kn km ks co mu tau chi sp fs fn el gap", lanes)
        + _fields("turned", 1, lanes)
        + _fields("crush", 2 if crushing else 1, lanes)
        + _fields("dn ds", 2 if damped else 1, lanes)
    )


def types(joint, damped, points, lanes, linked):
    """Record types by their names in ``shared.records.STATE``; compiled once for each combination that is used.

    Parameters
    ----------
    joint : dtype
        :func:`point_joint` or :func:`interface_joint`.
    damped : bool
        Whether anything is damped.
    points : int
        Contact points of a joint.
    lanes : int
    linked : bool
        Whether there are links.
    """
    link, hold = link_types(lanes)
    counts = [(name, np.int64, (lanes,)) for name in ("status", "follow", "when", "which", "side", "parted", "about")]
    return {
        "body": np.dtype(_fields("x z th c s vx vz w m i im ii fx fz mo", lanes)),
        "joint": joint,
        "load": np.dtype(_fields("fx fz mu_ ml", lanes)),
        "link": link if linked else NO_LINK,
        "bond": BOND_TYPE,
        "lane": np.dtype(
            _fields("dt g gx work shear visc px pz", lanes)
            + _fields("damp", 3 if damped else 1, lanes)
            + _fields("xi sh", points, lanes)
        ),
        "ground": np.dtype(_fields("ax az", lanes)),
        "feed": np.dtype(
            [(name, np.int64, (lanes,)) for name in ("x", "z", "last", "step", "end")]
            + _fields("ratio factor bc bs", lanes)
        ),
        "watch": np.dtype(
            counts
            + _fields(
                "amax vmax th tc ts stood top open turn wmax wide going ktop kopen kturn m x z px link_moment", lanes
            )
        ),
        "hold": hold,
        "pair": PAIR_TYPE,
        "span": SPAN_TYPE,
        "touch": TOUCH_TYPE,
    }
