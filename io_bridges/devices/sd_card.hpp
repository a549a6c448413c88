// SD memory card in SPI mode, command by command: standard (SDSC) or high capacity (SDHC).
//
//   In, out  bytes on SPI; the contents are a MemoryFile, block n at byte 512 n
//   Timing   after power-up 1 ms and 74 clocks with chip select high before it listens; ACMD41 says
//            ready after init_ns; a response follows its command after 1 to 8 bytes (drawn for each
//            card); the first block of a read after read_ns, the next ones of CMD18 after a tenth of it;
//            busy after each block written: two peaks. Most: write_ns x (0.5 to 1.5, evenly), within
//            CMD25 a tenth of that; one in stall_every blocks: 20 ms to longest_stall_ns, evenly
//   Limits   SCK 400 kHz until it is ready, then 25 MHz; mode 0 or 3: beyond is a finding
//   Power    it goes on when the microcontroller is reset. A block whose write is cut is afterwards
//            old, new or unreadable (a third each, by seed): read as the error token "ECC failed"
//            until it is written again; in the file it is half new, half old. The end of a run is no
//            cut: what the card has taken by then is in the file once its busy time is over
//   Source   SD Physical Layer Simplified Specification 4.10, chapters 4, 5 and 7 (SPI mode); SanDisk
//            SD Card Product Manual rev 2.2, chapter 5, for the times in bytes
//   Memory   read_ns, write_ns and the stalls: typical of cards, of no data sheet. What a card does
//            when its supply is cut is stated by none: neighbours of the block may be lost on real ones
//   Left out SD and 4-bit mode, high speed (CMD6), locking, write protection, program CMD27, erased
//            groups of SDSC, SDXC's power limits, one byte of clocks that a card wants after each
//            transaction before it lets go of MISO
//
//   | command                    | here                                                          |
//   | 0, 8, 58, 59               | modelled; CRC always checked of CMD0 and CMD8                 |
//   | 1                          | modelled, as ACMD41 without HCS                               |
//   | 9, 10, 13                  | modelled: CSD, CID, status (its error bits clear on reading)  |
//   | 12                         | modelled; the byte after it is the data's next                |
//   | 16                         | modelled: SDSC takes 512 and refuses others (stated: partial  |
//   |                            | blocks are left out); SDHC takes all, without effect          |
//   | 17, 18, 24, 25             | modelled                                                      |
//   | 32, 33, 38                 | modelled; erased blocks read 0                                |
//   | 55, ACMD 41, 51            | modelled (51: SCR)                                            |
//   | ACMD 13, 22                | modelled: status (all 0), number of well written blocks       |
//   | ACMD 23                    | stored only: the count has no effect on times                 |
//   | ACMD 42                    | stored only: the pull-up of chip select                       |
//   | 6, 27, 28..30, 42, 56      | refused: illegal command, a finding                           |
//   | any other                  | refused: illegal command, a finding                           |
//
//   Faults   memory_removed, memory_cut, memory_write_error (data response 0x0D), memory_crc_error (data response 0x0B; a bit of what is read),
//            memory_busy, sensor_wrong_identity (value 0: a MultiMediaCard, which knows neither CMD8 nor
//            CMD55; else: the manufacturer's number of the CID)
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "base/random.hpp"
#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/faults.hpp"
#include "io_bridges/devices/memory_file.hpp"
#include "io_bridges/devices/sd_registers.hpp"
#include "io_bridges/devices/supply_faults.hpp"

namespace whirl::io {

class SdCard : public SpiTarget {
 public:
  struct Params {
    std::string name = "sd_card";
    bool high_capacity = true;
    std::uint64_t seed = 1;
    Nanoseconds init_ns = 60'000'000;
    Nanoseconds read_ns = 400'000;
    Nanoseconds write_ns = 1'000'000;
    Nanoseconds longest_stall_ns = 250'000'000;
    double stall_every = 300.0;               // blocks; 0: never
    int bus = kAnywhere, device = kAnywhere;  // where faults find it
  };

  // The contents' size is the card's: a whole number of its units (sd_registers.hpp).
  SdCard(EventQueue& queue, const Params& params, MemoryFile contents, FaultBook* faults,
         FindingSink findings);

  void select(bool selected, Nanoseconds now) override;
  std::uint8_t transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode,
                        Nanoseconds now) override;
  void passed_by(std::uint8_t mosi, Nanoseconds now) override;

