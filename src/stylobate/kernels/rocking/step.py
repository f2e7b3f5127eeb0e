"""Housner's block: one step of the rocking equation, impacts located, and the loop over lanes.

Legend: x ≥ 0 rotation on the side the block stands on, s = ±1 that side (+1 tilts towards +x, so θ = s x clockwise),
v = ẋ, α slenderness, p² = m g R / I₀, e restitution, A = a_g/g, Γ = 1 + a_v/g, w = α − x.
Energies are per I₀.
"""

import math

import numpy as np

from ..ground import load
from ..jit import apart, kernel, law

#: Runs that one call advances together.
LANES = 64
#: Steps between two looks at the ground motion.
CHUNK = 64

# Rows of the state, each of LANES values in one flat array: with one base pointer the compiler needs no alias checks.
X, V, SIDE, MOVING, WORK, WORK_MAX, TO_RIGHT, LOSS = (row * LANES for row in range(8))
ALPHA, P2, E, STEP, LEFT, SIN_A, COS_A, X_EVENT = (row * LANES for row in range(8, 16))
X_OLD, V_OLD, WORK_OLD, COLLAPSE, IMPACTS, TO_LEFT = (row * LANES for row in range(16, 22))
ROWS = 22

# Rows of the table of whole numbers, one column per lane: motion at half steps, its last index, half steps done.
A_ADDRESS, AV_ADDRESS, REMAIN_ADDRESS, LAST, DONE = range(5)
WHOLE = 5

# Rows of the table of numbers that are looked at once per chunk, one column per lane.
FACTOR, A_REMAIN, GAMMA_MIN, LIFT = range(4)
REAL = 4

TERMS = 8


def trigonometry(linear: bool) -> tuple[float, ...]:
    """Coefficients of sin w / w, then of cos w, in powers of w²; the linearised equation keeps the first of each.

    Chebyshev interpolation on |w| ≤ 2 rad, error below 2e-13; 2 × TERMS numbers.
    """
    if linear:
        return ((1.0,) + (0.0,) * (TERMS - 1)) * 2
    from numpy.polynomial import Chebyshev, Polynomial

    fits = []
    for function in (lambda u: np.sinc(np.sqrt(np.abs(u)) / np.pi), lambda u: np.cos(np.sqrt(np.abs(u)))):
        fit = Chebyshev.interpolate(function, TERMS - 1, domain=[0.0, 4.0])
        fits.extend(fit.convert(kind=Polynomial, domain=[-1, 1], window=[-1, 1]).coef)
    return tuple(float(value) for value in fits)


@law
def sine(w, c):
    """Sine by polynomial, |w| ≤ 2 rad."""
    u = w * w
    y = c[7]
    y = y * u + c[6]
    y = y * u + c[5]
    y = y * u + c[4]
    y = y * u + c[3]
    y = y * u + c[2]
    y = y * u + c[1]
    y = y * u + c[0]
    return y * w


@law
def cosine(w, c):
    """Cosine by polynomial, |w| ≤ 2 rad."""
    u = w * w
    y = c[15]
    y = y * u + c[14]
    y = y * u + c[13]
    y = y * u + c[12]
    y = y * u + c[11]
    y = y * u + c[10]
    y = y * u + c[9]
    y = y * u + c[8]
    return y


