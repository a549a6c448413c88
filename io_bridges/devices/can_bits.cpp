#include "io_bridges/devices/can_bits.hpp"

#include <bit>

namespace whirl::io {
namespace {

class Writer {
 public:
  explicit Writer(CanBits& out) : out_(out) {}

  void put(std::uint32_t value, int count) {
    for (int i = count - 1; i >= 0; --i) {
      const auto bit = static_cast<std::uint8_t>(value >> i & 1);
      const bool invert = bit != (crc_ >> 14 & 1);
      crc_ = (crc_ << 1 & 0x7FFF) ^ (invert ? 0x4599u : 0);
      put_stuffed(bit);
    }
  }
  void put_crc() { put(crc_, 15); }

 private:
  void put_stuffed(std::uint8_t bit) {
    run_ = bit == last_ ? run_ + 1 : 1;
    last_ = bit;
    append(bit);
    if (run_ < 5) return;
    last_ = bit ^ 1;
    append(last_);
    run_ = 1;
  }
  void append(std::uint8_t bit) { out_.value[static_cast<std::size_t>(out_.count++)] = bit; }

  CanBits& out_;
  std::uint32_t crc_ = 0;
  int run_ = 0;
  std::uint8_t last_ = 2;  // the idle bus before does not count into a run
};

}  // namespace

CanBits can_bits(const CanFrame& frame) {
  CanBits bits;
  Writer writer(bits);
  const std::uint32_t remote = frame.remote ? 1 : 0;
  writer.put(0, 1);  // start of frame
  if (frame.extended) {
    writer.put(frame.id >> 18, 11);
    writer.put(3, 2);  // SRR, IDE
    writer.put(frame.id & 0x3FFFF, 18);
    writer.put(remote << 2, 3);  // RTR, r1, r0
  } else {
    writer.put(frame.id & 0x7FF, 11);
    writer.put(remote << 2, 3);  // RTR, IDE, r0
  }
  writer.put(frame.length, 4);
  for (int i = 0; !frame.remote && i < frame.length && i < 8; ++i) {
    writer.put(frame.data[static_cast<std::size_t>(i)], 8);
  }
  writer.put_crc();
  return bits;
}

std::uint32_t can_arbitration(const CanFrame& frame) {
  const std::uint32_t remote = frame.remote ? 1 : 0;
  if (!frame.extended) return frame.id << 21 | remote << 20;
  return frame.id >> 18 << 21 | 3u << 19 | (frame.id & 0x3FFFF) << 1 | remote;
}

int can_bit_lost(std::uint32_t winner, std::uint32_t loser) {
  return std::countl_zero(winner ^ loser);
}

}  // namespace whirl::io
