// A target: where the firmware runs. A stock QEMU with our board in it, or the physical board.
//
//   Promise  run until virtual time t, deliver what happened with time stamps, take what was sensed.
//   Overlap  run() returns at once; the plant takes its own step meanwhile; arrive() waits. Both sides
//            use what the other had delivered by the start of the step, so neither order of execution
//            nor host speed can change a result.
//   Silence  a target that does not answer within the host-side limit is an Error (internal for a
//            crash of ours, bad_input for an image that cannot run, host for what the machine did), with
//            its last output in `what`.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.hpp"
#include "harness/target/offers.hpp"
#include "io_bridges/messages/messages.hpp"

namespace whirl {

enum class TargetState {
  running,
  ended,       // the board asked for power-down, or the run was ended
  cpu_locked,  // the core cannot go on; firmware's doing, named in a cpu_fault message
  over_limit,  // a bench has left its limits and was made safe; why_ended() tells
};

// How a target that cannot wait has kept its time; see harness/pacing.
struct HeldPace {
  double pace = 1.0;
  std::int64_t late_ns = 0;        // of the host: what counts as late
  double late_share = 0.0;         // of the steps, that a run may have and be judged
  std::vector<double> lateness_s;  // of each step, the host's
  std::int64_t late_steps = 0, slipped_ns = 0;
  std::string scheduling;  // "SCHED_FIFO 49, memory locked"
};

class Target {
 public:
  virtual ~Target() = default;

  virtual Result<Done> start() = 0;
  // Pre: start() succeeded; every run() is followed by one arrive(). until_ns grows.
  virtual void run(std::int64_t until_ns, const io::Batch& sensed) = 0;
  virtual Result<TargetState> arrive(io::Batch& happened) = 0;
  // Ends the run in order: statistics arrive in `happened`. Safe to call twice, and after an error.
  virtual void stop(io::Batch& happened) = 0;
  // Names and versions of all that takes part, for run.json: {"qemu", "7.2.22"}, {"image sha256", ..}
  virtual std::vector<std::pair<std::string, std::string>> versions() const = 0;
  virtual Offers offers() const = 0;  // the same at any time
  // Of its log of buses: "i2c3", "pin_NAME".
  virtual bool sees(const std::string& /*wires*/) const { return offers().has(Offer::bus_log); }
  // Of the faults on wires and devices: "imu", "can2"; kind: "sensor_offset".
  virtual bool spoils(const std::string& /*what*/, const std::string& /*kind*/) const {
    return offers().has(Offer::wire_faults);
  }
  virtual std::string why_ended() const { return {}; }
  // Of several targets that wait for each other, asked while one of them is waited for:
  virtual bool over() const { return false; }         // it has given its last words
  virtual std::optional<Error> died() { return {}; }  // it has ended without any
  virtual std::optional<Error> hangs() {
    return {};
  }  // it is silent and nobody's fault but its own
  // Whom to ask about the others while this one is waited for, and has been silent for its limit.
  using Company = std::function<std::optional<Error>(bool silent)>;
  virtual void set_company(Company /*ask*/) {}
  virtual const HeldPace* held_pace() const { return nullptr; }  // null: it waits for the harness
};

}  // namespace whirl
