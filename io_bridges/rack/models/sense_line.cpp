#include "io_bridges/rack/models/sense_line.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::rack {
namespace {

constexpr double kDiode_V = 0.3;

}  // namespace

SenseLine::SenseLine(const Params& params)
    : params_(params), noise_(params.seed, params.name + ".noise") {}

void SenseLine::advance_to(io::Nanoseconds now) {
  if (now <= time_ns_) return;
  const double dt_s = static_cast<double>(now - time_ns_) * 1e-9;
  time_ns_ = now;
  const double blend =
      params_.time_constant_s > 0.0 ? -std::expm1(-dt_s / params_.time_constant_s) : 1.0;
  capacitor_V_ += blend * (level_V_ - capacitor_V_);
}

void SenseLine::set_V(double level_V, io::Nanoseconds now) {
  advance_to(now);
  level_V_ = level_V;
  if (!settled_) capacitor_V_ = level_V;
  settled_ = true;
}

double SenseLine::sample_V(io::Nanoseconds now) {
  advance_to(now);
  const double pin_V = capacitor_V_ + params_.noise_V * noise_.normal();
  return std::clamp(pin_V, -kDiode_V, params_.supply_V + kDiode_V);
}

double drawn_resistance_ohm(double nominal_ohm, double tolerance, std::uint64_t seed,
                            const std::string& name) {
  RandomStream random(seed, name);
  return nominal_ohm * (1.0 + tolerance * (2.0 * random.uniform() - 1.0));
}

}  // namespace whirl::rack
