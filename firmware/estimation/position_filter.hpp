// Position and velocity between and through the fixes of the capture system or of a GPS receiver.
//
//   Model   velocity from the accelerometer turned into W; position from velocity; the accelerometer's
//           error in W (tilt, bias) as a slow state. Fixes correct all three: a Luenberger observer,
//           with capture of a triple pole
//   Fixes   are late (capture, radio): each is compared with where the filter was kFixDelay_s ago
//   Left    what the cameras and their computer take is told by nobody, and not made up for: where that is
//           8 ms, place is 7 ms behind (flown along the figure 8, both periods)
//   GPS     place and velocity as they were delay_s ago. The place counts 5 /s, so at 5 Hz in full: the
//           vehicle goes where its receiver's error goes; 4 /s2 of it go to the velocity, which the
//           receiver's own draws by 3 /s. A place that leaps by 20 cm a solution costs 7 degrees of tilt.
//           Its height counts nothing here (Estimator::on_gps); without a barometer the height goes on by
//           the velocity downwards
//   Source  p' = v - k(p - p_meas) [Bangura 2017, 6.3]; gains from the pole
#pragma once
#include <array>

#include "firmware/math.hpp"

namespace fw {

class PositionFilter {
 public:
  static constexpr float kLongestDelay_s = 0.3f;

  void start(const Vector3& p_WB_W_m);
  void predict(const Quaternion& q_WB, const Vector3& a_B_mps2, float dt_s);
  void correct(const Vector3& p_WB_W_m, float since_last_fix_s);
  // Without fixes: along a velocity that something else knows, at a height that something else knows.
  void dead_reckon(const Vector3& v_WB_W_mps, float z_m, float dt_s);
  void resume(const Vector3& p_WB_W_m);           // the first fix after a gap: the velocity stays
  void hold_still();                              // standing on the ground: the velocity is zero
  void forget_bias() { bias_W_mps2_.setZero(); }  // it was reckoned with another heading

  struct Innovation {
    Vector3 p_W_m, v_W_mps;
  };
  // Of a place and a velocity as they were delay_s ago.
  Innovation gps_innovation(const Vector3& p_WB_W_m, const Vector3& v_WB_W_mps,
                            float delay_s) const;
  void correct_by_gps(const Innovation& innovation, float since_last_s);
  // After a gap: what it was off is taken over at once, but for the height.
  void shift(const Innovation& innovation);
  void set_height(float z_m, float vz_mps);

  const Vector3& p_WB_W_m() const { return p_W_m_; }
  const Vector3& v_WB_W_mps() const { return v_W_mps_; }
  const Vector3& innovation_W_m() const { return innovation_W_m_; }

 private:
  static constexpr float kFixDelay_s = 0.010f;  // 44 bytes at 57600 baud, and half a poll
  static constexpr unsigned kHistory = 64;      // steps of 5 ms
  struct Moment {
    Vector3 p_W_m = Vector3::Zero(), v_W_mps = Vector3::Zero();
  };

  Vector3 p_W_m_ = Vector3::Zero(), v_W_mps_ = Vector3::Zero(), bias_W_mps2_ = Vector3::Zero();
  Vector3 innovation_W_m_ = Vector3::Zero();
  std::array<Moment, kHistory> history_{};
  unsigned newest_ = 0;
};

}  // namespace fw
