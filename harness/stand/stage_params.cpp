#include "harness/stand/stage_params.hpp"

#include "base/check.hpp"

namespace whirl::stand {

Result<Done> set_stage(BoardDescription& board, int motor, const StageParams& params) {
  for (BoardDevice& device : board.devices) {
    if (device.type != "power_stage" || device.motor != motor) continue;
    for (const auto& [name, value] : params) {
      // A part's own error takes the place of the tolerance that it would be drawn from, and back.
      if (name == "shunt.gain_error") device.keys.erase("params.shunt.gain");
      if (name == "shunt.gain") device.keys.erase("params.shunt.gain_error");
      WHIRL_CHECK(device.set("params." + name, value), name);
    }
    return Done{};
  }
  return Error{ErrorKind::bad_input, board.name,
               "has no power stage of motor " + std::to_string(motor),
               "a stand needs one: esc32v2 has it"};
}

}  // namespace whirl::stand
