// An MCP2221A as its host sees it: its HID reports, with an I2C bus behind them.
//
//   Plays    status and set parameters, get data, write, read, both with repeated START, write without STOP, reset,
//            settings and GPIO as far as Linux's driver asks; every other command is refused
//   States   as EasyMCP2221 lists them; after a NACK of the address or a time-out it stays so until a cancel; a
//            cancel before its first transfer hangs it in 0x62 until a reset
//   Clock    12 MHz / (divider + 3), as Linux has it
//   Short    reports are filled with zeros
//   Left out what a NACK of a data byte shows is in no source: here it is idle with fewer bytes than asked for
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "io_bridges/hid/emulated/emulated_hid.hpp"
#include "io_bridges/hid/emulated/wire_engine.hpp"

namespace whirl::io {

class Mcp2221Chip : public EmulatedHid {
 public:
  Mcp2221Chip(EventQueue& queue, I2cBus& bus, const std::string& serial);
  Mcp2221Chip(EventQueue& queue, I2cCarrier& elsewhere, const std::string& serial);

  const HidIdentity& identity() const override { return identity_; }
  void output(std::span<const std::uint8_t> report) override;
  std::optional<HidReport> feature(std::uint8_t) override { return std::nullopt; }
  bool set_feature(std::span<const std::uint8_t>) override { return false; }

  WireEngine& engine() { return engine_; }

 private:
  using Report = std::array<std::uint8_t, 64>;

  std::uint8_t state();
  void status(const Report& request, Report& answer);
  void write(const Report& request, Report& answer);
  void read(const Report& request, Report& answer);
  void get_data(Report& answer);
  void gpio(const Report& request, Report& answer);
  void reset();

  HidIdentity identity_;
  WireEngine engine_;
  std::uint8_t divider_ = 0;
  bool used_ = false, hung_ = false, reads_ = false;
  std::size_t not_fed_ = 0;  // bytes of the running write that are still to come
  std::array<std::uint8_t, 4> level_{}, direction_{};
};

}  // namespace whirl::io
