// The radio's other user: a ground station that is not ours sends bytes as they stand. They go up with the
// next step, in the order in which they came, and share the air with our own frames.
//
//   Leads    a frame for the vehicle that moves it: SET_POSITION_TARGET_LOCAL_NED, or a COMMAND_LONG that
//            arms or disarms, takes off or lands. Looked for in each piece by itself: a piece is a frame
#pragma once
#include <cstdint>
#include <vector>

#include "io_bridges/messages/messages.hpp"

namespace whirl::flight {

class GuestRadio {
 public:
  // True: with this it leads.
  bool add(const std::vector<std::uint8_t>& bytes);
  // To the radio of that board of the run.
  void send(std::uint8_t board, std::uint16_t port, std::int64_t t_ns, io::Batch& sensed);

 private:
  std::vector<std::vector<std::uint8_t>> waiting_;
};

}  // namespace whirl::flight
