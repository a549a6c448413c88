#include "io_bridges/hid/cp2112.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace whirl::io {
namespace {

constexpr std::uint8_t kVersion = 0x05, kSmbusConfig = 0x06, kRead = 0x10, kWriteRead = 0x11,
                       kForceSend = 0x12, kData = 0x13, kWrite = 0x14, kAskStatus = 0x15,
                       kStatus = 0x16, kCancel = 0x17;
constexpr std::uint8_t kIdle = 0, kBusy = 1, kComplete = 2;
constexpr std::size_t kMost_written = 61, kMost_read = 512, kMost_written_before_read = 16,
                      kMost_in_report = 61;
constexpr std::int64_t kAnswer_ns = 1'000'000'000;

std::uint8_t low(std::size_t value) {
  return static_cast<std::uint8_t>(value);
}
std::uint8_t high(std::size_t value) {
  return static_cast<std::uint8_t>(value >> 8);
}

// status1 of a transfer that ended in an error.
I2cOutcome outcome_of(std::uint8_t status1) {
  switch (status1) {
    case 0:
      return I2cOutcome::address_nack;
    case 1:
      return I2cOutcome::bus_stuck;
    case 2:
      return I2cOutcome::lost_arbitration;
    case 4:
      return I2cOutcome::data_nack;
    default:
      return I2cOutcome::timed_out;  // 3: read incomplete
  }
}

}  // namespace

Result<std::unique_ptr<I2cBridge>> Cp2112::start(std::unique_ptr<HidPort> port,
                                                 const I2cBridgeSettings& settings) {
  std::unique_ptr<Cp2112> bridge(new Cp2112(std::move(port), settings));
  const auto version = bridge->port_->get_feature(kVersion, 3);
  if (!version) return version.error();
  if (version.value().size() < 3)
    return Error{ErrorKind::host, "CP2112", "it does not tell its version", ""};
  bridge->revision_ = version.value()[2];
  const auto set = bridge->set_speed(settings.speed_Hz);
  if (!set) return set.error();
  const I2cOutcome outcome = bridge->recover();
  if (outcome != I2cOutcome::done)
    return Error{ErrorKind::bad_input, "CP2112", words_of(outcome), "plug it in again"};
  return std::unique_ptr<I2cBridge>(std::move(bridge));
}

Result<Done> Cp2112::set_speed(int speed_Hz) {
  if (speed_Hz < kSlowest_Hz || speed_Hz > kFastest_Hz) {
    return Error{ErrorKind::bad_input, "CP2112",
                 "no I2C clock of " + std::to_string(speed_Hz) + " Hz", "10 to 400 kHz"};
  }
  const auto clock = static_cast<std::size_t>(speed_Hz);
  const auto timeout_ms =
      static_cast<std::size_t>(std::clamp<std::int64_t>(settings_.timeout_ns / 1'000'000, 1, 1000));
  const HidReport config{kSmbusConfig,
                         low(clock >> 24),
                         low(clock >> 16),
                         low(clock >> 8),
                         low(clock),
                         0x02,  // its own address, as a target that it is not
                         0,     // what is read is sent when it is asked for
                         high(timeout_ms),
                         low(timeout_ms),
                         high(timeout_ms),
                         low(timeout_ms),
                         1,  // SCL held low ends the transfer
                         0,
                         1};
  if (const auto set = port_->set_feature(config); !set) return set.error();
  const auto back = port_->get_feature(kSmbusConfig, config.size());
  if (!back) return back.error();
  if (back.value() != config)
    return Error{ErrorKind::host, "CP2112", "it does not keep its settings", ""};
  settings_.speed_Hz = speed_Hz;
  return Done{};
}

I2cOutcome Cp2112::recover() {
  I2cTransfer transfer;
  HidReport report;
  constexpr int kTries = 3;
  for (int i = 0; i < kTries; ++i) {
    if (!status(report, transfer)) return transfer.outcome;
    if (report[1] != kBusy) return I2cOutcome::done;
    if (!out(HidReport{kCancel, 0x01}, transfer)) return transfer.outcome;
    port_->pause_ns(pause_after_cancel_ns());
  }
  return I2cOutcome::busy;
}

