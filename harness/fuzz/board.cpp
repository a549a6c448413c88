// Fuzzes board files, up to what the board reads of them.
#include "harness/board/board_file.hpp"
#include "harness/fuzz/input_file.hpp"
#include "io_bridges/qemu/board/config.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto board = whirl::read_board(whirl::fuzz::path_of(data, size));
  if (!board) return 0;
  const std::string text = whirl::board_json(board.value(), {.image = "flight.elf"});
  std::ignore = whirl::board::parse_board(text).ok();
  return 0;
}
