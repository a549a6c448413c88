// The far end of a serial line: what t:ask talks to.
#include "io_bridges/devices/serial_port.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

// 8E2 is a receiver's: through an inverter, so that both ends mean the same by it.
io::UartFormat format_of(const DeviceSlot& slot) {
  io::UartFormat format{.baud = slot.quantity("baud")};
  if (slot.text("params.frame") != "8E2") return format;
  format.parity = 'E';
  format.stop_bits = 2.0;
  return format;
}

class SerialDevice final : public RackDevice {
 public:
  explicit SerialDevice(DeviceSlot& slot)
      : uart_(slot.bus_number()),
        port_(slot.rack().events(), slot.name(), format_of(slot), slot.rack().finding()) {
    port_.on_message([&happened = slot.rack().happened(), uart = uart_](
                         std::span<const std::uint8_t> bytes, Nanoseconds t_ns) {
      happened.add(io::Kind::uart_received, uart, t_ns, bytes.data(),
                   static_cast<std::uint32_t>(bytes.size()));
    });
    if (slot.flag("params.follows")) port_.follow();
    slot.join_uart(port_);
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::uart_frame, uart_}}; }
  void on_message(const io::Reader& message) override {
    port_.send_bytes(message.payload(), message.header().t_ns);
  }

 private:
  std::uint16_t uart_;
  io::SerialPort port_;
};

}  // namespace

DeviceType serial_type() {
  return {"serial",
          "terminal on a UART, what t:ask talks to",
          {bus_key("usart", "the UART").need().own(),
           quantity_key("baud", Dimension::baud, "baud", {50.0, 12e6}, "of the UART").need(),
           word_key("params.frame", "8N1 or 8E2", "bits, parity and stop bits of a character")
               .with(std::string("8N1")),
           flag_key("params.follows", "its rate is the UART's, whatever that is").with(false)},
          make_device<SerialDevice>};
}

}  // namespace whirl::rack
