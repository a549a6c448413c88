// All that is estimated of the vehicle's motion, from what its sensors say.
//
//   Rates    on_imu 1 kHz, step 200 Hz, pressures 75 Hz, fields 75 Hz, fixes as they come, GPS 5 Hz
//   Filters  all run all the time; choose() says whose attitude is flown by:
//            explicit  quaternion filter (attitude_filter.hpp), heading from the capture system
//            aided     velocity-aided filters 1 and 2 (body_filter.hpp, inertial_filter.hpp): the
//                      attitude of filter 2 while it has a velocity over ground, else that of filter 1
//   Ground   while it rests, with the capture system's attitude, the IMU's zero points are found
//            anew each second; the barometer's zero follows the pressure
//   Outdoors without capture. Position: GPS along the floor, the barometer's height, which GPS draws by
//            1/600 s; W's origin: gps_frame.hpp. Velocity: GPS. Heading: the magnetic field, by filter 1 and
//            the explicit filter. Zero points: the gyro's; of the accelerometer only its length at rest, so
//            that what its level axes are off stays in the attitude (0.15 m/s2: 0.9 degrees), but for what a
//            calibration has taken off
//   Both     while there is capture, GPS counts nothing, nor after it: its frame would be another one
#pragma once
#include <cstdint>

#include "firmware/estimation/attitude_filter.hpp"
#include "firmware/estimation/body_filter.hpp"
#include "firmware/estimation/capture_guard.hpp"
#include "firmware/estimation/drag_identification.hpp"
#include "firmware/estimation/field_guard.hpp"
#include "firmware/estimation/gps_frame.hpp"
#include "firmware/estimation/gps_guard.hpp"
#include "firmware/estimation/ground_calibration.hpp"
#include "firmware/estimation/heading_by_motion.hpp"
#include "firmware/estimation/height_filter.hpp"
#include "firmware/estimation/inertial_filter.hpp"
#include "firmware/estimation/position_filter.hpp"
#include "firmware/math.hpp"

namespace fw {

struct ImuSample {
  Vector3 a_B_mps2 = Vector3::Zero(), w_B_radps = Vector3::Zero();
  float temperature_degC = 0.0f;
};

struct CaptureFix {
  Vector3 p_WB_W_m = Vector3::Zero();
  float roll_rad = 0.0f, pitch_rad = 0.0f, yaw_rad = 0.0f;
};

enum class AttitudeSource : std::uint8_t { explicit_filter = 0, velocity_aided = 1 };

// Where the velocity over ground comes from that is flown by.
enum class VelocitySource : std::uint8_t {
  none,     // the accelerometer, for as long as that is good
  capture,  // fixes
  drag,     // filter 1's velocity through the air and the wind as it was when the fixes went; the
            // barometer's height; the magnetic field's heading. Position is what that adds up to
  gps,      // its solutions
};

// What the flight logic knows of the moment.
struct Situation {
  bool in_flight = false;  // the rotors carry, or shall
  bool airborne = false;   // off the ground
  bool by_drag = false;    // goes on without fixes, by drag
  bool resting = true;     // disarmed, no rotor turns, samples change
};

class Estimator {
 public:
  static constexpr float kStep_s = 0.005f;
  static constexpr std::uint32_t kNever = 1'000'000;
  static constexpr std::uint32_t kFixFresh_ms = 200, kFixLost_ms = 500;
  static constexpr std::uint32_t kByDrag_ms = 60'000;  // as long as the wind may be taken to stay

  [[gnu::cold]] Estimator();  // cold: small before fast, once

  void tick();  // each millisecond, before what came in it
  void on_imu(const ImuSample& sample);
  void on_fix(const CaptureFix& fix);
  [[gnu::cold]] void on_gps(const GpsSolution& solution);  // 5 Hz
  void on_pressure(float pressure_Pa);
  void on_field(const Vector3& field_B_uT);
  void step(const Situation& situation);

  // Samples are corrected otherwise from now on: zero points are found anew.
  void forget_zeros();

  void choose(AttitudeSource source) { source_ = source; }
  void set_declination(float declination_rad) { declination_rad_ = declination_rad; }
  // How filters 1 and 2 start: with this scale, tilted by this much about the nose from the explicit
  // filter's attitude. A change starts them anew, unless the vehicle is armed and flies by them.
  void set_start(float scale, float tilt_rad);

  // The drag coefficient to begin with; a change begins anew, unless it is what was identified.
  void set_drag(float drag_spm);

  const Quaternion& q_WB() const;
  const Vector3& w_WB_B_radps() const { return explicit_.w_WB_B_radps(); }
  const Vector3& p_WB_W_m() const { return position_.p_WB_W_m(); }
  const Vector3& v_WB_W_mps() const { return position_.v_WB_W_mps(); }
  VelocitySource velocity_source() const { return velocity_source_; }

