#include "io_bridges/qemu/board/wire_ends.hpp"

#include <algorithm>

#include "base/check.hpp"

namespace whirl::board {

using io::WireAct;
using io::WireAnswer;
using io::WireMessage;
using Clock = io::WireAnswer::Clock;

// ---- Leader

LeaderWire::LeaderWire(const WireSite& site, io::BoardWire wire)
    : site_(site),
      wire_(std::move(wire)),
      mark_(
          site.events, [this] { mark(); }, io::Rank::wire) {}

void LeaderWire::post(const WireMessage& message) {
  if (!wire_.post(message)) site_.closed();
}

WireAnswer LeaderWire::ask(const WireMessage& message) {
  const auto answer = wire_.ask(message);
  if (answer) return *answer;
  site_.closed();
  return {};
}

void LeaderWire::hear_lines(Nanoseconds latency_ns) {
  const Nanoseconds grain_ns = latency_ns / 2;
  WHIRL_CHECK(grain_ns > 0, latency_ns);
  grain_ns_ = grain_ns_ == 0 ? grain_ns : std::min(grain_ns_, grain_ns);
  mark_.at(site_.events.now() + grain_ns_);
}

// What changed until the mark before this one.
void LeaderWire::mark() {
  const Nanoseconds now = site_.events.now();
  post({now, WireAct::mark});
  mark_.at(now + grain_ns_);
  if (!std::exchange(marked_, true)) return;
  for (;;) {
    const auto edge = wire_.next_edge();
    if (!edge) return site_.closed();
    if (edge->mark != 0) return;
    ports_.at(edge->port)->edge(*edge);
  }
}

void LeaderWire::at_boundary(Nanoseconds now) {
  for (const auto& port : ports_) {
    if (port != nullptr && port->far_at_boundary()) return;  // it says so itself
  }
  post({now, WireAct::to_boundary});
}

void LeaderWire::after_boundary(Nanoseconds now) {
  for (const auto& port : ports_) {
    if (port != nullptr) port->after_boundary(now);
  }
}

void LeaderWire::run_ends(Nanoseconds now) {
  for (const auto& port : ports_) {
    if (port != nullptr) port->run_ends(now);
  }
}

// ---- Follower

FollowerWire::FollowerWire(const WireSite& site, io::BoardWire wire, bool shared)
    : site_(site),
      wire_(std::move(wire)),
      shared_(shared),
      pause_(
          site.events, [this] { pause(); }, io::Rank::wire),
      cap_(
          site.events,
          [this] {
            answer(Clock::held, site_.events.now());
            pause();
          },
          io::Rank::wire) {}

// What comes is acted on at its time; then until the next one is known nothing more may happen here.
void FollowerWire::pause() {
  const Nanoseconds now = site_.events.now();
  while (!waiting_) {
    const WireMessage* message = wire_.front();
    if (message == nullptr) return site_.closed();
    if (message->act != WireAct::to_boundary && message->t_ns > now) {
      return pause_.at(message->t_ns);
    }
    const WireMessage taken = *message;
    wire_.pop();
    count_late(taken, now);
    if (taken.act == WireAct::to_boundary) return;
    take(taken, now);
  }
}

void FollowerWire::take(const WireMessage& message, Nanoseconds now) {
  if (message.act == WireAct::mark) return wire_.tell({.t_ns = now, .mark = 1});
  FollowerPort& port = *ports_.at(message.port);
  if (!port.act(message, now)) return;
  asked_ = &port;
  if (!port.held()) return answer(Clock::released, now);
  if (shared_) return answer(Clock::held, now);
  waiting_ = true;  // the core runs on until it lets go
  if (now + kHeld_ns < next_boundary_ns_) cap_.at(now + kHeld_ns);
}

void FollowerWire::count_late(const WireMessage& message, Nanoseconds now) {
  if (message.t_ns >= now) return;
  ++late_;
  latest_ns_ = std::max(latest_ns_, now - message.t_ns);
}

void FollowerWire::answer(Clock clock, Nanoseconds now) {
  cap_.cancel();
  waiting_ = false;
  WireAnswer told = asked_->reply(clock, now);
  told.clock = clock;
  if (clock == Clock::held && shared_) told.t_ns = now + kLook_ns;
  wire_.answer(told);
}

void FollowerWire::clock_rose(const FollowerPort& port, Nanoseconds now) {
  if (!waiting_ || asked_ != &port) return;
  answer(Clock::released, now);
  pause_.at(now);
}

void FollowerWire::at_boundary(Nanoseconds now) {
  if (waiting_) answer(Clock::held_to_boundary, now);
}

void FollowerWire::after_boundary(Nanoseconds now, Nanoseconds next) {
  next_boundary_ns_ = next;
  pause_.at(now);
}

void FollowerWire::run_ends(Nanoseconds now) {
  if (late_ == 0) return;
  site_.finding({now, "wire",
                 std::to_string(late_) + " conditions came late, the worst by " +
                     std::to_string(latest_ns_) +
                     " ns: the master gave up while this board held the clock"});
}

// ---- All of a board

WireEnds::WireEnds(WireSite site) : site_(std::move(site)) {}

Result<LeaderWire*> WireEnds::lead(int fd) {
  if (const auto there = leaders_.find(fd); there != leaders_.end()) return there->second.get();
  auto wire = io::BoardWire::attach(fd);
  if (!wire) return wire.error();
  auto& place = leaders_[fd];
  place = std::make_unique<LeaderWire>(site_, std::move(wire.value()));
  return place.get();
}

Result<FollowerWire*> WireEnds::follow(int fd, bool shared) {
  if (const auto there = followers_.find(fd); there != followers_.end()) return there->second.get();
  auto wire = io::BoardWire::attach(fd);
  if (!wire) return wire.error();
  auto& place = followers_[fd];
  place = std::make_unique<FollowerWire>(site_, std::move(wire.value()), shared);
  return place.get();
}

Result<Done> WireEnds::arbitrate(int fd, io::CanBus& bus, const std::string& name, int number,
                                 std::unique_ptr<CanEar> ear) {
  auto wire = io::BoardWire::attach(fd);
  if (!wire) return wire.error();
  const auto known = std::find_if(arbiters_.begin(), arbiters_.end(),
                                  [&](const auto& arbiter) { return &arbiter->bus() == &bus; });
  auto& arbiter = known != arbiters_.end()
                      ? *known
                      : arbiters_.emplace_back(std::make_unique<CanLeader>(site_, bus));
  arbiter->add(std::move(wire.value()), name, number, std::move(ear));
  return Done{};
}

Result<Done> WireEnds::share(int fd, io::CanBus& bus) {
  auto wire = io::BoardWire::attach(fd);
  if (!wire) return wire.error();
  shares_.push_back(std::make_unique<CanFollower>(site_, std::move(wire.value()), bus));
  return Done{};
}

void WireEnds::at_boundary(Nanoseconds now) {
  for (const auto& arbiter : arbiters_) arbiter->at_boundary(now);
  for (const auto& [key, leader] : leaders_) leader->at_boundary(now);
  for (const auto& [key, follower] : followers_) follower->at_boundary(now);
}

void WireEnds::after_boundary(Nanoseconds now, Nanoseconds next) {
  for (const auto& arbiter : arbiters_) arbiter->after_boundary(now, next);
  for (const auto& share : shares_) share->after_boundary(now, next);
  for (const auto& [key, leader] : leaders_) leader->after_boundary(now);
  for (const auto& [key, follower] : followers_) follower->after_boundary(now, next);
}

void WireEnds::run_ends(Nanoseconds now) {
  for (const auto& share : shares_) share->run_ends(now);
  for (const auto& [key, leader] : leaders_) leader->run_ends(now);
  for (const auto& [key, follower] : followers_) follower->run_ends(now);
}

}  // namespace whirl::board
