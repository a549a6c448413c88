#include "firmware/calibration/least_squares.hpp"

#include <algorithm>
#include <cmath>

namespace fw {
namespace {

constexpr std::size_t at(std::size_t row, std::size_t column) {
  return row * (row + 1) / 2 + column;
}

}  // namespace

void LeastSquares::start(std::size_t unknowns) {
  *this = {};
  unknowns_ = unknowns;
}

void LeastSquares::add(std::span<const float> row, std::span<const float> y) {
  ++count_;
  for (std::size_t i = 0; i < unknowns_; ++i) {
    for (std::size_t k = 0; k <= i; ++k) xx_[at(i, k)] += row[i] * row[k];
    for (std::size_t c = 0; c < y.size(); ++c) xy_[c][i] += row[i] * y[c];
  }
  for (std::size_t c = 0; c < y.size(); ++c) yy_[c] += y[c] * y[c];
}

bool LeastSquares::solve(std::size_t column, Solution& p) const {
  std::array<float, kMostUnknowns> scale{};
  for (std::size_t i = 0; i < unknowns_; ++i) {
    if (!(xx_[at(i, i)] > 0.0f)) return false;
    scale[i] = 1.0f / std::sqrt(xx_[at(i, i)]);
  }
  auto l = xx_;  // becomes its Cholesky factor
  for (std::size_t i = 0; i < unknowns_; ++i) {
    for (std::size_t k = 0; k <= i; ++k) {
      float sum = xx_[at(i, k)] * scale[i] * scale[k];
      for (std::size_t j = 0; j < k; ++j) sum -= l[at(i, j)] * l[at(k, j)];
      if (i != k) {
        l[at(i, k)] = sum / l[at(k, k)];
        continue;
      }
      if (!(sum > kLeastPivot)) return false;
      l[at(i, i)] = std::sqrt(sum);
    }
  }
  for (std::size_t i = 0; i < unknowns_; ++i) {
    float sum = xy_[column][i] * scale[i];
    for (std::size_t k = 0; k < i; ++k) sum -= l[at(i, k)] * p[k];
    p[i] = sum / l[at(i, i)];
  }
  for (std::size_t i = unknowns_; i-- > 0;) {
    float sum = p[i];
    for (std::size_t k = i + 1; k < unknowns_; ++k) sum -= l[at(k, i)] * p[k];
    p[i] = sum / l[at(i, i)];
  }
  for (std::size_t i = 0; i < unknowns_; ++i) p[i] *= scale[i];
  return true;
}

float LeastSquares::left_over(std::size_t column, const Solution& p) const {
  float sum = yy_[column];
  for (std::size_t i = 0; i < unknowns_; ++i) sum -= p[i] * xy_[column][i];
  return std::max(sum, 0.0f);
}

}  // namespace fw
