// A stick whose fields lie across bytes: report 3 holds X and Y of 10 bits (0..1023), a hat with a null state, 12
// buttons, a throttle of 8 signed bits (-100..100) and 2 bits of padding in front; report 4 is a battery.
#pragma once
#include <optional>
#include <string>

#include "io_bridges/hid/emulated/emulated_hid.hpp"

namespace whirl::io {

class PlayedStick : public EmulatedHid {
 public:
  const HidIdentity& identity() const override { return identity_; }
  void output(std::span<const std::uint8_t>) override {}
  std::optional<HidReport> feature(std::uint8_t) override { return std::nullopt; }
  bool set_feature(std::span<const std::uint8_t>) override { return false; }

  void move(std::uint64_t x, std::uint64_t y, int throttle, std::uint64_t buttons = 0) {
    const std::uint64_t bits = x << 2 | y << 12 | std::uint64_t{8} << 22 | buttons << 26 |
                               std::uint64_t{static_cast<std::uint8_t>(throttle)} << 38;
    HidReport report{3};
    for (int i = 0; i < 6; ++i) report.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
    send(std::move(report));
  }
  void tell_battery(std::uint8_t percent) { send({4, percent}); }

 private:
  HidIdentity identity_{
      0x1209,
      0x0001,
      "Played stick",
      "S1",
      {0x05, 0x01, 0x09, 0x04, 0xA1, 0x01, 0x85, 0x03,        // joystick, report 3
       0x75, 0x02, 0x95, 0x01, 0x81, 0x03,                    // 2 bits of padding
       0x09, 0x30, 0x09, 0x31, 0x15, 0x00, 0x26, 0xFF, 0x03,  // X, Y: 0..1023
       0x75, 0x0A, 0x95, 0x02, 0x81, 0x02,                    //   10 bits each
       0xA4, 0x09, 0x39, 0x25, 0x07, 0x75, 0x04, 0x95, 0x01, 0x81, 0x42, 0xB4,  // hat 0..7, null
       0x05, 0x09, 0x19, 0x01, 0x29, 0x0C, 0x25, 0x01,                          // buttons 1 to 12
       0x75, 0x01, 0x95, 0x0C, 0x81, 0x02,                                      //   a bit each
       0x05, 0x02, 0x09, 0xBB, 0x15, 0x9C, 0x25, 0x64,              // throttle: -100..100
       0x75, 0x08, 0x95, 0x01, 0x81, 0x02,                          //
       0x75, 0x02, 0x95, 0x01, 0x81, 0x03,                          // to 6 bytes
       0x85, 0x04, 0x05, 0x06, 0x09, 0x20, 0x15, 0x00, 0x25, 0x64,  // report 4: battery
       0x75, 0x08, 0x95, 0x01, 0x81, 0x02, 0xC0},
      true};
};

}  // namespace whirl::io
