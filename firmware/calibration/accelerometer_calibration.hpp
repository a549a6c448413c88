// Zero points and scales of the accelerometer from six positions, each face up once, in any order.
//
//   Model    f = s (a - o), axis by axis: a as read, f specific force [after AN4399: gains and offsets alone]
//   Method   of each position the mean over 1.2 s held still. At rest |f| = g, however exactly the face points
//            up: sum_i s_i^2 (a_ki - o_i)^2 = g^2, k = 1..6, six equations for six unknowns, solved by
//            Newton from o_i = (a+ + a-) / 2, s_i = 2 g / (a+ - a-)
//   Refused  what no part within its data sheet has: zero point at 25 degC +-50 mg along x and y, +-80 mg
//            along z, by temperature +-35 and +-60 mg more; sensitivity +-3 %, and 2 % for temperature and
//            nonlinearity [MPU-6000 rev 3.4, table 6.2]
//   Left out axes that are not square to each other (data sheet: +-2 % cross-axis): that takes more positions
//   Error    tests/calibration_test.cpp; in flight test_plans/flight/calibrations.lua
#pragma once
#include <array>

#include "firmware/calibration/still_window.hpp"
#include "firmware/math.hpp"

namespace fw {

class AccelerometerCalibration {
 public:
  static constexpr unsigned kSides = 6;
  enum class Side : std::uint8_t {  // what points up
    nose,
    tail,
    right_side,
    left_side,
    belly,
    top,
    none
  };

  void start() { *this = {}; }
  // The side that this sample has completed, or none.
  Side add(const Vector3& a_B_mps2, const Vector3& w_B_radps);
  unsigned sides_done() const { return done_; }
  // Of six sides. False: no solution, or beyond the data sheet.
  bool solve(Vector3& offset_B_mps2, Vector3& scale) const;

 private:
  std::array<Vector3, kSides> mean_B_mps2_{};  // by Side
  std::array<bool, kSides> have_{};
  unsigned done_ = 0;
  StillWindow window_;
};

}  // namespace fw
