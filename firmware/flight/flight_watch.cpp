#include "firmware/config/vehicle.hpp"
#include "firmware/flight/flight.hpp"

namespace fw {
namespace {

constexpr float kTipped_cos = 0.5f;       // 60 degrees
constexpr float kTiltToArm_cos = 0.985f;  // 10 degrees

bool between(float low, float value, float high) {
  return value >= low && value <= high;
}

}  // namespace

Conditions Flight::conditions() const {
  Conditions now;
  now.set(Condition::imu_not_running, imu_missing_ms_ > kImuLost_ms);
  now.set(Condition::imu_frozen, imu_frozen_);
  // Who has just been restarted rights itself first.
  now.set(Condition::tipped_over, !catching_ && tilt_cosine(estimator_.q_WB()) < kTipped_cos);
  now.set(Condition::esc_over_current, motors_.over_current());
  now.set(Condition::motor_out, motors_.out());
  now.set(Condition::esc_silent, motors_.silent());
  now.set(Condition::no_position, !navigates());
  now.set(Condition::by_drag, estimator_.velocity_source() == VelocitySource::drag);
  now.set(Condition::outside_fence, navigates() && !fence().contains(estimator_.p_WB_W_m()));
  now.set(Condition::battery_empty, battery_.rest_V() < parameters_.get(Parameter::bat_empty_V));
  now.set(Condition::battery_low, battery_.rest_V() < parameters_.get(Parameter::bat_low_V));
  now.set(Condition::no_link, link_age_ms_ > kLinkLost_ms && link_age_ms_ < kNever);
  now.set(Condition::rc_lost, steered_by_hand() && pilot_.link() == PilotLink::lost);
  now.set(Condition::rc_nonsense, steered_by_hand() && pilot_.link() == PilotLink::nonsense);
  now.set(Condition::no_setpoints, target_age_ms_ > kTargetsLost_ms && target_age_ms_ < kNever);
  now.set(Condition::no_pressure, !estimator_.pressure_good());
  now.set(Condition::no_field, !estimator_.field_good());
  const bool by_gps = estimator_.velocity_source() == VelocitySource::gps;
  now.set(Condition::heading_by_gyro, by_gps && !estimator_.field_good());
  now.set(Condition::off_course, by_gps && off_course());
  return now;
}

// Far from where its own reference has it, which only a wrong heading, or a wind beyond its reach, does.
bool Flight::off_course() const {
  constexpr float kFar_m = 5.0f;
  const bool led = state_ != FlightState::flying || aim_ == Aim::place || aim_ == Aim::trajectory;
  if (!led || !in_air() || !airborne_ || !navigates() || !position_was_known_) return false;
  return (reference_.p_W_m() - estimator_.p_WB_W_m()).head<2>().norm() > kFar_m;
}

// The capture system's room, or, by GPS alone, about where it began.
Fence Flight::fence() const {
  if (estimator_.velocity_source() == VelocitySource::gps) {
    return {.top_m = parameters_.get(Parameter::fence_height_m),
            .radius_m = parameters_.get(Parameter::fence_radius_m)};
  }
  return {parameters_.get(Parameter::fence_north_m), parameters_.get(Parameter::fence_east_m),
          parameters_.get(Parameter::fence_top_m)};
}

Reason Flight::first_esc_problem() const {
  for (unsigned i = 0; i < 4; ++i) {
    const std::uint8_t flags = motors_.status(i).flags;
    if (motors_.silent(i)) return Reason::esc_silent;
    if ((flags & esc::flag_over_current) != 0) return Reason::esc_over_current;
    if ((flags & (esc::flag_under_voltage | esc::flag_desync)) != 0) {
      return Reason::esc_fault;
    }
    if ((flags & esc::flag_armed) == 0) return Reason::esc_not_armed;
  }
  return Reason::none;
}

// There, and telling what can be on the ground somewhere on earth.
Reason Flight::first_sensor_problem() const {
  constexpr float kLowest_Pa = 50e3f, kHighest_Pa = 110e3f;     // 5500 m; the Dead Sea
  constexpr float kWeakest_uT = 15.0f, kStrongest_uT = 100.0f;  // the earth's 22 to 67, and iron
  constexpr float kRest_mps2 = 1.5f;
  if (!estimator_.pressure_fresh() || !between(kLowest_Pa, estimator_.pressure_Pa(), kHighest_Pa)) {
    return Reason::no_pressure;
  }
  if (!estimator_.field_fresh() ||
      !between(kWeakest_uT, estimator_.field_B_uT().norm(), kStrongest_uT)) {
    return Reason::no_field;
  }
  const float a_mps2 = estimator_.imu().a_B_mps2.norm();
  if (!between(config::kGravity_mps2 - kRest_mps2, a_mps2, config::kGravity_mps2 + kRest_mps2)) {
    return Reason::imu_implausible;
  }
  return Reason::none;
}

Reason Flight::ready_to_arm() const {
  if (calibrator_.running() != Calibration::none) return Reason::calibrating;
  if (falling_) return Reason::falling;
  if (imu_missing_ms_ > kImuLost_ms) return Reason::imu_not_running;
  if (imu_frozen_) return Reason::imu_frozen;
  if (!estimator_.position_good()) return Reason::no_position;
  if (!estimator_.calibrated()) return Reason::imu_not_calibrated;
  if (!estimator_.position_settled()) return Reason::estimate_not_converged;
  if (const Reason problem = first_sensor_problem(); problem != Reason::none) return problem;
  if (!estimator_.converged()) return Reason::estimate_not_converged;
  if (tilt_cosine(estimator_.q_WB()) < kTiltToArm_cos) return Reason::tilted;
  if (!fence().contains(estimator_.p_WB_W_m())) return Reason::outside_fence;
  if (!battery_.connected()) return Reason::no_battery;
  if (battery_.rest_V() < parameters_.get(Parameter::bat_low_V)) return Reason::battery_low;
  if (const Reason problem = first_esc_problem(); problem != Reason::none) return problem;
  return escs_not_warm() ? Reason::esc_not_warm : Reason::none;
}

float Flight::sinking_mps() const {
  if (!estimator_.position_known() && estimator_.pressure_good()) return estimator_.baro_vz_mps();
  return estimator_.v_WB_W_mps().z();
}

float Flight::height_m() const {
  if (estimator_.position_known()) return ground_W_m_.z() - estimator_.p_WB_W_m().z();
  return estimator_.pressure_good() ? ground_W_m_.z() - estimator_.baro_z_m() : 0.0f;
}

// Faster far up, so that what is left of the battery lasts.
float Flight::descent_mps() const {
  constexpr float kHigh_m = 2.5f, kFaster_ps = 0.25f, kFastest_mps = 0.8f;
  constexpr float kLongestReturn_s = 15.0f;
  const bool outside = estimator_.position_known() && !fence().contains(estimator_.p_WB_W_m());
  if (outside && state_s_ < kLongestReturn_s) return 0.0f;
  const float height = height_m();
  if (height < config::kTouchdownHeight_m && estimator_.position_known()) {
    return config::kTouchdown_mps;
  }
  return std::clamp(config::kDescent_mps + kFaster_ps * (height - kHigh_m), config::kDescent_mps,
                    kFastest_mps);
}

}  // namespace fw
