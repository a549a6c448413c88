#include "harness/catalogue/propeller_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include "base/places.hpp"
#include "base/rpm.hpp"
#include "base/whole_file.hpp"
#include "harness/lua/table.hpp"
#include "plant/rotor/known_blades.hpp"
#include "plant/rotor/polar.hpp"
#include "plant/rotor/twist_fit.hpp"

namespace whirl::catalogue {
namespace {

Result<std::shared_ptr<const plant::PolarFamily>> load_polar(const lua::Table& file,
                                                             const std::string& place,
                                                             const std::string& name) {
  std::string path = file.sibling(name);
  if (!std::filesystem::exists(path)) path = polar_folder() + "/" + name;
  if (!std::filesystem::exists(path)) {
    return Error{ErrorKind::bad_input, place, "polar '" + name + "' is nowhere to be found",
                 "put it beside this file, or name one of plant/data/polars"};
  }
  const auto text = read_whole_file(path);
  if (!text) return text.error();
  auto polar = plant::read_polar(text.value(), path);
  if (!polar) return polar.error();
  return std::make_shared<const plant::PolarFamily>(std::move(polar.value()));
}

Result<std::shared_ptr<const plant::KnownBlades>> load_known() {
  const std::string path = polar_folder() + "/../propellers/known.txt";
  const auto text = read_whole_file(path);
  if (!text) return text.error();
  auto known = plant::read_known(text.value(), path);
  if (!known) return known.error();
  return std::make_shared<const plant::KnownBlades>(std::move(known.value()));
}

plant::BladeMaterial material_of(const lua::Table& t) {
  static const std::map<std::string, plant::BladeMaterial> kMaterials = {
      {"rigid", {}},
      {"nylon", plant::kNylon},
      {"glass nylon", plant::kGlass_nylon},
      {"carbon", plant::kCarbon},
      {"wood", plant::kWood}};
  if (!t.has("material")) return {};
  std::vector<std::string> words;
  words.reserve(std::size(kMaterials));
  for (const auto& [word, material] : kMaterials) words.push_back(word);
  const auto found = kMaterials.find(t.choice("material", words));
  return found == kMaterials.end() ? plant::BladeMaterial{} : found->second;
}

// A whole propeller of ordinary make weighs 7 to 15 g at 10 in and grows with the cube.
void check_mass(const lua::Table& t, const plant::PropellerDescription& d) {
  const double usual_kg = 0.01 * std::pow(d.diameter_m / 0.254, 3.0);
  if (d.mass_kg > 20.0 * usual_kg) {
    t.refuse("mass", "is over twenty times that of a propeller of this diameter",
             "give the whole propeller, e.g. \"9 g\"");
  }
}

void read_stations(const lua::Table& t, plant::PropellerDescription& d) {
  double steepest = 0.0;
  for (const lua::Table& s : t.tables("stations")) {
    const double beta = s.number("beta");
    steepest = std::max(steepest, std::abs(beta));
    d.stations.push_back({s.number("r", lua::between(0.0, 1.0)), s.number("c", lua::above(0.0)),
                          beta * std::numbers::pi / 180.0});
  }
  if (!d.stations.empty() && steepest < 1.6) {
    t.refuse("stations", "no beta is above 1.6: these look like radians", "beta is in degrees");
  }
}

// An ideal rotor lifts with CT^(3/2) sqrt(2 / pi): no propeller takes less.
void check_ideal(const lua::Table& row, const plant::StaticPoint& p) {
  const double ideal = std::pow(p.thrust_coefficient, 1.5) * std::sqrt(2.0 / std::numbers::pi);
  if (p.power_coefficient == 0.0 || p.power_coefficient >= ideal) return;
  row.refuse(row.has("power") ? "power" : "CP", "is less than an ideal rotor takes for that thrust",
             "check its unit, the density and the diameter; power is that of the shaft");
}

// CT and CP, or newtons and watts at the density of that day.
void read_static(const lua::Table& t, plant::PropellerDescription& d) {
  if (!t.has("static")) return;
  if (t.has("tip_twist_correction")) {
    t.refuse("tip_twist_correction", "does not go with static", "static finds it; leave one out");
  }
  const double density =
      t.quantity_or("density", Dimension::density, 1.225, lua::between(0.3, 2.0));
  for (const lua::Table& s : t.tables("static")) {
    const double omega = radps_of(s.number("rpm", lua::above(0.0)));
    const double n = omega / (2.0 * std::numbers::pi);
    const double scale = density * n * n * std::pow(d.diameter_m, 4.0);
    plant::StaticPoint p{omega};
    p.thrust_coefficient = s.has("thrust")
                               ? s.quantity("thrust", Dimension::force, lua::above(0.0)) / scale
                               : s.number("CT", lua::above(0.0));
    if (s.has("power")) {
      p.power_coefficient =
          s.quantity("power", Dimension::power, lua::above(0.0)) / (scale * n * d.diameter_m);
    } else if (s.has("CP")) {
      p.power_coefficient = s.number("CP", lua::above(0.0));
    }
    check_ideal(s, p);
    d.static_points.push_back(p);
  }
}

// A row or more from a tunnel: one brings most of what rest does not tell (plant/validation/left_out.hpp).
void read_flight(const lua::Table& t, plant::PropellerDescription& d) {
  if (!t.has("flight")) return;
  if (t.has("polars")) {
    t.refuse("flight", "goes without polars",
             "nothing is fitted on it beside polars; leave it out");
  }
  for (const lua::Table& s : t.tables("flight")) {
    plant::FlightPoint p{radps_of(s.number("rpm", lua::above(0.0)))};
    p.advance_ratio = s.number("J", lua::between(0.05, 2.0));
    p.thrust_coefficient = s.number("CT", lua::above(0.0));
    if (s.has("CP")) p.power_coefficient = s.number("CP", lua::above(0.0));
    if (p.power_coefficient > 0.0 && p.advance_ratio * p.thrust_coefficient > p.power_coefficient) {
      s.refuse("CP", "is less than thrust times speed",
               "an efficiency above 1: check J, CT and CP");
    }
    d.flight_points.push_back(p);
  }
}

// What a fitted blade has in its traits already.
void refuse_without_polars(const lua::Table& t) {
  for (const char* key : {"material", "thickness", "induced_factor", "stall_delay"}) {
    if (!t.has(key)) continue;
    t.refuse(key, "goes with polars", "without polars it is part of what is fitted; leave it out");
  }
}

struct Named {
  plant::PropellerDescription description;
  std::vector<std::pair<double, std::string>> polars;
};

Named read_table(const lua::Table& t, const std::string& path) {
  Named named;
  plant::PropellerDescription& d = named.description;
  d.place = path;
  std::ignore = t.choice("kind", {"propeller"});
  d.name = t.text("name");
  d.make = t.text_or("make", "");
  d.blade_count = static_cast<int>(t.integer("blades", 1, 8));
  d.diameter_m = t.quantity("diameter", Dimension::length, lua::above(0.0));
  d.mass_kg = t.quantity("mass", Dimension::mass, lua::above(0.0));
  check_mass(t, d);
  read_stations(t, d);
  read_static(t, d);
  read_flight(t, d);
  d.thickness_over_chord =
      t.number_or("thickness", d.thickness_over_chord, lua::between(0.02, 0.3));
  if (t.has("angles")) d.drawn = t.choice("angles", {"drawn", "read"}) == "drawn";
  d.tip_twist_correction_rad =
      t.quantity_or("tip_twist_correction", Dimension::angle, d.tip_twist_correction_rad);
  if (!t.has("polars")) {
    refuse_without_polars(t);
    return named;
  }
  d.induced_factor = t.number_or("induced_factor", d.induced_factor, lua::at_least(1.0));
  d.material = material_of(t);
  d.stall_delay = t.flag_or("stall_delay", d.stall_delay);
  for (const lua::Table& p : t.tables("polars")) {
    named.polars.emplace_back(p.number("r"), p.text("file"));
  }
  return named;
}

Result<PropellerFile> fitted(plant::PropellerDescription d) {
  auto known = load_known();
  if (!known) return known.error();
  d.known = std::move(known.value());
  auto fit = plant::fit_blade(std::move(d));
  if (!fit) return fit.error();
  const auto blade = fit.value().blade;
  return PropellerFile{blade, std::make_shared<const plant::FittedBlade>(std::move(fit.value())),
                       nullptr};
}

}  // namespace

Result<PropellerFile> read_propeller_file(const std::string& path) {
  const auto file = lua::read_file(path);
  if (!file) return file.error();
  Named named = read_table(file.value(), path);
  if (const auto good = file.value().finish(); !good) return good.error();
  plant::PropellerDescription& d = named.description;
  if (named.polars.empty()) return fitted(std::move(d));
  for (const auto& [r, name] : named.polars) {
    auto polar = load_polar(file.value(), path, name);
    if (!polar) return polar.error();
    d.sections.push_back({r, polar.value()});
  }
  auto twist = plant::make_fitted_blade(std::move(d));
  if (!twist) return twist.error();
  const auto blade = twist.value().blade;
  return PropellerFile{blade, nullptr,
                       std::make_shared<const plant::TwistedBlade>(std::move(twist.value()))};
}

std::vector<std::string> PropellerFile::doubts() const {
  std::vector<std::string> all;
  if (fit != nullptr) all = fit->doubts;
  if (twist != nullptr) all = twist->doubts;
  for (std::string& doubt : all) doubt = plant::name(*blade) + ": " + doubt;
  return all;
}

Result<std::shared_ptr<const plant::Blade>> read_propeller(const std::string& path) {
  auto read = read_propeller_file(path);
  if (!read) return read.error();
  return read.value().blade;
}

}  // namespace whirl::catalogue
