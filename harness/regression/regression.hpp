// Linear least squares as an engineer reports it: values with 95 % confidence, R2, condition.
//
//   Method   columns scaled to unit length, then singular values; intervals by Student's t
//   Correlated residuals (samples of a transient) carry less than their number says: `ordered` multiplies
//            the variances by (1 + r) / (1 - r), r being the residuals' lag-one correlation
//   Errors   bad_input: too few points, a value that is no number, columns that the data cannot tell
//            apart (condition above worst_condition): the message names them
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"

namespace whirl::regression {

struct Column {
  std::string name, unit;
  std::vector<double> x;
};

inline constexpr double kWorstCondition = 1000.0;

struct Problem {
  std::string name;          // "motor voltage"
  std::string wanted, unit;  // what y is
  std::vector<double> y;
  std::vector<Column> columns;    // y = sum of coefficient x column
  std::vector<double> weights{};  // of a residual, per point; empty: all 1
  bool ordered = false;           // in time: residuals may be correlated
  double worst_condition = kWorstCondition;
};

struct Coefficient {
  std::string name, unit;
  double value = 0.0;
  double error = 0.0;       // standard error
  double half_width = 0.0;  // of the 95 % interval
};

struct Fit {
  std::string name, wanted, unit;
  std::vector<Coefficient> coefficients;
  double r2 = 0.0;            // about the mean
  double residual_rms = 0.0;  // in the unit of y
  double condition = 0.0;     // of the scaled columns
  double t95 = 0.0;           // half width of an interval over its standard error
  std::vector<double> y, residuals;
  std::vector<double> covariance;  // of the coefficients, row by row

  const Coefficient& operator[](const std::string& coefficient) const;
  double value(const std::string& coefficient) const { return (*this)[coefficient].value; }
};

// What is derived from a fit, with its interval to first order.
Coefficient quotient(const Fit& fit, const std::string& over, const std::string& under,
                     const std::string& name, const std::string& unit);
Coefficient inverse(const Fit& fit, const std::string& of, const std::string& name,
                    const std::string& unit);

Result<Fit> solve(const Problem& problem);

double student_t95(double degrees_of_freedom);  // two-sided

}  // namespace whirl::regression
