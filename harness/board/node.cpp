#include "harness/board/node.hpp"

#include <algorithm>

namespace whirl {

Result<NodePlace> node_place(const std::vector<Node>& nodes, const std::string& text) {
  const auto slash = text.find('/');
  std::string names;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (slash != std::string::npos && nodes[i].name == text.substr(0, slash) && slash > 0) {
      if (slash + 1 == text.size()) break;
      return NodePlace{i, text.substr(slash + 1)};
    }
  }
  for (const Node& node : nodes) names += (names.empty() ? "" : ", ") + node.name;
  if (text.empty()) return Error{ErrorKind::bad_input, "", "an empty name names nothing", ""};
  if (nodes.size() == 1 && slash == std::string::npos) return NodePlace{0, text};
  if (nodes.size() == 1 && nodes[0].name.empty()) return NodePlace{0, text};
  return Error{ErrorKind::bad_input, "", "'" + text + "' names no board of this plan",
               "write NODE/" + (slash == std::string::npos ? text : text.substr(slash + 1)) +
                   " with NODE of: " + names};
}

bool plays_parts(const BoardDescription& board) {
  return std::any_of(board.devices.begin(), board.devices.end(),
                     [](const BoardDevice& device) { return device.type == "pod_parts"; });
}

std::string timing_profile(const std::vector<Node>& nodes) {
  std::string all;
  for (const Node& node : nodes) {
    const std::string whose = node.name.empty() ? "" : node.name + ": ";
    all += (all.empty() ? "" : "; ") + whose + node.board.timing_profile();
  }
  return all;
}

}  // namespace whirl
