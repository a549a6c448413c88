// A telemetry radio: MAVLink frames between a UART and the ground station in the harness.
#include "io_bridges/devices/mavlink_link.hpp"

#include <cmath>

#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

io::MavlinkLink::Params params_of(DeviceSlot& slot) {
  io::MavlinkLink::Params params;
  params.baud = slot.quantity("baud");
  params.uplink_loss = slot.quantity("params.uplink_loss");
  params.downlink_loss = slot.quantity("params.downlink_loss");
  params.air_bytes_per_s = slot.quantity("params.air_bytes_per_s");
  params.buffer_ns = std::llround(slot.quantity("params.buffer") * 1e9);
  params.seed = slot.rack().seed();
  return params;
}

class RadioDevice final : public RackDevice {
 public:
  explicit RadioDevice(DeviceSlot& slot)
      : uart_(slot.bus_number()),
        link_(slot.rack().events(), params_of(slot), slot.rack().finding()) {
    const auto send = [&slot, this](io::Kind kind) {
      return [&happened = slot.rack().happened(), kind, uart = uart_](
                 std::span<const std::uint8_t> bytes, Nanoseconds t_ns) {
        happened.add(kind, uart, t_ns, bytes.data(), static_cast<std::uint32_t>(bytes.size()));
      };
    };
    link_.on_frame(send(io::Kind::uart_received));
    link_.on_delivered(send(io::Kind::uart_delivered));
    slot.join_uart(link_);
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::uart_frame, uart_}}; }
  void on_message(const io::Reader& message) override {
    link_.send_frame(message.payload(), message.header().t_ns);
  }

 private:
  std::uint16_t uart_;
  io::MavlinkLink link_;
};

}  // namespace

DeviceType mavlink_link_type() {
  const io::MavlinkLink::Params usual;
  const auto loss = [](const char* path, const char* about) {
    return quantity_key(path, Dimension::ratio, "%", {0.0, 1.0}, about).with(0.0);
  };
  return {
      "mavlink_link",
      "telemetry radio on a UART",
      {bus_key("usart", "the UART").need().own(),
       quantity_key("baud", Dimension::baud, "baud", {50.0, 12e6}, "of the UART").with(usual.baud),
       loss("params.uplink_loss", "share of the frames that the air loses on their way up"),
       loss("params.downlink_loss", "and down"),
       quantity_key("params.air_bytes_per_s", Dimension::none, "B/s", {1.0, 1e9},
                    "that the air carries both ways, a bare number")
           .with(usual.air_bytes_per_s),
       quantity_key("params.buffer", Dimension::time, "ms", {0.0, 60.0},
                    "longest that a frame waits for the air")
           .with(static_cast<double>(usual.buffer_ns) * 1e-9)},
      make_device<RadioDevice>};
}

}  // namespace whirl::rack
