#include "io_bridges/devices/ms5611.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "io_bridges/devices/oddity_text.hpp"

namespace whirl::io {
namespace {

struct Noise {  // by OSR
  double rms_Pa, rms_K;
};
constexpr Noise kNoise[] = {{6.5, 0.012}, {4.2, 0.008}, {2.7, 0.005}, {1.8, 0.003}, {1.2, 0.002}};

}  // namespace

Ms5611::Ms5611(EventQueue& queue, const Params& params, Sense sense, FaultBook* faults,
               FindingSink findings)
    : queue_(queue),
      params_(params),
      sense_(std::move(sense)),
      faults_(faults),
      findings_(std::move(findings)),
      noise_(params.seed, params.name + ".noise"),
      garbage_(params.seed, params.name + ".garbage"),
      part_(params.prom, params.i2c_address, *this),
      conversion_(queue, [this] { converted(); }),
      supply_(
          queue, faults, params.bus, params.device, [this](Nanoseconds) { part_.supply(false); },
          [this](Nanoseconds) { part_.supply(true); }) {
  WHIRL_CHECK(params.conversion_share >= 0.0 && params.conversion_share <= 1.0,
              params.conversion_share);
}

void Ms5611::odd(core::Oddity what, std::uint32_t detail, Nanoseconds now) {
  findings_.report({now, params_.name, oddity_text(what, detail, nullptr)});
}

void Ms5611::conversion_begins(Quantity /*quantity*/, std::size_t osr, Nanoseconds now) {
  const auto& row = core::Ms5611::kOversampling[osr];
  const double span_ns = static_cast<double>(row.longest_ns - row.shortest_ns);
  Nanoseconds takes_ns = row.shortest_ns + std::llround(params_.conversion_share * span_ns);
  if (const Fault* late = fault(FaultKind::sensor_late, now)) {
    takes_ns += std::llround(late->value * 1e9);
  }
  conversion_.at(now + takes_ns);
}

void Ms5611::converted() {
  const Nanoseconds now = queue_.now();
  const std::uint32_t fresh = counts(now);
  const bool frozen = fault(FaultKind::sensor_frozen, now) != nullptr;
  part_.converted(fresh, frozen,
                  part_.spoiled() ? static_cast<std::uint32_t>(garbage_.bits()) : 0u);
}

std::uint32_t Ms5611::counts(Nanoseconds now) {
  constexpr std::uint32_t kMost_counts = core::Ms5611::kMost_counts;
  Truth truth = sense_(now);
  const Noise& row = kNoise[part_.osr()];
  const double noise = params_.noise_scale * noise_.normal();
  const int axis = part_.quantity() == Quantity::pressure ? 0 : 1;
  const double added = added_by_faults(faults_, params_.bus, params_.device, now, axis);
  if (fault(FaultKind::sensor_saturated, now, axis) != nullptr) return kMost_counts;
  const double exact =
      axis == 0
          ? ms5611::counts_of_pressure(params_.prom, truth.pressure_Pa + added + noise * row.rms_Pa,
                                       truth.temperature_K)
          : ms5611::counts_of_temperature(params_.prom,
                                          truth.temperature_K + added + noise * row.rms_K);
  return static_cast<std::uint32_t>(std::lround(std::clamp(exact, 0.0, double{kMost_counts})));
}

std::uint16_t Ms5611::last_prom_word(std::uint16_t word, Nanoseconds now) {
  const Fault* wrong = fault(FaultKind::sensor_wrong_identity, now);
  if (wrong == nullptr) return word;
  return static_cast<std::uint16_t>(word ^ static_cast<std::uint16_t>(wrong->value));
}

}  // namespace whirl::io
