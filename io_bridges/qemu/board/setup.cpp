// From a board's description and its images to what a board process is made of.
#include "base/text.hpp"
#include "io_bridges/board_description/board_text.hpp"
#include "io_bridges/qemu/board/board.hpp"

namespace whirl::board {
namespace {

Error wrong_start(const BoardDescription& board, std::uint32_t start) {
  return {ErrorKind::bad_input, board.name + ": start", hex(start) + " is no place in flash",
          "give a multiple of 0x200"};
}

}  // namespace

Result<Setup> read_setup(std::string_view text) {
  auto told = read_board_text(text);
  if (!told) return told.error();
  const BoardDescription& board = told.value().board;
  const Part* part = find_part(board.mcu);
  if (part == nullptr) {
    return Error{ErrorKind::bad_input, board.name, "unknown mcu '" + board.mcu + "'",
                 "use stm32f405rg or stm32f103cb"};
  }
  const bool errors = board.hsi_error != 0.0 || board.hse_error != 0.0;
  if (errors && !part->oscillators) {
    return Error{ErrorKind::bad_input, board.name + ": hsi_error, hse_error",
                 board.mcu + " has no oscillators", ""};
  }
  auto image = load_image(told.value().run.image, *part);
  if (!image) return image.error();
  if (!board.boot_image.empty()) {
    auto boot = load_image(board.boot_image, *part);
    if (!boot) return boot.error();
    const auto added = image.value().add(std::move(boot.value()), board.boot_image);
    if (!added) return added.error();
  }
  for (const std::string& file : told.value().run.flashed) {
    auto cells = load_image(file, *part);
    if (!cells) return cells.error();
    const auto added = image.value().add(std::move(cells.value()), file);
    if (!added) return added.error();
  }
  const std::uint32_t start = board.start != 0 ? board.start : part->flash.base;
  if (start % 0x200 != 0 || start - part->flash.base >= part->flash.size) {
    return wrong_start(board, start);
  }
  const std::string& file = told.value().run.image;
  if (auto good = check_start(image.value(), file, start); !good) return good.error();
  return Setup{std::move(told.value().board), std::move(told.value().run), part,
               std::move(image.value())};
}

}  // namespace whirl::board
