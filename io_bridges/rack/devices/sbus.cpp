// A radio-control receiver with SBUS output on a UART.
#include "io_bridges/devices/sbus.hpp"

#include <cmath>

#include "io_bridges/rack/devices/radio_receiver.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

io::SbusReceiver::Params sbus_params(DeviceSlot& slot) {
  io::SbusReceiver::Params params;
  params.name = slot.name();
  params.period_ns = std::llround(slot.quantity("params.period") * 1e9);
  params.inverter = slot.flag("inverter");
  params.link = link_of(slot);
  params.seed = slot.rack().seed();
  return params;
}

class SbusDevice final : public RackDevice {
 public:
  explicit SbusDevice(DeviceSlot& slot)
      : receiver_(slot.rack().events(), sbus_params(slot), &slot.rack().faults()) {
    slot.join_uart(receiver_);
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::rc_channels}}; }
  void on_message(const io::Reader& message) override { receiver_.on_sticks(sticks_of(message)); }

 private:
  io::SbusReceiver receiver_;
};

}  // namespace

DeviceType sbus_type() {
  const io::SbusReceiver::Params usual;
  std::vector<DeviceKey> keys = {
      bus_key("usart", "the UART").need().own(),
      flag_key("inverter", "the board has one before the UART: else an F4 reads garbage")
          .with(false),
      quantity_key("params.period", Dimension::time, "ms", {4e-3, 0.1}, "from frame to frame")
          .with(static_cast<double>(usual.period_ns) * 1e-9)};
  add_link_keys(keys);
  return {"sbus", "radio-control receiver with SBUS on a UART", std::move(keys),
          make_device<SbusDevice>};
}

}  // namespace whirl::rack
