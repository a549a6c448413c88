#include "harness/catalogue/board_file.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>

#include "base/text.hpp"
#include "harness/catalogue/device_entry.hpp"
#include "harness/lua/table.hpp"

namespace whirl {
namespace {

// What the board's process is told is JSON, which is UTF-8.
void refuse_other_bytes(const lua::Table& t, const char* key, const std::string& text) {
  if (legal_text(text) != text) t.refuse(key, "is not plain UTF-8 text");
}

// "boards/esc.lua:12" of an entry.
std::string line_of(const lua::Table& entry) {
  const std::string place = entry.place("name");
  return place.substr(0, place.rfind(": "));
}

// Plans speak of it: as "esc1", "NODE/esc1", and of all ESCs as "esc".
void check_name(const lua::Table& entry, const char* key, const std::string& name) {
  refuse_other_bytes(entry, key, name);
  const bool odd = std::any_of(name.begin(), name.end(), [](char c) {
    return c == '/' || std::iscntrl(static_cast<unsigned char>(c)) != 0;
  });
  if (odd) entry.refuse(key, "has a '/' or what no line shows", "letters, digits and '_' are well");
  if (name == "esc") entry.refuse(key, "'esc' means every ESC of a board", "call it esc1");
}

std::vector<BoardPin> read_pins(const lua::Table& file) {
  std::vector<BoardPin> pins;
  for (const lua::Table& entry : file.tables("pins")) {
    BoardPin pin{.name = entry.text("name"), .pin = entry.text("pin")};
    if (entry.has("pull")) pin.pull = entry.choice("pull", {"up", "down"});
    if (entry.has("bus")) pin.bus = entry.text("bus");
    check_name(entry, "name", pin.name);
    refuse_other_bytes(entry, "pin", pin.pin + pin.bus);
    pin.place = line_of(entry);
    for (const BoardPin& other : pins) {
      if (other.name == pin.name) entry.refuse("name", "two pins are called so");
      if (other.pin == pin.pin) entry.refuse("pin", "is listed twice");
    }
    pins.push_back(pin);
  }
  return pins;
}

void read_devices(const lua::Table& file, const rack::DeviceTypes& types, BoardDescription& board) {
  const std::vector<lua::Table> entries = file.tables("devices");
  for (const lua::Table& entry : entries) {
    board.devices.push_back(read_device(entry, types));
    check_name(entry, "name", board.devices.back().name);
    board.devices.back().place = line_of(entry);
  }
  if (const auto wrong = rack::check_sharing(board, types)) {
    refuse(entries[static_cast<std::size_t>(wrong->device)], *wrong);
  }
}

}  // namespace

Result<BoardDescription> read_board(const std::string& path, const rack::DeviceTypes& types) {
  const auto file = lua::read_file(path);
  if (!file) return file.error();
  const lua::Table& t = file.value();
  BoardDescription board;
  board.file = path;
  board.name = t.text("board");
  board.mcu = t.text("mcu");
  board.hse_Hz =
      t.quantity("hse", Dimension::frequency, {.low = 0.0, .high = 50e6, .low_open = true});
  board.lse_Hz = t.quantity_or("lse", Dimension::frequency, 0.0, lua::at_least(0.0));
  board.hse_start_ns = std::llround(
      t.quantity_or("hse_start", Dimension::time, 2e-3, lua::between(1e-6, 1.0)) * 1e9);
  board.hsi_error = t.quantity_or("hsi_error", Dimension::ratio, 0.0, lua::between(-0.05, 0.05));
  board.hse_error = t.quantity_or("hse_error", Dimension::ratio, 0.0, lua::between(-1e-3, 1e-3));
  if (t.has("boot_image")) board.boot_image = t.sibling(t.text("boot_image"));
  board.start = static_cast<std::uint32_t>(t.integer_or("start", 0, 0, 0xFFFFFFFF));
  if (t.text_or("timing", "cycles") != "cycles") {
    const double ns = t.quantity("timing", Dimension::time, lua::between(1e-9, 512e-9)) * 1e9;
    board.ns_per_instruction = std::llround(ns);
    const bool of_qemu = std::has_single_bit(static_cast<std::uint64_t>(board.ns_per_instruction));
    if (!of_qemu || std::abs(ns - std::llround(ns)) > 1e-6) {
      t.refuse("timing", "is neither \"cycles\" nor a power of two of nanoseconds");
    }
  }
  board.pins = read_pins(t);
  read_devices(t, types, board);
  board.watch = t.texts("watch");
  for (const std::string& name : board.watch) {
    refuse_other_bytes(t, "watch", name);
    if (name.empty()) t.refuse("watch", "has an empty name");
  }
  check_name(t, "board", board.name);
  refuse_other_bytes(t, "mcu", board.mcu);
  if (auto good = t.finish(); !good) return good.error();
  return board;
}

}  // namespace whirl
