#include "io_bridges/rack/devices/mavlink_keys.hpp"

#include <cmath>

namespace whirl::rack {

std::vector<DeviceKey> air_keys() {
  const io::MavlinkLink::Params usual;
  const auto loss = [](const char* path, const char* about) {
    return quantity_key(path, Dimension::ratio, "%", {0.0, 1.0}, about).with(0.0);
  };
  return {loss("params.uplink_loss", "share of the frames that the air loses on their way up"),
          loss("params.downlink_loss", "and down"),
          quantity_key("params.air_bytes_per_s", Dimension::none, "B/s", {1.0, 1e9},
                       "that the air carries both ways, a bare number")
              .with(usual.air_bytes_per_s),
          quantity_key("params.buffer", Dimension::time, "ms", {0.0, 60.0},
                       "longest that a frame waits for the air")
              .with(static_cast<double>(usual.buffer_ns) * 1e-9)};
}

io::MavlinkLink::Params radio_of(DeviceSlot& slot, double baud) {
  io::MavlinkLink::Params params;
  params.baud = baud;
  params.uplink_loss = slot.quantity("params.uplink_loss");
  params.downlink_loss = slot.quantity("params.downlink_loss");
  params.air_bytes_per_s = slot.quantity("params.air_bytes_per_s");
  params.buffer_ns = std::llround(slot.quantity("params.buffer") * 1e9);
  params.seed = slot.rack().seed();
  return params;
}

void tell_frames(io::MavlinkLink& radio, io::Batch& happened, std::uint16_t port) {
  const auto tell = [&happened, port](io::Kind kind) {
    return [&happened, port, kind](std::span<const std::uint8_t> bytes, Nanoseconds t_ns) {
      happened.add(kind, port, t_ns, bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    };
  };
  radio.on_frame(tell(io::Kind::uart_received));
  radio.on_delivered(tell(io::Kind::uart_delivered));
}

}  // namespace whirl::rack
