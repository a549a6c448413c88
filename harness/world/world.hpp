// A world: all that surrounds the firmware in one run (vehicle and ground station, or a stand).
//
//   Time     step(t) moves the world to t with what the target did until the step's start; the first
//            call is step(0), which only fills `sensed`. Steps are 1 ms. No clock, no thread, no file.
//   Signals  truth by name, in SI, read after each step. Names are lower case without the unit
//            ("height", "tilt", "thrust_1"); logs append the unit of the dimension ("height_m").
//   Input    commands, disturbances (request.hpp) and faults; what it does not understand it refuses
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "base/units.hpp"
#include "harness/world/request.hpp"
#include "io_bridges/messages/messages.hpp"

namespace whirl {

struct Signal {
  std::string name;
  Dimension dimension = Dimension::none;
  std::string about;  // one line for people: "height above the floor, truth"
};

// One fault as a plan asked for it. The kind is a word ("i2c_nack", "capture_lost").
struct FaultSpec {
  std::uint32_t number = 0;
  std::string kind;
  std::string device;         // "imu", "esc2"; may be empty
  std::int32_t bus = -1;      // I2C3: 3, SPI1: 1, USART2: 2; -1: any
  std::int32_t address = -1;  // I2C address, or the device's number on its board; -1: any
  std::int32_t axis = 0;      // sensors: 0..2 accelerometer x y z, 3..5 gyro x y z
  std::int64_t start_ns = 0;
  std::int64_t end_ns = INT64_MAX;  // INT64_MAX: for ever
  double value = 0.0;               // SI; its meaning depends on the kind
};

class World {
 public:
  virtual ~World() = default;

  virtual const std::vector<Signal>& signals() const = 0;
  virtual void read(std::span<double> values) const = 0;  // in the order of signals()

  virtual void step(std::int64_t t_ns, const io::Batch& happened, io::Batch& sensed) = 0;

  // At now_ns. Errors  bad_input, the place being the key that it is about: not understood, or out of
  //                    the range of this world
  virtual Result<Done> command(const Command& command, std::int64_t now_ns) = 0;
  virtual Result<Done> disturb(const Disturbance& disturbance, std::int64_t now_ns) = 0;

  // Text lines for t:ask: one to the firmware, and all that came from it so far.
  // Errors  bad_input: no such line here; the question before is not answered yet, and its late answer
  //         could not be told from that to this one
  virtual Result<Done> say(const std::string& /*line*/) {
    return Error{ErrorKind::bad_input, "", "nobody listens to lines here", "t:ask is for stands"};
  }
  virtual const std::vector<std::string>& heard() const {
    static const std::vector<std::string> nothing;
    return nothing;
  }

  // When the last bit of the latest command had passed the wire; negative: not known (yet).
  virtual std::int64_t command_on_wire_ns() const { return -1; }

  // True: this kind is the world's to apply (capture lost, supply dip), and it will report its
  // number in applied_faults() once it has acted. False: it is the board's.
  virtual bool take_fault(const FaultSpec& fault) = 0;
  virtual std::vector<std::uint32_t> applied_faults() const = 0;

  virtual std::string status() const = 0;  // a few words for the progress line: "flying, 1.08 m"
};

}  // namespace whirl
