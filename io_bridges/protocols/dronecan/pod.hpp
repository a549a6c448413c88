// What a host and a pod tell each other over CAN: the frames of pod_link.hpp as messages of this house.
//
//   PodSample    sequence, the host's time of it in us, accelerometer x y z, temperature, gyro x y z, in the counts that
//                the part is to show: 19 bytes with the CRC, three frames; at 1 kHz and 1 Mbit/s 38 to 48 % of the bus
//   PodFrame     any other frame: kind, sequence, payload
//   PodSetpoint  an ESC was told something: one frame
//   Ids          20110 to 20112, of the range that the protocol leaves to vendors
#pragma once
#include "io_bridges/protocols/dronecan/data_type.hpp"
#include "io_bridges/protocols/dronecan/fields.hpp"

namespace whirl::io::dronecan {

struct PodSample {
  static constexpr DataType kType{
      Kind::message, 20110,
      signature_of("whirl.PodSample\nsaturated uint8 sequence\ntruncated uint16 time\n"
                   "saturated int16[7] counts"),
      17, "whirl.PodSample"};
  std::uint8_t sequence = 0;
  std::uint16_t time_us = 0;  // wraps
  std::array<std::int16_t, 7> counts{};

  template <typename F>
  void layout(F& f) {
    f.u(sequence, 8);
    f.u_cut(time_us, 16);
    for (std::int16_t& count : counts) f.i(count, 16);
  }
};

struct PodFrame {
  static constexpr std::size_t kMost = 56;
  static constexpr DataType kType{
      Kind::message, 20111,
      signature_of("whirl.PodFrame\nsaturated uint8 kind\nsaturated uint8 sequence\n"
                   "saturated uint8[<=56] payload"),
      2 + kMost, "whirl.PodFrame"};
  std::uint8_t kind = 0, sequence = 0;
  Bounded<std::uint8_t, kMost> payload{};

  template <typename F>
  void layout(F& f) {
    f.u(kind, 8);
    f.u(sequence, 8);
    f.tail(payload, 8, [&](std::uint8_t& byte) { f.u(byte, 8); });
  }
};

struct PodSetpoint {
  static constexpr DataType kType{
      Kind::message, 20112,
      signature_of("whirl.PodSetpoint\nsaturated uint8 sequence\nsaturated uint8 esc\n"
                   "saturated uint8 valid\nsaturated uint16 value"),
      5, "whirl.PodSetpoint"};
  std::uint8_t sequence = 0, esc = 0, valid = 0;
  std::uint16_t value = 0;

  template <typename F>
  void layout(F& f) {
    f.u(sequence, 8);
    f.u(esc, 8);
    f.u(valid, 8);
    f.u(value, 16);
  }
};

}  // namespace whirl::io::dronecan
