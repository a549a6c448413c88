#include "harness/flight/controllers.hpp"

namespace whirl::flight {

const ControllerTypes& controller_types() {
#define WHIRL_CALL(name) name##_type(),
  static const ControllerTypes types = {WHIRL_MOTOR_CONTROLLERS(WHIRL_CALL)};
#undef WHIRL_CALL
  return types;
}

std::vector<std::string> names_of(const ControllerTypes& types) {
  std::vector<std::string> names;
  for (const ControllerType& type : types) names.push_back(type.name);
  return names;
}

}  // namespace whirl::flight
