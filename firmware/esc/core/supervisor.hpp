// Whether the motor may turn: arming, silence, latched faults. One for every source of set-points.
//
//   Rules   ESC protocol: 25 valid zeros in a row, at least 15.7 V at rest and no fault arm; then the
//           first v > 0 starts; 0.5 s without a valid set-point stops and disarms; 25 valid zeros
//           clear a latched fault
//   Call    on_setpoint() for each valid one, tick() once per millisecond
#pragma once
#include <cstdint>

namespace fw::esc {

enum class Latched : std::uint8_t { none, over_current, under_voltage, desync, stalled };

struct SupervisorLimits {
  float arming_voltage_V = 15.7f;
  std::uint16_t zeros_to_arm = 25;
  std::uint16_t silence_ms = 500;
};

class Supervisor {
 public:
  explicit Supervisor(const SupervisorLimits& limits) : limits_(limits) {}

  void limit(const SupervisorLimits& limits) { limits_ = limits; }

  // A valid set-point came in, from any source. at_rest: the motor does not turn.
  void on_setpoint(std::uint16_t v, float bus_voltage_V, bool at_rest) {
    silence_ms_ = 0;
    if (v != 0) {
      zeros_ = 0;
      v_ = armed_ ? v : std::uint16_t{0};
      return;
    }
    v_ = 0;
    if (zeros_ < limits_.zeros_to_arm) ++zeros_;
    if (zeros_ < limits_.zeros_to_arm || !at_rest) return;
    latched_ = Latched::none;
    low_voltage_ = !(bus_voltage_V >= limits_.arming_voltage_V);
    if (!low_voltage_) armed_ = true;
  }

  void tick() {
    if (!watched_ || silence_ms_ >= limits_.silence_ms) return;
    if (++silence_ms_ >= limits_.silence_ms) disarm();
  }

  void latch(Latched fault) {
    if (latched_ == Latched::none) latched_ = fault;
    disarm();
  }
  // The serial line's keep-alive may be turned off on a stand.
  void watch(bool on) { watched_ = on; }

  bool armed() const { return armed_; }
  bool refused_for_voltage() const { return low_voltage_; }
  Latched latched() const { return latched_; }
  std::uint16_t setpoint() const { return armed_ ? v_ : std::uint16_t{0}; }

 private:
  void disarm() {
    armed_ = false;
    v_ = 0;
    zeros_ = 0;
  }

  SupervisorLimits limits_;
  std::uint16_t v_ = 0;
  std::uint16_t zeros_ = 0;
  std::uint16_t silence_ms_ = 0;
  Latched latched_ = Latched::none;
  bool armed_ = false;
  bool low_voltage_ = false;
  bool watched_ = true;
};

}  // namespace fw::esc
