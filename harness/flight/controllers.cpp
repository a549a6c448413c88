#include "harness/flight/controllers.hpp"

#include <algorithm>

#include "base/check.hpp"

namespace whirl::flight {

const ControllerTypes& controller_types() {
#define WHIRL_CALL(name) name##_type(),
  static const ControllerTypes types = {WHIRL_MOTOR_CONTROLLERS(WHIRL_CALL)};
#undef WHIRL_CALL
  return types;
}

const ControllerType& type_named(const std::string& name, const ControllerTypes& types) {
  const auto type = std::find_if(types.begin(), types.end(),
                                 [&](const ControllerType& t) { return t.name == name; });
  WHIRL_CHECK(type != types.end(), name);
  return *type;
}

std::vector<std::string> names_of(const ControllerTypes& types) {
  std::vector<std::string> names;
  for (const ControllerType& type : types) names.push_back(type.name);
  return names;
}

}  // namespace whirl::flight
