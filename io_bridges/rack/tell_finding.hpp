// A finding as a message: place, a zero, text.
#pragma once
#include "io_bridges/devices/bus.hpp"
#include "io_bridges/messages/messages.hpp"

namespace whirl::rack {

inline void tell_finding(const io::Finding& finding, io::Batch& happened) {
  const std::string text = finding.where + '\0' + finding.what;
  happened.add(io::Kind::finding, 0, finding.t_ns, text.data(),
               static_cast<std::uint32_t>(text.size()));
}

}  // namespace whirl::rack
