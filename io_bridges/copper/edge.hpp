// A change of level on a wire, as a logic analyser or a file of waveforms has it.
#pragma once
#include <cstdint>

namespace whirl::copper {

struct Edge {
  std::int64_t t_ns = 0;   // of whoever watched; virtual time where a run was drawn
  std::uint16_t wire = 0;  // number of its channel
  bool level = false;      // from t_ns on
};

}  // namespace whirl::copper
