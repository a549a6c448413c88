// A bus that several boards have: how far ahead of the arbiter a board may run, and a bus that has its arbiter elsewhere.
#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "io_bridges/devices/can_bus.hpp"

namespace whirl::io {

Nanoseconds CanBus::least_ahead_ns() const {
  double fastest_ns = 0.0, slowest_ns = 0.0;  // of those that are there, or wait for it
  for (const CanStation& station : stations_) {
    if (!station.on_ && station.idles_to_go_ == 0) continue;
    fastest_ns = slowest_ns == 0.0 ? station.bit_ns_ : std::min(fastest_ns, station.bit_ns_);
    slowest_ns = std::max(slowest_ns, station.bit_ns_);
  }
  if (slowest_ns == 0.0) fastest_ns = slowest_ns = kFastest_bit_ns;
  const bool all_fit = rates_fit(fastest_ns, slowest_ns) && rates_fit(slowest_ns, fastest_ns);
  return static_cast<Nanoseconds>(std::min(fastest_ns, kFastest_bit_ns) *
                                  (all_fit ? kLeastAhead_bits : kLeastAheadMisread_bits));
}

Nanoseconds CanBus::untouched_until(CanStation& station) const {
  const Nanoseconds now = queue_.now(), free = std::max(now, free_ns_);
  Nanoseconds t = busy_ ? end_.due() : free + least_ahead_ns();
  const auto not_after = [&t](Nanoseconds other) { t = std::min(t, other); };
  if (held_dominant_) {
    not_after(now + static_cast<Nanoseconds>(kCanIdle * kFastest_bit_ns));
    if (dominant_.pending()) not_after(dominant_.due());
  } else if (!busy_) {
    if (station.idles_to_go_ > 0) not_after(joins_at(station));
    const bool may = station.on_ && !station.silent_ && !station.stub_->pending();
    if (may && station.node_->offered() != nullptr) not_after(std::max(free, station.may_send_ns_));
  }
  if (station.stub_->pending()) not_after(station.stub_->due());
  const auto next = foreseen_.upper_bound(now);
  if (next != foreseen_.end()) not_after(*next);
  return std::max(t, now + 1);
}

void CanBus::follow(CanArbiter& arbiter) {
  WHIRL_CHECK(!busy_ && !held_dominant_, queue_.now());
  arbiter_ = &arbiter;
  start_.cancel();
  joining_.cancel();
  for (CanStation& station : stations_) {
    arbiter.configured(station);
    if (station.idles_to_go_ > 0) arbiter.connected(station, station.idles_to_go_);
  }
}

const CanFrame* CanBus::offer_of(CanStation& station) {
  return station.on_ ? station.node_->offered() : nullptr;
}

void CanBus::hear(CanStation& station, const CanNews& news) {
  using Call = CanNews::Call;
  const Nanoseconds now = queue_.now();
  CanNode& node = *station.node_;
  const auto ended = [&] {
    if (sender_ == &station) sender_ = nullptr;
  };
  station.tec_ = news.tec;
  station.rec_ = news.rec;
  if (news.bus_off) station.on_ = false;
  station.bus_off_ = news.bus_off;
  switch (news.call) {
    case Call::begun:
      ended();  // of what was on the wire when it left
      if (news.sending) sender_ = &station;
      return node.begun(now);
    case Call::sent:
      ended();
      return node.sent(now);
    case Call::receive:
      return node.receive(news.frame, now);
    case Call::lost_arbitration:
      return node.lost_arbitration(now);
    case Call::failed:
      if (news.sending) ended();
      return node.failed(news.error, news.sending, now);
    case Call::bus_off:
      return node.bus_off(now);
    case Call::joined:
      station.idles_to_go_ = 0;
      station.on_ = true;
      return node.joined(now);
    case Call::stirred:
      return node.stirred(now);
    case Call::counted:
      return;
  }
}

}  // namespace whirl::io
