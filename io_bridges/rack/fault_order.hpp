// A fault as the harness orders it, for the book of a rack.
#pragma once
#include "io_bridges/devices/faults.hpp"
#include "io_bridges/messages/messages.hpp"

namespace whirl::rack {

// Pre: a message of kind fault.
inline io::Fault fault_of(const io::Reader& order) {
  const auto f = order.as<io::FaultCommand>();
  return {
      f.number, static_cast<io::FaultKind>(f.kind), f.start_ns, f.end_ns, f.bus, f.address, f.axis,
      f.value};
}

// What has acted is told in `happened`, which has to live as long as the book.
inline void tell_applied(io::FaultBook& book, io::Batch& happened) {
  book.on_applied([&happened](std::uint32_t number, io::Nanoseconds now) {
    happened.add(io::Kind::fault_applied, static_cast<std::uint16_t>(number), now, nullptr, 0);
  });
}

}  // namespace whirl::rack
