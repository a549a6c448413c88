#include "plant/sensors/gps.hpp"

#include <algorithm>

namespace whirl::plant {
namespace {

constexpr double kRound_s = 1e-9;  // the caller's clock is a sum of steps

}  // namespace

Gps::Gps(const GpsParams& params, std::uint64_t seed, const std::string& name)
    : params_(params), chance_(seed, name + ".dropout") {
  for (int i = 0; i < 3; ++i) {
    const std::string axis = name + "." + "ned"[i];
    const double wander = i == 2 ? params.wander_down_m : params.wander_level_m;
    wander_.emplace_back(wander, params.wander_time_s, seed, axis + ".wander");
    white_.emplace_back(seed, axis + ".white");
    velocity_.emplace_back(seed, axis + ".velocity");
  }
}

GpsFix Gps::measure(double t_s, const Truth& truth, double error_scale) {
  const double dt_s = t_s - measured_s_;
  measured_s_ = t_s;
  GpsFix fix{.taken_s = t_s, .p_WB_W_m = truth.p_WB_W_m, .v_WB_W_mps = truth.v_WB_W_mps};
  for (int i = 0; i < 3; ++i) {
    const bool down = i == 2;
    const double white_m = down ? params_.white_down_m : params_.white_level_m;
    const double velocity_mps = down ? params_.velocity_down_mps : params_.velocity_level_mps;
    fix.p_WB_W_m[i] += error_scale * (wander_[i].step(dt_s) + white_m * white_[i].normal());
    fix.v_WB_W_mps[i] += error_scale * velocity_mps * velocity_[i].normal();
  }
  fix.level_accuracy_m = error_scale * params_.wander_level_m;
  fix.down_accuracy_m = error_scale * params_.wander_down_m;
  fix.velocity_accuracy_mps = error_scale * params_.velocity_level_mps;
  return fix;
}

std::optional<GpsFix> Gps::step(double t_s, const Truth& truth) {
  if (t_s + kRound_s >= static_cast<double>(taken_) * params_.period_s) {
    ++taken_;
    const GpsFix fix = measure(t_s, truth);  // drawn even if lost: an outage shifts no noise
    const bool unlucky = chance_.uniform() < params_.dropout_chance;
    const bool out = std::any_of(outages_.begin(), outages_.end(),
                                 [&](const Outage& o) { return o.covers(t_s); });
    if (!unlucky && !out) on_the_way_.push_back(fix);
  }
  if (on_the_way_.empty() || t_s + kRound_s < on_the_way_.front().taken_s + params_.latency_s) {
    return std::nullopt;
  }
  const GpsFix fix = on_the_way_.front();
  on_the_way_.pop_front();
  return fix;
}

}  // namespace whirl::plant
