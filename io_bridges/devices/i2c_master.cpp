#include "io_bridges/devices/i2c_master.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"

namespace whirl::io {

I2cMaster::I2cMaster(EventQueue& queue, I2cBus& bus, double rate_Hz, Nanoseconds timeout_ns)
    : queue_(queue),
      bus_(bus),
      bit_ns_(1e9 / rate_Hz),
      timeout_ns_(timeout_ns),
      step_(queue, [this] { step(); }),
      timeout_(queue, [this] { give_up(); }) {
  bus_.scl().watch([this](bool level, Nanoseconds) {
    if (level) clock_may_run();
  });
  bus_.sda().watch([this](bool level, Nanoseconds) {
    if (level) clock_may_run();
  });
  bus_.on_free([this](Nanoseconds) { clock_may_run(); });
}

void I2cMaster::transfer(I2cRequest request, Done done) {
  WHIRL_CHECK(!busy());
  request_ = std::move(request);
  done_ = std::move(done);
  reply_ = {};
  reply_.acked = true;
  written_ = 0;
  reading_ = request_.write.empty() && request_.read > 0;
  bits(Phase::starting, 1);
}

// Does `count` bit times of `phase` as soon as the lines allow.
void I2cMaster::bits(Phase phase, int count) {
  phase_ = phase;
  count_ = count;
  waits_ = true;
  waits_since_ = queue_.now();
  timeout_.in(timeout_ns_);
  clock_may_run();
}

// The clock is held in the middle of a byte: its last bit waits.
void I2cMaster::hold() {
  resumes_ = true;
  bits(phase_, 1);
}

bool I2cMaster::may_run() {
  if (owns_) return bus_.scl().level();
  return abandoned_ ? bus_.scl().level() && bus_.sda().level() : bus_.idle();
}

void I2cMaster::clock_may_run() {
  const Nanoseconds now = queue_.now();
  if (!waits_ || !may_run()) return;
  waits_ = false;
  timeout_.cancel();
  const Nanoseconds from = std::max(now, bus_.released_ns());
  if (owns_) reply_.stretched_ns = std::max(reply_.stretched_ns, from - waits_since_);
  if (phase_ == Phase::reading && !resumes_) reply_.bytes.push_back(bus_.fetch(now));
  resumes_ = false;
  step_.at(from + std::llround(count_ * bit_ns_));
}

void I2cMaster::step() {
  const Nanoseconds now = queue_.now();
  if (owns_ && !bus_.scl().level()) return hold();
  switch (phase_) {
    case Phase::idle:
      return;
    case Phase::starting:
      if (!may_run()) return bits(Phase::starting, 1);  // somebody was faster
      owns_ = true;
      abandoned_ = false;
      bus_.start(now);
      return bits(Phase::addressing, 9);
    case Phase::addressing:
      return address_sent();
    case Phase::writing:
      if (!bus_.write(request_.write[written_++], now)) {
        reply_.acked = false;
        return bits(Phase::stopping, 1);
      }
      return next();
    case Phase::reading: {
      const bool more = static_cast<int>(reply_.bytes.size()) < request_.read;
      bus_.answer(more, now);
      return next();
    }
    case Phase::stopping:
      return finish();
  }
}

void I2cMaster::address_sent() {
  if (bus_.address(request_.address, reading_, queue_.now())) return next();
  reply_.acked = false;
  bits(Phase::stopping, 1);
}

void I2cMaster::next() {
  if (!reading_ && written_ < request_.write.size()) return bits(Phase::writing, 9);
  if (!reading_ && request_.read > 0) {
    reading_ = true;
    return bits(Phase::starting, 1);
  }
  if (reading_ && static_cast<int>(reply_.bytes.size()) < request_.read) {
    return bits(Phase::reading, 9);
  }
  bits(Phase::stopping, 1);
}

void I2cMaster::give_up() {
  reply_.timed_out = true;
  step_.cancel();
  waits_ = resumes_ = false;
  if (owns_) bus_.abandon(queue_.now());
  abandoned_ = abandoned_ || owns_;
  owns_ = false;
  finish();
}

void I2cMaster::finish() {
  phase_ = Phase::idle;
  timeout_.cancel();
  if (owns_) bus_.stop(queue_.now());
  owns_ = false;
  reply_.stop_ns = queue_.now();
  if (done_) done_(reply_);
}

}  // namespace whirl::io
