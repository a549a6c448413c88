#include "plant/air/air.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/angles.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;

double smooth(double x) {
  return 0.5 * (1.0 - std::cos(kPi * std::clamp(x, 0.0, 1.0)));
}

}  // namespace

double window(const GustWindow& gust, double t_s) {
  const double since = t_s - gust.start_s, left = gust.duration_s - since;
  if (since < 0.0 || left < 0.0) return 0.0;
  const double edge = std::min(gust.edge_s, 0.5 * gust.duration_s);
  return edge > 0.0 ? smooth(std::min(since, left) / edge) : 1.0;
}

double profile(const Jet& jet, double north_m, double east_m) {
  const double r = std::hypot(north_m - jet.north_m, east_m - jet.east_m);
  if (jet.edge_m <= 0.0) return r <= jet.radius_m ? 1.0 : 0.0;
  return smooth((jet.radius_m - r) / jet.edge_m + 0.5);
}

Air::Air(const AirParams& params, std::uint64_t seed)
    : params_(params), dryden_(params.dryden, seed) {}

Vector3d Air::mean_wind(double height_m) const {
  const double top = params_.shear_height_m, rough = params_.roughness_length_m;
  if (top <= 0.0 || height_m >= top) return params_.steady_wind_W_mps;
  if (height_m <= rough) return Vector3d::Zero();
  return params_.steady_wind_W_mps * (std::log(height_m / rough) / std::log(top / rough));
}

void Air::step(const Vector3d& p_W_m, const Vector3d& v_W_mps, double dt_s) {
  t_s_ += dt_s;
  if (params_.dryden.wind_at_6m_mps <= 0.0) return;
  centre_W_m_ = p_W_m;
  const Vector3d against = v_W_mps - mean_wind(-p_W_m.z());  // of the vehicle through the mean air
  const double level = std::hypot(against.x(), against.y());
  const Vector3d along =
      level > 1e-6 ? Vector3d(against.x() / level, against.y() / level, 0.0) : Vector3d::UnitX();
  const Vector3d across(-along.y(), along.x(), 0.0);
  const Gust gust = dryden_.step(against.norm(), -p_W_m.z(), dt_s);
  auto in_W = [&](const Vector3d& g) -> Vector3d {
    return along * g.x() + across * g.y() + Vector3d::UnitZ() * g.z();
  };
  turbulence_W_mps_ = in_W(gust.velocity_mps);
  turning_W_radps_ = in_W(gust.rate_radps);
}

Vector3d Air::wind_W_mps(const Vector3d& p_W_m) const {
  Vector3d wind = mean_wind(-p_W_m.z());
  for (const GustWindow& gust : params_.gusts) wind += window(gust, t_s_) * gust.wind_W_mps;
  for (const Jet& jet : params_.jets) {
    wind.z() -= profile(jet, p_W_m.x(), p_W_m.y()) * jet.upward_mps;
  }
  if (params_.dryden.wind_at_6m_mps > 0.0) {
    wind += turbulence_W_mps_ + turning_W_radps_.cross(p_W_m - centre_W_m_);
  }
  return wind;
}

Atmosphere Air::at(const Vector3d& p_W_m) const {
  const double warmer_K = params_.ground_temperature_offset_K;
  if (!params_.temperature_gradient_Kpm)
    return standard_atmosphere(params_.ground_height_m - p_W_m.z(), warmer_K);
  const Atmosphere ground = standard_atmosphere(params_.ground_height_m, warmer_K);
  return layered_atmosphere(ground, *params_.temperature_gradient_Kpm, -p_W_m.z());
}

}  // namespace whirl::plant
