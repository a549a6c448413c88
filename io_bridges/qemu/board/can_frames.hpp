// What passes a wire between two ends of a joined CAN bus, and what it stands for.
#pragma once
#include <algorithm>

#include "io_bridges/devices/can_bus.hpp"
#include "io_bridges/link/wire.hpp"

namespace whirl::board {

inline void pack(const io::CanFrame& frame, io::WireCan& can) {
  can.id = frame.id;
  can.extended = frame.extended;
  can.remote = frame.remote;
  can.length = frame.length;
  std::copy(frame.data.begin(), frame.data.end(), can.data);
}

inline io::CanFrame frame_of(const io::WireCan& can) {
  io::CanFrame frame{
      .id = can.id, .extended = can.extended, .remote = can.remote, .length = can.length};
  std::copy(std::begin(can.data), std::end(can.data), frame.data.begin());
  return frame;
}

inline io::WireCan packed(const io::CanNews& news, std::uint8_t place) {
  io::WireCan can;
  pack(news.frame, can);
  can.station = place;
  can.act = static_cast<std::uint8_t>(news.call);
  can.error = static_cast<std::uint8_t>(news.error);
  can.sending = news.sending;
  can.bus_off = news.bus_off;
  can.tec = static_cast<std::int16_t>(news.tec);
  can.rec = static_cast<std::int16_t>(news.rec);
  return can;
}

inline io::CanNews news_of(const io::WireCan& can) {
  return {.call = static_cast<io::CanNews::Call>(can.act),
          .error = static_cast<io::CanError>(can.error),
          .sending = can.sending,
          .bus_off = can.bus_off,
          .tec = can.tec,
          .rec = can.rec,
          .frame = frame_of(can)};
}

}  // namespace whirl::board
