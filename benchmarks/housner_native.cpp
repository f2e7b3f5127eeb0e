// Native reference for the batched Housner block: the same scheme as stylobate/kernels/rocking/step.py, written for one
// compiler and one purpose, so that the compiled Python kernel can be measured against it.
//
// Usage: housner_native LANES STEPS REPEATS  ->  prints ns per lane and step, then the sum of the peak rotations.
// Block: α = 0.16, p = 1.7 rad/s, e = 0.94, sine of 1 Hz, amplitudes 0.17 g to 0.30 g over the lanes, step 4 ms.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

constexpr int LANES = 64, CHUNK = 64, TERMS = 8;
constexpr double ALPHA = 0.16, P2 = 1.7 * 1.7, E = 0.94, STEP = 4e-3, DT = 1e-3, PI = 3.14159265358979323846;

struct alignas(64) Block {
    double x[LANES], v[LANES], side[LANES], moving[LANES], work[LANES], work_max[LANES], peak[LANES];
    double alpha[LANES], p2[LANES], step[LANES], left[LANES], sin_a[LANES], cos_a[LANES], event[LANES];
    double x_old[LANES], v_old[LANES], work_old[LANES], factor[LANES];
    double a[(2 * CHUNK + 1) * LANES], g[(2 * CHUNK + 1) * LANES];
};

// Taylor series, as many terms as the kernel's polynomials.
static const double S[TERMS] = {1.0, -1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800,
                                1.0 / 6227020800, -1.0 / 1307674368000};
static const double C[TERMS] = {1.0, -1.0 / 2, 1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800,
                                1.0 / 479001600, -1.0 / 87178291200};

static inline void sine_cosine(double w, double& s, double& c) {
    const double u = w * w;
    double p = S[TERMS - 1], q = C[TERMS - 1];
#pragma GCC unroll 8
    for (int k = TERMS - 2; k >= 0; --k) { p = p * u + S[k]; q = q * u + C[k]; }
    s = p * w;
    c = q;
}

static inline void nystrom(double& x, double& v, double& work, double a0, double a1, double a2, double g0, double g1,
                           double g2, double h, double alpha, double p2) {
    double s0, c0, s1, c1, s2, c2;
    sine_cosine(alpha - x, s0, c0);
    const double k0 = -p2 * (g0 * s0 + a0 * c0);
    sine_cosine(alpha - (x + 0.5 * h * v + 0.125 * h * h * k0), s1, c1);
    const double k1 = -p2 * (g1 * s1 + a1 * c1);
    sine_cosine(alpha - (x + h * v + 0.5 * h * h * k1), s2, c2);
    const double k2 = -p2 * (g2 * s2 + a2 * c2);
    const double v1 = v + h / 6 * (k0 + 4 * k1 + k2), vm = 0.5 * (v + v1) + 0.125 * h * (k0 - k2);
    work += h / 6 * p2 * (-v * (a0 * c0 + (g0 - 1) * s0) - 4 * vm * (a1 * c1 + (g1 - 1) * s1)
                          - v1 * (a2 * c2 + (g2 - 1) * s2));
    x += h * v + h * h / 6 * (k0 + 2 * k1);
    v = v1;
}

static inline double between(double y0, double y1, double y2, double r) {
    return y0 + r * (4 * y1 - 3 * y0 - y2) + 2 * r * r * (y0 - 2 * y1 + y2);
}

static void resolve(Block& b, int l, double a0, double a1, double a2) {
    double x = b.x_old[l], v = b.v_old[l], work = b.work_old[l], share = 0;
    const double h = b.step[l], at0 = b.alpha[l];
    for (int guard = 0; guard < 100000; ++guard) {
        if (b.moving[l] == 0) {
            double best = 2, best_side = 0;
            for (double side : {1.0, -1.0}) {
                const double f[3] = {-side * a0 * b.cos_a[l] - b.sin_a[l], -side * a1 * b.cos_a[l] - b.sin_a[l],
                                     -side * a2 * b.cos_a[l] - b.sin_a[l]};
                for (int half = 0; half < 2; ++half) {
                    const double start = 0.5 * half, begin = std::max(share, start);
                    if (start + 0.5 <= share) continue;
                    const double left = f[half], right = f[half + 1], here = left + (right - left) * (begin - start) * 2;
                    double at = 2;
                    if (here > 0) at = begin;
                    else if (right > 0) at = std::max(begin, start + 0.5 * left / (left - right));
                    if (at < best) { best = at; best_side = side; }
                }
            }
            if (best_side == 0 || best >= 1) break;
            share = best;
            b.side[l] = best_side;
            b.moving[l] = 1;
        }
        const double whole = 1 - share, side = b.side[l];
        double low = 0, high = whole, part = whole, x1 = x, v1 = v, w1 = 0;
        for (int k = 0; k < 80; ++k) {
            x1 = x; v1 = v; w1 = 0;
            nystrom(x1, v1, w1, side * between(a0, a1, a2, share), side * between(a0, a1, a2, share + part / 2),
                    side * between(a0, a1, a2, share + part), 1, 1, 1, part * h, at0, b.p2[l]);
            if (k == 0 && x1 >= 0) break;
            (x1 < 0 ? high : low) = part;
            double next = v1 < 0 ? part - x1 / (v1 * h) : 0.5 * (low + high);
            if (!(low < next && next < high)) next = 0.5 * (low + high);
            if (std::abs(next - part) <= 1e-12 * whole || high - low <= 1e-12 * whole) break;
            part = next;
        }
        work += w1; x = x1; v = v1; share += part;
        if (part == whole && x >= 0) break;
        x = 0; v = -E * std::min(v, 0.0); b.side[l] = -side;
        if (v <= 1e-5 * std::sqrt(b.p2[l]) * at0) { v = 0; b.moving[l] = 0; }
        if (share >= 1) break;
    }
    b.x[l] = x; b.v[l] = v; b.work[l] = work;
}

