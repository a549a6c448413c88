#include "harness/stand/current_bound.hpp"

#include <optional>

namespace whirl::stand {
namespace {

constexpr double kShort_step_s = 1e-4;
constexpr double kPatience_s = 2.0;
constexpr double kFastest_radps = 3000.0;

plant::RotorConditions turning(double speed_radps, const RiseAsked& asked) {
  plant::RotorConditions conditions = asked.still;
  conditions.omega_radps = speed_radps;
  conditions.v_AP_P_mps = {0.0, 0.0, -asked.wind_mps};
  return conditions;
}

// Where the rotor steadily gives that thrust.
double speed_of(const plant::Rotor& rotor, double thrust_N, const RiseAsked& asked) {
  double low = 20.0, high = kFastest_radps;
  for (int i = 0; i < 18; ++i) {
    const double middle = 0.5 * (low + high);
    const bool less = rotor.steady(turning(middle, asked)).thrust_N < thrust_N;
    (less ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Result<double> shortest_rise_s(const plant::MotorParams& motor,
                               const std::shared_ptr<const plant::Blade>& blade,
                               const RiseAsked& asked) {
  const auto refused = [](const char* what, const char* cure) {
    return Error{ErrorKind::bad_input, "to", what, cure};
  };
  if (!(asked.from_N > 0.0 && asked.to_N > asked.from_N)) {
    return refused("is no rise", "from a thrust above 0 N to a higher one");
  }
  plant::Rotor rotor(blade, +1);
  double w = speed_of(rotor, asked.from_N, asked);
  for (int i = 0; i < 1000; ++i) rotor.step(turning(w, asked), 1e-3);  // its inflow is there
  const double torque_Nm = motor.torque_constant_NmpA * (asked.current_A - motor.no_load_current_A);
  const auto level_N = [&](double share) {
    return asked.from_N + share * (asked.to_N - asked.from_N);
  };
  std::optional<double> tenth_s;
  double before_N = asked.from_N;
  for (double t_s = 0.0; t_s < kPatience_s && w < kFastest_radps && w > 0.0; t_s += kShort_step_s) {
    const plant::RotorLoads loads = rotor.step(turning(w, asked), kShort_step_s);
    const auto reached_s = [&](double wanted_N) {  // between the last two steps
      return t_s - kShort_step_s * (loads.thrust_N - wanted_N) / (loads.thrust_N - before_N);
    };
    if (!tenth_s && loads.thrust_N >= level_N(0.1)) tenth_s = reached_s(level_N(0.1));
    if (loads.thrust_N >= level_N(0.9)) return reached_s(level_N(0.9)) - *tenth_s;
    before_N = loads.thrust_N;
    w += kShort_step_s / motor.inertia_kgm2 * (torque_Nm - loads.shaft_torque_Nm);
  }
  return refused("is not reached with that current", "a higher current, or less thrust");
}

}  // namespace whirl::stand
