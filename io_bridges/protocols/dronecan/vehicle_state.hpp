// The battery's state, and whether the vehicle may turn its motors.
#pragma once
#include "io_bridges/protocols/dronecan/data_type.hpp"
#include "io_bridges/protocols/dronecan/fields.hpp"

namespace whirl::io::dronecan {

struct BatteryInfo {
  static constexpr DataType kType{Kind::message, 1092, 0x249C26548A711966, 54, "power.BatteryInfo"};
  static constexpr std::uint8_t kUnknown_pct = 127;
  float temperature_K = 0, voltage_V = 0, current_A = 0, mean_power_10s_W = 0;
  float remaining_Wh = 0, full_Wh = 0, hours_to_full = 0;
  std::uint16_t status_flags = 0;
  std::uint8_t health_pct = kUnknown_pct, charge_pct = 0, charge_deviation_pct = 0;
  std::uint8_t battery_id = 0;
  std::uint32_t model_instance = 0;
  Bounded<char, 31> model_name{};

  template <typename F>
  void layout(F& f) {
    for (float* value : {&temperature_K, &voltage_V, &current_A, &mean_power_10s_W, &remaining_Wh,
                         &full_Wh, &hours_to_full}) {
      f.f16(*value);
    }
    f.u(status_flags, 11);
    f.u(health_pct, 7);
    f.u(charge_pct, 7);
    f.u(charge_deviation_pct, 7);
    f.u(battery_id, 8);
    f.u(model_instance, 32);
    f.tail(model_name, 8, [&](char& letter) { f.u_cut(letter, 8); });
  }
};

struct ArmingStatus {
  static constexpr DataType kType{Kind::message, 1100, 0x8700F375556A8003, 1,
                                  "safety.ArmingStatus"};
  static constexpr std::uint8_t kDisarmed = 0, kArmed = 255;
  std::uint8_t status = kDisarmed;

  template <typename F>
  void layout(F& f) {
    f.u(status, 8);
  }
};

}  // namespace whirl::io::dronecan
