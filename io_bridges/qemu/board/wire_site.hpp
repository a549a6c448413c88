// Where on a board the end of a wire is.
#pragma once
#include <functional>

#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/link/wire.hpp"

namespace whirl::board {

using io::Nanoseconds;

struct WireSite {
  io::EventQueue& events;
  io::FindingSink finding;
  std::function<void()> closed;  // the run ends: does not return, in a board
};

}  // namespace whirl::board
