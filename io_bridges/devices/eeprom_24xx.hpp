// 24xx64, 24xx128 and the like: an EEPROM on I2C with two address bytes and a page buffer.
//
//   In, out  bytes on I2C; the contents are a MemoryFile of the part's size, which is a power of two
//   Writing  address high, address low, 1 to `page` bytes, STOP: the STOP starts the write cycle of
//            write_ns, in which the part acknowledges nothing. Beyond the page's end the address goes
//            back to its start. A START in place of the STOP, or a transfer that is abandoned, writes
//            nothing. Address bits beyond the size do not count
//   Reading  from the address pointer, which follows each byte and goes from the last one to 0; it
//            is 0 at power-up
//   WP       high: everything is acknowledged, no cycle starts, the bytes stay. Not joined: low
//   Power    bytes of the page whose cycle is cut are each new, old or 0xFF (a half, a quarter, a
//            quarter, by seed); the other pages keep theirs. The end of a run is no cut: the file has
//            what the part has stored by then
//   Source   Microchip 24AA128/24LC128/24FC128 DS21191S p. 9, 24AA64/24LC64 DS21189T: sizes, 5 ms,
//            what starts a cycle, acknowledge polling
//   Memory   wrap within the page, WP, abandoned writes, pointer at power-up: data sheet text as known
//   Left out endurance, the 1 ms of power-up, writing below 1.5 V, glitches on the lines
//
//   | transfer                   | here                                                          |
//   | address 1010 A2 A1 A0      | modelled: one address by key                                  |
//   | byte and page write        | modelled                                                      |
//   | random, current, sequential read | modelled                                                |
//   | acknowledge polling        | modelled                                                      |
//   | more than a page           | modelled: it wraps; told as a finding                         |
//   | identification page, lock of 24xx-D parts | refused: no such address answers               |
//
//   Faults   memory_removed, memory_cut, memory_write_error (the cycle runs, the bytes stay),
//            memory_busy; and those of the bus
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "base/random.hpp"
#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/faults.hpp"
#include "io_bridges/devices/memory_file.hpp"
#include "io_bridges/devices/supply_faults.hpp"
#include "io_bridges/devices/wire.hpp"

namespace whirl::io {

class Eeprom24xx : public I2cTarget {
 public:
  struct Params {
    std::string name = "eeprom";
    std::uint8_t i2c_address = 0x50;
    int page_bytes = 64;  // a power of two
    Nanoseconds write_ns = 5'000'000;
    std::uint64_t seed = 1;
    int bus = kAnywhere;  // where faults find it, beside the address
  };

  // `write_protect` may be null (low), so may `faults`.
  Eeprom24xx(EventQueue& queue, const Params& params, MemoryFile contents,
             const Wire* write_protect, FaultBook* faults, FindingSink findings);

  bool answers(std::uint8_t address_7bit) const override {
    return address_7bit == params_.i2c_address;
  }
  bool start(std::uint8_t address_7bit, bool read, Nanoseconds now) override;
  bool write(std::uint8_t byte, Nanoseconds now) override;
  std::uint8_t read(Nanoseconds now) override;
  void acked(bool, Nanoseconds) override {}
  void stop(Nanoseconds now) override;
  void abandoned(Nanoseconds) override { forget_write(); }

  const MemoryFile& contents() const { return contents_; }
  std::uint64_t cycles() const { return cycles_; }  // of writing, completed

 private:
  void forget_write();
  void advance_in_page();
  void begin_cycle(Nanoseconds now);
  void cycle_done();
  void power_off(Nanoseconds now);
  void store(std::int64_t at, std::uint8_t byte) { contents_.write(at, std::array{byte}); }
  std::uint8_t byte_at(std::int64_t at) const;
  const Fault* fault(FaultKind kind, Nanoseconds now) {
    return apply(faults_, kind, params_.bus, params_.i2c_address, now);
  }

  Params params_;
  MemoryFile contents_;
  const Wire* write_protect_;
  FaultBook* faults_;
  OnceFindings findings_;
  RandomStream tears_;
  Event cycle_done_;
  SupplyFaults supply_;

  bool powered_ = true;
  bool busy_ = false;
  std::int64_t pointer_ = 0;
  int address_bytes_ = 0;  // of this write, so far
  int data_bytes_ = 0;
  std::map<std::int64_t, std::uint8_t> page_;  // what the cycle will store, by address
  std::uint64_t cycles_ = 0;
};

}  // namespace whirl::io
