#include "io_bridges/devices/eeprom_24xx.hpp"

#include <bit>

#include "base/check.hpp"

namespace whirl::io {

Eeprom24xx::Eeprom24xx(EventQueue& queue, const Params& params, MemoryFile contents,
                       const Wire* write_protect, FaultBook* faults, FindingSink findings)
    : params_(params),
      contents_(std::move(contents)),
      write_protect_(write_protect),
      faults_(faults),
      findings_(std::move(findings)),
      tears_(params.seed, params.name + ".tears"),
      cycle_done_(queue, [this] { cycle_done(); }),
      supply_(
          queue, faults, params.bus, params.i2c_address,
          [this](Nanoseconds now) { power_off(now); }, [this](Nanoseconds) { powered_ = true; }) {
  const auto size = static_cast<std::uint64_t>(contents_.size_bytes());
  const auto page = static_cast<unsigned>(params_.page_bytes);
  WHIRL_CHECK(std::has_single_bit(size) && size <= 65536, size);
  WHIRL_CHECK(std::has_single_bit(page) && page <= size, page, size);
}

std::uint8_t Eeprom24xx::byte_at(std::int64_t at) const {
  std::array<std::uint8_t, 1> byte{};
  contents_.read(at, byte);
  return byte[0];
}

void Eeprom24xx::forget_write() {
  address_bytes_ = data_bytes_ = 0;
  if (!busy_) page_.clear();
}

bool Eeprom24xx::start(std::uint8_t /*address_7bit*/, bool /*read*/, Nanoseconds /*now*/) {
  forget_write();
  return powered_ && !busy_;
}

bool Eeprom24xx::write(std::uint8_t byte, Nanoseconds now) {
  if (!powered_) return false;
  if (address_bytes_ < 2) {
    pointer_ = (++address_bytes_ == 1 ? byte << 8 : pointer_ | byte) % contents_.size_bytes();
    return true;
  }
  if (++data_bytes_ > params_.page_bytes) {
    findings_.report({now, params_.name, "a write longer than a page overwrites its own start"});
  }
  page_[pointer_] = byte;
  advance_in_page();
  return true;
}

void Eeprom24xx::advance_in_page() {
  const std::int64_t within = params_.page_bytes - 1;
  pointer_ = (pointer_ & ~within) | ((pointer_ + 1) & within);
}

std::uint8_t Eeprom24xx::read(Nanoseconds /*now*/) {
  if (!powered_) return 0xFF;
  const std::uint8_t byte = byte_at(pointer_);
  pointer_ = (pointer_ + 1) % contents_.size_bytes();
  return byte;
}

void Eeprom24xx::stop(Nanoseconds now) {
  address_bytes_ = data_bytes_ = 0;
  if (page_.empty() || busy_ || !powered_) return;
  if (write_protect_ != nullptr && write_protect_->level()) return page_.clear();
  begin_cycle(now);
}

void Eeprom24xx::begin_cycle(Nanoseconds now) {
  busy_ = true;
  Nanoseconds done_ns = now + params_.write_ns;
  if (const Fault* stuck = fault(FaultKind::memory_busy, now)) done_ns = stuck->end_ns;
  if (fault(FaultKind::memory_write_error, now) != nullptr) page_.clear();
  if (done_ns != kNever) cycle_done_.at(done_ns);
  supply_.write_begins(now, params_.write_ns);
}

void Eeprom24xx::cycle_done() {
  for (const auto& [at, byte] : page_) store(at, byte);
  page_.clear();
  busy_ = false;
  ++cycles_;
}

void Eeprom24xx::power_off(Nanoseconds /*now*/) {
  cycle_done_.cancel();
  if (busy_ && !page_.empty()) {
    const std::int64_t page = params_.page_bytes, first = page_.begin()->first & ~(page - 1);
    for (std::int64_t at = first; at < first + page; ++at) {
      const std::uint32_t draw = tears_.bits() % 4;
      const auto written = page_.find(at);
      if (draw < 2 && written != page_.end()) store(at, written->second);
      if (draw == 3) store(at, 0xFF);
    }
  }
  powered_ = busy_ = false;
  pointer_ = 0;
  page_.clear();
  forget_write();
}

}  // namespace whirl::io
