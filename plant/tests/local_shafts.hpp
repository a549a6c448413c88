// Who steps the shafts of a RemotePowertrain in tests: averaged motors, each by itself between two
// boundaries on the source that it is given, as a board's process would its power stage.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "plant/power_bus.hpp"
#include "plant/remote_powertrain.hpp"

namespace whirl::plant {

class LocalShafts {
 public:
  LocalShafts(std::size_t motors, const MotorParams& motor)
      : motors_(motors, AveragedMotor(motor)), drives_(motors) {}

  void set_speed(double speed_radps) {
    for (AveragedMotor& motor : motors_) motor.set_speed(speed_radps);
  }
  void set_duty(std::size_t i, double duty) { drives_.at(i).duty = std::clamp(duty, 0.0, 1.0); }

  // Through one step of the grain.
  void step(RemotePowertrain& powertrain, double dt_s) {
    for (std::size_t i = 0; i < motors_.size(); ++i) {
      powertrain.receive(i, run(i, powertrain.load(i), dt_s));
    }
  }

  // One shaft under a load of its own.
  RemoteShaftState run(std::size_t i, const RemoteShaftLoad& load, double dt_s) {
    RemoteShaftState state;
    Battery feed(lab_supply(std::max(0.1, load.source_V), load.source_ohm));
    MotorBooks books;
    double charge_C = 0.0;
    for (int k = 0; k < kSubSteps; ++k) {
      if (load.brake_Nm > 0.0 && motors_[i].speed_radps() < 5.0) motors_[i].block();
      const ShaftLoad shaft{load.torque_Nm_s2, load.brake_Nm};
      const BusDraw draw = step_bus({&motors_[i], 1}, {&drives_[i], 1}, {&shaft, 1}, 0.0, feed,
                                    dt_s / kSubSteps, {&books, 1});
      charge_C += draw.charge_C;
      state.source_J += draw.battery.chemical_J;
      state.feed_J += draw.battery.series_J;
      state.winding_peak_A = std::max(state.winding_peak_A, std::abs(motors_[i].current_A()));
      state.electrical_in_J += books.electrical_in_J;
      state.copper_J += books.copper_J;
      state.diode_J += books.diode_J;
      state.no_load_J += books.no_load_J;
      state.magnetic_J += books.magnetic_J;
      state.kinetic_J += books.kinetic_J;
      state.air_J += books.air_J;
    }
    state.speed_radps = motors_[i].speed_radps();
    state.source_current_A = charge_C / dt_s;
    return state;
  }

 private:
  static constexpr int kSubSteps = 8;

  std::vector<AveragedMotor> motors_;
  std::vector<Drive> drives_;
};

}  // namespace whirl::plant
