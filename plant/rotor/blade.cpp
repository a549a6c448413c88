#include "plant/rotor/blade.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "base/angles.hpp"
#include "plant/rotor/blade_fit.hpp"
#include "plant/rotor/blade_rings.hpp"
#include "plant/rotor/torsion.hpp"

namespace whirl::plant {
namespace {

std::optional<Error> fault_of(const PropellerDescription& d) {
  const auto bad = [&](std::string what, std::string cure) {
    return Error{ErrorKind::bad_input, d.place, std::move(what), std::move(cure)};
  };
  if (d.blade_count < 1 || d.blade_count > 8) {
    return bad("blades: " + std::to_string(d.blade_count) + " is outside 1..8", "");
  }
  if (!(d.diameter_m >= 0.02 && d.diameter_m <= 10.0)) {
    return bad("diameter: " + std::to_string(d.diameter_m) + " m is outside 0.02..10 m",
               "write it with its unit, e.g. \"10 in\"");
  }
  if (!(d.mass_kg > 0.0 && d.mass_kg < 20.0)) {
    return bad("mass: " + std::to_string(d.mass_kg) + " kg is outside 0..20 kg",
               "give the whole propeller, e.g. \"7.9 g\"");
  }
  if (!(d.flap_stiffness_Nm_per_rad > 0.0 && d.flap_stiffness_Nm_per_rad < 1e6)) {
    return bad("flap_stiffness must be above 0 and below 1e6 N m/rad", "");
  }
  if (!(std::abs(d.tip_twist_correction_rad) <= 10.0 * kDeg)) {
    return bad("tip_twist_correction beyond 10 deg", "measure the blade's angles again");
  }
  if (!(d.induced_factor >= 1.0 && d.induced_factor <= 1.5)) {
    return bad("induced_factor is outside 1..1.5", "leave it out for the default");
  }
  if (d.stations.size() < 3) return bad("stations: at least 3 are needed", "give r, c, beta rows");
  if (d.sections.empty() && d.traits == nullptr) {
    return bad("polars: none given", "name at least one section");
  }
  return {};
}

std::optional<Error> fault_of_rows(const PropellerDescription& d) {
  double last = 0.0;
  for (std::size_t i = 0; i < d.stations.size(); ++i) {
    const PropellerStation& s = d.stations[i];
    const std::string place = d.place + ": stations[" + std::to_string(i + 1) + "]";
    const auto bad = [&](std::string what, std::string cure) {
      return Error{ErrorKind::bad_input, place, std::move(what), std::move(cure)};
    };
    if (!(s.r_over_R > last && s.r_over_R <= 1.0)) {
      return bad("r must ascend within 0..1", "r is the radius over the tip radius");
    }
    if (!(s.c_over_R > 0.0 && s.c_over_R < 1.0)) return bad("c must lie within 0..1", "c is c/R");
    if (!(std::abs(s.angle_rad) <= 80.0 * kDeg)) return bad("beta beyond 80 deg", "give degrees");
    last = s.r_over_R;
  }
  if (d.stations.front().r_over_R > 0.5 || last < 0.9) {
    return Error{ErrorKind::bad_input, d.place, "stations must reach from below 0.5 R to the tip",
                 "add the missing rows"};
  }
  last = -1.0;
  for (const SectionStation& s : d.sections) {
    if (s.polar == nullptr || !(s.r_over_R > last && s.r_over_R <= 1.0 && s.r_over_R >= 0.0)) {
      return Error{ErrorKind::bad_input, d.place, "polars must ascend in r within 0..1", ""};
    }
    last = s.r_over_R;
  }
  return {};
}

struct Mix {
  const PolarFamily* inner;
  const PolarFamily* outer;
  double outer_share;
};

Mix mix_at(const std::vector<SectionStation>& sections, double x) {
  if (x <= sections.front().r_over_R) return {sections.front().polar.get(), nullptr, 0.0};
  for (std::size_t i = 1; i < sections.size(); ++i) {
    if (x > sections[i].r_over_R) continue;
    const double a = sections[i - 1].r_over_R;
    return {sections[i - 1].polar.get(), sections[i].polar.get(),
            (x - a) / (sections[i].r_over_R - a)};
  }
  return {sections.back().polar.get(), nullptr, 0.0};
}

SectionCoefficients mixed(const Mix& mix, const SectionCoefficients& inner,
                          const SectionCoefficients& outer) {
  return {inner.cl + mix.outer_share * (outer.cl - inner.cl),
          inner.cd + mix.outer_share * (outer.cd - inner.cd)};
}

SectionCoefficients mixed(const Mix& mix, double alpha, double reynolds) {
  const SectionCoefficients c = mix.inner->at(alpha, reynolds);
  return mix.outer == nullptr ? c : mixed(mix, c, mix.outer->at(alpha, reynolds));
}

// Rotation holds the flow on a section that would stall: the lift moves towards its attached line.
struct StallDelay {
  double share = 0.0;  // 0 none, 1 fully attached
  PolarFamily::Attached line;
};

PolarFamily::Attached attached(const Mix& mix, double reynolds) {
  const auto a = mix.inner->attached(reynolds);
  PolarFamily::Attached line = a;
  if (mix.outer != nullptr) {
    const auto b = mix.outer->attached(reynolds);
    line.alpha0_rad += mix.outer_share * (b.alpha0_rad - a.alpha0_rad);
    line.slope_per_rad += mix.outer_share * (b.slope_per_rad - a.slope_per_rad);
  }
  return line;
}

StallDelay stall_delay(const Mix& mix, double chord_over_r, double reynolds) {
  return {std::tanh(3.0 * chord_over_r * chord_over_r), attached(mix, reynolds)};
}

double delayed_lift(const StallDelay& d, double alpha, double cl) {
  constexpr double kFull = 30.0 * kDeg;
  constexpr double kNone = 50.0 * kDeg;
  if (alpha <= d.line.alpha0_rad || alpha >= kNone) return cl;
  const double attached = d.line.slope_per_rad * std::sin(alpha - d.line.alpha0_rad);
  if (attached <= cl) return cl;
  const double fade = std::clamp((kNone - alpha) / (kNone - kFull), 0.0, 1.0);
  return cl + d.share * fade * (attached - cl);
}

// Angle of the first maximum of lift, without rotation's help; for the validity flag only.
double stall_alpha_rad(const Mix& mix) {
  constexpr double kReynolds_of_slow_flyers = 60e3;
  double best = -1.0;
  double angle = 2.0 * kDeg;
  for (double deg = 2.0; deg <= 30.0 && deg * kDeg < angle + 6.0 * kDeg; deg += 0.5) {
    const double cl = mixed(mix, deg * kDeg, kReynolds_of_slow_flyers).cl;
    if (cl <= best) continue;
    best = cl;
    angle = deg * kDeg;
  }
  return angle;
}

double angle_of_cell(int i) {
  return (0.5 * i - 180.0) * kDeg;
}

// Polars at all cells of a table. All rings of a blade are mixed of a few, and most of a table's time goes into them.
class Grids {
 public:
  const std::vector<SectionCoefficients>& of(const PolarFamily& polar) {
    std::vector<SectionCoefficients>& cells = grids_[&polar];
    if (!cells.empty()) return cells;
    cells.reserve(static_cast<std::size_t>(kAngles) * kReynolds);
    for (int level = 0; level < kReynolds; ++level) {
      const double re = reynolds_of_level(level);
      for (int i = 0; i < kAngles; ++i) cells.push_back(polar.at(angle_of_cell(i), re));
    }
    return cells;
  }

