// Whether a rotor that is asked to turn does: by its ESC's own word, 20 times a second. With one of four
// gone neither attitude nor place can be held.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "firmware/esc/core/protocol.hpp"
#include "firmware/esc/core/setpoint.hpp"

namespace fw {

class MotorWatch {
 public:
  void tick() {
    for (std::uint32_t& silent_ms : silent_ms_) ++silent_ms;
    for (unsigned i = 0; i < 4; ++i) failed_[i] = failed_[i] || silent(i);
    ++asked_ms_;
  }
  void on_answered(unsigned motor) { silent_ms_[motor] = 0; }
  void on_status(unsigned motor, const esc::protocol::Status& status) {
    status_[motor] = status;
    if ((status.flags & esc::flag_armed) == 0) failed_[motor] = true;
  }
  // Whether rotors are asked to turn, from the flight logic at each of its steps.
  void ask(bool turning) {
    if (!turning) asked_ms_ = 0;
  }

  const esc::protocol::Status& status(unsigned motor) const { return status_[motor]; }
  bool silent() const {  // one of them, for longer than it goes on by itself
    for (const std::uint32_t silent_ms : silent_ms_) {
      if (silent_ms > kSilent_ms) return true;
    }
    return false;
  }
  bool silent(unsigned motor) const { return silent_ms_[motor] > kSilent_ms; }
  // One stands or has disarmed though it was asked for long enough to start.
  bool out() const {
    constexpr std::uint8_t both = esc::flag_armed | esc::flag_turning;
    if (asked_ms_ < kStart_ms) return false;
    for (const esc::protocol::Status& status : status_) {
      if ((status.flags & both) != both) return true;
    }
    return false;
  }
  // One has tripped by its current, which it latches until it is asked to stand.
  bool over_current() const {
    return std::any_of(status_.begin(), status_.end(), [](const esc::protocol::Status& status) {
      return (status.flags & esc::flag_over_current) != 0;
    });
  }
  // One in this mode reads its thrust off a current whose zero still drifts, or that was never calibrated:
  // it flies by a static map, and each of the four by another.
  bool not_warm(esc::Mode mode) const {
    return goes_by_power(mode) &&
           std::any_of(status_.begin(), status_.end(), [](const esc::protocol::Status& status) {
             return (status.flags & esc::flag_uncalibrated) != 0;
           });
  }
  // How many have disarmed, fallen silent or stood when that was found, since they were last trusted anew.
  unsigned failed() const {
    return static_cast<unsigned>(std::count(failed_.begin(), failed_.end(), true));
  }
  void keep_failed() {
    constexpr std::uint8_t both = esc::flag_armed | esc::flag_turning;
    for (unsigned i = 0; i < 4; ++i) {
      failed_[i] = failed_[i] || (status_[i].flags & both) != both;
    }
  }
  void forget_failures() { failed_.fill(false); }
  bool all_turning() const {
    return std::all_of(status_.begin(), status_.end(), [](const esc::protocol::Status& status) {
      return (status.flags & esc::flag_turning) != 0;
    });
  }
  bool any_turning() const {
    for (const esc::protocol::Status& status : status_) {
      if ((status.flags & esc::flag_turning) != 0) return true;
    }
    return false;
  }

 private:
  static constexpr std::uint32_t kNever = 1'000'000;
  static constexpr std::uint32_t kSilent_ms = 500, kStart_ms = 1500;

  std::array<esc::protocol::Status, 4> status_{};
  std::array<std::uint32_t, 4> silent_ms_{kNever, kNever, kNever, kNever};
  std::uint32_t asked_ms_ = 0;
  std::array<bool, 4> failed_{};
};

}  // namespace fw
