// A target and a world in closed form, for tests of plans, verdicts, exit codes and results.
//
//   Target   behaves as its image is called: "flight" flies by the clock of its tasks; "crash" faults
//            at 50 ms; "asleep" does nothing; "lost" stops answering; "late" blames the host;
//            "drifting" differs from run to run; "throws" breaks, "interrupted" is sent a
//            TERM and "bitten" is reset by its window watchdog at 50 ms;
//            "modest" offers virtual time and nothing else
//   World    height answers a take-off as a first-order lag (tau 200 ms), thrust a command as one of
//            50 ms; a gust moves `east` and it comes back with tau 500 ms
#pragma once
#include "base/scratch_folder.hpp"
#include "harness/cli/composition.hpp"

namespace whirl::test {

// A project's root in a folder of its own: images, board, vehicle and the given plan files.
class FakeRoot {
 public:
  FakeRoot();
  void write(const std::string& relative, const std::string& text) const;
  std::string read(const std::string& relative) const;
  const std::string& path() const { return folder_.path(); }

 private:
  ScratchFolder folder_;
};

cli::Composition fake_composition(const std::string& root);

struct Outcome {
  int code = 0;
  std::string out;  // standard output
  std::string err;  // standard error
};
// The whole program, as from a shell.
Outcome whirl(const FakeRoot& root, const std::vector<std::string>& arguments);

}  // namespace whirl::test
