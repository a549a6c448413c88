#include "io_bridges/devices/sd_card.hpp"

#include <algorithm>

#include "io_bridges/protocols/crc.hpp"

namespace whirl::io {
namespace {

// R1.
constexpr std::uint8_t kIllegal = 0x04, kCrcError = 0x08, kAddressError = 0x20, kParameter = 0x40;
// Tokens.
constexpr std::uint8_t kStart = 0xFE, kEccFailed = 0x04, kOutOfRange = 0x08;

constexpr std::uint32_t kSlowSck_Hz = 440'000;     // 400 kHz + 10 %
constexpr std::uint32_t kFastSck_Hz = 27'500'000;  // 25 MHz + 10 %
constexpr Nanoseconds kPowerUp_ns = 1'000'000;
constexpr int kPowerUp_clocks = 74;
constexpr std::uint32_t kHighCapacitySupport = 1u << 30;

}  // namespace

SdCard::SdCard(EventQueue& queue, const Params& params, MemoryFile contents, FaultBook* faults,
               FindingSink findings)
    : queue_(queue),
      params_(params),
      contents_(std::move(contents)),
      faults_(faults),
      findings_(std::move(findings)),
      times_(params.seed, params.name + ".times"),
      tears_(params.seed, params.name + ".tears"),
      programmed_(queue, [this] { programmed(); }),
      supply_(
          queue, faults, params.bus, params.device, [this](Nanoseconds now) { power_off(now); },
          [this](Nanoseconds now) { power_on(now); }),
      csd_(sd::csd(params.high_capacity, contents_.size_bytes())) {
  RandomStream identity(params.seed, params.name + ".identity");
  response_bytes_ = static_cast<int>(1 + identity.bits() % 8);
  cid_ = sd::cid({.serial = identity.bits()});
  powered_ns_ = queue_.now();
}

void SdCard::select(bool selected, Nanoseconds /*now*/) {
  selected_ = selected;
  command_bytes_ = 0;
  if (selected) return;
  out_.clear();
  reading_.reset();
  if (receiving_ == Receiving::block || receiving_ == Receiving::token_one) {
    receiving_ = Receiving::commands;  // what came of the block is lost
  }
}

void SdCard::passed_by(std::uint8_t mosi, Nanoseconds now) {
  if (mode_ != Mode::sd || now < powered_ns_ + kPowerUp_ns) return;
  clocks_ = mosi == 0xFF ? clocks_ + 8 : 0;
}

void SdCard::check_clock(std::uint32_t sck_Hz, int mode, Nanoseconds now) {
  if (mode != 0 && mode != 3) report(now, "SPI mode " + std::to_string(mode) + ": it needs 0 or 3");
  const bool fast = mode_ == Mode::ready;
  if (sck_Hz <= (fast ? kFastSck_Hz : kSlowSck_Hz)) return;
  report(now, "SCK of " + std::to_string(sck_Hz / 1000) + " kHz where " +
                  (fast ? "25 MHz" : "400 kHz, until it is ready,") + " is the limit");
}

std::uint8_t SdCard::transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode, Nanoseconds now) {
  if (!selected_ || mode_ == Mode::off) return 0xFF;
  check_clock(sck_Hz, mode, now);
  const std::uint8_t miso = next_byte(now);
  receive(mosi, now);
  return miso;
}

// ---- To the host

std::uint8_t SdCard::next_byte(Nanoseconds now) {
  if (out_.empty() && reading_ && now >= reading_->ready_ns) send_next_read(now);
  if (out_.empty()) return busy(now) ? 0x00 : 0xFF;
  const std::uint8_t byte = out_.front();
  out_.pop_front();
  return byte;
}

void SdCard::respond(std::uint8_t r1, std::initializer_list<std::uint8_t> more) {
  out_.insert(out_.end(), static_cast<std::size_t>(response_bytes_), 0xFF);
  out_.push_back(r1);
  out_.insert(out_.end(), more);
}

void SdCard::send_block(std::span<const std::uint8_t> bytes, Nanoseconds now) {
  const std::uint16_t crc = crc16_xmodem(bytes);
  out_.push_back(kStart);
  out_.insert(out_.end(), bytes.begin(), bytes.end());
  if (fault(FaultKind::memory_crc_error, now) != nullptr) {
    out_.back() = static_cast<std::uint8_t>(out_.back() ^ 1u << times_.bits() % 8);
  }
  out_.push_back(static_cast<std::uint8_t>(crc >> 8));
  out_.push_back(static_cast<std::uint8_t>(crc & 0xFF));
}

