#include "firmware/pod/imu.hpp"

#include <algorithm>

#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/registers.hpp"
#include "firmware/pod/pod_pins.hpp"
#include "firmware/pod/pod_time.hpp"

namespace fw::pod {

using whirl::core::Mpu6000;
using whirl::core::Oddity;
namespace mpu = whirl::core::mpu;

namespace {

using PartsLock = hal::PriorityLock<kPriorityParts>;

constinit std::array<std::uint8_t, whirl::core::kRegisters> no_supply{};

}  // namespace

constinit PodImu imu;

void PodImu::start() {
  no_supply.fill(0xFF);
  hw::RCC::AHB1ENR::set(hw::RCC::GPIOCEN);
  DataReady::output(false, false);
  start_spi_slave();
  const PartsLock lock;
  part_.reset(now_ns());
  armed_ = answers(now_ns());
  arm_spi_slave(armed_);
}

const std::uint8_t* PodImu::answers(std::int64_t now) const {
  return powered_ ? part_.image(now) : no_supply.data();
}

// ---- What the registers ask for

void PodImu::odd(Oddity what, std::uint32_t /*detail*/, std::int64_t /*now*/) {
  ++oddities_;
  last_oddity_ = static_cast<std::uint8_t>(what);
}

// An open output (INT_OPEN) is driven high: the pod has no resistor of its own there.
void PodImu::interrupt_pin(Mpu6000::Pin pin, std::int64_t /*now*/) {
  DataReady::set(pin != Mpu6000::Pin::low);
}

void PodImu::pulse_ends_at(std::int64_t due) {
  const auto left_ns = static_cast<std::uint32_t>(due - now_ns());  // some 50 us: fits
  pulse_timer(std::max<std::uint32_t>(left_ns / 1000, 1));
}

void PodImu::was_reset() {
  part_.set_identity(identity_);
  clock_ns_ = whirl::core::kNever;
  pulse_timer(0);
}

void PodImu::pulse_over() {
  part_.pulse_over(now_ns());
}

// ---- The host's side

// Without room the one that is next comes early: its host is no part's any more.
void PodImu::sample(const Counts& counts, std::uint32_t due_us) {
  const PartsLock lock;
  if (waits_ == kRoom) waiting_[first_].due_us = now_us();
  if (waits_ == kRoom) show_due();
  waiting_[(first_ + waits_++) % kRoom] = {due_us, counts};
  show_due();
}

void PodImu::show_due() {
  while (waits_ != 0) {
    const Waiting& next = waiting_[first_];
    const auto left_us = static_cast<std::int32_t>(next.due_us - now_us());
    if (left_us > 0) return alarm_timer(static_cast<std::uint32_t>(left_us));
    first_ = (first_ + 1) % kRoom;
    --waits_;
    show(next.counts);
  }
}

void PodImu::show(const Counts& counts) {
  const std::int64_t now = now_ns();
  if (!powered_ || clock_ns_ == whirl::core::kNever || now < clock_ns_) return;
  ++samples_;
  if (spi_selected()) part_.begin_access();  // until that transfer is over
  if (!frozen_) part_.store(counts);
  if (spi_selected()) ++overlaps_;
  part_.data_ready(now);
}

void PodImu::poll() {
  const PartsLock lock;
  rearm(now_ns());
}

// A reset, and the end of one, answer from another page.
void PodImu::rearm(std::int64_t now) {
  const std::uint8_t* right = answers(now);
  if (right == armed_ || spi_selected()) return;
  armed_ = right;
  arm_spi_slave(armed_);
}

void PodImu::set_faults(bool frozen, bool powered, std::uint8_t identity) {
  const PartsLock lock;
  frozen_ = frozen;
  if (powered != powered_) part_.reset(now_ns());
  powered_ = powered;
  identity_ = identity;
  part_.set_identity(identity_);
}

std::uint8_t PodImu::setting(std::uint8_t address) const {
  return part_.image(whirl::core::kNever)[address & 0x7F];
}

// ---- The bus

void PodImu::transfer_over(const Transfer& transfer) {
  const std::int64_t now = now_ns();
  std::uint8_t address = transfer.first;
  if (transfer.burst) {
    part_.read_register(address, now);  // one stands for all: their effect is the same
  } else {
    for (std::uint32_t i = 0; i < transfer.count; ++i) {
      if (transfer.read) {
        part_.read_register(address, now);
      } else {
        part_.write_register(address, transfer.written[i], now);
      }
      address = Mpu6000::next_address(address);
    }
  }
  if (!spi_selected()) part_.end_access();  // else the next one's end does it
  rearm(now);
}

void transfer_over(const Transfer& transfer) {
  imu.transfer_over(transfer);
}

void pulse_over() {
  imu.pulse_over();
}

void alarm() {
  imu.alarm();
}

}  // namespace fw::pod
