// Height and vertical speed from the barometer's pressure and the accelerometer.
//
//   Frame    z and vz along W's third axis, so down is positive; z is 0 where zero() was called
//   Source   z' = vz - k4 (z - zm), vz' = e3'(R a) + g - b - k5 (z - zm), b' = k6 (z - zm)
//            [Bangura 2017, 6.12]; zm by the standard atmosphere's gradient at the pressure of zero()
//   Nonsense a height more than 5 m off is not believed. One that leapt there from one reading to the next and then holds for
//            a second is the old height by another zero, for no vehicle leaps; unless it is over 3 s since a reading was
//            believed. One that came there by and by, or so late, and holds for a second is where the filter starts anew
//   Gains    a triple pole at 0.8 rad/s: noise of 10 cm a sample leaves 3 cm and 4 cm/s
//   Valid    within some hundred metres of the place of zero()
#pragma once
#include "firmware/math.hpp"

namespace fw {

class HeightFilter {
 public:
  // Here and now is z = 0, at rest.
  void zero(float pressure_Pa);
  // a_down: acceleration along W's third axis without gravity, thus 0 at rest.
  void predict(float a_down_mps2, float dt_s);
  // A pressure, since_last_s after the one before.
  void correct(float pressure_Pa, float since_last_s);

  bool ready() const { return ready_; }
  // The last reading was within 5 m of where the filter was.
  bool believes() const { return doubted_s_ <= 0.0f; }
  // What the pressure has lent the vertical speed within some five seconds that the accelerometer did not feel.
  float drawn_mps() const { return drawn_mps_; }
  float z_m() const { return z_m_; }
  float vz_mps() const { return vz_mps_; }
  float bias_mps2() const { return bias_mps2_; }

 private:
  [[gnu::cold]] void doubt(float error_m, float dt_s);

  bool ready_ = false;
  float doubted_s_ = 0.0f;  // how long readings that hold have not been believed
  float since_believed_s_ = 0.0f;
  float last_error_m_ = 0.0f;  // of the reading before
  bool leapt_ = false;
  float drawn_mps_ = 0.0f;
  float zero_m_ = 0.0f, z_m_ = 0.0f, vz_mps_ = 0.0f, bias_mps2_ = 0.0f;
};

}  // namespace fw
