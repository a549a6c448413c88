#include "io_bridges/rack/device_type.hpp"

#include <algorithm>

namespace whirl::rack {

DeviceSlot::DeviceSlot(Rack& rack, const std::string& board, const BoardDevice& device,
                       const DeviceType& type, int number)
    : rack_(rack),
      device_(device),
      type_(type),
      number_(static_cast<std::uint16_t>(number)),
      place_((device.place.empty() ? board : device.place) + ": " + device.name) {}

const DeviceKey& DeviceSlot::key(const std::string& path) const {
  const DeviceKey* key = type_.find(path);
  WHIRL_CHECK(key != nullptr, type_.name, path);
  return *key;
}

template <typename T>
T DeviceSlot::value(const std::string& path) const {
  const DeviceKey& wanted = key(path);
  std::optional<KeyValue> value = device_.value(path);
  if (!value) value = wanted.fallback;
  WHIRL_CHECK(value && std::holds_alternative<T>(*value), type_.name, path);
  return std::get<T>(*value);
}

bool DeviceSlot::given(const std::string& path) const {
  std::ignore = key(path);
  return device_.value(path).has_value();
}

double DeviceSlot::quantity(const std::string& path) const {
  return value<double>(path);
}

std::uint16_t DeviceSlot::whole(const std::string& path) const {
  return static_cast<std::uint16_t>(value<double>(path));
}

bool DeviceSlot::flag(const std::string& path) const {
  return value<bool>(path);
}

std::string DeviceSlot::text(const std::string& path) const {
  return value<std::string>(path);
}

std::vector<double> DeviceSlot::triple(const std::string& path) const {
  return value<std::vector<double>>(path);
}

std::vector<std::string> DeviceSlot::axes(const std::string& path) const {
  return value<std::vector<std::string>>(path);
}

io::Wire& DeviceSlot::wire(const std::string& pin) {
  if (io::Wire* wire = rack_.pin(pin)) return *wire;
  fail("the part has no pin '" + pin + "'");
  return nowhere_;
}

io::I2cBus& DeviceSlot::i2c() {
  if (io::I2cBus* bus = rack_.i2c(bus_number())) return *bus;
  fail("the part has no bus '" + device_.bus + "' for it");
  return no_bus_;
}

io::CanBus& DeviceSlot::can() {
  if (io::CanBus* bus = rack_.can(bus_number())) return *bus;
  fail("the part has no bus '" + device_.bus + "' for it");
  no_can_ = std::make_unique<io::CanBus>(rack_.events(), "nowhere");
  return *no_can_;
}

void DeviceSlot::join_spi(io::SpiTarget& target) {
  if (!rack_.join_spi(bus_number(), pin("cs"), target, device_, number_)) {
    fail("the part has no bus '" + device_.bus + "' for it");
  }
}

void DeviceSlot::join_uart(io::UartPeer& peer) {
  if (!rack_.join_uart(bus_number(), peer)) {
    fail("the part has no bus '" + device_.bus + "' for it");
  }
}

io::SpiSlave& DeviceSlot::spi_slave() {
  if (io::SpiSlave* slave = rack_.spi_slave(bus_number())) return *slave;
  fail("the part has no bus '" + device_.bus + "' for it");
  return no_slave_;
}

void DeviceSlot::set_analog(const std::string& pin, std::function<double(Nanoseconds)> volts) {
  if (!rack_.set_analog(pin, std::move(volts))) fail("the part has no analog pin '" + pin + "'");
}

bool DeviceSlot::failed(const Result<Done>& result) {
  if (result) return false;
  if (!error_) error_ = result.error();
  return true;
}

void DeviceSlot::fail(const std::string& what) {
  if (!error_) error_ = Error{ErrorKind::bad_input, place_, what, ""};
}

const DeviceKey* DeviceType::find(const std::string& path) const {
  const auto it = std::find_if(keys.begin(), keys.end(),
                               [&](const DeviceKey& key) { return key.path == path; });
  return it == keys.end() ? nullptr : &*it;
}

std::string DeviceType::key_list() const {
  std::string list;
  for (const DeviceKey& key : keys) list += (list.empty() ? "" : ", ") + key.path;
  return list;
}

const DeviceType* find_type(const DeviceTypes& types, const std::string& name) {
  const auto it = std::find_if(types.begin(), types.end(),
                               [&](const DeviceType& type) { return type.name == name; });
  return it == types.end() ? nullptr : &*it;
}

std::string type_list(const DeviceTypes& types) {
  std::string list;
  for (const DeviceType& type : types) list += (list.empty() ? "" : ", ") + type.name;
  return list;
}

}  // namespace whirl::rack
