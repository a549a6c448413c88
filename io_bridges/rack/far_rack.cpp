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
  devices_.push_back(std::move(made));
  return takers_.add(*devices_.back(), slot.place());
}

void FarRack::on_message(const io::Reader& message) {
  if (message.header().kind == io::Kind::fault) return faults_.add(fault_of(message));
  takers_.give(message);
}

io::FindingSink FarRack::finding() {
  return [this](const io::Finding& f) { tell_finding(f, happened_); };
}

}  // namespace whirl::rack
