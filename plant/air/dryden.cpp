#include "plant/air/dryden.hpp"

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"

namespace whirl::plant {
namespace {

constexpr double kFoot_m = 0.3048;

// Increase per step of `now`, through a lag of `share` of a step's time; exact for a ramp.
double slope(double now, double share, double& lag) {
  const double gain = -std::expm1(-share), gap = now - lag;
  lag += gain * gap;
  return gain * gap;
}

}  // namespace

DrydenScales dryden_scales(double height_m, double wind_at_6m_mps) {
  const double h_ft = std::clamp(height_m / kFoot_m, 10.0, 1000.0);
  const double base = 0.177 + 0.000823 * h_ft;
  DrydenScales s;
  s.length_w_m = h_ft * kFoot_m;
  s.length_uv_m = h_ft / std::pow(base, 1.2) * kFoot_m;
  s.sigma_w_mps = 0.1 * wind_at_6m_mps;
  s.sigma_uv_mps = s.sigma_w_mps / std::pow(base, 0.4);
  return s;
}

Dryden::Dryden(const DrydenParams& params, std::uint64_t seed) : params_(params) {
  for (const char* name : {"air.dryden.u", "air.dryden.v", "air.dryden.w", "air.dryden.p"}) {
    noise_.emplace_back(seed, name);
  }
}

// x1' = a (n - x1), x2' = a (x1 - x2) with noise of density 1/a: exact transition and covariance.
void Dryden::Pole::step(double a, double dt_s, RandomStream& noise) {
  const double x = a * dt_s, fade = std::exp(-x), fade2 = fade * fade;
  const double q11 = 0.5 * (1.0 - fade2);
  const double q12 = 0.25 * (1.0 - fade2 * (1.0 + 2.0 * x));
  const double q22 = 0.125 * (2.0 - fade2 * (4.0 * x * x + 4.0 * x + 2.0));
  const double l11 = std::sqrt(q11), l21 = q12 / l11;
  const double l22 = std::sqrt(std::max(0.0, q22 - l21 * l21));
  const double n1 = noise.normal(), n2 = noise.normal();
  second = fade * (second + x * first) + l21 * n1 + l22 * n2;
  first = fade * first + l11 * n1;
}

Gust Dryden::step(double airspeed_mps, double height_m, double dt_s) {
  const DrydenScales s = dryden_scales(height_m, params_.wind_at_6m_mps);
  const double V = std::max(1.0, airspeed_mps), span = params_.wingspan_m;
  const double root3 = std::sqrt(3.0);
  Gust gust;
  // u has one pole: its output is the first stage, scaled to variance sigma^2 (stationary 1/2).
  velocity_[0].step(V / s.length_uv_m, dt_s, noise_[0]);
  gust.velocity_mps[0] = s.sigma_uv_mps * std::sqrt(2.0) * velocity_[0].first;
  velocity_[1].step(V / s.length_uv_m, dt_s, noise_[1]);
  gust.velocity_mps[1] =
      s.sigma_uv_mps * (root3 * velocity_[1].first + (1.0 - root3) * velocity_[1].second);
  velocity_[2].step(V / s.length_w_m, dt_s, noise_[2]);
  gust.velocity_mps[2] =
      s.sigma_w_mps * (root3 * velocity_[2].first + (1.0 - root3) * velocity_[2].second);

  const double corner = kPi * V / (4.0 * span), fade = std::exp(-corner * dt_s);
  const double corner_r = kPi * V / (3.0 * span);
  const double sigma_p = std::sqrt(0.8 * kPi / 2.0 * corner / V) * s.sigma_w_mps *
                         std::pow(kPi / (4.0 * span), 1.0 / 6.0) / std::cbrt(s.length_w_m);
  roll_ = fade * roll_ + sigma_p * std::sqrt(1.0 - fade * fade) * noise_[3].normal();
  // q and r are the slopes of w and v along the path, smoothed over the span.
  const double slope_w = slope(gust.velocity_mps[2], corner * dt_s, pitch_lag_) / (V * dt_s);
  const double slope_v = slope(gust.velocity_mps[1], corner_r * dt_s, yaw_lag_) / (V * dt_s);
  gust.rate_radps = {roll_, slope_w, -slope_v};
  return gust;
}

}  // namespace whirl::plant
