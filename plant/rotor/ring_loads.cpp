// Speed: twelve azimuths in three vectors of four. The compiler's vector types keep one order of
// operations whatever the machine (wider registers, no contraction), so the bits do not depend on
// which clone of the function runs.
#include "plant/rotor/ring_loads.hpp"
#include "base/angles.hpp"

#include <algorithm>
#include <cmath>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define WHIRL_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define WHIRL_VECTOR_CLONES
#endif
#define WHIRL_INLINE inline __attribute__((always_inline))

namespace whirl::plant {
namespace {

constexpr int kLanes = 4;
constexpr int kGroups = kAzimuths / kLanes;
using Vec = double __attribute__((vector_size(sizeof(double) * kLanes)));
using Float4 = float __attribute__((vector_size(sizeof(float) * kLanes)));
using Int4 = int __attribute__((vector_size(sizeof(int) * kLanes)));

struct Azimuths {
  Vec c[kGroups];
  Vec s[kGroups];
  Azimuths() {
    for (int k = 0; k < kAzimuths; ++k) {
      const double theta = 2.0 * kPi * k / kAzimuths;
      c[k / kLanes][k % kLanes] = std::cos(theta);
      s[k / kLanes][k % kLanes] = std::sin(theta);
    }
  }
};
const Azimuths kAz;

WHIRL_INLINE void square_root(Vec& x) {
  for (int i = 0; i < kLanes; ++i) x[i] = std::sqrt(x[i]);
}

WHIRL_INLINE double sum(const Vec& x) {
  return (x[0] + x[1]) + (x[2] + x[3]);
}

// The same of four, in the same order.
WHIRL_INLINE void sum_four(const Vec& a, const Vec& b, const Vec& c, const Vec& d, Vec& out) {
  const Vec ab =
      __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Vec cd =
      __builtin_shufflevector(c, d, 0, 4, 2, 6) + __builtin_shufflevector(c, d, 1, 5, 3, 7);
  out = __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}

// atan2(y, x) to 2e-9 rad, without branches: arctangent of the smaller over the larger by a
// polynomial (Chebyshev interpolation over 0..1, odd, ten terms), then unfolded by octants.
WHIRL_INLINE void angle_of(const Vec& y, const Vec& x, Vec& out) {
  const Vec zero = Vec{};
  const Vec ay = y < zero ? -y : y;
  const Vec ax = x < zero ? -x : x;
  const Vec big = ax > ay ? ax : ay;
  const Vec small = ax > ay ? ay : ax;
  const Vec t = small / (big + 1e-300);
  const Vec z = t * t;
  // Estrin's order: pairs first, so that the terms do not wait for one another.
  const Vec z2 = z * z;
  const Vec z4 = z2 * z2;
  const Vec low = (9.999999971605e-01 - z * 3.333327629198e-01) +
                  (1.999807528117e-01 - z * 1.426001608302e-01) * z2;
  const Vec middle = (1.093234150224e-01 - z * 8.349724970809e-02) +
                     (5.708955597024e-02 - z * 3.035186482312e-02) * z2;
  const Vec high = 1.048764927387e-02 - z * 1.701170068078e-03;
  const Vec p = low + (middle + high * z4) * z4;
  Vec a = p * t;
  a = ay > ax ? 0.5 * kPi - a : a;
  a = x < zero ? kPi - a : a;
  out = y < zero ? -a : a;
}

struct Coefficients {
  Vec cl;
  Vec cd;
};

// Two neighbouring cells of one level, wherever they lie: cl, cd, cl, cd.
WHIRL_INLINE void pair_at(const SectionTable::Cell* cell, Vec& out) {
  Float4 pair;
  __builtin_memcpy(&pair, cell, sizeof pair);
  out = __builtin_convertvector(pair, Vec);
}

// Float in the table, double from here on: a balance is sought to 1e-11.
WHIRL_INLINE void look_up_four(const SectionTable& table, const ReynoldsSlot& slot,
                               const Vec& alpha, Coefficients& out) {
  const Vec at = alpha * (360.0 / kPi) + 360.0;
  Int4 cell = __builtin_convertvector(at, Int4);
  const Int4 last = Int4{} + (kAngles - 2);
  cell = cell > last ? last : cell;
  cell = cell < Int4{} ? Int4{} : cell;
  const Vec w = at - __builtin_convertvector(cell, Vec);
  const auto* level = table.cells.data() + static_cast<std::ptrdiff_t>(slot.level) * kAngles;
  Vec c[kLanes];  // mixed over Reynolds number; one lane's two cells each
  for (int i = 0; i < kLanes; ++i) {
    const auto* here = level + cell[i];
    Vec lo, hi;
    pair_at(here, lo);
    pair_at(here + kAngles, hi);
    c[i] = lo + slot.weight * (hi - lo);
  }
  // Turned over, so that a vector holds one quantity of four lanes.
  const Vec here01 = __builtin_shufflevector(c[0], c[1], 0, 4, 1, 5);
  const Vec here23 = __builtin_shufflevector(c[2], c[3], 0, 4, 1, 5);
  const Vec next01 = __builtin_shufflevector(c[0], c[1], 2, 6, 3, 7);
  const Vec next23 = __builtin_shufflevector(c[2], c[3], 2, 6, 3, 7);
  const Vec cl0 = __builtin_shufflevector(here01, here23, 0, 1, 4, 5);
  const Vec cd0 = __builtin_shufflevector(here01, here23, 2, 3, 6, 7);
  const Vec cl1 = __builtin_shufflevector(next01, next23, 0, 1, 4, 5);
  const Vec cd1 = __builtin_shufflevector(next01, next23, 2, 3, 6, 7);
  out.cl = cl0 + w * (cl1 - cl0);
  out.cd = cd0 + w * (cd1 - cd0);
}

struct Winds {
  Vec tangential[kGroups];
  Vec axial[kGroups];
  Vec flap[kGroups];
  double mean_speed_mps = 0.0;
};

WHIRL_INLINE void find_winds(const Ring& ring, const DiscFlow& f, double u, double v, Winds& w) {
  const double r = ring.r_m;
  const double tilt = r / f.tip_radius_m;
  const double spin_speed = f.omega_radps * r - v;
  const double through = f.climb_mps + f.ground_factor * u;
  const double flap_speed = f.spin * f.omega_radps * r;
  // Everything that goes with cos and sin of the azimuth, gathered.
  const double axial_c = tilt * f.tilt_inflow_mps.c + r * f.q_radps - flap_speed * f.flap_rad.s;
  const double axial_s = tilt * f.tilt_inflow_mps.s - r * f.p_radps + flap_speed * f.flap_rad.c;
  Vec speed2 = Vec{};
  for (int g = 0; g < kGroups; ++g) {
    const Vec& c = kAz.c[g];
    const Vec& s = kAz.s[g];
    w.flap[g] = f.flap_rad.mean + f.flap_rad.c * c + f.flap_rad.s * s;
    w.tangential[g] = spin_speed + f.spin * (f.vx_mps * s - f.vy_mps * c);
    w.axial[g] = through + axial_c * c + axial_s * s - w.flap[g] * (f.vx_mps * c + f.vy_mps * s);
    speed2 += w.tangential[g] * w.tangential[g] + w.axial[g] * w.axial[g];
  }
  w.mean_speed_mps = std::sqrt(sum(speed2) / kAzimuths);
}

struct Sums {
  Vec up{}, up_c{}, up_s{}, back{}, back_c{}, back_s{}, tilt_c{}, tilt_s{};
  Vec stalled{};
};

WHIRL_INLINE void angle_of_attack(double blade_angle, const Winds& w, int g, Vec& alpha) {
  Vec phi;
  angle_of(w.axial[g], w.tangential[g], phi);
  alpha = blade_angle - phi;
  alpha = alpha > kPi ? alpha - 2.0 * kPi : alpha;
  alpha = alpha < -kPi ? alpha + 2.0 * kPi : alpha;
}

WHIRL_INLINE void add_forces(const Ring& ring, const Coefficients& k, const Vec& alpha,
                             const Winds& w, int g, Sums& sums) {
  const Vec& ut = w.tangential[g];
  const Vec& up = w.axial[g];
  Vec speed = ut * ut + up * up;
  square_root(speed);
  const Vec lift = speed * (k.cl * ut - k.cd * up);
  const Vec back = speed * (k.cl * up + k.cd * ut);
  const Vec tilted = w.flap[g] * lift;
  sums.up += lift;
  sums.up_c += lift * kAz.c[g];
  sums.up_s += lift * kAz.s[g];
  sums.back += back;
  sums.back_c += back * kAz.c[g];
  sums.back_s += back * kAz.s[g];
  sums.tilt_c += tilted * kAz.c[g];
  sums.tilt_s += tilted * kAz.s[g];
  const Vec zero = Vec{};
  const Vec size = alpha < zero ? -alpha : alpha;
  sums.stalled += size > ring.stall_alpha_rad ? zero + 1.0 : zero;
}

}  // namespace

WHIRL_VECTOR_CLONES
void ring_loads(const Ring& ring, const DiscFlow& f, double u, double v, RingLoads& out) {
  Winds w;
  find_winds(ring, f, u, v, w);
  const ReynoldsSlot slot =
      reynolds_slot(f.density_kgpm3 * w.mean_speed_mps * ring.chord_m / f.viscosity_Pas);
  const double angle = ring.angle_rad + ring.twist_share * f.tip_twist_rad;
  // One kind of work after the other: the groups' long chains of operations then run side by side.
  Vec alpha[kGroups];
  Coefficients coefficients[kGroups];
  for (int g = 0; g < kGroups; ++g) angle_of_attack(angle, w, g, alpha[g]);
  for (int g = 0; g < kGroups; ++g) look_up_four(ring.table, slot, alpha[g], coefficients[g]);
  Sums sums;
  for (int g = 0; g < kGroups; ++g) add_forces(ring, coefficients[g], alpha[g], w, g, sums);

  const double k = 0.5 * f.density_kgpm3 * ring.chord_m * ring.dr_m * f.blade_count / kAzimuths;
  Vec lift, back;
  sum_four(sums.up, sums.up_c, sums.up_s, sums.back, lift);
  sum_four(sums.back_s, sums.back_c, sums.tilt_c, sums.tilt_s, back);
  out.thrust_N = k * lift[0];
  out.drive_N = k * lift[3];
  out.fx_N = k * (-f.spin * back[0] - back[2]);
  out.fy_N = k * (f.spin * back[1] - back[3]);
  out.lift_N = {out.thrust_N, k * lift[1], k * lift[2]};
  out.stalled = sum(sums.stalled) / kAzimuths;
  out.sin_phi = (f.climb_mps + f.ground_factor * u) / std::max(w.mean_speed_mps, 1e-6);
  out.lift_slope_N_per_mps = k * kAzimuths * w.mean_speed_mps * 2.0 * kPi;
}

}  // namespace whirl::plant
