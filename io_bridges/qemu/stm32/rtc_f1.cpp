#include "io_bridges/qemu/stm32/rtc_f1.hpp"

#include "io_bridges/qemu/stm32/register_access.hpp"

namespace whirl::stm32 {

namespace {

enum : std::uint32_t {
  CRH = 0x00,
  CRL = 0x04,
  PRLH = 0x08,
  PRLL = 0x0C,
  DIVH = 0x10,
  DIVL = 0x14,
  CNTH = 0x18,
  CNTL = 0x1C,
  ALRH = 0x20,
  ALRL = 0x24,
};
constexpr std::uint32_t SECF = 1, ALRF = 2, OWF = 4, RSF = 8, CNF = 16, RTOFF = 32;
constexpr int kAlarmLine = 17;

void set_half(std::uint32_t& word, bool high, std::uint32_t half) {
  half &= 0xFFFF;
  word = high ? (word & 0xFFFF) | half << 16 : (word & 0xFFFF0000) | half;
}

}  // namespace

RtcF1::RtcF1(const Chip& chip, int irq, std::function<double()> rtcclk_Hz,
             std::function<bool()> writable, std::function<void(int, bool)> exti)
    : chip_(chip),
      irq_(chip.interrupts, irq),
      rtcclk_Hz_(std::move(rtcclk_Hz)),
      writable_(std::move(writable)),
      exti_(std::move(exti)),
      event_(chip.events, [this] {
        sync();
        arm();
      }) {
  clock_changed();
}

void RtcF1::clock_changed() {
  sync();
  grid_.set_frequency(rtcclk_Hz_ ? rtcclk_Hz_() : 0.0, chip_.events.now());
  arm();
}

void RtcF1::reset() {
  crh_ = flags_ = 0;
  configuring_ = false;
  synced_from_ = ticks();
  update_lines();
}

void RtcF1::reset_backup_domain() {
  reset();
  prl_ = new_prl_ = 0x8000;
  alarm_ = new_alarm_ = 0xFFFFFFFF;
  count_ = new_count_ = 0;
  anchor_ = ticks();
  arm();
}

// Advances the counter and raises what it passed.
void RtcF1::sync() {
  const std::int64_t steps = (ticks() - anchor_) / period();
  if (steps <= 0) return;
  anchor_ += steps * period();
  const std::uint64_t to = std::uint64_t{count_} + static_cast<std::uint64_t>(steps);
  flags_ |= SECF;
  if (alarm_ > count_ && alarm_ <= to) flags_ |= ALRF;
  if (to > 0xFFFFFFFFull) flags_ |= OWF;
  count_ = static_cast<std::uint32_t>(to);
  update_lines();
}

void RtcF1::arm() {
  event_.cancel();
  if (grid_.frequency_Hz() == 0) return;
  std::int64_t steps = 0;
  if ((crh_ & SECF) != 0) {
    steps = 1;
  } else if (alarm_ > count_) {
    steps = static_cast<std::int64_t>(alarm_) - count_;
  } else if ((crh_ & OWF) != 0) {
    steps = 0x100000000 - static_cast<std::int64_t>(count_);
  }
  const Nanoseconds due = steps > 0 ? grid_.time(anchor_ + steps * period()) : io::kNever;
  if (due != io::kNever) event_.at(due);
}

void RtcF1::update_lines() {
  irq_.set((flags_ & crh_ & 7) != 0);
  if (exti_) exti_(kAlarmLine, (flags_ & ALRF) != 0);
}

std::uint32_t RtcF1::status() const {
  std::uint32_t word = flags_ & 7;
  const bool clocked = grid_.frequency_Hz() > 0;
  if ((flags_ & RSF) != 0 || (clocked && ticks() > synced_from_)) word |= RSF;
  if (configuring_) word |= CNF;
  if (ticks() >= busy_until_) word |= RTOFF;
  return word;
}

void RtcF1::write_status(std::uint32_t value) {
  flags_ &= value | ~(SECF | ALRF | OWF);
  if ((value & RSF) == 0) synced_from_ = ticks();
  const bool entering = (value & CNF) != 0;
  if (entering && !configuring_) {
    new_prl_ = prl_, new_alarm_ = alarm_, new_count_ = count_;
    count_written_ = false;
  }
  if (!entering && configuring_) commit();
  configuring_ = entering;
  update_lines();
}

void RtcF1::commit() {
  sync();
  if (count_written_ || new_prl_ != prl_) anchor_ = ticks();
  prl_ = new_prl_ & 0xFFFFF;
  alarm_ = new_alarm_;
  if (count_written_) count_ = new_count_;
  busy_until_ = ticks() + 3;
  arm();
}

std::uint32_t RtcF1::read(std::uint32_t offset, unsigned size) {
  sync();
  const std::uint32_t left = static_cast<std::uint32_t>(
      period() - 1 - (grid_.frequency_Hz() > 0 ? (ticks() - anchor_) % period() : 0));
  std::uint32_t word = 0;
  switch (offset & ~3u) {
    case CRH:
      word = crh_;
      break;
    case CRL:
      word = status();
      break;
    case DIVH:
      word = left >> 16;
      break;
    case DIVL:
      word = left & 0xFFFF;
      break;
    case CNTH:
      word = count_ >> 16;
      break;
    case CNTL:
      word = count_ & 0xFFFF;
      break;
    default:
      break;  // PRL and ALR are write-only
  }
  return part_of_word(word, offset, size);
}

void RtcF1::write(std::uint32_t offset, std::uint32_t value, unsigned size) {
  value = on_all_lanes(value, size);
  sync();
  const std::uint32_t at = offset & ~3u;
  if (at == CRH) {
    crh_ = value & 7;
    arm();
    update_lines();
    return;
  }
  if (at == CRL) {
    write_status(value);
    return;
  }
  if (!configuring_ || (writable_ && !writable_())) return;
  switch (at) {
    case PRLH:
    case PRLL:
      set_half(new_prl_, at == PRLH, value);
      break;
    case CNTH:
    case CNTL:
      set_half(new_count_, at == CNTH, value);
      count_written_ = true;
      break;
    case ALRH:
    case ALRL:
      set_half(new_alarm_, at == ALRH, value);
      break;
    default:
      break;
  }
}

std::uint32_t BackupRegisters::read(std::uint32_t offset, unsigned size) {
  return offset < 4 * words_.size() ? part_of_word(words_[offset / 4], offset, size) : 0;
}

void BackupRegisters::write(std::uint32_t offset, std::uint32_t value, unsigned size) {
  if (offset < 4 || offset >= 4 * words_.size() || (writable_ && !writable_())) return;
  words_[offset / 4] = on_all_lanes(value, size) & 0xFFFF;
}

}  // namespace whirl::stm32
