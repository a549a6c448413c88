#include "plant/sensors/barometer.hpp"

#include <cmath>

namespace whirl::plant {

Barometer::Barometer(const BarometerParams& params, std::uint64_t seed, const std::string& name)
    : params_(params),
      noise_(params.noise_density_Pa, seed, name + ".white"),
      drift_(params.drift_Pa, params.drift_time_s, seed, name + ".drift"),
      bias_Pa_(draw_normal(params.turn_on_bias_Pa, seed, name + ".turn_on")) {}

double Barometer::sample_Pa(double dt_s, const Truth& truth) {
  double thrust = 0.0;
  for (double each : truth.thrust_N) thrust += each;
  const double dynamic_Pa = 0.5 * truth.air_density_kgpm3 * truth.v_AB_B_mps.squaredNorm();
  const double felt_Pa = truth.static_pressure_Pa +
                         params_.rotor_share * thrust / params_.disc_area_m2 +
                         params_.wind_share * dynamic_Pa;
  if (!started_) lagged_Pa_ = felt_Pa;
  started_ = true;
  lagged_Pa_ += (felt_Pa - lagged_Pa_) * -std::expm1(-dt_s / params_.lag_s);
  return lagged_Pa_ + bias_Pa_ + drift_.step(dt_s) + noise_.sample(dt_s);
}

}  // namespace whirl::plant
