// The number in a bus's name: "i2c3" -> 3. Nothing for a name without one, or with more than two digits.
#pragma once
#include <charconv>
#include <optional>
#include <string>

namespace whirl::plan {

inline std::optional<int> bus_number(const std::string& bus) {
  const auto letters = bus.find_last_not_of("0123456789");
  const std::size_t digits = letters == std::string::npos ? 0 : bus.size() - letters - 1;
  if (digits == 0 || digits > 2) return std::nullopt;
  int number = 0;
  std::from_chars(bus.data() + letters + 1, bus.data() + bus.size(), number);
  return number;
}

}  // namespace whirl::plan
