#include "io_bridges/qemu/board/far_ends.hpp"

#include "base/check.hpp"
#include "io_bridges/board_description/analog_device.hpp"
#include "io_bridges/board_description/bus_kind.hpp"
#include "io_bridges/board_description/bus_name.hpp"
#include "io_bridges/messages/messages.hpp"
#include "io_bridges/qemu/board/i2c_wire.hpp"
#include "io_bridges/qemu/board/level_wire.hpp"
#include "io_bridges/qemu/board/spi_wire.hpp"
#include "io_bridges/qemu/board/uart_wire.hpp"

namespace whirl::board {

Result<Done> FarEnds::lead(const BoardDevice& device, int number, const WireEnd& end, Ear ear) {
  WHIRL_CHECK(wires_ != nullptr, device.name);
  const int bus_of_device = bus_number(device.bus).value_or(0);
  if (bus_kind(device.bus) == BusKind::can) {
    if (io::CanBus* bus = rack_.can(bus_of_device)) {
      return wires_->arbitrate(end.fd, *bus, device.name, number, std::move(ear.can));
    }
  }
  const auto wire = wires_->lead(end.fd);
  if (!wire) return wire.error();
  const auto port = static_cast<std::uint8_t>(end.port);
  if (device.bus.starts_with("i2c") && device.address >= 0) {
    if (io::I2cBus* bus = rack_.i2c(bus_of_device)) {
      auto& led = wire.value()->port<LeaderI2c>(port, *bus);
      led.add(static_cast<std::uint8_t>(device.address), std::move(ear.i2c));
      return Done{};
    }
  } else if (device.bus.starts_with("spi")) {
    if (lead_spi(*wire.value(), device, number, end)) return Done{};
  } else if (is_uart(device.bus)) {
    if (join_uart_(bus_of_device, wire.value()->port<LeaderUart>(port, end.latency_ns))) {
      return Done{};
    }
  } else if (puts_a_level(device)) {
    auto& led = wire.value()->port<LeaderLevel>(port, end.latency_ns);
    const auto volts = [&led](io::Nanoseconds now) { return led.volts(now); };
    if (rack_.set_analog(device.bus, volts)) return Done{};
  }
  return Error{
      ErrorKind::bad_input, device.place + ": " + device.name,
      "is on no I2C, SPI, CAN, UART or analog pin of this part: no board can take its place", ""};
}

bool FarEnds::lead_spi(LeaderWire& wire, const BoardDevice& device, int number,
                       const WireEnd& end) {
  io::Wire* select = pin_of(device, "cs");
  if (select == nullptr) return false;
  io::Wire* ready = pin_of(device, "int");
  const auto port = static_cast<std::uint8_t>(end.port);
  auto& led = wire.port<LeaderSpi>(port, device.name, ready, end.latency_ns);
  if (ready != nullptr) tell_ready(*ready, number);
  return rack_.join_spi(bus_number(device.bus).value_or(0), *select, led, device, number);
}

io::Wire* FarEnds::pin_of(const BoardDevice& device, const char* key) {
  const auto value = device.value(key);
  return value ? rack_.pin(std::get<std::string>(*value)) : nullptr;
}

// As the part itself would.
void FarEnds::tell_ready(io::Wire& ready, int number) {
  ready.watch([this, number](bool level, io::Nanoseconds now) {
    const auto place = static_cast<std::uint16_t>(number);
    if (level) rack_.happened().add(io::Kind::data_ready, place, now, nullptr, 0);
  });
}

Result<Done> FarEnds::follow(const WireEnd& end) {
  WHIRL_CHECK(wires_ != nullptr, end.bus);
  if (bus_kind(end.bus) == BusKind::can) return follow_can(end);
  const auto wire = wires_->follow(end.fd, end.shared);
  if (!wire) return wire.error();
  const auto port = static_cast<std::uint8_t>(end.port);
  const int number = bus_number(end.bus).value_or(0);
  if (end.bus.starts_with("i2c")) {
    if (io::I2cBus* bus = rack_.i2c(number)) {
      return wire.value()->port<FollowerI2c>(port, *bus), Done{};
    }
  } else if (io::SpiSlave* slave = rack_.spi_slave(number);
             end.bus.starts_with("spi") && slave != nullptr) {
    return follow_spi(*wire.value(), end, *slave);
  } else if (is_uart(end.bus)) {
    auto& led = wire.value()->port<FollowerUart>(port, end.bus, end.latency_ns);
    if (join_uart_(number, led)) return Done{};
  } else if (bus_kind(end.bus) == BusKind::dac) {
    auto& led = wire.value()->port<FollowerLevel>(port);
    if (rack_.on_dac(number, [&led](double level_V) { led.put(level_V); })) return Done{};
  }
  return Error{ErrorKind::bad_input, end.bus,
               "the part has no such bus for the wire to another board, or a device is on its UART",
               ""};
}

Result<Done> FarEnds::follow_can(const WireEnd& end) {
  io::CanBus* bus = rack_.can(bus_number(end.bus).value_or(0));
  if (bus == nullptr) {
    return Error{ErrorKind::bad_input, end.bus,
                 "the part has no such bus for the wire to another board", ""};
  }
  if (!end.arbitrates) return wires_->share(end.fd, *bus);
  return wires_->arbitrate(end.fd, *bus, end.far, io::CanRecord::kFirst_board + boards_++, nullptr);
}

Result<Done> FarEnds::follow_spi(FollowerWire& wire, const WireEnd& end, io::SpiSlave& slave) {
  io::Wire* select = rack_.pin(end.select);
  io::Wire* ready = end.ready.empty() ? nullptr : rack_.pin(end.ready);
  if (select == nullptr || (ready == nullptr && !end.ready.empty())) {
    return Error{ErrorKind::bad_input, end.bus,
                 "the part has no pin '" + (select == nullptr ? end.select : end.ready) +
                     "' for the wire to another board",
                 ""};
  }
  wire.port<FollowerSpi>(static_cast<std::uint8_t>(end.port), end.bus, slave, *select, ready);
  return Done{};
}

}  // namespace whirl::board
