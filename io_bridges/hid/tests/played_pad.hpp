// A pad with two sticks as many are made: reports without numbers, of two sticks in four bytes (X, Y, Z, Rz: 0..255), a hat in
// degrees with a null state, twelve buttons and a byte of the maker's own; a report out, for its motors.
//
//   Source  written by hand from HID 1.11, 6.2.2 (items) and HID Usage Tables 1.12, 4 and 12 (usages); the layout is that
//           of pads which are told apart as "DirectInput"
#pragma once
#include <array>
#include <optional>

#include "io_bridges/hid/emulated/emulated_hid.hpp"

namespace whirl::io {

class PlayedPad : public EmulatedHid {
 public:
  static constexpr std::uint16_t kVendor = 0x1209, kProduct = 0x0002;  // for tests (pid.codes)
  static constexpr std::uint8_t kNoHat = 8;

  const HidIdentity& identity() const override { return identity_; }
  void output(std::span<const std::uint8_t>) override {}
  std::optional<HidReport> feature(std::uint8_t) override { return std::nullopt; }
  bool set_feature(std::span<const std::uint8_t>) override { return false; }

  // axes: X, Y, Z, Rz. buttons: bit 0 is button 1.
  void move(const std::array<std::uint8_t, 4>& axes, unsigned buttons = 0,
            std::uint8_t hat = kNoHat) {
    send({axes[0], axes[1], axes[2], axes[3], static_cast<std::uint8_t>(hat | buttons << 4),
          static_cast<std::uint8_t>(buttons >> 4), 0x00});
  }

 private:
  HidIdentity identity_{
      kVendor,
      kProduct,
      "Played pad",
      "P1",
      {0x05, 0x01, 0x09, 0x05, 0xA1, 0x01, 0xA1, 0x02,              // game pad; sticks and buttons
       0x15, 0x00, 0x26, 0xFF, 0x00, 0x35, 0x00, 0x46, 0xFF, 0x00,  // 0..255, of 0..255
       0x75, 0x08, 0x95, 0x04,                                      //   a byte each
       0x09, 0x30, 0x09, 0x31, 0x09, 0x32, 0x09, 0x35, 0x81, 0x02,  // X, Y, Z, Rz
       0x25, 0x07, 0x46, 0x3B, 0x01, 0x65, 0x14,                    // 0..7 of 0..315 degrees
       0x75, 0x04, 0x95, 0x01, 0x09, 0x39, 0x81, 0x42,  //   hat, 4 bits, with a null state
       0x65, 0x00, 0x25, 0x01, 0x45, 0x01, 0x05, 0x09,  // 0..1, no unit
       0x19, 0x01, 0x29, 0x0C, 0x75, 0x01, 0x95, 0x0C, 0x81, 0x02,    // buttons 1 to 12, a bit each
       0x06, 0x00, 0xFF, 0x26, 0xFF, 0x00, 0x46, 0xFF, 0x00,          // the maker's page
       0x75, 0x08, 0x95, 0x01, 0x09, 0x01, 0x81, 0x02, 0xC0,          //   a byte
       0xA1, 0x02, 0x09, 0x02, 0x95, 0x07, 0x91, 0x02, 0xC0, 0xC0}};  // 7 bytes out
};

}  // namespace whirl::io
