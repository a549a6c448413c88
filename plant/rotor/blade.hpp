// A propeller as the solver needs it: rings of blade, each with its own section table.
//
//   In       PropellerDescription: what a propeller file says (columns r/R, c/R, angle; polars by
//            radius). make_blade() checks it and answers with a Blade or one sentence with a cure.
//   Valid    1 to 8 blades, radius 1 cm to 5 m, stations ascending within (0, 1] of the tip radius.
//   Source   sections that nobody measured: blade_traits.hpp, fitted_blade.hpp; elastic twist: torsion.hpp; stall delay: [Snel].
//   Left out sweep, cone, section camber varying along the blade other than by mixing two polars.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace whirl::plant {

class PolarFamily;   // polar.hpp: one section at several Reynolds numbers
struct TraitBelief;  // blade_fit.hpp: a section in eleven numbers, and how sure they are
class KnownBlades;   // known_blades.hpp

struct PropellerStation {
  double r_over_R = 0.0;
  double c_over_R = 0.0;
  double angle_rad = 0.0;  // chord line against the disc
};

// From this radius outward (mixed linearly between neighbours) the section is `polar`.
struct SectionStation {
  double r_over_R = 0.0;
  std::shared_ptr<const PolarFamily> polar;
};

struct StaticPoint {
  double omega_radps = 0.0;
  double thrust_coefficient = 0.0;  // T / (rho n^2 D^4)
  double power_coefficient = 0.0;   // P / (rho n^3 D^5); 0: was not measured
};

// Measured along the shaft, J = V / (n D) above 0; coefficients as above.
struct FlightPoint {
  double omega_radps = 0.0;
  double advance_ratio = 0.0;
  double thrust_coefficient = 0.0;
  double power_coefficient = 0.0;  // 0: was not measured
};

// What resists twisting. No modulus: a rigid blade.
struct BladeMaterial {
  double shear_modulus_Pa = 0.0;
  double density_kgpm3 = 0.0;
};
// Handbook values; the moduli are those of parts that have taken up room moisture.
inline constexpr BladeMaterial kNylon{0.8e9, 1140.0};        // unreinforced: GWS and its copies
inline constexpr BladeMaterial kGlass_nylon{3.0e9, 1500.0};  // long glass fibre: APC
inline constexpr BladeMaterial kCarbon{5.0e9, 1550.0};
inline constexpr BladeMaterial kWood{0.7e9, 650.0};

struct PropellerDescription {
  std::string place;  // "hk_10x4.5.lua", repeated in errors
  std::string name;
  std::string make;  // "": not known
  int blade_count = 2;
  double diameter_m = 0.0;
  std::vector<PropellerStation> stations;
  std::vector<SectionStation> sections;
  double mass_kg = 0.0;                     // whole propeller
  double tip_twist_correction_rad = 0.0;    // added in proportion to r/R; stated in the file
  std::vector<StaticPoint> static_points;   // for make_fitted_blade(), which finds that correction
  std::vector<FlightPoint> flight_points;   // for fit_blade() alone
  double flap_stiffness_Nm_per_rad = 60.0;  // root spring of one blade; stiff plastic by default
  double induced_factor = 1.15;             // in hover; fades with through-flow (ring_balance.hpp)
  BladeMaterial material;                   // rigid unless given
  double thickness_over_chord = 0.10;       // at 0.75 R; torsion.hpp
  bool stall_delay = true;                  // rotational augmentation of the inboard sections
  bool drawn = false;                       // built to its drawing: angles known to 0.3 deg
  // Instead of sections: what is known of blades like it; make_fitted_blade() finds the traits.
  std::shared_ptr<const KnownBlades> known;
  std::shared_ptr<const TraitBelief> traits;
};

// Linear between stations, held beyond the first and the last.
double station_value(const std::vector<PropellerStation>& rows, double r_over_R,
                     double PropellerStation::*field);

class Blade;  // blade_rings.hpp: for the solver's eyes only

Result<std::shared_ptr<const Blade>> make_blade(const PropellerDescription& description);

// What others may ask of a blade without knowing its insides.
double radius_m(const Blade& blade);
double disc_area_m2(const Blade& blade);
int blade_count(const Blade& blade);
double polar_inertia_kgm2(const Blade& blade);  // whole propeller about its shaft, from its mass
const std::string& name(const Blade& blade);

}  // namespace whirl::plant
