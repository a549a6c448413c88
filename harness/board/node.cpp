#include "harness/board/node.hpp"

#include <algorithm>

#include "io_bridges/board_description/pod_host.hpp"

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

namespace {

const BoardDevice* host_of(const BoardDescription& board) {
  const auto host = std::find_if(board.devices.begin(), board.devices.end(), is_pod_host);
  return host == board.devices.end() ? nullptr : &*host;
}

}  // namespace

bool plays_parts(const BoardDescription& board) {
  return host_of(board) != nullptr;
}

std::set<std::string> pod_parts(const BoardDescription& board) {
  const BoardDevice* host = host_of(board);
  if (host == nullptr) return {};
  std::set<std::string> all{"mpu6000", "ms5611", "hmc5883l", "esc_i2c"};
  if (host->value("params.gps") == KeyValue(true)) all.insert("ublox_6");
  if (host->value("params.receiver") == KeyValue(true)) all.insert("sbus");
  if (host->value("params.radio") == KeyValue(true)) all.insert("mavlink_link");
  if (host->value("params.battery") == KeyValue(true)) all.insert("battery_sense");
  return all;
}

std::optional<int> can_of_host(const BoardDescription& board) {
  const BoardDevice* host = host_of(board);
  return host == nullptr ? std::nullopt : can_of_host(*host);
}

std::string device_bus(const BoardDevice& device) {
  return bus_of(device);
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
