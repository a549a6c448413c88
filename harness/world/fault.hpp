// A fault as it was asked for: one struct from the plan to the wire, and the list that a world keeps of
// those that are its own.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "base/result.hpp"

namespace whirl {

namespace fault_at {

struct Anywhere {};  // the world's own (capture lost, supply dip), or every wire of the kind
struct Wire {
  std::string name;  // "i2c3"; empty: of any bus
  int bus = -1;      // I2C3: 3, SPI1: 1, USART2: 2; -1: any
  int address = -1;  // of I2C; -1: any
};
struct Device {
  std::string name;  // "imu", "esc2"
  int bus = -1;
  int address = -1;  // of I2C, or the device's number on its board
  int motor = 0;     // whose ESC it is; 0: none
};
struct Motor {
  int number = 1;
};
struct Function {
  std::string name;  // watched
  int number = 0;    // in the list of those
};

}  // namespace fault_at

using FaultPlace = std::variant<fault_at::Anywhere, fault_at::Wire, fault_at::Device,
                                fault_at::Motor, fault_at::Function>;

// The kind is a word ("i2c_nack", "capture_lost"; io_bridges/devices/faults.hpp).
struct FaultSpec {
  std::uint32_t number = 0;
  std::string kind;
  FaultPlace place;
  std::uint8_t board = 0;  // the place of the board in the list of nodes; the world's own: 0
  std::int32_t axis = 0;   // of what the device senses (BoardDevice::senses)
  std::int64_t start_ns = 0;
  std::int64_t end_ns = INT64_MAX;  // INT64_MAX: for ever
  double value = 0.0;               // SI; its meaning depends on the kind
};

std::string target_of(const FaultSpec& fault);  // for people: "esc2", "motor 3"; empty: anywhere
int motor_of(const FaultSpec& fault);           // the motor, or that of the device; 0: none

// Errors  bad_input: a place is named, and what fails is one for all (the supply, the cameras)
Result<Done> must_be_of_all(const FaultSpec& fault);

// The faults that a world applies, from when to when, and which of them have acted.
class TimedFaults {
 public:
  void add(const FaultSpec& fault) { entries_.push_back({fault}); }

  // All of that kind in force at t_ns; they have acted then.
  void apply(const std::string& kind, std::int64_t t_ns,
             const std::function<void(const FaultSpec&)>& act);
  bool any(const std::string& kind, std::int64_t t_ns);  // the first of them has acted then
  std::vector<std::uint32_t> acted() const;              // their numbers

 private:
  struct Entry {
    FaultSpec fault;
    bool acted = false;
    bool in_force(const std::string& kind, std::int64_t t_ns) const {
      return fault.kind == kind && t_ns >= fault.start_ns && t_ns < fault.end_ns;
    }
  };
  std::vector<Entry> entries_;
};

}  // namespace whirl
