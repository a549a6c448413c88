// Linear least squares by normal equations, summed sample by sample: X'X p = X'y.
//
//   Size     up to kMostUnknowns, and up to kMostColumns of y over the same rows
//   Solve    Cholesky of X'X scaled to a diagonal of ones; nothing where a pivot says that the samples do
//            not tell two unknowns apart
//   Valid    float: rows of the order of 1, centred, so that a pivot of kLeastPivot still means something
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace fw {

class LeastSquares {
 public:
  static constexpr std::size_t kMostUnknowns = 9, kMostColumns = 3;
  using Solution = std::array<float, kMostUnknowns>;

  void start(std::size_t unknowns);
  void add(std::span<const float> row, std::span<const float> y);
  bool solve(std::size_t column, Solution& p) const;
  // Sum of squares that the solution leaves, by the sums: down to some 1e-6 of those of y.
  float left_over(std::size_t column, const Solution& p) const;
  std::uint32_t count() const { return count_; }

 private:
  static constexpr float kLeastPivot = 1e-4f;

  std::size_t unknowns_ = 0;
  std::uint32_t count_ = 0;
  std::array<float, kMostUnknowns*(kMostUnknowns + 1) / 2> xx_{};  // lower triangle, row by row
  std::array<std::array<float, kMostUnknowns>, kMostColumns> xy_{};
  std::array<float, kMostColumns> yy_{};
};

}  // namespace fw
