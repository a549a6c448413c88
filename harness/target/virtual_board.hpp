// The virtual board as a target: one QEMU process with our board in it.
//
//   Life      start() launches QEMU and waits until the image has been loaded; stop(), or the end of
//             this process, ends it: no QEMU outlives its harness
//   Silence   no answer for silence_s of host time, or the process gone: an Error with the last lines
//             that QEMU wrote, of the host when it was ended or stopped from outside. Off when a gdb
//             port is set: the world stands still while gdb holds it.
//   Others    a board that waits for another board's over a wire is silent for no fault of its own: the set
//             that it is in says who hangs, or has died
//   Threads   start() and all that follows belong to one thread (PDEATHSIG hangs on it)
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/target/target.hpp"
#include "io_bridges/board_description/board_description.hpp"

namespace whirl {

struct VirtualBoardOptions {
  BoardStart board;
  std::string qemu = "qemu-system-arm";
  std::string plugin;                     // whirl_board.so; empty: where the build put it
  int silence_s = 30;                     // 0: however long
  bool any_qemu_version = false;          // do not insist on the tested list
  std::vector<std::string> qemu_options;  // for developers: "-d", "in_asm", ...
};

class VirtualBoard final : public Target {
 public:
  explicit VirtualBoard(VirtualBoardOptions options);
  ~VirtualBoard() override;

  Result<Done> start() override;
  void run(std::int64_t until_ns, const io::Batch& sensed) override;
  Result<TargetState> arrive(io::Batch& happened) override;
  void stop(io::Batch& happened) override;
  std::vector<std::pair<std::string, std::string>> versions() const override;
  Offers offers() const override { return kAll_offers; }
  bool over() const override;
  std::optional<Error> died() override;
  std::optional<Error> hangs() override;
  void set_company(Company ask) override { company_ = std::move(ask); }

  int pid() const;             // 0: not running
  std::string output() const;  // what QEMU wrote so far, the last few KiB

 private:
  struct Process;
  Result<TargetState> await(io::Batch& happened);
  Result<TargetState> delivered(io::Batch& happened) const;
  Error give_up(double cpu_s_before);
  std::unique_ptr<Process> process_;
  VirtualBoardOptions options_;
  Result<Done> posted_ = Done{};
  Company company_;
  std::optional<double> cpu_s_;  // used when it was first looked at in this step
  io::Batch at_start_;           // what the board told of itself before its first step
};

// For `whirl doctor`: QEMU's first line of --version, or what is wrong.
Result<std::string> probe_qemu(const std::string& qemu = "qemu-system-arm");
std::string default_plugin();

}  // namespace whirl
