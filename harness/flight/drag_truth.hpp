// The drag coefficient that the vehicle really has, as flown: of the plant's forces, not of its parameters.
//
//   Out      c of the least squares of f_xy = -c (-f_z) v_xy over the last 20 s (exponential window), with f
//            the specific force in B (along z the thrust's) and v the velocity through the air: what
//            blades and rotor_drag_s_per_m give together at the speeds flown. What the frame's areas
//            add by the square of speed is no such coefficient, and is taken off f first
//   Valid    in the air, tilted or not; NaN until there was some air speed (1 m/s for 2 s, or 0.2 m/s for 50 s)
#pragma once
#include "plant/vehicle.hpp"

namespace whirl::flight {

class DragTruth {
 public:
  explicit DragTruth(const plant::AirframeParams& airframe) : airframe_(airframe) {}
  void step(const plant::VehicleState& truth, double dt_s);
  double coefficient_spm() const;

 private:
  plant::AirframeParams airframe_;
  double force_speed_ = 0.0, speed2_ = 0.0;  // decaying integrals of the normal equation
};

}  // namespace whirl::flight
