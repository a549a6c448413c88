#include "io_bridges/devices/cppm.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"

namespace whirl::io {
namespace {

constexpr double kCentre_ns = 1.5e6, kTravel_ns = 0.5e6;
constexpr double kStep_ns = core::receiver::kCppmStep_ns;
constexpr double kShortest_ns = 0.9e6, kLongest_ns = 2.1e6;
constexpr double kShortest_gap_ns = core::receiver::kCppmShortestGap_ns;
constexpr double kNonsense_ns[2] = {0.3e6, 3e6};
constexpr double kMost_jitter_s = 10e-6;
constexpr Nanoseconds kJitter_room_ns = 10'000;  // an early first edge is not before its frame

double channel_ns(double position) {
  const double ns = std::round((kCentre_ns + kTravel_ns * position) / kStep_ns) * kStep_ns;
  return std::clamp(ns, kShortest_ns, kLongest_ns);
}

}  // namespace

CppmReceiver::CppmReceiver(EventQueue& queue, Wire& wire, const Params& params, FaultBook* faults)
    : queue_(queue),
      wire_(wire),
      params_(params),
      faults_(faults),
      link_(params.link, faults),
      jitter_(params.seed, params.name + ".jitter"),
      nonsense_(params.seed, params.name + ".nonsense"),
      driver_(wire.add_driver(params.name)),
      frame_(queue, [this] { begin_frame(); }),
      pulse_(queue, [this] { pulse(); }),
      pulse_end_(queue, [this] { drive(false); }) {
  WHIRL_CHECK(params.channels >= 1 && params.channels <= 16, params.channels);
  drive(false);
  frame_.in(by_its_clock(static_cast<double>(params.frame_ns)));
}

Nanoseconds CppmReceiver::by_its_clock(double ns) const {
  return std::llround(ns * (1.0 + params_.clock_error));
}

Nanoseconds CppmReceiver::jitter() {
  const double s = std::clamp(params_.jitter_s * jitter_.normal(), -kMost_jitter_s, kMost_jitter_s);
  return std::llround(s * 1e9);
}

void CppmReceiver::begin_frame() {
  const Nanoseconds now = queue_.now();
  const RadioLink::Output out = link_.at(now);
  const Fault* glitch = faults_ == nullptr ? nullptr
                                           : faults_->find(FaultKind::rc_glitch, params_.link.bus,
                                                           params_.link.device, now);
  const auto channels = static_cast<std::size_t>(params_.channels);
  std::size_t odd = channels;  // the channel that is nonsense
  if (glitch != nullptr && nonsense_.uniform() < glitch->value && !out.silent) {
    faults_->applied(*glitch, now);
    odd = static_cast<std::size_t>(nonsense_.uniform() * static_cast<double>(channels));
  }
  pulses_.clear();
  double at_ns = 0.0;
  for (std::size_t i = 0; i < channels && !out.silent; ++i) {
    pulses_.push_back(now + kJitter_room_ns + by_its_clock(at_ns) + jitter());
    const double share = i == odd ? nonsense_.uniform() : 0.0;
    at_ns += i == odd ? kNonsense_ns[0] + share * (kNonsense_ns[1] - kNonsense_ns[0])
                      : channel_ns(out.sticks[i]);
  }
  if (!out.silent) pulses_.push_back(now + kJitter_room_ns + by_its_clock(at_ns) + jitter());
  next_ = 0;
  if (!pulses_.empty()) pulse_.at(pulses_.front());
  const double frame_ns = std::max(static_cast<double>(params_.frame_ns), at_ns + kShortest_gap_ns);
  frame_.at(now + by_its_clock(frame_ns));
}

void CppmReceiver::pulse() {
  drive(true);
  pulse_end_.at(queue_.now() + by_its_clock(static_cast<double>(params_.pulse_ns)));
  if (++next_ < pulses_.size()) pulse_.at(pulses_[next_]);
}

void CppmReceiver::drive(bool pulse) {
  wire_.drive(driver_, pulse != params_.negative ? Drive::high : Drive::low, queue_.now());
}

}  // namespace whirl::io
