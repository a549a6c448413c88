// Fuzzes .polar files.
#include <tuple>

#include "plant/rotor/polar.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  std::ignore = whirl::plant::read_polar(text, "fuzz.polar").ok();
  return 0;
}
