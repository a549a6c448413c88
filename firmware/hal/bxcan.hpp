// bxCAN: frames of 29-bit identifiers out by three mailboxes and in by FIFO 0, both by interrupts.
//
//   Port     which block, clocks, pins and bit time; what a test has in their place:
//              Can, Filters     registers, read(offset) and write(offset, value); those of the filters are CAN1's
//              Lock             keeps this block's interrupts out while it lives
//              kBitTiming       BTR
//              kFirstBank       of the filters; kRxFrames, kTxFrames: sizes of the rings
//              start()          clocks, pins, interrupts
//   Order    what waits goes by identifier, and among equals in the order of send(); the mailboxes
//            go in the order of their filling (TXFP): the frames of a transfer cannot overtake each other
//   Errors   bus-off: all that waits is dropped, for a set-point of before is worse than none; the
//            block rejoins by itself after 128 times eleven recessive bits (ABOM). Meanwhile send()
//            answers no_answer
//   Owner    tasks send, read and cancel; on_...() come from interrupts of one priority
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "firmware/hal/bxcan_registers.hpp"
#include "firmware/hal/can_frame.hpp"
#include "firmware/status.hpp"

namespace fw::hal {

template <typename Port>
class BxCan {
 public:
  // no_answer: the block does not enter initialisation. bad_data: more filters than banks.
  Status init(std::span<const CanFilter> filters);
  Status send(const CanFrame& frame);  // busy: the queue is full
  bool read(CanFrame& frame);
  // Gives up what has not gone out. What is on the wire right now may still arrive.
  void cancel();
  std::size_t waiting() const { return queued_ + in_mailboxes(); }
  bool bus_off() const { return (Can::read(hw::bxcan::ESR) & hw::bxcan::BOFF) != 0; }
  bool error_passive() const { return (Can::read(hw::bxcan::ESR) & hw::bxcan::EPVF) != 0; }
  const CanCounters& counters() const { return counters_; }
  // Pre: one waits.
  const CanFrame& newest() const { return ring_[(first_ + count_ - 1) % ring_.size()]; }

  // From the interrupts.
  void on_transmit();
  bool on_receive();  // true: a frame came, newest()
  void on_status();

 private:
  using Can = typename Port::Can;
  static constexpr std::uint32_t kMailboxes = 3;
  static constexpr int kPolls = 10'000;
  static constexpr std::size_t kBanks = 14;

  static void modify(std::uint32_t offset, std::uint32_t clear, std::uint32_t set) {
    Port::Filters::write(offset, (Port::Filters::read(offset) & ~clear) | set);
  }
  static std::size_t in_mailboxes() {
    const std::uint32_t empty = Can::read(hw::bxcan::TSR) / hw::bxcan::TME0 & 7u;
    return kMailboxes - ((empty & 1u) + (empty >> 1 & 1u) + (empty >> 2 & 1u));
  }
  void set_filters(std::span<const CanFilter> filters);
  void fill_mailboxes();
  static void post(std::uint32_t mailbox, const CanFrame& frame);
  void drop_all();

