// The flight logic: sensor samples, fixes, commands in; rotor set-points and state out.
//
//   Sensors come as they read; what corrects them: calibration/sensor_correction.hpp
//   Rates   on_imu 1 kHz, attitude_step 200 Hz, position_step 40 Hz. Knows no bus and no clock but
//           its own count of ticks
//   States  disarmed -> armed -> flying -> landing -> disarmed; what is taken in which of them, and
//           what is done about what goes wrong: the tables of supervisor.hpp
//   Files   flight.cpp commands and states; flight_watch.cpp what holds now, and what keeps it from
//           arming; flight_control.cpp from the reference to set-points; flight_manual.cpp from sticks;
//           flight_calibration.cpp when sensors are calibrated; flight_restart.cpp motors stopped in
//           the air, and started again
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "firmware/calibration/calibrator.hpp"
#include "firmware/calibration/sensor_correction.hpp"
#include "firmware/config/parameters.hpp"
#include "firmware/control/attitude_controller.hpp"
#include "firmware/control/attitude_reference.hpp"
#include "firmware/control/mixer.hpp"
#include "firmware/control/position_controller.hpp"
#include "firmware/control/reference.hpp"
#include "firmware/control/rotor_response.hpp"
#include "firmware/control/velocity_controller.hpp"
#include "firmware/esc/core/protocol.hpp"
#include "firmware/estimation/estimator.hpp"
#include "firmware/flight/battery_watch.hpp"
#include "firmware/flight/fence.hpp"
#include "firmware/flight/flight_state.hpp"
#include "firmware/flight/motor_watch.hpp"
#include "firmware/flight/pilot.hpp"
#include "firmware/flight/restart.hpp"
#include "firmware/flight/supervisor.hpp"
#include "firmware/math.hpp"

namespace fw {

class Flight {
 public:
  [[gnu::cold]] Flight();  // cold: small before fast, once

  // Inputs.
  void on_imu(const ImuSample& sample);
  void on_imu_missing();                                      // a tick without a sample
  void set_imu_frozen(bool frozen) { imu_frozen_ = frozen; }  // samples that stopped changing
  void on_fix(const CaptureFix& fix);
  void on_gps(const GpsSolution& solution) { estimator_.on_gps(solution); }
  void on_pressure(float pressure_Pa) { estimator_.on_pressure(pressure_Pa); }
  void on_field(const Vector3& field_B_uT);
  void on_target(const Vector3& p_W_m, float yaw_rad);
  // A point of a trajectory; far from where the reference is, it is a target to go to first.
  void on_trajectory(const TrajectoryPoint& point);
  // A horizontal velocity to hold, at a height.
  void on_velocity(const Vector3& v_W_mps, float z_m, float yaw_rad);
  // An attitude to hold, in the air only; thrust: share of the collective, hover at a half.
  void on_attitude(const Quaternion& q_WB, float yaw_rate_radps, float thrust_share);
  void on_rc(std::span<const std::uint16_t> channels_us) { pilot_.on_frame(channels_us); }
  void on_esc_answered(unsigned motor) { motors_.on_answered(motor); }
  void on_esc_status(unsigned motor, const esc::protocol::Status& status) {
    motors_.on_status(motor, status);
  }
  void on_battery(float voltage_V);     // 100 Hz
  void on_link() { link_age_ms_ = 0; }  // anything valid from the ground station
  // Commands: none if accepted.
  Reason arm();
  Reason disarm();
  // By force: motors off wherever it is; and, stopped in the air, on again there (restart.hpp).
  Reason kill();
  Reason restart();
  Reason take_off(float height_m);
  Reason land();
  // none: what runs is cancelled. Its outcome: calibrator().
  Reason calibrate(Calibration what);
  Calibrator& calibrator() { return calibrator_; }

  Parameters& parameters() { return parameters_; }
  const Parameters& parameters() const { return parameters_; }

  // Tasks.
  void attitude_step();
  void position_step();

  // Outputs.
  std::array<std::uint16_t, 4> setpoints() const { return setpoints_; }
  // They go out: from here on the rotors follow them.
  std::array<std::uint16_t, 4> send_setpoints();
  FlightState state() const { return state_; }
  Reason last_reason() const { return reason_; }
  std::uint32_t reason_count() const { return reason_count_; }  // steps with each new reason
  bool emergency() const { return emergency_; }
  // Motors were stopped in the air, and it has not come to rest since.
  bool falling() const { return falling_; }
  Reason ready_to_arm() const;
  const Estimator& estimator() const { return estimator_; }
  Estimator& estimator() { return estimator_; }
  const Pilot& pilot() const { return pilot_; }
  bool steered_by_hand() const { return steered_ != PilotMode::autonomous; }
  const Reference& reference() const { return reference_; }
  const esc::protocol::Status& esc_status(unsigned motor) const { return motors_.status(motor); }
  const BatteryWatch& battery() const { return battery_; }
  Conditions conditions() const;
  Reason take_warning() { return supervisor_.take_warning(); }

