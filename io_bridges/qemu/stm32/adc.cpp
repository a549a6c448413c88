// One converter: its registers, its sequences, its data. What converters do together: adc_bank.cpp.
#include "io_bridges/qemu/stm32/adc.hpp"

#include <algorithm>
#include <cmath>

#include "io_bridges/qemu/stm32/adc_registers.hpp"
#include "io_bridges/qemu/stm32/register_access.hpp"

namespace whirl::stm32 {

using namespace adc;

namespace {

constexpr std::int64_t kCalibrationClocks = 83;  // F103

}  // namespace

Adc::Adc(AdcBank& bank, const Chip& chip, int index)
    : bank_(bank),
      chip_(chip),
      name_("ADC" + std::to_string(index + 1)),
      index_(index),
      event_(chip.events, [this] { step(); }),
      calibration_(chip.events, [this] { cr2_ &= ~(CAL | RSTCAL); }) {
  request_.on_transfer_complete([this] {
    if (bank_.packs_data()) {
      bank_.transfers_done();
    } else if (f4() && (cr2_ & DDS) == 0) {
      last_transfer_done_ = true;
    }
  });
}

bool Adc::f4() const {
  return bank_.family() == AdcFamily::f4;
}

void Adc::stop() {
  event_.cancel();
  active_ = Group::none;
  regular_waiting_ = automatic_ = false;
  rank_ = injected_rank_ = left_in_part_ = 0;
  repeat_after_ = 0;
}

void Adc::reset() {
  stop();
  calibration_.cancel();
  sr_ = cr1_ = cr2_ = ltr_ = jsqr_ = dr_ = 0;
  htr_ = 0xFFF;
  smpr_ = {};
  sqr_ = {};
  jofr_ = jdr_ = {};
  last_transfer_done_ = false;
  request_.set(false);
  select_triggers();
  bank_.update_interrupt();
}

std::uint32_t Adc::read(std::uint32_t offset, unsigned size) {
  return part_of_word(read_word(offset & ~3u), offset, size);
}

void Adc::write(std::uint32_t offset, std::uint32_t value, unsigned size) {
  write_word(offset & ~3u, on_all_lanes(value, size));
}

std::uint32_t Adc::read_word(std::uint32_t offset) {
  if (offset >= JOFR1 && offset <= JOFR4) return jofr_[(offset - JOFR1) / 4];
  if (offset >= SQR1 && offset <= SQR3) return sqr_[(offset - SQR1) / 4];
  if (offset >= JDR1 && offset <= JDR4) return jdr_[(offset - JDR1) / 4];
  switch (offset) {
    case SR:
      return sr_;
    case CR1:
      return cr1_;
    case CR2:
      return cr2_;
    case SMPR1:
    case SMPR2:
      return smpr_[(offset - SMPR1) / 4];
    case HTR:
      return htr_;
    case LTR:
      return ltr_;
    case JSQR:
      return jsqr_;
    case DR: {
      const std::uint32_t value = dr_ | bank_.upper_data(index_);
      data_read();
      return value;
    }
    default:
      return 0;
  }
}

void Adc::data_read() {
  sr_ &= ~EOC;
  request_.set(false);
  bank_.update_interrupt();
}

void Adc::write_word(std::uint32_t offset, std::uint32_t value) {
  if (offset >= JOFR1 && offset <= JOFR4) {
    jofr_[(offset - JOFR1) / 4] = value & 0xFFF;
  } else if (offset >= SQR1 && offset <= SQR3) {
    sqr_[(offset - SQR1) / 4] = value & (offset == SQR1 ? 0xFFFFFF : 0x3FFFFFFF);
  } else if (offset == SMPR1 || offset == SMPR2) {
    smpr_[(offset - SMPR1) / 4] = value & (offset == SMPR1 ? 0x7FFFFFF : 0x3FFFFFFF);
  } else if (offset == SR) {
    clear_where_zero(sr_, f4() ? 0x3F : 0x1F, value);
  } else if (offset == CR1) {
    cr1_ = value & (f4() ? 0x07C0FFFF : 0x00CFFFFF);
  } else if (offset == CR2) {
    write_cr2(value);
  } else if (offset == HTR) {
    htr_ = value & 0xFFF;
  } else if (offset == LTR) {
    ltr_ = value & 0xFFF;
  } else if (offset == JSQR) {
    jsqr_ = value & 0x3FFFFF;
  }
  bank_.update_interrupt();
}

void Adc::write_cr2(std::uint32_t value) {
  const std::uint32_t before = cr2_;
  cr2_ = value & (f4() ? 0x3F3F0F03 : 0x009EF90F) & ~(f4() ? 0u : (CAL | RSTCAL));
  if (!f4()) cr2_ |= before & (CAL | RSTCAL);
  if ((cr2_ & DMA) == 0) {
    last_transfer_done_ = false;
    request_.set(false);
  }
  if ((cr2_ & ADON) == 0) stop();
  select_triggers();
  if (!f4()) {
    write_cr2_f1(value, before);
    return;
  }
  if ((cr2_ & ADON) == 0) return;
  if ((value & SWSTART_F4) != 0) bank_.trigger_regular(index_);
  if ((value & JSWSTART_F4) != 0) bank_.trigger_injected(index_);
}

void Adc::write_cr2_f1(std::uint32_t value, std::uint32_t before) {
  if ((cr2_ & ADON) == 0) return;
  const std::uint32_t calibrate = value & (CAL | RSTCAL) & ~before;
  if (calibrate != 0 && (before & ADON) != 0) {
    cr2_ |= calibrate;
    const std::int64_t clocks = (calibrate & CAL) != 0 ? kCalibrationClocks : 1;
    calibration_.at(bank_.grid().time(bank_.next_half_clock() + 2 * clocks));
  }
  const std::uint32_t written = value & ~(SWSTART_F1 | JSWSTART_F1);
  const bool adon_again = (before & ADON) != 0 && written == before && value == written;
  const bool software = (cr2_ & EXTTRIG) != 0 && field(cr2_, 17, 3) == 7;
  const bool software_injected = (cr2_ & JEXTTRIG) != 0 && field(cr2_, 12, 3) == 7;
  if (adon_again || ((value & SWSTART_F1) != 0 && software)) bank_.trigger_regular(index_);
  if ((value & JSWSTART_F1) != 0 && software_injected) bank_.trigger_injected(index_);
}

void Adc::connect_regular(unsigned selection, TriggerLine& line) {
  const int handle = line.add_sink([this](bool level, Nanoseconds) { trigger_edge(false, level); });
  regular_taps_[selection] = {&line, handle};
}

void Adc::connect_injected(unsigned selection, TriggerLine& line) {
  const int handle = line.add_sink([this](bool level, Nanoseconds) { trigger_edge(true, level); });
  injected_taps_[selection] = {&line, handle};
}

void Adc::select_triggers() {
  const bool on = (cr2_ & ADON) != 0;
  const bool regular = on && (f4() ? field(cr2_, 28, 2) != 0 : (cr2_ & EXTTRIG) != 0);
  const bool injected = on && (f4() ? field(cr2_, 20, 2) != 0 : (cr2_ & JEXTTRIG) != 0);
  const unsigned selected = f4() ? field(cr2_, 24, 4) : field(cr2_, 17, 3);
  const unsigned selected_injected = f4() ? field(cr2_, 16, 4) : field(cr2_, 12, 3);
  for (unsigned i = 0; i < 16; ++i) {
    const Tap& r = regular_taps_[i];
    const Tap& j = injected_taps_[i];
    if (r.line != nullptr) r.line->listen(r.handle, regular && i == selected);
    if (j.line != nullptr) j.line->listen(j.handle, injected && i == selected_injected);
  }
}

void Adc::trigger_edge(bool injected, bool level) {
  const unsigned edges = f4() ? field(cr2_, injected ? 20 : 28, 2) : 1;
  if ((edges & (level ? 1u : 2u)) == 0) return;
  if (injected) {
    bank_.trigger_injected(index_);
  } else {
    bank_.trigger_regular(index_);
  }
}

void Adc::start_regular(std::int64_t half_clock, std::int64_t repeat_after) {
  if ((cr2_ & ADON) == 0 || (f4() && (sr_ & OVR) != 0)) return;
  if (active_ == Group::regular || regular_waiting_) return;
  repeat_after_ = repeat_after;
  sr_ |= STRT;
  if ((cr1_ & DISCEN) == 0 || rank_ >= regular_length()) rank_ = 0;
  left_in_part_ = (cr1_ & DISCEN) != 0 ? field(cr1_, 13, 3) + 1 : 0;
  if (active_ == Group::injected) {
    regular_waiting_ = true;
  } else {
    begin(Group::regular, half_clock);
  }
}

void Adc::start_injected(std::int64_t half_clock) {
  if ((cr2_ & ADON) == 0 || active_ == Group::injected) return;
  regular_waiting_ = active_ == Group::regular;
  sr_ |= JSTRT;
  if ((cr1_ & JDISCEN) == 0 || injected_rank_ >= injected_length()) injected_rank_ = 0;
  begin(Group::injected, half_clock);
}

void Adc::begin(Group group, std::int64_t half_clock) {
  active_ = group;
  start_ = half_clock;
  sampled_ = false;
  const bool regular = group == Group::regular;
  if ((regular ? rank_ : injected_rank_) == 0) {
    (regular ? regular_began_ : injected_began_) = half_clock;
  }
  channel_ = regular ? regular_channel(rank_) : injected_channel(injected_rank_);
  event_.at(bank_.grid().time(start_ + sampling_half_clocks(channel_)));
}

void Adc::step() {
  if (sampled_) {
    finish();
    return;
  }
  const double volts = bank_.volts(index_, channel_);
  const double code = std::floor(volts / bank_.vdda_V() * 4096.0 + 0.5);
  code_ = code >= 4095.0 ? 4095 : code > 0.0 ? static_cast<std::uint32_t>(code) : 0;
  sampled_ = true;
  start_ += sampling_half_clocks(channel_) + conversion_half_clocks();  // now: its end
  event_.at(bank_.grid().time(start_));
}

void Adc::finish() {
  if (active_ == Group::regular) {
    finish_regular(start_);
  } else {
    finish_injected(start_);
  }
  bank_.update_interrupt();
}

void Adc::finish_regular(std::int64_t at) {
  const bool last = rank_ + 1 >= regular_length();
  active_ = Group::none;
  const std::uint32_t code = code_;
  rank_ = last ? 0 : rank_ + 1;
  const bool part_over = left_in_part_ > 0 && --left_in_part_ == 0;
  watch_window(code, false);
  if (last) {
    tell_sequence(regular_began_, at);
    sequence_over(at);
  } else if (!part_over) {
    begin(Group::regular, at);
  }
  store_regular(code, last);
}

void Adc::sequence_over(std::int64_t at) {
  const bool again = (cr2_ & CONT) != 0 && (cr1_ & DISCEN) == 0;
  if ((cr1_ & JAUTO) != 0) {
    automatic_ = true;
    regular_waiting_ = again;
    sr_ |= JSTRT;
    injected_rank_ = 0;
    begin(Group::injected, at);
  } else if (again) {
    begin(Group::regular, at);
  } else if (repeat_after_ > 0) {
    const std::int64_t began = at - sampling_half_clocks(channel_) - conversion_half_clocks();
    begin(Group::regular, std::max(at, began + repeat_after_));
  }
}

void Adc::finish_injected(std::int64_t at) {
  const std::int32_t value = static_cast<std::int32_t>(code_ >> (12 - bits()));
  const std::uint32_t offset = jofr_[injected_rank_];
  jdr_[injected_rank_] = align(value - static_cast<std::int32_t>(offset), true);
  const bool last = injected_rank_ + 1 >= injected_length();
  watch_window(code_, true);
  injected_rank_ = last ? 0 : injected_rank_ + 1;
  active_ = Group::none;
  if (last) {
    sr_ |= f4() ? JEOC : JEOC | EOC;
    tell_sequence(injected_began_, at);
  }
  const bool one_per_trigger = (cr1_ & JDISCEN) != 0 && !automatic_;
  if (!last && !one_per_trigger) {
    begin(Group::injected, at);
  } else {
    injected_over(at);
  }
}

void Adc::injected_over(std::int64_t at) {
  automatic_ = false;
  if (!regular_waiting_) return;
  regular_waiting_ = false;
  begin(Group::regular, at);
}

void Adc::tell_sequence(std::int64_t began, std::int64_t ended) {
  if (sequence_sink_) sequence_sink_(bank_.grid().time(began), bank_.grid().time(ended));
}

void Adc::watch_window(std::uint32_t code, bool injected) {
  if ((cr1_ & (injected ? JAWDEN : AWDEN)) == 0) return;
  if ((cr1_ & AWDSGL) != 0 && field(cr1_, 0, 5) != channel_) return;
  if (code > htr_ || code < ltr_) sr_ |= AWD;
}

// Left: regular data end at bit 15, injected data (signed) at bit 14; 6-bit data stay in a byte.
std::uint32_t Adc::align(std::int32_t value, bool injected) const {
  if ((cr2_ & ALIGN) != 0) {
    const unsigned left = bits() == 6 ? 2 : 16 - bits();
    value *= 1 << (injected ? left - 1 : left);
  }
  return static_cast<std::uint32_t>(value) & 0xFFFF;
}

void Adc::store_regular(std::uint32_t code, bool last) {
  const std::uint32_t value = align(static_cast<std::int32_t>(code >> (12 - bits())), false);
  if (bank_.packs_data()) {
    dr_ = value;
    sr_ |= EOC;
    bank_.regular_data(index_, value);
    return;
  }
  const bool per_conversion = f4() && (cr2_ & EOCS) != 0;
  const bool by_dma = (cr2_ & DMA) != 0;
  const bool unread = by_dma ? request_.level() : per_conversion && (sr_ & EOC) != 0;
  if (f4() && unread) {  // the new value is lost, the old one stays valid
    flag_overrun();
    return;
  }
  dr_ = value;
  if (per_conversion || last) sr_ |= EOC;
  bank_.update_interrupt();
  if (by_dma && !last_transfer_done_) request_.set(true);
}

// The regular group stops until software clears OVR and starts afresh.
void Adc::flag_overrun() {
  sr_ |= OVR;
  request_.set(false);
  if (active_ == Group::regular) {
    event_.cancel();
    active_ = Group::none;
  }
  regular_waiting_ = false;
  rank_ = 0;
}

bool Adc::sensors_on() const {
  return (cr2_ & TSVREFE_F1) != 0;
}

bool Adc::interrupting() const {
  return ((sr_ & EOC) != 0 && (cr1_ & EOCIE) != 0) || ((sr_ & AWD) != 0 && (cr1_ & AWDIE) != 0) ||
         ((sr_ & JEOC) != 0 && (cr1_ & JEOCIE) != 0) || ((sr_ & OVR) != 0 && (cr1_ & OVRIE) != 0);
}

}  // namespace whirl::stm32
