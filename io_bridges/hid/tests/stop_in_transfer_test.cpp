// A stop while a bridge's transfer is open, in virtual time: how long after it the zero set-point has arrived at the ESC,
// for a stop at every quarter of a millisecond of the transfer.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "io_bridges/devices/esc_i2c.hpp"
#include "io_bridges/hid/tests/bridge_bench.hpp"

namespace whirl::io {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr Nanoseconds kMs = 1'000'000;
constexpr std::uint8_t kEsc = 0x29, kNobody = 0x2A, kStretcher = 0x2B;
constexpr double kLimit_ms = 20.0;

// Holds SCL low from the first byte that it is sent until `until_ns`, or until the bus is given up.
class Stretcher final : public I2cTarget {
 public:
  explicit Stretcher(I2cBus& bus) : bus_(bus) {}
  bool answers(std::uint8_t address) const override { return address == kStretcher; }
  bool start(std::uint8_t, bool, Nanoseconds) override { return true; }
  bool write(std::uint8_t, Nanoseconds now) override {
    hold(now);
    return true;
  }
  std::uint8_t read(Nanoseconds now) override {
    hold(now);
    return 0;
  }
  void acked(bool, Nanoseconds) override {}
  void stop(Nanoseconds now) override { bus_.scl().force(Drive::none, now); }
  Nanoseconds until_ns = 0;
  bool for_ever = false;

 private:
  void hold(Nanoseconds now) {
    bus_.hold_until(until_ns);
    if (for_ever) bus_.scl().force(Drive::low, now);
  }
  I2cBus& bus_;
};

struct OpenTransfer {
  std::uint8_t address = kEsc;
  Bytes write;
  std::size_t read = 0;
};

// An ESC that has turned, with a bridge that is told to stop.
struct StopBench {
  explicit StopBench(BridgeKind kind) : bench(kind) {
    bench.bus.add(esc);
    bench.bus.add(stretcher);
    esc.on_setpoint([this](const EscI2c::Write& write) {
      if (write.valid && write.v == 0 && !zero_ns) zero_ns = write.stop_ns;
    });
    I2cBridgeSettings settings;  // as a bench file has them
    settings.speed_Hz = 100'000;
    settings.timeout_ns = 20 * kMs;
    bridge = std::move(
        start_i2c_bridge(
            kind, std::make_unique<MemoryHidPort>(bench.queue, *bench.chip, bench.cable), settings)
            .value());
    bridge->stop_when([this] { return bench.queue.now() >= stop_ns; });
    EXPECT_TRUE(bridge->write(kEsc, pack_setpoint(kEsc, 800)).ok());  // it has been used
  }

  // As the bench's thread does it: ended, then zeros, one each 10 ms.
  double zero_after_ms(const OpenTransfer& open, Nanoseconds stop_after_ns) {
    stop_ns = bench.queue.now() + stop_after_ns;
    bridge->transfer(open.address, open.write, open.read);
    bench.queue.run_until(std::max(bench.queue.now(), stop_ns));
    for (int tries = 0; !zero_ns && tries < 200; ++tries) {
      const Nanoseconds next_ns = bench.queue.now() + 10 * kMs;
      bridge->transfer(kEsc, pack_setpoint(kEsc, 0), 0, true);
      bench.queue.run_until(std::max(bench.queue.now(), zero_ns ? 0 : next_ns));
    }
    EXPECT_TRUE(zero_ns.has_value());
    return static_cast<double>(zero_ns.value_or(1'000'000 * kMs) - stop_ns) * 1e-6;
  }

