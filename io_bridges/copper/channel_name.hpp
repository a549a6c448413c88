// What a channel's name says of its wire. The same names stand in the files that a run draws (results/sinks), in a
// bench's list of clips and in a capture that somebody has named so.
//
//   i2c3_scl, i2c3_sda; spi1_sck, spi1_mosi, spi1_miso, spi1_cs_DEVICE; usart2_tx, usart2_rx (of the board);
//   ready_DEVICE (data ready, rising); pin_PIN (a pin that the board file names); marker
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace whirl::copper {

enum class Role : std::uint8_t {
  scl,
  sda,
  sck,
  mosi,
  miso,
  chip_select,
  tx,
  rx,
  ready,
  pin,
  marker
};

struct ChannelName {
  Role role{};
  int bus = 0;             // number of the I2C, SPI or UART
  std::string thing = {};  // of a chip select or data ready: the device; of a pin: its name
  bool operator==(const ChannelName&) const = default;
};

// Nothing: a wire that nobody here reads.
std::optional<ChannelName> channel_name(std::string_view name);

}  // namespace whirl::copper
