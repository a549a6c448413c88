// A physical board as a target: its buses hang on this host, and time does not wait.
//
//   Step     arrive() serves the links until the step's end is due by the pacer. What came is told in order of
//            its time; what a link had before the step's end and told later comes with the next one
//   Late     a step that begins late is counted, and told to the report by held_pace(); a stall beyond
//            100 ms is given up, as the pacer says
//   Safe     an emergency_stop from the world, the bench's longest time, a lost heartbeat, the operator or the
//            end of the run: the links send the zero set-point and nothing else from then on
//   Offers   a log of the buses on which an analyser's clips are; no virtual time, no watches; faults of the parts that it
//            plays, and of their bus; of those behind a pod what is a matter of their data
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/pacing/pacer.hpp"
#include "harness/target/bench/bench_description.hpp"
#include "harness/target/bench/link.hpp"
#include "harness/target/target.hpp"

namespace whirl::bench {

struct BenchOptions {
  BenchDescription bench;
  std::function<bool()> operator_stops;  // asked each step; null: nobody is there
  bool real_time = true;                 // asks the host for SCHED_FIFO
  // Parts and their buses, "imu", "can2", and the kinds of fault that act there.
  std::map<std::string, std::function<bool(const std::string& kind)>> played = {};
};

class BenchTarget final : public Target {
 public:
  BenchTarget(BenchOptions options, std::vector<std::unique_ptr<Link>> links,
              pacing::HostClock& clock);
  ~BenchTarget() override;

  Result<Done> start() override;
  void run(std::int64_t until_ns, const io::Batch& sensed) override;
  Result<TargetState> arrive(io::Batch& happened) override;
  void stop(io::Batch& happened) override;
  std::vector<std::pair<std::string, std::string>> versions() const override;
  Offers offers() const override;
  bool sees(const std::string& wires) const override;
  bool spoils(const std::string& what, const std::string& kind) const override {
    const auto part = options_.played.find(what);
    return part != options_.played.end() && part->second(kind);
  }
  std::string why_ended() const override { return why_; }
  const HeldPace* held_pace() const override { return &held_; }

 private:
  BenchTime time();
  Result<Done> serve_until(std::int64_t due_host_ns);
  Result<Done> serve_all(std::int64_t now_host_ns);
  void tell(std::int64_t until_ns, io::Batch& happened);
  void make_safe(const std::string& why);

  BenchOptions options_;
  std::vector<std::unique_ptr<Link>> links_;
  pacing::HostClock& clock_;
  pacing::Pacer pacer_;
  HeldPace held_;
  Arrivals arrivals_;
  std::int64_t until_ns_ = 0;
  std::string why_;  // made safe, and by what; empty: not
  bool started_ = false, stopped_ = false;
  bool host_stopped_ = false;  // by the operator or the host: nothing of the firmware's
};

}  // namespace whirl::bench
