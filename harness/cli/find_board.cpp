#include "harness/cli/find_board.hpp"

#include "harness/cli/find_plans.hpp"

namespace whirl::cli {

Result<BoardDescription> find_board(const std::string& written, const Asker& who,
                                    const std::string& root) {
  const auto path = find_file(written, who, {root + "/test_plans/boards"}, ".lua");
  if (!path) return path.error();
  return read_board(shown_path(path.value()));
}

}  // namespace whirl::cli
