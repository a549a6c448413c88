#include "io_bridges/devices/pulse_source.hpp"

#include "base/check.hpp"

namespace whirl::io {

PulseSource::PulseSource(EventQueue& queue, Wire& wire, const std::string& name)
    : queue_(queue),
      wire_(wire),
      driver_(wire.add_driver(name)),
      period_(queue, [this] { begin(); }),
      fall_(queue, [this] { drive(false); }),
      glitch_(queue, [this] { invert(); }),
      glitch_end_(queue, [this] { invert(); }) {
  wire_.drive(driver_, Drive::low, queue_.now());
}

void PulseSource::set(const Train& train) {
  WHIRL_CHECK(train.width_ns >= 0 && train.width_ns < train.period_ns, train.width_ns);
  train_ = train;
  if (!period_.pending()) period_.at(queue_.now());
}

void PulseSource::begin() {
  if (train_.width_ns == 0) return;  // until the next set()
  const Nanoseconds now = queue_.now();
  drive(true);
  fall_.at(now + train_.width_ns);
  period_.at(now + train_.period_ns);
  if (train_.glitch_ns == 0) return;
  glitch_.at(now + train_.glitch_after_ns);
  glitch_end_.at(now + train_.glitch_after_ns + train_.glitch_ns);
}

void PulseSource::drive(bool high) {
  high_ = high;
  wire_.drive(driver_, high_ != inverted_ ? Drive::high : Drive::low, queue_.now());
}

void PulseSource::invert() {
  inverted_ = !inverted_;
  drive(high_);
}

}  // namespace whirl::io
