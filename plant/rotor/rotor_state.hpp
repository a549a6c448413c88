// What a rotor remembers between steps, and the pieces that step() and steady() share.
#pragma once
#include <array>

#include "plant/rotor/ring_balance.hpp"
#include "plant/rotor/ring_loads.hpp"
#include "plant/rotor/rotor.hpp"

namespace whirl::plant {

struct Rotor::State {
  std::array<double, kRing_count> u_mps{};
  std::array<double, kRing_count> v_mps{};
  Harmonic tilt_mps;  // c, s
  Harmonic flap_rad;
  double tip_twist_rad = 0.0;
};

// The disc's loads under a given inflow, ring by ring and summed.
struct DiscLoads {
  std::array<RingLoads, kRing_count> rings;
  double thrust_N = 0.0;
  double torque_Nm = 0.0;
  double fx_N = 0.0;
  double fy_N = 0.0;
  double moment_c_Nm = 0.0;  // integral of r dT cos(theta), sin(theta)
  double moment_s_Nm = 0.0;
  double moment_mean_Nm = 0.0;
  double stalled = 0.0;  // share of the disc, weighted by dynamic pressure
  double induced_mps = 0.0;
};

DiscFlow disc_flow(const Blade& blade, int spin, const RotorConditions& conditions,
                   RotorValidity& validity);
DiscLoads disc_loads(const Blade& blade, const DiscFlow& flow,
                     const std::array<double, kRing_count>& u_mps,
                     const std::array<double, kRing_count>& v_mps);
RotorLoads airframe_loads(const Blade& blade, const DiscFlow& flow, const DiscLoads& disc,
                          RotorValidity validity);

RingWake ring_wake(const Blade& blade, const Ring& ring, const DiscFlow& flow);

// Gradient of the inflow and flapping that the disc's loads ask for.
Harmonic wanted_tilt(const Blade& blade, const DiscFlow& flow, const DiscLoads& disc);
Harmonic wanted_flap(const Blade& blade, const DiscFlow& flow, const DiscLoads& disc);
double tilt_time_constant_s(const Blade& blade, const DiscFlow& flow, const DiscLoads& disc);

}  // namespace whirl::plant
