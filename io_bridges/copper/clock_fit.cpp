#include "io_bridges/copper/clock_fit.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::copper {
namespace {

std::int64_t middle(const MarkerPulse& pulse) {
  return pulse.before_host_ns + (pulse.after_host_ns - pulse.before_host_ns) / 2;
}

double half_width_ns(const MarkerPulse& pulse) {
  return static_cast<double>(pulse.after_host_ns - pulse.before_host_ns) / 2.0;
}

}  // namespace

std::int64_t ClockFit::host_ns(std::int64_t analyser_ns) const {
  return host_zero_ns + std::llround(static_cast<double>(analyser_ns - analyser_zero_ns) * rate);
}

double ClockFit::residue_at_ns(std::int64_t analyser_ns) const {
  if (rate_known) return residue_ns;
  return residue_ns + kRate_error * std::abs(static_cast<double>(analyser_ns - analyser_zero_ns));
}

std::optional<ClockFit> fit_clocks(const std::vector<MarkerPulse>& pulses) {
  if (pulses.empty()) return std::nullopt;
  const MarkerPulse& first = pulses.front();
  const MarkerPulse& last = pulses.back();
  ClockFit fit{first.analyser_ns, middle(first), 1.0, half_width_ns(first), false};
  if (pulses.size() == 1) return fit;
  if (last.analyser_ns <= first.analyser_ns) return std::nullopt;
  fit.rate = static_cast<double>(middle(last) - middle(first)) /
             static_cast<double>(last.analyser_ns - first.analyser_ns);
  fit.rate_known = true;
  fit.residue_ns = std::max(half_width_ns(first), half_width_ns(last));
  double off_ns = 0.0;
  for (const MarkerPulse& pulse : pulses) {
    off_ns = std::max(
        off_ns, std::abs(static_cast<double>(fit.host_ns(pulse.analyser_ns) - middle(pulse))));
  }
  fit.residue_ns += off_ns;
  return fit;
}

}  // namespace whirl::copper