@law
def step(x, v, a0, a1, a2, g0, g1, g2, h, alpha, p2, c):
    """One step of Nyström's method of order four on one side, no impact.

    ``a``: side × a_g/g and ``g``: 1 + a_v/g at the start, the middle and the end. Returns x, v and the input work.
    """
    s0, c0 = sine(alpha - x, c), cosine(alpha - x, c)
    k0 = -p2 * (g0 * s0 + a0 * c0)  # Eq. (H1); Housner 1963, with vertical input
    x1 = x + 0.5 * h * v + 0.125 * h * h * k0
    s1, c1 = sine(alpha - x1, c), cosine(alpha - x1, c)
    k1 = -p2 * (g1 * s1 + a1 * c1)
    x2 = x + h * v + 0.5 * h * h * k1
    s2, c2 = sine(alpha - x2, c), cosine(alpha - x2, c)
    k2 = -p2 * (g2 * s2 + a2 * c2)
    x_new = x + h * v + h * h / 6.0 * (k0 + 2.0 * k1)
    v_new = v + h / 6.0 * (k0 + 4.0 * k1 + k2)
    v_mid = 0.5 * (v + v_new) + 0.125 * h * (k0 - k2)
    r0 = -v * (a0 * c0 + (g0 - 1.0) * s0)
    r1 = -v_mid * (a1 * c1 + (g1 - 1.0) * s1)
    r2 = -v_new * (a2 * c2 + (g2 - 1.0) * s2)
    return x_new, v_new, h / 6.0 * p2 * (r0 + 4.0 * r1 + r2)


@law
def between(y0, y1, y2, r):
    """Parabola through the values at the start, the middle and the end of a step, at the share r of it."""
    return y0 + r * (4.0 * y1 - 3.0 * y0 - y2) + 2.0 * r * r * (y0 - 2.0 * y1 + y2)


@law
def uplift(a, g, side, sin_a, cos_a):
    """Positive where a block at rest starts to rock onto ``side``: overturning less stabilising moment over m g R."""
    return -side * a * cos_a - g * sin_a


@law
def first_uplift(a0, a1, a2, g0, g1, g2, share, sin_a, cos_a):
    """Share of the step at which a block at rest starts to rock, and onto which side; side 0 if it does not.

    Input is taken as linear over each half of the step; ``share`` is where the search begins.
    """
    best, best_side = 2.0, 0.0
    for side in (1.0, -1.0):
        for half in range(2):
            start, end = 0.5 * half, 0.5 + 0.5 * half
            if end <= share:
                continue
            left = uplift(a1, g1, side, sin_a, cos_a) if half else uplift(a0, g0, side, sin_a, cos_a)
            right = uplift(a2, g2, side, sin_a, cos_a) if half else uplift(a1, g1, side, sin_a, cos_a)
            begin = max(share, start)
            here = left + (right - left) * (begin - start) / 0.5
            at = 2.0
            if here > 0.0:
                at = begin
            elif right > 0.0:
                at = max(begin, start + 0.5 * left / (left - right))
            if at < best:
                best, best_side = at, side
    return best, best_side


@law
def peaks(right, left, side, x):
    """Largest rotation to either side so far, with the present one."""
    tilt = side * max(x, 0.0)
    return max(right, tilt), max(left, -tilt)


