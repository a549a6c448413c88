#include "harness/plan/contradictions.hpp"

#include <string>
#include <type_traits>

namespace whirl::plan {
namespace {

using namespace request;

template <typename T, typename... Any>
constexpr bool is_one_of = (std::is_same_v<T, Any> || ...);

// Where a vehicle goes, or what a motor turns by: of one command there is one.
bool leads(const Command& command) {
  return std::visit(
      []<typename Request>(const Request&) {
        return is_one_of<Request, TakeOff, GoTo, Land, Figure8, Cruise, HoldAttitude,
                         request::Waypoints, Teleoperation, SetPoint, request::Calibrate>;
      },
      command);
}

}  // namespace

void refuse_contradictions(const lua::Table& t, const std::vector<Command>& all) {
  const Command* leader = nullptr;
  for (const Command& command : all) {
    if (!leads(command)) continue;
    if (leader != nullptr) {
      t.refuse(word(command), std::string("contradicts '") + word(*leader) + "' beside it",
               "one t:command each");
    }
    leader = &command;
  }
}

}  // namespace whirl::plan