  // What is flown by has settled: latent scales near 1, both velocity-aided attitudes of one mind.
  bool converged() const;
  bool fix_fresh() const { return fix_age_ms_ < kFixLost_ms; }
  // Where it is along the floor, and how fast it moves, by capture or GPS.
  bool position_known() const { return fix_fresh() || gps_guard_.fresh(); }
  // To be armed with: the same, and settled at rest.
  bool position_good() const;
  bool position_settled() const;
  std::uint32_t fix_age_ms() const { return fix_age_ms_; }
  bool calibrated() const {
    return zeros_ == Zeros::by_capture || (zeros_ == Zeros::by_gravity && !fix_fresh());
  }
  // Came within the last 0.2 s.
  bool pressure_fresh() const { return pressure_age_ms_ < kSlowSensorLost_ms; }
  bool field_fresh() const { return field_age_ms_ < kSlowSensorLost_ms; }
  // The same, and is believed: what height and heading go by.
  bool pressure_good() const { return pressure_fresh() && height_.believes() && !climb_doubted_; }
  bool field_good() const { return field_fresh() && field_guard_.fresh(); }
  float pressure_Pa() const { return pressure_Pa_; }
  const Vector3& field_B_uT() const { return field_B_uT_; }
  // How often the motion has shown that the heading was wrong, and turned it.
  std::uint32_t heading_turns() const { return heading_turns_; }
  const ImuSample& imu() const { return sample_; }
  const GpsSolution& gps() const { return gps_; }
  const GpsFrame& gps_frame() const { return gps_frame_; }

  const AttitudeFilter& explicit_filter() const { return explicit_; }
  const BodyFilter& body() const { return body_; }
  const InertialFilter& inertial() const { return inertial_; }
  const DragIdentification& drag() const { return drag_; }
  // Down from where the flight began; offset by what the capture system has taught.
  float baro_z_m() const { return height_.z_m() - height_offset_m_; }
  float baro_vz_mps() const { return height_.vz_mps(); }

 private:
  static constexpr std::uint32_t kSlowSensorLost_ms = 200;
  static constexpr float kClimbOff_s = 0.5f;

  void restart_aided();
  void step_explicit(const Vector3& w_B);
  void step_aided(const Vector3& w_B);
  bool new_zeros(const Quaternion& q_WB);
  void calibrate_by_capture();
  void calibrate_by_gravity();
  void move_by_height();
  void step_drag();
  void step_position();
  VelocitySource find_velocity_source() const;
  Vector3 velocity_by_drag_W() const;
  Vector3 velocity_measured_B() const;
  bool plausible(const CaptureFix& fix) const;
  bool pressure_drawn() const { return std::abs(height_.drawn_mps()) > 0.4f; }
  void compare_climb(float gps_vz_mps, float since_last_s);
  [[gnu::cold]] void turn_heading(float by_rad);
  void correct_velocity(const CaptureFix& fix, float since_last_s);

  AttitudeFilter explicit_;
  PositionFilter position_;
  GroundCalibration calibration_;
  HeightFilter height_;
  BodyFilter body_;
  InertialFilter inertial_;
  DragIdentification drag_;
  AttitudeSource source_ = AttitudeSource::explicit_filter;
  Situation situation_;
  VelocitySource velocity_source_ = VelocitySource::none;
  Vector3 steady_wind_W_mps_ = Vector3::Zero();  // of the last seconds with fixes

  ImuSample sample_;
  Vector3 a_sum_ = Vector3::Zero(), w_sum_ = Vector3::Zero();
  int sum_count_ = 0;
  Vector3 a_B_mps2_ = Vector3::Zero(), raw_w_B_radps_ = Vector3::Zero();
  Vector3 accel_zero_B_mps2_ = Vector3::Zero(), gyro_zero_B_radps_ = Vector3::Zero();
  bool started_ = false;
  enum class Zeros : std::uint8_t { unknown, by_gravity, by_capture } zeros_ = Zeros::unknown;

  CaptureFix fix_;
  CaptureGuard capture_guard_;
  std::uint32_t fix_age_ms_ = kNever, still_fixes_ = 0;
  Vector3 capture_v_W_mps_ = Vector3::Zero();
  GpsFrame gps_frame_;
  GpsGuard gps_guard_;
  GpsSolution gps_;
  float pressure_Pa_ = 0.0f, resting_Pa_ = 0.0f, height_offset_m_ = 0.0f;
  std::uint32_t pressure_age_ms_ = kNever, field_age_ms_ = kNever;
  float climb_off_s_ = 0.0f;  // for how long the barometer has climbed otherwise than the receiver
  bool climb_doubted_ = false;  // until it rests
  FieldGuard field_guard_;
  HeadingByMotion heading_by_motion_;
  std::uint32_t heading_turns_ = 0;
  Vector3 field_B_uT_ = Vector3::Zero();
  float declination_rad_ = 0.0f, start_scale_ = 1.0f, start_tilt_rad_ = 0.0f;
  float start_drag_spm_ = 0.0f;
};

}  // namespace fw
