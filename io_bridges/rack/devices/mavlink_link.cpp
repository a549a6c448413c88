// A telemetry radio: MAVLink frames between a UART and the ground station in the harness.
#include "io_bridges/rack/devices/mavlink_keys.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

class RadioDevice final : public RackDevice {
 public:
  explicit RadioDevice(DeviceSlot& slot)
      : uart_(slot.bus_number()),
        link_(slot.rack().events(), radio_of(slot, slot.quantity("baud")), slot.rack().finding()) {
    tell_frames(link_, slot.rack().happened(), uart_);
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
  std::vector<DeviceKey> keys = {
      bus_key("usart", "the UART").need().own(),
      quantity_key("baud", Dimension::baud, "baud", {50.0, 12e6}, "of the UART")
          .with(io::MavlinkLink::Params{}.baud)};
  for (DeviceKey& key : air_keys()) keys.push_back(std::move(key));
  return {"mavlink_link", "telemetry radio on a UART", std::move(keys), make_device<RadioDevice>};
}

}  // namespace whirl::rack
