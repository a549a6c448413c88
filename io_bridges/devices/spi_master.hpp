// An SPI master that is not the MCU: it clocks whole transfers through an MCU that is the slave.
//
//   Does     one transfer at a time: chip select low, its bytes without a gap, chip select high
//   Edges    of each byte two (spi_slave.hpp). Modes 1 and 3: the first bit goes out with the first
//            edge, the last is sampled half a clock before the byte's end. Modes 0 and 2: half a clock
//            earlier, both
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/devices/spi_slave.hpp"
#include "io_bridges/devices/wire.hpp"

namespace whirl::io {

struct SpiRequest {
  std::vector<std::uint8_t> mosi;
  double sck_Hz = 1e6;
  Nanoseconds lead_ns = 500;  // from chip select to the first edge
  Nanoseconds tail_ns = 500;  // from the end of the last byte to chip select
};

struct SpiReply {
  Nanoseconds start_ns = 0, stop_ns = 0;
  std::vector<std::uint8_t> miso;
  std::vector<Nanoseconds> waited_ns;  // SpiSlave::shift_out of each byte
};

class SpiMaster {
 public:
  using Done = std::function<void(const SpiReply&)>;

  SpiMaster(EventQueue& queue, SpiSlave& slave, Wire& chip_select, int mode);

  bool busy() const { return busy_; }
  // Pre: !busy(), at least a byte. `done` comes as chip select rises.
  void transfer(SpiRequest request, Done done);

 private:
  void edge();
  void schedule();
  void shift_out();
  void finish();
  Nanoseconds at_half_clocks(std::int64_t n) const;  // since the first edge

  EventQueue& queue_;
  SpiSlave& slave_;
  Wire& chip_select_;
  int driver_;
  bool late_phase_;  // CPHA
  Event edge_, stop_;
  bool busy_ = false, out_next_ = false;
  Nanoseconds first_edge_ns_ = 0;
  SpiRequest request_;
  SpiReply reply_;
  Done done_;
};

}  // namespace whirl::io