  BridgeBench bench;
  EscI2c esc{kEsc};
  Stretcher stretcher{bench.bus};
  std::optional<Nanoseconds> zero_ns;  // the first one's STOP
  Nanoseconds stop_ns = 3'600'000 * kMs;
  std::unique_ptr<I2cBridge> bridge;
};

class StopInTransfer : public ::testing::TestWithParam<BridgeKind> {
 protected:
  // The worst of stops from the transfer's begin to `until_ns` behind it.
  template <typename Prepare>
  double worst_ms(const char* what, const OpenTransfer& open, Nanoseconds until_ns,
                  Prepare prepare) {
    double worst = 0.0;
    for (Nanoseconds at_ns = 0; at_ns <= until_ns; at_ns += kMs / 4) {
      StopBench bench(GetParam());
      prepare(bench, at_ns);
      worst = std::max(worst, bench.zero_after_ms(open, at_ns));
    }
    std::printf("zero at most %.2f ms after a stop: %s\n", worst, what);
    return worst;
  }
  static void leave(StopBench&, Nanoseconds) {}
};
INSTANTIATE_TEST_SUITE_P(Kinds, StopInTransfer,
                         ::testing::Values(BridgeKind::mcp2221a, BridgeKind::cp2112),
                         [](const auto& of) {
                           return of.param == BridgeKind::mcp2221a ? "Mcp2221" : "Cp2112";
                         });

TEST_P(StopInTransfer, AnEscThatAnswers) {
  EXPECT_LT(worst_ms("of a set-point", {kEsc, Bytes{100, 0, 0}, 0}, 10 * kMs, leave), kLimit_ms);
  EXPECT_LT(worst_ms("of a status read", {kEsc, {}, 6}, 10 * kMs, leave), kLimit_ms);
}

TEST_P(StopInTransfer, OneThatIsSilent) {
  EXPECT_LT(worst_ms("nobody there, a write", {kNobody, Bytes{1, 2, 3}, 0}, 20 * kMs, leave),
            kLimit_ms);
  EXPECT_LT(worst_ms("nobody there, a read", {kNobody, {}, 6}, 20 * kMs, leave), kLimit_ms);
}

TEST_P(StopInTransfer, OneThatHoldsTheClockUntilTheStopsTime) {
  const auto hold = [](StopBench& bench, Nanoseconds stop_after_ns) {
    bench.stretcher.until_ns = bench.bench.queue.now() + stop_after_ns;
  };
  EXPECT_LT(worst_ms("clock held, a write", {kStretcher, Bytes(40), 0}, 45 * kMs, hold), kLimit_ms);
  EXPECT_LT(worst_ms("clock held, a read", {kStretcher, {}, 40}, 45 * kMs, hold), kLimit_ms);
}

TEST_P(StopInTransfer, OneThatHoldsTheClockUntilTheBusIsGivenUp) {
  const auto hold = [](StopBench& bench, Nanoseconds) { bench.stretcher.for_ever = true; };
  EXPECT_LT(worst_ms("clock held, a write", {kStretcher, Bytes(40), 0}, 45 * kMs, hold), kLimit_ms);
  EXPECT_LT(worst_ms("clock held, a read", {kStretcher, {}, 40}, 45 * kMs, hold), kLimit_ms);
}

TEST_P(StopInTransfer, ALongTransfer) {
  EXPECT_LT(worst_ms("of 500 bytes", {kStretcher, {}, 500}, 50 * kMs, leave), kLimit_ms);
}

// No zero passes a bus whose line is held: it does within the limit of the line's release.
TEST_P(StopInTransfer, ABusThatIsStuckIsTriedAgainUntilItIsFree) {
  double worst = 0.0;
  for (const bool clock : {true, false}) {
    for (Nanoseconds stuck_ns = 30 * kMs; stuck_ns < 60 * kMs; stuck_ns += kMs / 4) {
      StopBench bench(GetParam());
      Wire& line = clock ? bench.bench.bus.scl() : bench.bench.bus.sda();
      line.force(Drive::low, bench.bench.queue.now());
      Event let_go(bench.bench.queue, [&] { line.force(Drive::none, bench.bench.queue.now()); });
      let_go.in(stuck_ns);
      const double after_ms = bench.zero_after_ms({kEsc, Bytes{100, 0, 0}, 0}, 5 * kMs);
      worst = std::max(worst, after_ms - static_cast<double>(stuck_ns - 5 * kMs) * 1e-6);
    }
  }
  std::printf("zero at most %.2f ms after the bus is free\n", worst);
  EXPECT_LT(worst, kLimit_ms);
}

TEST_P(StopInTransfer, WhatIsUrgentIsNotEndedByTheStop) {
  StopBench bench(GetParam());
  bench.stop_ns = 0;
  EXPECT_TRUE(bench.bridge->transfer(kEsc, pack_setpoint(kEsc, 0), 0, true).ok());
  EXPECT_TRUE(bench.bridge->transfer(kEsc, {}, 6, true).ok());
  EXPECT_EQ(bench.bridge->transfer(kStretcher, Bytes(60), 0).outcome, I2cOutcome::timed_out);
  bench.bench.bus.scl().force(Drive::low, bench.bench.queue.now());
  const I2cTransfer none = bench.bridge->transfer(kEsc, pack_setpoint(kEsc, 0), 0, true);
  EXPECT_FALSE(none.ok());
  EXPECT_LT(none.end_ns - none.begin_ns, 20 * kMs);  // and then it is tried again
}

}  // namespace
}  // namespace whirl::io
