#include "plant/sensors/current_shunt.hpp"

#include <cmath>

namespace whirl::plant {

CurrentShunt::CurrentShunt(const CurrentShuntParams& p, std::uint64_t seed, const std::string& name)
    : params_(p),
      wander_(p.wander_A, p.wander_time_s, seed, name + ".wander"),
      noise_(seed, name + ".noise"),
      gain_(1.0 + p.gain_error +
            draw_uniform(-p.gain_tolerance, p.gain_tolerance, seed, name + ".gain")),
      offset_A_(draw_uniform(p.offset_low_A, p.offset_high_A, seed, name + ".offset")),
      excess_A_(draw_normal(p.warm_up_A, seed, name + ".warm_up")) {}

void CurrentShunt::flow(double bus_A, double dt_s) {
  smooth_A_ += (bus_A - smooth_A_) * -std::expm1(-6.283185307179586 * params_.pole_Hz * dt_s);
  wander_.step(dt_s);
  t_s_ += dt_s;
}

double CurrentShunt::sample_A() {
  const double offset_A =
      offset_A_ + excess_A_ * std::exp(-t_s_ / params_.warm_up_time_s) + wander_.value();
  const double sigma_A = params_.noise_A + params_.noise_per_A * std::abs(smooth_A_);
  return gain_ * smooth_A_ + offset_A + sigma_A * noise_.normal();
}

}  // namespace whirl::plant
