#include "io_bridges/qemu/board/inertial_sensor.hpp"

#include <algorithm>

namespace whirl::board {
namespace {

// Names a device's parameters and where they go.
struct Entry {
  const char* name;
  double plant::TriadParams::*field;
};
constexpr Entry kTriad[] = {
    {"noise_density", &plant::TriadParams::noise_density},
    {"bias_instability", &plant::TriadParams::bias_instability},
    {"turn_on_bias", &plant::TriadParams::turn_on_bias},
    {"scale_error", &plant::TriadParams::scale_error},
    {"vibration", &plant::TriadParams::vibration_per_radps2},
};

bool set_triad(plant::TriadParams& triad, const std::string& name, double value) {
  const auto entry = std::find_if(std::begin(kTriad), std::end(kTriad),
                                  [&](const Entry& e) { return name == e.name; });
  if (entry == std::end(kTriad)) return false;
  triad.*(entry->field) = value;
  return true;
}

bool set_vector(Eigen::Vector3d& vector, const std::string& index, double value) {
  if (index != "0" && index != "1" && index != "2") return false;
  vector[index[0] - '0'] = value;
  return true;
}

bool set_one(plant::ImuParams& params, const std::string& key, double value) {
  const std::size_t dot = key.find('.');
  const std::string group = key.substr(0, dot);
  const std::string name = dot == std::string::npos ? "" : key.substr(dot + 1);
  if (group == "accelerometer") return set_triad(params.accelerometer, name, value);
  if (group == "gyroscope") return set_triad(params.gyroscope, name, value);
  if (group == "place") return set_vector(params.p_BS_B_m, name, value);
  if (group == "misalignment") return set_vector(params.misalignment_rad, name, value);
  return false;
}

}  // namespace

Result<plant::ImuParams> imu_params(const std::map<std::string, double>& params,
                                    const std::string& place) {
  plant::ImuParams result = plant::mpu6000_physics();
  for (const auto& [key, value] : params) {
    if (!set_one(result, key, value)) {
      return Error{ErrorKind::bad_input, place, "unknown parameter '" + key + "'",
                   "accelerometer or gyroscope { noise_density, bias_instability, turn_on_bias, "
                   "scale_error, vibration }, place, misalignment"};
    }
  }
  const auto good = plant::validate(result, place);
  if (!good) return good.error();
  return result;
}

io::Mpu6000::Truth InertialSensor::feel(Nanoseconds now) {
  const double dt_s = static_cast<double>(now - motion_ns_) * 1e-9;
  plant::ImuMotion motion;
  for (int i = 0; i < 3; ++i) {
    motion.specific_force_B_mps2[i] = motion_.specific_force_B_mps2[i];
    motion.alpha_WB_B_radps2[i] = motion_.alpha_WB_B_radps2[i];
    motion.w_WB_B_radps[i] = motion_.w_WB_B_radps[i] + motion_.alpha_WB_B_radps2[i] * dt_s;
  }
  std::copy(std::begin(motion_.rotor_speed_radps), std::end(motion_.rotor_speed_radps),
            motion.rotor_speed_radps.begin());
  const plant::ImuSample felt = imu_.sample(static_cast<double>(now) * 1e-9, motion);
  const Eigen::Vector3d& f = felt.specific_force_S_mps2;
  const Eigen::Vector3d& w = felt.rate_S_radps;
  // Forward-right-down to the part's forward-left-up.
  return {{f.x(), -f.y(), -f.z()}, {w.x(), -w.y(), -w.z()}, motion_.air_temperature_K};
}

}  // namespace whirl::board
