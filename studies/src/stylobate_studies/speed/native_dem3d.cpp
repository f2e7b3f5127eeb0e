// Native reference of the distinct element step in space: the same rim law, rotation and layout, with explicit vectors.
// Usage: native_dem3d STEPS DT  → "ns_per_joint_step top_displacement", for the paper's column of 12 round drums under a
// constant base acceleration of (2, 1, 0) m/s², undamped.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#ifdef __AVX512F__
#include <immintrin.h>
#endif

namespace {

constexpr int WIDTH = 8;             // doubles in one vector
constexpr int VECTORS = 2;           // vectors in a block: 16 lanes
constexpr int LANES = WIDTH * VECTORS;
constexpr int DRUMS = 12;
constexpr int CHUNK = 32;
constexpr double PI = 3.141592653589793, TINY = 1e-18, CENTRED = 1e-9, NOTHING = 1e-30;

typedef double V __attribute__((vector_size(WIDTH * 8)));
typedef long long Mask __attribute__((vector_size(WIDTH * 8)));

inline V pick(Mask m, V a, V b) { return m ? a : b; }
inline V larger(V a, V b) { return a > b ? a : b; }
inline V smaller(V a, V b) { return a < b ? a : b; }
inline V all(double x) { return V{} + x; }
inline V size(V a) { return larger(a, -a); }
inline V root(V a) {
#ifdef __AVX512F__
    return (V)_mm512_sqrt_pd((__m512d)a);
#else
    V r;
    for (int i = 0; i < WIDTH; ++i) r[i] = __builtin_sqrt(a[i]);
    return r;
#endif
}

struct V3 { V x, y, z; };
inline V3 operator+(V3 a, V3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline V3 operator-(V3 a, V3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline V3 operator*(V a, V3 b) { return {a * b.x, a * b.y, a * b.z}; }
inline V dot(V3 a, V3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline V3 cross(V3 a, V3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline V3 pick(Mask m, V3 a, V3 b) { return {pick(m, a.x, b.x), pick(m, a.y, b.y), pick(m, a.z, b.z)}; }

struct Drum { V3 p[VECTORS], v[VECTORS], i[VECTORS], j[VECTORS], k[VECTORS], l[VECTORS], w[VECTORS], f[VECTORS], n[VECTORS];
              V m[VECTORS], im[VECTORS], ia[VECTORS], ic[VECTORS], ht[VECTORS], rb[VECTORS], rt[VECTORS]; };
struct Joint { V kn[VECTORS], ks[VECTORS], co[VECTORS], mu[VECTORS], t[VECTORS], kf[VECTORS], kt[VECTORS], en[VECTORS];
               V3 s[VECTORS], f[VECTORS], up[VECTORS], lo[VECTORS]; };
struct Lane { V dt[VECTORS], pivot[VECTORS], free[VECTORS], work[VECTORS], shear[VECTORS]; V3 g[VECTORS], p[VECTORS]; };

Drum drum[DRUMS + 1];
Joint joint[DRUMS + 1];
Lane lane;
V3 ground[CHUNK + 1][VECTORS];

inline V over_root(V x) {
    static const double c[] = {1.5707963267948457, -0.21460183657961013, 0.08904862081826843, -0.050792762643682245,
        0.03368046433967888, -0.024366397045309886, 0.018621724287455857, -0.01466134286289636, 0.011493823555180352,
        -0.008503457350174305, 0.005523167239593235, -0.002896219765138688, 0.0011120542916517799,
        -0.00027199399719354117, 3.139129045303818e-05};
    V p = all(c[14]);
#pragma GCC unroll 14
    for (int k = 13; k >= 0; --k) p = p * x + c[k];
    return p;
}

struct Angle { V a, c, s; };
inline Angle angle_of(V versine) {
    const V u = smaller(larger(versine, V{}), all(2.0)), low = smaller(u, 2.0 - u), r = root(low);
    const V a = r * over_root(1.0 - low);
    return {pick(u <= 1.0, a, PI - a), 1.0 - u, r * root(2.0 - low)};
}
inline V angle_to(V c, V s) {
    const V low = s * s / (1.0 + size(c)), a = root(low) * over_root(1.0 - low);
    return pick(c >= 0.0, a, PI - a);
}

struct Pressed { V l, n, c, s; };
inline Pressed press(V d, V g, V gamma, V cg, V sg, Angle psi) {
    const Angle phi = angle_of((g + d) / larger(g, all(TINY)));
    const V start = gamma - psi.a, end = gamma + psi.a;
    const Mask first = start > -phi.a, last = end < phi.a;
    const V p = pick(first, start, -phi.a), cp = pick(first, cg * psi.c + sg * psi.s, phi.c);
    const V sp = pick(first, sg * psi.c - cg * psi.s, -phi.s);
    const V ce = cg * psi.c - sg * psi.s, se = sg * psi.c + cg * psi.s;
    const V q = pick(last, end, phi.a), cq = pick(last, ce, phi.c), sq = pick(last, se, phi.s);
    const V one = pick(q > p, all(1.0), V{});
    const V again = end - 2.0 * PI, two = pick(again > -phi.a, all(1.0), V{});
    const Mask within = again < phi.a;
    const V r = pick(within, again, phi.a), cr = pick(within, ce, phi.c), sr = pick(within, se, phi.s);
    const V length = one * (q - p) + two * (r + phi.a), sines = one * (sq - sp) + two * (sr + phi.s);
    const V cosines = one * (cp - cq) + two * (phi.c - cr);
    const V twice = one * (sq * cq - sp * cp) + two * (sr * cr + phi.s * phi.c);
    const V squares = one * (sq * sq - sp * sp) + two * (sr * sr - phi.s * phi.s);
    const V n = larger(d * length + g * sines, V{});
    const V c = d * sines + 0.5 * g * (length + twice), s = d * cosines + 0.5 * g * squares;
    return {length, n, smaller(larger(c, -n), n), smaller(larger(s, -n), n)};
}

struct Shares { V force, moment; };
inline V beyond(V x, V y) {
    const V both = x + y;
    return root(larger(both + 0.57 * x * y / larger(both, all(NOTHING)), all(1.0)));
}
inline Shares toward(V x, V y, V one, V two, V a, V b, V excess) {
    const V u = x * one * one, v = y * two * two, square = (u + v) * (u + v);
    const V p = a * (square + 0.57 * v * v), q = b * (square + 0.57 * u * u);
    const V mean = larger(p * x + q * y, all(NOTHING)), more = excess * (x + y);
    const V r = mean + more * p, s = mean + more * q, each = mean / (r * s);
    return {each * s, each * r};
}
inline Shares returned(V shear2, V torsion2, V force, V moment, V kf, V kt) {
    const V each = 1.0 / larger(force * force, all(1e-12)), other = 1.0 / larger(moment * moment, all(1e-12));
    const V x = shear2 * each, y = torsion2 * other, a = kf * each, b = kt * other, excess = beyond(x, y) - 1.0;
    Shares w = toward(x, y, all(1.0), all(1.0), a, b, excess);
    w = toward(x, y, w.force, w.moment, a, b, excess);
    const V less = 1.0 / beyond(x * w.force * w.force, y * w.moment * w.moment);
    return {w.force * less, w.moment * less};
}

void forces() {
    for (int q = 0; q < DRUMS; ++q) {
        Drum &u = drum[q + 1], &v = drum[q];
        Joint &e = joint[q];
        for (int b = 0; b < VECTORS; ++b) {
            const V dt = lane.dt[b];
            const V3 z = v.k[b];
            V3 n = u.n[b].x * u.i[b] + u.n[b].y * u.j[b] + u.n[b].z * u.k[b];
            const V3 r = u.f[b].x * u.i[b] + u.f[b].y * u.j[b] + u.f[b].z * u.k[b];
            const V3 c = u.p[b] + r - v.p[b] - v.ht[b] * z;
            const V cosine = dot(n, z);
            V3 h = n - cosine * z;
            const V sine = root(dot(h, h));
            h = pick(sine < 1e-15, v.i[b], (1.0 / larger(sine, all(1e-15))) * h);
            const V3 t = cross(z, h), d = cosine * h - sine * z;
            const V3 vel = u.v[b] + cross(u.w[b], r) - v.v[b] - cross(v.w[b], c + v.ht[b] * z);
            const V3 om = u.w[b] - v.w[b];
            const V along = dot(c, h), across = dot(c, t), gap = larger(root(along * along + across * across), all(CENTRED));
            const V side = pick(across < 0.0, all(-1.0), all(1.0)), each = 1.0 / gap;
            const Mask near = gap <= CENTRED;
            const V cg = pick(near, all(1.0), along * each), sg = pick(near, V{}, side * across * each);
            const V ru = u.rb[b], rl = v.rt[b], ra = ru * cosine, twice = 2.0 * gap;
            const Angle pu_ = angle_of((rl - gap + ra) * (rl + gap - ra) / (twice * ra));
            const Angle pl_ = angle_of((ra - rl + gap) * (ra + rl - gap) / (twice * rl));
            const V area = ra * ra * (pu_.a - pu_.c * pu_.s) + rl * rl * (pl_.a - pl_.c * pl_.s);
            const V rho = area / larger(2.0 * (ra * pu_.a + rl * pl_.a), all(NOTHING));
            const V kn = e.kn[b] * rho, ku = kn * ru, kl = kn * rl;
            const V gamma = angle_to(cg, sg), du = -dot(c, z), dl = -dot(c, n);
            Pressed a = press(du, ru * sine, PI - gamma, -cg, sg, pu_), w = press(dl, rl * sine, gamma, cg, sg, pl_);
            e.en[b] = 0.5 * (ku * (du * a.n + ru * sine * a.c) + kl * (dl * w.n + rl * sine * w.c));
            const V pu = ku * a.n, cu = ku * ru * a.c, su = -side * ku * ru * a.s;
            const V pl = kl * w.n, cl = kl * rl * w.c, sl = side * kl * rl * w.s;
            const V3 mu = pu * c + cu * d + su * t, ml = cl * h + sl * t;
            V3 f = pu * z + pl * n, m = cross(mu, z) + cross(ml, n);
            const V press_ = pu + pl, one = 1.0 / larger(press_, all(NOTHING));
            const V3 p = one * (mu + ml);
            const V eu = 1.0 / larger(pu, all(NOTHING)), el = 1.0 / larger(pl, all(NOTHING));
            const V3 gg = eu * mu - el * ml;
            const V spread = larger((pu * ru * ru - (cu * cu + su * su) * eu + pl * rl * rl - (cl * cl + sl * sl) * el +
                                     pu * pl * one * dot(gg, gg)) * one, V{});
            n = f + all(NOTHING) * z;
            n = (1.0 / root(dot(n, n))) * n;
            V3 slip = vel + cross(om, p - c);
            slip = slip - dot(slip, n) * n;
            const V spin = dot(om, n), closed = ra * a.l + rl * w.l;
            const V kf = e.ks[b] * rho * closed, kt = 0.5 * kf * spread * lane.pivot[b];
            const V3 s = e.s[b].x * v.i[b] + e.s[b].y * v.j[b] + e.s[b].z * v.k[b];
            const V old = e.t[b], keep = smaller(kf / larger(e.kf[b], all(NOTHING)), all(1.0));
            V3 sq = keep * (s - dot(s, n) * n) - kf * dt * slip;
            V tw = smaller(kt / larger(e.kt[b], all(NOTHING)), all(1.0)) * old - kt * dt * spin;
            const V limit = e.mu[b] * press_ + e.co[b] * rho * closed, arm = limit * root(spread) * (2.0 / 3.0) * lane.pivot[b];
            const Shares left = returned(dot(sq, sq), tw * tw, limit, arm, kf, kt);
            sq = left.force * sq;
            tw = left.moment * tw;
            lane.shear[b] -= 0.5 * dt * (dot(s + sq, slip) + (old + tw) * spin);
            e.s[b] = {dot(sq, v.i[b]), dot(sq, v.j[b]), dot(sq, v.k[b])};
            e.t[b] = tw;
            e.kf[b] = kf;
            e.kt[b] = kt;
            f = f + sq;
            m = m + cross(p, sq) + tw * n;
            e.f[b] = f;
            e.up[b] = m - cross(c - r, f);
            e.lo[b] = cross(-v.ht[b] * z, f) - m;
        }
    }
}

inline V3 turned(V3 a, V3 u) {
    const V square = dot(u, u), first = 1.0 - square * (1.0 / 6 - square * (1.0 / 120));
    const V second = 0.5 - square * (1.0 / 24 - square * (1.0 / 720));
    const V3 p = cross(u, a);
    return a + first * p + second * cross(u, p);
}

void move(int step) {
    for (int b = 0; b < VECTORS; ++b) lane.p[b] = {V{}, V{}, V{}};
    for (int q = 0; q < DRUMS; ++q) {
        Drum &u = drum[q + 1];
        const Joint &e = joint[q], &a = joint[q + 1];
        for (int b = 0; b < VECTORS; ++b) {
            const V dt = lane.dt[b], free = lane.free[b];
            V3 v = u.v[b] + dt * (u.im[b] * (e.f[b] - a.f[b]) - ground[step][b] - lane.g[b]);
            V3 l = u.l[b] + dt * (e.up[b] + a.lo[b]);
            v.y *= free, l.x *= free, l.z *= free;
            u.v[b] = v;
            u.l[b] = l;
            u.p[b] = u.p[b] + dt * v;
            lane.p[b] = lane.p[b] + u.m[b] * v;
            const V spin = u.ic[b] * dot(l, u.k[b]), angle = spin * dt, square = angle * angle;
            const V c = 1.0 - square * (0.5 - square * (1.0 / 24));
            const V s = angle * (1.0 - square * (1.0 / 6 - square * (1.0 / 120)));
            const V3 w = u.ia[b] * l, turn = dt * w;
            u.i[b] = turned(c * u.i[b] + s * u.j[b], turn);
            u.k[b] = turned(u.k[b], turn);
            u.j[b] = cross(u.k[b], u.i[b]);
            u.w[b] = w + spin * u.k[b];
        }
    }
    for (int b = 0; b < VECTORS; ++b)
        lane.work[b] -= 0.5 * dot(ground[step][b] + ground[step + 1][b], lane.p[b]) * lane.dt[b];
}

void setup(double dt) {
    const double h = 5.0 / DRUMS, k_n = 5e10, k_s = 2.5e10;
    double mass[DRUMS + 1] = {0};
    const V o = V{}, l = all(1.0);
    for (int i = 0; i <= DRUMS; ++i) {
        const double R = 0.48 - 0.15 * (i - 1) / DRUMS, r = 0.48 - 0.15 * i / DRUMS;
        const double m = 1600.0 * PI * h * (R * R + R * r + r * r) / 3, zc = h * (R * R + 2 * R * r + 3 * r * r) / (4 * (R * R + R * r + r * r));
        double axial = 0, across = 0;
        const double node[3] = {-std::sqrt(0.6), 0, std::sqrt(0.6)}, weight[3] = {5. / 9, 8. / 9, 5. / 9};
        for (int k = 0; k < 3; ++k) {
            const double z = 0.5 * h * (1 + node[k]), s = R + (r - R) * z / h, part = 1600.0 * 0.5 * h * weight[k];
            axial += part * PI * s * s * s * s / 2;
            across += part * (PI * s * s * s * s / 4 + PI * s * s * (z - zc) * (z - zc));
        }
        Drum &u = drum[i];
        for (int b = 0; b < VECTORS; ++b) {
            u.i[b] = {l, o, o}, u.j[b] = {o, l, o}, u.k[b] = {o, o, l}, u.n[b] = {o, o, l};
            if (i == 0) { u.rt[b] = all(1e3); continue; }
            u.m[b] = all(m), u.im[b] = all(1 / m), u.ia[b] = all(1 / across), u.ic[b] = all(1 / axial - 1 / across);
            u.f[b] = {o, o, all(-zc)}, u.ht[b] = all(h - zc), u.rb[b] = all(R), u.rt[b] = all(r);
            u.p[b] = {o, o, all(h * (i - 1) + zc)};
            joint[i - 1].kn[b] = all(k_n), joint[i - 1].ks[b] = all(k_s), joint[i - 1].mu[b] = all(0.7);
        }
        mass[i] = i ? m : 0;
    }
    double closure = 0.0;
    for (int i = 1; i <= DRUMS; ++i) {
        double weight = 0.0;
        for (int k = i; k <= DRUMS; ++k) weight += 9.81 * mass[k];
        const double R = 0.48 - 0.15 * (i - 1) / DRUMS;
        closure += weight / (k_n * PI * R * R);
        for (int b = 0; b < VECTORS; ++b) drum[i].p[b].z -= closure, drum[i].v[b] = {l * dt, l * dt * 0.5, o};
    }
    for (int b = 0; b < VECTORS; ++b) {
        lane.dt[b] = all(dt), lane.g[b] = {o, o, all(9.81)}, lane.pivot[b] = l, lane.free[b] = l;
        for (int s = 0; s <= CHUNK; ++s) ground[s][b] = {all(2.0), l, o};
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
    std::printf("%.6g %.17g\n", ns / (double(steps) * DRUMS * LANES), drum[DRUMS].p[0].x[0]);
}
