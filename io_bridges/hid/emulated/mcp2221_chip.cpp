#include "io_bridges/hid/emulated/mcp2221_chip.hpp"

#include <algorithm>

namespace whirl::io {
namespace {

constexpr std::uint8_t kDefault_divider = 117;  // 100 kHz
constexpr std::size_t kPayload = 60;

HidReport descriptor() {
  return {
      0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01,  // vendor page, application
      0x09, 0x01, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x75, 0x08, 0x95, 0x40, 0x81, 0x02,  // 64 bytes in
      0x09, 0x02, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x75, 0x08, 0x95, 0x40, 0x91, 0x02,  // 64 bytes out
      0xC0};
}

}  // namespace

Mcp2221Chip::Mcp2221Chip(EventQueue& queue, I2cBus& bus, const std::string& serial)
    : identity_{0x04D8, 0x00DD, "MCP2221 USB-I2C/UART Combo", serial, descriptor(), false},
      engine_(queue, bus, kPayload) {
  reset();
}

Mcp2221Chip::Mcp2221Chip(EventQueue& queue, I2cCarrier& elsewhere, const std::string& serial)
    : identity_{0x04D8, 0x00DD, "MCP2221 USB-I2C/UART Combo", serial, descriptor(), false},
      engine_(queue, elsewhere, kPayload) {
  reset();
}

void Mcp2221Chip::reset() {
  engine_.cancel();
  divider_ = kDefault_divider;
  engine_.set_rate(12e6 / (divider_ + 3));
  used_ = hung_ = reads_ = false;
  not_fed_ = 0;
  level_ = {};
  direction_ = {1, 1, 1, 1};
}

std::uint8_t Mcp2221Chip::state() {
  using S = WireEngine::State;
  if (hung_) return 0x62;
  switch (engine_.state()) {
    case S::idle:
      return reads_ ? 0x55 : 0x00;
    case S::starting:
      return 0x10;
    case S::addressing:
      return 0x20;
    case S::writing:
      return 0x40;
    case S::held:
      return 0x45;
    case S::reading:
      return engine_.received() >= kPayload ? 0x54 : 0x50;
    case S::stopping:
      return 0x60;
    case S::address_nack:
      return 0x25;
    case S::data_nack:
      return 0x00;
    case S::stuck:
    case S::lost:
      return engine_.total() == 0 || engine_.passed() == 0 ? 0x12 : reads_ ? 0x23 : 0x44;
  }
  return 0x00;
}

void Mcp2221Chip::output(std::span<const std::uint8_t> report) {
  Report request{}, answer{};
  const auto content = report.subspan(1, std::min(report.size() - 1, request.size()));
  std::copy(content.begin(), content.end(), request.begin());
  answer[0] = request[0];
  switch (request[0]) {
    case 0x10:
      status(request, answer);
      break;
    case 0x40:
      get_data(answer);
      break;
    case 0x50:
    case 0x51:
      gpio(request, answer);
      break;
    case 0x60:
    case 0x61:
    case 0xB0:
    case 0xB1:
      break;  // settings: taken, and read as zeros
    case 0x70:
      if (request[1] == 0xAB && request[2] == 0xCD && request[3] == 0xEF) reset();
      return;  // it is off the bus before it could answer
    case 0x90:
    case 0x92:
    case 0x94:
      write(request, answer);
      break;
    case 0x91:
    case 0x93:
      read(request, answer);
      break;
    default:
      answer[1] = 0x01;
  }
  send(HidReport(answer.begin(), answer.end()));
}

void Mcp2221Chip::status(const Report& request, Report& answer) {
  if (request[2] == 0x10) {
    answer[2] = state() == 0x00 ? 0x11 : 0x10;
    hung_ = hung_ || !used_;
    engine_.cancel();
    reads_ = false;
    not_fed_ = 0;
  }
  if (request[3] == 0x20) {
    const bool idle = state() == 0x00;
    answer[3] = idle ? 0x20 : 0x21;
    answer[4] = request[4];
    if (idle) {
      divider_ = request[4];
      engine_.set_rate(12e6 / (divider_ + 3));
    }
  }
  answer[8] = state();
  answer[9] = static_cast<std::uint8_t>(engine_.total());
  answer[10] = static_cast<std::uint8_t>(engine_.total() >> 8);
  answer[11] = static_cast<std::uint8_t>(engine_.passed());
  answer[12] = static_cast<std::uint8_t>(engine_.passed() >> 8);
  answer[14] = divider_;
  answer[20] = engine_.state() == WireEngine::State::address_nack ? 0x40 : 0x00;
  answer[21] = used_ ? 1 : 0;
  answer[22] = engine_.scl() ? 1 : 0;
  answer[23] = engine_.sda() ? 1 : 0;
  answer[46] = 'A';
  answer[47] = '6';
  answer[48] = '1';
  answer[49] = '2';
}

void Mcp2221Chip::write(const Report& request, Report& answer) {
  const std::size_t total = request[1] | std::size_t{request[2]} << 8;
  const std::uint8_t now = state();
  const bool fresh = not_fed_ == 0;
  const bool takes = fresh
                         ? now == 0x00 || (now == 0x45 && request[0] != 0x90)
                         : engine_.state() == WireEngine::State::writing && engine_.waiting() == 0;
  if (!takes) {
    if (!fresh && engine_.state() == WireEngine::State::data_nack) not_fed_ = 0;
    answer[1] = 0x01;
    answer[2] = now;
    return;
  }
  if (fresh) {
    used_ = true;
    reads_ = false;
    not_fed_ = total;
    engine_.write(request[3] >> 1, total, request[0] != 0x94);
  }
  const std::size_t count = std::min(kPayload, not_fed_);
  engine_.feed(std::span(request).subspan(4, count));
  not_fed_ -= count;
}

void Mcp2221Chip::read(const Report& request, Report& answer) {
  const std::uint8_t now = state();
  if (now != 0x00 && !(now == 0x45 && request[0] == 0x93)) {
    answer[1] = 0x01;
    answer[2] = now;
    return;
  }
  used_ = true;
  reads_ = true;
  engine_.read(request[3] >> 1, request[1] | std::size_t{request[2]} << 8);
}

void Mcp2221Chip::get_data(Report& answer) {
  const std::uint8_t now = state();
  answer[2] = now;
  answer[3] = 127;
  const bool whole = engine_.received() >= kPayload || now == 0x55;
  if (!reads_ || !whole) {
    answer[1] = 0x41;
    return;
  }
  const auto bytes = engine_.take(kPayload);
  answer[3] = static_cast<std::uint8_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), answer.begin() + 4);
  if (now == 0x55 && engine_.received() == 0) reads_ = false;
}

void Mcp2221Chip::gpio(const Report& request, Report& answer) {
  for (std::size_t pin = 0; pin < level_.size(); ++pin) {
    if (request[0] == 0x51) {
      answer[2 + 2 * pin] = level_[pin];
      answer[3 + 2 * pin] = direction_[pin];
      continue;
    }
    if (request[2 + 4 * pin] != 0) level_[pin] = request[3 + 4 * pin];
    if (request[4 + 4 * pin] != 0) direction_[pin] = request[5 + 4 * pin];
    std::copy_n(request.begin() + 2 + 4 * static_cast<int>(pin), 4,
                answer.begin() + 2 + 4 * static_cast<int>(pin));
  }
}

}  // namespace whirl::io
