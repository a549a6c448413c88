#include "harness/target/bench/serial_rack_link.hpp"

#include <algorithm>
#include <cmath>

#include "harness/target/bench/turn_of_bytes.hpp"
#include "io_bridges/board_description/line_part.hpp"

namespace whirl::bench {

const BoardDevice* part_at(const BoardDescription& board, const SerialLink& link, LinePart kind) {
  const auto found = std::find_if(
      board.devices.begin(), board.devices.end(),
      [&](const BoardDevice& device) { return kind(device) && is_at_uart(device, link.uart); });
  return found == board.devices.end() ? nullptr : &*found;
}

SerialRackLink::SerialRackLink(LinePlace place, const io::UartFormat& format, std::uint64_t seed,
                               rack::LineRack::Choice carries, const std::optional<PodPlaces>& pod)
    : RackLink(rack_, pod),
      rack_(format, seed, std::move(carries),
            [this](std::uint8_t byte, double baud) {
              if (!safe_) hear(byte, baud);
            }),
      place_(std::move(place)) {}

SerialRackLink::SerialRackLink(const LinePartOptions& options, std::string end,
                               const io::UartFormat& format, LinePart kind)
    : SerialRackLink(
          {options.link.name, options.link.path, std::move(end)}, format, options.seed,
          [kind, uart = options.link.uart](const BoardDevice& device) {
            return kind(device) && is_at_uart(device, uart);
          },
          std::nullopt) {}

Result<Done> SerialRackLink::open_line(io::TtyFrame frame, double baud) {
  auto tty = io::Tty::open(place_.path, static_cast<int>(std::lround(baud)), frame);
  if (!tty) return tty.error();
  tty_ = std::move(tty.value());
  return Done{};
}

Result<Done> SerialRackLink::take_in(std::int64_t now_host_ns) {
  advance(now_host_ns);
  return read_turn(*tty_, [this](std::span<const std::uint8_t> piece) { rack_.give(piece); });
}

void SerialRackLink::make_safe() {
  safe_ = true;
  waiting_.clear();
}

std::vector<std::pair<std::string, std::string>> SerialRackLink::versions() const {
  return {{"link " + place_.name, place_.path + ", " + place_.end}};
}

}  // namespace whirl::bench
