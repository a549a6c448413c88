#include "plant/rotor/vortex_ring.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::plant {
namespace {

constexpr double kBegins = 0.3, kStrongest = 1.3, kOver = 2.0;
constexpr double kSigma = 0.15, kMemory_radii = 5.0;

double smooth(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

double vortex_ring_strength(const Descent& d) {
  if (!(d.hover_mps > 0.1)) return 0.0;
  const double x = d.down_mps / d.hover_mps;
  if (!(x > kBegins && x < kOver)) return 0.0;
  const double along = x < kStrongest ? smooth((x - kBegins) / (kStrongest - kBegins))
                                      : smooth((kOver - x) / (kOver - kStrongest));
  return along * smooth(1.0 - d.in_plane_mps / d.hover_mps);
}

double VortexRing::step(const Descent& d, double radius_m, double dt_s) {
  const double strength = vortex_ring_strength(d);
  const bool was_inside = inside_;
  inside_ = strength > 0.0;
  if (!inside_) return 0.0;
  const double draw = random_.normal();
  const double keeps =
      was_inside ? std::exp(-dt_s * d.hover_mps / (kMemory_radii * radius_m)) : 0.0;
  state_ = keeps * state_ + std::sqrt(1.0 - keeps * keeps) * draw;
  return kSigma * strength * d.hover_mps * state_;
}

}  // namespace whirl::plant
