// Fuzzes board files, up to what the board's process reads of them.
#include "harness/catalogue/board_file.hpp"
#include "harness/fuzz/input_file.hpp"
#include "io_bridges/board_description/board_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto board = whirl::read_board(whirl::fuzz::path_of(data, size));
  if (!board) return 0;
  const std::string text = whirl::board_text({board.value(), {.image = "flight.elf"}});
  WHIRL_CHECK(whirl::read_board_text(text).ok(), text);
  return 0;
}
