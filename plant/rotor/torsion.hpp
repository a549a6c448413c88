// How a soft blade twists under its own loads: one mode, quasi-steady.
//
//   Why      lift pulls ahead of the elastic axis and turns the nose up; camber and the centrifugal
//            pull on a flat blade turn it down. A soft blade stands a degree or two lower when it
//            carries no lift than at rest, and thrust at high advance ratio falls with speed.
//   Model    solid section: torsion constant 0.152 c t^3 (parabolic thickness), elastic axis at 0.45 c,
//            moment of camber from thin-aerofoil theory, pi/2 x the angle of zero lift. The shape of
//            the twist is that under a load proportional to r^2 c^2; inboard of the widest chord the
//            blade is up to twice as thick as there, at the tip at least 0.4 of it.
//   Valid    quasi-steady: the blade's first torsion lies above 100 Hz. Clamped at 8 deg.
//   Left out bending and its coupling with sweep, twist that varies over the azimuth.
//   Source   thin sections in torsion, [Timoshenko]; the flattening moment is what helicopter blades call
//            the propeller moment, [Leishman]
#pragma once
#include "plant/rotor/blade_rings.hpp"

namespace whirl::plant {

struct DiscFlow;
struct DiscLoads;

// Of every ring, by the rule above.
std::array<double, kRing_count> thickness_m(const Blade& blade, double over_chord);

// Fills blade.torsion and the rings' shares; rings must have chord, angle and polar.
void fill_torsion(const BladeMaterial& material, double thickness_over_chord, Blade& blade);

// Anew after the rings' angles have changed.
void settle_flattening(Blade& blade);

// Tip twist that these loads ask for, nose up positive.
double wanted_tip_twist_rad(const Blade& blade, const DiscFlow& flow, const DiscLoads& disc);

}  // namespace whirl::plant
