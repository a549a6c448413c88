// A blade in axial flow given station by station, solved by the plant's own ring balance.
//
//   For  reference cases that bring their section as a formula or their stations as printed; the
//        plant's Rotor goes through the same balance_ring() with its tables and azimuths.
#pragma once
#include <cmath>
#include <vector>

#include "plant/rotor/ring_balance.hpp"

namespace whirl::plant {

struct AxialStation {
  double r_m = 0.0;
  double chord_m = 0.0;
  double angle_rad = 0.0;
};

struct AxialSolution {
  double normal_Npm = 0.0;  // one blade, per metre of span
  double tangential_Npm = 0.0;
  double u_mps = 0.0;
  double v_mps = 0.0;
  double loss = 1.0;  // Prandtl's factor there
  bool converged = false;
};

// section(alpha, reynolds_over_speed_chord...): lift and drag at (alpha_rad, speed_mps, chord_m).
template <typename Section>
AxialSolution solve_axial(const AxialStation& s, RingWake wake, const Section& section) {
  wake.r_m = s.r_m;
  wake.dr_m = 1.0;  // loads per metre
  RingForce last;
  const auto force_at = [&](double u, double v) {
    const double axial = wake.climb_mps + u;
    const double turning = wake.blade_speed_mps - v;
    const double speed = std::hypot(axial, turning);
    const auto k = section(s.angle_rad - std::atan2(axial, turning), speed, s.chord_m);
    const double q = 0.5 * wake.density_kgpm3 * s.chord_m * speed * wake.blade_count;
    last = {q * (k.cl * turning - k.cd * axial), q * (k.cl * axial + k.cd * turning),
            axial / speed};
    return last;
  };
  const RingPoint point = balance_ring(wake, force_at, {});
  const RingForce force = force_at(point.u_mps, point.v_mps);
  return {force.thrust_N / wake.blade_count,
          force.drive_N / wake.blade_count,
          point.u_mps,
          point.v_mps,
          prandtl_loss(s.r_m, wake.tip_m, wake.root_m, wake.blade_count, force.sin_phi),
          point.converged};
}

}  // namespace whirl::plant
