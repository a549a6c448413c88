#include "harness/cli/pace_command.hpp"

#include <sched.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <thread>
#include <tuple>
#include <vector>

#include "base/interruption.hpp"
#include "harness/cli/console.hpp"
#include "harness/executive/held_pace.hpp"
#include "harness/pacing/real_time.hpp"
#include "harness/target/bench/bench_target.hpp"

namespace whirl::cli {
namespace {

constexpr std::int64_t kMs_ns = 1'000'000;
constexpr std::int64_t kTurn_steps = 5'000;
constexpr double kMore_allowed = 0.001;  // of the steps
constexpr std::array<double, 8> kBins_us = {10, 20, 50, 100, 200, 500, 1000, 10'000};

struct Arm {
  std::vector<double> late_us;
  double share(double limit_us) const {
    const auto late =
        std::count_if(late_us.begin(), late_us.end(), [&](double x) { return x > limit_us; });
    return late_us.empty() ? std::nan("")
                           : static_cast<double>(late) / static_cast<double>(late_us.size());
  }
  double worst_us() const {
    return late_us.empty() ? std::nan("") : *std::max_element(late_us.begin(), late_us.end());
  }
};

void run_empty(pacing::HostClock& clock, std::int64_t steps, Arm& arm) {
  const std::int64_t zero_ns = clock.now_ns() + kMs_ns;
  for (std::int64_t k = 0; k < steps; ++k) {
    const std::int64_t due_ns = zero_ns + k * kMs_ns;
    clock.sleep_until(due_ns);
    arm.late_us.push_back(static_cast<double>(clock.now_ns() - due_ns) * 1e-3);
  }
}

HeldPace run_bench(pacing::HostClock& clock, std::int64_t steps, std::int64_t late_ns, Arm& arm) {
  bench::BenchOptions options;
  options.real_time = false;  // both arms have it already
  options.bench.late_ns = late_ns;
  options.bench.late_share = 0.01;
  options.bench.safety.longest_ns = INT64_MAX;
  bench::BenchTarget target(std::move(options), {}, clock);
  std::ignore = target.start();
  io::Batch nothing, happened;
  for (std::int64_t k = 1; k <= steps; ++k) {
    target.run(k * kMs_ns, nothing);
    happened.clear();
    std::ignore = target.arrive(happened);
  }
  for (const double late_s : target.held_pace()->lateness_s) arm.late_us.push_back(late_s * 1e6);
  return *target.held_pace();
}

// Before the paced thread in the scheduler's eyes: 3 ms of each 10.
class Burners {
 public:
  explicit Burners(int count) {
    for (int i = 0; i < count; ++i) threads_.emplace_back([this] { burn(); });
  }
  ~Burners() {
    stop_ = true;
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  void burn() const {
    sched_param first{};
    first.sched_priority = 60;
    sched_setscheduler(0, SCHED_FIFO, &first);
    pacing::MonotonicClock clock;
    // All in step: a thread that is pushed from one core finds the others taken too.
    const std::int64_t zero_ns = (clock.now_ns() / (10 * kMs_ns) + 1) * 10 * kMs_ns;
    for (std::int64_t t_ns = zero_ns; !stop_; t_ns += 10 * kMs_ns) {
      clock.sleep_until(t_ns);
      while (clock.now_ns() < t_ns + 3 * kMs_ns && !stop_) {
      }
    }
  }
  std::atomic<bool> stop_ = false;
  std::vector<std::thread> threads_;
};

void show(const char* name, const Arm& arm, double late_us) {
  std::printf("  %-12s", name);
  double from = 0.0;
  for (std::size_t i = 0; i <= kBins_us.size(); ++i) {
    const double to = i < kBins_us.size() ? kBins_us[i] : INFINITY;
    const auto in = std::count_if(arm.late_us.begin(), arm.late_us.end(),
                                  [&](double x) { return x >= from && x < to; });
    std::printf(" %8lld", static_cast<long long>(in));
    from = to;
  }
  std::printf("   %.3f %% later than %g us, most %.2f ms\n", 100.0 * arm.share(late_us), late_us,
              arm.worst_us() * 1e-3);
}

}  // namespace

int bench_pace_command(const PaceOptions& options) {
  pacing::MonotonicClock clock;
  const Burners burners(options.overload);
  const pacing::RealTime got = pacing::take_real_time();
  const auto late_ns = static_cast<std::int64_t>(options.late_us * 1e3);
  Arm empty, bench;
  HeldPace held;
  held.late_ns = late_ns;
  held.late_share = 0.01;
  auto left = static_cast<std::int64_t>(options.seconds * 1e3);
  for (; left > 0 && interrupted_by() == 0; left -= kTurn_steps) {
    const std::int64_t steps = std::min(left, kTurn_steps);
    run_empty(clock, steps, empty);
    const HeldPace turn = run_bench(clock, steps, late_ns, bench);
    held.late_steps += turn.late_steps;
    held.slipped_ns += turn.slipped_ns;
    held.lateness_s.insert(held.lateness_s.end(), turn.lateness_s.begin(), turn.lateness_s.end());
  }
  pacing::give_back_real_time();
  std::printf("1 kHz, %s; steps by lateness in us:\n  %-12s", got.told.c_str(), "");
  for (const double bin : kBins_us) std::printf("     <%4.0f", bin);
  std::printf("     more\n");
  show("empty loop", empty, options.late_us);
  show("bench loop", bench, options.late_us);
  results::Report report;
  report_pace(&held, 0.0, report);
  if (!report.untimely.empty()) {
    std::printf("a run would be inconclusive: %s\n", report.untimely.c_str());
    return 3;
  }
  const double more = bench.share(options.late_us) - empty.share(options.late_us);
  const bool holds = more <= kMore_allowed;
  std::printf("the bench's loop is late %+.3f %% more often than an empty one: %s 0.1 %%\n",
              100.0 * more, holds ? "within" : "more than");
  if (!got.first_in_line) return 3;
  return holds ? 0 : 1;
}

}  // namespace whirl::cli
