#include "io_bridges/hid/mcp2221.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace whirl::io {
namespace {

constexpr std::uint8_t kStatus = 0x10, kGetData = 0x40, kWrite = 0x90, kRead = 0x91,
                       kReadRepeated = 0x93, kWriteNoStop = 0x94;
constexpr std::uint8_t kCancel = 0x10, kSetSpeed = 0x20;
constexpr std::uint8_t kIdle = 0x00, kStartTimeout = 0x12, kAddressSent = 0x21,
                       kAddressTimeout = 0x23, kAddressNack = 0x25, kWriteTimeout = 0x44,
                       kWrittenNoStop = 0x45, kStopTimeout = 0x62;
constexpr std::size_t kPayload = 60;
constexpr std::size_t kLongest = 65535;
constexpr std::uint8_t kNothing = 127;  // as the count of bytes: none yet, or none at all
constexpr std::int64_t kAnswer_ns = 4'000'000'000;  // as Linux waits for an answer

std::string hex(const char* what, std::uint8_t value) {
  char text[48];
  std::snprintf(text, sizeof text, "%s 0x%02x", what, unsigned{value});
  return text;
}

std::size_t word(const std::array<std::uint8_t, 64>& report, std::size_t at) {
  return report[at] | std::size_t{report[at + 1]} << 8;
}

}  // namespace

Result<std::unique_ptr<I2cBridge>> Mcp2221::start(std::unique_ptr<HidPort> port,
                                                  const I2cBridgeSettings& settings) {
  std::unique_ptr<Mcp2221> bridge(new Mcp2221(std::move(port), settings));
  const I2cOutcome outcome = bridge->recover();
  if (outcome != I2cOutcome::done) {
    return Error{ErrorKind::bad_input, "MCP2221A", words_of(outcome), "check wiring and pull-ups"};
  }
  const auto set = bridge->set_speed(settings.speed_Hz);
  if (!set) return set.error();
  return std::unique_ptr<I2cBridge>(std::move(bridge));
}

Result<Done> Mcp2221::set_speed(int speed_Hz) {
  if (speed_Hz < kSlowest_Hz || speed_Hz > kFastest_Hz) {
    return Error{ErrorKind::bad_input, "MCP2221A",
                 "no I2C clock of " + std::to_string(speed_Hz) + " Hz", "47 to 400 kHz"};
  }
  Report report{kStatus, 0, 0, kSetSpeed,
                static_cast<std::uint8_t>(std::ceil(12e6 / speed_Hz) - 2.0)};
  I2cTransfer transfer;
  if (!command(report, transfer)) return transfer.error("MCP2221A");
  if (report[3] != kSetSpeed) {
    return Error{ErrorKind::host, "MCP2221A", "it refuses the clock while a transfer runs", ""};
  }
  settings_.speed_Hz = speed_Hz;
  return Done{};
}

I2cOutcome Mcp2221::recover() {
  constexpr int kTries = 3;
  Report report;
  I2cTransfer transfer;
  for (int i = 0; i <= kTries; ++i) {
    if (!status(report, transfer)) return transfer.outcome;
    if (report[8] == kIdle) break;
    if (i == kTries)
      return report[22] != 0 && report[23] != 0 ? I2cOutcome::busy : I2cOutcome::bus_stuck;
    Report cancel{kStatus, 0, kCancel};
    if (!command(cancel, transfer)) return transfer.outcome;
    if (i > 0) port_->pause_ns(pause_after_cancel_ns());
  }
  return report[22] != 0 && report[23] != 0 ? I2cOutcome::done : I2cOutcome::bus_stuck;
}

void Mcp2221::run(std::uint8_t address, std::span<const std::uint8_t> write, std::size_t read,
                  I2cTransfer& transfer) {
  if (write.size() > kLongest || read > kLongest) {
    fail(transfer, I2cOutcome::refused, "more than 65535 bytes");
    return;
  }
  const bool both = !write.empty() && read > 0;
  if (!write.empty() && !send(both ? kWriteNoStop : kWrite, address, write, transfer)) return;
  if (read > 0) receive(both ? kReadRepeated : kRead, address, read, transfer);
}

// An answer that was given up may come late, and would be taken for the next one's.
void Mcp2221::drain() {
  constexpr std::int64_t kQuiet_ns = 20'000'000;
  for (int i = 0; i < 64; ++i) {
    const auto old = port_->read(kQuiet_ns);
    if (!old || old.value().empty()) break;
  }
  owes_answer_ = false;
}

