// Fuzzes the stand's data of a calibration: what is read is written and
// read again as the same, and whatever it is, the fit ends.
#include "harness/calibrate/data_file.hpp"
#include "harness/calibrate/report.hpp"
#include "harness/fuzz/input_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace whirl;
  const auto read = calibrate::read_data(fuzz::path_of(data, size));
  if (!read) return 0;
  const std::string text = calibrate::data_text(read.value());
  const auto again = calibrate::read_data(
      fuzz::path_of(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  WHIRL_CHECK(again.ok(), again.ok() ? "" : again.error().message());
  WHIRL_CHECK(calibrate::data_text(again.value()) == text);
  std::ignore = calibrate::identify(read.value()).ok();
  return 0;
}
