// I2C as a master: START, address, bytes, STOP; see i2c.hpp.
#include <algorithm>
#include <cmath>

#include "io_bridges/qemu/stm32/i2c.hpp"
#include "io_bridges/qemu/stm32/i2c_bits.hpp"

namespace whirl::stm32 {
using namespace i2c_bits;

void I2c::try_start() {
  if ((cr1_ & (PE | START)) != (PE | START) || phase_ != Phase::idle || slave_ != Slave::none) {
    return;
  }
  if (!routed() || !bus_.idle()) return;  // tried again when a line rises or a STOP passes
  phase_ = Phase::starting;
  step_.in(std::llround(bit_ns_ / 2));
}

// The clock is held (or the bus is free): do what CR1 asks for, STOP before START.
void I2c::act() {
  if (phase_ == Phase::idle) return try_start();
  if (phase_ != Phase::holding) return;  // after the byte that is under way
  const bool fresh_read = (sr1_ & ADDR) != 0 && !transmitter_;
  if (fresh_read) return;  // one byte comes first, as soon as ADDR is cleared
  if ((cr1_ & STOP) != 0) return begin_stop();
  if ((cr1_ & START) == 0 || (sr1_ & SB) != 0) return;
  phase_ = Phase::starting;
  after_bits(1);
}

void I2c::after_bits(int bits) {
  const Nanoseconds from = std::max(chip_.events.now(), bus_.released_ns());
  step_.at(from + std::llround(bits * bit_ns_));
}

void I2c::begin_bits(Phase phase, int bits) {
  phase_ = phase;
  if (!bus_.scl().level()) {
    waits_for_scl_ = true;
    return;
  }
  if (fetch_due_) shift_ = bus_.fetch(chip_.events.now());
  fetch_due_ = false;
  after_bits(bits);
}

void I2c::step() {
  if (phase_ != Phase::stopping && phase_ != Phase::starting && !bus_.scl().level()) {
    waits_for_scl_ = true;  // somebody holds the clock: the byte ends later
    return;
  }
  switch (phase_) {
    case Phase::starting:
      started();
      break;
    case Phase::addressing:
      address_sent();
      break;
    case Phase::sending:
      byte_sent();
      break;
    case Phase::receiving:
      byte_received();
      break;
    case Phase::stopping:
      stopped();
      break;
    case Phase::idle:
    case Phase::holding:
      break;
  }
  update();
}

void I2c::started() {
  if (!master_ && !bus_.idle()) {  // somebody was faster
    phase_ = Phase::idle;
    return;
  }
  bus_.start(chip_.events.now());
  master_ = true;
  transmitter_ = nacked_ = dr_full_ = shift_full_ = dma_last_ = false;
  cr1_ &= ~START;
  sr1_ = (sr1_ & ~(TXE | BTF)) | SB;
  phase_ = Phase::holding;
  if ((cr1_ & STOP) != 0) begin_stop();
}

bool I2c::lost_arbitration(std::uint8_t sent) {
  if (bus_.sda().level() || sent == 0) return false;
  sr1_ |= ARLO;
  sr1_ &= ~(TXE | BTF);
  master_ = transmitter_ = dr_full_ = false;
  phase_ = Phase::idle;
  bus_.stop(chip_.events.now());
  return true;
}

void I2c::address_sent() {
  if (lost_arbitration(shift_)) return;
  const bool read = (shift_ & 1) != 0;
  phase_ = Phase::holding;
  if (!bus_.address(shift_ >> 1, read, chip_.events.now())) {
    sr1_ |= AF;
    nacked_ = true;
    return act();
  }
  sr1_ |= ADDR;
  transmitter_ = !read;
  if (transmitter_) sr1_ |= TXE;
  next_ack_ = (cr1_ & ACK) != 0;
  act();
}

void I2c::load_shift() {
  shift_ = dr_;
  dr_full_ = false;
  sr1_ = (sr1_ & ~BTF) | TXE;
  begin_bits(Phase::sending, 9);
}

void I2c::byte_sent() {
  if (lost_arbitration(shift_)) return;
  if (!bus_.write(shift_, chip_.events.now())) {
    sr1_ |= AF;
    nacked_ = true;
  }
  next_or_hold(dr_full_ && !nacked_);
  if (phase_ == Phase::holding && !nacked_) sr1_ |= BTF;
}

// What a slave that stretches will send is known when it lets go of the clock.
void I2c::begin_receive() {
  fetch_due_ = true;
  begin_bits(Phase::receiving, 9);
}

// ACK answers the byte that comes now; with POS it answers the one after it. LAST answers the byte
// that follows the DMA's last but one with NACK.
bool I2c::acknowledge_now() {
  const bool bit = (cr1_ & ACK) != 0;
  bool ack = bit;
  if ((cr1_ & POS) != 0) {
    ack = next_ack_;
    next_ack_ = bit;
  }
  return ack && !dma_last_;
}

void I2c::byte_received() {
  const bool ack = acknowledge_now();
  bus_.answer(ack, chip_.events.now());
  nacked_ = !ack;
  store_received(shift_);
  next_or_hold(ack && !shift_full_);
}

// DR first; while DR is still full the byte stays in the shift register and the clock stops.
void I2c::store_received(std::uint8_t byte) {
  if ((sr1_ & RXNE) == 0) {
    dr_ = byte;
    sr1_ |= RXNE;
    return;
  }
  shift_ = byte;
  shift_full_ = true;
  sr1_ |= BTF;
}

// A byte is through: STOP, START, the next byte, or hold the clock.
void I2c::next_or_hold(bool more) {
  phase_ = Phase::holding;
  if ((cr1_ & (STOP | START)) != 0) return act();
  if (!more) return;
  if (transmitter_) {
    load_shift();
  } else {
    begin_receive();
  }
}

void I2c::begin_stop() {
  phase_ = Phase::stopping;
  after_bits(1);
}

void I2c::stopped() {
  if (!lines_high()) return;  // a stuck line: STOP stays pending until it rises
  master_ = transmitter_ = dr_full_ = dma_last_ = false;
  cr1_ &= ~STOP;
  sr1_ &= ~(TXE | BTF | SB);
  phase_ = Phase::idle;
  bus_.stop(chip_.events.now());  // calls back: a START that waits begins
  try_start();
}

}  // namespace whirl::stm32
