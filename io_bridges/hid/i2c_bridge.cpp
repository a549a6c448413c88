#include "io_bridges/hid/i2c_bridge.hpp"

#include <cstdio>
#include <utility>

#include "io_bridges/hid/cp2112.hpp"
#include "io_bridges/hid/hid_device.hpp"
#include "io_bridges/hid/mcp2221.hpp"

namespace whirl::io {

const char* words_of(I2cOutcome outcome) {
  switch (outcome) {
    case I2cOutcome::done:
      return "done";
    case I2cOutcome::address_nack:
      return "nobody acknowledges this address";
    case I2cOutcome::data_nack:
      return "the target refused a byte";
    case I2cOutcome::bus_stuck:
      return "the bus is stuck: SDA or SCL stays low";
    case I2cOutcome::lost_arbitration:
      return "arbitration lost to another master";
    case I2cOutcome::busy:
      return "the bridge is busy";
    case I2cOutcome::timed_out:
      return "no end in time";
    case I2cOutcome::unplugged:
      return "the bridge is gone";
    case I2cOutcome::refused:
      return "the bridge cannot do that";
  }
  return "";
}

Error I2cTransfer::error(const std::string& place) const {
  WHIRL_CHECK(!ok());
  std::string what = words_of(outcome);
  if (!told.empty()) what += ": " + told;
  return {outcome == I2cOutcome::refused ? ErrorKind::bad_input : ErrorKind::host, place, what, ""};
}

bool I2cBridge::fail(I2cTransfer& transfer, I2cOutcome outcome, std::string told) {
  transfer.outcome = outcome;
  transfer.told = std::move(told);
  transfer.bytes.clear();
  return false;
}

I2cTransfer I2cBridge::transfer(std::uint8_t address, std::span<const std::uint8_t> write,
                                std::size_t read, bool urgent) {
  WHIRL_CHECK(address < 128 && (!write.empty() || read > 0), int{address}, write.size(), read);
  I2cTransfer transfer;
  transfer.begin_ns = now_ns();
  urgent_ = urgent;
  const auto bits = static_cast<std::int64_t>(9 * (write.size() + read + 2));
  deadline_ns_ = transfer.begin_ns + (urgent ? settings_.urgent_timeout_ns : settings_.timeout_ns) +
                 bits * 1'000'000'000 / settings_.speed_Hz;
  run(address, write, read, transfer);
  transfer.end_ns = now_ns();
  const I2cOutcome outcome = transfer.outcome;
  if (outcome != I2cOutcome::done && outcome != I2cOutcome::unplugged &&
      outcome != I2cOutcome::refused) {
    recover();
  }
  urgent_ = false;
  return transfer;
}

Result<std::vector<std::uint8_t>> I2cBridge::scan() {
  constexpr std::uint8_t kFirst = 0x08, kLast = 0x77;  // the others are reserved
  std::vector<std::uint8_t> found;
  for (std::uint8_t address = kFirst; address <= kLast; ++address) {
    const I2cTransfer probe = read(address, 1);
    if (probe.ok()) {
      found.push_back(address);
    } else if (probe.outcome != I2cOutcome::address_nack) {
      char place[32];
      std::snprintf(place, sizeof place, "scan, 0x%02x", unsigned{address});
      return probe.error(place);
    }
  }
  return found;
}

Result<std::unique_ptr<I2cBridge>> start_i2c_bridge(BridgeKind kind, std::unique_ptr<HidPort> port,
                                                    const I2cBridgeSettings& settings) {
  switch (kind) {
    case BridgeKind::mcp2221a:
      return Mcp2221::start(std::move(port), settings);
    case BridgeKind::cp2112:
      return Cp2112::start(std::move(port), settings);
  }
  WHIRL_CHECK(false);
}

Result<std::unique_ptr<I2cBridge>> open_i2c_bridge(BridgeKind kind, const std::string& serial,
                                                   const I2cBridgeSettings& settings) {
  const bool microchip = kind == BridgeKind::mcp2221a;
  auto port = open_hid(microchip ? HidQuery{"MCP2221A", Mcp2221::kVendor, Mcp2221::kProduct, serial}
                                 : HidQuery{"CP2112", Cp2112::kVendor, Cp2112::kProduct, serial});
  if (!port) return port.error();
  return start_i2c_bridge(kind, std::move(port.value()), settings);
}

}  // namespace whirl::io
