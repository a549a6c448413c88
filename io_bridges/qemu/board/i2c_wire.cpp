#include "io_bridges/qemu/board/i2c_wire.hpp"

#include "base/check.hpp"
#include "base/text.hpp"

namespace whirl::board {

using io::WireAct;
using io::WireAnswer;
using io::WireMessage;
using Clock = io::WireAnswer::Clock;

LeaderI2c::LeaderI2c(LeaderWire& wire, std::uint8_t port, io::I2cBus& bus)
    : wire_(wire),
      port_(port),
      events_(wire.site().events),
      bus_(bus),
      again_(
          events_,
          [this] {
            ask({events_.now(), WireAct::still_held});
          },
          io::Rank::wire),
      handle_(bus.scl().add_driver("another board")) {
  bus_.add(*this);
  bus_.on_start([this](Nanoseconds now) { began(now); });
  bus_.on_free([this](Nanoseconds now) { ended(now); });
}

void LeaderI2c::add(std::uint8_t address, std::unique_ptr<io::I2cBus> ear) {
  WHIRL_CHECK(seats_.emplace(address, Seat{std::move(ear)}).second, address);
}

void LeaderI2c::post(WireMessage message) {
  message.port = port_;
  wire_.post(message);
}

WireAnswer LeaderI2c::ask(WireMessage message) {
  message.port = port_;
  const WireAnswer answer = wire_.ask(message);
  held_ = answer.clock != Clock::released;
  far_at_boundary_ = answer.clock == Clock::held_to_boundary;
  has_next_ = answer.has_byte;
  next_ = answer.byte;
  if (!held_) bus_.hold_until(answer.t_ns);
  hold(held_);
  if (answer.clock == Clock::held) again_.at(answer.t_ns);
  return answer;
}

void LeaderI2c::hold(bool low) {
  bus_.scl().drive(handle_, low ? io::Drive::low : io::Drive::none, events_.now());
}

void LeaderI2c::began(Nanoseconds now) {
  has_next_ = false;
  seat_ = nullptr;
  for (const auto& [address, seat] : seats_) {
    if (seat.ear != nullptr) seat.ear->start(now);
  }
  post({now, WireAct::start});
}

// Also a master that gives up while the far slave holds the clock ends so.
void LeaderI2c::ended(Nanoseconds now) {
  held_ = has_next_ = false;
  seat_ = nullptr;
  again_.cancel();
  hold(false);
  for (const auto& [address, seat] : seats_) {
    if (seat.ear != nullptr) seat.ear->stop(now);
  }
  post({now, WireAct::stop});
}

bool LeaderI2c::start(std::uint8_t address_7bit, bool read, Nanoseconds now) {
  Seat& seat = seats_.at(address_7bit);
  ++seat.addressed;
  const bool ack =
      ask({now, WireAct::address, address_7bit, static_cast<std::uint8_t>(read ? 1 : 0)}).ack != 0;
  if (!ack) return false;
  ++seat.acknowledged;
  seat_ = &seat;
  if (seat.ear != nullptr) seat.ear->address(address_7bit, read, now);
  return true;
}

bool LeaderI2c::write(std::uint8_t byte, Nanoseconds now) {
  const bool ack = ask({now, WireAct::write, byte}).ack != 0;
  if (ack && seat_ != nullptr && seat_->ear != nullptr) seat_->ear->write(byte, now);
  return ack;
}

std::uint8_t LeaderI2c::read(Nanoseconds now) {
  if (!has_next_) return ask({now, WireAct::fetch}).byte;
  has_next_ = false;
  return next_;
}

void LeaderI2c::acked(bool ack, Nanoseconds now) {
  if (ack) {
    ask({now, WireAct::acked, 0, 1});
  } else {
    post({now, WireAct::acked});  // the slave lets go of the lines
  }
}

void LeaderI2c::after_boundary(Nanoseconds now) {
  if (!far_at_boundary_) return;
  far_at_boundary_ = false;
  if (held_) ask({now, WireAct::still_held});
}

void LeaderI2c::run_ends(Nanoseconds now) {
  for (const auto& [address, seat] : seats_) {
    if (seat.addressed == 0 || seat.acknowledged != 0) continue;
    wire_.site().finding({now, bus_.name(),
                          "no board answered at " + hex(address) + ", asked " +
                              std::to_string(seat.addressed) + " times: has it another address?"});
  }
}

FollowerI2c::FollowerI2c(FollowerWire& wire, std::uint8_t, io::I2cBus& bus) : bus_(bus) {
  bus_.scl().watch([this, &wire](bool level, Nanoseconds now) {
    if (level) wire.clock_rose(*this, now);
  });
  bus_.on_start([this, &wire](Nanoseconds now) {
    if (acting_ || start_told_) return;
    start_told_ = true;
    wire.site().finding({now, bus_.name(),
                         "a START of this board's own is not carried over the wire to the other "
                         "board: its bus has one master"});
  });
}

bool FollowerI2c::act(const WireMessage& message, Nanoseconds now) {
  acting_ = true;
  const bool question = pass(message, now);
  acting_ = false;
  return question;
}

bool FollowerI2c::pass(const WireMessage& message, Nanoseconds now) {
  const bool flag = message.flag != 0;
  switch (message.act) {
    case WireAct::start:
      begin(now);
      return false;
    case WireAct::stop:
      end(now);
      return false;
    case WireAct::address:
      answer_ = {};
      ours_ = true;
      answer_.ack = bus_.address(message.byte, flag, now) ? 1 : 0;
      ahead_ = flag && answer_.ack != 0;
      return true;
    case WireAct::write:
      answer_ = {};
      answer_.ack = bus_.write(message.byte, now) ? 1 : 0;
      return true;
    case WireAct::fetch:
      answer_ = {};
      answer_.byte = bus_.fetch(now);
      return true;
    case WireAct::acked:
      bus_.answer(flag, now);
      answer_ = {};
      ahead_ = flag;
      return flag;
    case WireAct::still_held:
      return true;
    default:
      WHIRL_CHECK(false, static_cast<int>(message.act));
  }
  return false;
}

void FollowerI2c::begin(Nanoseconds now) {
  if (!ours_) bus_.stop_unseen(now);  // what a repeated START ends was for others
  ours_ = false;
  bus_.start(now);
}

void FollowerI2c::end(Nanoseconds now) {
  ahead_ = false;
  if (ours_) {
    bus_.stop(now);
  } else {
    bus_.stop_unseen(now);
  }
  ours_ = false;
}

WireAnswer FollowerI2c::reply(Clock clock, Nanoseconds now) {
  if (clock == Clock::released && ahead_) {
    answer_.byte = bus_.fetch(now);
    answer_.has_byte = true;
    ahead_ = false;
  }
  return answer_;
}

}  // namespace whirl::board
