// CAN 2.0 A and B as bits on the wire. Source: Bosch CAN specification 2.0, parts A and B, section 3.1 (frames), 5 (stuffing).
#include "io_bridges/copper/wire_drawing.hpp"

namespace whirl::copper {
namespace {

constexpr int kBase_bits = 11, kExtended_bits = 18, kCrc_bits = 15, kEqual_bits = 5, kFlag_bits = 6;
constexpr std::int64_t kIntermission_bits = 3;
constexpr std::uint32_t kPolynomial = 0x4599;

struct Bits {
  std::vector<bool> all = {};

  void add(std::uint32_t value, int count) {
    for (int i = count - 1; i >= 0; --i) all.push_back((value >> i & 1) != 0);
  }
};

std::uint32_t crc_of(const std::vector<bool>& bits) {
  std::uint32_t crc = 0;
  for (const bool bit : bits) {
    const bool next = bit != ((crc >> 14 & 1) != 0);
    crc = crc << 1 & 0x7FFF;
    if (next) crc ^= kPolynomial;
  }
  return crc;
}

}  // namespace

std::vector<bool> can_bits(const io::CanMessage& frame) {
  const bool extended = (frame.flags & 1) != 0, remote = (frame.flags & 2) != 0;
  Bits bits;
  bits.add(0, 1);  // start of frame
  if (extended) {
    bits.add(frame.id >> kExtended_bits, kBase_bits);
    bits.add(3, 2);  // substitute remote request, identifier extension
    bits.add(frame.id, kExtended_bits);
  } else {
    bits.add(frame.id, kBase_bits);
  }
  bits.add(remote ? 1 : 0, 1);
  bits.add(0, 2);
  bits.add(frame.length, 4);
  for (int i = 0; !remote && i < frame.length && i < 8; ++i) bits.add(frame.data[i], 8);
  bits.add(crc_of(bits.all), kCrc_bits);
  std::vector<bool> stuffed;
  int equal = 0;
  for (const bool bit : bits.all) {
    equal = !stuffed.empty() && stuffed.back() == bit ? equal + 1 : 1;
    stuffed.push_back(bit);
    if (equal < kEqual_bits) continue;
    stuffed.push_back(!bit);
    equal = 1;
  }
  return stuffed;
}

void draw_can(const io::CanRecord& frame, std::int64_t end_ns, std::uint16_t wire,
              std::vector<Edge>& edges) {
  const std::int64_t passed_ns = end_ns - frame.start_ns;
  const std::int64_t bit_ns = (frame.busy_ns - passed_ns) / kIntermission_bits;
  if (bit_ns <= 0) return;
  std::vector<bool> bits = can_bits(frame.frame);
  if (frame.error == 0) {
    bits.insert(bits.end(), {true, false, true});  // somebody has acknowledged it
  } else {
    bits.resize(frame.bit, true);
    bits.insert(bits.end(), kFlag_bits, false);
    bits.push_back(true);
  }
  for (std::size_t i = 0; i < bits.size(); ++i) {
    edges.push_back({frame.start_ns + static_cast<std::int64_t>(i) * bit_ns, wire, bits[i]});
  }
}

}  // namespace whirl::copper
