// What of a bench nobody has proven without hardware: of the parts that its file names, and of every bench. The one place where it
// stands: `whirl bench check` prints it, and docs/bench.md has the same words.
#pragma once
#include <string>
#include <vector>

#include "harness/target/bench/bench_description.hpp"

namespace whirl::bench {

struct Unproven {
  const char* what;  // "a real bus-off"
  const char* why;   // what stands for it: what has been tried instead
  std::string text() const { return std::string(what) + ": " + why; }
};

std::vector<Unproven> all_unproven();
// Of these, what concerns this bench. Pre: its lines' ends are known (SerialLink::mavlink); receiver, gps: a line is one's.
struct LineEnds {
  bool receiver = false, gps = false, commands = false;
};
std::vector<Unproven> unproven(const BenchDescription& bench, LineEnds lines);

}  // namespace whirl::bench
