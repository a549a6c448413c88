#include "io_bridges/hid/emulated/cp2112_chip.hpp"

#include <algorithm>

namespace whirl::io {
namespace {

constexpr std::uint8_t kIn = 0x81, kOut = 0x91, kFeature = 0xB1;

struct Kind {
  std::uint8_t number, item, bytes;  // bytes without the number
};
constexpr Kind kReports[] = {
    {0x01, kFeature, 1},  {0x02, kFeature, 4},  {0x03, kFeature, 1},  {0x04, kFeature, 2},
    {0x05, kFeature, 2},  {0x06, kFeature, 13}, {0x10, kOut, 63},     {0x11, kOut, 63},
    {0x12, kOut, 63},     {0x13, kIn, 63},      {0x14, kOut, 63},     {0x15, kOut, 63},
    {0x16, kIn, 63},      {0x17, kOut, 63},     {0x20, kFeature, 1},  {0x21, kFeature, 9},
    {0x22, kFeature, 62}, {0x23, kFeature, 62}, {0x24, kFeature, 62},
};

HidReport descriptor() {
  HidReport out = {0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01};
  for (const Kind& kind : kReports) {
    const std::uint8_t items[] = {0x85, kind.number, 0x09, 0x01, 0x15,       0x00,      0x26, 0xFF,
                                  0x00, 0x75,        0x08, 0x95, kind.bytes, kind.item, 0x02};
    out.insert(out.end(), std::begin(items), std::end(items));
  }
  out.push_back(0xC0);
  return out;
}

double clock_Hz(const HidReport& config) {
  return double(std::uint32_t{config[1]} << 24 | config[2] << 16 | config[3] << 8 | config[4]);
}

}  // namespace

Cp2112Chip::Cp2112Chip(EventQueue& queue, I2cBus& bus, const std::string& serial,
                       std::uint8_t revision)
    : identity_{0x10C4, 0xEA90, "CP2112 HID USB-to-SMBus Bridge", serial, descriptor(), true},
      engine_(queue, bus, 512) {
  for (const Kind& kind : kReports) {
    if (kind.item != kFeature) continue;
    features_[kind.number] = HidReport(std::size_t{kind.bytes} + 1);
    features_[kind.number][0] = kind.number;
  }
  features_[0x05] = {0x05, 0x0C, revision};
  features_[0x06] = {0x06, 0x00, 0x01, 0x86, 0xA0, 0x02, 0, 0, 0, 0, 0, 0, 0, 0};  // 100 kHz
  features_[0x21] = {0x21, 0xC4, 0x10, 0x90, 0xEA, 0x32, 0, 0, 0, 0};
  engine_.on_end([this] { ended(); });
  engine_.set_rate(clock_Hz(features_[0x06]));
}

std::optional<HidReport> Cp2112Chip::feature(std::uint8_t number) {
  const auto found = features_.find(number);
  if (found == features_.end()) return std::nullopt;
  return found->second;
}

bool Cp2112Chip::set_feature(std::span<const std::uint8_t> report) {
  const auto found = report.empty() ? features_.end() : features_.find(report[0]);
  if (found == features_.end()) return false;
  const std::size_t count = std::min(report.size(), found->second.size());
  if (report[0] == 0x04 && count >= 3) {  // GPIO: value and mask, to the latch
    std::uint8_t& latch = features_[0x03][1];
    latch = static_cast<std::uint8_t>((latch & ~report[2]) | (report[1] & report[2]));
  } else if (report[0] != 0x03 && report[0] != 0x05) {
    std::copy_n(report.begin(), count, found->second.begin());
  }
  if (report[0] == 0x06 && clock_Hz(found->second) > 0.0) engine_.set_rate(clock_Hz(found->second));
  return true;
}

void Cp2112Chip::output(std::span<const std::uint8_t> report) {
  std::array<std::uint8_t, 64> r{};
  std::copy_n(report.begin(), std::min(report.size(), r.size()), r.begin());
  const std::size_t length = std::size_t{r[2]} | std::size_t{r[1]} << 8;
  const std::size_t read = std::size_t{r[3]} | std::size_t{r[2]} << 8;
  const auto address = static_cast<std::uint8_t>(r[1] >> 1);
  switch (r[0]) {
    case 0x10:
      request_ = {address, {}, std::min<std::size_t>(read, 512)};
      break;
    case 0x11:
      request_ = {address,
                  {r.begin() + 5, r.begin() + 5 + std::min<int>(r[4], 16)},
                  std::min<std::size_t>(read, 512)};
      break;
    case 0x14:
      request_ = {address, {r.begin() + 3, r.begin() + 3 + std::min<int>(r[2], 61)}, 0};
      break;
    case 0x12:
      return send_data(length);
    case 0x15:
      return send_status();
    case 0x17:
      engine_.cancel();
      status0_ = status1_ = 0;
      return;
    default:
      return;
  }
  if (status0_ == 1) return;  // the running one goes on
  tries_ = 0;
  begin();
}

void Cp2112Chip::begin() {
  status0_ = 1;
  status1_ = 0;
  received_.clear();
  if (request_.write.empty()) return engine_.read(request_.address, request_.read);
  engine_.write(request_.address, request_.write.size(), request_.read == 0);
  engine_.feed(request_.write);
}

void Cp2112Chip::ended() {
  using S = WireEngine::State;
  const std::size_t retries = std::size_t{features_[0x06][13]} | std::size_t{features_[0x06][12]}
                                                                     << 8;
  switch (engine_.state()) {
    case S::held:
      return engine_.read(request_.address, request_.read);
    case S::address_nack:
      if (retries == 0 || ++tries_ <= retries) return begin();
      return complete(3, 0);
    case S::data_nack:
      return complete(3, 4);
    case S::stuck:
      return complete(3, engine_.passed() == 0 ? 1 : 3);
    case S::lost:
      return complete(3, 2);
    case S::idle:
      return complete(2, 5);
    default:
      return;
  }
}

void Cp2112Chip::complete(std::uint8_t status0, std::uint8_t status1) {
  status0_ = status0;
  status1_ = status1;
  if (status0 == 2 && request_.read > 0) received_ = engine_.take(request_.read);
  if (features_[0x06][6] != 0 && status0 == 2) send_data(request_.read);
}

void Cp2112Chip::send_status() {
  HidReport report(64);
  const auto count = static_cast<std::uint16_t>(engine_.passed());
  report[0] = 0x16;
  report[1] = status0_;
  report[2] = status1_;
  report[3] = static_cast<std::uint8_t>(tries_ >> 8);
  report[4] = static_cast<std::uint8_t>(tries_);
  report[5] = static_cast<std::uint8_t>(count >> 8);
  report[6] = static_cast<std::uint8_t>(count);
  send(std::move(report));
}

void Cp2112Chip::send_data(std::size_t most) {
  constexpr std::size_t kMost = 61;
  HidReport report(64);
  const std::size_t count = status0_ == 2 ? std::min({most, kMost, received_.size()}) : 0;
  report[0] = 0x13;
  report[1] = status0_;
  report[2] = static_cast<std::uint8_t>(count);
  std::copy_n(received_.begin(), count, report.begin() + 3);
  received_.erase(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(count));
  send(std::move(report));
}

}  // namespace whirl::io
