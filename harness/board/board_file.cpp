#include "harness/board/board_file.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "harness/lua/table.hpp"

namespace whirl {
namespace {

using nlohmann::json;

constexpr lua::Range kBaud{.low = 50.0, .high = 12e6};

// Any value of a table as JSON: quantities in SI, other texts as they are.
json passed_through(const lua::Table& table) {
  json out = json::object();
  for (const std::string& key : table.keys()) {
    switch (table.kind(key)) {
      case lua::Kind::text: {
        const std::string text = table.text(key);
        const auto quantity = parse_quantity(text, "");
        out[key] = quantity ? json(quantity.value().value_SI) : json(text);
        break;
      }
      case lua::Kind::number:
        out[key] = table.number(key);
        break;
      case lua::Kind::flag:
        out[key] = table.flag_or(key, false);
        break;
      case lua::Kind::table: {
        const lua::Table inner = table.table(key);
        out[key] = inner.size() > 0 ? json(table.numbers(key)) : passed_through(inner);
        break;
      }
    }
  }
  return out;
}

// What goes to the board's process goes as JSON, which is UTF-8.
std::string dumped(const lua::Table& t, const char* key, const json& value) {
  try {
    return value.dump();
  } catch (const json::exception&) {
    t.refuse(key, "is not UTF-8 text");
    return "null";
  }
}

BoardDevice read_device(const lua::Table& t) {
  BoardDevice device;
  json entry = json::object();
  entry["name"] = device.name = t.text("name");
  entry["type"] = device.type = t.text("type");
  entry["bus"] = device.bus = t.text("bus");
  if (t.has("address")) {
    entry["address"] = device.address = static_cast<int>(t.integer("address", 0x08, 0x77));
  }
  if (t.has("motor")) entry["motor"] = device.motor = static_cast<int>(t.integer("motor", 1, 4));
  if (t.has("cs")) entry["cs"] = t.text("cs");
  if (t.has("int")) entry["int"] = t.text("int");
  if (t.has("baud")) entry["baud"] = t.quantity("baud", Dimension::baud, kBaud);
  entry["params"] = t.has("params") ? passed_through(t.table("params")) : json::object();
  device.cs = entry.value("cs", "");
  device.interrupt = entry.value("int", "");
  device.json = dumped(t, "name", entry);
  return device;
}

// Is the pin this device's own? A jumper only listens at its `cs`.
bool drives(const BoardDevice& device, const std::string& pin) {
  if (pin.empty()) return false;
  const bool on_pin = device.type == "pulse_source" || device.type == "volts";
  return (on_pin && device.bus == pin) || device.interrupt == pin ||
         (device.type != "jumper" && device.cs == pin);
}

json read_pins(const lua::Table& file) {
  json pins = json::array();
  for (const lua::Table& entry : file.tables("pins")) {
    json pin = {{"name", entry.text("name")}, {"pin", entry.text("pin")}};
    if (entry.has("pull")) pin["pull"] = entry.choice("pull", {"up", "down"});
    if (entry.has("bus")) pin["bus"] = entry.text("bus");
    for (const json& other : pins) {
      if (other["name"] == pin["name"]) entry.refuse("name", "two pins are called so");
      if (other["pin"] == pin["pin"]) entry.refuse("pin", "is listed twice");
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
      for (const std::string* pin : {&a.cs, &a.interrupt, &a.bus}) {
        if (drives(b, *pin) && drives(a, *pin)) {
          file.refuse("devices", a.name + " and " + b.name + " are on one pin, " + *pin);
        }
      }
      if (a.address != -1 && a.bus == b.bus && a.address == b.address) {
        file.refuse("devices", a.name + " and " + b.name + " share one address on " + a.bus);
      }
    }
  }
}

}  // namespace

const BoardDevice* Board::find(const std::string& device) const {
  const int i = number(device);
  return i < 0 ? nullptr : &devices[static_cast<std::size_t>(i)];
}

int Board::number(const std::string& device) const {
  const auto it = std::find_if(devices.begin(), devices.end(),
                               [&](const BoardDevice& d) { return d.name == device; });
  return it == devices.end() ? -1 : static_cast<int>(it - devices.begin());
}

int Board::watch_number(const std::string& function) const {
  const auto it = std::find(watch.begin(), watch.end(), function);
  return it == watch.end() ? -1 : static_cast<int>(it - watch.begin());
}

std::string Board::timing_profile() const {
  char text[80];
  std::snprintf(text, sizeof text, "crystal ready after %g ms", hse_start_s * 1e3);
  std::string clocks = text;
  if (hse_error != 0) {
    std::snprintf(text, sizeof text, ", %+g ppm off", hse_error * 1e6);
    clocks += text;
  }
  if (hsi_error != 0) {
    std::snprintf(text, sizeof text, ", HSI %+g %% off", hsi_error * 1e2);
    clocks += text;
  }
  const std::string rate = ns_per_instruction == 0
                               ? "CPU cycles (+-10 %)"
                               : std::to_string(ns_per_instruction) + " ns per instruction";
  return rate + ", " + clocks;
}

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
  board.hse_start_s =
      t.quantity_or("hse_start", Dimension::time, board.hse_start_s, lua::between(1e-6, 1.0));
  board.hsi_error = t.quantity_or("hsi_error", Dimension::ratio, 0.0, lua::between(-0.05, 0.05));
  board.hse_error = t.quantity_or("hse_error", Dimension::ratio, 0.0, lua::between(-1e-3, 1e-3));
  if (t.has("boot_image")) board.boot_image = t.sibling(t.text("boot_image"));
  board.start = static_cast<std::uint32_t>(t.integer_or("start", 0, 0, 0xFFFFFFFF));
  if (t.text_or("timing", "cycles") != "cycles") {
    const double ns = t.quantity("timing", Dimension::time, lua::between(1e-9, 512e-9)) * 1e9;
    board.ns_per_instruction = static_cast<int>(std::lround(ns));
    const bool of_qemu = std::has_single_bit(static_cast<unsigned>(board.ns_per_instruction));
    if (!of_qemu || std::abs(ns - board.ns_per_instruction) > 1e-6) {
      t.refuse("timing", "is neither \"cycles\" nor a power of two of nanoseconds");
    }
  }
  for (const lua::Table& entry : t.tables("devices")) board.devices.push_back(read_device(entry));
  board.pins_json = dumped(t, "pins", read_pins(t));
  board.watch = t.texts("watch");
  dumped(t, "watch", json(board.watch));
  dumped(t, "board", json(board.name));
  dumped(t, "mcu", json(board.mcu));
  refuse_doubles(t, board);
  if (auto good = t.finish(); !good) return good.error();
  return board;
}

std::string board_json(const Board& board, const BoardRun& run) {
  json out;
  out["board"] = board.name;
  out["mcu"] = board.mcu;
  out["hse_Hz"] = board.hse_Hz;
  out["lse_Hz"] = board.lse_Hz;
  out["hse_start_ns"] = std::llround(board.hse_start_s * 1e9);
  out["hsi_error"] = board.hsi_error;
  out["hse_error"] = board.hse_error;
  out["boot_image"] = board.boot_image;
  out["start"] = board.start;
  out["image"] = run.image;
  out["ns_per_instruction"] = board.ns_per_instruction;
  out["seed"] = run.seed;
  out["sync_ns"] = run.sync_ns;
  out["devices"] = json::array();
  for (const BoardDevice& device : board.devices)
    out["devices"].push_back(json::parse(device.json));
  out["pins"] = json::parse(board.pins_json);
  out["watch"] = board.watch;
  out["gdb"] = run.gdb;
  out["gdb_port"] = run.gdb_port;
  // A path may hold any bytes: what is no UTF-8 becomes a name that is not found, and is shown.
  return out.dump(1, ' ', false, json::error_handler_t::replace);
}

}  // namespace whirl
