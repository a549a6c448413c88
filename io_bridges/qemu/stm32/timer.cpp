// The registers of a timer. Counting, scheduling, inputs and outputs: timer_*.cpp.
#include "io_bridges/qemu/stm32/timer.hpp"

#include "io_bridges/qemu/stm32/register_access.hpp"

namespace whirl::stm32 {

using namespace tim;

namespace {

std::string signal_name(int timer, const std::string& suffix) {
  return "TIM" + std::to_string(timer) + "_" + suffix;
}

struct Masks {
  std::uint32_t cr1, cr2, smcr, dier, sr, ccer;
};

Masks masks(TimerKind kind) {
  switch (kind) {
    case TimerKind::advanced:
      return {0x3FF, 0x7FFD, 0xFFF7, 0x7FFF, 0x1EFF, 0x3FFF};
    case TimerKind::general_32:
    case TimerKind::general_16:
      return {0x3FF, 0x00F8, 0xFFF7, 0x5F5F, 0x1E5F, 0xBBBB};
    case TimerKind::two_channel:
      return {0x38F, 0, 0x00F7, 0x0047, 0x0647, 0x00BB};
    case TimerKind::one_channel:
      return {0x38F, 0, 0, 0x0003, 0x0203, 0x000B};
    case TimerKind::basic:
      return {0x08F, 0x0070, 0, 0x0101, 0x0001, 0};
  }
  return {};
}

}  // namespace

Timer::Timer(const Chip& chip, const TimerConfig& config)
    : chip_(chip),
      config_(config),
      can_(abilities(config.kind)),
      name_("TIM" + std::to_string(config.number)),
      event_(chip.events,
             [this] {
               sync();
               settle();
             }),
      etr_(signal_name(config.number, "ETR"), false),
      break_(signal_name(config.number, "BKIN"), false),
      resynchronised_(chip.events, [this] { hear_late_edges(); }),
      update_irq_(chip.interrupts, config.update_irq),
      compare_irq_(chip.interrupts, config.compare_irq),
      trigger_irq_(chip.interrupts, config.trigger_irq),
      break_irq_(chip.interrupts, config.break_irq) {
  const auto refresh = [this] {
    sync();
    settle();
  };
  for (int ch = 0; ch < 4; ++ch) {
    const auto i = static_cast<std::size_t>(ch);
    const std::string number = "CH" + std::to_string(ch + 1);
    pins_[i] = std::make_unique<Signal>(signal_name(config.number, number), false);
    pins_n_[i] = std::make_unique<Signal>(signal_name(config.number, number + "N"), false);
    pins_[i]->watch([this, ch](bool, Nanoseconds) {
      raw_changed(ch);
      if (ch == 1 || ch == 2) raw_changed(0);
    });
    pins_[i]->on_route(refresh);
    pins_n_[i]->on_route(refresh);
    input_[i].filter = std::make_unique<io::Event>(chip.events, [this, ch] { filtered_edge(ch); });
    dead_time_[i] = std::make_unique<io::Event>(chip.events, [this, ch] {
      channel_[static_cast<std::size_t>(ch)].dead = false;
      drive_pins(ch);
    });
    compare_[i].on_wanted_change(refresh);
  }
  trgo_.on_wanted_change(refresh);
  etr_.watch([this](bool level, Nanoseconds) { etr_changed(level); });
  break_.watch([this](bool, Nanoseconds) { break_changed(); });
  for (std::size_t i = 0; i < kRequests; ++i) {
    dma_[i].on_served([this, i] { request_served(static_cast<int>(i)); });
  }
  arr_ = arr_shadow_ = max_count();
  chip_.clocks.on_change([this] { clock_changed(); });
  clock_changed();
}

Timer::~Timer() = default;

void Timer::reset() {
  sync();
  cr1_ = cr2_ = smcr_ = dier_ = sr_ = ccer_ = active_ccer_ = 0;
  ccmr_ = active_ccmr_ = {};
  psc_ = rcr_ = bdtr_ = dcr_ = or_ = psc_shadow_ = repetitions_ = 0;
  arr_ = arr_shadow_ = max_count();
  channel_ = {};
  cnt_ = 0;
  down_ = gate_ = false;
  psc_count_ = turns_ = 0;
  raised_ = pulses_ = burst_index_ = etr_edges_ = 0;
  burst_touched_ = false;
  late_edges_.clear();
  resynchronised_.cancel();
  for (auto& event : dead_time_) event->cancel();
  for (DmaRequest& request : dma_) request.set(false);
  select_trigger();
  pattern_dirty_ = phase_changed_ = true;
  settle();
}

std::uint32_t Timer::read(std::uint32_t offset, unsigned size) {
  sync();
  // What the counter passed while nobody waited for it concerns nobody now: no settle() here.
  const std::uint32_t word = read_word(offset & ~3u);
  return part_of_word(word, offset, size);
}

void Timer::write(std::uint32_t offset, std::uint32_t value, unsigned size) {
  sync();
  write_word(offset & ~3u, on_all_lanes(value, size));
  settle();
}

std::uint32_t Timer::read_word(std::uint32_t offset) {
  switch (offset) {
    case CR1:
      return centre() || encoder() ? (cr1_ & ~DIR) | (down_ ? DIR : 0) : cr1_;
    case CR2:
      return cr2_;
    case SMCR:
      return smcr_;
    case DIER:
      return dier_;
    case SR:
      return sr_;
    case CCMR1:
      return ccmr_[0];
    case CCMR2:
      return ccmr_[1];
    case CCER:
      return ccer_;
    case CNT:
      return cnt_;
    case PSC:
      return psc_;
    case ARR:
      return arr_;
    case RCR:
      return rcr_;
    case CCR1:
    case CCR2:
    case CCR3:
    case CCR4: {
      const int ch = static_cast<int>(offset - CCR1) / 4;
      if (ch >= can_.channels) return 0;
      if (!is_output(ch) && (sr_ & (CC1IF << ch)) != 0) {  // reading a capture takes it
        sr_ &= ~(CC1IF << ch);
        settle();
      }
      return channel_[static_cast<std::size_t>(ch)].ccr;
    }
    case BDTR:
      return bdtr_;
    case DCR:
      return dcr_;
    case DMAR: {
      if (!can_.dma || can_.channels == 0 || burst_register() >= DMAR) return 0;
      const std::uint32_t word = read_word(burst_register());
      burst_step();
      return word;
    }
    case OR:
      return or_;
    default:
      return 0;
  }
}

void Timer::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case CNT:
    case PSC:
    case ARR:
    case RCR:
    case CCR1:
    case CCR2:
    case CCR3:
    case CCR4:
      write_count(offset, value);
      break;
    default:
      write_control(offset, value);
      break;
  }
}

