#include "firmware/calibration/magnetometer_calibration.hpp"

namespace fw {
namespace {

constexpr float kUnit_uT = 50.0f;     // that the sphere is summed in
constexpr float kTurned_uT = 2.5f;    // some 2.5 degrees
constexpr std::uint32_t kRough = 60;  // samples of the sphere
constexpr std::uint8_t kPerCell = 14, kEnough = 3;
constexpr float kWeakest_uT = 20.0f, kStrongest_uT = 70.0f, kMostResidual = 0.03f;
constexpr float kStretched = 1.4f;

// Of the cube about the centre: face by the longest component, its square by the other two.
unsigned cell_of(const Vector3& direction) {
  Eigen::Index axis = 0;
  const float longest = direction.cwiseAbs().maxCoeff(&axis);
  const unsigned face = 2 * static_cast<unsigned>(axis) + (direction[axis] < 0.0f ? 1 : 0);
  const auto third = [longest](float component) {
    // Thirds of the angle, not of the edge: cells of about the same size.
    const float share = std::atan2(component, longest) / (0.25f * kPi);
    return share < -1.0f / 3.0f ? 0u : share > 1.0f / 3.0f ? 2u : 1u;
  };
  return 9 * face + 3 * third(direction[(axis + 1) % 3]) + third(direction[(axis + 2) % 3]);
}

// The symmetric root of a matrix near the identity; false: it has none.
bool square_root(const Matrix3& A, Matrix3& root) {
  Matrix3 y = A, z = Matrix3::Identity();
  for (int i = 0; i < 8; ++i) {
    if (!(y.determinant() > 1e-3f && z.determinant() > 1e-3f)) return false;
    const Matrix3 next = 0.5f * (y + z.inverse());
    z = 0.5f * (z + y.inverse()).eval();
    y = next;
  }
  root = 0.5f * (y + y.transpose());
  return (root * root - A).cwiseAbs().maxCoeff() < 1e-3f;
}

}  // namespace

void MagnetometerCalibration::start() {
  *this = {};
  sums_.start(4);
}

bool MagnetometerCalibration::add(const Vector3& m_B_uT) {
  if (sums_.count() == 0 && !centred_) {
    first_uT_ = low_uT_ = high_uT_ = m_B_uT;
  } else if ((m_B_uT - last_uT_).norm() < kTurned_uT) {
    return false;
  }
  last_uT_ = m_B_uT;
  return centred_ ? add_to_ellipsoid(m_B_uT) : find_centre(m_B_uT);
}

bool MagnetometerCalibration::find_centre(const Vector3& m_B_uT) {
  const Vector3 u = (m_B_uT - first_uT_) / kUnit_uT;
  const float y = u.squaredNorm();
  sums_.add(std::array{2.0f * u.x(), 2.0f * u.y(), 2.0f * u.z(), 1.0f}, {&y, 1});
  low_uT_ = low_uT_.cwiseMin(m_B_uT);
  high_uT_ = high_uT_.cwiseMax(m_B_uT);
  LeastSquares::Solution p{};
  if (sums_.count() < kRough || !sums_.solve(0, p)) return false;
  const Vector3 c(p[0], p[1], p[2]);
  const float radius_uT = kUnit_uT * std::sqrt(std::max(p[3] + c.squaredNorm(), 0.0f));
  const bool curved = (high_uT_ - low_uT_).minCoeff() > 0.6f * radius_uT;
  if (!curved || radius_uT < 0.5f * kWeakest_uT || radius_uT > 2.0f * kStrongest_uT) return false;
  centre_uT_ = first_uT_ + kUnit_uT * c;
  radius_uT_ = radius_uT;
  centred_ = true;
  sums_.start(9);
  return true;
}

bool MagnetometerCalibration::add_to_ellipsoid(const Vector3& m_B_uT) {
  const Vector3 u = (m_B_uT - centre_uT_) / radius_uT_;
  std::uint8_t& in_cell = in_cell_[cell_of(u)];
  if (in_cell >= kPerCell) return false;
  ++in_cell;
  const Vector3 uu = u.cwiseAbs2();
  const float y = uu.sum() - 1.0f;
  sums_.add(std::array{uu.x() + uu.y() - 2.0f * uu.z(), uu.x() - 2.0f * uu.y() + uu.z(),
                       2.0f * u.x() * u.y(), 2.0f * u.x() * u.z(), 2.0f * u.y() * u.z(),
                       2.0f * u.x(), 2.0f * u.y(), 2.0f * u.z(), 1.0f},
            {&y, 1});
  return in_cell == kEnough;
}

unsigned MagnetometerCalibration::cells_seen() const {
  unsigned seen = 0;
  for (const std::uint8_t in_cell : in_cell_) seen += in_cell >= kEnough ? 1 : 0;
  return seen;
}

bool MagnetometerCalibration::seen_enough() const {
  for (unsigned face = 0; face < 6; ++face) {
    unsigned seen = 0;
    for (unsigned i = 0; i < 9; ++i) seen += in_cell_[9 * face + i] >= kEnough ? 1 : 0;
    if (seen < 5) return false;
  }
  return cells_seen() >= kCellsWanted;
}

bool MagnetometerCalibration::solve(Vector3& centre_B_uT, Matrix3& W) const {
  LeastSquares::Solution p{};
  if (!centred_ || !sums_.solve(0, p)) return false;
  // |u|^2 - 1 is twice what the radius is off.
  const float left = sums_.left_over(0, p) / static_cast<float>(sums_.count());
  if (!(0.5f * std::sqrt(left) < kMostResidual)) return false;
  Matrix3 A;
  A << 1.0f - p[0] - p[1], -p[2], -p[3],        //
      -p[2], 1.0f - p[0] + 2.0f * p[1], -p[4],  //
      -p[3], -p[4], 1.0f + 2.0f * p[0] - p[1];
  const Vector3 v(p[5], p[6], p[7]);
  if (!(A.determinant() > 0.1f)) return false;
  const Vector3 c = A.inverse() * v;
  const float square = 1.0f + p[8] + c.dot(v);
  Matrix3 root;
  if (!(square > 0.1f) || !square_root(A / square, root)) return false;
  const float radius = 3.0f / root.trace();  // a mean of the axes'
  const float field_uT = radius * radius_uT_;
  const Matrix3 bend = radius * root;
  const bool possible = field_uT > kWeakest_uT && field_uT < kStrongest_uT &&
                        bend.diagonal().minCoeff() > 1.0f / kStretched &&
                        bend.diagonal().maxCoeff() < kStretched;
  if (!possible) return false;
  centre_B_uT = centre_uT_ + radius_uT_ * c;
  W = bend;
  return true;
}

}  // namespace fw
