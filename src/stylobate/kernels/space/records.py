"""Records of bodies in space of which any two may touch; one lane. Positions at t_n, velocities at t_{n−1/2}.

Legend::

    body[i]    x y z … ib     as in ``dem3d/records.py``, of one lane each
               f[3] mo[3]     force and moment of all contacts at t_n [N], [N m]
               r              distance of the farthest point from the centroid [m]
               travel         way that no point of the body can have exceeded since the pairs were listed [m]
               local          Cundall's local damping, for settling and for what comes to rest [-]
               past[3]        angular velocity after the last kick, before the drift that followed [rad/s]
               fixed          1: it moves with the ground
    shape[s]   body kind      whose it is; BLOCK, DRUM or GROUND (the half-space below the origin of its body, k is up)
               first count    its vertices in ``vertex`` [m], in the axes of the body from its centroid
               face faces     its faces: planes n·x ≤ d in ``plane``, and in ``loop`` where their corners are in ``corner``
               m[3] r         middle of a sphere around it, in the axes of its body, and its radius [m]
               c[3] e[3]      of drums: middle of the lower face, and the axis, in the axes of the body [m], [-]
               h rb rt        height, radii of the lower and the upper face [m]
    loop[f]    first count    corners of face f, numbers of vertices of the shape, counter-clockwise seen from outside
               inner          1: all of it lies on other shapes of its body
    pair[p]    a b            shapes whose bodies may touch, a < b;  joint  number of the joint of two of their faces, or −1
               n[3]           direction from a to b: normal of the contact, or an axis that parts them [-]
               ta[3] tb[3]    directions in which drums a and b turn a facet, from their axes; along n where they are 0
               side           1, 2: it is the side of drum a, or b, that is touched
               f[3] t         shear force on b at the middle of what touches [N], torsion on b about n there [N m]
               s[3] st kc jc  core of the shear, see shared/friction.py, in space: force, torsion [N m], k [N/m], j [N m];
                              at[3]  its place in the axes of the first body from its centroid, of a joint in those of the
                              lower face from its middle [m];  fs[3] ft kf jf  the same of the fresh layer
               fn en          normal force at the last step [N], elastic energy of the pressure [J]
               pn pf pd       power of pressure, friction springs and dashpots at the last step, before they acted [W]
               d[3]           dashpots: force on b [N], and torsion [N m] in ``dt``
               area           of the contact [m²], 0 where there is none
               ra[3] rb[3]    its middle at the last step from the centroid of either body [m]
               gap            how far apart the shapes are along n [m], where they do not touch
               share          of the bed in what the shapes hold, 0 where they do not touch;  total[SUMS]  of their overlap
               va[3] whole    vector area [m²] and volume [m³] of the contact that theirs is a part of;  en_part  its share
                              of the work that has pressed that [J]
    joint[j]   a b            shapes of the lower and the upper face, a body each
               ml il jl       middle and two directions of the lower face in the axes of its body, il × jl out of it [m], [-]
               mu iu ju       the same of the upper face, iu × ju into its body
               rl ru          radii of round faces [m]; of others from ``first_l`` on ``many_l`` corners (and ``_u``)
                              in ``edge`` [m], counter-clockwise, the lower face smaller by ``LESS``
               kn ks tan co   stiffness and cohesion per area [N/m³], [Pa], tan φ
               width          area of the smaller face [m²]
               from_c to_c    cosines of the relative tilts from which the bed acts too, and alone
               apart_c apart  faces that open at a tilt of more than this cosine, or an overlap below it [m²], part for good
               weight live    1 joint, 0 bed, between them both; 0: the faces have parted for good
               gf gm          force and moment of damping on the upper body about the middle of the lower face [N], [N m]
               f t s st kc jc at fs ft kf jf d dt en pf pd n ra rb  what is remembered, as of a pair;  over  area of the
                              overlap [m²]
    law[a, b]  k_n, k_s [N/m³], tan φ of bodies a < b
    now        dt last earlier  step, the last part of one that was taken, and the one before [s]
               kick           longest time for which forces at t_n may act [s]
               eta calm       restitution of the bed: F is larger by eta while it closes, smaller while it opens; below the
                              speed ``calm`` [m/s] in proportion to it;  dull  the same of the joints
               beta           stiffness-proportional damping [s]
               g[3]           gravity, as an acceleration of the base: up is positive [m/s²]
               skin           of the bounding spheres [m]
               rate           largest (circular frequency)² of a contact at the last step [1/s²]
               deepest        largest mean depth of the bed so far [m]
               work shear visc  work of the input, of the friction springs on their surroundings reversed, of dampers [J]
               pairs touched status  pairs listed; first step with a foreign contact, −1; RUNNING or FAILED
    ties         the links: arrays link, bond, seat and load of as many rows each; see ``shared/records.py``, and
    bond[m]    lower upper    its bodies;  i[3] j[3] k[3]  of what crosses a joint two directions along it and the one across
                              it, from the lower body to the upper one, in the axes of the lower body [-]
    seat[m]                   the lower body in these axes;  ht  0
    load[m]    f up lo        force on the upper body, moments on the upper and the lower one [N], [N m]
    feed ground  as in ``dem3d/records.py``, of one lane
"""

