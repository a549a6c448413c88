// A GPS receiver on the vehicle as one who knows the truth sees it: how wrong it is, and where the vehicle is
// for it, in the vehicle's own frame.
//
//   In       GnssSolution at each measurement of the part; GPS_GLOBAL_ORIGIN from the vehicle
//   Out      the error stays until the next solution; NaN until there was one, and for the place until the
//            vehicle has told its origin. The axes of W and of the vehicle's frame are taken as parallel
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "base/wgs84.hpp"
#include "io_bridges/messages/messages.hpp"
#include "io_bridges/protocols/mavlink_messages.hpp"

namespace whirl::flight {

class Receiver {
 public:
  void on_solution(const io::GnssSolution& solution, std::int64_t t_ns);
  void hear(const io::MavlinkFrame& frame);

  Eigen::Vector3d error_W_m() const;
  double period_s() const { return period_s_; }  // between the two newest; NaN until there were
  // Of a vehicle that is at p_WB_W_m: north, east, down of its origin.
  Eigen::Vector3d place_m(const Eigen::Vector3d& p_WB_W_m) const;

 private:
  void place_solution();

  std::optional<io::GnssSolution> solution_;
  std::int64_t solution_ns_ = 0;
  double period_s_ = std::nan("");
  std::optional<Geodetic> origin_;
  Eigen::Vector3d solution_m_ =
      Eigen::Vector3d::Constant(std::nan(""));  // of origin_; signals ask each step
};

}  // namespace whirl::flight
