// A UART's bytes from the edges of its wire: one start bit, eight data bits, least significant first, one stop bit.
//
//   Reads    each bit in its middle, counted from the fall of the start bit
//   Refuses  a byte whose stop bit is low: told as unread (a wrong baud rate, a break, a lost edge)
//   Times    start: the fall; stop: the end of the stop bit
#pragma once
#include <cstdint>
#include <functional>

#include "io_bridges/copper/i2c_decoder.hpp"

namespace whirl::copper {

struct UartByte {
  std::int64_t start_ns = 0, stop_ns = 0;
  std::uint8_t byte = 0;
};

class UartDecoder {
 public:
  // Pre: baud above 0.
  UartDecoder(double baud, std::function<void(const UartByte&)> byte,
              std::function<void(const Unread&)> unread)
      : bit_ns_(1e9 / baud), byte_(std::move(byte)), unread_(std::move(unread)) {}

  void line(bool level, std::int64_t t_ns);
  // No edge has come until then: a byte may end without one.
  void advance_to(std::int64_t t_ns);

 private:
  std::int64_t at(double bits) const;

  double bit_ns_;
  std::function<void(const UartByte&)> byte_;
  std::function<void(const Unread&)> unread_;
  bool level_ = true, open_ = false;
  std::int64_t start_ns_ = 0;
  int bit_ = 0;  // that is read next: 0 start, 9 stop
  std::uint32_t bits_ = 0;
};

}  // namespace whirl::copper
