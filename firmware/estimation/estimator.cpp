#include "firmware/estimation/estimator.hpp"

#include "firmware/config/vehicle.hpp"
#include "firmware/estimation/drag_model.hpp"

namespace fw {
namespace {

// On the ground the accelerometer may set roll and pitch fast; in flight it is a slow reference.
constexpr float kAccelGainGround_radps = 2.0f, kAccelGainFlight_radps = 0.2f;
constexpr float kHeadingShareGround = 1.0f, kHeadingShareFlight = 0.1f;
// Cameras, radio and a poll 15 ms, half a period of differences 12 ms, their filter 25 ms.
constexpr float kCaptureVelocityDelay_s = 0.050f;
constexpr float kLeastThrust_mps2 = 3.0f;  // below, drag says little about speed
constexpr float kSteepest_cos = 0.3f;
constexpr float kGpsDoubted_s = 2.0f, kWindow_s = 1.0f;
// The barometer wanders by a metre in ten minutes, the receiver's height by several in one.
constexpr float kHeightByGps_ps = 1.0f / 600.0f, kMostHeightError_m = 5.0f;
constexpr float kFieldShareGround = 0.05f, kFieldShareFlight = 0.01f;  // 75 Hz

float seconds(std::uint32_t ms) {
  return 1e-3f * static_cast<float>(ms);
}

}  // namespace

Estimator::Estimator() {
  set_drag(config::kDrag_spm);
  restart_aided();
}

void Estimator::tick() {
  ++fix_age_ms_;
  gps_guard_.tick();
  ++pressure_age_ms_;
  ++field_age_ms_;
  field_guard_.tick();
}

void Estimator::on_imu(const ImuSample& sample) {
  sample_ = sample;
  a_sum_ += sample.a_B_mps2;
  w_sum_ += sample.w_B_radps;
  ++sum_count_;
}

const Quaternion& Estimator::q_WB() const {
  if (source_ == AttitudeSource::explicit_filter) return explicit_.q_WB();
  return position_known() ? inertial_.q_WB() : body_.q_WB();
}

bool Estimator::position_good() const {
  return fix_age_ms_ <= kFixFresh_ms || (!fix_fresh() && gps_guard_.fresh());
}

bool Estimator::position_settled() const {
  constexpr std::uint32_t kCaptureFixes = 20, kGpsFixes = 10;  // in a row: half a second, two
  return fix_fresh() ? still_fixes_ >= kCaptureFixes : gps_guard_.in_row() >= kGpsFixes;
}

bool Estimator::converged() const {
  constexpr float kScaleOff = 0.15f, kApart_rad = 0.1f;
  if (source_ == AttitudeSource::explicit_filter) return true;
  const bool scales =
      std::abs(body_.scale() - 1.0f) < kScaleOff && std::abs(inertial_.scale() - 1.0f) < kScaleOff;
  return scales && body_.q_WB().angularDistance(inertial_.q_WB()) < kApart_rad;
}

void Estimator::on_fix(const CaptureFix& fix) {
  // Who flies by GPS comes into a room in another frame: not before it has landed.
  if (situation_.in_flight && gps_frame_.known()) return;
  const bool stuck = capture_guard_.stuck(fix.p_WB_W_m, fix.yaw_rad);
  if (situation_.airborne && (stuck || !plausible(fix))) return;
  const bool first = fix_age_ms_ >= kFixLost_ms && !situation_.in_flight;
  const float since_last_s = seconds(fix_age_ms_);
  if (!fix_fresh()) calibration_.restart();  // a window by gravity is none by capture
  explicit_.correct_heading(fix.yaw_rad,
                            situation_.in_flight ? kHeadingShareFlight : kHeadingShareGround);
  if (fix_age_ms_ >= kFixLost_ms && situation_.airborne) {
    inertial_.resume(body_.q_WB(), position_.v_WB_W_mps());
    position_.resume(fix.p_WB_W_m);
  }
  correct_velocity(fix, since_last_s);
  fix_ = fix;
  fix_age_ms_ = 0;
  gps_frame_.forget();
  gps_guard_.forget();
  if (first) return position_.start(fix.p_WB_W_m);
  position_.correct(fix.p_WB_W_m, since_last_s);
  // In the air an innovation is flight; standing still it tells whether the filter has settled.
  still_fixes_ = position_.innovation_W_m().norm() < 0.03f ? still_fixes_ + 1 : 0;
}

bool Estimator::plausible(const CaptureFix& fix) const {
  const float turned_rad = wrap_pi(fix.yaw_rad - yaw_of(explicit_.q_WB()));
  return CaptureGuard::plausible((fix.p_WB_W_m - position_.p_WB_W_m()).norm(), turned_rad,
                                 seconds(fix_age_ms_));
}

// v = 0.5 V + 0.5 dp/dt [Bangura 2017, 6.9, 6.10]. After a gap the difference is too old a velocity.
void Estimator::correct_velocity(const CaptureFix& fix, float since_last_s) {
  constexpr float kLongest_s = 0.2f;
  if (since_last_s > kLongest_s) return;
  capture_v_W_mps_ = 0.5f * capture_v_W_mps_ + 0.5f / since_last_s * (fix.p_WB_W_m - fix_.p_WB_W_m);
  inertial_.correct(capture_v_W_mps_, kCaptureVelocityDelay_s, since_last_s);
  inertial_.correct_heading(fix.yaw_rad, since_last_s);
}

void Estimator::on_gps(const GpsSolution& solution) {
  gps_ = solution;
  const bool stuck = gps_guard_.stuck(solution) && situation_.airborne;
  if (fix_fresh() || stuck || !solution.good()) return;
  if (!gps_frame_.known()) {
    // A vehicle that capture has placed goes on in the capture's frame.
    if (situation_.resting && fix_age_ms_ >= kNever) gps_frame_.learn(solution);
    if (!gps_frame_.known()) return;
    position_.start(Vector3::Zero());
  }
  const float wrong_rad = heading_by_motion_.compare(solution.v_W_mps, solution.age_s);
  if (situation_.airborne && wrong_rad != 0.0f) turn_heading(wrong_rad);
  const Vector3 p_W_m = gps_frame_.local(solution);
  const auto innovation = position_.gps_innovation(p_W_m, solution.v_W_mps, solution.age_s);
  const float since_last_s = gps_guard_.age_s();
  const bool was_lost = !gps_guard_.fresh();
  // Where the pressure draws the climb, the receiver is not judged by that.
  Vector3 v_off_W = innovation.v_W_mps;
  if (pressure_drawn()) v_off_W.z() = 0.0f;
  if (!gps_guard_.believe(innovation.p_W_m, v_off_W)) {
    // Nothing has moved it: what it was told before was wrong, or this is.
    if (situation_.resting && since_last_s > kGpsDoubted_s) {
      position_.start({p_W_m.x(), p_W_m.y(), position_.p_WB_W_m().z()});
    }
    return;
  }
  // Nobody flies by a place that is unknown: it may jump.
  if (was_lost) {
    position_.shift(innovation);
  } else {
    position_.correct_by_gps(innovation, since_last_s);
  }
  inertial_.correct(solution.v_W_mps, solution.age_s, since_last_s);
  if (!situation_.airborne) return;
  compare_climb(solution.v_W_mps.z(), since_last_s);
  const float height_error_m = std::clamp(height_.z_m() - height_offset_m_ - p_W_m.z(),
                                          -kMostHeightError_m, kMostHeightError_m);
  height_offset_m_ += kHeightByGps_ps * std::min(since_last_s, 0.25f) * height_error_m;
}

// A receiver's climb is good to decimetres a second. A barometer that for half a second tells another one, which the
// accelerometer has not felt, is moved by something else than height, and what it has taught the filter is wrong as well.
void Estimator::compare_climb(float gps_vz_mps, float since_last_s) {
  constexpr float kOff_mps = 0.8f;
  const bool off = pressure_drawn() && std::abs(height_.vz_mps() - gps_vz_mps) > kOff_mps;
  climb_off_s_ = off ? climb_off_s_ + since_last_s : 0.0f;
  climb_doubted_ |= climb_off_s_ > kClimbOff_s;
}

void Estimator::turn_heading(float by_rad) {
  const Quaternion by_W(std::cos(0.5f * by_rad), 0.0f, 0.0f, std::sin(0.5f * by_rad));
  explicit_.turn(by_W);
  body_.turn(by_W);
  inertial_.turn(by_W);
  position_.forget_bias();
  heading_by_motion_.forget();
  field_guard_.misleads();
  ++heading_turns_;
}

void Estimator::on_pressure(float pressure_Pa) {
  const float since_last_s = seconds(pressure_age_ms_);
  pressure_age_ms_ = 0;
  pressure_Pa_ = pressure_Pa;
  if (situation_.resting || !height_.ready()) {
    resting_Pa_ =
        resting_Pa_ > 0.0f ? resting_Pa_ + 0.02f * (pressure_Pa - resting_Pa_) : pressure_Pa;
    height_.zero(resting_Pa_);
    height_offset_m_ = -fix_.p_WB_W_m.z();
    return;
  }
  height_.correct(pressure_Pa, since_last_s);
  // The rotors' wash and the weather, by which the pressure is off.
  if (fix_fresh() && situation_.airborne) {
    height_offset_m_ += 0.5f * std::min(since_last_s, 0.1f) *
                        (height_.z_m() - height_offset_m_ - position_.p_WB_W_m().z());
  }
}

void Estimator::on_field(const Vector3& field_B_uT) {
  const float since_last_s = seconds(field_age_ms_);
  field_age_ms_ = 0;
  field_B_uT_ = field_B_uT;
  const Vector3 field_W = explicit_.q_WB() * field_B_uT;
  if (situation_.resting) {
    field_guard_.rests(field_W);
  } else if (!field_guard_.believe(field_W)) {
    return;
  }
  body_.correct_heading(field_B_uT, declination_rad_, since_last_s);
  if (fix_fresh()) return;
  const float from_north_rad = declination_rad_ - std::atan2(field_W.y(), field_W.x());
  explicit_.correct_heading(yaw_of(explicit_.q_WB()) + from_north_rad,
                            situation_.in_flight ? kFieldShareFlight : kFieldShareGround);
}

void Estimator::set_start(float scale, float tilt_rad) {
  if (scale == start_scale_ && tilt_rad == start_tilt_rad_) return;
  const bool flown_by = !situation_.resting && source_ == AttitudeSource::velocity_aided;
  if (flown_by) return;
  start_scale_ = scale;
  start_tilt_rad_ = tilt_rad;
  restart_aided();
}

void Estimator::set_drag(float drag_spm) {
  if (drag_spm == start_drag_spm_) return;
  start_drag_spm_ = drag_spm;
  if (drag_spm != drag_.drag_spm()) drag_.start(drag_spm);
}

void Estimator::restart_aided() {
  const Quaternion q_WB = explicit_.q_WB() * from_euler(start_tilt_rad_, 0.0f, 0.0f);
  body_.start(q_WB, start_scale_);
  inertial_.start(q_WB, position_.v_WB_W_mps(), start_scale_);
}

void Estimator::step(const Situation& situation) {
  situation_ = situation;
  if (sum_count_ > 0) {
    const float scale = 1.0f / static_cast<float>(sum_count_);
    a_B_mps2_ = scale * a_sum_ - accel_zero_B_mps2_;
    raw_w_B_radps_ = scale * w_sum_;
    a_sum_.setZero();
    w_sum_.setZero();
    sum_count_ = 0;
    step_explicit(raw_w_B_radps_);
    step_aided(raw_w_B_radps_ - gyro_zero_B_radps_);
  }
  velocity_source_ = find_velocity_source();
  step_position();
  step_drag();
  if (!situation.resting) return calibration_.restart();
  if (fix_age_ms_ <= kFixFresh_ms) return calibrate_by_capture();
  if (fix_fresh()) return calibration_.restart();
  calibrate_by_gravity();
}

// Without capture the height is the barometer's, and what rests does not move.
void Estimator::move_by_height() {
  if (pressure_good() && height_.ready()) position_.set_height(baro_z_m(), baro_vz_mps());
  if (!situation_.resting) return;
  position_.hold_still();
  heading_by_motion_.forget();
  climb_doubted_ = false;
  climb_off_s_ = 0.0f;
}

__attribute__((noinline)) void Estimator::step_explicit(const Vector3& w_B) {
  if (!started_) {
    explicit_.start(a_B_mps2_, fix_.yaw_rad);
    restart_aided();
  }
  started_ = true;
  const float gain = !situation_.resting ? kAccelGainFlight_radps : kAccelGainGround_radps;
  explicit_.update(w_B, a_B_mps2_, kStep_s, gain);
}

__attribute__((noinline)) void Estimator::step_aided(const Vector3& w_B) {
  const FromInertialFilter to_body{position_known(), inertial_.q_WB(),
                                   inertial_.v_WB_W_mps() - inertial_.wind_W_mps(),
                                   inertial_.accel_bias_B_mps2()};
  const FromBodyFilter to_inertial{body_.q_WB(), body_.q_WB() * body_.v_AB_B_mps(),
                                   body_.accel_bias_B_mps2(), !position_known()};
  if (height_.ready()) {
    const Vector3 a_W = body_.q_WB() * a_B_mps2_;
    height_.predict(a_W.z() + config::kGravity_mps2, kStep_s);
  }
  body_.step(w_B, a_B_mps2_, velocity_measured_B(), to_body, kStep_s);
  inertial_.predict(w_B, a_B_mps2_, to_inertial, kStep_s);
  // Whatever it was that they swallowed: they fly.
  if (!body_.finite() || !inertial_.finite()) restart_aided();
}

VelocitySource Estimator::find_velocity_source() const {
  if (fix_fresh()) return VelocitySource::capture;
  if (gps_guard_.fresh()) return VelocitySource::gps;
  const bool healthy = source_ == AttitudeSource::velocity_aided && pressure_good() && field_good();
  const bool goes_on = situation_.by_drag && situation_.airborne && fix_age_ms_ < kByDrag_ms;
  return goes_on && healthy ? VelocitySource::drag : VelocitySource::none;
}

Vector3 Estimator::velocity_by_drag_W() const {
  Vector3 v_W = body_.q_WB() * body_.v_AB_B_mps() + steady_wind_W_mps_;
  v_W.z() = height_.vz_mps();
  return v_W;
}

void Estimator::step_position() {
  constexpr float kSteadyWind_s = 5.0f;
  if (velocity_source_ == VelocitySource::drag) {
    return position_.dead_reckon(velocity_by_drag_W(), baro_z_m(), kStep_s);
  }
  position_.predict(q_WB(), a_B_mps2_, kStep_s);
  heading_by_motion_.feel(q_WB() * a_B_mps2_, kStep_s);
  if (!fix_fresh()) move_by_height();
  if (!position_known()) return;
  const float share = situation_.airborne ? kStep_s / kSteadyWind_s : 1.0f;
  steady_wind_W_mps_ += share * (inertial_.wind_W_mps() - steady_wind_W_mps_);
}

__attribute__((noinline)) void Estimator::step_drag() {
  const bool flies = situation_.airborne && a_B_mps2_.z() < -kLeastThrust_mps2;
  if (!flies || !fix_fresh()) return drag_.pause();
  drag_.add(a_B_mps2_, q_WB(), position_.v_WB_W_mps());
}

// Where a component is not measured, the filter's own stands for it: no innovation.
Vector3 Estimator::velocity_measured_B() const {
  if (!situation_.airborne) return Vector3::Zero();
  Vector3 v_B = body_.v_AB_B_mps();
  const Vector3 a_B = a_B_mps2_ - body_.accel_bias_B_mps2();
  if (a_B.z() < -kLeastThrust_mps2) {
    v_B.head<2>() = velocity_through_air(a_B.head<2>() / a_B.z(), drag_.drag_spm());
  }
  const Vector3 down_B = body_.q_WB().conjugate() * Vector3::UnitZ();
  if (pressure_good() && down_B.z() > kSteepest_cos) {
    v_B.z() = (height_.vz_mps() - down_B.head<2>().dot(v_B.head<2>())) / down_B.z();
  }
  return v_B;
}

void Estimator::forget_zeros() {
  zeros_ = Zeros::unknown;
  accel_zero_B_mps2_.setZero();
  gyro_zero_B_radps_.setZero();
  explicit_.set_gyro_bias(gyro_zero_B_radps_);
  calibration_.restart();
}

// True: a window is over, and the gyro's zero point is the one of it.
bool Estimator::new_zeros(const Quaternion& q_WB) {
  if (!calibration_.add(raw_w_B_radps_, a_B_mps2_ + accel_zero_B_mps2_, q_WB)) return false;
  gyro_zero_B_radps_ = calibration_.gyro_bias_B_radps();
  explicit_.set_gyro_bias(gyro_zero_B_radps_);
  return true;
}

void Estimator::calibrate_by_capture() {
  const Quaternion q_WB = from_euler(fix_.roll_rad, fix_.pitch_rad, fix_.yaw_rad);
  if (!new_zeros(q_WB)) return;
  accel_zero_B_mps2_ = calibration_.accel_bias_B_mps2();
  if (zeros_ != Zeros::by_capture) {
    explicit_.start(q_WB.conjugate() * Vector3(0.0f, 0.0f, -config::kGravity_mps2), fix_.yaw_rad);
    position_.start(fix_.p_WB_W_m);
    restart_aided();
  }
  zeros_ = Zeros::by_capture;
}

// Upright is where the accelerometer points, and what its length is off is a zero point along that.
void Estimator::calibrate_by_gravity() {
  const Vector3 a_B_mps2 = a_B_mps2_ + accel_zero_B_mps2_;
  if (!new_zeros(Quaternion::FromTwoVectors(-a_B_mps2, Vector3::UnitZ()))) return;
  // Filter 2 has its heading from filter 1, by 0.1 /s: at rest it begins with the field's.
  inertial_.correct_heading(yaw_of(explicit_.q_WB()), kWindow_s);
  if (zeros_ == Zeros::by_capture) return;  // all three axes are known
  accel_zero_B_mps2_ = calibration_.accel_bias_B_mps2();
  if (zeros_ == Zeros::unknown) {
    explicit_.start(a_B_mps2 - accel_zero_B_mps2_, yaw_of(explicit_.q_WB()));
    restart_aided();
  }
  zeros_ = Zeros::by_gravity;
}

}  // namespace fw
