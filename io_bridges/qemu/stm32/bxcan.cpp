#include "io_bridges/qemu/stm32/bxcan.hpp"

#include <algorithm>
#include <utility>

#include "io_bridges/qemu/stm32/bxcan_bits.hpp"
#include "io_bridges/qemu/stm32/register_access.hpp"

namespace whirl::stm32 {

using namespace bxcan;

namespace {

enum : std::uint32_t {
  MCR = 0x00,
  MSR = 0x04,
  TSR = 0x08,
  RF0R = 0x0C,
  RF1R = 0x10,
  IER = 0x14,
  ESR = 0x18,
  BTR = 0x1C,
  TI0R = 0x180,
  RI0R = 0x1B0,
  FILTERS = 0x200,
  END = 0x320,
};

}  // namespace

BxCan::BxCan(const Chip& chip, const CanConfig& config, CanFilters& filters)
    : chip_(chip),
      config_(config),
      filters_(filters),
      rx_(std::string("CAN") + std::to_string(config.number) + "_RX", true),
      tx_(std::string("CAN") + std::to_string(config.number) + "_TX", true),
      own_bus_(chip.events, name(), chip.finding),
      loop_(chip.events, std::string(name()) + " loop"),
      station_(&own_bus_.join(*this, name())),
      loop_station_(&loop_.join(*this, name())),
      tx_irq_(chip.interrupts, config.tx_irq),
      rx0_irq_(chip.interrupts, config.rx0_irq),
      rx1_irq_(chip.interrupts, config.rx1_irq),
      sce_irq_(chip.interrupts, config.sce_irq) {
  chip_.clocks.on_change([this] { set_bit_time(); });
}

void BxCan::wire_to(io::CanBus& bus) {
  bus_ = &bus;
  station_ = &bus.join(*this, name());
}

bool BxCan::loops_back() const {
  return (btr_ & LBKM) != 0;
}

void BxCan::set_bit_time() {
  const double bit_ns = bit_time_s() * 1e9;
  bus_->configure(*station_, bit_ns, (btr_ & SILM) != 0);
  loop_.configure(*loop_station_, bit_ns, false, true);
}

void BxCan::reset() {
  bus_->disconnect(*station_);
  loop_.disconnect(*loop_station_);
  mcr_ = 0x00010002;
  ier_ = lec_ = msr_flags_ = tsr_flags_ = levels_ = 0;
  btr_ = 0x01230000;
  init_acknowledged_ = leaving_ = false;
  sleeping_ = true;
  mailbox_ = {};
  fifo_ = {};
  offered_ = in_flight_ = -1;
  abort_in_flight_ = false;
  if (config_.number == 1) filters_.reset();
  update_lines();
}

double BxCan::bit_time_s() const {
  const double quanta = 3.0 + field(btr_, 16, 4) + field(btr_, 20, 3);
  const double pclk1_Hz = chip_.clocks.pclk1_Hz();
  return pclk1_Hz > 0.0 ? quanta * (field(btr_, 0, 10) + 1) / pclk1_Hz : 1.0;
}

std::uint32_t BxCan::msr() const {
  const bool sends = in_flight_ >= 0 && (loops_back() ? loop_ : *bus_).sends(station());
  return 0xC00 | (sends ? 0x100 : 0) | msr_flags_ | (sleeping_ ? SLAK : 0) |
         (init_acknowledged_ ? INAK : 0);
}

std::uint32_t BxCan::tsr() const {
  std::uint32_t word = tsr_flags_;
  int lowest_free = -1;
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (mailbox_[i].pending) continue;
    word |= 1u << (26 + i);
    if (lowest_free < 0) lowest_free = static_cast<int>(i);
  }
  // CODE: the next free mailbox, or the one of lowest priority when none is.
  if (lowest_free >= 0) return word | static_cast<std::uint32_t>(lowest_free) << 24;
  return word | 2u << 24;
}

std::uint32_t BxCan::esr() const {
  const auto tec = static_cast<std::uint32_t>(std::min(station().tec(), 255));
  const auto rec = static_cast<std::uint32_t>(station().rec());
  return rec << 24 | tec << 16 | lec_ << 4 | (station().is_bus_off() ? BOFF : 0) |
         (tec > 127 || rec > 127 ? EPVF : 0) | (tec >= 96 || rec >= 96 ? EWGF : 0);
}

