#include "harness/regression/regression.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/check.hpp"

namespace whirl::regression {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Error refuse(const Problem& p, const std::string& what, const std::string& cure) {
  return {ErrorKind::bad_input, "fit of " + p.name, what, cure};
}

bool finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

Result<Done> check(const Problem& p) {
  WHIRL_CHECK(!p.columns.empty());
  WHIRL_CHECK(p.weights.empty() || p.weights.size() == p.y.size());
  for (const Column& c : p.columns) {
    WHIRL_CHECK(c.x.size() == p.y.size(), c.x.size(), p.y.size());
    if (!finite(c.x)) return refuse(p, "a value of " + c.name + " is not a number", "");
  }
  if (!finite(p.y) || !finite(p.weights)) return refuse(p, "a value is not a number", "");
  if (p.y.size() < p.columns.size() + 2) {
    return refuse(p,
                  std::to_string(p.y.size()) + " points are too few for " +
                      std::to_string(p.columns.size()) + " constants",
                  "measure more points");
  }
  return Done{};
}

// The names that make up the direction which the data say nothing about.
std::string blended(const Problem& p, const VectorXd& direction) {
  std::string names;
  for (std::size_t i = 0; i < p.columns.size(); ++i) {
    if (std::abs(direction(static_cast<Eigen::Index>(i))) < 0.2) continue;
    names += (names.empty() ? "" : " and ") + p.columns[i].name;
  }
  return names;
}

double lag_one(const VectorXd& r) {
  const Eigen::Index n = r.size() - 1;
  const double square = r.squaredNorm();
  return square > 0.0 ? r.head(n).dot(r.tail(n)) / square : 0.0;
}

double r_squared(const VectorXd& y, const VectorXd& residuals) {
  const double about_mean = (y.array() - y.mean()).matrix().squaredNorm();
  return about_mean > 0.0 ? 1.0 - residuals.squaredNorm() / about_mean : 0.0;
}

std::vector<double> listed(const VectorXd& v) {
  return {v.data(), v.data() + v.size()};
}

std::size_t place(const Fit& fit, const std::string& name) {
  for (std::size_t i = 0; i < fit.coefficients.size(); ++i) {
    if (fit.coefficients[i].name == name) return i;
  }
  WHIRL_CHECK(false, name);
  return 0;
}

}  // namespace

const Coefficient& Fit::operator[](const std::string& coefficient) const {
  return coefficients[place(*this, coefficient)];
}

Coefficient quotient(const Fit& fit, const std::string& over, const std::string& under,
                     const std::string& name, const std::string& unit) {
  const std::size_t n = fit.coefficients.size(), a = place(fit, over), b = place(fit, under);
  const double x = fit.coefficients[a].value, y = fit.coefficients[b].value;
  const double variance = (fit.covariance[a * n + a] - 2.0 * x / y * fit.covariance[a * n + b] +
                           x * x / (y * y) * fit.covariance[b * n + b]) /
                          (y * y);
  const double error = std::sqrt(std::max(0.0, variance));
  return {name, unit, x / y, error, fit.t95 * error};
}

Coefficient inverse(const Fit& fit, const std::string& of, const std::string& name,
                    const std::string& unit) {
  const Coefficient& c = fit[of];
  const double square = c.value * c.value;
  return {name, unit, 1.0 / c.value, c.error / square, c.half_width / square};
}

// A table up to 5; Cornish and Fisher's expansion beyond, within 0.1 %.
double student_t95(double n) {
  constexpr double kFew[] = {12.706, 12.706, 4.303, 3.182, 2.776, 2.571};
  if (n < 5.5) return kFew[static_cast<int>(std::max(0.0, n + 0.5))];
  const double z = 1.959964, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

Result<Fit> solve(const Problem& p) {
  if (const auto good = check(p); !good) return good.error();
  const auto rows = static_cast<Eigen::Index>(p.y.size());
  const auto columns = static_cast<Eigen::Index>(p.columns.size());
  const VectorXd y = Eigen::Map<const VectorXd>(p.y.data(), rows);
  const VectorXd weight = p.weights.empty()
                              ? VectorXd::Ones(rows).eval()
                              : Eigen::Map<const VectorXd>(p.weights.data(), rows).eval();
  MatrixXd a(rows, columns);
  for (Eigen::Index c = 0; c < columns; ++c) {
    a.col(c) = Eigen::Map<const VectorXd>(p.columns[static_cast<std::size_t>(c)].x.data(), rows);
  }
  MatrixXd scaled = weight.asDiagonal() * a;
  const VectorXd length = scaled.colwise().norm();
  for (Eigen::Index c = 0; c < columns; ++c) {
    if (length(c) > 0.0) scaled.col(c) /= length(c);
  }
  if (!scaled.allFinite() || !length.allFinite() || !weight.cwiseProduct(y).allFinite()) {
    return refuse(p, "the data are beyond what can be computed with", "look for a wrong unit");
  }
  const Eigen::JacobiSVD<MatrixXd> svd(scaled, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const VectorXd& s = svd.singularValues();
  const double condition = s(0) / std::max(s(columns - 1), 1e-300);
  if (!(condition < p.worst_condition)) {
    return refuse(p,
                  "the data do not tell " + blended(p, svd.matrixV().col(columns - 1)) +
                      " apart (condition above " + std::to_string(std::lround(p.worst_condition)) +
                      ")",
                  "vary speed, thrust and inflow more");
  }
  const VectorXd solution = svd.solve(weight.cwiseProduct(y));
  const VectorXd weighted = weight.cwiseProduct(y) - scaled * solution;
  const double free = static_cast<double>(rows - columns);
  double variance = weighted.squaredNorm() / free;
  if (p.ordered) {
    const double r = std::clamp(lag_one(weighted), 0.0, 0.99);
    variance *= (1.0 + r) / (1.0 - r);
  }
  const MatrixXd spread = svd.matrixV() * s.array().square().inverse().matrix().asDiagonal() *
                          svd.matrixV().transpose();

  Fit fit{p.name, p.wanted, p.unit, {}, 0.0, 0.0, condition, student_t95(free), p.y, {}, {}};
  VectorXd values = solution;
  for (Eigen::Index c = 0; c < columns; ++c) {
    const Column& column = p.columns[static_cast<std::size_t>(c)];
    values(c) = solution(c) / length(c);
    const double error = std::sqrt(variance * spread(c, c)) / length(c);
    fit.coefficients.push_back({column.name, column.unit, values(c), error, fit.t95 * error});
  }
  for (Eigen::Index i = 0; i < columns * columns; ++i) {
    const Eigen::Index r = i / columns, c = i % columns;
    fit.covariance.push_back(variance * spread(r, c) / (length(r) * length(c)));
  }
  const VectorXd residuals = y - a * values;
  fit.residuals = listed(residuals);
  fit.residual_rms = std::sqrt(residuals.squaredNorm() / free);
  fit.r2 = r_squared(y, residuals);
  return fit;
}

}  // namespace whirl::regression