@kernel
def resolve(s, l, a0, a1, a2, g0, g1, g2, rest, c):
    """Repeat the last step of one lane with its impacts located and its start from rest found.

    ``a``, ``g``: a_g/g and 1 + a_v/g at the start, the middle and the end of the step; ``rest``: the impact velocity
    over p α under which the block comes to rest.
    """
    h, alpha, p2, e = s[STEP + l], s[ALPHA + l], s[P2 + l], s[E + l]
    x, v, side, moving = s[X_OLD + l], s[V_OLD + l], s[SIDE + l], s[MOVING + l]
    work = s[WORK_OLD + l]
    share = 0.0
    for _ in range(100_000):
        if moving == 0.0:
            at, new_side = first_uplift(a0, a1, a2, g0, g1, g2, share, s[SIN_A + l], s[COS_A + l])
            if new_side == 0.0 or at >= 1.0:
                break
            share, side, moving = at, new_side, 1.0
        # From here to the end of the step, and if the block goes through upright on the way, only to there.
        whole = 1.0 - share
        low, high, part = 0.0, whole, whole
        x1, v1, w1 = x, v, 0.0
        for iteration in range(80):
            middle, end = share + 0.5 * part, share + part
            x1, v1, w1 = step(
                x, v,
                side * between(a0, a1, a2, share), side * between(a0, a1, a2, middle), side * between(a0, a1, a2, end),
                between(g0, g1, g2, share), between(g0, g1, g2, middle), between(g0, g1, g2, end),
                part * h, alpha, p2, c,
            )  # fmt: skip
            if iteration == 0 and x1 >= 0.0:
                break
            if x1 < 0.0:
                high = part
            else:
                low = part
            if iteration == 0:  # larger root of the parabola through x, v and the end
                bend = 2.0 * (x1 - x - v * h * whole) / (h * whole) ** 2
                next_part = (-v - math.sqrt(max(0.0, v * v - 2.0 * bend * x))) / (bend * h) if bend < 0.0 else 0.0
            else:
                next_part = part - x1 / (v1 * h) if v1 < 0.0 else 0.0
            if not low < next_part < high:
                next_part = 0.5 * (low + high)
            if abs(next_part - part) <= 1e-11 * whole or high - low <= 1e-11 * whole:
                break
            part = next_part
        work += w1
        x, v = x1, v1
        share += part
        if part == whole and x >= 0.0:
            break
        # Impact: the velocity keeps its direction, and the block goes on on its other side.
        x, v, side = 0.0, -e * min(v, 0.0), -side
        s[LOSS + l] += 0.5 * min(v1, 0.0) ** 2 - 0.5 * v * v  # Housner 1963: the share 1 − e²
        s[IMPACTS + l] += 1.0
        if v <= rest * math.sqrt(p2) * alpha:
            s[LOSS + l] += 0.5 * v * v
            v, moving = 0.0, 0.0
        if share >= 1.0:
            break
    s[X + l], s[V + l], s[SIDE + l], s[MOVING + l] = x, v, side, moving
    s[WORK + l] = work
    s[WORK_MAX + l] = max(s[WORK_MAX + l], work)
    s[TO_RIGHT + l], s[TO_LEFT + l] = peaks(s[TO_RIGHT + l], s[TO_LEFT + l], side, x)


@law
def point_of_no_return(alpha, remaining, lightest, linear):
    """Rotation beyond which a block that moves outward falls, whatever is left of the input.

    There gravity beats the largest remaining |a_g|/g at the smallest remaining 1 + a_v/g, and does so ever after.
    """
    pull = remaining / lightest
    return alpha + (pull if linear else math.atan(pull))


@apart
def fill(out, rows, addresses, lasts, starts, factors, offset):
    """Write the input of every lane at consecutive half steps: row r and lane l at ``r * LANES + l``.

    ``addresses`` of arrays that hold the motions at the half steps of the runs and a zero behind (index ``lasts``);
    address 0 stands for no motion. ``starts``: half steps done; ``offset`` is added to every value.
    """
    for r in range(rows):
        row = out[r * LANES : (r + 1) * LANES]
        for l in range(LANES):
            value = offset
            if addresses[l] != 0:
                value += factors[l] * load(addresses[l], min(starts[l] + r, lasts[l]))
            row[l] = value


@kernel
def drop(a, g, row, whole, j):
    """End of a motion with the step before j: step j starts without it, and the row has served both."""
    for l in range(LANES):
        if whole[DONE, l] + 2 * j == whole[LAST, l] - 1:
            a[row + l], g[row + l] = 0.0, 1.0


