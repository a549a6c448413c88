// Predicted against measured: sum of |error| over sum of |measured| (WMAPE), and the mean with its sign.
#pragma once
#include <cmath>

namespace whirl::sweep {

struct Tally {
  double off = 0.0, signed_off = 0.0, all = 0.0;
  int n = 0;
  void add(double got, double want) {
    off += std::abs(got - want), signed_off += got - want, all += std::abs(want);
    ++n;
  }
  double wmape_percent() const { return percent(off); }
  double mean_percent() const { return percent(signed_off); }

 private:
  double percent(double sum) const { return all == 0.0 ? 0.0 : 100.0 * sum / all; }
};

}  // namespace whirl::sweep
