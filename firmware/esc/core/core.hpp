// The ESC's control core: set-points and measurements in, voltage for the bridge out, once per
// millisecond. Plain C++: the image runs it on the part, the flight plans behind the I2C device.
//
//   Modes   0 duty, 1 speed, 2 thrust by the static map, 4 aerodynamic power, 5 thrust by power
//   Source  [Bangura 2017, ch. 5, table 3.3]; set-points as the ESC protocol says
//   Guards  winding current by the back-EMF bound, over-current latch, stall and loss of sync latch
//   Not here  six-step commutation and start-up (the bridge driver), bytes on the bus
#pragma once
#include <cstdint>

#include "firmware/esc/core/calibration.hpp"
#include "firmware/esc/core/protocol.hpp"
#include "firmware/esc/core/sensing.hpp"
#include "firmware/esc/core/speed_controller.hpp"
#include "firmware/esc/core/supervisor.hpp"
#include "firmware/esc/core/thrust_estimator.hpp"

namespace fw::esc {

struct Sensed {
  float bus_voltage_V = 0.0f;
  float bus_current_A = 0.0f;  // PWM average from the shunt, before offset and gain
  float speed_radps = 0.0f;    // mechanical; 0 when no zero crossings are seen
  bool in_sync = false;        // commutation follows the rotor
  bool slowing = false;        // from one crossing to the next, by more than noise
  float latest_radps = -1.0f;  // speed without lag and rather too low, for limits; < 0: not known
  // Of all crossings since the last period, so that what one comes late by is taken off again by the next: for
  // control. < 0: as the latest.
  float recent_radps = -1.0f;
};

struct Drive {
  float duty = 0.0f;       // of the bus voltage, 0..1
  bool energised = false;  // false: all switches off, the motor coasts
};

class Core {
 public:
  static constexpr float kPeriod_s = 1e-3f;

  explicit Core(const Calibration& calibration);

  // A valid set-point 0..2047 from the bus, or a value in the unit of `mode` from the command line.
  void on_setpoint(std::uint16_t v);
  bool command(Mode mode, float value);  // false: the mode cannot be changed now
  void arm_by_hand();                    // as 25 zeros would
  Drive tick(const Sensed& sensed);
  bool recalibrate(const Calibration& calibration);  // false: refused while the motor turns
  // What still_air.hpp has found: of the calibration, the power of still air becomes this share of itself.
  void take_still_power(float share);
  bool set_mode(Mode mode);  // false: refused (turning, or a mode that a propeller has no use for)
  void latch(Latched fault) { supervisor_.latch(fault); }
  void watch(bool on) { supervisor_.watch(on); }

  std::uint8_t flags() const;
  Mode mode() const { return calibration_.mode; }
  float bus_current_A() const { return bus_current_A_; }    // filtered
  float measured_current_A() const { return measured_A_; }  // of the bus, calibrated, last period
  const Sensed& sensed() const { return sensed_; }
  const Drive& drive() const { return drive_; }
  float bus_voltage_V() const { return sensed_.bus_voltage_V; }
  float speed_radps() const { return sensed_.speed_radps; }
  bool at_rest() const { return sensed_.speed_radps < 10.0f; }
  float wanted_speed_radps() const { return wanted_radps_; }
  const ThrustEstimator& estimator() const { return estimator_; }
  const Supervisor& supervisor() const { return supervisor_; }
  const Calibration& calibration() const { return calibration_; }

 private:
  float wanted_value() const;
  float speed_for(float value) const;
  enum class Phase : std::uint8_t { stopped, starting, running, lost };

  void enter(Phase phase);
  void advance_phase(bool wanted);
  Drive drive_for_phase(float value);
  Drive regulate(float value);
  void guard(const Sensed& sensed);

  Calibration calibration_;
  Supervisor supervisor_;
  OffsetError offset_error_{kPeriod_s};
  ThrustEstimator estimator_;
  SpeedController speed_control_;
  Sensed sensed_{};
  Drive drive_{};
  float command_value_ = 0.0f;
  bool command_given_ = false;
  float measured_A_ = 0.0f;
  float bus_current_A_ = 0.0f;
  float wanted_radps_ = 0.0f;
  float solved_radps_ = 0.0f;  // of the last period: where the next one begins
  std::uint16_t over_current_ms_ = 0;
  Phase phase_ = Phase::stopped;
  std::uint16_t phase_ms_ = 0;
  std::uint8_t losses_ = 0;  // of synchronism, since it last ran calmly
  bool saturated_ = false;
};

}  // namespace fw::esc
