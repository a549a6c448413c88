// One key of a device in a board file: what may stand there.
//
//   Use     quantity_key("params.rate", Dimension::frequency, "kHz", {1e3, 400e3}, "of SCL").with(400e3)
//   Units   values, limits and defaults are SI; `unit` is the one in which people are shown them
//   Errors  complaint() says in one sentence what is wrong with a value; empty: nothing
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "base/units.hpp"
#include "io_bridges/board_description/board_description.hpp"

namespace whirl::rack {

enum class KeyKind : std::uint8_t {
  bus,       // "i2c3": `unit` is the kind of bus, or several: "i2c or spi"
  pin,       // "PB0"
  word,      // the one word `unit`, or one of several: "stop or hold"
  address,   // on I2C
  whole,     // a whole number
  quantity,  // a number with a unit, or a bare one where the dimension is none
  triple,    // three of them, along x, y, z
  flag,      // true or false
  file,      // a path; in a board file it counts from there
  axes,      // { "+x", "-y", "-z" }: where the part's axes point to, in the body's
};

// Two devices with the same value: they may, they may not if they are of one type, they may not.
enum class Sharing : std::uint8_t { shared, own_in_type, own };

struct Limits {  // inclusive; NaN is never within
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool hold(double x) const { return x >= low && x <= high; }
};

struct DeviceKey {
  std::string path;   // "baud", "params.shunt.offset"
  std::string about;  // in a few words
  KeyKind kind = KeyKind::quantity;
  Dimension dimension = Dimension::none;
  std::string unit = {};
  Limits limits = {};
  Sharing sharing = Sharing::shared;
  bool needed = false;
  std::optional<KeyValue> fallback = {};  // what is taken where the key is not given
  std::string fallback_text = {};         // where that is no single value
  std::string not_with = {};              // a key that says the same thing another way
  std::string on_bus = {};  // "spi": a key of devices on that kind of bus, and of no other

  DeviceKey need() const;
  DeviceKey with(KeyValue value) const;
  DeviceKey with_text(std::string text) const;
  DeviceKey own(Sharing how = Sharing::own) const;
  DeviceKey instead_of(std::string other) const;
  DeviceKey on(std::string kind_of_bus) const;
};

DeviceKey bus_key(std::string kind, std::string about);  // "i2c", "i2c or spi"
DeviceKey pin_key(std::string path, std::string about);  // own
DeviceKey address_key();
DeviceKey motor_key();  // 1..io::kMostMotors, own in its type
DeviceKey flag_key(std::string path, std::string about);
DeviceKey file_key(std::string path, std::string about);
DeviceKey axes_key(std::string path, std::string about);
DeviceKey quantity_key(std::string path, Dimension dimension, std::string unit, Limits limits,
                       std::string about);
DeviceKey word_key(std::string path, std::string words, std::string about);  // "stop or hold"
DeviceKey triple_key(std::string path, Dimension dimension, std::string unit, Limits limits,
                     std::string about);

std::string complaint(const DeviceKey& key, const KeyValue& value);

// For lists of keys.
std::string unit_text(const DeviceKey& key);     // "kHz", "pin", "bus i2cN"
std::string range_text(const DeviceKey& key);    // "1..400", may be empty
std::string default_text(const DeviceKey& key);  // "needed", "400 kHz", "none"

}  // namespace whirl::rack
