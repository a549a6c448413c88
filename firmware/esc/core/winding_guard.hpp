// The winding current from the shunt, once per PWM period, and the highest duty that it allows: the fast
// half of the current limit, beside the bound on voltage (speed_controller.hpp). Derivation, stability and
// where the limits come from: docs/winding_guard.md.
//
//   Units    converter counts of the shunt (31.66 mA), of voltages (6.177 mV), PWM counts of 3600
//   Sense    one pole of 1 kHz, sampled at a pulse's end: s1 = s0 e^-x + i (1 - e^-dx), x = 0.314
//   Law      above the limit the voltage droops by 0.4 V per ampere; one sample far above cuts the next
//            pulse short
//   Trip     cuts in quick succession, a bus current over its limit, or a droop that lasts
//   Error    reads some 10 % below the windings' mean: commutation gives current back to the bus
#pragma once
#include <cstdint>

#include "firmware/esc/core/sensing.hpp"

namespace fw::esc {

class WindingGuard {
 public:
  static constexpr std::uint32_t kPeriod = 3600;
  static constexpr std::uint32_t kShortest = 120;  // leaves room for a sample
  static constexpr int counts(float ampere) {
    return static_cast<int>(ampere / kAmperes_per_count);
  }

  static constexpr float kLimit_share = 1.06f;   // above what the model's bound alone allows
  static constexpr float kCut_share = 1.45f;     // of the limit: one sample
  static constexpr float kLasting_share = 1.2f;  // for longer than any step takes:
  static constexpr std::uint16_t kLasting_ms = 250;
  static constexpr float kBus_A = 24.0f;

  // gain: true current over the shunt's, as calibrated.
  void configure(float max_current_A, float gain) {
    limit_ = counts(kLimit_share * max_current_A / gain);
    cut_at_ = counts(kCut_share * max_current_A / gain);
    lasting_at_ = counts(kLasting_share * max_current_A / gain);
  }
  void restart() {
    shunt_ = current_ = 0;
    cut_ = tripped_ = false;
    cuts_ = bus_over_ = 0;
    lasting_ms_ = 0;
  }

  // Once per period. shunt: counts above zero; duty: PWM counts in force in this period.
  void update(int shunt, std::uint32_t duty) {
    const int before = shunt_;
    shunt_ = shunt;
    note_bus(shunt);
    cut_ = false;
    if (duty < kLeast_told) [[unlikely]] {  // too short a pulse: noise only
      current_ -= current_ / 4;
      return;
    }
    const auto share =
        static_cast<int>((duty * (374'604u - 15u * duty)) >> 16);  // 65536 (1 - e^-dx)
    const int raw = (256 * shunt - 187 * before) * 256 / share;
    current_ += (raw - current_) / 2;
    if (raw > cut_at_) [[unlikely]] {
      cut_ = true;
      cuts_ = static_cast<std::uint8_t>(cuts_ + 4);
      tripped_ |= cuts_ >= kCutsToTrip;
    } else if (cuts_ > 0) [[unlikely]] {
      --cuts_;
    }
  }

  // Once per millisecond: whether the current lasts.
  void tick() {
    const int next = current_ > lasting_at_ ? lasting_ms_ + 1 : lasting_ms_ - 4;
    lasting_ms_ = static_cast<std::uint16_t>(next > 0 ? next : 0);
    tripped_ |= lasting_ms_ >= kLasting_ms;
  }

  // braked: the rotor slows down although it is driven; 40 % of the limit will do.
  std::uint32_t allowed(std::uint32_t wanted, int bus_counts, bool braked = false) const {
    if (cut_) [[unlikely]]
      return kShortest;
    const int over = current_ - (braked ? 2 * limit_ / 5 : limit_);
    if (over <= 0 || bus_counts <= 0) [[likely]]
      return wanted;
    const auto less = static_cast<std::uint32_t>(kDroop * over / bus_counts);
    const std::uint32_t rest = wanted > less ? wanted - less : 0u;
    return rest > kShortest ? rest : kShortest;
  }

  bool tripped() const { return tripped_; }
  float current_A() const { return static_cast<float>(current_) * kAmperes_per_count; }

 private:
  static constexpr std::uint32_t kLeast_told = 180;
  static constexpr std::uint8_t kCutsToTrip = 12;  // three, close together
  // 0.4 ohm in counts of shunt, bus and PWM.
  static constexpr int kDroop =
      static_cast<int>(0.4f * kAmperes_per_count / kVolts_per_count * 3600);

  void note_bus(int shunt) {
    if (shunt <= counts(kBus_A)) [[likely]] {
      bus_over_ = 0;
      return;
    }
    ++bus_over_;
    tripped_ |= bus_over_ >= 3;
  }

  int limit_ = counts(21.2f), cut_at_ = counts(29.0f), lasting_at_ = counts(24.0f);
  int shunt_ = 0, current_ = 0;
  bool cut_ = false, tripped_ = false;
  std::uint8_t cuts_ = 0, bus_over_ = 0;
  std::uint16_t lasting_ms_ = 0;
};

}  // namespace fw::esc
