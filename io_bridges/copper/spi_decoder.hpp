// SPI of one chip select from the edges of its wires.
//
//   Reads    both data wires at each rise of SCK while the select is low: modes 0 and 3, most significant bit first
//   Refuses  a select that holds clocks, and not a multiple of eight: told as unread, none of its bytes is given
//   Cannot   tell eight lost clocks from a byte that was never sent
//   Times    start, stop: the select's edges; a byte has passed half a clock behind the rise of its eighth
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "io_bridges/copper/i2c_decoder.hpp"

namespace whirl::copper {

struct SpiFrame {
  std::int64_t start_ns = 0, stop_ns = 0;
  std::vector<std::uint8_t> pairs;  // MOSI and MISO in turn
  std::vector<std::int64_t> passed_ns;
};

class SpiDecoder {
 public:
  SpiDecoder(std::function<void(const SpiFrame&)> frame, std::function<void(const Unread&)> unread)
      : frame_(std::move(frame)), unread_(std::move(unread)) {}

  void select(bool level, std::int64_t t_ns);
  void sck(bool level, std::int64_t t_ns);
  void mosi(bool level) { mosi_ = level; }
  void miso(bool level) { miso_ = level; }

 private:
  std::function<void(const SpiFrame&)> frame_;
  std::function<void(const Unread&)> unread_;
  bool selected_ = false, sck_ = false, mosi_ = false, miso_ = false;
  SpiFrame now_;
  int clocks_ = 0;
  std::int64_t rise_ns_ = 0;
  std::uint8_t out_ = 0, in_ = 0;
};

}  // namespace whirl::copper
