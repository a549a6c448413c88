// The ground: a plane at z = 0 of W that the gear and the hubs may touch.
//
//   Method  Bullet (double precision) solves the contacts of a step; free motion is not its business.
//           A step without a contact force is left to step_free().
//   Valid   steps up to 2 ms; flat rigid ground; restitution above an approach of 0.1 m/s
//   Error   bounce height e^2 h within 2 %, rest within 1e-6 m/s (tests/contact_test.cpp)
#pragma once
#include <memory>

#include "plant/airframe/airframe_params.hpp"
#include "plant/airframe/rigid_body.hpp"

namespace whirl::plant {

class ContactWorld {
 public:
  explicit ContactWorld(const AirframeParams& params);
  ~ContactWorld();
  ContactWorld(ContactWorld&&) noexcept;
  ContactWorld& operator=(ContactWorld&&) noexcept;

  // Could a foot touch the ground within this step?
  bool in_reach(const BodyState& state, double dt_s) const;

  // Steps with contact. Returns the impulse of the ground; 0 leaves `state` untouched.
  double step(BodyState& state, const Forcing& forcing, double dt_s);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace whirl::plant
