// A motor controller that no vehicle has: a set-point is a share of 1000 rad/s, and duty goes by the
// error of the speed. One file, and one line of a table (toy_controller_test.cpp).
#include "harness/flight/tests/toy_controller.hpp"

#include <algorithm>

#include "base/rpm.hpp"

namespace whirl::flight {
namespace {

class ToyController final : public MotorController {
 public:
  void write(std::uint16_t setpoint) override { wanted_radps_ = setpoint / 2047.0 * 1000.0; }

  plant::MotorCommand step(std::int64_t, const plant::MotorState& motor, double) override {
    speed_radps_ = motor.speed_radps;
    duty_ = std::clamp(0.01 * (wanted_radps_ - speed_radps_), 0.0, 1.0);
    if (cut_) duty_ = 0.0;
    return {duty_, plant::Freewheel::diode};
  }
  void cut() override { cut_ = true; }

  io::EscState status() const override { return {0.0, rpm_of(speed_radps_), 0, {}}; }
  bool armed() const override { return !cut_; }
  std::vector<NamedValue> signals() const override {
    return {{{"toy_duty", Dimension::ratio, ""}, [this] { return duty_; }}};
  }

 private:
  double wanted_radps_ = 0.0, speed_radps_ = 0.0, duty_ = 0.0;
  bool cut_ = false;
};

}  // namespace

ControllerType toy_controller_type() {
  return {"toy", plant::Freewheel::diode,
          [](const FlightParams&, std::uint64_t, int) -> std::unique_ptr<MotorController> {
            return std::make_unique<ToyController>();
          }};
}

}  // namespace whirl::flight