 private:
  std::map<const PolarFamily*, std::vector<SectionCoefficients>> grids_;
};

SectionTable make_table(const Mix& mix, double chord_over_r, bool delay, Grids& grids) {
  SectionTable table;
  table.cells.reserve(static_cast<std::size_t>(kAngles) * kReynolds);
  const auto& inner = grids.of(*mix.inner);
  const auto* outer = mix.outer == nullptr ? nullptr : &grids.of(*mix.outer);
  for (int level = 0; level < kReynolds; ++level) {
    const double re = reynolds_of_level(level);
    const StallDelay sd = delay ? stall_delay(mix, chord_over_r, re) : StallDelay{};
    for (int i = 0; i < kAngles; ++i) {
      const double alpha = angle_of_cell(i);
      const std::size_t cell = table.cells.size();
      SectionCoefficients c = inner[cell];
      if (outer != nullptr) c = mixed(mix, c, (*outer)[cell]);
      if (delay) c.cl = delayed_lift(sd, alpha, c.cl);
      table.cells.push_back({static_cast<float>(c.cl), static_cast<float>(c.cd)});
    }
  }
  return table;
}

void fill_by_traits(const TraitVector& traits, Ring& ring) {
  const double chord_over_r = ring.chord_m / ring.r_m;
  ring.table.cells.reserve(static_cast<std::size_t>(kAngles) * kReynolds);
  for (int level = 0; level < kReynolds; ++level) {
    const TraitSection section = trait_section(traits, chord_over_r, reynolds_of_level(level));
    for (int i = 0; i < kAngles; ++i) {
      const SectionCoefficients c = coefficients(section, angle_of_cell(i));
      ring.table.cells.push_back({static_cast<float>(c.cl), static_cast<float>(c.cd)});
    }
  }
  const TraitSection usual = trait_section(traits, chord_over_r, 60e3);
  ring.stall_alpha_rad = stall_angle_rad(usual);
  ring.zero_lift_rad = usual.zero_lift_rad;
}

// Twist that grows with the square of the speed and with nothing else, told as a centrifugal moment on
// one elastic mode of compliance 1.
void twist_by_speed(const TraitVector& traits, Blade& blade) {
  const double D = 2.0 * blade.radius_m;
  const double omega = 2.0 * kPi * kTwist_speed_mps / D;
  for (Ring& ring : blade.rings) ring.twist_share = ring.r_m / blade.radius_m;
  blade.torsion.compliance_rad_per_Nm = 1.0;
  blade.torsion.given_kgm2 = -traits[speed_twist_deg] * kDeg / (omega * omega);
  settle_flattening(blade);
}

void fill_rings(const PropellerDescription& d, Blade& blade) {
  const double first = std::min(d.stations.front().r_over_R, 0.15);
  blade.root_m = std::max(first, 0.05) * blade.radius_m;
  blade.hub_m = 0.5 * blade.root_m;
  const double width = (blade.radius_m - blade.root_m) / kRing_count;
  const double twist =
      d.traits != nullptr ? tip_twist_rad(d.traits->mean, 0.0) : d.tip_twist_correction_rad;
  Grids grids;
  for (int i = 0; i < kRing_count; ++i) {
    Ring& ring = blade.rings[static_cast<std::size_t>(i)];
    ring.r_m = blade.root_m + (i + 0.5) * width;
    ring.dr_m = width;
    const double x = ring.r_m / blade.radius_m;
    ring.chord_m = blade.radius_m * station_value(d.stations, x, &PropellerStation::c_over_R);
    ring.angle_rad = station_value(d.stations, x, &PropellerStation::angle_rad) + twist * x;
    if (d.traits != nullptr) {
      fill_by_traits(d.traits->mean, ring);
      continue;
    }
    const Mix mix = mix_at(d.sections, x);
    ring.table = make_table(mix, ring.chord_m / ring.r_m, d.stall_delay, grids);
    ring.stall_alpha_rad = stall_alpha_rad(mix);
    ring.zero_lift_rad = attached(mix, 1e5).alpha0_rad;
  }
}

// Mass spread along the span as chord x thickness.
void fill_inertia(const PropellerDescription& d, Blade& blade) {
  const auto thickness = thickness_m(blade, d.thickness_over_chord);
  double mass = 0.0;
  double second = 0.0;
  for (std::size_t i = 0; i < kRing_count; ++i) {
    const Ring& ring = blade.rings[i];
    const double dm = ring.chord_m * thickness[i] * ring.dr_m;
    mass += dm;
    second += dm * ring.r_m * ring.r_m;
  }
  constexpr double kShare_of_blades = 0.85;  // the rest is hub, at no radius worth counting
  blade.polar_inertia_kgm2 = kShare_of_blades * d.mass_kg * second / mass;
  blade.flap_inertia_kgm2 = blade.polar_inertia_kgm2 / blade.count;
  blade.flap_stiffness_Nm_per_rad = d.flap_stiffness_Nm_per_rad;
}

}  // namespace

// A monotone-free cubic would overshoot at the tip; linear is what the tables were read with.
double station_value(const std::vector<PropellerStation>& rows, double x,
                     double PropellerStation::*field) {
  if (x <= rows.front().r_over_R) return rows.front().*field;
  if (x >= rows.back().r_over_R) return rows.back().*field;
  std::size_t i = 1;
  while (rows[i].r_over_R < x) ++i;
  const auto& a = rows[i - 1];
  const auto& b = rows[i];
  const double w = (x - a.r_over_R) / (b.r_over_R - a.r_over_R);
  return a.*field + w * (b.*field - a.*field);
}

Result<std::shared_ptr<const Blade>> make_blade(const PropellerDescription& description) {
  if (auto bad = fault_of(description)) return *bad;
  if (auto bad = fault_of_rows(description)) return *bad;
  auto blade = std::make_shared<Blade>();
  blade->name = description.name;
  blade->count = description.blade_count;
  blade->radius_m = 0.5 * description.diameter_m;
  blade->induced_factor = description.induced_factor;
  fill_rings(description, *blade);
  fill_inertia(description, *blade);
  if (description.traits != nullptr) {
    blade->induced_factor = description.traits->mean[hover_loss];
    twist_by_speed(description.traits->mean, *blade);
  } else {
    fill_torsion(description.material, description.thickness_over_chord, *blade);
  }
  return std::shared_ptr<const Blade>(std::move(blade));
}

std::shared_ptr<const Blade> twisted(const Blade& blade, double tip_twist_rad) {
  auto turned = std::make_shared<Blade>(blade);
  for (Ring& ring : turned->rings) ring.angle_rad += tip_twist_rad * ring.r_m / blade.radius_m;
  settle_flattening(*turned);
  return turned;
}

double reynolds_of_level(int level) {
  return kReynolds_low * std::pow(kReynolds_high / kReynolds_low, level / (kReynolds - 1.0));
}

SectionCoefficients look_up(const SectionTable& table, ReynoldsSlot slot, double alpha_rad) {
  const double at = (alpha_rad / kDeg + 180.0) * 2.0;
  const int i = std::clamp(static_cast<int>(at), 0, kAngles - 2);
  const double w = at - i;
  const auto* lo = table.cells.data() + static_cast<std::ptrdiff_t>(slot.level) * kAngles + i;
  const auto* hi = lo + kAngles;
  const auto blend = [&](double a0, double a1, double b0, double b1) {
    const double a = a0 + w * (a1 - a0);
    return a + slot.weight * (b0 + w * (b1 - b0) - a);
  };
  return {blend(lo[0].cl, lo[1].cl, hi[0].cl, hi[1].cl),
          blend(lo[0].cd, lo[1].cd, hi[0].cd, hi[1].cd)};
}

double radius_m(const Blade& blade) {
  return blade.radius_m;
}
double disc_area_m2(const Blade& blade) {
  return kPi * blade.radius_m * blade.radius_m;
}
int blade_count(const Blade& blade) {
  return blade.count;
}
double polar_inertia_kgm2(const Blade& blade) {
  return blade.polar_inertia_kgm2;
}
const std::string& name(const Blade& blade) {
  return blade.name;
}

}  // namespace whirl::plant
