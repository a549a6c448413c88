// Fuzzes vehicle files, with the propeller that they name.
#include "harness/catalogue/vehicle_file.hpp"
#include "harness/fuzz/input_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::ignore = whirl::catalogue::read_vehicle(whirl::fuzz::path_of(data, size)).ok();
  return 0;
}
