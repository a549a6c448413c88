// An SPI bus between two boards: a slave's place on the master's bus, with its chip select and, from the slave's
// board, its data-ready line.
//
//   Exact     chip select; of each byte the time at which its first bit goes out, its first clock, and that at which its
//             last one is taken, half a period before the byte's end (io_bridges/devices/spi_slave.hpp); MOSI and MISO
//   Line      data-ready comes `latency_ns` after the slave's board has put it out
//   Findings  a master in CPHA 0, or in another mode than the slave's: what passes is 0xFF; a frame of 16 bits
#pragma once
#include <deque>

#include "io_bridges/devices/spi_slave.hpp"
#include "io_bridges/devices/wire.hpp"
#include "io_bridges/qemu/board/wire_ends.hpp"

namespace whirl::board {

// The far slave as the master's bus sees it.
class LeaderSpi final : public LeaderPort, public io::SpiTarget {
 public:
  // `ready` may be null: nothing is joined to the slave's line.
  LeaderSpi(LeaderWire& wire, std::uint8_t port, std::string name, io::Wire* ready,
            Nanoseconds latency_ns);

  void select(bool selected, Nanoseconds now) override;
  void begin(std::uint8_t mosi, std::uint32_t sck_Hz, int mode, Nanoseconds now) override;
  std::uint8_t transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode,
                        Nanoseconds now) override;

 private:
  void edge(const io::WireEdge& edge) override;
  void put_ready();

  LeaderWire& wire_;
  std::uint8_t port_;
  std::string name_;
  io::Wire* ready_;
  int driver_ = 0;
  Nanoseconds latency_ns_;
  std::deque<std::pair<Nanoseconds, bool>> edges_;  // due, level
  io::Event due_, sampled_;
  io::OnceFindings findings_;
  bool begun_ = false;
  std::uint8_t mosi_ = 0, miso_ = 0xFF;
};

// The far master as the slave's board sees it.
class FollowerSpi final : public FollowerPort {
 public:
  // select: driven here. ready: the slave's own, may be null.
  FollowerSpi(FollowerWire& wire, std::uint8_t port, std::string name, io::SpiSlave& slave,
              io::Wire& select, io::Wire* ready);

 private:
  bool act(const io::WireMessage& message, Nanoseconds now) override;
  io::WireAnswer reply(io::WireAnswer::Clock clock, Nanoseconds now) override;

  void begin(int mode, Nanoseconds now);

  std::string name_;
  io::SpiSlave& slave_;
  io::Wire& select_;
  int driver_;
  io::OnceFindings findings_;
  bool in_step_ = false;  // this byte passes
  std::uint8_t miso_ = 0xFF;
};

}  // namespace whirl::board