void Timer::write_count(std::uint32_t offset, std::uint32_t value) {
  if (!can_.wide) value &= 0xFFFF;
  switch (offset) {
    case CNT:
      cnt_ = value;
      turns_ = 0;
      normalise_direction();
      pattern_dirty_ = phase_changed_ = true;
      break;
    case PSC:
      psc_ = value & 0xFFFF;
      break;
    case ARR:
      arr_ = value;
      break;
    case RCR:
      if (can_.advanced) rcr_ = value & 0xFF;
      turns_ = 0;
      break;
    default:
      write_ccr(static_cast<int>(offset - CCR1) / 4, value);
      break;
  }
}

void Timer::write_ccr(int ch, std::uint32_t value) {
  if (ch < can_.channels && is_output(ch)) channel_[static_cast<std::size_t>(ch)].ccr = value;
}

void Timer::write_cr1(std::uint32_t value) {
  value &= masks(config_.kind).cr1;
  const bool enabled = (value & CEN) != 0 && (cr1_ & CEN) == 0;
  const bool was_centre = centre();
  cr1_ = (cr1_ & CEN) | (value & ~CEN);
  if ((value & CEN) == 0) cr1_ &= ~CEN;
  if (!centre() && !encoder()) down_ = (cr1_ & DIR) != 0;
  if (centre() && !was_centre) down_ = (cr1_ & DIR) != 0;
  normalise_direction();
  turns_ = 0;
  pattern_dirty_ = true;
  if (enabled) enable();
}

