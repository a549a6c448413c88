#include "harness/stand/stage_params.hpp"

#include <nlohmann/json.hpp>

namespace whirl::stand {

Result<std::string> with_stage(const std::string& board_json, int motor,
                               const StageParams& params) {
  nlohmann::json board = nlohmann::json::parse(board_json);
  for (nlohmann::json& device : board["devices"]) {
    if (device["type"] != "power_stage" || device.value("motor", 0) != motor) continue;
    for (const auto& [name, value] : params) device["params"][name] = value;
    return board.dump(1);
  }
  return Error{ErrorKind::bad_input, board.value("board", std::string("board")),
               "has no power stage of motor " + std::to_string(motor),
               "a stand needs one: esc32v2 has it"};
}

}  // namespace whirl::stand
