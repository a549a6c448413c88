#include "harness/target/bench/serial_rack_link.hpp"

#include <cmath>

namespace whirl::bench {

SerialRackLink::SerialRackLink(LinePlace place, const io::UartFormat& format, std::uint64_t seed,
                               rack::LineRack::Choice carries, const std::optional<PodPlaces>& pod)
    : RackLink(rack_, pod),
      rack_(format, seed, std::move(carries),
            [this](std::uint8_t byte, double baud) {
              if (!safe_) hear(byte, baud);
            }),
      place_(std::move(place)) {}

Result<Done> SerialRackLink::open_line(io::TtyFrame frame, double baud) {
  auto tty = io::Tty::open(place_.path, static_cast<int>(std::lround(baud)), frame);
  if (!tty) return tty.error();
  tty_ = std::move(tty.value());
  return Done{};
}

void SerialRackLink::make_safe() {
  safe_ = true;
  waiting_.clear();
}

std::vector<std::pair<std::string, std::string>> SerialRackLink::versions() const {
  return {{"link " + place_.name, place_.path + ", " + place_.end}};
}

}  // namespace whirl::bench
