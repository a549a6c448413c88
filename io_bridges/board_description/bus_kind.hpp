// What kind of bus a name is of: "i2c3", "spi1", "can2", "usart2" or "uart4"; "dac1" is a DAC's channel.
#pragma once
#include <string_view>

namespace whirl {

enum class BusKind { none, i2c, spi, can, uart, dac };

inline BusKind bus_kind(std::string_view bus) {
  if (bus.starts_with("i2c")) return BusKind::i2c;
  if (bus.starts_with("spi")) return BusKind::spi;
  if (bus.starts_with("can")) return BusKind::can;
  if (bus.starts_with("dac")) return BusKind::dac;
  const bool uart = bus.starts_with("usart") || bus.starts_with("uart");
  return uart ? BusKind::uart : BusKind::none;
}

inline bool is_uart(std::string_view bus) {
  return bus_kind(bus) == BusKind::uart;
}

}  // namespace whirl
