#include "harness/world/signal_table.hpp"

namespace whirl {

SignalTable::SignalTable(const std::vector<Signal>& signals) : signals_(signals) {
  for (const Signal& signal : signals) {
    const std::string suffix = si_suffix(signal.dimension);
    with_unit_.push_back(suffix.empty() ? signal.name : signal.name + "_" + suffix);
  }
}

std::optional<std::size_t> SignalTable::find(std::string_view name) const {
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    if (signals_[i].name == name) return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> SignalTable::find_with_unit(std::string_view name) const {
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    if (with_unit_[i] == name) return i;
  }
  return std::nullopt;
}

std::string SignalTable::names() const {
  std::string all;
  for (const Signal& signal : signals_) all += (all.empty() ? "" : ", ") + signal.name;
  return all;
}

}  // namespace whirl
