// CP2112: SMBus master behind numbered HID reports; its engine works by itself and is asked how it goes.
//
//   Speed    10 to 400 kHz (its limits are not in the sources at hand; the field is in Hz)
//   Length   61 bytes out, 512 in; written and then read: 16 out, and its revision 1 cannot at all
//   Outcomes address NACK, write incomplete (data NACK), bus not free (bus stuck), arbitration lost, time-out
//   Set up   one retry (0 would mean for ever), write and read time-out of the settings, SCL-low time-out on
//   Source   Linux hid-cp2112.c (reports, fields, status codes); AN495 for identifiers
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "io_bridges/hid/i2c_bridge.hpp"

namespace whirl::io {

class Cp2112 : public I2cBridge {
 public:
  static constexpr std::uint16_t kVendor = 0x10C4, kProduct = 0xEA90;
  static constexpr int kSlowest_Hz = 10'000, kFastest_Hz = 400'000;

  static Result<std::unique_ptr<I2cBridge>> start(std::unique_ptr<HidPort> port,
                                                  const I2cBridgeSettings& settings);

  Result<Done> set_speed(int speed_Hz) override;
  I2cOutcome recover() override;
  std::string label() const override { return "CP2112"; }

 private:
  Cp2112(std::unique_ptr<HidPort> port, const I2cBridgeSettings& settings)
      : I2cBridge(settings), port_(std::move(port)) {}

  void run(std::uint8_t address, std::span<const std::uint8_t> write, std::size_t read,
           I2cTransfer& transfer) override;
  std::int64_t now_ns() const override { return port_->now_ns(); }

  bool request(std::uint8_t address, std::span<const std::uint8_t> write, std::size_t read,
               I2cTransfer& transfer);
  bool out(std::span<const std::uint8_t> report, I2cTransfer& transfer);
  bool in(std::uint8_t number, HidReport& report, I2cTransfer& transfer);
  bool status(HidReport& report, I2cTransfer& transfer);
  bool finished(I2cTransfer& transfer);
  bool fetch(std::size_t count, I2cTransfer& transfer);

  std::unique_ptr<HidPort> port_;
  int revision_ = 0;
};

}  // namespace whirl::io
