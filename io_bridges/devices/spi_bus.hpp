// An SPI bus: the targets on it, each with its chip select, and what the controller reads back.
//
//   Chip select   a wire, active low; a change of its level selects or releases the target
//   MISO          driven by the one selected target; 0xFF (pull-up) if none, and a clash of two
//                 gives the AND of both, is counted and reported
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/wire.hpp"

namespace whirl::io {

// Faults that act on frames on their way. Returns what really passes.
class SpiFaults {
 public:
  virtual ~SpiFaults() = default;
  virtual std::uint8_t miso(const Wire& chip_select, std::uint8_t value, Nanoseconds now) = 0;
};

class SpiBus {
 public:
  // One byte passed: what, to whom (null: nobody was selected), when its last bit was through.
  using Log = std::function<void(const Wire* chip_select, std::uint8_t mosi, std::uint8_t miso,
                                 Nanoseconds now)>;

  explicit SpiBus(std::string name) : name_(std::move(name)) {}

  void add(SpiTarget& target, Wire& chip_select);
  void set_faults(SpiFaults* faults) { faults_ = faults; }
  void on_byte(Log log) { log_ = std::move(log); }
  using Clash = std::function<void(const Wire& first, const Wire& second, Nanoseconds now)>;
  void on_clash(Clash clash) { clash_ = std::move(clash); }  // with each byte
  // The controller: a frame of a byte begins; one byte has passed.
  void begin(std::uint8_t mosi, std::uint32_t sck_Hz, int mode, Nanoseconds now);
  std::uint8_t transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode, Nanoseconds now);

  const std::string& name() const { return name_; }
  std::uint64_t clashes() const { return clashes_; }

 private:
  struct Seat {
    SpiTarget* target;
    Wire* chip_select;
    bool selected;
  };

  std::string name_;
  std::vector<std::unique_ptr<Seat>> seats_;
  SpiFaults* faults_ = nullptr;
  Log log_;
  Clash clash_;
  std::uint64_t clashes_ = 0;
};

}  // namespace whirl::io
