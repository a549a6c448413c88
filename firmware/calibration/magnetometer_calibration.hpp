// Hard and soft iron of the magnetometer, from a vehicle that is turned through the whole sphere.
//
//   Model    b = W (m - c): m as read, b a field of one length. c is what the frame adds (hard iron); W, symmetric
//            and of trace 3, undoes how it bends and how the axes' gains differ (soft iron)
//   Method   1 a sphere through the first samples, |u|^2 = 2 u'c + (r^2 - |c|^2), [AN4246, section 4, its
//              four-parameter model]: roughly the centre, about which the rest is summed
//            2 an ellipsoid u'A u - 2 v'u = i with trace(A) = 3 [AN4246's ten parameters, normalised so that
//              they are linear: Turner, Anderson, Mason 1999]; c = A^-1 v,
//              W = sqrt(A / (i + c'v)) by Denman and Beavers' iteration
//   Sums     normal equations of 4, then of 9 unknowns about that centre: no sample is kept. A sample
//            counts if the field has turned since the last and its cell of the sphere (54: the faces of a
//            cube, 3 x 3 each) is not full, so that no pose weighs more than another
//   Refused  too little of the sphere (44 of 54 cells, 5 of 9 on each face); a residual of more than 3 % RMS;
//            a field that the earth has nowhere (20 to 70 uT); axes that differ by a factor of 1.4
//   Error    tests/calibration_test.cpp; in flight test_plans/flight/calibrations.lua
#pragma once
#include <array>
#include <cstdint>

#include "firmware/calibration/least_squares.hpp"
#include "firmware/math.hpp"

namespace fw {

class MagnetometerCalibration {
 public:
  static constexpr unsigned kCells = 54, kCellsWanted = 44;

  void start();
  // True: a part of the sphere was seen that was not before.
  bool add(const Vector3& m_B_uT);
  bool seen_enough() const;
  unsigned cells_seen() const;

  // False: the samples are not of one field on an ellipsoid.
  bool solve(Vector3& centre_B_uT, Matrix3& W) const;

 private:
  bool find_centre(const Vector3& m_B_uT);
  bool add_to_ellipsoid(const Vector3& m_B_uT);

  LeastSquares sums_;
  bool centred_ = false;
  Vector3 first_uT_ = Vector3::Zero(), last_uT_ = Vector3::Zero();
  Vector3 low_uT_ = Vector3::Zero(), high_uT_ = Vector3::Zero();
  Vector3 centre_uT_ = Vector3::Zero();
  float radius_uT_ = 0.0f;
  std::array<std::uint8_t, kCells> in_cell_{};
};

}  // namespace fw
