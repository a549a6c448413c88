#include "harness/sweep/forward_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <set>

#include "base/rpm.hpp"
#include "harness/sweep/tally.hpp"
#include "harness/sweep/validity_tally.hpp"
#include "plant/rotor/polar.hpp"
#include "plant/rotor/rotor.hpp"
#include "plant/rotor/twist_fit.hpp"

namespace whirl::sweep {
namespace {

using plant::MeasuredPoint;
using plant::Prediction;
using results::Chart;
using results::ChartCurve;

struct Teller {
  const SweptPropeller& prop;
  std::shared_ptr<const plant::Blade> least_drag, most_drag;  // null: no section states an error

  explicit Teller(const SweptPropeller& propeller) : prop(propeller) {
    if (prop.twist == nullptr || prop.twist->drag_within == 0.0) return;
    least_drag = plant::with_section_drag(*prop.twist, -1);
    most_drag = plant::with_section_drag(*prop.twist, +1);
  }
  std::vector<Prediction> tell(const std::vector<MeasuredPoint>& where) const {
    if (prop.fit != nullptr) return plant::predict(prop.fit->axial, prop.fit->belief, where);
    return by(prop.blade, where);
  }
  static std::vector<Prediction> by(const std::shared_ptr<const plant::Blade>& blade,
                                    const std::vector<MeasuredPoint>& where) {
    std::vector<Prediction> told;
    told.reserve(where.size());
    for (const MeasuredPoint& p : where) {
      told.push_back({plant::propeller_coefficients(blade, p.omega_radps, p.advance_ratio), {}});
    }
    return told;
  }
};

struct BandTally : Tally {
  int inside = 0;
  void add(double got, double want, double half) {
    Tally::add(got, want);
    inside += std::abs(got - want) <= half ? 1 : 0;
  }
};

struct Pair {  // CT and CP charts side by side
  Chart CT, CP;
  Pair(const std::string& group, const std::string& x_label)
      : CT{group, "CT = T / (rho n2 D4)", x_label, "CT", "", "", {}, {}},
        CP{group, "CP = P / (rho n3 D5)", x_label, "CP", "", "", {}, {}} {}

  void draw(const std::string& name, const std::vector<double>& x,
            const std::vector<Prediction>& told, bool faint = false, bool in_legend = true) {
    ChartCurve t{name, x, {}, false, faint, in_legend}, p = t;
    for (const Prediction& k : told) t.y.push_back(k.mean.CT), p.y.push_back(k.mean.CP);
    CT.curves.push_back(t), CP.curves.push_back(p);
  }
  // With what is known of how far it may be off.
  void draw_with_band(const std::string& name, const std::vector<double>& x,
                      const std::vector<MeasuredPoint>& where, const Teller& teller) {
    const auto told = teller.tell(where);
    draw(name, x, told);
    note_validity(name, x, where, teller.prop.blade);
    if (teller.least_drag != nullptr) {
      draw(name + ", least drag", x, Teller::by(teller.least_drag, where), true);
      draw(name + ", most drag", x, Teller::by(teller.most_drag, where), true);
    }
    if (teller.prop.fit == nullptr) return;
    for (const double side : {-plant::kNine_in_ten, plant::kNine_in_ten}) {
      auto edge = told;
      for (Prediction& k : edge) {
        k.mean.CT += side * k.deviation.CT, k.mean.CP += side * k.deviation.CP;
      }
      draw(name + (side < 0 ? ", 90 % band, lower" : ", 90 % band, upper"), x, edge, true,
           side > 0);
    }
  }
  // By the flying rotor, whose sections they are.
  void note_validity(const std::string& name, const std::vector<double>& x,
                     const std::vector<MeasuredPoint>& where,
                     const std::shared_ptr<const plant::Blade>& blade) {
    const plant::Rotor rotor(blade, 1);
    ValidityTally tally;
    for (std::size_t i = 0; i < x.size(); ++i) {
      plant::RotorConditions c;
      c.omega_radps = where[i].omega_radps;
      c.v_AP_P_mps.z() = -where[i].advance_ratio * c.omega_radps / (2.0 * std::numbers::pi) * 2.0 *
                         radius_m(*blade);
      tally.add(x[i], rotor.steady(c).validity);
    }
    if (tally.note().empty()) return;
    for (Chart* chart : {&CT, &CP}) {
      chart->note += (chart->note.empty() ? "" : "; ") + name + ": " + tally.note();
    }
  }
  void mark(const std::string& name, const std::vector<double>& x,
            const std::vector<MeasuredPoint>& points) {
    ChartCurve t{name, x, {}, true}, p{name, x, {}, true};
    for (const MeasuredPoint& m : points) t.y.push_back(m.CT), p.y.push_back(m.CP);
    CT.curves.push_back(t), CP.curves.push_back(p);
  }
};

std::string rpm_text(double omega_radps) {
  return std::to_string(std::lround(rpm_of(omega_radps))) + " rpm";
}

void report(Chart& chart, const std::string& what, double value) {
  chart.figures.push_back({what, value, std::numeric_limits<double>::infinity(), "%", true});
}

struct Tallies {
  BandTally CT, CP;

