// What the converters of a part do together: clock, interrupt, simultaneous and interleaved modes.
#include "io_bridges/qemu/stm32/adc.hpp"
#include "io_bridges/qemu/stm32/adc_registers.hpp"
#include "io_bridges/qemu/stm32/register_access.hpp"

namespace whirl::stm32 {

using namespace adc;

namespace {

constexpr unsigned kTemperature = 16, kReference = 17, kBattery = 18;

}  // namespace

AdcBank::AdcBank(const Chip& chip, AdcConfig config)
    : chip_(chip), config_(std::move(config)), irq_(chip.interrupts, config_.irq) {
  for (int i = 0; i < config_.converters; ++i) {
    converters_.push_back(std::make_unique<Adc>(*this, chip, i));
  }
  chip_.clocks.on_change([this] { update_clock(); });
  update_clock();
}

void AdcBank::reset() {
  for (auto& converter : converters_) converter->reset();
  ccr_ = 0;
  latest_ = {};
  fresh_ = 0;
  stream_.clear();
  packed_.clear();
  last_transfer_done_ = false;
  alternate_ = 0;
  update_clock();
}

void AdcBank::connect_regular(unsigned selection, TriggerLine& line) {
  for (auto& converter : converters_) converter->connect_regular(selection, line);
}

void AdcBank::connect_injected(unsigned selection, TriggerLine& line) {
  for (auto& converter : converters_) converter->connect_injected(selection, line);
}

void AdcBank::update_clock() {
  const double own_Hz = config_.family == AdcFamily::f1 && config_.adcclk_Hz
                            ? config_.adcclk_Hz()
                            : chip_.clocks.pclk2_Hz() / (2 + 2 * field(ccr_, 16, 2));
  grid_.set_frequency(2.0 * own_Hz, chip_.events.now());
}

// The next whole clock, counted in halves.
std::int64_t AdcBank::next_half_clock() {
  const std::int64_t next = grid_.next_tick(chip_.events.now());
  return next + (next & 1);
}

void AdcBank::update_interrupt() {
  bool any = false;
  for (const auto& converter : converters_) any = any || converter->interrupting();
  irq_.set(any);
}

double AdcBank::volts(int index, unsigned channel) const {
  if (channel < kTemperature) {
    return config_.volts ? config_.volts(index + 1, static_cast<int>(channel), chip_.events.now())
                         : 0.0;
  }
  const bool f4 = config_.family == AdcFamily::f4;
  if (index != 0) return 0.0;
  if (channel == kBattery) return f4 && (ccr_ & VBATE) != 0 ? config_.vbat_V / 2 : 0.0;
  if (f4 ? (ccr_ & TSVREFE) == 0 : !converters_[0]->sensors_on()) return 0.0;
  if (channel == kReference) return f4 ? 1.21 : 1.20;
  const double above_25 = config_.temperature_degC - 25.0;
  return f4 ? 0.76 + 0.0025 * above_25 : 1.43 - 0.0043 * above_25;
}

// MULT of F405: dual modes below 16, triple modes above; DUALMOD of F103 has other numbers.
unsigned AdcBank::multi() const {
  if (config_.family == AdcFamily::f4) return field(ccr_, 0, 5);
  return field(converters_[0]->control(), 16, 4);
}

int AdcBank::partners() const {
  if (multi() == 0) return 1;
  return config_.family == AdcFamily::f4 && multi() >= 16 ? 3 : 2;
}

bool AdcBank::regular_together() const {
  const unsigned mode = config_.family == AdcFamily::f4 ? multi() & 15 : multi();
  return mode == 1 || mode == 2 || mode == 6;
}

bool AdcBank::interleaved() const {
  if (config_.family == AdcFamily::f4) return (multi() & 15) == 7;
  return multi() == 3 || multi() == 4 || multi() == 7 || multi() == 8;
}

bool AdcBank::injected_together() const {
  if (config_.family == AdcFamily::f4) return (multi() & 15) == 1 || (multi() & 15) == 5;
  return multi() == 1 || (multi() >= 3 && multi() <= 5);
}

bool AdcBank::alternating() const {
  const unsigned mode = config_.family == AdcFamily::f4 ? multi() & 15 : multi();
  return mode == 2 || mode == 9;
}

std::int64_t AdcBank::interleave_half_clocks() const {
  if (config_.family == AdcFamily::f4) return 2 * (5 + field(ccr_, 8, 4));
  return multi() == 3 || multi() == 7 ? 14 : 28;
}

// Partners start before the master: of events at equal times they come first, so the master's
// request finds their data.
void AdcBank::trigger_regular(int index) {
  const std::int64_t now = next_half_clock();
  const bool together = index == 0 && partners() > 1;
  if (together && regular_together()) {
    for (int i = partners() - 1; i >= 0; --i) converters_[i]->start_regular(now);
  } else if (together && interleaved()) {
    const std::int64_t delay = interleave_half_clocks();
    const bool f1 = config_.family == AdcFamily::f1;
    const std::int64_t again = f1 && delay == 28 ? 2 * delay : 0;  // slow mode repeats itself
    for (int i = 0; i < partners(); ++i) {
      const int turn = f1 ? 1 - i : i;  // F103: ADC2 first
      converters_[i]->start_regular(now + turn * delay, again);
    }
  } else {
    converters_[index]->start_regular(now);
  }
}

void AdcBank::trigger_injected(int index) {
  const std::int64_t now = next_half_clock();
  const bool together = index == 0 && partners() > 1;
  if (together && injected_together()) {
    for (int i = partners() - 1; i >= 0; --i) converters_[i]->start_injected(now);
  } else if (together && alternating()) {
    converters_[alternate_]->start_injected(now);
    alternate_ = (alternate_ + 1) % partners();
  } else {
    converters_[index]->start_injected(now);
  }
}

unsigned AdcBank::packing() const {
  return config_.family == AdcFamily::f4 && partners() > 1 ? field(ccr_, 14, 2) : 0;
}

bool AdcBank::packs_data() const {
  return packing() != 0;
}

std::uint32_t AdcBank::upper_data(int index) const {
  if (config_.family != AdcFamily::f1 || index != 0 || partners() < 2) return 0;
  return converters_[1]->data() << 16;
}

void AdcBank::regular_data(int index, std::uint32_t value) {
  latest_[index] = value;
  fresh_ |= 1u << index;
  const int together = partners();
  if (index >= together || fresh_ != (1u << together) - 1) return;
  fresh_ = 0;
  if (!packed_.empty()) {
    for (auto& converter : converters_) converter->flag_overrun();
    converters_[0]->request().set(false);
    return;
  }
  for (int i = 0; i < together; ++i) stream_.push_back(latest_[i]);
  pack();
  request_packed();
}

// RM0090 "Multi ADC mode", DMA modes 1 (one half-word), 2 (two half-words), 3 (two bytes).
void AdcBank::pack() {
  const unsigned mode = packing();
  const std::size_t items = mode == 1 ? 1 : 2;
  std::size_t used = 0;
  for (; used + items <= stream_.size(); used += items) {
    const std::uint32_t first = stream_[used];
    if (mode == 1) {
      packed_.push_back(first);
    } else if (mode == 2) {
      packed_.push_back(stream_[used + 1] << 16 | first);
    } else {
      packed_.push_back((stream_[used + 1] & 0xFF) << 8 | (first & 0xFF));
    }
  }
  stream_.erase(stream_.begin(), stream_.begin() + static_cast<std::ptrdiff_t>(used));
}

void AdcBank::request_packed() {
  update_interrupt();
  if (last_transfer_done_) packed_.clear();
  if (!packed_.empty()) converters_[0]->request().set(true);
}

void AdcBank::transfers_done() {
  if ((ccr_ & CCR_DDS) == 0) last_transfer_done_ = true;
}

std::uint32_t AdcBank::read_cdr() {
  std::uint32_t value = 0;
  if (packs_data() && !packed_.empty()) {
    value = packed_.front();
    packed_.pop_front();
  } else if (converters_.size() > 1) {
    value = converters_[1]->data() << 16 | converters_[0]->data();
  }
  for (auto& converter : converters_) converter->data_read();  // lowers the request
  if (!packed_.empty()) converters_[0]->request().set(true);
  return value;
}

std::uint32_t AdcBank::read_common(std::uint32_t offset) {
  if (offset == CSR) {
    std::uint32_t all = 0;
    for (std::size_t i = 0; i < converters_.size(); ++i) all |= converters_[i]->status() << (8 * i);
    return all;
  }
  if (offset == CCR) return ccr_;
  return offset == CDR ? read_cdr() : 0;
}

void AdcBank::write_common(std::uint32_t offset, std::uint32_t value) {
  if (offset != CCR) return;
  const std::uint32_t before = ccr_;
  ccr_ = value & 0x00C3EF1F;
  if (field(ccr_, 14, 2) == 0 || field(ccr_, 0, 5) != field(before, 0, 5)) {
    last_transfer_done_ = false;
    packed_.clear();
    stream_.clear();
    fresh_ = 0;
  }
  update_clock();
}

std::uint32_t AdcF4Block::read(std::uint32_t offset, unsigned size) {
  const std::uint32_t inside = offset & 0xFF;
  const int index = static_cast<int>(offset >> 8);
  if (index == 3) return part_of_word(bank_.read_common(inside & ~3u), offset, size);
  return index < bank_.converters() ? bank_.converter(index + 1).read(inside, size) : 0;
}

void AdcF4Block::write(std::uint32_t offset, std::uint32_t value, unsigned size) {
  const std::uint32_t inside = offset & 0xFF;
  const int index = static_cast<int>(offset >> 8);
  if (index == 3) {
    bank_.write_common(inside & ~3u, on_all_lanes(value, size));
  } else if (index < bank_.converters()) {
    bank_.converter(index + 1).write(inside, value, size);
  }
}

}  // namespace whirl::stm32
