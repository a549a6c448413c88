#include "io_bridges/hid/emulated/wire_engine.hpp"

#include <algorithm>

#include "base/check.hpp"

namespace whirl::io {
namespace {

constexpr Nanoseconds kAsk_ns = 200'000;  // the carrier

}  // namespace

void WireEngine::begin(std::uint8_t address, std::size_t total) {
  WHIRL_CHECK(ready());
  address_ = address;
  total_ = total;
  passed_ = 0;
  paused_ = false;
  blocked_since_ = -1;
  to_write_.clear();
  received_.clear();
  state_ = State::starting;
  if (carrier_ == nullptr) after_bits(1);
}

void WireEngine::write(std::uint8_t address, std::size_t total, bool stop) {
  begin(address, total);
  reading_ = false;
  stop_ = stop;
  if (carrier_ != nullptr) carry_write();
}

void WireEngine::read(std::uint8_t address, std::size_t total) {
  std::vector<std::uint8_t> held;
  if (carrier_ != nullptr && state_ == State::held) held = {to_write_.begin(), to_write_.end()};
  begin(address, total);
  reading_ = true;
  stop_ = true;
  if (carrier_ == nullptr) return;
  state_ = State::reading;
  carrier_->begin(address, std::move(held), total);
  step_.in(kAsk_ns);
}

void WireEngine::feed(std::span<const std::uint8_t> bytes) {
  to_write_.insert(to_write_.end(), bytes.begin(), bytes.end());
  if (carrier_ != nullptr) return carry_write();
  if (!paused_ || reading_) return;
  paused_ = false;
  next();
}

std::vector<std::uint8_t> WireEngine::take(std::size_t most) {
  const auto count = static_cast<std::ptrdiff_t>(std::min(most, received_.size()));
  std::vector<std::uint8_t> bytes(received_.begin(), received_.begin() + count);
  received_.erase(received_.begin(), received_.begin() + count);
  if (paused_ && reading_) {
    paused_ = false;
    next();
  }
  return bytes;
}

void WireEngine::cancel() {
  step_.cancel();
  if (holds_) bus_->stop(queue_.now());
  if (carrier_ != nullptr) carrier_->abandon();
  holds_ = false;
  paused_ = false;
  to_write_.clear();
  received_.clear();
  state_ = State::idle;
}

// Once all bytes are there. One without STOP waits for the read behind it.
void WireEngine::carry_write() {
  state_ = State::writing;
  if (to_write_.size() < total_) return;
  passed_ = total_;
  if (!stop_) return rest(State::held);
  carrier_->begin(address_, {to_write_.begin(), to_write_.end()}, 0);
  to_write_.clear();
  step_.in(kAsk_ns);
}

void WireEngine::ask_carrier() {
  const auto outcome = carrier_->outcome();
  if (!outcome) return step_.in(kAsk_ns);
  received_.assign(outcome->bytes.begin(), outcome->bytes.end());
  passed_ = outcome->acked ? total_ : 0;
  rest(outcome->timed_out ? State::stuck : outcome->acked ? State::idle : State::address_nack);
}

// The clock may not run; for too long, the transfer ends.
bool WireEngine::blocked() {
  constexpr Nanoseconds kAgain_ns = 20'000, kLimit_ns = 25'000'000;
  const Nanoseconds now = queue_.now();
  const bool free = state_ != State::starting || holds_ || bus_->idle();
  if (bus_->scl().level() && now >= bus_->released_ns() && free) {
    blocked_since_ = -1;
    return false;
  }
  if (blocked_since_ < 0) blocked_since_ = now;
  if (now - blocked_since_ > kLimit_ns) {
    rest(State::stuck);
  } else {
    step_.in(kAgain_ns);
  }
  return true;
}

void WireEngine::step() {
  if (blocked()) return;
  const Nanoseconds now = queue_.now();
  if (state_ == State::starting) {
    if (lose_) {
      lose_ = false;
      return rest(State::lost);
    }
    bus_->start(now);
    holds_ = true;
    state_ = State::addressing;
    after_bits(9);
  } else if (state_ == State::addressing) {
    if (bus_->address(address_, reading_, now)) return next();
    finish(State::address_nack);
  } else if (state_ == State::writing) {
    const std::uint8_t byte = to_write_.front();
    to_write_.pop_front();
    if (!bus_->write(byte, now)) return finish(State::data_nack);
    ++passed_;
    next();
  } else if (state_ == State::reading) {
    ++passed_;
    received_.push_back(bus_->read(passed_ < total_, now));
    next();
  } else if (state_ == State::stopping) {
    bus_->stop(now);
    holds_ = false;
    rest(final_);
  }
}

void WireEngine::next() {
  state_ = reading_ ? State::reading : State::writing;
  if (passed_ == total_) {
    if (!stop_) return rest(State::held);
    return finish(State::idle);
  }
  paused_ = reading_ ? received_.size() >= room_ : to_write_.empty();
  if (!paused_) after_bits(9);
}

void WireEngine::finish(State with) {
  final_ = with;
  state_ = State::stopping;
  after_bits(1);
}

void WireEngine::rest(State in) {
  state_ = in;
  if (end_) end_();
}

}  // namespace whirl::io
