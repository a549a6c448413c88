// whirl bench flash, whirl bench probe: a board through its debug probe, by openocd.
#pragma once
#include <string>

#include "harness/cli/composition.hpp"
#include "harness/target/bench/bench_description.hpp"
#include "io_bridges/openocd/server.hpp"

namespace whirl::cli {

struct ProbeOptions {
  std::string name;   // of test_plans/benches, or a path
  std::string image;  // name or path of the ELF
  int samples = 1000;
  bool halt = false;  // probe: also halts the core for its registers
  bool reset = false;
};

// openocd, started for that probe. Errors  bad_input: what is missing, one line with its cure
Result<std::unique_ptr<openocd::Server>> connect_probe(const bench::DebugProbe& probe);

// Writes the image, reads it back, resets. 0: done; 2: what is missing, one line with its cure.
int bench_flash_command(const ProbeOptions& options, const Composition& composition);

// Where the program counter is, sample by sample, while the image runs on: the share of time that the core works, with
// its interval, and the functions in which it was. With --halt the registers of a fault, from the core and from what
// the image itself has kept of it. 0: shown; 2: what is missing.
int bench_probe_command(const ProbeOptions& options, const Composition& composition);

}  // namespace whirl::cli
