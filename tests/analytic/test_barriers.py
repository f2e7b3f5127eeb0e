"""Energy that overturns a column on soft joints, all of them: against the least potential energy on an edge."""

import numpy as np
import pytest
from scipy.optimize import minimize

import stylobate as st
from stylobate.models.shared.toes import bed_toes, disc_on_bed, point_toes, rim_toes


def column(drums: int, slenderness: float = 8.0, section: str = "circular") -> st.Column:
    size = {"height": slenderness, "bottom_width": 1.0, "top_width": 0.9, "density": 2700.0}
    return st.Column.tapered(**size, drums=drums, joint=st.Joint(1e9, 5e8, 35.0), section=section)


def joint_barriers(stone: st.Column, toes: np.ndarray) -> np.ndarray:
    """Barrier over each joint of small angles [J]: ½ (W b)²/(g B) of the rigid column less what joints give."""
    mass, height = stone.parts_above
    most = stone.joint_weights * 0.5 * stone.joint_widths
    return 0.5 * most**2 / (stone.gravity * mass * height) - toes.sum(axis=0)


def of_bed(kn: float, radius: float, weight: float):
    """Energy of a joint on a bed that is turned under its weight, over rest: the least over its depth (closed form)."""

    def stored(turn: float) -> float:
        slope, low, high = max(abs(turn), 1e-12), -radius * abs(turn), radius * abs(turn) + weight / kn
        for _ in range(60):
            depth = 0.5 * (low + high)
            low, high = (depth, high) if disc_on_bed(kn, radius, depth, slope)[0] < weight else (low, depth)
        return disc_on_bed(kn, radius, depth, slope)[1] - weight * depth + weight**2 / (2.0 * kn * np.pi * radius**2)

    return stored


def of_points(kn: float, radius: float, weight: float, area: float):
    """The same on two points, by the moment N b at which one opens."""
    most, first = weight * radius, weight / (kn * area * radius)
    return lambda turn: most * (0.5 * turn**2 / first if abs(turn) < first else abs(turn) - 0.5 * first)


def least_on_an_edge(stone: st.Column, joints) -> float:
    """Least potential energy at which some part stands over its edge and none beyond, by search over moments [J]."""
    mass, height = stone.parts_above
    order = np.arange(stone.n)
    leaning = stone.gravity * (mass * height)[np.maximum.outer(order, order)]
    most = stone.joint_weights * 0.5 * stone.joint_widths
    barriers = []
    for j in order:
        others, scale = order != j, most[j] ** 2 / leaning[j, j]

        def energy(shares, j=j, others=others, scale=scale):
            moments = np.full(stone.n, most[j])
            moments[others] = shares * most[others]
            turns = np.linalg.solve(leaning, moments)
            return (sum(joint(turn) for joint, turn in zip(joints, turns, strict=True)) - 0.5 * moments @ turns) / scale

        start = np.minimum(leaning[j] / leaning[j, j] * most[j] / most, 1.0)[others]
        for share in (1.0, 0.9):
            best = minimize(energy, share * start, bounds=[(-1.0, 1.0)] * (stone.n - 1), method="L-BFGS-B")
            barriers.append(best.fun * scale)
    return min(barriers)


@pytest.mark.parametrize(("kn", "least"), [(1e10, 0.97), (1e9, 0.6)])
def test_beds_overturn_with_no_less_than_is_told(kn, least):
    """Six drums on beds: below the least energy on an edge, and by no more than 3 % where no second joint comes to its
    edge first (1e10), or 40 % (1e9, where the base alone on a soft joint would have 0.86 of the rigid column's)."""
    stone = column(6)
    joints = [
        of_bed(kn, 0.5 * width, weight) for width, weight in zip(stone.joint_widths, stone.joint_weights, strict=True)
    ]
    lowest = joint_barriers(stone, bed_toes(stone, np.full(6, kn))).min()
    true = least_on_an_edge(stone, joints)
    assert least * true < lowest <= true


def test_points_overturn_with_no_less_than_is_told():
    """So soft that what they turn makes moments a tenth larger: sums over joints without that were too high."""
    stone = column(8, 13.0, "rectangular")
    kn = 1e8
    joints = [
        of_points(kn, 0.5 * width, weight, area)
        for width, weight, area in zip(stone.joint_widths, stone.joint_weights, stone.joint_areas, strict=True)
    ]
    lowest = joint_barriers(stone, point_toes(stone, np.full(8, kn), 0.5)).min()
    true = least_on_an_edge(stone, joints)
    assert 0.95 * true < lowest <= true


@pytest.mark.parametrize("toes", [rim_toes, bed_toes])
def test_stiff_joints_overturn_as_rigid_ones(toes):
    stone = column(6)
    rigid = joint_barriers(stone, np.zeros((2, 6))).min()
    barriers = [joint_barriers(stone, toes(stone, np.full(6, kn))).min() / rigid for kn in (1e9, 1e10, 1e11, 1e13)]
    assert barriers == sorted(barriers)
    assert 0.985 < barriers[-1] < 1.0


def test_a_tall_column_on_soft_beds_is_decided():
    """That of Marcus Aurelius at 3e9 N/m³, shaken a little: sums of all toes told a barrier below zero, so that no run of it
    was ever decided."""
    stone = st.preset("marcus-aurelius")
    soft = stone.replace(joints=tuple(j.changed(normal_stiffness=3e9, shear_stiffness=1.5e9) for j in stone.joints))
    response = st.simulate(
        soft, st.sine_pulse(1.0, 0.02 * st.g, 1.5), st.DistinctElement3D(law="bed"), output_interval=0.1
    )
    assert response.decided
    assert not response.collapsed
