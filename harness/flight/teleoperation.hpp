// A person's hand that flies by velocity: a script says when to move which stick where, the hand follows.
//
//   Script   velocity over ground (frame W), height, rate of yaw; times from the begin on
//   Hand     what the script says reaches it reaction_s later; it then moves as a first-order lag of
//            0.1 s, the neuromuscular lag of a pilot's arm [McRuer, Jex 1967, T_N]
//   Rate     the stick is read, and heading integrated, at 50 Hz, as the thesis's ground station does
//            (sec. 3.6); the radio carries the newest at its own 10 Hz: 50 frames of 65 bytes a second
//            beside 40 poses are more than its 5760 B/s
#pragma once
#include <cstdint>

#include "harness/flight/set_point.hpp"
#include "harness/world/request.hpp"

namespace whirl::flight {

class Teleoperation {
 public:
  // Pre: the script is not empty. `from`: heading and height when it begins, at rest.
  Teleoperation(const request::Teleoperation& wanted, const Target& from, std::int64_t now_ns);

  SetPoint at(std::int64_t t_ns);  // in order of time

 private:
  void read_stick();
  void ask(const request::Stick& stick);

  request::Teleoperation wanted_;
  std::size_t next_ = 0;  // of the script
  std::int64_t begin_ns_, next_ns_;
  Eigen::Vector3d asked_W_mps_ = Eigen::Vector3d::Zero(), hand_W_mps_ = Eigen::Vector3d::Zero();
  double asked_height_m_, hand_height_m_;
  double asked_yaw_rate_radps_ = 0.0, hand_yaw_rate_radps_ = 0.0;
  double yaw_rad_;
};

}  // namespace whirl::flight
