// How well a propeller's curve in flight was foretold, and what many such scores come to.
//
//   Error    sum of |error| over sum of |measured|, in percent
//   Band     stated 90 %: share of measured points inside, half-width over the mean of the measured
//   Slope    dCP/dJ by least squares within each run of one speed, all runs together: what power tells of inflow. Over all J
//            off by a share of the measured; from where the data begin to J 0.3, where rotors of hover lie in wind (4 m/s
//            at 5000 rpm and 10 in: 0.19), in percent of the mean CP there for each 0.1 of J. Told, not judged
//   Asked    what a propeller never seen is to get. A figure that does not reach it says so in its name and keeps
//            a wider limit, from what it was when that was written: a bound that it may not lose again
#pragma once
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "plant/rotor/blade_fit.hpp"
#include "plant/validation/report.hpp"

namespace whirl::plant {

inline constexpr double kUnjudged = std::numeric_limits<double>::infinity();

struct Score {  // in percent; shares of 1
  double CT = 0, CP = 0;
  double inside_CT = 0, inside_CP = 0;
  double half_CT = 0, half_CP = 0;
  bool refused = false;
  double slope_CP = kUnjudged,
         low_slope_CP = kUnjudged;  // errors, in percent; where nothing tells a slope: none
  double surprise =
      0;  // of its static rows, the larger of thrust's and power's; standard deviations
};

Score score(const AxialBlade& blade, const TraitBelief& belief,
            const std::vector<MeasuredPoint>& points);
std::string line(const std::string& name, const char* how, const Score& s);

// Of the points up to most_J: nothing where no run has two of different J.
std::optional<double> slope_over_J(const std::vector<MeasuredPoint>& points,
                                   double MeasuredPoint::*coefficient, double most_J);

double quantile(std::vector<double> values, double share);
// Of those not refused; with `missed`, a refused one counts as infinitely off.
std::vector<double> column(const std::vector<Score>& scores, double Score::*field, bool missed);

struct Limits {
  double median_CT, median_CP, most_CT, most_CP, outside, half_CT, half_CP, refused;
};
inline constexpr Limits kAsked{6.0, 8.0, 12.0, 14.0, 10.0, 12.0, 15.0, 3.0};
inline constexpr Limits kNothing{kUnjudged, kUnjudged, kUnjudged, kUnjudged,
                                 kUnjudged, kUnjudged, kUnjudged, kUnjudged};

// Judged by `limits`, told against `asked`: how many of it are reached, and which are not.
void add_summary(const std::string& how, const std::vector<Score>& scores, const Limits& limits,
                 const Limits& asked, Report& report);

// The median errors of the slopes, told only.
void add_slopes(const std::string& how, const std::vector<Score>& scores, Report& report);

}  // namespace whirl::plant
