// The ground, a plane at z = 0 of W, and obstacles: what the gear and the hubs may touch.
//
//   Method  Bullet (double precision) solves the contacts of a step; free motion is not its business.
//           A step without a contact force is left to step_free().
//   Valid   steps up to 2 ms; flat rigid ground; restitution above an approach of 0.1 m/s
//   Error   bounce height e^2 h within 2 %, rest within 1e-6 m/s (tests/contact_test.cpp)
#pragma once
#include <memory>
#include <vector>

#include "plant/airframe/airframe_params.hpp"
#include "plant/airframe/obstacle.hpp"
#include "plant/airframe/rigid_body.hpp"

namespace whirl::plant {

// From the feet and hubs to what is nearest; negative: they would be in it.
double clearance_m(const AirframeParams& params, std::span<const Obstacle> obstacles,
                   const Eigen::Vector3d& p_WB_W_m, const Eigen::Quaterniond& q_WB);

// Nothing of it in the floor or in an obstacle: feet and hubs by clearance_m(), propellers by their discs.
// within_m: how far feet may be in what they stand on; negative: how far from all they must be.
bool stands_free(const AirframeParams& params, std::span<const Obstacle> obstacles,
                 const Eigen::Vector3d& p_WB_W_m, const Eigen::Quaterniond& q_WB, double within_m);

struct Touch {  // impulses of a step
  double sum_Ns = 0.0;
  double from_below_Ns = 0.0;  // of contacts whose normal is within 60 deg of straight up
};

class ContactWorld {
 public:
  explicit ContactWorld(const AirframeParams& params, const std::vector<Obstacle>& obstacles = {});
  ~ContactWorld();
  ContactWorld(ContactWorld&&) noexcept;
  ContactWorld& operator=(ContactWorld&&) noexcept;

  // Could a foot or hub touch something within this step?
  bool in_reach(const BodyState& state, double dt_s) const;

  // Steps with contact. A sum of 0 leaves `state` untouched.
  Touch step(BodyState& state, const Forcing& forcing, double dt_s);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace whirl::plant
