// Fuzzes the ESC's messages on I2C: what is taken is packed again as the same bytes.
#include "io_bridges/protocols/esc_codec.hpp"

#include <algorithm>

#include "base/check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace whirl::io;
  if (size == 0) return 0;
  const auto address = static_cast<std::uint8_t>(data[0] & 0x7F);
  const std::span<const std::uint8_t> bytes(data + 1, size - 1);
  if (const auto setpoint = unpack_setpoint(address, bytes)) {
    const auto packed = pack_setpoint(address, *setpoint);
    WHIRL_CHECK(std::equal(packed.begin(), packed.end(), bytes.begin()));
  }
  if (const auto status = unpack_status(address, bytes)) {
    const auto packed = pack_status(address, *status);
    WHIRL_CHECK(std::equal(packed.begin(), packed.end(), bytes.begin()));
  }
  return 0;
}
