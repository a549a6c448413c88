// Averaged motors on the vehicle's own bus: duties in, and in each sub-step the bus voltage and all
// currents agree (power_bus.hpp).
//
//   Valid    steps up to 5 ms, cut into sub-steps of at most 125 us
//   Error    the books close to the 10 nV to which the bus agrees (tests/vehicle_energy_test.cpp)
#pragma once
#include "plant/battery/battery.hpp"
#include "plant/motor/averaged_motor.hpp"
#include "plant/powertrain.hpp"

namespace whirl::plant {

class AveragedPowertrain final : public Powertrain {
 public:
  AveragedPowertrain(const std::vector<MotorParams>& motors, const BatteryParams& battery,
                     double avionics_current_A);

  std::size_t count() const override { return motors_.size(); }
  double source_V() const override { return battery_.source_V(); }
  double speed_radps(std::size_t motor) const override { return motors_.at(motor).speed_radps(); }
  void set_speed(std::size_t motor, double speed_radps) override {
    motors_.at(motor).set_speed(speed_radps);
  }
  void block(std::size_t motor) override { motors_.at(motor).block(); }
  void command(std::size_t motor, const MotorCommand& command) override;
  void set_loads(std::span<const ShaftLoad> loads) override;
  void set_dip(double below_V) override { battery_.set_dip(below_V); }
  void step(double dt_s, PowertrainState& state) override;

 private:
  Battery battery_;
  double avionics_current_A_;
  // One of each for each motor:
  std::vector<AveragedMotor> motors_;
  std::vector<double> shorts_A_;  // as commanded
  std::vector<Drive> drives_;     // kept: the last bus voltage is the next first guess
  std::vector<ShaftLoad> loads_;
  std::vector<MotorBooks> books_, total_;  // of a sub-step and of all
};

}  // namespace whirl::plant
