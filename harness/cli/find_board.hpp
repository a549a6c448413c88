// The board that a plan, a bench or a calibration names: of test_plans/boards, or a file of its own.
#pragma once
#include "harness/catalogue/board_file.hpp"
#include "harness/cli/find_file.hpp"

namespace whirl::cli {

// Errors  bad_input: nothing is there, or what read_board() refuses
Result<BoardDescription> find_board(const std::string& written, const Asker& who,
                                    const std::string& root);

}  // namespace whirl::cli
