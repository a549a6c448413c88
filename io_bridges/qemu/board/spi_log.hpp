// Puts the bytes of one chip select together and logs the transaction when it ends.
#pragma once
#include <cstdint>
#include <vector>

#include "io_bridges/devices/wire.hpp"
#include "io_bridges/messages/messages.hpp"

namespace whirl::board {

class SpiLog {
 public:
  static constexpr std::size_t kPairs = 16;  // of MOSI and MISO, kept

  SpiLog(io::Batch& happened, int bus, int device, io::Wire& chip_select)
      : happened_(happened), bus_(bus), device_(device), selected_(!chip_select.level()) {
    chip_select.watch([this](bool level, io::Nanoseconds now) { level ? end(now) : begin(now); });
  }
  void byte(std::uint8_t mosi, std::uint8_t miso, io::Nanoseconds now) {
    if (length_++ >= kPairs) return;
    passed_ns_.push_back(io::passed_ns(start_ns_, now));
    pairs_.push_back(mosi);
    pairs_.push_back(miso);
  }

 private:
  void begin(io::Nanoseconds now) {
    selected_ = true;
    start_ns_ = now;
    length_ = 0;
    pairs_.clear();
    passed_ns_.clear();
  }
  void end(io::Nanoseconds now) {
    if (!selected_ || length_ == 0) return;
    selected_ = false;
    io::BusTransaction head;
    head.start_ns = start_ns_;
    head.address = static_cast<std::uint16_t>(device_);
    head.length = static_cast<std::uint32_t>(length_);
    io::add_transaction(io::Kind::spi_transaction, static_cast<std::uint16_t>(bus_), now, head,
                        pairs_, passed_ns_, happened_);
  }

  io::Batch& happened_;
  int bus_, device_;
  bool selected_;
  io::Nanoseconds start_ns_ = 0;
  std::size_t length_ = 0;
  std::vector<std::uint8_t> pairs_;
  std::vector<std::uint32_t> passed_ns_;  // since start_ns_
};

}  // namespace whirl::board
