// SD card in SPI mode: start-up, blocks read, streams of blocks written, erase. Freestanding.
//
//   Contract  call tick() from one task, some thousand times a second for full speed: each waits for
//             nothing, and moves at most kMost_bytes_per_tick (one block and what surrounds it) over
//             the bus. One request at a time: read(), write(), finish() and erase() say busy while
//             another runs; busy() falls when it is done, result() then says how it went. Spans that
//             are given stay the driver's until then; write() copies
//   Streams   each write that continues the one before goes on in the same CMD25; anything else, or
//             finish(), ends it and asks the card by CMD13 whether all was well. Until then a written
//             block is accepted, not yet safe
//   Bus       the card's alone: it stays selected between exchanges
//   Faults    what fails ends its request, and the card is started anew, every 250 ms for ever: so does
//             a card that was pulled and put in again. starts() counts: what was open is gone then
//   CRC       on in both directions (CMD59), as no wire on a vehicle is quiet
//   Limits    400 kHz at most until it is ready, then 25 MHz: the bus's two speeds. Read 100 ms, write
//             600 ms (250 of the specification and more), erase 10 s, start 1 s
//   Source    SD Physical Layer Simplified Specification 4.10, chapters 4, 5.3 and 7
#pragma once
#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <span>

#include "firmware/drivers/sd_wire.hpp"
#include "firmware/status.hpp"

namespace fw {

template <typename B>
concept CardSpi = requires(B bus, std::span<std::uint8_t> bytes, bool on) {
  bus.select(on);                                    // chip select, true: low
  { bus.start(bytes, on) } -> std::same_as<Status>;  // exchange in place; fast or slow
  { bus.done() } -> std::same_as<bool>;              // nothing is under way
};

template <CardSpi Bus>
class SdCard {
 public:
  static constexpr std::size_t kBlock_bytes = sd::kBlock_bytes;
  static constexpr std::size_t kMost_bytes_per_tick = 560;
  using Block = std::span<std::uint8_t, kBlock_bytes>;
  using ConstBlock = std::span<const std::uint8_t, kBlock_bytes>;

  explicit constexpr SdCard(Bus& bus) : bus_(bus) {}

  void tick(std::uint32_t now_us);

  bool ready() const { return phase_ >= Phase::idle; }
  bool busy() const { return request_ != Request::none; }
  Status result() const { return result_; }  // of the last request
  std::uint32_t blocks() const { return blocks_; }
  std::uint32_t starts() const { return starts_; }
  std::uint32_t failures() const { return failures_; }  // of requests and of a card that was ready

  Status read(std::uint32_t block, Block into);
  Status write(std::uint32_t block, ConstBlock bytes);
  Status finish();
  Status erase(std::uint32_t first, std::uint32_t last);

 private:
  enum class Phase : std::uint8_t {
    absent,
    clocks,
    go_idle,
    interface,
    crc_on,
    application,
    operating,
    capacity,
    block_length,
    csd,
    csd_data,
    idle,  // ready, and from here on
    read_command,
    read_data,
    write_command,
    write_data,
    write_busy,
    stop,
    stop_busy,
    status,
    verify,
    erase_first,
    erase_last,
    erase_all,
    erase_busy,
  };
  enum class Request : std::uint8_t { none, read, write, finish, erase };

  static constexpr std::uint32_t kRetry_us = 250'000, kStart_us = 1'000'000, kRead_us = 100'000,
                                 kWrite_us = 600'000, kErase_us = 10'000'000;

  Status ask(Request request, std::uint32_t block, std::uint32_t last = 0);
  void begin(std::uint32_t now_us);
  void next_request();
  void exchange(std::size_t bytes);
  void command(std::uint8_t index, std::uint32_t argument);
  void start_command(const sd::Answer& answer, std::uint32_t now_us);
  void transfer_command(const sd::Answer& answer, std::uint32_t now_us);
  void completed(std::uint32_t now_us);
  void data_came(std::uint32_t now_us);
  void block_sent(std::uint32_t now_us);
  void polled(std::uint32_t now_us, std::uint32_t limit_us, Phase then);
  void go(Phase phase, std::uint32_t now_us) {
    phase_ = phase;
    since_us_ = now_us;
  }
  void fail(Status why, std::uint32_t now_us);
  void done(std::uint32_t now_us) {
    request_ = Request::none;
    result_ = Status::ok;
    go(Phase::idle, now_us);
  }
  bool late(std::uint32_t now_us, std::uint32_t limit_us) const {
    return now_us - since_us_ > limit_us;
  }
  std::uint32_t address(std::uint32_t block) const {
    return high_capacity_ ? block : block * static_cast<std::uint32_t>(kBlock_bytes);
  }

  Bus& bus_;
  Phase phase_ = Phase::absent;  // a card needs its time after power-up
  bool in_flight_ = false, version_2_ = false, high_capacity_ = false;
  std::uint8_t attempts_ = 0;
  std::uint32_t since_us_ = 0, start_us_ = 0;
  std::uint32_t blocks_ = 0, starts_ = 0, failures_ = 0;

  Request request_ = Request::none;
  Status result_ = Status::ok;
  std::uint32_t block_ = 0, last_ = 0;
  std::uint8_t* into_ = nullptr;
  bool streaming_ = false;
  std::uint32_t next_block_ = 0;  // of the stream

  std::array<std::uint8_t, sd::kFrame_bytes> bytes_{};
  std::size_t length_ = 0;
  std::array<std::uint8_t, kBlock_bytes> outgoing_{};
  std::array<std::uint8_t, 16> csd_{};
  sd::DataReader reader_;
};

}  // namespace fw

#include "firmware/drivers/sd_card_steps.hpp"
