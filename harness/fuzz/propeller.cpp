// Fuzzes propeller files: blades, polars, and the fit of their twist.
#include "harness/catalogue/propeller_file.hpp"
#include "harness/fuzz/input_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::ignore = whirl::catalogue::read_propeller(whirl::fuzz::path_of(data, size)).ok();
  return 0;
}