  const MemoryFile& contents() const { return contents_; }
  std::int64_t blocks() const { return contents_.size_bytes() / sd::kBlock_bytes; }
  std::int64_t blocks_written() const { return written_; }

 private:
  enum class Mode : std::uint8_t { off, sd, idle, ready };  // sd: powered, not yet on SPI
  enum class Receiving : std::uint8_t { commands, token_one, token_many, block };
  using Block = std::array<std::uint8_t, sd::kBlock_bytes>;
  struct Command {
    int index = 0;
    std::uint32_t argument = 0;
    bool application = false;
    bool good_crc = true;
  };
  struct Reading {
    std::int64_t block = 0;
    bool many = false;
    Nanoseconds ready_ns = 0;
  };

  // sd_card.cpp: bytes and commands.
  std::uint8_t next_byte(Nanoseconds now);
  void receive(std::uint8_t byte, Nanoseconds now);
  void command_byte(std::uint8_t byte, Nanoseconds now);
  void run(const Command& command, Nanoseconds now);
  bool run_in_idle(const Command& command, Nanoseconds now);
  bool run_application(const Command& command, Nanoseconds now);
  bool run_transfer(const Command& command, Nanoseconds now);
  bool run_erase(const Command& command, Nanoseconds now);
  void go_idle(const Command& command, Nanoseconds now);
  void interface_condition(const Command& command);
  void operating_condition(bool host_knows_high_capacity, Nanoseconds now);
  void stop_reading(Nanoseconds now);
  void check_clock(std::uint32_t sck_Hz, int mode, Nanoseconds now);
  void respond(std::uint8_t r1, std::initializer_list<std::uint8_t> more = {});
  void send_block(std::span<const std::uint8_t> bytes, Nanoseconds now);
  void send_next_read(Nanoseconds now);
  std::optional<std::int64_t> block_of(std::uint32_t address);
  std::uint8_t idle_bit() const { return mode_ == Mode::idle ? 1 : 0; }
  void report(Nanoseconds now, const std::string& what) {
    findings_.report({now, params_.name, what});
  }

  // sd_card_write.cpp: writing, power and faults.
  void begin_write(std::int64_t block, bool many);
  void write_token(std::uint8_t byte, Nanoseconds now);
  void data_byte(std::uint8_t byte, Nanoseconds now);
  void block_received(Nanoseconds now);
  void program(Nanoseconds now);
  void programmed();
  Nanoseconds busy_time(bool many);
  bool busy(Nanoseconds now) const { return now < busy_until_ns_; }
  void erase(Nanoseconds now);
  void power_off(Nanoseconds now);
  void power_on(Nanoseconds now);
  void tear();
  const Fault* fault(FaultKind kind, Nanoseconds now) {
    return apply(faults_, kind, params_.bus, params_.device, now);
  }

  EventQueue& queue_;
  Params params_;
  MemoryFile contents_;
  FaultBook* faults_;
  OnceFindings findings_;
  RandomStream times_, tears_;
  Event programmed_;
  SupplyFaults supply_;
  int response_bytes_;  // NCR of this card
  sd::Register csd_, cid_;

  Mode mode_ = Mode::sd;
  bool selected_ = false;
  Nanoseconds powered_ns_ = 0;
  int clocks_ = 0;  // with chip select and MOSI high, since power-up
  bool crc_on_ = false, version_2_ = false, application_next_ = false;
  std::optional<bool> host_knows_high_capacity_;
  Nanoseconds init_done_ns_ = kNever;
  std::uint8_t status_ = 0;  // second byte of R2

  std::array<std::uint8_t, 6> command_{};
  std::size_t command_bytes_ = 0;
  std::deque<std::uint8_t> out_;
  std::optional<Reading> reading_;

  Receiving receiving_ = Receiving::commands;
  bool write_many_ = false, write_failed_ = false;
  std::int64_t write_block_ = 0;
  std::array<std::uint8_t, sd::kBlock_bytes + 2> data_{};
  std::size_t data_bytes_ = 0;
  std::uint32_t well_written_ = 0;
  std::int64_t written_ = 0;

  struct Programming {
    std::int64_t block;
    Block bytes;
  };
  std::optional<Programming> programming_;
  Nanoseconds busy_until_ns_ = 0;
  std::set<std::int64_t> unreadable_;
  std::optional<std::int64_t> erase_first_, erase_last_;
};

}  // namespace whirl::io
