// A bench's CAN on a real kernel: an ESC that a thread plays on vcan0, the check of the bus, and how soon each kind of
// emergency has a zero set-point there. Only inside the guest.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <thread>

#include "harness/pacing/host_clock.hpp"
#include "harness/stand/can_throttle.hpp"
#include "harness/target/bench/bench_target.hpp"
#include "harness/target/bench/can_check.hpp"
#include "harness/target/bench/can_link.hpp"
#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/local_node.hpp"

namespace whirl::bench {
namespace {

namespace dc = io::dronecan;
constexpr std::int64_t kMs = 1'000'000;
constexpr const char* kInterface = "vcan0";

std::int64_t now_ns() {
  return pacing::MonotonicClock().now_ns();
}

class PlayedEsc {
 public:
  PlayedEsc() {
    auto port = socket_can_port({"bus", kInterface});
    EXPECT_TRUE(port.ok()) << port.error().message();
    port_ = std::move(port.value());
    thread_ = std::thread([this] { work(); });
  }
  ~PlayedEsc() {
    ends_ = true;
    thread_.join();
  }
  std::atomic<int> commands = 0, last = 0;
  std::atomic<std::int64_t> zero_since_ns = -1;  // of an unbroken row of zeros

 private:
  void work() {
    std::int64_t next_status_ns = now_ns();
    while (!ends_) {
      pollfd file{port_->file(), POLLIN, 0};
      poll(&file, 1, 5);
      node_.poll(now_ns());
      if (now_ns() >= next_status_ns) {
        next_status_ns += 50 * kMs;
        node_.broadcast(dc::EscStatus{.voltage_V = 16, .speed_rpm = last.load() > 0 ? 3000 : 0},
                        16);
      }
      while (const auto got = port_->receive().value()) {
        if (got->own || got->trouble) continue;
        if (const auto* transfer = node_.on_frame(got->frame, got->host_ns)) {
          if (const auto raw = node_.read<dc::RawCommand>(*transfer)) obey(*raw, got->host_ns);
        }
      }
    }
  }
  void obey(const dc::RawCommand& raw, std::int64_t at_ns) {
    ++commands;
    last = raw.commands.items[0];
    if (last != 0) {
      zero_since_ns = -1;
    } else if (zero_since_ns < 0) {
      zero_since_ns = at_ns;
    }
  }

