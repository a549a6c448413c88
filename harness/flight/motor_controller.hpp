// The controller of one motor: set-points in, each millisecond a command to the motor's bridge out.
//
//   Adding   NAME.cpp with its class and ControllerType NAME_type(), and a line of controllers.hpp
//   Behind   an I2C device (io_bridges/devices/esc_i2c.hpp), which judges bytes, address and CRC and
//            answers with status()
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "harness/world/signal_table.hpp"
#include "io_bridges/messages/messages.hpp"
#include "plant/powertrain.hpp"

namespace whirl::flight {

struct FlightParams;

class MotorController {
 public:
  struct NamedValue {  // a signal of its own; its name gets the motor's number: "esc_thrust_1"
    Signal signal;
    std::function<double()> value;
  };

  virtual ~MotorController() = default;

  virtual void write(std::uint16_t setpoint) = 0;  // 0..2047, a valid one
  // What the motor did in the millisecond that ends now; answers for the next one.
  virtual plant::MotorCommand step(std::int64_t now_ns, const plant::MotorState& motor,
                                   double bus_voltage_V) = 0;
  virtual void cut() = 0;  // a fault injected into it: it stops its motor and stays so

  virtual io::EscState status() const = 0;
  virtual bool armed() const = 0;
  virtual std::vector<NamedValue> signals() const { return {}; }  // valid as long as the controller
};

struct ControllerType {
  std::string name;  // in a vehicle's file: esc = { controller = "..." }
  // What carries the current between the pulses of a motor that it turns: who asks what a vehicle
  // draws without flying it (harness/sweep) takes it from here.
  plant::Freewheel freewheel;
  // For the motor of that number, 1 to plant::kMostMotors.
  std::unique_ptr<MotorController> (*make)(const FlightParams& params, std::uint64_t seed,
                                           int number);
};

using ControllerTypes = std::vector<ControllerType>;

}  // namespace whirl::flight
