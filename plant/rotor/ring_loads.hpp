// Blade-element loads of one ring, averaged over a revolution.
//
//   Frame   P as in rotor.hpp. theta is the azimuth from x_P (forward) towards y_P (right); the blade
//           moves along e_t = s (sin theta, -cos theta), s the spin sign. Up is -z_P.
//   Source  [Thesis, 4.2] with its errata; [Leishman, ch. 3]
#pragma once
#include "plant/rotor/blade_rings.hpp"

namespace whirl::plant {

// First harmonic about the shaft: mean + c cos(theta) + s sin(theta).
struct Harmonic {
  double mean = 0.0;
  double c = 0.0;
  double s = 0.0;
};

// What is the same for all rings.
struct DiscFlow {
  double spin = 1.0;
  double omega_radps = 0.0;  // of the blades against the air's own axes (body yaw included)
  double vx_mps = 0.0;       // hub through the air
  double vy_mps = 0.0;
  double climb_mps = 0.0;  // air that comes down through the disc without induction
  double p_radps = 0.0;
  double q_radps = 0.0;
  double density_kgpm3 = 1.225;
  double viscosity_Pas = 1.81e-5;
  double tip_radius_m = 1.0;
  int blade_count = 2;
  double ground_factor = 1.0;  // share of the induced velocity that the blades feel
  Harmonic tilt_inflow_mps;    // c, s: at the tip, growing linearly from the shaft
  Harmonic flap_rad;
  double tip_twist_rad = 0.0;  // elastic
};

struct RingLoads {
  double thrust_N = 0.0;  // all blades, mean over a revolution
  double drive_N = 0.0;   // tangential force that resists turning
  double fx_N = 0.0;      // in-plane force on the rotor
  double fy_N = 0.0;
  Harmonic lift_N;       // thrust per revolution as harmonic; moments come from c and s
  double stalled = 0.0;  // share of the azimuth past stall
  double sin_phi = 0.0;  // of the mean flow, for Prandtl's factor
  double lift_slope_N_per_mps = 0.0;  // -d(thrust)/d(inflow), positive estimate for the integrator
};

// u, v: axial and swirl velocity of this ring. Writes every field of `out`, in place: a copy of it would wait for
// what was just stored.
void ring_loads(const Ring& ring, const DiscFlow& flow, double u_mps, double v_mps, RingLoads& out);

}  // namespace whirl::plant
