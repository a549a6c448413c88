#include "harness/world/fault.hpp"

namespace whirl {

std::string target_of(const FaultSpec& fault) {
  if (const auto* wire = std::get_if<fault_at::Wire>(&fault.place)) return wire->name;
  if (const auto* device = std::get_if<fault_at::Device>(&fault.place)) return device->name;
  if (const auto* function = std::get_if<fault_at::Function>(&fault.place)) return function->name;
  if (const auto* motor = std::get_if<fault_at::Motor>(&fault.place)) {
    return "motor " + std::to_string(motor->number);
  }
  return "";
}

Result<Done> must_be_of_all(const FaultSpec& fault) {
  if (std::holds_alternative<fault_at::Anywhere>(fault.place)) return Done{};
  return Error{ErrorKind::bad_input, "",
               "a fault of kind " + fault.kind + " has no place: it meets all",
               "leave device, bus, motor and function out"};
}

int motor_of(const FaultSpec& fault) {
  if (const auto* motor = std::get_if<fault_at::Motor>(&fault.place)) return motor->number;
  if (const auto* device = std::get_if<fault_at::Device>(&fault.place)) return device->motor;
  return 0;
}

void TimedFaults::apply(const std::string& kind, std::int64_t t_ns,
                        const std::function<void(const FaultSpec&)>& act) {
  for (Entry& entry : entries_) {
    if (!entry.in_force(kind, t_ns)) continue;
    entry.acted = true;
    act(entry.fault);
  }
}

bool TimedFaults::any(const std::string& kind, std::int64_t t_ns) {
  for (Entry& entry : entries_) {
    if (!entry.in_force(kind, t_ns)) continue;
    entry.acted = true;
    return true;
  }
  return false;
}

std::vector<std::uint32_t> TimedFaults::acted() const {
  std::vector<std::uint32_t> numbers;
  for (const Entry& entry : entries_) {
    if (entry.acted) numbers.push_back(entry.fault.number);
  }
  return numbers;
}

}  // namespace whirl
