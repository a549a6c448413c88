#include "harness/board/board_file.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/text.hpp"
#include "harness/lua/table.hpp"

namespace whirl {
namespace {

constexpr lua::Range kBaud{.low = 50.0, .high = 12e6};

// Any value of a table: quantities in SI, other texts as they are; inner tables by their path.
void pass_through(const lua::Table& table, const std::string& prefix, BoardDevice& device) {
  for (const std::string& key : table.keys()) {
    const std::string path = prefix + key;
    switch (table.kind(key)) {
      case lua::Kind::text: {
        const std::string text = table.text(key);
        const auto quantity = parse_quantity(text, "");
        device.set(path, quantity ? KeyValue(quantity.value().value_SI) : KeyValue(text));
        break;
      }
      case lua::Kind::number:
        device.set(path, table.number(key));
        break;
      case lua::Kind::flag:
        device.set(path, table.flag_or(key, false));
        break;
      case lua::Kind::table: {
        const lua::Table inner = table.table(key);
        if (inner.size() > 0) {
          device.set(path, table.numbers(key));
        } else {
          pass_through(inner, path + ".", device);
        }
        break;
      }
    }
  }
}

// What the board's process is told is JSON, which is UTF-8.
void refuse_other_bytes(const lua::Table& t, const char* key, const std::string& text) {
  if (legal_text(text) != text) t.refuse(key, "is not plain UTF-8 text");
}

BoardDevice read_device(const lua::Table& t) {
  BoardDevice device;
  device.name = t.text("name");
  device.type = t.text("type");
  device.bus = t.text("bus");
  refuse_other_bytes(t, "name", device.name + device.type + device.bus);
  if (t.has("address")) device.address = static_cast<int>(t.integer("address", 0x08, 0x77));
  if (t.has("motor")) device.motor = static_cast<int>(t.integer("motor", 1, 4));
  if (t.has("cs")) device.set("cs", t.text("cs"));
  if (t.has("int")) device.set("int", t.text("int"));
  if (t.has("baud")) device.set("baud", t.quantity("baud", Dimension::baud, kBaud));
  if (t.has("params")) pass_through(t.table("params"), "params.", device);
  return device;
}

std::string pin_at(const BoardDevice& device, const char* key) {
  const auto value = device.value(key);
  return value ? std::get<std::string>(*value) : "";
}

// Is the pin this device's own? A jumper only listens at its `cs`.
bool drives(const BoardDevice& device, const std::string& pin) {
  if (pin.empty()) return false;
  const bool on_pin = device.type == "pulse_source" || device.type == "volts";
  return (on_pin && device.bus == pin) || pin_at(device, "int") == pin ||
         (device.type != "jumper" && pin_at(device, "cs") == pin);
}

std::vector<BoardPin> read_pins(const lua::Table& file) {
  std::vector<BoardPin> pins;
  for (const lua::Table& entry : file.tables("pins")) {
    BoardPin pin{.name = entry.text("name"), .pin = entry.text("pin")};
    if (entry.has("pull")) pin.pull = entry.choice("pull", {"up", "down"});
    if (entry.has("bus")) pin.bus = entry.text("bus");
    refuse_other_bytes(entry, "name", pin.name + pin.pin + pin.bus);
    for (const BoardPin& other : pins) {
      if (other.name == pin.name) entry.refuse("name", "two pins are called so");
      if (other.pin == pin.pin) entry.refuse("pin", "is listed twice");
    }
    pins.push_back(pin);
  }
  return pins;
}

void refuse_doubles(const lua::Table& file, const Board& board) {
  for (const BoardDevice& b : board.devices) {
    for (const BoardDevice& a : board.devices) {
      if (&a == &b) break;  // each pair once
      if (a.name == b.name) file.refuse("devices", "two devices are called '" + a.name + "'");
      for (const std::string& pin : {pin_at(a, "cs"), pin_at(a, "int"), a.bus}) {
        if (drives(b, pin) && drives(a, pin)) {
          file.refuse("devices", a.name + " and " + b.name + " are on one pin, " + pin);
        }
      }
      if (a.address != -1 && a.bus == b.bus && a.address == b.address) {
        file.refuse("devices", a.name + " and " + b.name + " share one address on " + a.bus);
      }
    }
  }
}

}  // namespace

Result<Board> read_board(const std::string& path) {
  const auto file = lua::read_file(path);
  if (!file) return file.error();
  const lua::Table& t = file.value();
  Board board;
  board.file = path;
  board.name = t.text("board");
  board.mcu = t.text("mcu");
  board.hse_Hz = t.quantity("hse", Dimension::frequency, lua::above(0.0));
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
  for (const lua::Table& entry : t.tables("devices")) board.devices.push_back(read_device(entry));
  board.pins = read_pins(t);
  board.watch = t.texts("watch");
  for (const std::string& name : board.watch) refuse_other_bytes(t, "watch", name);
  refuse_other_bytes(t, "board", board.name);
  refuse_other_bytes(t, "mcu", board.mcu);
  refuse_doubles(t, board);
  if (auto good = t.finish(); !good) return good.error();
  return board;
}

}  // namespace whirl
