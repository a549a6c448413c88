#pragma once
#include <charconv>
#include <optional>
#include <string_view>

namespace whirl {

// The number in a bus's name: "i2c3" -> 3. Nothing for a name without one, or with more than two digits.
inline std::optional<int> bus_number(std::string_view bus) {
  const std::size_t digit = bus.find_last_not_of("0123456789") + 1;  // "i2c3": the last one counts
  if (digit == 0 || bus.size() == digit || bus.size() - digit > 2) return std::nullopt;
  int number = 0;
  std::from_chars(bus.data() + digit, bus.data() + bus.size(), number);
  return number;
}

}  // namespace whirl
