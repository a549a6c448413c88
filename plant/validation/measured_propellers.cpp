#include "plant/validation/measured_propellers.hpp"

#include <cmath>
#include <cstdio>
#include <map>

#include "harness/base/check.hpp"
#include "plant/rotor/polar.hpp"
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

// Asked only after sections and induced factor were settled; nothing but its own twist is fitted.
const std::vector<Measured>& all_unseen() {
  static const std::vector<Measured> all = {
      {"apcsf_10x4.7",
       10.0,
       "static_kt0835",
       {{4997, "rd0838_4997"}, {6020, "rd0840_6020"}, {6512, "rd0841_6512"}}}};
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

struct Case {
  const Measured* measured;
  PropellerDescription description;
  Rows still;                 // rpm, CT, CP
  std::vector<Rows> forward;  // per run: J, CT, CP
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
  d.sections = family_sections(m.name, section);
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
                               std::abs(grown - wanted), std::max(10.0, 0.5 * wanted)});
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

void add_bounds(const std::string& name, Errors s, Errors f, Report& report) {
  report.figures.push_back({name + ": static CT", "%", s.CT, 5.0});
  report.figures.push_back({name + ": static CP", "%", s.CP, 10.0});
  report.figures.push_back({name + ": flight CT", "%", f.CT, 10.0});
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

std::vector<SectionStation> family_sections(const std::string& propeller,
                                            const SectionOf& section) {
  if (propeller.starts_with("gws")) return {{0.2, section("bw3")}, {0.9, section("e63")}};
  return {{0.2, section("bw3")}, {0.6, section("naca6409")}, {1.0, section("naca4412")}};
}

Report validate_measured_propellers(const ReadData& read) {
  Report report{"Measured propellers: static and in flight",
                "UIUC Propeller Database [UiucProp]",
                {},
                {},
                {}};
  report.notes.push_back(
      "Sections per family and the induced power factor were settled with these propellers' flight "
      "data in view; the twist was fitted on static thrust alone.");
  const SectionOf section = section_reader(read);
  std::vector<Case> cases;
  std::vector<double> twists;
  for (const Measured& m : all_measured()) {
    cases.push_back(read_case("propellers/", m, read, section));
    twists.push_back(fitted_twist(cases.back()));
  }
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    const std::string name = c.measured->name;
    const auto blade = blade_with(c, twists[i]);
    const Errors s = static_errors(c, blade, &report);
    const Errors f = forward_errors(c, blade, &report);
    add_bounds(name, s, f, report);
    report.notes.push_back(line(c.measured->name, "fitted on static thrust", twists[i], s, f));
    const std::size_t sibling = i ^ 1u;  // pairs of one make stand together
    const auto other = blade_with(c, twists[sibling]);
    report.notes.push_back(line(c.measured->name, "left out (twist of its sibling)",
                                twists[sibling], static_errors(c, other, nullptr),
                                forward_errors(c, other, nullptr)));
    const auto none = blade_with(c, 0.0);
    report.notes.push_back(line(c.measured->name, "no twist correction", 0.0,
                                static_errors(c, none, nullptr), forward_errors(c, none, nullptr)));
  }
  return report;
}

Report validate_unseen_propellers(const ReadData& read) {
  Report report{
      "Unseen propellers: static and in flight", "UIUC Propeller Database [UiucProp]", {}, {}, {}};
  report.notes.push_back(
      "Nothing was settled with this flight data; the limits are those of the four known "
      "propellers. "
      "Same make as two of them, and three of its runs: another make is still untested.");
  const SectionOf section = section_reader(read);
  for (const Measured& m : all_unseen()) {
    const Case c = read_case("unseen/", m, read, section);
    const double twist = fitted_twist(c);
    const auto blade = blade_with(c, twist);
    const Errors s = static_errors(c, blade, &report);
    const Errors f = forward_errors(c, blade, &report);
    add_bounds(m.name, s, f, report);
    report.notes.push_back(line(m.name, "fitted on static thrust", twist, s, f));
    const auto none = blade_with(c, 0.0);
    report.notes.push_back(line(m.name, "no twist correction", 0.0, static_errors(c, none, nullptr),
                                forward_errors(c, none, nullptr)));
  }
  return report;
}

}  // namespace whirl::plant
