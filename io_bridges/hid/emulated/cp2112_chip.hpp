// A CP2112 as its host sees it: numbered HID reports, with an I2C bus behind them.
//
//   Plays    read, write and write-read requests, force send, status, cancel; version, SMBus settings (clock,
//            retries, automatic sending), GPIO latch and strings as far as Linux's driver asks
//   Retries  an address that nobody acknowledges is tried again so often as set; 0: until a cancel
//   Left out its own time-outs: a bus that is not free or SCL held low for 25 ms ends a transfer whatever is set
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io_bridges/hid/emulated/emulated_hid.hpp"
#include "io_bridges/hid/emulated/wire_engine.hpp"

namespace whirl::io {

class Cp2112Chip : public EmulatedHid {
 public:
  Cp2112Chip(EventQueue& queue, I2cBus& bus, const std::string& serial, std::uint8_t revision = 3);

  const HidIdentity& identity() const override { return identity_; }
  void output(std::span<const std::uint8_t> report) override;
  std::optional<HidReport> feature(std::uint8_t number) override;
  bool set_feature(std::span<const std::uint8_t> report) override;

  WireEngine& engine() { return engine_; }

 private:
  struct Request {
    std::uint8_t address = 0;
    std::vector<std::uint8_t> write;
    std::size_t read = 0;
  };

  void begin();
  void ended();
  void complete(std::uint8_t status0, std::uint8_t status1);
  void send_status();
  void send_data(std::size_t most);

  HidIdentity identity_;
  WireEngine engine_;
  std::map<std::uint8_t, HidReport> features_;
  Request request_;
  std::uint8_t status0_ = 0, status1_ = 0;
  std::size_t tries_ = 0;
  std::vector<std::uint8_t> received_;
};

}  // namespace whirl::io
