#include "harness/flight/receiver.hpp"

namespace whirl::flight {
namespace {

constexpr double kRad_per_e7 = M_PI / 180.0 * 1e-7;

Eigen::Vector3d nothing() {
  return Eigen::Vector3d::Constant(std::nan(""));
}

// From one place to another, along north, east and down of the first.
Eigen::Vector3d ned_m(const Geodetic& from, const Geodetic& to) {
  const auto a = ecef_m(from), b = ecef_m(to);
  Eigen::Vector3d ned;
  for (unsigned axis = 0; axis < 3; ++axis) {
    std::array<double, 3> unit{};
    unit[axis] = 1.0;
    const auto along = ned_in_ecef(from, unit);
    ned[axis] = along[0] * (b[0] - a[0]) + along[1] * (b[1] - a[1]) + along[2] * (b[2] - a[2]);
  }
  return ned;
}

}  // namespace

void Receiver::hear(const io::MavlinkFrame& frame) {
  const auto told = io::unpack<io::GpsGlobalOrigin>(frame);
  if (!told) return;
  origin_ = {kRad_per_e7 * told->latitude, kRad_per_e7 * told->longitude, 1e-3 * told->altitude};
  place_solution();
}

void Receiver::on_solution(const io::GnssSolution& solution, std::int64_t t_ns) {
  if (solution_) period_s_ = 1e-9 * static_cast<double>(t_ns - solution_ns_);
  solution_ns_ = t_ns;
  solution_ = solution;
  place_solution();
}

void Receiver::place_solution() {
  if (!solution_ || !origin_) return;
  const Geodetic seen{solution_->latitude_rad, solution_->longitude_rad, solution_->height_m};
  solution_m_ = ned_m(*origin_, seen);
}

Eigen::Vector3d Receiver::error_W_m() const {
  return solution_ ? Eigen::Vector3d(solution_->p_error_W_m) : nothing();
}

Eigen::Vector3d Receiver::place_m(const Eigen::Vector3d& p_WB_W_m) const {
  if (!solution_ || !origin_) return nothing();
  // The same error, and where the vehicle has moved since.
  return solution_m_ + p_WB_W_m + error_W_m() - Eigen::Vector3d(solution_->p_WB_W_m);
}

}  // namespace whirl::flight
