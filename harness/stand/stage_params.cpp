#include "harness/stand/stage_params.hpp"

#include "base/check.hpp"

namespace whirl::stand {

Result<Done> set_stage(BoardDescription& board, int motor, const StageParams& params) {
  for (BoardDevice& device : board.devices) {
    if (device.type != "power_stage" || device.motor != motor) continue;
    for (const auto& [name, value] : params) {
      WHIRL_CHECK(device.set("params." + name, value), name);
    }
    return Done{};
  }
  return Error{ErrorKind::bad_input, board.name,
               "has no power stage of motor " + std::to_string(motor),
               "a stand needs one: esc32v2 has it"};
}

}  // namespace whirl::stand
