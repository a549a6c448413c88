// Fuzzes the text that a board's process is started with.
#include <tuple>

#include "io_bridges/board_description/board_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  std::ignore = whirl::read_board_text(text).ok();
  return 0;
}
