// A thrust stand of metal, as a plan sees it: what instruments measure, what the ESC tells, who commands it.
//
//   Signals  those that the bench's instruments give, NaN before the first reading and when the last one is older
//            than 250 ms; those of esc_master.hpp; other names for them (`aliases`)
//   Command  those of esc_master.hpp. No wind, no brake, no faults: nothing here moves air
//   Ages     of what the instruments give: from its own time on. What the ESC tells counts as of its step
//   Limits   judged each step on any of the signals; outside, or not measured for 250 ms once it was: the bench is
//            told to make safe
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/stand/esc_master.hpp"
#include "harness/world/world.hpp"

namespace whirl::stand {

struct BenchLimit {
  std::string signal;
  Dimension dimension = Dimension::none;
  double low = 0.0, high = 0.0;  // SI
};

struct BenchStandParams {
  EscMasterParams esc;
  std::vector<Signal> readings;                // in the order of instrument_reading's ports
  std::map<std::string, std::string> aliases;  // {"speed", "told_speed"}
  std::vector<BenchLimit> limits;
};

class BenchStand final : public World {
 public:
  // Errors  bad_input: an alias or a limit names no signal, or two signals are called the same
  static Result<std::unique_ptr<BenchStand>> make(BenchStandParams params);

  const std::vector<Signal>& signals() const override { return signals_; }
  void read(std::span<double> values) const override;
  std::span<const std::int64_t> ages_ns() const override { return ages_ns_; }
  void step(std::int64_t t_ns, const io::Batch& happened, io::Batch& sensed) override;
  Result<Done> command(const Command& command, std::int64_t now_ns) override;
  Result<Done> disturb(const Disturbance& disturbance, std::int64_t now_ns) override;
  std::int64_t command_on_wire_ns() const override { return master_.on_wire_ns(); }
  Result<bool> take_fault(const FaultSpec&) override { return false; }
  std::vector<std::uint32_t> applied_faults() const override { return {}; }
  std::string status() const override;
  Result<Done> say(const std::string& line) override { return master_.ask(line); }
  const std::vector<std::string>& heard() const override { return master_.heard(); }

 private:
  explicit BenchStand(BenchStandParams params);
  struct Measured {
    std::int64_t t_ns = 0;
    double value = 0.0;
  };
  Result<Done> name_signals();
  Result<Done> add_signal(Signal signal, std::function<double()> value,
                          std::optional<std::size_t> reading);
  std::optional<std::size_t> column(const std::string& name) const;
  double latest(std::size_t reading) const;
  std::optional<std::string> beyond_limits();

  BenchStandParams params_;
  EscMaster master_;
  std::vector<std::optional<Measured>> measured_;
  std::vector<Signal> signals_;
  std::vector<std::function<double()>> values_;
  std::vector<std::optional<std::size_t>> read_by_;  // the reading that a signal is, if it is one
  std::vector<std::int64_t> ages_ns_;
  std::vector<bool> seen_;  // of the limits: their signals were measured
  std::int64_t now_ns_ = 0;
};

}  // namespace whirl::stand
