// Who takes what a logic analyser saw.
#pragma once
#include <string>
#include <vector>

#include "io_bridges/copper/edge.hpp"

namespace whirl::copper {

class EdgeSink {
 public:
  virtual ~EdgeSink() = default;
  // Once, before the first edge. Wires are numbered as these names are.
  virtual void begin(const std::vector<std::string>& channels, double rate_Hz) = 0;
  // In order of time; at the first sample one of each wire, with the level that it had.
  virtual void on_edge(const Edge& edge) = 0;
  virtual void advance_to(std::int64_t t_ns) = 0;  // all has been told until then
};

}  // namespace whirl::copper
