// How full the pack is, by its voltage at rest: what is measured, and what the current costs on the way.
//
//   Model   a first-order lag over what the pins say; V_rest = V + R I, I the sum of what the ESCs tell
//   Levels  of four lithium-polymer cells at rest: low 3.6 V each (some 15 % left), empty 3.45 V. By
//           parameters; below 2.5 V at the pins nothing is connected (facts of the PX4FMU v1's driver)
#pragma once
#include <cstdint>

namespace fw {

class BatteryWatch {
 public:
  // 100 times a second.
  void on_voltage(float voltage_V, float current_A, float resistance_ohm) {
    constexpr float kShare = 0.02f;  // 0.5 s
    const float rest_V = voltage_V + resistance_ohm * current_A;
    voltage_V_ = voltage_V_ > 0.0f ? voltage_V_ + kShare * (voltage_V - voltage_V_) : voltage_V;
    rest_V_ = rest_V_ > 0.0f ? rest_V_ + kShare * (rest_V - rest_V_) : rest_V;
  }
  bool connected() const { return voltage_V_ > kConnected_V; }
  float voltage_V() const { return voltage_V_; }
  float rest_V() const { return rest_V_; }

 private:
  static constexpr float kConnected_V = 2.5f;
  float voltage_V_ = 0.0f, rest_V_ = 0.0f;
};

}  // namespace fw
