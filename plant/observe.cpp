#include "plant/observe.hpp"

namespace whirl::plant {

Truth observe(const VehicleState& s) {
  Truth truth{.p_WB_W_m = s.p_WB_W_m, .v_WB_W_mps = s.v_WB_W_mps, .q_WB = s.q_WB};
  truth.v_AB_B_mps = s.q_WB.conjugate() * (s.v_WB_W_mps - s.wind_W_mps);
  truth.static_pressure_Pa = s.static_pressure_Pa;
  truth.air_density_kgpm3 = s.air_density_kgpm3;
  for (std::size_t i = 0; i < s.motors.size(); ++i) {
    truth.thrust_N[i] = s.motors[i].thrust_N;
    truth.bus_current_A[i] = s.motors[i].bus_current_A;
  }
  return truth;
}

ImuMotion imu_motion(const VehicleState& s) {
  ImuMotion motion{.specific_force_B_mps2 = s.specific_force_B_mps2,
                   .w_WB_B_radps = s.w_WB_B_radps,
                   .alpha_WB_B_radps2 = s.alpha_WB_B_radps2};
  for (std::size_t i = 0; i < s.motors.size(); ++i)
    motion.rotor_speed_radps[i] = s.motors[i].speed_radps;
  return motion;
}

}  // namespace whirl::plant
