#include "io_bridges/protocols/dronecan/bits.hpp"

#include <algorithm>

#include "base/check.hpp"

namespace whirl::io::dronecan {

void BitWriter::bits(std::uint64_t value, int count) {
  WHIRL_CHECK(count >= 0 && count <= 64 && static_cast<std::size_t>(count) <= left(), count, at_);
  while (count > 0) {
    const int here = std::min(count, 8);  // of one byte of the value, most significant bit first
    for (int bit = here - 1; bit >= 0; --bit, ++at_) {
      const auto set = static_cast<std::uint8_t>((value >> bit & 1) << (7 - at_ % 8));
      payload_.data[at_ / 8] = static_cast<std::uint8_t>(payload_.data[at_ / 8] | set);
    }
    value >>= here == 8 ? 8 : 0;
    count -= here;
  }
}

std::uint64_t BitReader::bits(int count) {
  WHIRL_CHECK(count >= 0 && count <= 64, count);
  if (!ok_ || static_cast<std::size_t>(count) > left()) {
    ok_ = false;
    return 0;
  }
  std::uint64_t value = 0;
  for (int done = 0; done < count;) {
    const int here = std::min(count - done, 8);
    std::uint64_t byte = 0;
    for (int bit = 0; bit < here; ++bit, ++at_) {
      byte = byte << 1 | (bytes_[at_ / 8] >> (7 - at_ % 8) & 1u);
    }
    value |= byte << done;
    done += here;
  }
  return value;
}

}  // namespace whirl::io::dronecan
