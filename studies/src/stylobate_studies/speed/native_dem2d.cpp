// Native reference of the plane distinct element step: the same law and layout, written with explicit vectors.
// Usage: native_dem2d STEPS DT  → "ns_per_contact_step top_displacement", for the paper's column of 12 drums,
// two contact points a joint, under a constant base acceleration of 2 m/s², undamped.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace {

constexpr int WIDTH = 8;             // doubles in one vector
constexpr int VECTORS = 2;           // vectors in a block: 16 lanes
constexpr int LANES = WIDTH * VECTORS;
constexpr int DRUMS = 12;
constexpr int POINTS = 2;
constexpr int CHUNK = 16;

typedef double V __attribute__((vector_size(WIDTH * 8)));
typedef long long Mask __attribute__((vector_size(WIDTH * 8)));

inline V pick(Mask m, V a, V b) { return m ? a : b; }
inline V larger(V a, V b) { return a > b ? a : b; }
inline V smaller(V a, V b) { return a < b ? a : b; }
inline V all(double x) { return V{} + x; }

struct Drum { V x[VECTORS], z[VECTORS], th[VECTORS], c[VECTORS], s[VECTORS], vx[VECTORS], vz[VECTORS], w[VECTORS],
              m[VECTORS], im[VECTORS], ii[VECTORS], hb[VECTORS], ht[VECTORS], b[VECTORS], t[VECTORS]; };
struct Joint { V kn[VECTORS], ks[VECTORS], co[VECTORS], mu[VECTORS], fx[VECTORS], fz[VECTORS], up[VECTORS], lo[VECTORS],
               fs[POINTS][VECTORS]; };
struct Lane { V dt[VECTORS], g[VECTORS], work[VECTORS], shear[VECTORS], px[VECTORS], pz[VECTORS]; };
struct Ground { V ax[VECTORS], az[VECTORS]; };

Drum drum[DRUMS + 1];
Joint joint[DRUMS + 1];
Lane lane;
Ground ground[CHUNK + 1];

void forces() {
    for (int j = 0; j < DRUMS; ++j) {
        Drum &u = drum[j + 1], &v = drum[j];
        Joint &e = joint[j];
        for (int k = 0; k < VECTORS; ++k) {
            const V cl = v.c[k], sl = v.s[k], ht = v.ht[k], w = v.t[k], wu = u.w[k], wl = v.w[k], dt = lane.dt[k];
            const V dx = u.x[k] - v.x[k], dz = u.z[k] - v.z[k];
            const V ps = cl * dx + sl * dz, pq = cl * dz - sl * dx - ht;
            const V c = u.c[k] * cl + u.s[k] * sl, s = u.s[k] * cl - u.c[k] * sl;
            const V ms = ps + s * u.hb[k], mq = pq - c * u.hb[k];
            const V ls = ms - u.b[k] * c, lq = mq - u.b[k] * s, rs = ms + u.b[k] * c, rq = mq + u.b[k] * s;
            const V over = larger(smaller(rs, w) - larger(ls, -w), V{});
            const V dvx = u.vx[k] - v.vx[k], dvz = u.vz[k] - v.vz[k];
            const V vs = cl * dvx + sl * dvz, vq = cl * dvz - sl * dvx;
            const V kn = e.kn[k] * over * 0.5, ks = e.ks[k] * over * 0.5, co = e.co[k] * over * 0.5;
            V sa{}, sb{}, up{}, lo{}, shear{};
            for (int p = 0; p < POINTS; ++p) {
                const V side = p ? w : -w, cs = p ? rs : ls, cq = p ? rq : lq;
                const Mask inside = p ? cs < w : cs > -w;
                const V as = p ? smaller(rs, w) : larger(ls, -w);
                const V aq = pick(inside, cq, V{});
                const V gap = pick(inside, cq, c * cq - s * (cs - side));
                const V ns = pick(inside, V{}, -s), nq = pick(inside, all(1.0), c);
                const V rs_ = as - ps, rq_ = aq - pq, lq_ = aq + ht;
                const V us = vs - wu * rq_ + wl * lq_, uq = vq + wu * rs_ - wl * as;
                const V vt = us * nq - uq * ns;
                const V fn = larger(-kn * gap, V{});
                const V limit = e.mu[k] * fn + pick(fn > 0.0, co, V{});
                const V old = e.fs[p][k];
                const V fs = smaller(larger(old - ks * vt * dt, -limit), limit);
                e.fs[p][k] = fs;
                shear -= 0.5 * (old + fs) * vt * dt;
                const V fa = fn * ns + fs * nq, fb = fn * nq - fs * ns;
                sa += fa;
                sb += fb;
                up += rs_ * fb - rq_ * fa;
                lo += as * fb - lq_ * fa;
            }
            e.fx[k] = cl * sa - sl * sb;
            e.fz[k] = sl * sa + cl * sb;
            e.up[k] = up;
            e.lo[k] = lo;
            lane.shear[k] += shear;
        }
    }
}

