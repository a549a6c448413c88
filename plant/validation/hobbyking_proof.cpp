#include "plant/validation/hobbyking_proof.hpp"

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"
#include "plant/rotor/hobbyking_10x4_5.hpp"
#include "plant/rotor/rotor.hpp"
#include "plant/rotor/twist_fit.hpp"

namespace whirl::plant {
namespace {

RotorLoads loads_at(const std::shared_ptr<const Blade>& blade, double rpm, double inflow_mps) {
  RotorConditions c;
  c.omega_radps = rpm * kRadps_per_rpm;
  c.v_AP_P_mps.z() = -inflow_mps;
  return Rotor(blade, 1).steady(c);
}

void add_static(const std::shared_ptr<const Blade>& blade, Report& report) {
  Series mine{"plant", {}, {}, false}, thesis{"thesis, fit of the load cell", {}, {}, true};
  Series merit{"plant", {}, {}, false};
  double worst = 0.0, lowest = 1.0, highest = 0.0;
  for (double rpm = 3000.0; rpm <= 5500.0; rpm += 250.0) {
    const RotorLoads l = loads_at(blade, rpm, 0.0);
    const double want = 1.789e-7 * rpm * rpm - 1.4715e-4 * rpm;
    worst = std::max(worst, 100.0 * std::abs(l.thrust_N / want - 1.0));
    lowest = std::min(lowest, l.figure_of_merit);
    highest = std::max(highest, l.figure_of_merit);
    for (Series* s : {&mine, &thesis, &merit}) s->x.push_back(rpm);
    mine.y.push_back(l.thrust_N);
    thesis.y.push_back(want);
    merit.y.push_back(l.figure_of_merit);
  }
  report.plots.push_back({"Static thrust", "rpm", "N", {mine, thesis}});
  report.plots.push_back({"Figure of merit in hover", "rpm", "", {merit}});
  report.figures.push_back({"static thrust, 3000 to 5500 rpm", "%", worst, 3.0});
  report.figures.push_back({"figure of merit below 0.6 by", "", std::max(0.0, 0.6 - lowest), 0.0});
  report.figures.push_back(
      {"figure of merit above 0.75 by", "", std::max(0.0, highest - 0.75), 0.0});
}

void add_downdraft(const std::shared_ptr<const Blade>& blade, Report& report) {
  constexpr double kRpm = 4660.0;  // static speed for the table's 3.2 N
  constexpr double kWind[] = {0.0, 0.8, 2.2, 3.5, 3.8, 4.0, 4.2};
  constexpr double kLoss[] = {0.0, -1.99, -10.49, -13.79, -15.84, -18.70, -20.72};
  const double still = loads_at(blade, kRpm, 0.0).thrust_N;
  Series mine{"plant", {}, {}, false}, table{"thesis, Table 5.6", {}, {}, true};
  double squares = 0.0, squares_kept = 0.0, last = 0.0;
  for (std::size_t i = 0; i < 7; ++i) {
    last = 100.0 * (loads_at(blade, kRpm, kWind[i]).thrust_N / still - 1.0);
    const double off = last - kLoss[i];
    squares += off * off;
    if (i != 3 && i != 4) squares_kept += off * off;
    mine.x.push_back(kWind[i]), mine.y.push_back(last);
    table.x.push_back(kWind[i]), table.y.push_back(kLoss[i]);
  }
  report.plots.push_back({"Thrust under a downdraft at constant rpm",
                          "wind through the disc, m/s",
                          "%",
                          {mine, table}});
  report.figures.push_back({"Table 5.6 without its outliers at 3.5 and 3.8 m/s, RMS", "points",
                            std::sqrt(squares_kept / 5.0), 3.0});
  report.figures.push_back(
      {"Table 5.6, all seven points, RMS", "points", std::sqrt(squares / 7.0), 4.0});
  // J = 0.213: the four measured slow flyers lose 21.9 to 28.8 % of their static thrust there.
  report.figures.push_back({"loss at 4.2 m/s outside 21.9..28.8 % (measured slow flyers) by",
                            "points", std::max({0.0, 21.9 + last, -28.8 - last}), 0.0});
}

void add_inflow_map(const std::shared_ptr<const Blade>& blade, Report& report) {
  Plot plot{
      "What power can tell of thrust: CT against CP over inflow of -2..6 m/s", "CP", "CT", {}};
  Plot over{"CT and CP over inflow at 4500 rpm", "inflow, m/s", "", {}};
  Series ct{"CT", {}, {}, false}, cp{"CP", {}, {}, false};
  for (const double rpm : {3500.0, 4500.0, 5500.0}) {
    Series s{std::to_string(static_cast<int>(rpm)) + " rpm", {}, {}, false};
    const double n = rpm / 60.0;
    const double D = 2.0 * radius_m(*blade);
    for (double v = -2.0; v <= 6.01; v += 0.25) {
      const auto k = propeller_coefficients(blade, rpm * kRadps_per_rpm, v / (n * D));
      s.x.push_back(k.CP), s.y.push_back(k.CT);
      if (rpm != 4500.0) continue;
      ct.x.push_back(v), ct.y.push_back(k.CT);
      cp.x.push_back(v), cp.y.push_back(k.CP);
    }
    plot.series.push_back(std::move(s));
  }
  const auto most = std::max_element(cp.y.begin(), cp.y.end());
  const double at = cp.x[static_cast<std::size_t>(most - cp.y.begin())];
  over.series = {ct, cp};
  report.plots.push_back(plot);
  report.plots.push_back(over);
  char text[160];
  std::snprintf(
      text, sizeof text,
      "CP at 4500 rpm is largest at an inflow of %.2f m/s (%.4f; %.4f at 6 m/s): around it power"
      " says little about thrust.",
      at, *most, cp.y.back());
  report.notes.push_back(text);
}

}  // namespace

Report validate_hobbyking(const ReadData& read) {
  Report report{"Hobbyking 10x4.5", "[Bangura2017, 3.5, Table 5.6]", {}, {}, {}};
  const SectionOf section = section_reader(read);
  const auto blade = make_blade(hobbyking_10x4_5(section("bw3"), section("e63"))).value();
  add_static(blade, report);
  add_downdraft(blade, report);
  add_inflow_map(blade, report);
  report.notes.push_back(
      "Outliers of Table 5.6: 3.5 and 3.8 m/s lie 4 to 5 points above the smooth curve through the "
      "others and above every measured slow flyer; its wind was measured by hand.");
  return report;
}

}  // namespace whirl::plant
