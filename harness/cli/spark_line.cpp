#include "harness/cli/spark_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace whirl::cli {

std::string spark_line(std::span<const double> values) {
  static constexpr const char* kBlocks[] = {"\u2581", "\u2582", "\u2583", "\u2584",
                                            "\u2585", "\u2586", "\u2587", "\u2588"};
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double x : values) {
    if (!std::isfinite(x)) continue;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  std::string line;
  for (const double x : values) {
    if (!std::isfinite(x)) {
      line += "\u00b7";
    } else if (!(high > low)) {
      line += kBlocks[3];
    } else {
      line += kBlocks[std::min(7, static_cast<int>(8.0 * ((x - low) / (high - low))))];
    }
  }
  return line;
}

}  // namespace whirl::cli
