// The values of a device's keys as the rack wants them: nothing where a key is not given.
#pragma once
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "io_bridges/board_description/board_description.hpp"

namespace whirl::board {

// "i2c3" is (i2c, 3).
struct BusName {
  std::string kind;
  int number = 0;
};

inline BusName split(const std::string& bus) {
  const auto digit = bus.find_last_not_of("0123456789") + 1;  // "i2c3": the last number counts
  return {bus.substr(0, digit), std::atoi(bus.substr(digit).c_str())};
}

inline std::string text(const BoardDevice& device, const char* key) {
  const auto value = device.value(key);
  const auto* text = value ? std::get_if<std::string>(&*value) : nullptr;
  return text == nullptr ? "" : *text;
}

inline double baud_of(const BoardDevice& device) {
  const auto value = device.value("baud");
  const double* baud = value ? std::get_if<double>(&*value) : nullptr;
  return baud == nullptr ? 0.0 : *baud;
}

// Numbers by name; lists as name.0, name.1, ...
inline std::map<std::string, double> params_of(const BoardDevice& device) {
  std::map<std::string, double> numbers;
  for (const auto& [path, value] : device.keys) {
    if (!path.starts_with("params.")) continue;
    const std::string name = path.substr(7);
    if (const double* number = std::get_if<double>(&value)) numbers[name] = *number;
    if (const bool* flag = std::get_if<bool>(&value)) numbers[name] = *flag ? 1.0 : 0.0;
    const auto* list = std::get_if<std::vector<double>>(&value);
    for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
      numbers[name + "." + std::to_string(i)] = (*list)[i];
    }
  }
  return numbers;
}

}  // namespace whirl::board