std::uint32_t BxCan::fifo_register(int n) const {
  const Fifo& fifo = fifo_[static_cast<std::size_t>(n)];
  return static_cast<std::uint32_t>(fifo.frames.size()) | (fifo.full ? FULL : 0) |
         (fifo.overrun ? FOVR : 0);
}

std::uint32_t BxCan::read(std::uint32_t offset, unsigned size) {
  return part_of_word(read_word(offset & ~3u), offset, size);
}

void BxCan::write(std::uint32_t offset, std::uint32_t value, unsigned size) {
  write_word(offset & ~3u, on_all_lanes(value, size));
  update_lines();
}

std::uint32_t BxCan::read_word(std::uint32_t offset) {
  if (offset >= TI0R && offset < RI0R) return mailbox_[(offset - TI0R) / 16].word[offset / 4 % 4];
  if (offset >= RI0R && offset < RI0R + 32) {
    const Fifo& fifo = fifo_[(offset - RI0R) / 16];
    return fifo.frames.empty() ? 0 : fifo.frames.front().word[offset / 4 % 4];
  }
  if (offset >= FILTERS && offset < END) return config_.number == 1 ? filters_.read(offset) : 0;
  switch (offset) {
    case MCR:
      return mcr_;
    case MSR:
      return msr();
    case TSR:
      return tsr();
    case RF0R:
      return fifo_register(0);
    case RF1R:
      return fifo_register(1);
    case IER:
      return ier_;
    case ESR:
      return esr();
    case BTR:
      return btr_;
    default:
      return 0;
  }
}

void BxCan::write_word(std::uint32_t offset, std::uint32_t value) {
  if (offset >= TI0R && offset < RI0R) {
    write_mailbox(offset, value);
  } else if (offset >= FILTERS && offset < END) {
    if (config_.number == 1) filters_.write(offset, value);
  } else if (offset == MCR) {
    write_mcr(value);
  } else if (offset == MSR) {
    msr_flags_ &= ~(value & (ERRI | WKUI | SLAKI));
  } else if (offset == TSR) {
    write_tsr(value);
  } else if (offset == RF0R || offset == RF1R) {
    Fifo& fifo = fifo_[offset == RF0R ? 0 : 1];
    if ((value & FULL) != 0) fifo.full = false;
    if ((value & FOVR) != 0) fifo.overrun = false;
    if ((value & RFOM) != 0) release(offset == RF0R ? 0 : 1);
  } else if (offset == IER) {
    ier_ = value & 0x38F7F;
  } else if (offset == ESR) {
    lec_ = field(value, 4, 3);
  } else if (offset == BTR && initialising()) {
    btr_ = value & 0xC37F03FF;
  }
}

void BxCan::write_mcr(std::uint32_t value) {
  if ((value & RESET) != 0) {
    reset();
    return;
  }
  mcr_ = value & 0x100FF;
  enter_or_leave();
}

// INRQ is acknowledged once nothing is being sent; leaving needs eleven recessive bits, and a node that
// went bus-off before it needs 128 times as many.
void BxCan::enter_or_leave() {
  const bool was_sleeping = sleeping_;
  const bool init = (mcr_ & INRQ) != 0;
  sleeping_ = (mcr_ & SLEEP) != 0 && in_flight_ < 0 && !init;
  if (sleeping_ && !was_sleeping) msr_flags_ |= SLAKI;
  if (sleeping_) {
    init_acknowledged_ = leaving_ = false;
    bus_->disconnect(*station_);
    loop_.disconnect(*loop_station_);
  } else if (init && in_flight_ < 0) {
    init_acknowledged_ = true;
    leaving_ = false;
    bus_->disconnect(*station_);
    loop_.disconnect(*loop_station_);
  } else if (!init && !leaving_ && (init_acknowledged_ || was_sleeping)) {
    leave(station().is_bus_off() ? kAfterBusOff : kAfterInit);
  }
}

void BxCan::write_tsr(std::uint32_t value) {
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::uint32_t shift = 8 * i;
    if ((value & (RQCP << shift)) != 0) tsr_flags_ &= ~(0xFu << shift);
    if ((value & (ABRQ << shift)) != 0) abort(static_cast<int>(i));
  }
}

