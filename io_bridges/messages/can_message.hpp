// A CAN frame as a message, and back.
#pragma once
#include <algorithm>

#include "io_bridges/messages/messages.hpp"
#include "io_bridges/protocols/can_frame.hpp"

namespace whirl::io {

inline CanMessage to_message(const CanFrame& frame) {
  CanMessage message;
  message.id = frame.id;
  message.flags = static_cast<std::uint8_t>((frame.extended ? 1 : 0) | (frame.remote ? 2 : 0));
  message.length = frame.length;
  std::copy(frame.data.begin(), frame.data.end(), message.data);
  return message;
}

inline CanFrame frame_of(const CanMessage& message) {
  CanFrame frame;
  frame.extended = (message.flags & 1) != 0;
  frame.remote = (message.flags & 2) != 0;
  frame.id = message.id & (frame.extended ? 0x1FFFFFFF : 0x7FF);
  frame.length = std::min<std::uint8_t>(message.length, 8);
  if (!frame.remote) std::copy_n(message.data, frame.length, frame.data.begin());
  return frame;
}

}  // namespace whirl::io
