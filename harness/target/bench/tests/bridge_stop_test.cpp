// From an emergency to the zero set-point at the ESC's end of the I2C bus: the bench's loop, the bridge's thread and its
// client at a played chip, in the host's time, with a transfer open that does not end by itself.
//
//   Host   one that is busy only ever adds to the time, so the least of several stops is judged. That the bridge's share
//          is short wherever in a transfer the stop comes is shown in virtual time (io_bridges/hid/tests/stop_in_transfer_test.cpp)
#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <functional>
#include <optional>

#include "harness/target/bench/bench_target.hpp"
#include "harness/target/bench/hid_port.hpp"
#include "harness/target/bench/tests/live_hid_port.hpp"
#include "io_bridges/devices/esc_i2c.hpp"
#include "io_bridges/hid/tests/bridge_bench.hpp"

namespace whirl::bench {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kHeartbeat_ns = 100 * kMs;
constexpr std::uint8_t kEsc = 0x29, kNobody = 0x2A, kStuck = 0x2B;

// Holds SCL low once it is spoken to, until it is told to let go: asked each 100 us.
class StuckTarget final : public io::I2cTarget {
 public:
  explicit StuckTarget(io::I2cBus& bus) : bus_(bus) {}
  bool answers(std::uint8_t address) const override { return address == kStuck; }
  bool start(std::uint8_t, bool, std::int64_t now) override {
    bus_.scl().force(io::Drive::low, now);
    return true;
  }
  bool write(std::uint8_t, std::int64_t) override { return true; }
  std::uint8_t read(std::int64_t) override { return 0; }
  void acked(bool, std::int64_t) override {}
  void stop(std::int64_t now) override { let_go(now); }  // of a controller that gives the bus up
  void let_go(std::int64_t now) { bus_.scl().force(io::Drive::none, now); }

 private:
  io::I2cBus& bus_;
};

struct BridgeStop {
  explicit BridgeStop(io::BridgeKind kind) : chip(kind) {
    chip.bus.add(esc);
    chip.bus.add(stuck);
    esc.on_setpoint([this](const io::EscI2c::Write& write) {
      if (!write.valid) return;
      if (write.v > 0) zero_host_ns = -1;
      if (write.v == 0 && zero_host_ns < 0) zero_host_ns = begin_ns + write.stop_ns;
      ++writes;
    });
    BridgeLink link{.name = "throttle", .kind = "", .serial = "", .bus = 2};
    const auto opener = [this, kind](io::BridgeKind, const std::string&,
                                     const io::I2cBridgeSettings& settings) {
      return io::start_i2c_bridge(
          kind, std::make_unique<LiveHidPort>(chip.queue, *chip.chip, chip.cable, begin_ns),
          settings);
    };
    const auto zero = io::pack_setpoint(kEsc, 0);
    std::vector<std::unique_ptr<Link>> links;
    links.push_back(
        std::make_unique<BridgeThread>(BridgeOptions{.name = "throttle",
                                                     .bus = 2,
                                                     .safe = {kEsc, {zero.begin(), zero.end()}, 0},
                                                     .heartbeat_ns = kHeartbeat_ns},
                                       hid_port_over(link, opener)));
    BenchOptions options;
    options.real_time = false;
    options.bench.late_ns = 5 * kMs;
    options.bench.safety.longest_ns = 60'000 * kMs;
    options.bench.safety.heartbeat_ns = kHeartbeat_ns;
    options.operator_stops = [this] { return enter.load(); };
    target.emplace(std::move(options), std::move(links), clock);
    EXPECT_TRUE(target->start().ok());
  }
  ~BridgeStop() {
    io::Batch nothing;
    target->stop(nothing);
  }
  Result<TargetState> step() {
    t_ns += kMs;
    target->run(t_ns, sensed);
    sensed.clear();
    io::Batch happened;
    return target->arrive(happened);
  }
  void order(std::uint8_t address, std::vector<std::uint8_t> write, std::uint16_t read) {
    const io::I2cOrder head{address, read, 1};
    sensed.add(io::Kind::i2c_order, 2, t_ns, head, write.data(),
               static_cast<std::uint32_t>(write.size()));
  }
  // The ESC turns, and then a transfer to `address` is open, and others wait. False: the host did not turn the loop.
  bool open(std::uint8_t address) {
    const auto turns = io::pack_setpoint(kEsc, 800);
    order(kEsc, {turns.begin(), turns.end()}, 0);
    for (int k = 0; k < 30; ++k) {
      if (!step()) return false;
    }
    for (int k = 0; k < 20; ++k) order(address, {}, 6);
    for (int k = 0; k < 4; ++k) {
      if (!step()) return false;
    }
    return writes == 1 && zero_host_ns < 0;
  }
  double zero_after_ms(std::int64_t since_ns) {
    while (zero_host_ns < 0) clock.sleep_until(clock.now_ns() + kMs / 10);
    return static_cast<double>(zero_host_ns - since_ns) * 1e-6;
  }

