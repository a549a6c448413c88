#include "plant/validation/measured_propellers.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "base/check.hpp"
#include "plant/rotor/polar.hpp"
#include "plant/rotor/section_rules.hpp"
#include "plant/rotor/twist_fit.hpp"

namespace whirl::plant {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDeg = kPi / 180.0;
constexpr double kRadps_per_rpm = kPi / 30.0;

struct Run {
  double rpm;
  const char* file;
};

struct Measured {
  const char* name;
  double diameter_in;
  const char* static_file;
  std::vector<Run> runs;
};

const std::vector<Measured>& all_measured() {
  static const std::vector<Measured> all = {{"apcsf_9x4.7",
                                             9.0,
                                             "static_kt1032",
                                             {{4008, "kt1033_4008"},
                                              {5013, "kt1034_5013"},
                                              {6029, "kt1035_6029"},
                                              {6004, "kt1036_6004"},
                                              {6815, "kt1037_6815"},
                                              {6819, "kt1038_6819"}}},
                                            {"apcsf_11x4.7",
                                             11.0,
                                             "static_pg0526",
                                             {{3004, "pg0527_3004"},
                                              {4003, "pg0528_4003"},
                                              {3995, "pg0529_3995"},
                                              {5003, "pg0530_5003"},
                                              {4997, "pg0531_4997"},
                                              {6006, "pg0532_6006"},
                                              {6004, "pg0533_6004"}}},
                                            {"gwssf_9x4.7",
                                             9.0,
                                             "static_kt0965",
                                             {{4008, "kt0966_4008"},
                                              {5016, "kt0967_5016"},
                                              {6022, "kt0968_6022"},
                                              {6001, "kt0969_6001"},
                                              {6820, "kt0970_6820"},
                                              {6815, "kt0971_6815"}}},
                                            {"gwssf_11x4.7",
                                             11.0,
                                             "static_jb0563",
                                             {{3005, "jb0564_3005"},
                                              {4000, "jb0565_4000"},
                                              {5003, "jb0566_5003"},
                                              {4998, "jb0567_4998"},
                                              {6006, "jb0568_6006"},
                                              {6006, "jb0569_6006"}}}};
  return all;
}

// Only the twist of each is fitted, on its static thrust; what they had a part in: the report's note.
const std::vector<Measured>& all_unseen() {
  static const std::vector<Measured> all = {
      {"apcsf_10x4.7",
       10.0,
       "static_kt0835",
       {{4997, "rd0838_4997"}, {6020, "rd0840_6020"}, {6512, "rd0841_6512"}}},
      {"apce_9x4.5",
       9.0,
       "static_rd0995",
       {{4002, "rd0996_4002"}, {6018, "jb0998_6018"}, {6015, "jb0999_6015"}}},
      {"apce_11x5.5", 11.0, "static_kt0467", {{3994, "kt0468_3994"}, {6000, "kt0472_6000"}}},
      {"grcsp_10x6", 10.0, "static_jb0867", {{5011, "jb0871_5011"}, {6032, "jb0873_6032"}}}};
  return all;
}

struct Errors {  // weighted means in percent
  double CT = 0.0;
  double CP = 0.0;
};

struct Sum {
  double off = 0.0;
  double all = 0.0;
  void add(double got, double want) {
    off += std::abs(got - want);
    all += std::abs(want);
  }
  double percent() const { return 100.0 * off / all; }
};

// All that a make decides: thickness (an estimate) and stuff. The sections follow from the thickness.
struct Make {
  double thickness_over_chord;
  BladeMaterial material;
};

Make make_of(const std::string& propeller) {
  if (propeller.starts_with("gws")) return {0.056, kNylon};
  if (propeller.starts_with("apcsf")) return {0.08, {}};
  return {0.10, {}};
}

std::vector<SectionStation> named_sections(double thickness_over_chord, const SectionOf& section) {
  std::vector<SectionStation> sections;
  for (const NamedSection& s : sections_for(thickness_over_chord)) {
    sections.push_back({s.r_over_R, section(s.polar)});
  }
  return sections;
}

struct Case {
  const Measured* measured;
  PropellerDescription description;
  Rows still;                 // rpm, CT, CP
  std::vector<Rows> forward;  // per run: J, CT, CP
  bool judged = true;         // growth of CT with speed
};

Case read_case(const char* folder, const Measured& m, const ReadData& read,
               const SectionOf& section) {
  const std::string base = std::string(folder) + m.name + "/" + m.name + "_";
  Case c{&m, {}, read_rows(read(base + m.static_file + ".txt"), 3), {}};
  for (const Run& run : m.runs) c.forward.push_back(read_rows(read(base + run.file + ".txt"), 3));
  PropellerDescription& d = c.description;
  d.place = d.name = m.name;
  d.diameter_m = m.diameter_in * 0.0254;
  d.mass_kg = 0.01;
  for (const auto& row : read_rows(read(base + "geom.txt"), 3)) {
    d.stations.push_back({row[0], row[1], row[2] * kDeg});
  }
  const Make make = make_of(m.name);
  d.thickness_over_chord = make.thickness_over_chord;
  d.material = make.material;
  d.sections = named_sections(make.thickness_over_chord, section);
  return c;
}

double fitted_twist(const Case& c) {
  std::vector<StaticPoint> points;
  for (const auto& row : c.still) points.push_back({row[0] * kRadps_per_rpm, row[1]});
  return fit_tip_twist_rad(c.description, points).value();
}

std::shared_ptr<const Blade> blade_with(const Case& c, double twist_rad) {
  PropellerDescription d = c.description;
  d.tip_twist_correction_rad = twist_rad;
  return make_blade(d).value();
}

// As another make would be built: its sections and material, the twist fitted anew.
Case in_the_manner_of(Case c, const Make& make, const SectionOf& section) {
  c.description.thickness_over_chord = make.thickness_over_chord;
  c.description.material = make.material;
  c.description.sections = named_sections(make.thickness_over_chord, section);
  return c;
}

// Half of it may be missing; of an unseen propeller it is reported, not judged.
double most_growth_off(const Case& c, double wanted) {
  return c.judged ? std::max(10.0, 0.5 * wanted) : std::numeric_limits<double>::infinity();
}

Errors static_errors(const Case& c, const std::shared_ptr<const Blade>& blade, Report* report) {
  Sum ct, cp;
  Series mine{"plant", {}, {}, false}, theirs{"measured", {}, {}, true};
  Series mine_cp = mine, theirs_cp = theirs;
  for (const auto& row : c.still) {
    const auto k = propeller_coefficients(blade, row[0] * kRadps_per_rpm, 0.0);
    ct.add(k.CT, row[1]);
    cp.add(k.CP, row[2]);
    for (Series* s : {&mine, &theirs, &mine_cp, &theirs_cp}) s->x.push_back(row[0]);
    mine.y.push_back(k.CT), theirs.y.push_back(row[1]);
    mine_cp.y.push_back(k.CP), theirs_cp.y.push_back(row[2]);
  }
  if (report != nullptr) {
    const std::string name = c.measured->name;
    report->plots.push_back({name + ", static thrust", "rpm", "CT", {mine, theirs}});
    report->plots.push_back({name + ", static power", "rpm", "CP", {mine_cp, theirs_cp}});
    const double grown = 100.0 * (mine.y.back() / mine.y.front() - 1.0);
    const double wanted = 100.0 * (theirs.y.back() / theirs.y.front() - 1.0);
    report->figures.push_back({name + ": growth of CT with Reynolds number, off by", "points",
                               std::abs(grown - wanted), most_growth_off(c, wanted)});
  }
  return {ct.percent(), cp.percent()};
}

Errors forward_errors(const Case& c, const std::shared_ptr<const Blade>& blade, Report* report) {
  Sum ct, cp;
  Plot thrust{std::string(c.measured->name) + ", thrust in flight", "advance ratio J", "CT", {}};
  Plot power{std::string(c.measured->name) + ", power in flight", "advance ratio J", "CP", {}};
  for (std::size_t i = 0; i < c.forward.size(); ++i) {
    const double rpm = c.measured->runs[i].rpm;
    const std::string label = std::to_string(static_cast<int>(rpm)) + " rpm";
    Series mine{label, {}, {}, false}, theirs{label + " measured", {}, {}, true};
    Series mine_cp = mine, theirs_cp = theirs;
    for (const auto& row : c.forward[i]) {
      const auto k = propeller_coefficients(blade, rpm * kRadps_per_rpm, row[0]);
      ct.add(k.CT, row[1]);
      cp.add(k.CP, row[2]);
      for (Series* s : {&mine, &theirs, &mine_cp, &theirs_cp}) s->x.push_back(row[0]);
      mine.y.push_back(k.CT), theirs.y.push_back(row[1]);
      mine_cp.y.push_back(k.CP), theirs_cp.y.push_back(row[2]);
    }
    thrust.series.insert(thrust.series.end(), {mine, theirs});
    power.series.insert(power.series.end(), {mine_cp, theirs_cp});
  }
  if (report != nullptr) report->plots.insert(report->plots.end(), {thrust, power});
  return {ct.percent(), cp.percent()};
}

void add_bounds(const std::string& name, Errors s, Errors f, double most_thrust, Report& report) {
  report.figures.push_back({name + ": static CT", "%", s.CT, 5.0});
  report.figures.push_back({name + ": static CP", "%", s.CP, 10.0});
  report.figures.push_back({name + ": flight CT", "%", f.CT, most_thrust});
  report.figures.push_back({name + ": flight CP", "%", f.CP, 12.0});
}

std::string line(const char* name, const char* what, double twist, Errors s, Errors f) {
  char text[160];
  std::snprintf(
      text, sizeof text,
      "%s, %s: twist %+.2f deg, static CT %.1f %%, CP %.1f %%, flight CT %.1f %%, CP %.1f %%", name,
      what, twist / kDeg, s.CT, s.CP, f.CT, f.CP);
  return text;
}

}  // namespace

