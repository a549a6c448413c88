// An SPI slave that is not one of our simulated parts: the MCU under test, as a master on its wires
// sees it. Chip select is a wire of its own.
//
//   Edges    of a byte only two matter. shift_out: its first bit is put on MISO (CPHA 1: the leading
//            edge of its first clock; CPHA 0: when chip select falls, then the trailing edge of the
//            byte before). sampled: its last bit has been taken from MOSI
#pragma once
#include <cstdint>

#include "io_bridges/devices/event_queue.hpp"

namespace whirl::io {

// How long what went out had waited for its first bit.
struct SpiSlack {
  struct Bytes {
    std::uint64_t bytes = 0, late = 0;  // late: there was nothing in time
    Nanoseconds least_ns = kNever;
    void add(Nanoseconds waited_ns) {
      ++bytes;
      if (waited_ns < 0) {
        ++late;
      } else if (waited_ns < least_ns) {
        least_ns = waited_ns;
      }
    }
  };
  Bytes first, others;  // of a transfer
};

class SpiSlave {
 public:
  static constexpr Nanoseconds kNothing = -1;

  virtual ~SpiSlave() = default;
  // How long what goes out has waited for it; kNothing: there was nothing in time, or nobody selected.
  virtual Nanoseconds shift_out(Nanoseconds now) = 0;
  // `bits`: how many clocks there were, 8 of a whole byte, fewer where the master broke it off. Returns
  // what they read from MISO, in the low bits.
  virtual std::uint8_t sampled(std::uint8_t mosi, int bits, Nanoseconds now) = 0;
  virtual int mode() const = 0;                  // that it is set to: CPOL << 1 | CPHA
  virtual SpiSlack slack() const { return {}; }  // so far
};

}  // namespace whirl::io
