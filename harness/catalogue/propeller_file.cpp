#include "harness/catalogue/propeller_file.hpp"

#include <filesystem>
#include <map>
#include <numbers>

#include "base/places.hpp"
#include "base/rpm.hpp"
#include "base/whole_file.hpp"
#include "harness/lua/table.hpp"
#include "plant/rotor/polar.hpp"
#include "plant/rotor/section_rules.hpp"
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

}  // namespace

Result<std::shared_ptr<const plant::Blade>> read_propeller(const std::string& path) {
  const auto file = lua::read_file(path);
  if (!file) return file.error();
  const lua::Table& t = file.value();
  plant::PropellerDescription d;
  d.place = path;
  std::ignore = t.choice("kind", {"propeller"});
  d.name = t.text("name");
  d.blade_count = static_cast<int>(t.integer("blades", 1, 8));
  d.diameter_m = t.quantity("diameter", Dimension::length, lua::above(0.0));
  d.mass_kg = t.quantity("mass", Dimension::mass, lua::above(0.0));
  d.induced_factor = t.number_or("induced_factor", d.induced_factor, lua::at_least(1.0));
  d.material = material_of(t);
  d.thickness_over_chord =
      t.number_or("thickness", d.thickness_over_chord, lua::between(0.02, 0.3));
  d.stall_delay = t.flag_or("stall_delay", d.stall_delay);
  d.tip_twist_correction_rad =
      t.quantity_or("tip_twist_correction", Dimension::angle, d.tip_twist_correction_rad);
  for (const lua::Table& s : t.tables("stations")) {
    d.stations.push_back({s.number("r", lua::between(0.0, 1.0)), s.number("c", lua::above(0.0)),
                          s.number("beta") * std::numbers::pi / 180.0});
  }
  if (t.has("static")) {
    for (const lua::Table& s : t.tables("static")) {
      d.static_points.push_back(
          {radps_of(s.number("rpm", lua::above(0.0))), s.number("CT", lua::above(0.0))});
    }
  }
  std::vector<std::pair<double, std::string>> polars;
  if (t.has("polars")) {
    for (const lua::Table& p : t.tables("polars")) {
      polars.emplace_back(p.number("r"), p.text("file"));
    }
  } else {
    for (const auto& s : plant::sections_for(d.thickness_over_chord)) {
      polars.emplace_back(s.r_over_R, s.polar + ".polar");
    }
  }
  if (const auto good = t.finish(); !good) return good.error();
  for (const auto& [r, name] : polars) {
    auto polar = load_polar(t, path, name);
    if (!polar) return polar.error();
    d.sections.push_back({r, polar.value()});
  }
  return plant::make_fitted_blade(std::move(d));
}

}  // namespace whirl::catalogue