 private:
  static constexpr std::uint32_t kNever = Estimator::kNever;
  static constexpr std::uint32_t kTargetFresh_ms = 500, kTargetsLost_ms = 3000;
  static constexpr std::uint32_t kImuLost_ms = 20, kLinkLost_ms = 3000;
  static constexpr float kSpinUp_s = 1.5f;       // armed before it flies
  static constexpr float kAboveGround_m = 0.3f;  // a target below that does not mean flight

  void tick();
  void apply_parameters();
  void keep_drag();
  MotorCurrents motor_currents_A() const;
  void watch_calibration();
  void estimate();
  void supervise();
  void react(const Decision& decision);
  void follow_target_into_air();
  void count_contact();
  void detect_touchdown();
  void control();
  void run_motor_to_calibrate();
  void enter(FlightState state, Reason reason);
  void stop_motors(Reason reason, bool emergency);
  void cut(Reason reason);
  void watch_fall();
  bool rotors_start();
  void catch_fall();
  void right_itself();
  Reason first_esc_problem() const;
  Reason first_sensor_problem() const;
  bool escs_not_warm() const;
  Fence fence() const;
  // A place by capture or GPS, or by drag a velocity; not who has lost its course, who comes down level.
  bool navigates() const {
    return !course_lost_ && estimator_.velocity_source() != VelocitySource::none;
  }
  bool off_course() const;
  bool in_air() const { return state_ >= FlightState::flying; }
  // Downward speed and height over where it armed, by the best that is known now.
  float sinking_mps() const;
  float height_m() const;
  float descent_mps() const;  // 0 while it is on its way back inside the fence
  bool accept_target(const Vector3& p_W_m, float yaw_rad);
  void advance_reference();
  void follow_reference();
  void follow_pilot();
  void follow_arm_switch(const PilotDemand& sticks);
  void follow_sticks(const PilotDemand& sticks);
  void hand_over(PilotMode mode);
  void begin_armed();
  void refuse(Reason reason);
  void follow_attitude();
  void stay();
  void descend();

  Parameters parameters_;
  SensorCorrection correction_;
  Calibrator calibrator_{parameters_};
  Pilot pilot_;
  PilotMode steered_ = PilotMode::autonomous;  // by whom; a lost link changes nothing
  bool arm_switch_ = true;
  Estimator estimator_;
  Supervisor supervisor_;
  MotorWatch motors_;
  BatteryWatch battery_;
  AttitudeController attitude_control_;
  PositionController position_control_;
  VelocityController velocity_control_;
  AttitudeReference attitude_reference_;
  RotorResponse rotors_;
  RotorThrusts setpoints_N_{};
  Reference reference_;

  FlightState state_ = FlightState::disarmed;
  Reason reason_ = Reason::none;
  std::uint32_t reason_count_ = 0;
  bool emergency_ = false;
  bool falling_ = false, attitude_lost_ = false;  // since they were stopped
  bool starting_ = false, catching_ = false;      // a restart: the rotors, then the fall
  bool righting_ = false;                         // far from level, and not level since
  FallDrag fall_drag_;

  bool imu_frozen_ = false;
  std::uint32_t imu_missing_ms_ = kNever;

  Vector3 target_W_m_ = Vector3::Zero();
  float target_yaw_rad_ = 0.0f;
  enum class Aim : std::uint8_t { place, trajectory, velocity, attitude } aim_ = Aim::place;
  TrajectoryPoint point_;
  Vector3 jerk_W_mps3_ = Vector3::Zero(), target_v_W_mps_ = Vector3::Zero();
  AttitudeDemand attitude_;
  unsigned hold_steps_ = 0;  // attitude steps since set-points went out
  float thrust_share_ = 0.0f;
  std::uint32_t target_age_ms_ = kNever;
  std::uint32_t link_age_ms_ = kNever;

  Vector3 ground_W_m_ = Vector3::Zero();
  float lift_ = 0.0f;  // share of the weight that the rotors are asked to carry
  float contact_s_ = 0.0f, state_s_ = 0.0f, blind_longest_s_ = 0.0f, quiet_s_ = 0.0f;
  bool airborne_ = false, position_was_known_ = false, course_lost_ = false;
  std::uint32_t heading_turns_ = 0;  // that the reference knows of
  ThrustAndAttitude wanted_;
  std::array<std::uint16_t, 4> setpoints_{};
};

}  // namespace fw
