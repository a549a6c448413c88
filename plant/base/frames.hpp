// Frames and names: the one block that says them. Everything else in plant only uses the letters.
//
//   W   world: north-east-down, origin on the ground, inertial for a flight of minutes
//   B   body: forward-right-down, origin at the centre of mass
//   P   rotor: origin at the hub, axes parallel to B, thrust along -z
//   S   sensor: origin at the mounting point, axes nominally parallel to B
//   A   the air that a rotor or the body meets
//   Names   quantity_ReferenceTarget_ExpressedIn_unit: p_WB_W_m is B's origin as seen from W, in
//           W's components; adjacent letters cancel. R_WB and q_WB turn B's components into W's.
//           w_WB_B_radps: angular velocity of B against W; alpha is its derivative in B.
//   Units   SI; specific force is what an ideal accelerometer reads: (0, 0, -9.81) at rest
#pragma once

namespace whirl::plant {

inline constexpr double kGravity_mps2 = 9.80665;  // standard gravity, along +z of W

}  // namespace whirl::plant
