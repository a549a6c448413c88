#include "io_bridges/board_description/board_text.hpp"

#include <cmath>
#include <concepts>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "base/json_text.hpp"

namespace whirl {
namespace {

using nlohmann::json;

// JSON's numbers have no range: a cast of one that does not fit is undefined.
template <std::integral T>
bool read_whole(const json& value, T& into) {
  if (value.is_number_unsigned()) {
    const auto whole = value.get<std::uint64_t>();
    into = static_cast<T>(whole);
    return std::in_range<T>(whole);
  }
  if (value.is_number_integer()) {
    const auto whole = value.get<std::int64_t>();
    into = static_cast<T>(whole);
    return std::in_range<T>(whole);
  }
  constexpr double kExact = 9007199254740992.0;  // 2^53
  const double number = value.is_number() ? value.get<double>() : NAN;
  if (!(std::abs(number) <= kExact) || number != std::floor(number)) return false;
  const auto whole = static_cast<std::int64_t>(number);
  into = static_cast<T>(whole);
  return std::in_range<T>(whole);
}

// A text of the user's may be long, and no UTF-8.
std::string shown(const json& value) {
  return text_of(value, -1, NoUtf8::replace).substr(0, 40);
}

// One object: which keys were asked for, and the first thing in the text that is wrong.
class Keys {
 public:
  Keys(const json& object, std::string place, Error& first)
      : object_(object), place_(std::move(place)), first_(first) {}

  template <typename T>
  void read(const char* key, T& into) {
    asked_.insert(key);
    const auto found = object_.find(key);
    if (found == object_.end()) return;
    if constexpr (std::same_as<T, bool>) {
      if (!found->is_boolean()) return fail(key, "has the wrong type: " + shown(*found));
      into = found->get<bool>();
    } else if constexpr (std::integral<T>) {
      if (!read_whole(*found, into)) {
        fail(key, "is not a whole number in range: " + shown(*found));
      }
    } else if constexpr (std::floating_point<T>) {
      if (!found->is_number()) return fail(key, "has the wrong type: " + shown(*found));
      into = found->get<T>();
    } else {
      if (!found->is_string()) return fail(key, "has the wrong type: " + shown(*found));
      into = found->get<T>();
    }
  }
  const json& list(const char* key) {
    static const json kNone = json::array();
    asked_.insert(key);
    const auto found = object_.find(key);
    if (found == object_.end()) return kNone;
    if (found->is_array()) return *found;
    fail(key, "is not a list");
    return kNone;
  }
  std::vector<std::string> others() const {
    std::vector<std::string> keys;
    for (const auto& [key, value] : object_.items()) {
      if (asked_.count(key) == 0) keys.push_back(key);
    }
    return keys;
  }
  void refuse_others() {
    for (const std::string& key : others()) fail(key.substr(0, 40), "is no key");
  }
  void fail(const std::string& key, const std::string& what) {
    if (first_.what.empty()) first_ = {ErrorKind::bad_input, place_ + key, what, ""};
  }