  void add(const Prediction& told, const MeasuredPoint& p) {
    CT.add(told.mean.CT, p.CT, plant::kNine_in_ten * told.deviation.CT);
    CP.add(told.mean.CP, p.CP, plant::kNine_in_ten * told.deviation.CP);
  }
  // "mine, at rest: CT, WMAPE"; nothing where nothing was judged.
  void report_as(const std::string& whose, Pair& pair) const {
    if (CT.n == 0) return;
    report(pair.CT, whose + ": CT, WMAPE", CT.wmape_percent());
    report(pair.CT, whose + ": CT, mean error", CT.mean_percent());
    report(pair.CP, whose + ": CP, WMAPE", CP.wmape_percent());
    report(pair.CP, whose + ": CP, mean error", CP.mean_percent());
  }
  ForwardJudged judged() const {
    const double n = std::max(CT.n, 1);
    return {CT.wmape_percent(),
            CP.wmape_percent(),
            CT.mean_percent(),
            CP.mean_percent(),
            100.0 * CT.inside / n,
            100.0 * CP.inside / n,
            CT.n};
  }
};

double zero_thrust_J(const Teller& teller, double omega) {
  for (double J = 0.2; J < 2.0; J += 0.02) {
    if (teller.tell({{omega, J, 0, 0}}).front().mean.CT < 0.0) return J;
  }
  return 2.0;
}

void curve_over_J(const Teller& teller, double omega, Pair& pair) {
  const double end = zero_thrust_J(teller, omega);
  std::vector<double> x;
  std::vector<MeasuredPoint> where;
  for (int i = 0; i <= 24; ++i) {
    x.push_back(end * i / 24.0);
    where.push_back({omega, x.back(), 0, 0});
  }
  pair.draw_with_band(rpm_text(omega), x, where, teller);
}

void add_over_J(const Teller& teller, const std::vector<MeasuredFile>& measured,
                const Options& options, ForwardSweep& sweep) {
  Pair pair("In flight, over J = V/(n D)", "advance ratio J");
  std::set<std::string> drawn;
  const auto curve = [&](double omega) {
    if (drawn.insert(rpm_text(omega)).second) curve_over_J(teller, omega, pair);
  };
  for (const double omega : options.speeds_radps) curve(omega);
  Tallies all;
  for (const MeasuredFile& file : measured) {
    std::vector<MeasuredPoint> flying;
    for (const MeasuredPoint& p : file.points) {
      if (p.advance_ratio > 0.1) flying.push_back(p);
    }
    if (flying.empty()) continue;
    curve(flying.front().omega_radps);
    std::vector<double> x;
    const auto told = teller.tell(flying);
    Tallies own;
    for (std::size_t i = 0; i < flying.size(); ++i) {
      x.push_back(flying[i].advance_ratio);
      if (!(flying[i].CT > 0.0 && flying[i].CP > 0.0)) continue;
      own.add(told[i], flying[i]), all.add(told[i], flying[i]);
    }
    pair.mark(file.name, x, flying);
    own.report_as(file.name + ", in flight", pair);
  }
  if (drawn.empty()) {
    const double speed = options.speed_radps > 0.0 ? options.speed_radps : options.top_speed_radps;
    for (const double share : {0.5, 0.75, 1.0}) curve(share * speed);
  }
  sweep.flight = all.judged();
  all.report_as("all in flight", pair);
  sweep.charts.insert(sweep.charts.end(), {pair.CT, pair.CP});
}

void add_over_speed(const Teller& teller, const std::vector<MeasuredFile>& measured,
                    const Options& options, ForwardSweep& sweep) {
  double top = options.speed_radps > 0.0 ? options.speed_radps : options.top_speed_radps;
  for (const double omega : options.speeds_radps) top = std::max(top, omega);
  for (const MeasuredFile& file : measured) {
    for (const MeasuredPoint& p : file.points) top = std::max(top, p.omega_radps);
  }
  Pair pair("Over speed, at chosen J", "speed / rpm");
  for (const double J : options.advance_ratios) {
    std::vector<double> x;
    std::vector<MeasuredPoint> where;
    for (int i = 4; i <= 20; ++i) {
      where.push_back({top * i / 20.0, J, 0, 0});
      x.push_back(rpm_of(where.back().omega_radps));
    }
    char name[32];
    std::snprintf(name, sizeof name, "J = %.3g", J);
    pair.draw_with_band(name, x, where, teller);
  }
  Tallies all;
  for (const MeasuredFile& file : measured) {
    std::vector<MeasuredPoint> still;
    std::vector<double> x;
    for (const MeasuredPoint& p : file.points) {
      if (p.advance_ratio <= 0.1) still.push_back(p), x.push_back(rpm_of(p.omega_radps));
    }
    if (still.empty()) continue;
    const auto told = teller.tell(still);
    Tallies own;
    for (std::size_t i = 0; i < still.size(); ++i) {
      own.add(told[i], still[i]), all.add(told[i], still[i]);
    }
    pair.mark(file.name, x, still);
    own.report_as(file.name + ", at rest", pair);
  }
  sweep.at_rest = all.judged();
  all.report_as("all at rest", pair);
  sweep.charts.insert(sweep.charts.end(), {pair.CT, pair.CP});
}

}  // namespace

ForwardSweep forward_sweep(const SweptPropeller& propeller,
                           const std::vector<MeasuredFile>& measured, const Options& options) {
  const Teller teller{propeller};
  ForwardSweep sweep;
  add_over_J(teller, measured, options, sweep);
  add_over_speed(teller, measured, options, sweep);
  std::vector<std::string> doubts;
  if (propeller.fit != nullptr) doubts = propeller.fit->doubts;
  if (propeller.twist != nullptr) doubts = propeller.twist->doubts;
  std::string& note = sweep.charts.front().note;
  for (const std::string& doubt : doubts) note += (note.empty() ? "" : "; ") + doubt;
  return sweep;
}

namespace {

std::string left_over_line(double thrust_off, double power_off) {
  char text[80];
  std::snprintf(text, sizeof text, "static rows leave over: CT %.1f %%, CP %.1f %%",
                100.0 * thrust_off, 100.0 * power_off);
  return text;
}

}  // namespace

std::vector<std::string> twist_lines(const plant::TwistedBlade& twist) {
  std::vector<std::string> lines;
  char text[160];
  const double deg = twist.tip_twist_rad * 180.0 / std::numbers::pi;
  std::snprintf(text, sizeof text, "tip twist: %+.2f deg, %s", deg,
                twist.found ? "found on the static rows" : "as the file gives it: no static rows");
  lines.emplace_back(text);
  if (twist.found) {
    lines.push_back(left_over_line(twist.thrust_off, twist.power_off));
    std::snprintf(text, sizeof text, "static thrust answers to twist: %.1f %% per degree",
                  100.0 * twist.answer_per_deg);
    lines.emplace_back(text);
  }
  for (const plant::SectionStation& s : twist.description.sections) {
    const double within = s.polar->drag_within();
    std::snprintf(text, sizeof text, "section from r = %.2f: %s, ", s.r_over_R,
                  s.polar->name().substr(0, 60).c_str());
    lines.push_back(std::string(text) +
                    (within > 0.0
                         ? "drag within " + std::to_string(std::lround(100.0 * within)) + " %"
                         : "no error of its drag is stated"));
  }
  for (const std::string& doubt : twist.doubts) lines.push_back("doubt: " + doubt);
  return lines;
}

std::vector<std::string> fit_lines(const plant::FittedBlade& fit) {
  std::vector<std::string> lines = {left_over_line(fit.thrust_off, fit.power_off)};
  char text[160];
  for (int i = 0; i < plant::kTraits; ++i) {
    std::snprintf(text, sizeof text, "%s: %.3g, +- %.2g (90 %%)",
                  std::string(plant::kTrait_names[static_cast<std::size_t>(i)]).c_str(),
                  fit.belief.mean[i], plant::kNine_in_ten * std::sqrt(fit.belief.covariance(i, i)));
    lines.emplace_back(text);
  }
  for (const std::string& doubt : fit.doubts) lines.push_back("doubt: " + doubt);
  return lines;
}

}  // namespace whirl::sweep
