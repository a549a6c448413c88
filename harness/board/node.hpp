// The boards of a run. A plan that names one image and one board has one node without a name.
//
//   Names    "esc1/fw::esc::control_task", "esc1/imu", "esc1/i2c2": what stands on that node's board. Where
//            there is only one node its name may be left out.
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/board_description/board_description.hpp"

namespace whirl {

struct Node {
  std::string name;  // empty: the only one
  BoardDescription board;
  std::map<std::string, std::string> joined =
      {};  // CAN buses that another board arbitrates: "can1", "flight/can2"

  // As reports name it: with the node's name where it has one.
  std::string qualified(const std::string& what) const {
    return name.empty() ? what : name + "/" + what;
  }
};

struct NodePlace {
  std::size_t node = 0;
  std::string rest;  // without the node's name
};

// Errors  bad_input: of several nodes none is named, or one that is not there
Result<NodePlace> node_place(const std::vector<Node>& nodes, const std::string& text);

// Its parts sense what the vehicle does, and play its ESCs: it stands for any number of devices, and turns no motor.
bool plays_parts(const BoardDescription& board);
// The types of what it plays: "mpu6000"; with a GPS "ublox_6", with a receiver "sbus".
std::set<std::string> pod_parts(const BoardDescription& board);
// The CAN bus that such a board's host is on; nothing: it is on a serial line.
std::optional<int> can_of_host(const BoardDescription& board);
// The bus that a device hangs on: "i2c3"; of a pod's host on CAN that one, which is a parameter of it.
std::string device_bus(const BoardDevice& device);

// In words: which clock each board's time passes by.
std::string timing_profile(const std::vector<Node>& nodes);

}  // namespace whirl
