#include "io_bridges/rack/takers.hpp"

namespace whirl::rack {

Result<Done> Takers::add(RackDevice& device, const std::string& place) {
  for (const Intake& intake : device.intakes()) {
    if (!intake.port) {
      of_kind_[intake.kind].push_back(&device);
    } else if (!of_port_.emplace(std::pair(intake.kind, *intake.port), &device).second) {
      return Error{ErrorKind::bad_input, place, "another device takes the messages that it takes",
                   "give it a number of its own"};
    }
  }
  return Done{};
}

bool Takers::give(const io::Reader& message) const {
  const io::Header& head = message.header();
  const auto all = of_kind_.find(head.kind);
  if (all != of_kind_.end()) {
    for (RackDevice* device : all->second) device->on_message(message);
  }
  const auto one = of_port_.find({head.kind, head.port});
  if (one != of_port_.end()) one->second->on_message(message);
  return all != of_kind_.end() || one != of_port_.end();
}

}  // namespace whirl::rack
