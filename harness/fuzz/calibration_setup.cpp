// Fuzzes what a calibration is to measure.
#include "harness/catalogue/calibration_file.hpp"
#include "harness/fuzz/input_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::ignore = whirl::catalogue::read_calibration(whirl::fuzz::path_of(data, size)).ok();
  return 0;
}