void Timer::write_control(std::uint32_t offset, std::uint32_t value) {
  const Masks mask = masks(config_.kind);
  switch (offset) {
    case CR1:
      write_cr1(value);
      break;
    case CR2:
      cr2_ = value & mask.cr2;
      pattern_dirty_ = true;
      raw_changed(0);
      break;
    case SMCR:
      smcr_ = value & mask.smcr;
      normalise_direction();  // an encoder may have left CNT at 0, counting down
      select_trigger();
      break;
    case DIER:
      dier_ = value & mask.dier;
      for (std::size_t i = 0; i < kRequests; ++i) {
        if ((dier_ & (UDE << i)) == 0) dma_[i].set(false);
      }
      break;
    case SR:
      clear_where_zero(sr_, mask.sr, value);
      break;
    case EGR:
      generate(value);
      break;
    case CCMR1:
    case CCMR2:
      write_ccmr(offset == CCMR1 ? 0 : 1, value);
      break;
    case CCER:
      write_ccer(value & mask.ccer);
      break;
    case BDTR:
      if (can_.advanced) write_bdtr(value & 0xFFFF);
      break;
    case DCR:
      if (can_.dma && can_.channels > 0) dcr_ = value & 0x1F1F;
      burst_index_ = 0;
      break;
    case DMAR:
      if (!can_.dma || can_.channels == 0 || burst_register() >= DMAR) break;
      write_word(burst_register(), value);
      burst_step();
      break;
    case OR:
      or_ = can_.option ? value & 0xC03 : 0;
      break;
    default:
      break;
  }
}

// CCxS is writable only while the channel is off.
void Timer::write_ccmr(int half, std::uint32_t value) {
  const int first = 2 * half;
  std::uint32_t fixed = 0;
  for (int i = 0; i < 2; ++i) {
    if (bit(ccer_, 4 * static_cast<unsigned>(first + i))) fixed |= 3u << (8 * i);
    if (first + i >= can_.channels) fixed |= 0xFFu << (8 * i);
  }
  std::uint32_t& reg = ccmr_[static_cast<std::size_t>(half)];
  reg = ((value & ~fixed) | (reg & fixed)) & 0xFFFF;
  pattern_dirty_ = true;
  select_trigger();
}

void Timer::write_ccer(std::uint32_t value) {
  if (!config_.both_edges && !can_.advanced) value &= 0x3333;
  if (((bdtr_ >> 8) & 3) >= 2) value = (value & ~0x2AAAu) | (ccer_ & 0x2AAA);  // LOCK level 2
  for (int ch = 0; ch < can_.channels; ++ch) {
    if (!bit(value, 4 * static_cast<unsigned>(ch)))
      channel_[static_cast<std::size_t>(ch)].captures = 0;
  }
  ccer_ = value;
  pattern_dirty_ = true;
}

void Timer::write_bdtr(std::uint32_t value) {
  const std::uint32_t lock = (bdtr_ >> 8) & 3;
  std::uint32_t fixed = 0;
  if (lock != 0) fixed |= 0x300 | 0xFF | BKE | BKP | AOE;
  if (lock >= 2) fixed |= OSSI | OSSR;
  bdtr_ = (value & ~fixed) | (bdtr_ & fixed);
  pattern_dirty_ = true;
  if (break_active()) break_now();
}

void Timer::generate(std::uint32_t egr) {
  egr &= masks(config_.kind).sr & 0xFF;
  if ((egr & UIF) != 0) restart_count();
  for (int ch = 0; ch < can_.channels; ++ch) {
    if ((egr & (CC1IF << ch)) == 0) continue;
    if (is_output(ch)) {
      sr_ |= CC1IF << ch;
      if ((dier_ & (CC1DE << ch)) != 0) raise(ch + 1);
    } else {
      capture(ch);
    }
  }
  if ((egr & COMIF) != 0) com_event();
  if ((egr & TIF) != 0) set_trigger_flag();
  if ((egr & BIF) != 0) break_now();
}

}  // namespace whirl::stm32
