#include "plant/rotor/fitted_blade.hpp"

#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "base/check.hpp"
#include "plant/rotor/blade_rings.hpp"
#include "plant/rotor/known_blades.hpp"

namespace whirl::plant {
namespace {

constexpr double kStrange = 0.75;
constexpr double kSurprising = 3.0;  // standard deviations
// Power is then about twice what the shape takes: a wrong unit, a wrong column.
constexpr double kGross = 8.0;

std::string said(const char* format, double a, double b = 0.0) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

std::vector<MeasuredPoint> at_rest(const std::vector<StaticPoint>& rows) {
  std::vector<MeasuredPoint> points;
  points.reserve(rows.size());
  for (const StaticPoint& row : rows) {
    points.push_back({row.omega_radps, 0.0, row.thrust_coefficient, row.power_coefficient});
  }
  return points;
}

std::vector<MeasuredPoint> in_flight(const std::vector<FlightPoint>& rows) {
  std::vector<MeasuredPoint> points;
  points.reserve(rows.size());
  for (const FlightPoint& row : rows) {
    points.push_back(
        {row.omega_radps, row.advance_ratio, row.thrust_coefficient, row.power_coefficient});
  }
  return points;
}

struct LeftOver {
  double CT = 0.0, CP = 0.0;
};

// Sum of |error| over sum of measured; 0 where nothing was.
LeftOver left_over(const FittedBlade& fit, const std::vector<MeasuredPoint>& points) {
  double thrust = 0.0, power = 0.0, thrust_off = 0.0, power_off = 0.0;
  for (const MeasuredPoint& p : points) {
    const auto k = axial_coefficients(fit.axial, fit.belief.mean, p.omega_radps, p.advance_ratio);
    thrust += p.CT;
    thrust_off += std::abs(k.CT - p.CT);
    if (p.CP == 0.0) continue;
    power += p.CP;
    power_off += std::abs(k.CP - p.CP);
  }
  return {thrust > 0.0 ? thrust_off / thrust : 0.0, power > 0.0 ? power_off / power : 0.0};
}

// How far the rows lie from what was believed before them, in its own standard deviations.
void surprise(const std::vector<StaticPoint>& rows, FittedBlade& fit) {
  const auto before = predict(fit.axial, fit.belief, at_rest(rows));
  double powers = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Prediction& p = before[i];
    fit.thrust_surprise += (rows[i].thrust_coefficient - p.mean.CT) / p.deviation.CT /
                           static_cast<double>(rows.size());
    if (rows[i].power_coefficient == 0.0) continue;
    fit.power_surprise += (rows[i].power_coefficient - p.mean.CP) / p.deviation.CP;
    powers += 1.0;
  }
  if (powers > 0.0) fit.power_surprise /= powers;
}

double answer_to_twist(const FittedBlade& fit, double omega_radps) {
  TraitVector more = fit.belief.mean;
  more[tip_twist_deg] += 1.0;
  const double here = axial_coefficients(fit.axial, fit.belief.mean, omega_radps, 0.0).CT;
  return axial_coefficients(fit.axial, more, omega_radps, 0.0).CT / here - 1.0;
}

std::optional<Error> refusal(const PropellerDescription& d, const FittedBlade& fit) {
  const double twist = fit.belief.mean[tip_twist_deg];
  if (fit.thrust_off > kMost_left) {
    return Error{ErrorKind::bad_input, d.place,
                 said("no blade of this shape gives the static thrust: %.0f %% are left over",
                      100.0 * fit.thrust_off),
                 "check diameter, chord, angle and the unit of the thrust"};
  }
  if (twist < kLowest_twist_deg - kRefused_beyond_deg ||
      twist > kHighest_twist_deg + kRefused_beyond_deg) {
    return Error{ErrorKind::bad_input, d.place,
                 said("static thrust asks for %+.1f deg of tip twist", twist),
                 "angles read off photographs err by -1 to 4 deg; measure them again"};
  }
  return {};
}

std::optional<Error> gross(const PropellerDescription& d, const FittedBlade& fit) {
  for (const auto& [what, sigmas] :
       {std::pair("thrust", fit.thrust_surprise), std::pair("power", fit.power_surprise)}) {
    if (std::abs(sigmas) <= kGross) continue;
    return Error{
        ErrorKind::bad_input, d.place,
        std::string("static ") + what +
            said(" is %+.1f standard deviations off what blades of this shape take", sigmas),
        "check its unit, the density and the diameter; power is that of the shaft"};
  }
  return {};
}

void note_doubts(const PropellerDescription& d, FittedBlade& fit) {
  const double twist = fit.belief.mean[tip_twist_deg];
  const auto doubt = [&fit](const std::string& text) {
    if (!text.empty()) fit.doubts.push_back(text);
  };
  if (d.static_points.empty()) {
    fit.doubts.emplace_back("no static rows: its angles may be off by -1 to 4 deg, see the band");
  } else {
    doubt(answer_doubt(answer_to_twist(fit, d.static_points.back().omega_radps)));
  }
  doubt(twist_doubt(twist));
  doubt(power_doubt(fit.power_off));
  if (fit.flight_thrust_off > kMost_left) {
    fit.doubts.push_back(said("thrust in flight is left over by %.0f %%: check J, rpm and the unit",
                              100.0 * fit.flight_thrust_off));
  }
  for (const auto& [what, sigmas] :
       {std::pair("thrust", fit.thrust_surprise), std::pair("power", fit.power_surprise)}) {
    if (std::abs(sigmas) <= kSurprising) continue;
    fit.doubts.push_back(std::string("static ") + what +
                         said(" is %+.1f standard deviations off what blades of this shape take: "
                              "check its unit, the density and the diameter",
                              sigmas));
  }
  if (fit.belief.strange_make) {
    fit.doubts.emplace_back(
        d.make.empty() ? "its make is not named: its band is that of a make nobody measured"
                       : "no propeller of its make was measured: its band is wider");
  }
  if (fit.strangeness > kStrange) {
    fit.doubts.emplace_back("its shape is like that of no propeller measured so far");
  }
}

}  // namespace

