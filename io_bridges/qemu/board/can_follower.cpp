// The end of a joined CAN bus on a board that does not arbitrate.
#include <algorithm>

#include "base/check.hpp"
#include "io_bridges/qemu/board/can_frames.hpp"
#include "io_bridges/qemu/board/can_wire.hpp"

namespace whirl::board {

using io::CanFrame;
using io::CanNews;
using io::CanStation;
using io::WireAct;
using io::WireCan;
using io::WireCanAct;
using io::WireMessage;
using Call = io::CanNews::Call;

// ---- A device that another board takes the place of

void CanEar::receive(const CanFrame& frame) {
  for (int i = 0; i < bus_.stations(); ++i) {
    bus_.hear(bus_.station(i), {.call = Call::receive, .frame = frame});
  }
}

void CanEar::connected(CanStation& station, int) {
  bus_.hear(station, {.call = Call::joined});
}

void CanEar::requested(CanStation& station) {
  while (bus_.offer_of(station) != nullptr) {
    bus_.hear(station, {.call = Call::begun});
    bus_.hear(station, {.call = Call::sent});
  }
}

// ---- Follower

CanFollower::CanFollower(const WireSite& site, io::BoardWire wire, io::CanBus& bus)
    : site_(site),
      wire_(std::move(wire)),
      bus_(bus),
      pause_(
          site.events, [this] { pause(); }, io::Rank::wire),
      stir_(
          site.events, [this] { stir(); }, io::Rank::wire) {
  bus_.follow(*this);
}

void CanFollower::tell(WireCanAct act, WireCan can, bool more) {
  can.act = static_cast<std::uint8_t>(act);
  wire_.tell({.t_ns = site_.events.now(), .can = can}, more);
}

void CanFollower::configured(CanStation& station) {
  WireCan can;
  can.station = static_cast<std::uint8_t>(station.place());
  can.bit_ns = station.bit_ns();
  can.silent = station.silent();
  tell(WireCanAct::configure, can, true);
}

void CanFollower::connected(CanStation& station, int idles) {
  WireCan can;
  can.station = static_cast<std::uint8_t>(station.place());
  can.idles = static_cast<std::int16_t>(idles);
  tell(WireCanAct::connect, can, true);
  requested(station);  // it is told when it takes part
}

void CanFollower::disconnected(CanStation& station) {
  WireCan can;
  can.station = static_cast<std::uint8_t>(station.place());
  tell(WireCanAct::disconnect, can, true);
  if (can.station < offers_.size()) offers_[can.station] = {};
}

void CanFollower::requested(CanStation&) {
  if (!at_boundary_) pause_.at(site_.events.now());
}

// Its offers are what its nodes would say to an arbiter of their own at this nanosecond.
bool CanFollower::tell_offers() {
  bool changed = false;
  offers_.resize(static_cast<std::size_t>(bus_.stations()));
  for (int i = 0; i < bus_.stations(); ++i) {
    Offer& offer = offers_[static_cast<std::size_t>(i)];
    if (offer.on_wire) continue;
    const CanFrame* frame = bus_.offer_of(bus_.station(i));
    const std::optional<CanFrame> now = frame != nullptr ? std::optional(*frame) : std::nullopt;
    if (now == offer.told) continue;
    WireCan can;
    can.station = static_cast<std::uint8_t>(i);
    if (now) pack(*now, can);
    tell(now ? WireCanAct::offer : WireCanAct::withdraw, can, true);
    offer.told = now;
    changed = true;
  }
  return changed;
}

bool CanFollower::offers() const {
  return std::any_of(offers_.begin(), offers_.end(),
                     [](const Offer& offer) { return offer.told && !offer.on_wire; });
}

void CanFollower::pause() {
  if (at_boundary_) return;
  const Nanoseconds now = site_.events.now();
  tell_offers();
  do {
    pause_.cancel();
    stop(now);
    if (!take_news(now)) return;
  } while (tell_offers() || pause_.pending());  // what it was told made it ask
  pause_.at(go_until_ns_);
}

// "Then too": it stands there for an answer, or for the boundary. Who only has come to where it may go asks, perhaps, yet.
void CanFollower::stop(Nanoseconds now) {
  const bool then_too = now < go_until_ns_ || offers() || now >= boundary_ns_;
  WireCan can;
  can.act = static_cast<std::uint8_t>(WireCanAct::stopped);
  wire_.tell({.t_ns = now, .level = static_cast<std::uint8_t>(then_too ? 1 : 0), .can = can});
}

bool CanFollower::take_news(Nanoseconds now) {
  for (;;) {
    const WireMessage* front = wire_.front();
    if (front == nullptr) return site_.closed(), false;
    const WireMessage message = *front;
    wire_.pop();
    switch (message.act) {
      case WireAct::can_go:
        go_until_ns_ = message.t_ns;
        return true;
      case WireAct::to_boundary:
        at_boundary_ = true;
        return false;
      case WireAct::can_stir:
        if (!stir_.pending()) stir_.at(message.t_ns);
        break;
      default:
        hear(message, now);
    }
  }
}

void CanFollower::hear(const WireMessage& message, Nanoseconds now) {
  WHIRL_CHECK(message.act == WireAct::can_news, static_cast<int>(message.act));
  if (message.t_ns < now) {
    ++late_;
    latest_ns_ = std::max(latest_ns_, now - message.t_ns);
  }
  const CanNews news = news_of(message.can);
  Offer& offer = offers_.at(message.can.station);
  if (news.call == Call::begun) offer.on_wire = true;
  const bool failed = news.call == Call::failed && news.sending;
  if (news.call == Call::sent) offer.told.reset();
  if (news.call == Call::sent || news.call == Call::lost_arbitration || failed) {
    offer.on_wire = false;
  }
  bus_.hear(bus_.station(message.can.station), news);
}

// Of the stations that take no part the node knows what that means.
void CanFollower::stir() {
  for (int i = 0; i < bus_.stations(); ++i) {
    CanStation& station = bus_.station(i);
    if (station.takes_part()) continue;
    bus_.hear(station, {.call = Call::stirred,
                        .bus_off = station.is_bus_off(),
                        .tec = station.tec(),
                        .rec = station.rec()});
  }
}

void CanFollower::after_boundary(Nanoseconds now, Nanoseconds next) {
  boundary_ns_ = next;
  go_until_ns_ = now;
  at_boundary_ = false;
  pause_.at(now);
}

void CanFollower::run_ends(Nanoseconds now) {
  if (late_ == 0) return;
  site_.finding({now, bus_.name(),
                 std::to_string(late_) + " answers of the bus came late, the worst by " +
                     std::to_string(latest_ns_) +
                     " ns: two sent one identifier, or one had another bit rate"});
}

}  // namespace whirl::board