int main(int argc, char** argv) {
    const int groups = std::max(1, (argc > 1 ? atoi(argv[1]) : 64) / LANES), steps = argc > 2 ? atoi(argv[2]) : 2500;
    const int repeats = argc > 3 ? atoi(argv[3]) : 5;
    const int samples = static_cast<int>(steps * STEP / DT) + 1;
    std::vector<double> sine(samples), table(2 * steps + 2 * CHUNK + 2, 0.0);
    for (int i = 0; i < samples; ++i) sine[i] = std::sin(2 * PI * i * DT);
    for (int r = 0; r <= 2 * steps; ++r) {  // the motion at half steps
        const double position = r * (STEP / 2 / DT);
        const int i = std::min(static_cast<int>(position), samples - 2);
        table[r] = sine[i] + (sine[i + 1] - sine[i]) * (position - i);
    }
    double best = 1e300, checksum = 0;
    for (int repeat = 0; repeat < repeats; ++repeat) {
        checksum = 0;
        const auto begin = std::chrono::steady_clock::now();
        for (int group = 0; group < groups; ++group) {
            static Block b;
            for (int l = 0; l < LANES; ++l) {
                b.x[l] = b.v[l] = b.moving[l] = b.work[l] = b.work_max[l] = b.peak[l] = 0;
                b.side[l] = 1; b.alpha[l] = ALPHA; b.p2[l] = P2; b.step[l] = STEP; b.left[l] = steps;
                b.sin_a[l] = std::sin(ALPHA); b.cos_a[l] = std::cos(ALPHA); b.event[l] = PI / 2;
                b.factor[l] = 0.17 + 0.13 * l / (LANES - 1);
            }
            std::fill(std::begin(b.g), std::end(b.g), 1.0);
            for (int done = 0; done < steps; done += CHUNK) {
                for (int r = 0; r <= 2 * CHUNK; ++r)
                    for (int l = 0; l < LANES; ++l) b.a[r * LANES + l] = b.factor[l] * table[2 * done + r];
                for (int j = 0; j < CHUNK; ++j) {
                    const double *a0 = b.a + 2 * j * LANES, *a1 = a0 + LANES, *a2 = a1 + LANES;
                    const double *g0 = b.g + 2 * j * LANES, *g1 = g0 + LANES, *g2 = g1 + LANES;
                    long events = 0;
#pragma omp simd reduction(+ : events)
                    for (int l = 0; l < LANES; ++l) {
                        const bool active = j < b.left[l];
                        const double h = active ? b.step[l] * b.moving[l] : 0;
                        double x = b.x[l], v = b.v[l], work = b.work[l];
                        b.x_old[l] = x; b.v_old[l] = v; b.work_old[l] = work;
                        nystrom(x, v, work, b.side[l] * a0[l], b.side[l] * a1[l], b.side[l] * a2[l], g0[l], g1[l],
                                g2[l], h, b.alpha[l], b.p2[l]);
                        b.x[l] = x; b.v[l] = v; b.work[l] = work;
                        b.work_max[l] = std::max(b.work_max[l], work);
                        b.peak[l] = std::max(b.peak[l], x);
                        const bool lifted = b.moving[l] == 0 && std::abs(a2[l]) * b.cos_a[l] > g2[l] * b.sin_a[l];
                        events += active && (x < 0 || x > b.event[l] || lifted) ? 1 : 0;
                    }
                    if (!events) continue;
                    for (int l = 0; l < LANES; ++l) {
                        if (j >= b.left[l]) continue;
                        const bool lifted = b.moving[l] == 0 && std::abs(a2[l]) * b.cos_a[l] > g2[l] * b.sin_a[l];
                        if (b.x[l] < 0 || lifted) {
                            resolve(b, l, a0[l], a1[l], a2[l]);
                            b.peak[l] = std::max(b.peak[l], b.x[l]);
                        }
                        if (b.x[l] > b.event[l] && b.v[l] > 0) b.left[l] = 0;
                    }
                }
                for (int l = 0; l < LANES; ++l) b.left[l] -= CHUNK;
            }
            for (int l = 0; l < LANES; ++l) checksum += b.peak[l];
        }
        const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
        best = std::min(best, wall.count());
    }
    std::printf("%.4f %.9f\n", best / (double(groups) * LANES * steps) * 1e9, checksum);
}