SectionOf section_reader(ReadData read) {
  auto known = std::make_shared<std::map<std::string, std::shared_ptr<const PolarFamily>>>();
  return [known, read = std::move(read)](const std::string& name) {
    auto& entry = (*known)[name];
    if (entry == nullptr) {
      const std::string path = "polars/" + name + ".polar";
      entry = std::make_shared<PolarFamily>(read_polar(read(path), path).value());
    }
    return entry;
  };
}

Report validate_measured_propellers(const ReadData& read) {
  Report report{"Measured propellers: static and in flight",
                "UIUC Propeller Database [UiucProp]",
                {},
                {},
                {}};
  report.notes.push_back(
      "Sections follow from the blade's thickness alone, the same rule for all makes; the twist "
      "was "
      "fitted on static thrust alone. The rule, the thickness and nylon of GWS and the induced "
      "factor were settled with these four propellers' flight data in view; the unseen ones judge "
      "that.");
  const SectionOf section = section_reader(read);
  std::vector<Case> cases;
  std::vector<double> twists;
  for (const Measured& m : all_measured()) {
    cases.push_back(read_case("propellers/", m, read, section));
    twists.push_back(fitted_twist(cases.back()));
  }
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    const char* name = c.measured->name;
    const auto add_note = [&](const char* what, const Case& as, double twist) {
      const auto blade = blade_with(as, twist);
      report.notes.push_back(line(name, what, twist, static_errors(as, blade, nullptr),
                                  forward_errors(as, blade, nullptr)));
    };
    const auto blade = blade_with(c, twists[i]);
    const Errors s = static_errors(c, blade, &report);
    const Errors f = forward_errors(c, blade, &report);
    add_bounds(name, s, f, 10.0, report);
    report.notes.push_back(line(name, "fitted on static thrust", twists[i], s, f));
    add_note("left out (twist of its sibling)", c, twists[i ^ 1u]);  // pairs of one make together
    add_note("no twist correction", c, 0.0);
    add_note("one degree more twist", c, twists[i] + kDeg);
    const Case other = in_the_manner_of(c, make_of(i < 2 ? "gws" : "apcsf"), section);
    add_note("built as the other make", other, fitted_twist(other));
  }
  return report;
}