  std::unique_ptr<io::CanPort> port_;
  dc::LocalNode node_{20, "org.example.esc",
                      [this](const io::CanFrame& frame) { std::ignore = port_->send(frame); }};
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

struct CanBench {
  explicit CanBench(std::int64_t heartbeat_ns = 1000 * kMs) {
    BenchOptions options;
    options.real_time = false;
    options.bench.late_ns = 5 * kMs;
    options.bench.safety = {
        .phrase = "", .limits = {}, .longest_ns = 60'000 * kMs, .heartbeat_ns = heartbeat_ns};
    options.operator_stops = [this] { return enter; };
    std::vector<std::unique_ptr<Link>> links;
    links.push_back(std::make_unique<CanLink>(
        CanOptions{.link = {"bus", kInterface}, .heartbeat_ns = heartbeat_ns}, socket_can_port));
    target.emplace(std::move(options), std::move(links), clock);
    EXPECT_TRUE(target->start().ok());
  }
  // Until the ESC has got a set-point that is not zero.
  void turn(const PlayedEsc& esc) {
    throttle.set(1000);
    while (esc.last == 0) ASSERT_TRUE(step().ok());
    for (int k = 0; k < 100; ++k) ASSERT_TRUE(step().ok());
    ASSERT_GT(esc.last, 0);
  }
  Result<TargetState> step() {
    io::Batch sensed;
    throttle.send(t_ns, sensed);
    if (!emergency.empty()) {
      sensed.add(io::Kind::emergency_stop, 0, t_ns, emergency.data(),
                 static_cast<std::uint32_t>(emergency.size()));
    }
    t_ns += kMs;
    target->run(t_ns, sensed);
    happened.clear();
    auto state = target->arrive(happened);
    for (io::Reader r(happened.bytes()); r.next();) {
      if (r.header().kind == io::Kind::can_transfer) throttle.on_message(r);
    }
    return state;
  }

  pacing::MonotonicClock clock;
  stand::CanThrottle throttle{1, 1};
  bool enter = false;
  std::string emergency;
  std::int64_t t_ns = 0;
  io::Batch happened;
  std::optional<BenchTarget> target;
};

// How long after `since_ns` the ESC has a zero, and nothing but zeros from then on.
double zero_after_ms(const PlayedEsc& esc, std::int64_t since_ns) {
  while (esc.zero_since_ns < 0) pacing::MonotonicClock().sleep_until(now_ns() + kMs / 10);
  const std::int64_t zero_ns = esc.zero_since_ns;
  const int commands = esc.commands;
  while (esc.commands < commands + 5) pacing::MonotonicClock().sleep_until(now_ns() + kMs);
  EXPECT_EQ(esc.zero_since_ns, zero_ns);
  return static_cast<double>(zero_ns - since_ns) * 1e-6;
}

TEST(BenchCan, TheCheckFindsTheEscByItsName) {
  PlayedEsc esc;
  const auto port = socket_can_port({"bus", kInterface});
  ASSERT_TRUE(port.ok()) << port.error().message();
  pacing::MonotonicClock clock;
  const auto told = check_can_bus(*port.value(), clock, {.interface = kInterface, .seconds = 1.5});
  ASSERT_TRUE(told.ok()) << told.error().message();
  for (const std::string& line : told.value()) std::printf("figure: %s\n", line.c_str());
  EXPECT_NE(told.value()[1].find("node 20 org.example.esc: 50 of 50"), std::string::npos);
}

TEST(BenchCan, TheEscIsCommandedAndItsWordComesBack) {
  PlayedEsc esc;
  CanBench bench;
  bench.turn(esc);
  EXPECT_GE(bench.throttle.on_wire_ns(), 0);
  EXPECT_GT(bench.throttle.reported().speed_rpm, 0);
  EXPECT_EQ(bench.throttle.reported().refused, 0u);
}

TEST(BenchCan, ALimitHasAZeroOnTheBusWithinTwentyMilliseconds) {
  PlayedEsc esc;
  CanBench bench;
  bench.turn(esc);
  bench.emergency = "supply_current is 30";
  const std::int64_t since_ns = now_ns();
  ASSERT_TRUE(bench.step().ok());
  const double after_ms = zero_after_ms(esc, since_ns);
  std::printf("figure: CAN: zero %.2f ms after a limit\n", after_ms);
  EXPECT_LT(after_ms, 20.0);
}

TEST(BenchCan, TheOperatorsKeyHasAZeroOnTheBusWithinTwentyMilliseconds) {
  PlayedEsc esc;
  CanBench bench;
  bench.turn(esc);
  bench.enter = true;
  const std::int64_t since_ns = now_ns();
  EXPECT_FALSE(bench.step().ok());
  const double after_ms = zero_after_ms(esc, since_ns);
  std::printf("figure: CAN: zero %.2f ms after the operator's key\n", after_ms);
  EXPECT_LT(after_ms, 20.0);
}

TEST(BenchCan, TheRunsEndHasAZeroOnTheBusWithinTwentyMilliseconds) {
  PlayedEsc esc;
  CanBench bench;
  bench.turn(esc);
  const std::int64_t since_ns = now_ns();
  bench.target->stop(bench.happened);  // as Ctrl-C ends it
  while (esc.zero_since_ns < 0) pacing::MonotonicClock().sleep_until(now_ns() + kMs / 10);
  const double after_ms = static_cast<double>(esc.zero_since_ns - since_ns) * 1e-6;
  std::printf("figure: CAN: zero %.2f ms after the run's end\n", after_ms);
  EXPECT_LT(after_ms, 20.0);
}

TEST(BenchCan, ALostHeartbeatHasAZeroOnTheBusWithinTwentyMillisecondsOfItsLimit) {
  PlayedEsc esc;
  CanBench bench(100 * kMs);
  bench.turn(esc);
  const double after_ms = zero_after_ms(esc, now_ns());  // the loop does not turn
  std::printf("figure: CAN: zero %.2f ms after the last turn, of a heartbeat of 100 ms\n",
              after_ms);
  EXPECT_LT(after_ms, 120.0);
}

}  // namespace
}  // namespace whirl::bench
