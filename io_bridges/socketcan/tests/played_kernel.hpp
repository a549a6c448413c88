// The system calls of a CAN socket, played: a test's program is linked so that those of the code under test come here
// (-Wl,--wrap in CMakeLists.txt). Calls on other files go to the kernel as ever.
#pragma once
#include <linux/can.h>

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "io_bridges/socketcan/tests/link_message.hpp"

namespace whirl::io {

class PlayedKernel {
 public:
  struct Option {
    int level = 0, name = 0;
    std::uint32_t value = 0;
  };
  struct Incoming {
    can_frame frame = {};
    int error = 0;  // instead of a frame
    std::int64_t size = sizeof(can_frame);
    int flags = 0;                           // MSG_CONFIRM
    std::optional<std::uint32_t> lost = {};  // so far, as SO_RXQ_OVFL has it
    std::optional<std::int64_t> software_ns = {}, hardware_ns = {};
  };

  PlayedKernel() { at_work = this; }
  ~PlayedKernel() { at_work = nullptr; }
  PlayedKernel(const PlayedKernel&) = delete;
  PlayedKernel& operator=(const PlayedKernel&) = delete;

  static PlayedKernel* at_work;

  Bytes link =
      link_message(ARPHRD_CAN, IFF_UP, "can", controller_at(1'000'000, CAN_STATE_ERROR_ACTIVE));
  int socket_error = 0, bind_error = 0;  // 0: none
  std::deque<int> send_errors;           // of the writes to come, 0: taken
  std::deque<Incoming> incoming;         // none left: EAGAIN
  std::int64_t monotonic_ns = 50'000'000'000, realtime_ns = 1'700'000'000'000'000'000;

  std::vector<Option> options;
  std::vector<can_frame> sent;
  int bound_to = -1, opened = 0, closed = 0;
};

}  // namespace whirl::io