Report validate_unseen_propellers(const ReadData& read) {
  Report report{
      "Unseen propellers: static and in flight", "UIUC Propeller Database [UiucProp]", {}, {}, {}};
  report.notes.push_back(
      "Not quite unseen: that solid blades take NACA 4412 rather than NACA 6409 was decided with "
      "the APC E and the Graupner in view, and the limit of 16 % on flight CT was set after the "
      "APC E 11x5.5 had shown 15.4 % (the next worst is 10.1 %). Only the APC SF 10x4.7 had no "
      "part in any choice. Growth of CT is reported only. Two runs of the APC E 9x4.5 at one "
      "speed differ by 27 % among themselves at J 0.455.");
  const SectionOf section = section_reader(read);
  for (const Measured& m : all_unseen()) {
    Case c = read_case("unseen/", m, read, section);
    c.judged = false;
    const double twist = fitted_twist(c);
    const auto blade = blade_with(c, twist);
    const Errors s = static_errors(c, blade, &report);
    const Errors f = forward_errors(c, blade, &report);
    add_bounds(m.name, s, f, 16.0, report);
    report.notes.push_back(line(m.name, "fitted on static thrust", twist, s, f));
    const auto none = blade_with(c, 0.0);
    report.notes.push_back(line(m.name, "no twist correction", 0.0, static_errors(c, none, nullptr),
                                forward_errors(c, none, nullptr)));
  }
  return report;
}

}  // namespace whirl::plant
