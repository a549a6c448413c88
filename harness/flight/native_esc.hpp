// A motor controller of flight plans: the firmware's own control core (firmware/esc/core, compiled
// for this machine), between what the ESC would sense of its motor and what its bridge does to it.
// Bytes, address and rejects are the I2C device's (io_bridges/devices/esc_i2c.hpp).
//
//   Loop     1 kHz, as the image's control tick: newest set-point in, one tick of the core, voltage
//            out until the next
//   Senses   bus voltage in counts of the ADC; the shunt with its offset, gain, wander and noise
//            (plant/sensors/current_shunt.hpp) in 20 samples, its zero taken while the motor stands;
//            speed from zero crossings (zero_crossings.hpp), smoothed as the image does
//   Bridge   duty in counts of the 20 kHz PWM; between pulses the current runs on through the diodes
//            (it never reverses)
//   Start    as the image's bridge driver: off, it looks for a turning rotor and joins it; one that
//            shows nothing for 15 ms is aligned. The averaged motor knows neither alignment nor a
//            rotor that is lost: it is held off for 161 ms instead and commutates rightly from there;
//            its seventh crossing ends the start. The 161 ms put the thrust in the middle of where the
//            image has it: 90 % of 2 N 288 to 318 ms after the set-point in 18 starts on its stand, as
//            the rotor came to rest (harness/tests/native_start_test.cpp holds it to the image)
//   Backward a rotor that the air turns against its sense shows its crossings in the wrong order, which the
//            image does not join but aligns for 200 ms more: here its windings are shorted meanwhile, which
//            brakes it as the alignment's field does in the mean, twice as hard
//   Left out a start that the image would lose against a rotor that turns; the 1.5 A that the bus carries while the rotor is aligned; loss of sync other than by
//            standing still; the image's guard of the winding current at the PWM's rate, which droops
//            beyond 22 A (the core's own bounds act); the amplifier's ripple and its removal
#pragma once
#include <cstdint>
#include <functional>
#include <optional>

#include "firmware/esc/core/core.hpp"
#include "firmware/esc/core/sensing.hpp"
#include "harness/flight/motor_controller.hpp"
#include "harness/flight/zero_crossings.hpp"
#include "plant/sensors/current_shunt.hpp"

namespace whirl::flight {

struct EscParams {
  fw::esc::Calibration calibration;
  plant::CurrentShuntParams shunt;
  int pole_pairs = 7;  // of its motor
};

class NativeEsc final : public MotorController {
 public:
  NativeEsc(const EscParams& params, std::uint64_t seed, int number);

  void write(std::uint16_t v) override { setpoint_ = v, fresh_ = true; }
  plant::MotorCommand step(std::int64_t now_ns, const plant::MotorState& motor,
                           double bus_voltage_V) override;
  void cut() override { cut_ = true; }

  io::EscState status() const override;
  bool armed() const override { return core_.supervisor().armed(); }
  std::vector<NamedValue> signals() const override;
  const fw::esc::Core& core() const { return core_; }
  // What the image does with `still`: `tick` is to step this ESC and its motor by a millisecond. The share that it found;
  // nothing: refused.
  std::optional<double> take_still_air(const std::function<void()>& tick);

 private:
  enum class Phase : std::uint8_t { off, catching, aligning, turning };

  fw::esc::Sensed sense(std::int64_t now_ns, const plant::MotorState& motor, double bus_voltage_V);
  float sample_current(double bus_current_A);
  void enter(Phase phase);
  void follow(bool energised);

  fw::esc::Core core_;
  fw::esc::ZeroCurrent zero_;
  fw::esc::SmoothSpeed speed_;
  plant::CurrentShunt shunt_;
  ZeroCrossings crossings_;
  std::uint16_t setpoint_ = 0;
  bool fresh_ = false, cut_ = false, followed_ = false, backward_ = false;
  Phase phase_ = Phase::off;
  int phase_ms_ = 0;
  double last_speed_radps_ = 0.0;
};

}  // namespace whirl::flight