void SdCard::send_next_read(Nanoseconds now) {
  const std::int64_t block = reading_->block++;
  if (block >= blocks() || unreadable_.count(block) != 0) {
    const bool beyond = block >= blocks();
    status_ = static_cast<std::uint8_t>(status_ | (beyond ? 0x80 : 0x10));
    out_.push_back(beyond ? kOutOfRange : kEccFailed);
    return reading_.reset();
  }
  Block bytes{};
  contents_.read(block * sd::kBlock_bytes, bytes);
  send_block(bytes, now);
  if (!reading_->many) return reading_.reset();
  reading_->ready_ns = now + params_.read_ns / 10;
}

// ---- From the host

void SdCard::receive(std::uint8_t byte, Nanoseconds now) {
  if (receiving_ == Receiving::block) return data_byte(byte, now);
  if (command_bytes_ > 0 || (byte & 0xC0) == 0x40) return command_byte(byte, now);
  if (byte == 0xFF) return;
  if (receiving_ != Receiving::commands && out_.empty()) return write_token(byte, now);
  report(now, "MOSI is not held high while the card works or waits");
}

void SdCard::command_byte(std::uint8_t byte, Nanoseconds now) {
  command_[command_bytes_++] = byte;
  if (command_bytes_ < command_.size()) return;
  command_bytes_ = 0;
  Command command;
  command.index = command_[0] & 0x3F;
  for (std::size_t i = 1; i <= 4; ++i) command.argument = command.argument << 8 | command_[i];
  const std::uint8_t crc = crc7(std::span<const std::uint8_t>(command_).first(5));
  command.good_crc = command_[5] == static_cast<std::uint8_t>(crc << 1 | 1);
  command.application = application_next_;
  if (command.index == 0) return go_idle(command, now);
  if (mode_ == Mode::sd) return report(now, "a command before CMD0: the card is not on SPI yet");
  if (busy(now)) return report(now, "a command while the card is busy: it is ignored");
  application_next_ = false;
  if (receiving_ == Receiving::token_many && command.index != 12) {
    report(now, "a command where a block of CMD25 or its end is due");
  }
  receiving_ = Receiving::commands;
  stop_reading(now);
  run(command, now);
}

// The next byte of the data still passes: it is what the host reads after CMD12.
void SdCard::stop_reading(Nanoseconds /*now*/) {
  if (!reading_ && out_.empty()) return;
  const std::uint8_t stuff = out_.empty() ? 0xFF : out_.front();
  out_.assign(1, stuff);
  reading_.reset();
}

void SdCard::run(const Command& command, Nanoseconds now) {
  if (!command.good_crc && (crc_on_ || command.index == 8)) {
    return respond(static_cast<std::uint8_t>(kCrcError | idle_bit()));
  }
  const Fault* wrong = fault(FaultKind::sensor_wrong_identity, now);
  const bool multimedia_card = wrong != nullptr && wrong->value == 0.0;
  if (multimedia_card && (command.index == 8 || command.index == 55)) {
    return respond(static_cast<std::uint8_t>(kIllegal | idle_bit()));
  }
  if (run_in_idle(command, now)) return;
  // After CMD55 what is no application command is taken as the plain one (4.3.9).
  const bool done =
      mode_ == Mode::ready &&
      ((command.application && run_application(command, now)) || run_transfer(command, now));
  if (done) return;
  const std::string name = (command.application ? "ACMD" : "CMD") + std::to_string(command.index);
  report(now, name + (mode_ == Mode::idle ? " before it is ready: illegal" : " is not modelled"));
  respond(static_cast<std::uint8_t>(kIllegal | idle_bit()));
}

void SdCard::go_idle(const Command& command, Nanoseconds now) {
  if (mode_ == Mode::sd && clocks_ < kPowerUp_clocks) {
    return report(now, "CMD0 before 1 ms and 74 clocks with chip select high: it is not heard");
  }
  if (mode_ == Mode::sd && !command.good_crc) {
    return report(now, "CMD0 with a wrong CRC: it is not heard");
  }
  if (!command.good_crc && crc_on_) return respond(kCrcError | idle_bit());
  if (busy(now)) tear();
  busy_until_ns_ = now;
  stop_reading(now);
  receiving_ = Receiving::commands;
  mode_ = Mode::idle;
  crc_on_ = version_2_ = application_next_ = false;
  host_knows_high_capacity_.reset();
  init_done_ns_ = kNever;
  status_ = 0;
  respond(0x01);
}

// What a card answers before and after it is ready. False: another command.
bool SdCard::run_in_idle(const Command& command, Nanoseconds now) {
  if (command.application) {
    if (command.index != 41) return false;
    operating_condition((command.argument & kHighCapacitySupport) != 0, now);
    return true;
  }
  switch (command.index) {
    case 1:
      operating_condition(false, now);
      return true;
    case 8:
      if (mode_ != Mode::idle) return false;
      interface_condition(command);
      return true;
    case 55:
      application_next_ = true;
      respond(idle_bit());
      return true;
    case 58: {
      std::uint32_t ocr = sd::kOcr_voltages;
      if (mode_ == Mode::ready) ocr |= sd::kOcr_powered;
      if (mode_ == Mode::ready && params_.high_capacity) ocr |= sd::kOcr_high_capacity;
      respond(idle_bit(),
              {static_cast<std::uint8_t>(ocr >> 24), static_cast<std::uint8_t>(ocr >> 16),
               static_cast<std::uint8_t>(ocr >> 8), static_cast<std::uint8_t>(ocr)});
      return true;
    }
    case 59:
      crc_on_ = (command.argument & 1) != 0;
      respond(idle_bit());
      return true;
    default:
      return false;
  }
}

