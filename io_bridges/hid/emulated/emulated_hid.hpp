// A HID device that is played: what its chip does with reports, whatever carries them (memory_hid_port.hpp in a
// process, uhid_device.hpp under a kernel).
//
//   Reports  as in HidPort: with their number first, 0 where the device numbers none
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>

#include "io_bridges/hid/hid_port.hpp"

namespace whirl::io {

struct HidIdentity {
  std::uint16_t vendor = 0, product = 0;
  std::string name;
  std::string serial;
  HidReport descriptor;
  bool numbered = false;  // its reports have numbers
};

class EmulatedHid {
 public:
  virtual ~EmulatedHid() = default;
  virtual const HidIdentity& identity() const = 0;
  virtual void output(std::span<const std::uint8_t> report) = 0;
  virtual std::optional<HidReport> feature(
      std::uint8_t number) = 0;  // nothing: there is none of this number
  virtual bool set_feature(std::span<const std::uint8_t> report) = 0;

  bool has_input() const { return !input_.empty(); }
  // Pre: has_input(). Without a number where the device numbers none.
  HidReport take_input() {
    HidReport report = std::move(input_.front());
    input_.pop_front();
    return report;
  }

 protected:
  void send(HidReport report) { input_.push_back(std::move(report)); }

 private:
  std::deque<HidReport> input_;
};

}  // namespace whirl::io
