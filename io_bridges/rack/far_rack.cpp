#include "io_bridges/rack/far_rack.hpp"

#include "base/check.hpp"
#include "io_bridges/rack/fault_order.hpp"
#include "io_bridges/rack/tell_finding.hpp"

namespace whirl::rack {

FarRack::FarRack(std::uint64_t seed) : seed_(seed) {
  tell_applied(faults_, happened_);
}

Result<Done> FarRack::build(const BoardDescription& board, const DeviceTypes& types) {
  for (std::size_t i = 0; i < board.devices.size(); ++i) {
    if (!carries(board.devices[i])) continue;
    if (auto added = add(board, static_cast<int>(i), types); !added) return added;
  }
  return Done{};
}

Result<Done> FarRack::add(const BoardDescription& board, int number, const DeviceTypes& types) {
  const BoardDevice& device = board.devices[static_cast<std::size_t>(number)];
  const DeviceType* type = find_type(types, device.type);
  WHIRL_CHECK(type != nullptr, device.type);  // the board file was read with these types
  DeviceSlot slot(*this, board.name, device, *type, number);
  auto made = type->make(slot);
  if (slot.error()) return *slot.error();
  for (const Intake& intake : made->intakes()) {
    takers_[intake.kind].push_back({intake.port, made.get()});
  }
  devices_.push_back(std::move(made));
  return Done{};
}

void FarRack::on_message(const io::Reader& message) {
  const io::Header& head = message.header();
  if (head.kind == io::Kind::fault) return faults_.add(fault_of(message));
  const auto takers = takers_.find(head.kind);
  if (takers == takers_.end()) return;
  for (const Taker& taker : takers->second) {
    if (taker.port.value_or(head.port) == head.port) taker.device->on_message(message);
  }
}

io::FindingSink FarRack::finding() {
  return [this](const io::Finding& f) { tell_finding(f, happened_); };
}

}  // namespace whirl::rack
