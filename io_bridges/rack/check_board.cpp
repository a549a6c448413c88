#include "io_bridges/rack/check_board.hpp"

#include <map>

#include "io_bridges/board_description/bus_name.hpp"

namespace whirl::rack {
namespace {

// Things that belong to one device, by what a complaint calls them: "pin, PB0".
class Owners {
 public:
  std::optional<BoardComplaint> claim(const std::string& thing, const std::string& words,
                                      const std::string& owner, int device,
                                      const std::string& key) {
    const auto [it, first] = owners_.emplace(thing, owner);
    if (first) return std::nullopt;
    return BoardComplaint{device, key, it->second + " and " + owner + " " + words, ""};
  }

 private:
  std::map<std::string, std::string> owners_;
};

std::string value_text(const KeyValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  const double* number = std::get_if<double>(&value);
  return number == nullptr ? "" : std::to_string(static_cast<long>(*number));
}

std::optional<BoardComplaint> claim_key(Owners& owners, const BoardDevice& device, int number,
                                        const DeviceKey& key) {
  const auto value = device.value(key.path);
  if (!value || key.sharing == Sharing::shared) return std::nullopt;
  const std::string text = value_text(*value);
  if (key.kind == KeyKind::pin) {
    return owners.claim("pin " + text, "are on one pin, " + text, device.name, number, key.path);
  }
  // UART4 and USART4 are one thing; so are all spellings of a bus.
  const std::string what =
      key.kind == KeyKind::bus ? key.unit + std::to_string(bus_number(text).value_or(0)) : text;
  const std::string whose = key.sharing == Sharing::own ? "" : device.type;
  return owners.claim(whose + " " + key.path + " " + what, "share one " + key.path + ", " + text,
                      device.name, number, key.path);
}

std::optional<BoardComplaint> claim_device(Owners& owners, const BoardDevice& device, int number,
                                           const DeviceType& type) {
  if (owners.claim("name " + device.name, "", device.name, number, "name")) {
    return BoardComplaint{number, "name", "two devices are called '" + device.name + "'", ""};
  }
  for (const DeviceKey& key : type.keys) {
    if (auto wrong = claim_key(owners, device, number, key)) return wrong;
  }
  for (const std::string& pin : type.pins) {
    if (auto wrong =
            owners.claim("pin " + pin, "are on one pin, " + pin, device.name, number, "")) {
      return wrong;
    }
  }
  if (device.address == -1) return std::nullopt;
  return owners.claim("address " + device.bus + " " + std::to_string(device.address),
                      "share one address on " + device.bus, device.name, number, "address");
}

// Is the key one of devices on that bus?
bool belongs(const DeviceKey& key, const BoardDevice& device) {
  const std::size_t digit = device.bus.find_last_not_of("0123456789") + 1;
  return key.on_bus.empty() || device.bus.substr(0, digit) == key.on_bus;
}

// Keys that are good one by one.
std::optional<BoardComplaint> check_together(const BoardDevice& device, int number,
                                             const DeviceType& type) {
  std::map<std::string, std::string> pins;  // its key of each
  for (const DeviceKey& key : type.keys) {
    const auto value = device.value(key.path);
    if (!value) continue;
    if (!belongs(key, device)) {
      return BoardComplaint{number, key.path,
                            "is for one on " + key.on_bus + ", and this is on " + device.bus,
                            "leave it out"};
    }
    if (!key.not_with.empty() && device.value(key.not_with)) {
      return BoardComplaint{number, key.path, "says what " + key.not_with + " says",
                            "one of the two"};
    }
    if (key.kind != KeyKind::pin) continue;
    const auto [other, first] = pins.emplace(value_text(*value), key.path);
    if (first) continue;
    return BoardComplaint{number, key.path, other->second + " is " + other->first + ", too", ""};
  }
  return std::nullopt;
}

}  // namespace

std::optional<BoardComplaint> check_device(const BoardDevice& device, int number,
                                           const DeviceTypes& types) {
  const DeviceType* type = find_type(types, device.type);
  if (type == nullptr) {
    return BoardComplaint{number, "type", "unknown type '" + device.type + "'",
                          "use one of " + type_list(types)};
  }
  if (device.name.empty()) return BoardComplaint{number, "name", "is empty", "give it one"};
  for (const std::string& path : device.paths()) {
    const DeviceKey* key = type->find(path);
    if (key == nullptr) return BoardComplaint{number, path, no_key(*type), keys_cure(*type)};
    const std::string wrong = complaint(*key, *device.value(path));
    if (!wrong.empty()) return BoardComplaint{number, path, wrong, ""};
  }
  for (const DeviceKey& key : type->keys) {
    if (!key.needed || device.value(key.path) || !belongs(key, device)) continue;
    return BoardComplaint{number, key.path, "is missing: a " + type->name + " needs it",
                          key.about + ", " + unit_text(key)};
  }
  return check_together(device, number, *type);
}

std::optional<BoardComplaint> check_sharing(const BoardDescription& board,
                                            const DeviceTypes& types) {
  Owners owners;
  for (const BoardPin& pin : board.pins) {
    if (!pin.bus.empty()) std::ignore = owners.claim("pin " + pin.pin, "", pin.bus, 0, "");
  }
  for (std::size_t i = 0; i < board.devices.size(); ++i) {
    const BoardDevice& device = board.devices[i];
    const DeviceType* type = find_type(types, device.type);
    if (type == nullptr) continue;
    if (auto wrong = claim_device(owners, device, static_cast<int>(i), *type)) return wrong;
  }
  return std::nullopt;
}

std::string no_key(const DeviceType& type) {
  return "is no key of the type " + type.name;
}

std::string keys_cure(const DeviceType& type) {
  return "it has name, type, " + type.key_list();
}

}  // namespace whirl::rack
