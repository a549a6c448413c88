// Fuzzes what a calibration is to measure.
#include "harness/calibrate/setup.hpp"
#include "harness/fuzz/input_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::ignore = whirl::calibrate::read_setup(whirl::fuzz::path_of(data, size)).ok();
  return 0;
}
