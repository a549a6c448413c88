#include "io_bridges/rack/can_rack.hpp"

#include "io_bridges/board_description/pod_host.hpp"
#include "io_bridges/rack/can_log.hpp"

namespace whirl::rack {

CanRack::Afar::Afar(io::CanBus& bus, double rate_Hz, FrameSink heard)
    : bus_(bus), station_(bus.join(*this, "mcu")), heard_(std::move(heard)) {
  bus_.configure(station_, 1e9 / rate_Hz);
  bus_.connect(station_, 1);
}

void CanRack::Afar::give(const io::CanFrame& frame) {
  waiting_.push_back(frame);
  bus_.request(station_);
}

void CanRack::Afar::bus_off(Nanoseconds /*now*/) {
  waiting_.clear();
  bus_.connect(station_, io::CanBus::kIdles_after_bus_off);
}

CanRack::CanRack(int bus, double rate_Hz, std::uint64_t seed, FrameSink heard)
    : FarRack(seed),
      number_(bus),
      bus_(events(), "CAN" + std::to_string(bus), finding()),
      wire_faults_(events(), faults(), bus_, bus, 1e9 / rate_Hz),
      afar_(bus_, rate_Hz, std::move(heard)) {
  log_can(bus_, number_, happened());
}

bool CanRack::carries(const BoardDevice& device) const {
  return bus_of(device) == "can" + std::to_string(number_);
}

void CanRack::give(const io::CanFrame& frame) {
  afar_.give(frame);
}

}  // namespace whirl::rack
