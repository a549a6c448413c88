#include "harness/flight/hand.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "base/random.hpp"

namespace whirl::flight {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kTwoPi = 6.283185307179586;
constexpr double kSway_m = 1.5e-3, kSway_rad = 0.2 * kTwoPi / 360.0;
constexpr double kTremor_m = 2.5e-5, kTremor_rad = 0.01 * kTwoPi / 360.0;
constexpr double kTakesHold_s = 0.5;
constexpr double kHalf_s = 5e-4;  // differences are taken over so much to either side

Quaterniond turn(const Vector3d& by_rad) {
  const double angle = by_rad.norm();
  if (angle < 1e-12) return Quaterniond::Identity();
  return Quaterniond(Eigen::AngleAxisd(angle, by_rad / angle));
}

// The shortest.
Vector3d turn_between_rad(const Quaterniond& from, const Quaterniond& to) {
  Quaterniond q = from.conjugate() * to;
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const Eigen::AngleAxisd a(q);
  return a.angle() * a.axis();
}

double minimum_jerk(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
}

}  // namespace

double above_floor_m(const plant::AirframeParams& airframe, const Grip& at) {
  double lowest_m = std::numeric_limits<double>::infinity();
  for (const Vector3d& foot_B_m : airframe.contact.gear_B_m) {
    const double z_m = (at.p_WB_W_m + at.q_WB * foot_B_m).z();
    lowest_m = std::min(lowest_m, -z_m - airframe.contact.foot_radius_m);
  }
  const double along_z = (at.q_WB * Vector3d::UnitZ()).z();
  const double slope = std::sqrt(std::max(0.0, 1.0 - along_z * along_z));
  for (const plant::RotorMount& rotor : airframe.rotors) {
    const double z_m = (at.p_WB_W_m + at.q_WB * rotor.p_BP_B_m).z();
    lowest_m = std::min(lowest_m, -z_m - rotor.radius_m * slope);
  }
  return lowest_m;
}

Hand::Hand(const Grip& grip, double t_s, std::uint64_t seed)
    : from_(grip), goal_(grip), start_s_(t_s) {
  RandomStream chance(seed, "hand");
  const auto draw = [&chance](Sines& sines, double sway, double tremor) {
    for (std::size_t i = 0; i < sines.size(); ++i) {
      const bool slow = i < 2;  // two sines of this amplitude have the RMS that is asked for
      const double low_Hz = slow ? 0.2 : 8.0, high_Hz = slow ? 1.2 : 12.0;
      sines[i] = {kTwoPi * (low_Hz + (high_Hz - low_Hz) * chance.uniform()),
                  kTwoPi * chance.uniform(), slow ? sway : tremor};
    }
  };
  for (Sines& sines : shift_m_) draw(sines, kSway_m, kTremor_m);
  for (Sines& sines : turn_rad_) draw(sines, kSway_rad, kTremor_rad);
}

void Hand::move(const Grip& to, double t_s, double over_s) {
  WHIRL_CHECK(over_s > 0.0, over_s);
  moves_.push_back(
      {t_s, over_s, to.p_WB_W_m - goal_.p_WB_W_m, turn_between_rad(goal_.q_WB, to.q_WB)});
  goal_ = to;
}

Grip Hand::course(double t_s) const {
  Grip now = from_;
  for (const Move& move : moves_) {
    const double share = minimum_jerk((t_s - move.start_s) / move.over_s);
    now.p_WB_W_m += share * move.way_W_m;
    now.q_WB = now.q_WB * turn(share * move.turn_B_rad);
  }
  return now;
}

Vector3d Hand::sum(const std::array<Sines, 3>& sines, double t_s) const {
  Vector3d all = Vector3d::Zero();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const Sine& s : sines[axis]) {
      all[static_cast<Eigen::Index>(axis)] += s.amplitude * std::sin(s.w_radps * t_s + s.phase_rad);
    }
  }
  return all;
}

Grip Hand::grip(double t_s) const {
  Grip now = course(t_s);
  const double share = minimum_jerk((t_s - start_s_) / kTakesHold_s);
  now.p_WB_W_m += share * sum(shift_m_, t_s);
  now.q_WB = now.q_WB * turn(share * sum(turn_rad_, t_s));
  return now;
}

plant::CarriedBody Hand::body(double t_s) const {
  const Grip before = grip(t_s - kHalf_s), now = grip(t_s), after = grip(t_s + kHalf_s);
  return {.p_WB_W_m = now.p_WB_W_m,
          .v_WB_W_mps = (after.p_WB_W_m - before.p_WB_W_m) / (2.0 * kHalf_s),
          .q_WB = now.q_WB.normalized(),
          .w_WB_B_radps = turn_between_rad(before.q_WB, after.q_WB) / (2.0 * kHalf_s)};
}

}  // namespace whirl::flight
