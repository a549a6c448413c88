#include "harness/sweep/forward_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/rpm.hpp"
#include "harness/sweep/tally.hpp"
#include "plant/rotor/twist_fit.hpp"

namespace whirl::sweep {
namespace {

using plant::MeasuredPoint;
using plant::Prediction;
using results::Chart;
using results::ChartCurve;

struct Teller {
  const std::shared_ptr<const plant::Blade>& blade;
  const plant::FittedBlade* fit;

  std::vector<Prediction> tell(const std::vector<MeasuredPoint>& where) const {
    if (fit != nullptr) return plant::predict(fit->axial, fit->belief, where);
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

ForwardJudged judged(const BandTally& T, const BandTally& P) {
  const double n = std::max(T.n, 1);
  return {T.wmape_percent(),
          P.wmape_percent(),
          T.mean_percent(),
          P.mean_percent(),
          100.0 * T.inside / n,
          100.0 * P.inside / n,
          T.n};
}

struct Pair {  // CT and CP charts side by side
  Chart CT, CP;
  Pair(const std::string& group, const std::string& x_label)
      : CT{group, "CT = T / (rho n2 D4)", x_label, "CT", "", "", {}, {}},
        CP{group, "CP = P / (rho n3 D5)", x_label, "CP", "", "", {}, {}} {}

  void draw(const std::string& name, const std::vector<double>& x,
            const std::vector<Prediction>& told, bool band) {
    ChartCurve t{name, x, {}}, p{name, x, {}};
    for (const Prediction& k : told) t.y.push_back(k.mean.CT), p.y.push_back(k.mean.CP);
    CT.curves.push_back(t), CP.curves.push_back(p);
    if (!band) return;
    for (const double side : {-plant::kNine_in_ten, plant::kNine_in_ten}) {
      ChartCurve tb{"", x, {}, false, true}, pb{"", x, {}, false, true};
      if (side > 0) tb.name = pb.name = name + ", 90 % band";
      for (const Prediction& k : told) {
        tb.y.push_back(k.mean.CT + side * k.deviation.CT);
        pb.y.push_back(k.mean.CP + side * k.deviation.CP);
      }
      CT.curves.push_back(tb), CP.curves.push_back(pb);
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

double zero_thrust_J(const Teller& teller, double omega) {
  for (double J = 0.2; J < 2.0; J += 0.02) {
    if (teller.tell({{omega, J, 0, 0}}).front().mean.CT < 0.0) return J;
  }
  return 2.0;
}

void add_over_J(const Teller& teller, const std::vector<MeasuredFile>& measured, double speed_radps,
                ForwardSweep& sweep) {
  Pair pair("In flight, over J = V/(n D)", "advance ratio J");
  BandTally T, P;
  const auto curve = [&](double omega) {
    const double end = zero_thrust_J(teller, omega);
    std::vector<double> x;
    std::vector<MeasuredPoint> where;
    for (int i = 0; i <= 24; ++i) {
      x.push_back(end * i / 24.0);
      where.push_back({omega, x.back(), 0, 0});
    }
    pair.draw(rpm_text(omega), x, teller.tell(where), teller.fit != nullptr);
  };
  for (const MeasuredFile& file : measured) {
    std::vector<MeasuredPoint> flying;
    for (const MeasuredPoint& p : file.points) {
      if (p.advance_ratio > 0.1) flying.push_back(p);
    }
    if (flying.empty()) continue;
    curve(flying.front().omega_radps);
    std::vector<double> x;
    const auto told = teller.tell(flying);
    BandTally t, p;
    for (std::size_t i = 0; i < flying.size(); ++i) {
      x.push_back(flying[i].advance_ratio);
      if (!(flying[i].CT > 0.0 && flying[i].CP > 0.0)) continue;
      for (BandTally* each : {&t, &T}) {
        each->add(told[i].mean.CT, flying[i].CT, plant::kNine_in_ten * told[i].deviation.CT);
      }
      for (BandTally* each : {&p, &P}) {
        each->add(told[i].mean.CP, flying[i].CP, plant::kNine_in_ten * told[i].deviation.CP);
      }
    }
    pair.mark(file.name, x, flying);
    report(pair.CT, file.name + ": CT, WMAPE", t.wmape_percent());
    report(pair.CT, file.name + ": CT, mean error", t.mean_percent());
    report(pair.CP, file.name + ": CP, WMAPE", p.wmape_percent());
    report(pair.CP, file.name + ": CP, mean error", p.mean_percent());
  }
  if (pair.CT.curves.empty()) {
    for (const double share : {0.5, 0.75, 1.0}) curve(share * speed_radps);
  }
  sweep.flight = judged(T, P);
  if (T.n > 0) {
    report(pair.CT, "all in flight: CT, WMAPE", sweep.flight.CT_percent);
    report(pair.CP, "all in flight: CP, WMAPE", sweep.flight.CP_percent);
  }
  sweep.charts.insert(sweep.charts.end(), {pair.CT, pair.CP});
}

void add_over_speed(const Teller& teller, const std::vector<MeasuredFile>& measured,
                    double top_radps, ForwardSweep& sweep) {
  Pair pair("Over speed, at chosen J", "speed / rpm");
  for (const double J : {0.0, 0.2, 0.4}) {
    std::vector<double> x;
    std::vector<MeasuredPoint> where;
    for (int i = 4; i <= 20; ++i) {
      where.push_back({top_radps * i / 20.0, J, 0, 0});
      x.push_back(rpm_of(where.back().omega_radps));
    }
    char name[16];
    std::snprintf(name, sizeof name, "J = %.1f", J);
    pair.draw(name, x, teller.tell(where), teller.fit != nullptr && J == 0.0);
  }
  BandTally T, P;
  for (const MeasuredFile& file : measured) {
    std::vector<MeasuredPoint> still;
    std::vector<double> x;
    for (const MeasuredPoint& p : file.points) {
      if (p.advance_ratio <= 0.1) still.push_back(p), x.push_back(rpm_of(p.omega_radps));
    }
    if (still.empty()) continue;
    const auto told = teller.tell(still);
    for (std::size_t i = 0; i < still.size(); ++i) {
      T.add(told[i].mean.CT, still[i].CT, plant::kNine_in_ten * told[i].deviation.CT);
      P.add(told[i].mean.CP, still[i].CP, plant::kNine_in_ten * told[i].deviation.CP);
    }
    pair.mark(file.name, x, still);
  }
  sweep.at_rest = judged(T, P);
  if (T.n > 0) {
    report(pair.CT, "all at rest: CT, WMAPE", sweep.at_rest.CT_percent);
    report(pair.CP, "all at rest: CP, WMAPE", sweep.at_rest.CP_percent);
  }
  sweep.charts.insert(sweep.charts.end(), {pair.CT, pair.CP});
}

}  // namespace

ForwardSweep forward_sweep(const std::shared_ptr<const plant::Blade>& blade,
                           const plant::FittedBlade* fit, const std::vector<MeasuredFile>& measured,
                           double speed_radps) {
  const Teller teller{blade, fit};
  double top = speed_radps;
  for (const MeasuredFile& file : measured) {
    for (const MeasuredPoint& p : file.points) top = std::max(top, p.omega_radps);
  }
  ForwardSweep sweep;
  add_over_J(teller, measured, speed_radps, sweep);
  add_over_speed(teller, measured, top, sweep);
  if (fit != nullptr) {
    std::string& note = sweep.charts.front().note;
    for (const std::string& doubt : fit->doubts) note += (note.empty() ? "" : "; ") + doubt;
  }
  return sweep;
}

std::vector<std::string> fit_lines(const plant::FittedBlade& fit) {
  std::vector<std::string> lines;
  char text[160];
  std::snprintf(text, sizeof text, "static rows leave over: CT %.1f %%, CP %.1f %%",
                100.0 * fit.thrust_off, 100.0 * fit.power_off);
  lines.emplace_back(text);
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