bool Mcp2221::command(Report& report, I2cTransfer& transfer) {
  if (owes_answer_) drain();
  std::array<std::uint8_t, 65> out{};  // the report's number, 0, comes first
  std::copy(report.begin(), report.end(), out.begin() + 1);
  if (const auto written = port_->write(out); !written) {
    return fail(transfer, I2cOutcome::unplugged, written.error().message());
  }
  const std::int64_t until_ns = port_->now_ns() + kAnswer_ns;
  for (std::int64_t now = port_->now_ns(); now < until_ns; now = port_->now_ns()) {
    const auto answer = port_->read(until_ns - now);
    if (!answer) return fail(transfer, I2cOutcome::unplugged, answer.error().message());
    if (answer.value().size() != report.size() || answer.value()[0] != report[0]) continue;
    std::copy(answer.value().begin(), answer.value().end(), report.begin());
    return true;
  }
  owes_answer_ = true;
  return fail(transfer, I2cOutcome::timed_out, "it does not answer");
}

bool Mcp2221::status(Report& report, I2cTransfer& transfer) {
  report = {kStatus};
  return command(report, transfer);
}

// What the engine's state says has gone wrong; true when nothing has.
bool Mcp2221::engine_failed(std::uint8_t state, I2cTransfer& transfer) {
  if (state == kAddressNack || state == kAddressSent) {
    fail(transfer, I2cOutcome::address_nack);
    return true;
  }
  if (state != kStartTimeout && state != kAddressTimeout && state != kWriteTimeout &&
      state != kStopTimeout) {
    return false;
  }
  Report report;
  if (!status(report, transfer)) return true;
  const bool low = report[22] == 0 || report[23] == 0;
  fail(transfer, low ? I2cOutcome::bus_stuck : I2cOutcome::timed_out, hex("engine state", state));
  return true;
}

// A report that the engine takes only when it has dealt with the one before.
bool Mcp2221::accepted(Report report, I2cTransfer& transfer) {
  while (true) {
    Report answer = report;
    if (!command(answer, transfer)) return false;
    if (answer[1] == 0) return true;
    if (!status(answer, transfer)) return false;
    if (engine_failed(answer[8], transfer)) return false;
    if (answer[8] == kIdle && (answer[20] & 0x40) != 0)
      return fail(transfer, I2cOutcome::data_nack);
    if (late()) return fail(transfer, I2cOutcome::busy, hex("engine state", answer[8]));
  }
}

bool Mcp2221::send(std::uint8_t code, std::uint8_t address, std::span<const std::uint8_t> bytes,
                   I2cTransfer& transfer) {
  for (std::size_t at = 0; at < bytes.size(); at += kPayload) {
    const auto piece = bytes.subspan(at, std::min(kPayload, bytes.size() - at));
    Report report{code, static_cast<std::uint8_t>(bytes.size()),
                  static_cast<std::uint8_t>(bytes.size() >> 8),
                  static_cast<std::uint8_t>(address << 1)};
    std::copy(piece.begin(), piece.end(), report.begin() + 4);
    if (!accepted(report, transfer)) return false;
    if (at + kPayload < bytes.size() && given_up()) return fail(transfer, I2cOutcome::timed_out);
  }
  return sent(code == kWrite, bytes.size(), transfer);
}

bool Mcp2221::sent(bool stops, std::size_t count, I2cTransfer& transfer) {
  while (true) {
    Report report;
    if (!status(report, transfer)) return false;
    const std::uint8_t state = report[8];
    if (engine_failed(state, transfer)) return false;
    if (state == kIdle && word(report, 11) < count) {
      return fail(transfer, I2cOutcome::data_nack,
                  "after " + std::to_string(word(report, 11)) + " bytes");
    }
    if (state == (stops ? kIdle : kWrittenNoStop)) return true;
    if (late()) {
      const bool low = report[22] == 0 || report[23] == 0;
      return fail(transfer, low ? I2cOutcome::bus_stuck : I2cOutcome::timed_out,
                  hex("engine state", state));
    }
  }
}

bool Mcp2221::receive(std::uint8_t code, std::uint8_t address, std::size_t count,
                      I2cTransfer& transfer) {
  if (!accepted({code, static_cast<std::uint8_t>(count), static_cast<std::uint8_t>(count >> 8),
                 static_cast<std::uint8_t>(address << 1 | 1)},
                transfer)) {
    return false;
  }
  while (transfer.bytes.size() < count) {
    Report report{kGetData};
    if (!command(report, transfer)) return false;
    const std::size_t got = report[3];
    if (report[1] == 0 && got <= kPayload) {
      if (got > count - transfer.bytes.size())
        return fail(transfer, I2cOutcome::timed_out, "it gives more than asked for");
      transfer.bytes.insert(transfer.bytes.end(), report.begin() + 4,
                            report.begin() + 4 + static_cast<int>(got));
      if (got > 0 && (transfer.bytes.size() == count || !given_up())) continue;
    } else if (got != kNothing) {
      return fail(transfer, I2cOutcome::timed_out, hex("a count of bytes of", report[3]));
    }
    if (engine_failed(report[2], transfer)) return false;
    if (late()) return fail(transfer, I2cOutcome::timed_out, hex("engine state", report[2]));
  }
  return true;
}

}  // namespace whirl::io
