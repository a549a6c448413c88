#include "harness/catalogue/device_entry.hpp"

namespace whirl {
namespace {

using rack::DeviceKey;
using rack::DeviceType;
using rack::KeyKind;

KeyValue read_value(const lua::Table& t, const std::string& key, const DeviceKey& as) {
  switch (as.kind) {
    case KeyKind::bus:
    case KeyKind::pin:
    case KeyKind::word:
      return t.text(key);
    case KeyKind::file: {
      const std::string path = t.text(key);
      return path.empty() ? path : t.sibling(path);
    }
    case KeyKind::address:
    case KeyKind::whole:
      return static_cast<double>(t.integer(key));
    case KeyKind::quantity:
      return t.quantity(key, as.dimension);
    case KeyKind::triple:
      return t.quantities(key, as.dimension);
    case KeyKind::flag:
      return t.flag_or(key, false);
    case KeyKind::axes:
      return t.texts(key);
  }
  return false;
}

bool leads_to_a_key(const DeviceType& type, const std::string& path) {
  for (const DeviceKey& key : type.keys) {
    if (key.path.starts_with(path + ".")) return true;
  }
  return false;
}

// Every key that is given, by its path: params = { shunt = { gain = ... } } is params.shunt.gain.
void read_keys(const lua::Table& t, const std::string& prefix, const DeviceType& type,
               BoardDevice& device) {
  for (const std::string& key : t.keys()) {
    const std::string path = prefix + key;
    if (prefix.empty() && (key == "name" || key == "type")) continue;
    if (const DeviceKey* known = type.find(path)) {
      KeyValue value = read_value(t, key, *known);
      const std::string wrong = rack::complaint(*known, value);
      if (!wrong.empty()) t.refuse(key, wrong);
      if (wrong.empty()) device.set(path, std::move(value));
    } else if (leads_to_a_key(type, path)) {
      read_keys(t.table(key), path + ".", type, device);
    } else {
      t.refuse(key, rack::no_key(type), rack::keys_cure(type));
    }
  }
}

}  // namespace

BoardDevice read_device(const lua::Table& entry, const rack::DeviceTypes& types) {
  BoardDevice device;
  device.name = entry.text("name");
  device.type = entry.text("type");
  if (const DeviceType* type = rack::find_type(types, device.type)) {
    read_keys(entry, "", *type, device);
    device.senses = type->senses;
  }
  if (const auto wrong = rack::check_device(device, 0, types)) refuse(entry, *wrong);
  return device;
}

void refuse(const lua::Table& entry, const rack::BoardComplaint& complaint) {
  entry.refuse(complaint.key.empty() ? "type" : complaint.key, complaint.what, complaint.cure);
}

}  // namespace whirl
