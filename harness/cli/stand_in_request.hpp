// What `whirl standin` is asked for: a virtual board that behaves as one of metal, at this host's own wires.
#pragma once
#include <string>

namespace whirl::cli {

struct StandInRequest {
  std::string board = "esc32v2";  // a name or path, as in a plan
  std::string image;              // likewise; empty: the board's usual one
  std::string stand = R"({ prop = "hk_10x4.5", battery = "4s_2200" })";  // the plan's table
  double pace = 1.0;
  std::string folder = "standin";   // of the links to its lines, and of a bench file for it
  std::string serial = "STANDIN1";  // number of the played bridge
  bool bridge = true;               // its I2C behind an MCP2221A that uhid plays
  std::string can;   // interface that the board's CAN, or the pod's, is joined to; empty: none
  bool pod = false;  // beside it the pod on a board of its own, which plays its sensors and ESCs
  double seconds = 0.0;  // of the host; 0: until a signal
};

}  // namespace whirl::cli
