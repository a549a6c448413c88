#include "io_bridges/qemu/board/config.hpp"

#include <cmath>
#include <concepts>
#include <nlohmann/json.hpp>
#include <utility>

namespace whirl::board {
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

// Walks objects and remembers the first thing that is wrong.
class Keys {
 public:
  template <typename T>
  void read(const json& object, const char* key, const std::string& place, T& into) {
    const auto found = object.find(key);
    if (found == object.end() || failed()) return;
    if constexpr (std::integral<T>) {
      if (read_whole(*found, into)) return;
      fail(place + key, "is not a whole number in range: " + found->dump().substr(0, 40));
    } else {
      try {
        into = found->get<T>();
      } catch (const json::exception&) {
        fail(place + key, "has the wrong type: " + found->dump().substr(0, 40));
      }
    }
  }
  void fail(const std::string& place, const std::string& what) {
    if (!failed()) error_ = {ErrorKind::bad_input, place, what, ""};
  }
  bool failed() const { return !error_.what.empty(); }
  const Error& error() const { return error_; }

 private:
  Error error_;
};

void flatten(const json& value, const std::string& name, std::map<std::string, double>& into) {
  if (value.is_number()) into[name] = value.get<double>();
  if (value.is_boolean()) into[name] = value.get<bool>() ? 1.0 : 0.0;
  if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      flatten(value[i], name + "." + std::to_string(i), into);
    }
  }
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) {
      flatten(inner, name.empty() ? key : name + "." + key, into);
    }
  }
}

DeviceConfig read_device(Keys& keys, const json& object, const std::string& place) {
  DeviceConfig device;
  keys.read(object, "name", place, device.name);
  keys.read(object, "type", place, device.type);
  keys.read(object, "bus", place, device.bus);
  keys.read(object, "cs", place, device.cs);
  keys.read(object, "int", place, device.interrupt);
  keys.read(object, "address", place, device.address);
  keys.read(object, "motor", place, device.motor);
  keys.read(object, "baud", place, device.baud);
  if (object.contains("params")) flatten(object["params"], "", device.params);
  if (device.name.empty()) keys.fail(place + "name", "is missing");
  if (device.type.empty()) keys.fail(place + "type", "is missing");
  return device;
}

const json& list_of(Keys& keys, const json& top, const char* key) {
  static const json kNone = json::array();
  const auto found = top.find(key);
  if (found == top.end()) return kNone;
  if (found->is_array()) return *found;
  if (!found->is_object() || !found->empty()) keys.fail(key, "is not a list");  // {}: empty in Lua
  return kNone;
}

void read_lists(Keys& keys, const json& top, BoardConfig& config) {
  int n = 0;
  for (const json& entry : list_of(keys, top, "devices")) {
    const std::string place = "devices[" + std::to_string(n++) + "].";
    if (!entry.is_object()) return keys.fail(place, "is not an object");
    config.devices.push_back(read_device(keys, entry, place));
  }
  n = 0;
  for (const json& entry : list_of(keys, top, "pins")) {
    const std::string place = "pins[" + std::to_string(n++) + "].";
    if (!entry.is_object()) return keys.fail(place, "is not an object");
    PinConfig pin;
    keys.read(entry, "name", place, pin.name);
    keys.read(entry, "pin", place, pin.pin);
    keys.read(entry, "pull", place, pin.pull);
    keys.read(entry, "bus", place, pin.bus);
    config.pins.push_back(pin);
  }
  for (const json& entry : list_of(keys, top, "watch")) {
    if (!entry.is_string()) return keys.fail("watch", "is not a list of names");
    config.watch.push_back(entry.get<std::string>());
  }
}

}  // namespace

Result<BoardConfig> parse_board(std::string_view json_text) {
  const json top = json::parse(json_text, nullptr, false);
  if (!top.is_object()) return Error{ErrorKind::bad_input, "board", "is not a JSON object", ""};
  Keys keys;
  BoardConfig config;
  keys.read(top, "board", "", config.board);
  keys.read(top, "mcu", "", config.mcu);
  keys.read(top, "image", "", config.image);
  keys.read(top, "hse_Hz", "", config.hse_Hz);
  keys.read(top, "hse_start_ns", "", config.hse_start_ns);
  keys.read(top, "lse_Hz", "", config.lse_Hz);
  keys.read(top, "hsi_error", "", config.hsi_error);
  keys.read(top, "hse_error", "", config.hse_error);
  keys.read(top, "boot_image", "", config.boot_image);
  keys.read(top, "start", "", config.start);
  keys.read(top, "ns_per_instruction", "", config.ns_per_instruction);
  keys.read(top, "seed", "", config.seed);
  keys.read(top, "sync_ns", "", config.sync_ns);
  keys.read(top, "gdb_port", "", config.gdb_port);
  read_lists(keys, top, config);
  if (config.image.empty()) keys.fail("image", "is missing");
  if (!(config.hse_Hz >= 0.0 && config.hse_Hz <= 50e6)) keys.fail("hse_Hz", "is outside 0..50 MHz");
  if (!(std::abs(config.hsi_error) <= 0.05)) keys.fail("hsi_error", "is outside +-5 %");
  if (!(std::abs(config.hse_error) <= 1e-3)) keys.fail("hse_error", "is outside +-1000 ppm");
  if (config.hse_error != 0.0 && config.hse_Hz == 0.0)
    keys.fail("hse_error", "is of a crystal that is not fitted");
  if (config.hse_start_ns < 0) keys.fail("hse_start_ns", "is negative");
  if (config.ns_per_instruction < 0) keys.fail("ns_per_instruction", "is negative");
  if (keys.failed()) {
    Error error = keys.error();
    error.place = (config.board.empty() ? "board" : config.board) + ": " + error.place;
    return error;
  }
  return config;
}

}  // namespace whirl::board
