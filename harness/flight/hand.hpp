// A hand that holds the vehicle: turns it smoothly to where a plan wants it, and trembles.
//
//   Moves    a minimum-jerk course each, 10 s^3 - 15 s^4 + 6 s^5 of place and of the shortest turn [Flash 1985];
//            one that begins before the last has ended adds to it [Flash 1991], so that speeds never jump
//   Tremor   of each of the six ways: sway of two sines of 0.2 to 1.2 Hz, and the physiological tremor, two
//            of 8 to 12 Hz; phases and frequencies drawn from the seed. RMS: sway 1.5 mm and 0.2 deg, tremor
//            0.025 mm (0.1 m/s^2, the order that accelerometers on hands show) and 0.01 deg. Estimates
//   Frame    W and B
//   Left out how strong a hand is: it holds whatever the rotors pull
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "plant/airframe/airframe_params.hpp"
#include "plant/vehicle.hpp"

namespace whirl::flight {

struct Grip {
  Eigen::Vector3d p_WB_W_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
};

// From the vehicle's lowest point to the floor; the propellers' discs count.
double above_floor_m(const plant::AirframeParams& airframe, const Grip& at);

class Hand {
 public:
  static constexpr double kForEver_s = std::numeric_limits<double>::infinity();

  Hand(const Grip& grip, double t_s, std::uint64_t seed);
  void move(const Grip& to, double t_s, double over_s);  // over_s above 0
  void let_go_at(double t_s) { end_s_ = t_s; }
  bool holds(double t_s) const { return t_s < end_s_; }
  bool putting_down() const { return end_s_ < kForEver_s; }
  const Grip& goal() const { return goal_; }
  Grip course(double t_s) const;  // without tremor
  plant::CarriedBody body(double t_s) const;

 private:
  struct Move {
    double start_s, over_s;
    Eigen::Vector3d way_W_m, turn_B_rad;
  };
  struct Sine {
    double w_radps, phase_rad, amplitude;
  };
  using Sines = std::array<Sine, 4>;

  Grip grip(double t_s) const;
  Eigen::Vector3d sum(const std::array<Sines, 3>& sines, double t_s) const;

  Grip from_, goal_;
  double start_s_, end_s_ = kForEver_s;
  std::vector<Move> moves_;
  std::array<Sines, 3> shift_m_, turn_rad_;
};

}  // namespace whirl::flight