@apart
def advance(s, whole, real, a, g, c, chunks, chunk, rest, linear, vertical, until_end):
    """Advance all lanes by up to ``chunks`` × ``chunk`` steps; lanes that are over stand still.

    Parameters
    ----------
    s : array, shape (ROWS * LANES,)
    whole, real : array, shape (WHOLE, LANES), (REAL, LANES)
    a, g : array, shape ((2 CHUNK + 1) * LANES,)
        Room for a_g/g and 1 + a_v/g at half steps.
    c : tuple of float
        From :func:`trigonometry`.
    chunk : int
        Steps between two looks at the ground motion, :data:`CHUNK` at most.
    """
    for _ in range(chunks):
        alive = 0
        for l in range(LANES):
            if s[LEFT + l] <= 0.0:
                continue
            alive += 1
            if s[COLLAPSE + l] < 0.0:
                remaining = abs(real[FACTOR, l]) * load(whole[REMAIN_ADDRESS, l], min(whole[DONE, l], whole[LAST, l]))
                if remaining != real[A_REMAIN, l]:
                    real[A_REMAIN, l] = remaining
                    s[X_EVENT + l] = point_of_no_return(s[ALPHA + l], remaining, real[GAMMA_MIN, l], linear)
        if alive == 0:
            return
        rows = 2 * chunk + 1
        fill(a, rows, whole[A_ADDRESS], whole[LAST], whole[DONE], real[FACTOR], 0.0)
        if vertical:
            fill(g, rows, whole[AV_ADDRESS], whole[LAST], whole[DONE], real[LIFT], 1.0)
        cut = chunk
        for l in range(LANES):
            if whole[DONE, l] < whole[LAST, l]:
                cut = min(cut, (whole[LAST, l] - whole[DONE, l]) // 2)
        for j in range(chunk):
            row = 2 * j * LANES
            if j >= cut:
                drop(a, g, row, whole, j)
            row1, row2, row3 = row + LANES, row + 2 * LANES, row + 3 * LANES
            a_start, a_middle, a_end = a[row:row1], a[row1:row2], a[row2:row3]
            g_start, g_middle, g_end = g[row:row1], g[row1:row2], g[row2:row3]
            events = 0
            for l in range(LANES):
                active = j < s[LEFT + l]
                h = s[STEP + l] * s[MOVING + l] if active else 0.0
                x, v, side, work = s[X + l], s[V + l], s[SIDE + l], s[WORK + l]
                x1, v1, w1 = step(
                    x, v,
                    side * a_start[l], side * a_middle[l], side * a_end[l], g_start[l], g_middle[l], g_end[l],
                    h, s[ALPHA + l], s[P2 + l], c,
                )  # fmt: skip
                s[X_OLD + l], s[V_OLD + l], s[WORK_OLD + l] = x, v, work
                s[X + l], s[V + l], s[WORK + l] = x1, v1, work + w1
                s[WORK_MAX + l] = max(s[WORK_MAX + l], work + w1)
                s[TO_RIGHT + l], s[TO_LEFT + l] = peaks(s[TO_RIGHT + l], s[TO_LEFT + l], side, x1)
                turned = (x1 < 0.0) | (x1 > s[X_EVENT + l])
                lifted = (s[MOVING + l] == 0.0) & (abs(a_end[l]) * s[COS_A + l] > g_end[l] * s[SIN_A + l])
                flag = 1 if active & (turned | lifted) else 0
                events += flag
            if events == 0:
                continue
            for l in range(LANES):
                if j >= s[LEFT + l]:
                    continue
                impact = s[X + l] < 0.0
                lifted = s[MOVING + l] == 0.0 and abs(a_end[l]) * s[COS_A + l] > g_end[l] * s[SIN_A + l]
                if impact or lifted:
                    resolve(s, l, a_start[l], a_middle[l], a_end[l], g_start[l], g_middle[l], g_end[l], rest, c)
                if s[X + l] > s[X_EVENT + l] and s[V + l] > 0.0:
                    if s[COLLAPSE + l] < 0.0:
                        s[COLLAPSE + l] = (whole[DONE, l] // 2 + j + 1) * s[STEP + l]
                        s[X_EVENT + l] = 0.5 * math.pi  # on its side
                        if not until_end:
                            s[LEFT + l] = 0.0
                    else:
                        s[LEFT + l] = 0.0
        for l in range(LANES):
            whole[DONE, l] += 2 * chunk
            s[LEFT + l] -= chunk