Result<FittedBlade> fit_blade(PropellerDescription d) {
  WHIRL_CHECK(d.known != nullptr);
  // Every fault of the description is told before anything is fitted on it.
  d.traits = std::make_shared<const TraitBelief>(first_belief(d.drawn));
  if (const auto sound = make_blade(d); !sound) return sound.error();
  FittedBlade fit;
  fit.axial = axial_blade(d, kRing_count);
  const BladeShape shape = blade_shape(d.stations);
  fit.strangeness = d.known->strangeness(shape);
  const bool given = d.tip_twist_correction_rad != 0.0;
  fit.belief = d.known->prior_for(shape, d.drawn || given);
  fit.belief.strange_make = !d.known->knows(d.make);
  if (given) fit.belief.mean[tip_twist_deg] = d.tip_twist_correction_rad * 180.0 / 3.14159265358979;
  surprise(d.static_points, fit);
  std::vector<TrustedSet> sets;
  if (!d.static_points.empty()) sets.push_back({at_rest(d.static_points), kStatic_trust});
  if (!d.flight_points.empty()) sets.push_back({in_flight(d.flight_points), kFlight_trust});
  if (!sets.empty()) fit.belief = fit_traits(fit.axial, sets, fit.belief);
  const LeftOver still = left_over(fit, at_rest(d.static_points));
  fit.thrust_off = still.CT;
  fit.power_off = still.CP;
  fit.flight_thrust_off = left_over(fit, in_flight(d.flight_points)).CT;
  if (auto no = refusal(d, fit)) return *no;
  if (auto no = gross(d, fit)) return *no;
  note_doubts(d, fit);
  d.traits = std::make_shared<const TraitBelief>(fit.belief);
  const auto made = make_blade(d);
  if (!made) return made.error();
  fit.blade = made.value();
  return fit;
}

}  // namespace whirl::plant
