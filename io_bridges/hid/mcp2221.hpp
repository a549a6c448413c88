// MCP2221A: I2C master behind 64-byte HID reports, each of which is answered by one.
//
//   Speed    47 to 400 kHz. Its divider is 12 MHz / f - 2 by one source, - 3 by the other: by the first the
//            bus is never faster than asked for, whichever is right (3 % slower at 400 kHz at worst)
//   Length   65535 bytes each way, 60 a report
//   Outcomes address and data NACK, bus stuck, busy, time-out. Lost arbitration has no code of its own
//   Recovery cancel, up to three times with 10 ms between (1 ms when stopped), until the engine is idle. An engine that has never
//            been used hangs on a cancel: none is sent to an idle one
//   Source   Linux hid-mcp2221.c (commands, states), EasyMCP2221 (states, undocumented bytes). Not from the
//            data sheet, and not tried on a chip: bytes 8..23 of the status answer
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "io_bridges/hid/i2c_bridge.hpp"

namespace whirl::io {

class Mcp2221 : public I2cBridge {
 public:
  static constexpr std::uint16_t kVendor = 0x04D8, kProduct = 0x00DD;
  static constexpr int kSlowest_Hz = 47'000, kFastest_Hz = 400'000;

  static Result<std::unique_ptr<I2cBridge>> start(std::unique_ptr<HidPort> port,
                                                  const I2cBridgeSettings& settings);

  Result<Done> set_speed(int speed_Hz) override;
  I2cOutcome recover() override;
  std::string label() const override { return "MCP2221A"; }

 private:
  using Report = std::array<std::uint8_t, 64>;

  Mcp2221(std::unique_ptr<HidPort> port, const I2cBridgeSettings& settings)
      : I2cBridge(settings), port_(std::move(port)) {}

  void run(std::uint8_t address, std::span<const std::uint8_t> write, std::size_t read,
           I2cTransfer& transfer) override;
  std::int64_t now_ns() const override { return port_->now_ns(); }

  bool command(Report& report, I2cTransfer& transfer);  // the answer replaces it
  bool status(Report& report, I2cTransfer& transfer);
  bool accepted(Report report, I2cTransfer& transfer);
  bool send(std::uint8_t code, std::uint8_t address, std::span<const std::uint8_t> bytes,
            I2cTransfer& transfer);
  bool sent(bool stops, std::size_t count, I2cTransfer& transfer);
  bool receive(std::uint8_t code, std::uint8_t address, std::size_t count, I2cTransfer& transfer);
  bool engine_failed(std::uint8_t state, I2cTransfer& transfer);
  void drain();

  std::unique_ptr<HidPort> port_;
  bool owes_answer_ = false;  // one may still come for a command that was given up
};

}  // namespace whirl::io
