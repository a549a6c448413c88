#include "firmware/config/parameters.hpp"

#include <cmath>

namespace fw {
namespace {

constexpr bool rows_are_good() {
  for (std::size_t i = 0; i < kParameterCount; ++i) {
    const ParameterRow& row = kParameterTable[i];
    if (static_cast<std::size_t>(row.parameter) != i) return false;
    if (row.name.empty() || row.name.size() > 16) return false;
    if (!(row.low <= row.start && row.start <= row.high)) return false;
  }
  return true;
}
static_assert(rows_are_good());

}  // namespace

Parameters::Parameters() {
  for (std::size_t i = 0; i < kParameterCount; ++i) values_[i] = kParameterTable[i].start;
}

bool Parameters::set(std::size_t index, float value, bool armed) {
  if (index >= kParameterCount) return false;
  const ParameterRow& row = kParameterTable[index];
  if (!(value >= row.low && value <= row.high)) return false;  // nor NaN
  if (row.numbers == Numbers::whole && value != std::floor(value)) return false;
  if (value == values_[index]) return true;
  if (armed && row.while_armed == WhileArmed::refused) return false;
  values_[index] = value;
  ++changes_;
  return true;
}

std::optional<std::size_t> Parameters::index_of(std::string_view name) {
  for (std::size_t i = 0; i < kParameterCount; ++i) {
    if (kParameterTable[i].name == name) return i;
  }
  return std::nullopt;
}

}  // namespace fw