import numpy as np

from ..shared.records import BOND_TYPE, link_types

#: Kinds of shapes.
BLOCK, DRUM, GROUND = range(3)

#: Facets of the prism that stands for a drum.
FACETS = 12

#: The second of two shapes, and the lower one of two faces, is taken smaller by this factor: what is flush never coincides.
LESS = 1.0 - 1.0e-10

#: Most vertices and faces of a shape, most corners of a clipped face.
MOST_VERTICES, MOST_FACES, MOST_CORNERS = 256, 512, 1024

#: Sums over the surface of an overlap, see ``overlap.py``, and over the edge of one, see ``boundary.py``.
SUMS, OF_SUMS = 29, 19


def types() -> dict[str, np.dtype]:
    """Record types by name."""

    def fields(names: str, *rows: int, kind: type = np.float64) -> list[tuple]:
        return [(name, kind, rows) if rows else (name, kind) for name in names.split()]

    def counts(names: str) -> list[tuple]:
        return fields(names, kind=np.int64)

    axes = " ".join(f"{axis}{c}" for axis in "ijk" for c in "xyz")
    return {
        "body": np.dtype(
            fields(f"x y z vx vy vz {axes} lx ly lz wx wy wz m im ia ic ib", 1)
            + fields("f mo past", 3)
            + fields("r travel local")
            + counts("fixed")
        ),
        "shape": np.dtype(counts("body kind first count face faces") + fields("m c e", 3) + fields("r h rb rt")),
        "loop": np.dtype(counts("first count inner")),
        "pair": np.dtype(
            counts("a b joint side")
            + fields("n ta tb f d ra rb va s fs at", 3)
            + fields("total", SUMS)
            + fields("t dt kc jc st ft kf jf fn en area gap share whole en_part pn pf pd")
        ),
        "joint": np.dtype(
            counts("a b first_l many_l first_u many_u live")
            + fields("ml il jl mu iu ju f d gf gm n ra rb s fs at", 3)
            + fields("rl ru kn ks tan co width from_c to_c apart_c apart weight t dt kc jc st ft kf jf en over pf pd")
        ),
        "now": np.dtype(
            fields("dt last earlier kick eta dull calm beta skin rate deepest work shear visc")
            + fields("g", 3)
            + counts("pairs touched status")
        ),
        "link": link_types(1)[0],
        "bond": np.dtype(
            [(name, BOND_TYPE[name]) for name in BOND_TYPE.names or ()] + counts("lower upper") + fields("i j k", 3)
        ),
        "seat": np.dtype(fields(f"x y z vx vy vz wx wy wz {axes} ht", 1)),
        "load": np.dtype(fields("f up lo", 3, 1)),
        "feed": np.dtype(fields("x y z last step", 1, kind=np.int64) + fields("ratio factor", 1) + fields("r", 9, 1)),
        "ground": np.dtype(fields("a", 3, 1)),
    }


def workspace() -> tuple[np.ndarray, ...]:
    """Arrays that one contact needs: of either shape vertices, planes and heights; polygons, faces that matter, sums."""
    return (
        np.zeros((MOST_VERTICES, 3)),
        np.zeros((MOST_FACES, 4)),
        np.zeros(MOST_VERTICES),
        np.zeros((MOST_VERTICES, 3)),
        np.zeros((MOST_FACES, 4)),
        np.zeros(MOST_VERTICES),
        np.zeros((MOST_CORNERS, 3)),
        np.zeros((MOST_CORNERS, 3)),
        np.zeros(MOST_FACES, dtype=np.int64),
        np.zeros(MOST_FACES, dtype=np.int64),
        np.zeros(SUMS),
    )


def workspace_of_joints() -> tuple[np.ndarray, ...]:
    """Arrays that one joint needs: corners of the upper face, arcs, and sums, see ``boundary.py``."""
    return np.zeros((MOST_VERTICES, 3)), np.zeros((MOST_VERTICES, 2)), np.zeros(OF_SUMS)