void Cp2112::run(std::uint8_t address, std::span<const std::uint8_t> write, std::size_t read,
                 I2cTransfer& transfer) {
  if (!request(address, write, read, transfer) || !finished(transfer)) return;
  if (read > 0) fetch(read, transfer);
}

bool Cp2112::request(std::uint8_t address, std::span<const std::uint8_t> write, std::size_t read,
                     I2cTransfer& transfer) {
  if (read > kMost_read) return fail(transfer, I2cOutcome::refused, "more than 512 bytes read");
  const auto wire_address = static_cast<std::uint8_t>(address << 1);
  HidReport report;
  if (read == 0) {
    if (write.size() > kMost_written)
      return fail(transfer, I2cOutcome::refused, "more than 61 bytes written");
    report = {kWrite, wire_address, low(write.size())};
  } else if (write.empty()) {
    report = {kRead, wire_address, high(read), low(read)};
  } else {
    if (write.size() > kMost_written_before_read) {
      return fail(transfer, I2cOutcome::refused, "more than 16 bytes written before a read");
    }
    if (revision_ <= 1)
      return fail(transfer, I2cOutcome::refused, "its revision 1 has no repeated START");
    report = {kWriteRead, wire_address, high(read), low(read), low(write.size())};
  }
  report.insert(report.end(), write.begin(), write.end());
  return out(report, transfer);
}

bool Cp2112::out(std::span<const std::uint8_t> report, I2cTransfer& transfer) {
  HidReport padded(report.begin(), report.end());
  padded.resize(64);
  const auto written = port_->write(padded);
  return written.ok() || fail(transfer, I2cOutcome::unplugged, written.error().message());
}

// The next report of this number; another one is from a transfer that was given up.
bool Cp2112::in(std::uint8_t number, HidReport& report, I2cTransfer& transfer) {
  const std::int64_t until_ns = port_->now_ns() + kAnswer_ns;
  for (std::int64_t now = port_->now_ns(); now < until_ns; now = port_->now_ns()) {
    auto answer = port_->read(until_ns - now);
    if (!answer) return fail(transfer, I2cOutcome::unplugged, answer.error().message());
    if (answer.value().size() < 7 || answer.value()[0] != number) continue;
    report = std::move(answer.value());
    return true;
  }
  return fail(transfer, I2cOutcome::timed_out, "it does not answer");
}

bool Cp2112::status(HidReport& report, I2cTransfer& transfer) {
  return out(HidReport{kAskStatus, 0x01}, transfer) && in(kStatus, report, transfer);
}

bool Cp2112::finished(I2cTransfer& transfer) {
  while (true) {
    HidReport report;
    if (!status(report, transfer)) return false;
    const std::uint8_t status0 = report[1], status1 = report[2];
    if (status0 == kComplete) return true;
    if (status0 != kBusy && status0 != kIdle) {
      return fail(transfer, outcome_of(status1), "status1 " + std::to_string(status1));
    }
    if (late()) return fail(transfer, I2cOutcome::timed_out, "status0 " + std::to_string(status0));
  }
}

bool Cp2112::fetch(std::size_t count, I2cTransfer& transfer) {
  while (transfer.bytes.size() < count) {
    // One report's worth at a time: whether the chip would answer more with several is in no source at hand.
    const std::size_t left = std::min(count - transfer.bytes.size(), kMost_in_report);
    HidReport report;
    if (!out(HidReport{kForceSend, high(left), low(left)}, transfer) ||
        !in(kData, report, transfer))
      return false;
    const std::size_t got = report[2];
    if (got > left || report.size() < 3 + got) {
      return fail(transfer, I2cOutcome::timed_out, "it gives more than asked for");
    }
    transfer.bytes.insert(transfer.bytes.end(), report.begin() + 3,
                          report.begin() + 3 + static_cast<int>(got));
    if (late()) return fail(transfer, I2cOutcome::timed_out, "what was read does not come");
  }
  return true;
}

}  // namespace whirl::io
