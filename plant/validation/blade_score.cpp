#include "plant/validation/blade_score.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace whirl::plant {
namespace {

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double outside(const std::vector<Score>& scores, double Score::*inside) {
  return 100.0 * (1.0 - mean(column(scores, inside, false)));
}

constexpr double kHover_J = 0.3;

double mean_CP(const std::vector<MeasuredPoint>& points, double most_J) {
  double sum = 0, n = 0;
  for (const MeasuredPoint& p : points) {
    if (p.advance_ratio <= most_J) sum += p.CP, n += 1;
  }
  return sum / n;
}

// told: the same points as foretold.
void score_slopes(const std::vector<MeasuredPoint>& points, const std::vector<MeasuredPoint>& told,
                  Score& s) {
  const auto off = [&](double most_J, double scale) {
    const auto is = slope_over_J(points, &MeasuredPoint::CP, most_J);
    const auto was_told = slope_over_J(told, &MeasuredPoint::CP, most_J);
    if (!is || !was_told) return kUnjudged;
    return 100.0 * std::abs(*was_told - *is) / (scale > 0.0 ? scale : std::abs(*is));
  };
  s.slope_CP = off(kUnjudged, 0.0);
  s.low_slope_CP = off(kHover_J, 10.0 * mean_CP(points, kHover_J));
}

std::string not_reached(double asked) {
  char text[40];
  std::snprintf(text, sizeof text, " (asked %g: not reached)", asked);
  return text;
}

}  // namespace

std::optional<double> slope_over_J(const std::vector<MeasuredPoint>& points,
                                   double MeasuredPoint::*coefficient, double most_J) {
  struct Sums {
    double n = 0, J = 0, C = 0, JJ = 0, JC = 0;
  };
  std::map<double, Sums> runs;
  for (const MeasuredPoint& p : points) {
    if (p.advance_ratio > most_J) continue;
    Sums& r = runs[p.omega_radps];
    const double J = p.advance_ratio, C = p.*coefficient;
    r.n += 1, r.J += J, r.C += C, r.JJ += J * J, r.JC += J * C;
  }
  double over = 0, under = 0;
  for (const auto& [omega_radps, r] : runs) {
    over += r.JC - r.J * r.C / r.n, under += r.JJ - r.J * r.J / r.n;
  }
  if (under <= 1e-12) return {};
  return over / under;
}

Score score(const AxialBlade& blade, const TraitBelief& belief,
            const std::vector<MeasuredPoint>& points) {
  Score s;
  double T = 0, P = 0;
  const auto answers = predict(blade, belief, points);
  std::vector<MeasuredPoint> told = points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Prediction& a = answers[i];
    told[i].CP = a.mean.CP;
    const double off_T = std::abs(a.mean.CT - points[i].CT);
    const double off_P = std::abs(a.mean.CP - points[i].CP);
    T += std::abs(points[i].CT), P += std::abs(points[i].CP);
    s.CT += off_T, s.CP += off_P;
    s.half_CT += kNine_in_ten * a.deviation.CT, s.half_CP += kNine_in_ten * a.deviation.CP;
    s.inside_CT += off_T <= kNine_in_ten * a.deviation.CT ? 1 : 0;
    s.inside_CP += off_P <= kNine_in_ten * a.deviation.CP ? 1 : 0;
  }
  const auto n = static_cast<double>(points.size());
  s.CT *= 100 / T, s.CP *= 100 / P, s.half_CT *= 100 / T, s.half_CP *= 100 / P;
  s.inside_CT /= n, s.inside_CP /= n;
  score_slopes(points, told, s);
  return s;
}

std::string line(const std::string& name, const char* how, const Score& s) {
  char text[200];
  if (s.refused) return name + ", " + how + ": refused";
  std::snprintf(text, sizeof text,
                "%s, %s: flight CT %.1f %%, CP %.1f %%; inside the band %.0f %% and %.0f %%, "
                "half-width %.0f %% and %.0f %%",
                name.c_str(), how, s.CT, s.CP, 100 * s.inside_CT, 100 * s.inside_CP, s.half_CT,
                s.half_CP);
  return text;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return kUnjudged;  // every one was refused
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const auto i = static_cast<std::size_t>(at);
  if (i + 1 >= values.size()) return values.back();
  if (std::isinf(values[i + 1])) return at > static_cast<double>(i) ? values[i + 1] : values[i];
  return values[i] + (at - static_cast<double>(i)) * (values[i + 1] - values[i]);
}

std::vector<double> column(const std::vector<Score>& scores, double Score::*field, bool missed) {
  std::vector<double> values;
  for (const Score& s : scores) {
    if (!s.refused) values.push_back(s.*field);
    if (s.refused && missed) values.push_back(kUnjudged);
  }
  return values;
}

void add_summary(const std::string& how, const std::vector<Score>& scores, const Limits& limits,
                 const Limits& asked, Report& report) {
  int questions = 0, reached = 0;
  const auto add = [&](const char* what, const char* unit, double value, double Limits::*of) {
    const bool good = value <= asked.*of;
    ++questions, reached += good ? 1 : 0;
    report.figures.push_back(
        {how + ": " + what + (good ? "" : not_reached(asked.*of)), unit, value, limits.*of});
  };
  const auto share = [&](double Score::*field, double part, bool missed) {
    return quantile(column(scores, field, missed), part);
  };
  add("flight CT, median", "%", share(&Score::CT, 0.5, false), &Limits::median_CT);
  add("flight CP, median", "%", share(&Score::CP, 0.5, false), &Limits::median_CP);
  add("flight CT, nine in ten", "%", share(&Score::CT, 0.9, true), &Limits::most_CT);
  add("flight CP, nine in ten", "%", share(&Score::CP, 0.9, true), &Limits::most_CP);
  add("CT outside the 90 % band", "%", outside(scores, &Score::inside_CT), &Limits::outside);
  add("CP outside the 90 % band", "%", outside(scores, &Score::inside_CP), &Limits::outside);
  add("half-width on CT, median", "%", share(&Score::half_CT, 0.5, false), &Limits::half_CT);
  add("half-width on CP, median", "%", share(&Score::half_CP, 0.5, false), &Limits::half_CP);
  add("refused", "propellers",
      static_cast<double>(
          std::count_if(scores.begin(), scores.end(), [](const Score& s) { return s.refused; })),
      &Limits::refused);
  if (std::isinf(asked.median_CT)) return;  // nothing is
  report.figures.push_back({how + ": reached of what is asked", "of " + std::to_string(questions),
                            static_cast<double>(reached), kUnjudged});
}

void add_slopes(const std::string& how, const std::vector<Score>& scores, Report& report) {
  const auto add = [&](const char* what, const char* unit, double Score::*field) {
    std::vector<double> told;
    for (const double off : column(scores, field, false)) {
      if (std::isfinite(off)) told.push_back(off);
    }
    report.figures.push_back({how + ": " + what + ", median of " + std::to_string(told.size()),
                              unit, quantile(told, 0.5), kUnjudged});
  };
  add("slope of CP over J off by", "%", &Score::slope_CP);
  add("slope of CP to J 0.3 off by, of CP", "% per 0.1", &Score::low_slope_CP);
}

}  // namespace whirl::plant