void BxCan::write_mailbox(std::uint32_t offset, std::uint32_t value) {
  const std::uint32_t n = (offset - TI0R) / 16, which = offset / 4 % 4;
  Mailbox& mailbox = mailbox_[n];
  if (mailbox.pending) return;
  mailbox.word[which] = which == 1 ? value & 0xFFFF010F : value;
  if (which != 0 || (value & TXRQ) == 0) return;
  mailbox.pending = true;
  mailbox.order = sequence_++;
  tsr_flags_ &= ~(0xFu << (8 * n));
  (loops_back() ? loop_ : *bus_).request(station());
}

void BxCan::abort(int mailbox) {
  if (!mailbox_[static_cast<std::size_t>(mailbox)].pending) return;
  if (mailbox == in_flight_) {
    abort_in_flight_ = true;
  } else {
    finish(mailbox, 0);
  }
}

void BxCan::release(int n) {
  Fifo& fifo = fifo_[static_cast<std::size_t>(n)];
  if (!fifo.frames.empty()) fifo.frames.pop_front();
  fifo.full = false;
}

// By identifier (then mailbox number), or in order of request with TXFP.
int BxCan::next_mailbox() const {
  int best = -1;
  for (int i = 0; i < 3; ++i) {
    const Mailbox& candidate = mailbox_[static_cast<std::size_t>(i)];
    if (!candidate.pending) continue;
    if (best < 0) {
      best = i;
      continue;
    }
    const Mailbox& leader = mailbox_[static_cast<std::size_t>(best)];
    const bool sooner = (mcr_ & TXFP) != 0 ? candidate.order < leader.order
                                           : candidate.word[0] >> 1 < leader.word[0] >> 1;
    if (sooner) best = i;
  }
  return best;
}

io::CanFrame BxCan::frame_of(const Mailbox& mailbox) const {
  io::CanFrame frame;
  const std::uint32_t head = mailbox.word[0];
  frame.extended = bit(head, 2);
  frame.id = frame.extended ? head >> 3 : head >> 21;
  frame.remote = bit(head, 1);
  frame.length = static_cast<std::uint8_t>(std::min(mailbox.word[1] & 15, 8u));
  for (unsigned i = 0; i < 8; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(mailbox.word[2 + i / 4] >> (8 * (i % 4)));
  }
  return frame;
}

void BxCan::store(const io::CanFrame& frame) {
  const CanFilters::Match match = filters_.match(frame, config_.number == 2);
  if (!match.accepted) return;
  Fifo& fifo = fifo_[static_cast<std::size_t>(match.fifo)];
  Received received;
  received.word[0] =
      (frame.extended ? frame.id << 3 | 4u : frame.id << 21) | (frame.remote ? 2u : 0);
  received.word[1] = match.index << 8 | frame.length;
  for (unsigned i = 0; i < 8 && i < frame.length; ++i) {
    received.word[2 + i / 4] |= static_cast<std::uint32_t>(frame.data[i]) << (8 * (i % 4));
  }
  if (fifo.frames.size() == 3) {
    fifo.overrun = true;
    if ((mcr_ & RFLM) == 0) fifo.frames.back() = received;
    return;
  }
  fifo.frames.push_back(received);
  if (fifo.frames.size() == 3) fifo.full = true;
}

void BxCan::update_lines() {
  const Fifo &zero = fifo_[0], &one = fifo_[1];
  tx_irq_.set((ier_ & TMEIE) != 0 && (tsr_flags_ & (RQCP | RQCP << 8 | RQCP << 16)) != 0);
  rx0_irq_.set(((ier_ & FMPIE0) != 0 && !zero.frames.empty()) ||
               ((ier_ & FFIE0) != 0 && zero.full) || ((ier_ & FOVIE0) != 0 && zero.overrun));
  rx1_irq_.set(((ier_ & FMPIE1) != 0 && !one.frames.empty()) || ((ier_ & FFIE1) != 0 && one.full) ||
               ((ier_ & FOVIE1) != 0 && one.overrun));
  sce_irq_.set(((ier_ & ERRIE) != 0 && (msr_flags_ & ERRI) != 0) ||
               ((ier_ & WKUIE) != 0 && (msr_flags_ & WKUI) != 0) ||
               ((ier_ & SLKIE) != 0 && (msr_flags_ & SLAKI) != 0));
}

}  // namespace whirl::stm32
