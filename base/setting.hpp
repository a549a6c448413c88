// One value in place of what a file says: "vehicle.motor.resistance", "120 mohm".
//
//   Key      the file it is of (plan, stand, vehicle), and the path of the key in it; lists by number from
//            1: "vehicle.motors.2.spin"
//   Value    as it would stand in the file: true, false, a number, or a text ("120 mohm")
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace whirl {

struct Setting {
  std::string key, value;
};
using Settings = std::vector<Setting>;

// The rest of its path, where the setting is of that file; empty otherwise.
inline std::string_view path_in(const Setting& setting, std::string_view file) {
  const std::string_view key = setting.key;
  const bool of_it =
      key.starts_with(file) && key.size() > file.size() + 1 && key[file.size()] == '.';
  return of_it ? key.substr(file.size() + 1) : std::string_view{};
}

}  // namespace whirl
