// Fuzzes the JSON that a board's process is started with.
#include <tuple>

#include "io_bridges/qemu/board/config.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  std::ignore = whirl::board::parse_board(text).ok();
  return 0;
}