void SdCard::interface_condition(const Command& command) {
  const auto pattern = static_cast<std::uint8_t>(command.argument & 0xFF);
  const auto voltage = static_cast<std::uint8_t>(command.argument >> 8 & 0x0F);
  version_2_ = voltage == 1;  // 2.7 to 3.6 V
  respond(idle_bit(), {0, 0, static_cast<std::uint8_t>(version_2_ ? 1 : 0), pattern});
}

// The first one starts the card; a high capacity card stays idle for a host that does not know it.
void SdCard::operating_condition(bool host_knows_high_capacity, Nanoseconds now) {
  if (!host_knows_high_capacity_) {
    host_knows_high_capacity_ = host_knows_high_capacity;
    const bool known = host_knows_high_capacity && version_2_;
    if (known || !params_.high_capacity) init_done_ns_ = now + params_.init_ns;
    if (init_done_ns_ == kNever) {
      report(now, "a high capacity card stays idle without CMD8 and HCS in ACMD41");
    }
  }
  if (mode_ == Mode::idle && now >= init_done_ns_) mode_ = Mode::ready;
  respond(idle_bit());
}

bool SdCard::run_application(const Command& command, Nanoseconds now) {
  switch (command.index) {
    case 13:
      respond(0, {status_});
      status_ = 0;
      send_block(std::array<std::uint8_t, 64>{}, now);
      return true;
    case 22: {
      respond(0);
      const std::uint32_t n = well_written_;
      send_block(std::array{static_cast<std::uint8_t>(n >> 24), static_cast<std::uint8_t>(n >> 16),
                            static_cast<std::uint8_t>(n >> 8), static_cast<std::uint8_t>(n)},
                 now);
      return true;
    }
    case 23:
    case 42:
      respond(0);
      return true;
    case 51:
      respond(0);
      send_block(sd::kScr, now);
      return true;
    default:
      return false;
  }
}

// Its block, or nothing and the answer has been given.
std::optional<std::int64_t> SdCard::block_of(std::uint32_t address) {
  if (!params_.high_capacity && address % sd::kBlock_bytes != 0) {
    respond(kAddressError);
    return std::nullopt;
  }
  const std::int64_t block = params_.high_capacity ? address : address / sd::kBlock_bytes;
  if (block < blocks()) return block;
  status_ = static_cast<std::uint8_t>(status_ | 0x80);
  respond(kParameter);
  return std::nullopt;
}

bool SdCard::run_transfer(const Command& command, Nanoseconds now) {
  switch (command.index) {
    case 9:
    case 10: {
      respond(0);
      sd::Register bytes = command.index == 9 ? csd_ : cid_;
      const Fault* wrong = fault(FaultKind::sensor_wrong_identity, now);
      if (wrong != nullptr && command.index == 10) {
        bytes[0] = static_cast<std::uint8_t>(wrong->value);
        bytes[15] = static_cast<std::uint8_t>(crc7(std::span(bytes).first(15)) << 1 | 1);
      }
      send_block(bytes, now);
      return true;
    }
    case 12:
      respond(0);
      return true;
    case 13:
      respond(0, {status_});
      status_ = 0;
      return true;
    case 16:
      respond(params_.high_capacity || command.argument == sd::kBlock_bytes ? 0 : kParameter);
      return true;
    case 17:
    case 18:
      if (const auto block = block_of(command.argument)) {
        respond(0);
        reading_ = Reading{*block, command.index == 18, now + params_.read_ns};
      }
      return true;
    case 24:
    case 25:
      if (const auto block = block_of(command.argument)) {
        respond(0);
        begin_write(*block, command.index == 25);
      }
      return true;
    default:
      return run_erase(command, now);
  }
}

bool SdCard::run_erase(const Command& command, Nanoseconds now) {
  constexpr std::uint8_t kEraseSequence = 0x10;
  if (command.index == 32 || command.index == 33) {
    if (const auto block = block_of(command.argument)) {
      (command.index == 32 ? erase_first_ : erase_last_) = *block;
      respond(0);
    }
    return true;
  }
  if (command.index != 38) return false;
  const bool in_order = erase_first_ && erase_last_ && *erase_first_ <= *erase_last_;
  respond(in_order ? 0 : kEraseSequence);
  if (in_order) erase(now);
  erase_first_.reset();
  erase_last_.reset();
  return true;
}

}  // namespace whirl::io