  pacing::MonotonicClock clock;
  std::int64_t begin_ns = clock.now_ns(), t_ns = 0;
  std::atomic<std::int64_t> zero_host_ns = -1;  // since when the ESC gets zeros only
  std::atomic<int> writes = 0;
  std::atomic<bool> enter = false;
  io::BridgeBench chip;  // the thread's, once it runs
  io::EscI2c esc{kEsc};
  StuckTarget stuck{chip.bus};
  io::Batch sensed;
  std::optional<BenchTarget> target;
};

struct Emergency {
  const char* name;
  double limit_ms;
  std::function<void(BridgeStop&)> come;
};

const Emergency kEmergencies[] = {
    {"a limit", 20.0,
     [](BridgeStop& bench) {
       const std::string why = "current is 30 A";
       bench.sensed.add(io::Kind::emergency_stop, 0, bench.t_ns, why.data(),
                        static_cast<std::uint32_t>(why.size()));
       EXPECT_EQ(bench.step().value(), TargetState::over_limit);
     }},
    {"the operator's key", 20.0,
     [](BridgeStop& bench) {
       bench.enter = true;
       EXPECT_FALSE(bench.step().ok());
     }},
    {"the run's end, as by Ctrl-C", 20.0,
     [](BridgeStop& bench) {
       io::Batch happened;
       bench.target->stop(happened);
     }},
    {"the last turn of the loop", static_cast<double>(kHeartbeat_ns) * 1e-6 + 20.0,
     [](BridgeStop&) {}},
};

class BridgeStops : public ::testing::TestWithParam<io::BridgeKind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, BridgeStops,
                         ::testing::Values(io::BridgeKind::mcp2221a, io::BridgeKind::cp2112),
                         [](const auto& of) {
                           return of.param == io::BridgeKind::mcp2221a ? "Mcp2221" : "Cp2112";
                         });

TEST_P(BridgeStops, TheZeroIsAtTheEscInTimeWhateverTransferIsOpen) {
  constexpr int kMost_stops = 10;
  for (const Emergency& emergency : kEmergencies) {
    for (const std::uint8_t address : {kEsc, kNobody, kStuck}) {
      double least_ms = 1e9;
      for (int stop = 0; stop < kMost_stops && least_ms >= emergency.limit_ms; ++stop) {
        BridgeStop bench(GetParam());
        if (!bench.open(address)) continue;
        const std::int64_t since_ns = bench.clock.now_ns();
        emergency.come(bench);
        least_ms = std::min(least_ms, bench.zero_after_ms(since_ns));
      }
      std::printf("zero %.2f ms after %s, 0x%02x asked\n", least_ms, emergency.name,
                  unsigned{address});
      EXPECT_LT(least_ms, emergency.limit_ms) << emergency.name << ", " << int{address};
    }
  }
}

}  // namespace
}  // namespace whirl::bench