  std::array<CanFrame, Port::kTxFrames> queue_{};  // the next one first
  std::size_t queued_ = 0;
  std::array<CanFrame, Port::kRxFrames> ring_{};
  std::size_t first_ = 0, count_ = 0;
  CanCounters counters_;
};

template <typename Port>
Status BxCan<Port>::init(std::span<const CanFilter> filters) {
  using namespace hw::bxcan;
  if (filters.size() > kBanks) return Status::bad_data;
  Port::start();
  Can::write(MCR, INRQ | ABOM | TXFP);  // SLEEP is cleared by it
  for (int i = 0; (Can::read(MSR) & INAK) == 0; ++i) {
    if (i == kPolls) return Status::no_answer;
  }
  Can::write(BTR, Port::kBitTiming);
  set_filters(filters);
  Can::write(IER, TMEIE | FMPIE0 | FOVIE0 | EPVIE | BOFIE | ERRIE);
  Can::write(MCR, ABOM | TXFP);  // it joins after eleven recessive bits, whenever those come
  return Status::ok;
}

// One bank of 32 bits with a mask each; IDE and RTR must fit, too.
template <typename Port>
void BxCan<Port>::set_filters(std::span<const CanFilter> filters) {
  using namespace hw::bxcan;
  const auto all = static_cast<std::uint32_t>((1u << filters.size()) - 1u) << Port::kFirstBank;
  modify(FMR, 0, FINIT);
  modify(FA1R, all, 0);
  modify(FM1R, all, 0);
  modify(FS1R, 0, all);
  modify(FFA1R, all, 0);
  std::uint32_t bank = F0R1 + 8 * Port::kFirstBank;
  for (const CanFilter& filter : filters) {
    Port::Filters::write(bank, filter.id << 3 | IDE);
    Port::Filters::write(bank + 4, filter.mask << 3 | IDE | RTR);
    bank += 8;
  }
  modify(FA1R, 0, all);
  modify(FMR, FINIT, 0);
}

template <typename Port>
Status BxCan<Port>::send(const CanFrame& frame) {
  const typename Port::Lock lock;
  if (bus_off()) {
    ++counters_.dropped;
    return Status::no_answer;
  }
  if (queued_ == queue_.size()) {
    ++counters_.dropped;
    return Status::busy;
  }
  std::size_t place = queued_++;
  for (; place > 0 && queue_[place - 1].id > frame.id; --place) queue_[place] = queue_[place - 1];
  queue_[place] = frame;
  fill_mailboxes();
  return Status::ok;
}

template <typename Port>
void BxCan<Port>::fill_mailboxes() {
  const std::uint32_t empty = Can::read(hw::bxcan::TSR);
  std::size_t taken = 0;
  for (std::uint32_t mailbox = 0; mailbox < kMailboxes && taken < queued_; ++mailbox) {
    if ((empty & hw::bxcan::TME0 << mailbox) != 0) post(mailbox, queue_[taken++]);
  }
  std::copy(queue_.begin() + static_cast<std::ptrdiff_t>(taken),
            queue_.begin() + static_cast<std::ptrdiff_t>(queued_), queue_.begin());
  queued_ -= taken;
}

template <typename Port>
void BxCan<Port>::post(std::uint32_t mailbox, const CanFrame& frame) {
  const std::uint32_t at = hw::bxcan::TI0R + 0x10 * mailbox;
  const auto word = [&frame](std::size_t i) {
    return static_cast<std::uint32_t>(frame.data[i] | frame.data[i + 1] << 8 |
                                      frame.data[i + 2] << 16) |
           static_cast<std::uint32_t>(frame.data[i + 3]) << 24;
  };
  Can::write(at + 4, frame.length);
  Can::write(at + 8, word(0));
  Can::write(at + 12, word(4));
  Can::write(at, frame.id << 3 | hw::bxcan::IDE | hw::bxcan::TXRQ);
}

template <typename Port>
bool BxCan<Port>::read(CanFrame& frame) {
  const typename Port::Lock lock;
  if (count_ == 0) return false;
  frame = ring_[first_];
  first_ = (first_ + 1) % ring_.size();
  --count_;
  return true;
}

template <typename Port>
void BxCan<Port>::cancel() {
  const typename Port::Lock lock;
  drop_all();
}

template <typename Port>
void BxCan<Port>::drop_all() {
  counters_.dropped += static_cast<std::uint32_t>(waiting());
  queued_ = 0;
  Can::write(hw::bxcan::TSR, hw::bxcan::ABRQ0 | hw::bxcan::ABRQ0 << 8 | hw::bxcan::ABRQ0 << 16);
}

template <typename Port>
void BxCan<Port>::on_transmit() {
  const std::uint32_t status = Can::read(hw::bxcan::TSR);
  std::uint32_t completed = 0;
  for (std::uint32_t shift = 0; shift < 8 * kMailboxes; shift += 8) {
    if ((status & hw::bxcan::RQCP0 << shift) == 0) continue;
    completed |= hw::bxcan::RQCP0 << shift;
    if ((status & hw::bxcan::TXOK0 << shift) != 0) ++counters_.sent;
  }
  Can::write(hw::bxcan::TSR, completed);
  fill_mailboxes();
}

// One frame: where more wait, the line stays up and the core comes back.
template <typename Port>
bool BxCan<Port>::on_receive() {
  using namespace hw::bxcan;
  const std::uint32_t status = Can::read(RF0R);
  if ((status & FOVR0) != 0) {
    ++counters_.lost;
    Can::write(RF0R, FOVR0);
  }
  if ((status & FMP0_Msk) == 0) return false;
  CanFrame frame;
  frame.id = Can::read(RI0R) >> 3;
  frame.length = static_cast<std::uint8_t>(std::min<std::uint32_t>(Can::read(RI0R + 4) & 15u, 8u));
  const std::uint32_t words[2] = {Can::read(RI0R + 8), Can::read(RI0R + 12)};
  Can::write(RF0R, RFOM0);
  for (unsigned i = 0; i < 8; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(words[i / 4] >> (8 * (i % 4)));
  }
  if (count_ == ring_.size()) {
    ++counters_.lost;
    return false;
  }
  ring_[(first_ + count_++) % ring_.size()] = frame;
  ++counters_.received;
  return true;
}

template <typename Port>
void BxCan<Port>::on_status() {
  const std::uint32_t state = Can::read(hw::bxcan::ESR);
  Can::write(hw::bxcan::MSR, hw::bxcan::ERRI);
  if ((state & hw::bxcan::BOFF) != 0) {
    ++counters_.bus_off;
    drop_all();
  } else if ((state & hw::bxcan::EPVF) != 0) {
    ++counters_.passive;
  }
}

}  // namespace fw::hal
