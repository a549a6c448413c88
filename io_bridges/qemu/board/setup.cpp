// From a board's description and its images to what a board process is made of.
#include "base/text.hpp"
#include "io_bridges/qemu/board/board.hpp"

namespace whirl::board {
namespace {

Error wrong_start(const BoardConfig& board, std::uint32_t start) {
  return {ErrorKind::bad_input, board.board + ": start", hex(start) + " is no place in flash",
          "give a multiple of 0x200"};
}

}  // namespace

Result<Setup> read_setup(std::string_view board_json) {
  auto config = parse_board(board_json);
  if (!config) return config.error();
  const Part* part = find_part(config.value().mcu);
  if (part == nullptr) {
    return Error{ErrorKind::bad_input, config.value().board,
                 "unknown mcu '" + config.value().mcu + "'", "use stm32f405rg or stm32f103cb"};
  }
  const bool errors = config.value().hsi_error != 0.0 || config.value().hse_error != 0.0;
  if (errors && !part->oscillators) {
    return Error{ErrorKind::bad_input, config.value().board + ": hsi_error, hse_error",
                 config.value().mcu + " has no oscillators", ""};
  }
  auto image = load_image(config.value().image, *part);
  if (!image) return image.error();
  const BoardConfig& board = config.value();
  if (!board.boot_image.empty()) {
    auto boot = load_image(board.boot_image, *part);
    if (!boot) return boot.error();
    const auto added = image.value().add(std::move(boot.value()), board.boot_image);
    if (!added) return added.error();
  }
  const std::uint32_t start = board.start != 0 ? board.start : part->flash.base;
  if (start % 0x200 != 0 || start - part->flash.base >= part->flash.size) {
    return wrong_start(board, start);
  }
  if (auto good = check_start(image.value(), board.image, start); !good) return good.error();
  return Setup{std::move(config.value()), part, std::move(image.value())};
}

}  // namespace whirl::board
