#include "io_bridges/rack/can_rack.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "io_bridges/rack/can_log.hpp"
#include "io_bridges/rack/tell_finding.hpp"

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
    : number_(bus),
      seed_(seed),
      bus_(events_, "CAN" + std::to_string(bus), finding()),
      afar_(bus_, rate_Hz, std::move(heard)) {
  log_can(bus_, number_, happened_);
}

Result<Done> CanRack::build(const BoardDescription& board, const DeviceTypes& types) {
  for (std::size_t i = 0; i < board.devices.size(); ++i) {
    if (board.devices[i].bus != "can" + std::to_string(number_)) continue;
    if (auto added = add(board, static_cast<int>(i), types); !added) return added;
  }
  return Done{};
}

Result<Done> CanRack::add(const BoardDescription& board, int number, const DeviceTypes& types) {
  const BoardDevice& device = board.devices[static_cast<std::size_t>(number)];
  const DeviceType* type = find_type(types, device.type);
  WHIRL_CHECK(type != nullptr, device.type);  // the board file was read with these types
  DeviceSlot slot(*this, board.name, device, *type, number);
  auto made = type->make(slot);
  if (slot.error()) return *slot.error();
  devices_.push_back(std::move(made));
  return Done{};
}

void CanRack::on_message(const io::Reader& message) {
  const io::Header& head = message.header();
  for (const auto& device : devices_) {
    for (const Intake& intake : device->intakes()) {
      const bool its = intake.kind == head.kind && intake.port.value_or(head.port) == head.port;
      if (its) device->on_message(message);
    }
  }
}

void CanRack::give(const io::CanFrame& frame) {
  afar_.give(frame);
}

io::FindingSink CanRack::finding() {
  return [this](const io::Finding& f) { tell_finding(f, happened_); };
}

}  // namespace whirl::rack
