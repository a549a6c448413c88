// The flight logic: sensor samples, fixes, commands in; rotor set-points and state out.
//
//   Rates   on_imu 1 kHz, attitude_step 200 Hz, position_step 40 Hz. Knows no bus and no clock but
//           its own count of ticks
//   States  disarmed -> armed -> flying -> landing -> disarmed; failsafe landing from the two in the
//           air; motors off at once where nothing can be controlled (IMU lost, tipped over)
#pragma once
#include <array>
#include <cstdint>

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
#include "firmware/flight/pilot.hpp"
#include "firmware/math.hpp"

namespace fw {

enum class FlightState : std::uint8_t { disarmed, armed, flying, landing, failsafe };

enum class Reason : std::uint8_t {  // why a command was refused, or a flight ended
  none,
  imu_not_running,
  imu_frozen,
  imu_not_calibrated,
  no_capture,
  estimate_not_converged,
  tilted,
  esc_not_armed,
  esc_fault,
  esc_silent,
  no_setpoints,
  tipped_over,
  landed,
  commanded,
  wrong_state,
  height_out_of_range,
};
const char* text_of(Reason reason);

class Flight {
 public:
  // Inputs.
  void on_imu(const ImuSample& sample);
  void on_imu_missing();                                      // a tick without a sample
  void set_imu_frozen(bool frozen) { imu_frozen_ = frozen; }  // samples that stopped changing
  void on_fix(const CaptureFix& fix);
  void on_pressure(float pressure_Pa) { estimator_.on_pressure(pressure_Pa); }
  void on_field(const Vector3& field_B_uT) { estimator_.on_field(field_B_uT); }
  void on_target(const Vector3& p_W_m, float yaw_rad);
  // A point of a trajectory; far from where the reference is, it is a target to go to first.
  void on_trajectory(const TrajectoryPoint& point);
  // A horizontal velocity to hold, at a height.
  void on_velocity(const Vector3& v_W_mps, float z_m, float yaw_rad);
  // An attitude to hold, in the air only; thrust: share of the collective, hover at a half.
  void on_attitude(const Quaternion& q_WB, float yaw_rate_radps, float thrust_share);
  void on_rc(const CppmFrame& frame) { pilot_.on_frame(frame); }
  void on_esc_answered(unsigned motor) { esc_silent_ms_[motor] = 0; }
  void on_esc_status(unsigned motor, const esc::protocol::Status& status) {
    esc_status_[motor] = status;
  }
  // Commands: none if accepted.
  Reason arm();
  Reason disarm();
  Reason take_off(float height_m);
  Reason land();

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
  Reason ready_to_arm() const;
  const Estimator& estimator() const { return estimator_; }
  Estimator& estimator() { return estimator_; }
  const Pilot& pilot() const { return pilot_; }
  const Reference& reference() const { return reference_; }
  const esc::protocol::Status& esc_status(unsigned motor) const { return esc_status_[motor]; }
  bool capture_fresh() const { return estimator_.fix_fresh(); }

 private:
  static constexpr std::uint32_t kNever = Estimator::kNever;
  static constexpr std::uint32_t kEscSilent_ms = 500, kTargetFresh_ms = 500, kTargetsLost_ms = 3000;
  static constexpr std::uint32_t kImuLost_ms = 20;

  void tick();
  void apply_parameters();
  void estimate();
  void supervise();
  void watch_flight();
  void detect_touchdown();
  void control();
  void enter(FlightState state, Reason reason);
  void stop_motors(Reason reason, bool emergency);
  Reason first_esc_problem() const;
  bool in_air() const { return state_ >= FlightState::flying; }
  bool accept_target(const Vector3& p_W_m, float yaw_rad);
  void advance_reference();
  void follow_reference();
  void follow_attitude();
  void stay();

  Parameters parameters_;
  Pilot pilot_;
  Estimator estimator_;
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

  bool imu_frozen_ = false;
  std::uint32_t imu_missing_ms_ = kNever;

  Vector3 target_W_m_ = Vector3::Zero();
  float target_yaw_rad_ = 0.0f;
  enum class Aim : std::uint8_t { place, trajectory, velocity, attitude } aim_ = Aim::place;
  TrajectoryPoint point_;
  Vector3 jerk_W_mps3_ = Vector3::Zero(), target_v_W_mps_ = Vector3::Zero();
  AttitudeDemand attitude_;
  float thrust_share_ = 0.0f;
  std::uint32_t target_age_ms_ = kNever;
  std::array<esc::protocol::Status, 4> esc_status_{};
  std::array<std::uint32_t, 4> esc_silent_ms_{kNever, kNever, kNever, kNever};

  Vector3 ground_W_m_ = Vector3::Zero();
  float lift_ = 0.0f;  // share of the weight that the rotors are asked to carry
  float contact_s_ = 0.0f, state_s_ = 0.0f, tipped_s_ = 0.0f;
  bool airborne_ = false;
  ThrustAndAttitude wanted_;
  std::array<std::uint16_t, 4> setpoints_{};
};

}  // namespace fw
