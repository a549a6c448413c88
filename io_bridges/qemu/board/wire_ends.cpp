#include "io_bridges/qemu/board/wire_ends.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "base/text.hpp"

namespace whirl::board {

using io::WireAct;
using io::WireAnswer;
using io::WireMessage;
using Clock = io::WireAnswer::Clock;

LeaderEnd::LeaderEnd(const WireSite& site, io::I2cBus& bus, std::unique_ptr<io::I2cBus> ear,
                     std::uint8_t address, io::BoardWire wire)
    : site_(site),
      bus_(bus),
      ear_(std::move(ear)),
      address_(address),
      wire_(std::move(wire)),
      again_(
          site.events,
          [this] {
            ask({site_.events.now(), WireAct::still_held});
          },
          io::Rank::wire),
      handle_(bus.scl().add_driver("the board at " + hex(address))) {
  bus_.add(*this);
  bus_.on_start([this](Nanoseconds now) { began(now); });
  bus_.on_free([this](Nanoseconds now) { ended(now); });
}

void LeaderEnd::post(const WireMessage& message) {
  if (!wire_.post(message)) site_.closed();
}

WireAnswer LeaderEnd::ask(const WireMessage& message) {
  const auto answer = wire_.ask(message);
  if (!answer) {
    site_.closed();
    return {};
  }
  held_ = answer->clock != Clock::released;
  far_at_boundary_ = answer->clock == Clock::held_to_boundary;
  has_next_ = answer->has_byte;
  next_ = answer->byte;
  if (!held_) bus_.hold_until(answer->t_ns);
  hold(held_);
  if (answer->clock == Clock::held) again_.at(answer->t_ns);
  return *answer;
}

void LeaderEnd::hold(bool low) {
  bus_.scl().drive(handle_, low ? io::Drive::low : io::Drive::none, site_.events.now());
}

void LeaderEnd::began(Nanoseconds now) {
  has_next_ = false;
  ear_->start(now);
  post({now, WireAct::start});
}

// Also a master that gives up while the far slave holds the clock ends so.
void LeaderEnd::ended(Nanoseconds now) {
  held_ = has_next_ = false;
  again_.cancel();
  hold(false);
  ear_->stop(now);
  post({now, WireAct::stop});
}

bool LeaderEnd::start(std::uint8_t address_7bit, bool read, Nanoseconds now) {
  ++addressed_;
  const bool ack =
      ask({now, WireAct::address, address_7bit, static_cast<std::uint8_t>(read ? 1 : 0)}).ack != 0;
  if (!ack) return false;
  ++acknowledged_;
  ear_->address(address_7bit, read, now);
  return true;
}

bool LeaderEnd::write(std::uint8_t byte, Nanoseconds now) {
  const bool ack = ask({now, WireAct::write, byte}).ack != 0;
  if (ack) ear_->write(byte, now);
  return ack;
}

std::uint8_t LeaderEnd::read(Nanoseconds now) {
  if (!has_next_) return ask({now, WireAct::fetch}).byte;
  has_next_ = false;
  return next_;
}

void LeaderEnd::acked(bool ack, Nanoseconds now) {
  if (ack) {
    ask({now, WireAct::acked, 0, 1});
  } else {
    post({now, WireAct::acked});  // the slave lets go of the lines
  }
}

void LeaderEnd::at_boundary(Nanoseconds now) {
  WHIRL_CHECK(!held_ || far_at_boundary_, now);
  if (!far_at_boundary_) post({now, WireAct::to_boundary});
}

void LeaderEnd::after_boundary(Nanoseconds now) {
  far_at_boundary_ = false;
  if (held_) ask({now, WireAct::still_held});
}

void LeaderEnd::run_ends(Nanoseconds now) {
  if (addressed_ == 0 || acknowledged_ != 0) return;
  site_.finding({now, bus_.name(),
                 "no board answered at " + hex(address_) + ", asked " + std::to_string(addressed_) +
                     " times: has it another address?"});
}

FollowerEnd::FollowerEnd(const WireSite& site, io::I2cBus& bus, io::BoardWire wire)
    : site_(site),
      bus_(bus),
      wire_(std::move(wire)),
      pause_(
          site.events, [this] { pause(); }, io::Rank::wire),
      cap_(
          site.events,
          [this] {
            answer(Clock::held, site_.events.now());
            pause();
          },
          io::Rank::wire) {
  bus_.scl().watch([this](bool level, Nanoseconds now) {
    if (level && waiting_) clock_rose(now);
  });
  bus_.on_start([this](Nanoseconds now) {
    if (acting_ || start_told_) return;
    start_told_ = true;
    site_.finding({now, bus_.name(),
                   "a START of this board's own is not carried over the wire to the other board: "
                   "its bus has one master"});
  });
}

// What comes is acted on at its time; then until the next one is known nothing more may happen here.
void FollowerEnd::pause() {
  const Nanoseconds now = site_.events.now();
  for (;;) {
    const WireMessage* message = wire_.front();
    if (message == nullptr) return site_.closed();
    if (message->act != WireAct::to_boundary && message->t_ns > now) {
      return pause_.at(message->t_ns);
    }
    const WireMessage taken = *message;
    wire_.pop();
    count_late(taken, now);
    acting_ = true;
    const Next next = act(taken, now);
    acting_ = false;
    if (next == Next::boundary) return;
    if (next == Next::go_on) continue;
    if (bus_.scl().level()) {
      answer(Clock::released, now);
      continue;
    }
    waiting_ = true;  // the core runs on until it lets go
    if (now + kHeld_ns < next_boundary_ns_) cap_.at(now + kHeld_ns);
    return;
  }
}

FollowerEnd::Next FollowerEnd::act(const WireMessage& message, Nanoseconds now) {
  const bool flag = message.flag != 0;
  switch (message.act) {
    case WireAct::to_boundary:
      return Next::boundary;
    case WireAct::start:
      begin(now);
      return Next::go_on;
    case WireAct::stop:
      end(now);
      return Next::go_on;
    case WireAct::address:
      answer_ = {};
      ours_ = true;
      answer_.ack = bus_.address(message.byte, flag, now) ? 1 : 0;
      ahead_ = flag && answer_.ack != 0;
      return Next::wait_for_scl;
    case WireAct::write:
      answer_ = {};
      answer_.ack = bus_.write(message.byte, now) ? 1 : 0;
      return Next::wait_for_scl;
    case WireAct::fetch:
      answer_ = {};
      answer_.byte = bus_.fetch(now);
      return Next::wait_for_scl;
    case WireAct::acked:
      bus_.answer(flag, now);
      answer_ = {};
      ahead_ = flag;
      return flag ? Next::wait_for_scl : Next::go_on;
    case WireAct::still_held:
      return Next::wait_for_scl;
  }
  return Next::go_on;
}

void FollowerEnd::begin(Nanoseconds now) {
  if (!ours_) bus_.stop_unseen(now);  // what a repeated START ends was for others
  ours_ = false;
  bus_.start(now);
}

void FollowerEnd::end(Nanoseconds now) {
  ahead_ = false;
  if (ours_) {
    bus_.stop(now);
  } else {
    bus_.stop_unseen(now);
  }
  ours_ = false;
}

void FollowerEnd::count_late(const WireMessage& message, Nanoseconds now) {
  if (message.t_ns >= now) return;
  ++late_;
  latest_ns_ = std::max(latest_ns_, now - message.t_ns);
}

void FollowerEnd::answer(Clock clock, Nanoseconds now) {
  cap_.cancel();
  waiting_ = false;
  // A hold whose end is known beforehand (a fault on this board's end of the wire) is only said.
  answer_.t_ns = clock == Clock::released ? std::max(now, bus_.released_ns()) : now;
  answer_.clock = clock;
  if (clock == Clock::released && ahead_) {
    answer_.byte = bus_.fetch(now);
    answer_.has_byte = true;
    ahead_ = false;
  }
  wire_.answer(answer_);
}

void FollowerEnd::clock_rose(Nanoseconds now) {
  answer(Clock::released, now);
  pause_.at(now);
}

void FollowerEnd::at_boundary(Nanoseconds now) {
  if (waiting_) answer(Clock::held_to_boundary, now);
}

void FollowerEnd::after_boundary(Nanoseconds now, Nanoseconds next) {
  next_boundary_ns_ = next;
  pause_.at(now);
}

void FollowerEnd::run_ends(Nanoseconds now) {
  if (late_ == 0) return;
  site_.finding({now, bus_.name(),
                 std::to_string(late_) + " conditions came late, the worst by " +
                     std::to_string(latest_ns_) +
                     " ns: the master gave up while this board held the clock"});
}

WireEnds::WireEnds(WireSite site) : site_(std::move(site)) {}

void WireEnds::lead(io::I2cBus& bus, std::unique_ptr<io::I2cBus> ear, std::uint8_t address,
                    io::BoardWire wire) {
  leaders_.push_back(
      std::make_unique<LeaderEnd>(site_, bus, std::move(ear), address, std::move(wire)));
}

void WireEnds::follow(io::I2cBus& bus, io::BoardWire wire) {
  followers_.push_back(std::make_unique<FollowerEnd>(site_, bus, std::move(wire)));
}

void WireEnds::at_boundary(Nanoseconds now) {
  for (const auto& leader : leaders_) leader->at_boundary(now);
  for (const auto& follower : followers_) follower->at_boundary(now);
}

void WireEnds::after_boundary(Nanoseconds now, Nanoseconds next) {
  for (const auto& leader : leaders_) leader->after_boundary(now);
  for (const auto& follower : followers_) follower->after_boundary(now, next);
}

void WireEnds::run_ends(Nanoseconds now) {
  for (const auto& leader : leaders_) leader->run_ends(now);
  for (const auto& follower : followers_) follower->run_ends(now);
}

}  // namespace whirl::board