 private:
  const json& object_;
  std::string place_;
  Error& first_;
  std::set<std::string> asked_;
};

template <typename T>
bool read_items(const json& value, bool (json::*is)() const noexcept, KeyValue& into) {
  std::vector<T> items;
  for (const json& item : value) {
    if (!(item.*is)()) return false;
    items.push_back(item.get<T>());
  }
  into = std::move(items);
  return true;
}

bool read_value(const json& value, KeyValue& into) {
  if (value.is_boolean()) return into = value.get<bool>(), true;
  if (value.is_number()) return into = value.get<double>(), true;
  if (value.is_string()) return into = value.get<std::string>(), true;
  if (!value.is_array()) return false;
  if (!value.empty() && value[0].is_string()) {
    return read_items<std::string>(value, &json::is_string, into);
  }
  return read_items<double>(value, &json::is_number, into);
}

BoardDevice read_device(const json& object, const std::string& place, Error& first) {
  Keys keys(object, place, first);
  BoardDevice device;
  keys.read("name", device.name);
  keys.read("type", device.type);
  keys.read("place", device.place);
  for (const json& sense : keys.list("senses")) {
    if (sense.is_string()) device.senses.push_back(sense.get<std::string>());
    if (!sense.is_string()) keys.fail("senses", "is not a list of names");
  }
  if (device.name.empty()) keys.fail("name", "is missing");
  if (device.type.empty()) keys.fail("type", "is missing");
  for (const std::string& path : keys.others()) {
    KeyValue value;
    if (!read_value(object[path], value) || !device.set(path, std::move(value))) {
      keys.fail(path.substr(0, 40), "has the wrong type: " + shown(object[path]));
    }
  }
  return device;
}

BoardPin read_pin(const json& object, const std::string& place, Error& first) {
  Keys keys(object, place, first);
  BoardPin pin;
  keys.read("name", pin.name);
  keys.read("pin", pin.pin);
  keys.read("pull", pin.pull);
  keys.read("bus", pin.bus);
  keys.read("place", pin.place);
  keys.refuse_others();
  return pin;
}

WireEnd read_wire(const json& object, const std::string& place, Error& first) {
  Keys keys(object, place, first);
  WireEnd wire;
  keys.read("device", wire.device);
  keys.read("bus", wire.bus);
  keys.read("fd", wire.fd);
  keys.read("port", wire.port);
  keys.read("shared", wire.shared);
  keys.read("select", wire.select);
  keys.read("ready", wire.ready);
  keys.read("latency_ns", wire.latency_ns);
  keys.read("arbitrates", wire.arbitrates);
  keys.read("far", wire.far);
  keys.refuse_others();
  return wire;
}

void read_texts(Keys& keys, const char* key, std::vector<std::string>& into) {
  for (const json& entry : keys.list(key)) {
    if (entry.is_string()) {
      into.push_back(entry.get<std::string>());
    } else {
      keys.fail(key, "is not a list of names");
    }
  }
}

template <typename T, typename Read>
void read_objects(Keys& keys, const char* key, std::vector<T>& into, Error& first, Read read) {
  for (const json& entry : keys.list(key)) {
    const std::string place = std::string(key) + "[" + std::to_string(into.size()) + "].";
    if (!entry.is_object()) return keys.fail(place, "is not an object");
    into.push_back(read(entry, place, first));
  }
}

void check(const BoardStart& start, Keys& keys) {
  const BoardDescription& board = start.board;
  if (start.run.image.empty()) keys.fail("image", "is missing");
  if (!(board.hse_Hz >= 0.0 && board.hse_Hz <= 50e6)) keys.fail("hse_Hz", "is outside 0..50 MHz");
  if (!(std::abs(board.hsi_error) <= 0.05)) keys.fail("hsi_error", "is outside +-5 %");
  if (!(std::abs(board.hse_error) <= 1e-3)) keys.fail("hse_error", "is outside +-1000 ppm");
  if (board.hse_error != 0.0 && board.hse_Hz == 0.0) {
    keys.fail("hse_error", "is of a crystal that is not fitted");
  }
  if (board.hse_start_ns < 0) keys.fail("hse_start_ns", "is negative");
  if (board.ns_per_instruction < 0) keys.fail("ns_per_instruction", "is negative");
}

json json_of(const BoardDevice& device) {
  json out = {{"name", device.name},
              {"type", device.type},
              {"place", device.place},
              {"senses", device.senses}};
  for (const std::string& path : device.paths()) {
    std::visit([&](const auto& value) { out[path] = value; }, *device.value(path));
  }
  return out;
}

}  // namespace

std::string board_text(const BoardStart& start) {
  const BoardDescription& board = start.board;
  json out = {{"file", board.file},
              {"board", board.name},
              {"mcu", board.mcu},
              {"hse_Hz", board.hse_Hz},
              {"lse_Hz", board.lse_Hz},
              {"hse_start_ns", board.hse_start_ns},
              {"hsi_error", board.hsi_error},
              {"hse_error", board.hse_error},
              {"boot_image", board.boot_image},
              {"start", board.start},
              {"ns_per_instruction", board.ns_per_instruction},
              {"image", start.run.image},
              {"seed", start.run.seed},
              {"gdb_port", start.run.gdb_port},
              {"folder", start.run.folder},
              {"node", start.run.node},
              {"flashed", start.run.flashed},
              {"wires", json::array()},
              {"devices", json::array()},
              {"pins", json::array()},
              {"watch", board.watch}};
  for (const BoardDevice& device : board.devices) out["devices"].push_back(json_of(device));
  for (const WireEnd& wire : start.run.wires) {
    out["wires"].push_back({{"device", wire.device},
                            {"bus", wire.bus},
                            {"fd", wire.fd},
                            {"port", wire.port},
                            {"shared", wire.shared},
                            {"select", wire.select},
                            {"ready", wire.ready},
                            {"latency_ns", wire.latency_ns},
                            {"arbitrates", wire.arbitrates},
                            {"far", wire.far}});
  }
  for (const BoardPin& pin : board.pins) {
    out["pins"].push_back({{"name", pin.name},
                           {"pin", pin.pin},
                           {"pull", pin.pull},
                           {"bus", pin.bus},
                           {"place", pin.place}});
  }
  return text_of(out, 1, NoUtf8::replace);
}

Result<BoardStart> read_board_text(std::string_view text) {
  const json top = parse_json(text);
  if (!top.is_object()) return Error{ErrorKind::bad_input, "board", "is not a JSON object", ""};
  Error first;
  Keys keys(top, "", first);
  BoardStart start;
  BoardDescription& board = start.board;
  keys.read("file", board.file);
  keys.read("board", board.name);
  keys.read("mcu", board.mcu);
  keys.read("hse_Hz", board.hse_Hz);
  keys.read("lse_Hz", board.lse_Hz);
  keys.read("hse_start_ns", board.hse_start_ns);
  keys.read("hsi_error", board.hsi_error);
  keys.read("hse_error", board.hse_error);
  keys.read("boot_image", board.boot_image);
  keys.read("start", board.start);
  keys.read("ns_per_instruction", board.ns_per_instruction);
  keys.read("image", start.run.image);
  keys.read("seed", start.run.seed);
  keys.read("gdb_port", start.run.gdb_port);
  keys.read("folder", start.run.folder);
  keys.read("node", start.run.node);
  read_objects(keys, "devices", board.devices, first, read_device);
  read_objects(keys, "pins", board.pins, first, read_pin);
  read_objects(keys, "wires", start.run.wires, first, read_wire);
  read_texts(keys, "flashed", start.run.flashed);
  read_texts(keys, "watch", board.watch);
  keys.refuse_others();
  check(start, keys);
  if (first.what.empty()) return start;
  first.place = (board.name.empty() ? "board" : board.name) + ": " + first.place;
  return first;
}

}  // namespace whirl
