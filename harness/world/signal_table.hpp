// Signals by name: which column a name is, and which names there are.
//
//   With unit  "height_m"; of none and ratio the bare name
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/units.hpp"

namespace whirl {

struct Signal {
  std::string name;
  Dimension dimension = Dimension::none;
  std::string about;  // one line for people: "height above the floor, truth"
};

class SignalTable {
 public:
  explicit SignalTable(const std::vector<Signal>& signals);

  const Signal& operator[](std::size_t column) const { return signals_[column]; }
  std::optional<std::size_t> find(std::string_view name) const;
  std::optional<std::size_t> find_with_unit(std::string_view name) const;
  const std::string& with_unit(std::size_t column) const { return with_unit_[column]; }
  std::string names() const;  // "height, north, east"

 private:
  const std::vector<Signal>& signals_;  // of the world, which outlives its tables
  std::vector<std::string> with_unit_;
};

}  // namespace whirl