void move(int step) {
    for (int k = 0; k < VECTORS; ++k) lane.px[k] = lane.pz[k] = V{};
    for (int j = 0; j < DRUMS; ++j) {
        Drum &u = drum[j + 1];
        const Joint &e = joint[j], &a = joint[j + 1];
        for (int k = 0; k < VECTORS; ++k) {
            const V dt = lane.dt[k];
            u.vx[k] += ((e.fx[k] - a.fx[k]) * u.im[k] - ground[step].ax[k]) * dt;
            u.vz[k] += ((e.fz[k] - a.fz[k]) * u.im[k] - ground[step].az[k] - lane.g[k]) * dt;
            u.w[k] += (e.up[k] - a.lo[k]) * u.ii[k] * dt;
            u.x[k] += u.vx[k] * dt;
            u.z[k] += u.vz[k] * dt;
            const V angle = u.w[k] * dt, even = 1.0 - 0.5 * angle * angle;
            u.th[k] += angle;
            const V c = u.c[k], s = u.s[k];
            u.c[k] = c * even - s * angle;
            u.s[k] = s * even + c * angle;
            lane.px[k] += u.m[k] * u.vx[k];
            lane.pz[k] += u.m[k] * u.vz[k];
        }
    }
    for (int k = 0; k < VECTORS; ++k)
        lane.work[k] -= 0.5 * ((ground[step].ax[k] + ground[step + 1].ax[k]) * lane.px[k] +
                               (ground[step].az[k] + ground[step + 1].az[k]) * lane.pz[k]) * lane.dt[k];
}

void setup(double dt) {
    const double h = 5.0 / DRUMS, k_n = 5e10, k_s = 2.5e10;
    double above[DRUMS + 1] = {0};
    for (int i = 1; i <= DRUMS; ++i) {
        const double b = 0.96 - 0.30 * (i - 1) / DRUMS, t = 0.96 - 0.30 * i / DRUMS;
        const double m = 1600.0 * h * (b + t) / 2, zc = h * (b + 2 * t) / (3 * (b + t));
        const double inertia =
            1600.0 * (h * h * h * (b * b + 4 * b * t + t * t) / (36 * (b + t)) + h * (b + t) * (b * b + t * t) / 48);
        Drum &u = drum[i];
        for (int k = 0; k < VECTORS; ++k) {
            u.m[k] = all(m), u.im[k] = all(1 / m), u.ii[k] = all(1 / inertia);
            u.hb[k] = all(zc), u.ht[k] = all(h - zc), u.b[k] = all(b / 2), u.t[k] = all(t / 2);
            u.z[k] = all(h * (i - 1) + zc), u.c[k] = all(1.0);
            joint[i - 1].kn[k] = all(k_n), joint[i - 1].ks[k] = all(k_s), joint[i - 1].mu[k] = all(0.7);
        }
        above[i] = m;
    }
    double closure = 0.0;
    for (int i = 1; i <= DRUMS; ++i) {
        double weight = 0.0;
        for (int k = i; k <= DRUMS; ++k) weight += 9.81 * above[k];
        closure += weight / (k_n * (0.96 - 0.30 * (i - 1) / DRUMS));
        for (int k = 0; k < VECTORS; ++k) drum[i].z[k] -= closure;
    }
    for (int k = 0; k < VECTORS; ++k) {
        lane.dt[k] = all(dt), lane.g[k] = all(9.81);
        drum[0].c[k] = all(1.0), drum[0].t[k] = all(1e6);
        for (int s = 0; s <= CHUNK; ++s) ground[s].ax[k] = all(2.0);
    }
}

}  // namespace

int main(int argc, char **argv) {
    const long steps = argc > 1 ? std::atol(argv[1]) : 4800;
    setup(argc > 2 ? std::atof(argv[2]) : 3e-5);
    const std::clock_t start = std::clock();
    for (long n = 0; n < steps; ++n) {
        forces();
        move(static_cast<int>(n % CHUNK));
    }
    const double ns = 1e9 * double(std::clock() - start) / CLOCKS_PER_SEC;
    std::printf("%.6g %.17g\n", ns / (double(steps) * DRUMS * POINTS * LANES), drum[DRUMS].x[0][0]);
}
