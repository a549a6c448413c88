// The card's memory: blocks that come in, the time that they take, and what is left of them when the
// supply goes in between.
#include <algorithm>
#include <cmath>

#include "io_bridges/devices/sd_card.hpp"
#include "io_bridges/protocols/crc.hpp"

namespace whirl::io {
namespace {

constexpr std::uint8_t kStartOne = 0xFE, kStartMany = 0xFC, kStopMany = 0xFD;
constexpr std::uint8_t kAccepted = 0xE5, kCrcRefused = 0xEB, kNotWritten = 0xED;
constexpr std::uint8_t kR2_error = 0x04, kR2_range = 0x80;

constexpr Nanoseconds kShortestStall_ns = 20'000'000;
constexpr Nanoseconds kErase_ns = 2'000'000;
constexpr double kErase_ns_per_byte = 0.5;  // 0.5 ms for each MiB

}  // namespace

void SdCard::begin_write(std::int64_t block, bool many) {
  receiving_ = many ? Receiving::token_many : Receiving::token_one;
  write_many_ = many;
  write_block_ = block;
  write_failed_ = false;
  well_written_ = 0;
}

void SdCard::write_token(std::uint8_t byte, Nanoseconds now) {
  if (busy(now)) return report(now, "a token while the card is busy: it is ignored");
  if (write_many_ && byte == kStopMany) {
    receiving_ = Receiving::commands;
    out_.push_back(0xFF);
    busy_until_ns_ = now + busy_time(true);
    return;
  }
  if (byte != (write_many_ ? kStartMany : kStartOne)) {
    return report(now, "a wrong token: 0xFE starts the block of CMD24, 0xFC those of CMD25");
  }
  receiving_ = Receiving::block;
  data_bytes_ = 0;
}

void SdCard::data_byte(std::uint8_t byte, Nanoseconds now) {
  data_[data_bytes_++] = byte;
  if (data_bytes_ < data_.size()) return;
  receiving_ = write_many_ ? Receiving::token_many : Receiving::commands;
  block_received(now);
}

void SdCard::block_received(Nanoseconds now) {
  const auto bytes = std::span<const std::uint8_t>(data_).first(sd::kBlock_bytes);
  const int crc = data_[sd::kBlock_bytes] << 8 | data_[sd::kBlock_bytes + 1];
  const bool spoiled = fault(FaultKind::memory_crc_error, now) != nullptr;
  if (spoiled || (crc_on_ && crc != crc16_xmodem(bytes))) {
    write_failed_ = true;
    return out_.push_back(kCrcRefused);
  }
  const bool beyond = write_block_ >= blocks();
  if (beyond) status_ = static_cast<std::uint8_t>(status_ | kR2_range);
  const bool broken = fault(FaultKind::memory_write_error, now) != nullptr;
  if (broken) status_ = static_cast<std::uint8_t>(status_ | kR2_error);
  if (beyond || broken || write_failed_) {  // after an error the rest of CMD25 is refused
    write_failed_ = true;
    return out_.push_back(kNotWritten);
  }
  out_.push_back(kAccepted);
  program(now);
}

// Most writes are quick; now and then the card tidies up.
Nanoseconds SdCard::busy_time(bool many) {
  const double u = times_.uniform(), v = times_.uniform();
  if (params_.stall_every > 0.0 && v * params_.stall_every < 1.0) {
    const Nanoseconds shortest = std::min(kShortestStall_ns, params_.longest_stall_ns);
    return shortest + std::llround(u * static_cast<double>(params_.longest_stall_ns - shortest));
  }
  const double usual_ns = static_cast<double>(params_.write_ns) * (0.5 + u);
  return std::llround(many ? usual_ns / 10.0 : usual_ns);
}

void SdCard::program(Nanoseconds now) {
  Block bytes{};
  std::copy_n(data_.begin(), bytes.size(), bytes.begin());
  programming_ = Programming{write_block_++, bytes};
  const Nanoseconds time_ns = busy_time(write_many_);
  busy_until_ns_ = now + time_ns;
  if (const Fault* stuck = fault(FaultKind::memory_busy, now)) busy_until_ns_ = stuck->end_ns;
  if (busy_until_ns_ != kNever) programmed_.at(busy_until_ns_);
  supply_.write_begins(now, time_ns);
}

void SdCard::programmed() {
  if (!programming_) return;
  contents_.write(programming_->block * sd::kBlock_bytes, programming_->bytes);
  unreadable_.erase(programming_->block);
  programming_.reset();
  ++well_written_;
  ++written_;
}

void SdCard::erase(Nanoseconds now) {
  const std::int64_t count = *erase_last_ - *erase_first_ + 1;
  const std::int64_t bytes = count * sd::kBlock_bytes;
  contents_.clear(*erase_first_ * sd::kBlock_bytes, bytes);
  unreadable_.erase(unreadable_.lower_bound(*erase_first_), unreadable_.upper_bound(*erase_last_));
  busy_until_ns_ = now + kErase_ns + std::llround(kErase_ns_per_byte * static_cast<double>(bytes));
}

// ---- Power

void SdCard::tear() {
  programmed_.cancel();
  if (!programming_) return;
  const Programming cut = *programming_;
  switch (tears_.bits() % 3) {
    case 0:
      break;  // old
    case 1:
      return programmed();
    default: {
      const auto half = std::span<const std::uint8_t>(cut.bytes).first(cut.bytes.size() / 2);
      contents_.write(cut.block * sd::kBlock_bytes, half);
      unreadable_.insert(cut.block);
    }
  }
  programming_.reset();
}

void SdCard::power_off(Nanoseconds now) {
  if (mode_ == Mode::off) return;
  tear();
  mode_ = Mode::off;
  busy_until_ns_ = now;
  out_.clear();
  reading_.reset();
  receiving_ = Receiving::commands;
  command_bytes_ = 0;
  erase_first_.reset();
  erase_last_.reset();
}

void SdCard::power_on(Nanoseconds now) {
  if (mode_ != Mode::off) return;
  mode_ = Mode::sd;
  powered_ns_ = now;
  clocks_ = 0;
}

}  // namespace whirl::io
