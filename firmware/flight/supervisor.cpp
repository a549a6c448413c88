#include "firmware/flight/supervisor.hpp"

#include <bit>
#include <optional>

namespace fw {
namespace {

std::optional<Column> column_of(FlightState state, bool by_attitude) {
  switch (state) {
    case FlightState::disarmed:
      return std::nullopt;
    case FlightState::armed:
      return Column::armed;
    case FlightState::flying:
      return by_attitude ? Column::by_attitude : Column::autonomous;
    case FlightState::landing:
      return Column::landing;
    case FlightState::failsafe:
      return Column::failsafe;
  }
  return std::nullopt;
}

constexpr bool rows_in_order() {
  for (std::size_t i = 0; i < kConditions; ++i) {
    if (static_cast<std::size_t>(kRules[i].condition) != i) return false;
  }
  return true;
}
static_assert(rows_in_order(), "kRules has a row for each condition, in their order");

}  // namespace

Decision Supervisor::step(const Conditions& now, FlightState state, std::uint32_t dt_ms,
                          bool by_attitude) {
  const std::optional<Column> column = column_of(state, by_attitude);
  Decision gravest;
  for (std::size_t i = 0; i < kConditions; ++i) {
    const Rule& rule = kRules[i];
    const std::uint32_t bit = 1u << i;
    if (!now.has(rule.condition)) {
      held_ms_[i] = 0;
      told_ &= ~bit;
      continue;
    }
    held_ms_[i] += dt_ms;
    if (!column || held_ms_[i] < rule.holds_ms) continue;
    const Reaction reaction = rule.reactions[static_cast<std::size_t>(*column)];
    if (reaction == Reaction::tell && (told_ & bit) == 0) {
      to_tell_ |= bit;
      told_ |= bit;
    }
    if (reaction > gravest.reaction) gravest = {reaction, rule.reason};
  }
  return gravest;
}

Reason Supervisor::take_warning() {
  if (to_tell_ == 0) return Reason::none;
  const auto first = static_cast<std::size_t>(std::countr_zero(to_tell_));
  to_tell_ &= ~(1u << first);
  return kRules[first].reason;
}

}  // namespace fw
