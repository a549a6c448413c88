// The vehicle in somebody's hands: held, turned, put down; and what is asked of it there.
#include "harness/flight/flight_world.hpp"

#include <algorithm>
#include <cmath>

#include "plant/airframe/contact_world.hpp"

namespace whirl::flight {
namespace {

constexpr double kClear_m = 0.05;     // of the floor, wherever a hand has it
constexpr double kLifted_m = 1.0;     // where no height is said and it stands
constexpr double kPutDown_m = 0.005;  // it falls the rest
constexpr double kFastest_mps = 5.0, kFastest_radps = 15.0;  // of a course, at its middle
constexpr double kCatchable_mps = 0.5, kCatchable_radps = 1.0;

double seconds(std::int64_t t_ns) {
  return static_cast<double>(t_ns) * 1e-9;
}

// A course of minimum jerk is in its middle 15/8 as fast as in the mean.
bool too_fast(const Grip& from, const Grip& to, double over_s) {
  const double way_m = (to.p_WB_W_m - from.p_WB_W_m).norm();
  const double turn_rad = from.q_WB.angularDistance(to.q_WB);
  return 1.875 * way_m > kFastest_mps * over_s || 1.875 * turn_rad > kFastest_radps * over_s;
}

const char* const kTooFast = "faster than a hand: its way and turn take longer";

}  // namespace

double FlightWorld::standing_m() const {
  return -above_floor_m(airframe_, {});
}

// within_m: as of plant::stands_free().
bool FlightWorld::free_of_obstacles(const Grip& at, double within_m) const {
  return obstacles_.empty() ||
         plant::stands_free(airframe_, obstacles_, at.p_WB_W_m, at.q_WB, within_m);
}

void FlightWorld::carry(std::int64_t t_ns) {
  if (!hand_) return;
  if (!hand_->holds(seconds(t_ns))) return hand_.reset();
  vehicle_.carry(hand_->body(seconds(t_ns)));
}

Result<Done> FlightWorld::hold_in_hand(const request::Hold& wanted, std::int64_t now_ns) {
  const plant::VehicleState& s = vehicle_.state();
  const double now_s = seconds(now_ns);
  if (has_load_) return refusal("hold", "is not for a vehicle with a load on a line");
  if (hand_ && hand_->putting_down()) {
    return refusal("hold", "it is being put down", "wait until it stands");
  }
  const bool catchable =
      s.v_WB_W_mps.norm() < kCatchable_mps && s.w_WB_B_radps.norm() < kCatchable_radps;
  if (!hand_ && !catchable) {
    return refusal("hold", "it moves too fast to be caught", "below 0.5 m/s and 1 rad/s");
  }
  const Grip start = hand_ ? hand_->goal() : Grip{s.p_WB_W_m, s.q_WB};
  Grip to{start.p_WB_W_m, Eigen::AngleAxisd(wanted.yaw_rad, Eigen::Vector3d::UnitZ()) *
                              Eigen::AngleAxisd(wanted.pitch_rad, Eigen::Vector3d::UnitY()) *
                              Eigen::AngleAxisd(wanted.roll_rad, Eigen::Vector3d::UnitX())};
  if (wanted.north_m) to.p_WB_W_m.x() = *wanted.north_m;
  if (wanted.east_m) to.p_WB_W_m.y() = *wanted.east_m;
  if (wanted.height_m) {
    to.p_WB_W_m.z() = -*wanted.height_m;
  } else if (!hand_) {
    to.p_WB_W_m.z() = std::min(to.p_WB_W_m.z(), -kLifted_m);
  }
  if (above_floor_m(airframe_, to) < kClear_m) {
    return refusal("height", "its lowest point would be within 5 cm of the floor",
                   "hold it higher");
  }
  if (too_fast(start, to, wanted.over_s)) return refusal("over", kTooFast, "5 m/s, 15 rad/s");
  Hand next = hand_ ? *hand_ : Hand(start, now_s, seed_);
  next.move(to, now_s, wanted.over_s);
  constexpr int kLooks = 100;
  for (int i = 1; i < kLooks; ++i) {
    const double share = static_cast<double>(i) / kLooks;
    const Grip at = next.course(now_s + share * wanted.over_s);
    if (above_floor_m(airframe_, at) < -kPutDown_m) {
      return refusal("hold", "on its way there it would touch the floor",
                     "lift it level first: t:hold { height = \"1 m\" }");
    }
    if (!free_of_obstacles(at, kPutDown_m)) {
      return refusal("hold", "on its way there it would touch an obstacle or a wall");
    }
  }
  if (!free_of_obstacles(to, -kPutDown_m)) {
    return refusal("hold", "it would be in an obstacle or a wall there");
  }
  hand_ = next;
  return Done{};
}

Result<Done> FlightWorld::release(const request::Release& wanted, std::int64_t now_ns) {
  if (!hand_) return refusal("release", "nobody holds it", "t:hold comes first");
  const double now_s = seconds(now_ns);
  if (!wanted.over_s) return hand_.reset(), Done{};
  const Grip at = hand_->goal();
  const double yaw_rad = roll_pitch_yaw_rad(at.q_WB).z();
  const Grip down{{at.p_WB_W_m.x(), at.p_WB_W_m.y(), -standing_m() - kPutDown_m},
                  Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()))};
  if (too_fast(at, down, *wanted.over_s)) return refusal("over", kTooFast, "5 m/s, 15 rad/s");
  if (!free_of_obstacles(down, 0.0)) {
    return refusal("release", "there is an obstacle where it would be put down");
  }
  hand_->move(down, now_s, *wanted.over_s);
  hand_->let_go_at(now_s + *wanted.over_s);
  return Done{};
}

// param 1 gyroscope, 2 magnetometer, 5 accelerometer, 6 the motors' fields ("compassmot"); none: stop it.
void FlightWorld::calibrate(const request::Calibrate& command) {
  std::array<float, 7> param{};
  switch (command.what) {
    case request::Calibration::gyroscope:
      param[0] = 1.0f;
      break;
    case request::Calibration::magnetometer:
      param[1] = 1.0f;
      break;
    case request::Calibration::accelerometer:
      param[4] = 1.0f;
      break;
    case request::Calibration::motor_fields:
      param[5] = 1.0f;
      break;
    case request::Calibration::cancel:
      break;
  }
  estimates_.await_calibration();
  station_.command(kPreflightCalibration, param);
}

}  // namespace whirl::flight
