// The sending end of a UART: characters one behind the other, each given away as its last stop bit
// has passed.
#pragma once
#include <deque>
#include <functional>
#include <span>

#include "io_bridges/devices/bus.hpp"

namespace whirl::io {

class UartTransmitter {
 public:
  UartTransmitter(EventQueue& queue, const UartFormat& format, UartPeer::Sink sink);

  void add(std::span<const std::uint8_t> bytes);
  // Behind what waits already.
  void change_format(const UartFormat& format);

  std::size_t waiting() const { return waiting_.size(); }
  const UartFormat& format() const { return format_; }

 private:
  struct Entry {
    std::uint8_t byte = 0;
    bool is_format = false;
    UartFormat format = {};
  };
  void start();
  void sent();
  Nanoseconds character_ns() const;

  UartFormat format_;
  UartPeer::Sink sink_;
  std::deque<Entry> waiting_;  // the first is on the line while passed_ is pending
  Event passed_;
};

}  // namespace whirl::io
