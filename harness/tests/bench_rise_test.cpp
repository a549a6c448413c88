// The way of a bench from end to end, without its copper: the ESC's real image runs as a stand-in at a pace, its
// serial line and load cell on pseudo-terminals, its I2C behind a bridge that takes its time; the plan of the bench
// is run against it as against metal.
#include "harness/tests/common_clock.hpp"
#include "harness/tests/stand_in_rise.hpp"
#include "io_bridges/socketcan/tests/memory_can.hpp"

namespace whirl {
namespace {

class WireOfStandIn final : public bench::I2cPort {
 public:
  explicit WireOfStandIn(StandIn& stand_in) : stand_in_(stand_in) {}
  Result<Done> open() override { return Done{}; }
  Result<bench::TransferOutcome> transfer(const bench::Transfer& transfer) override {
    return stand_in_.transfer(transfer);
  }
  void close() override {}
  std::string version() const override { return "a wire to the stand-in"; }

 private:
  StandIn& stand_in_;
};

// Its bridge has a thread of its own, which holds its times by the host's clock: who is late there is late. Then it is done once
// more, slower; a test that has shown nothing does not pass.
TEST(Bench, TheThrustRiseOfTheRealImageIsMeasuredOverItsWires) {
  std::string late;
  for (const double pace : {0.15, 0.0125}) {
    const ScratchFolder folder;
    Metal metal(folder, pace);
    const auto wire = [&](const bench::BridgeLink&) -> Result<std::unique_ptr<bench::I2cPort>> {
      return std::unique_ptr<bench::I2cPort>(std::make_unique<WireOfStandIn>(**metal.stand_in));
    };
    const ComposedRun run =
        run_on_bench(folder, metal, R"(bus = "i2c2", bridge = "cp2112")", {wire});
    late = why_not_judged(run, metal);
    if (late.empty()) return expect_a_rise(run);
    std::printf("not judged at a pace of %g: %s\n", pace, late.c_str());
  }
  FAIL() << "nothing was shown, at either pace: " << late
         << "\nthis machine is too busy for a bench; run it again when less is at work";
}

// The same over DroneCAN: the board's CAN and the bench's on one bus in memory, in place of an interface. All of it is on one
// clock, which waits for both: nobody is late, on any machine.
TEST(Bench, TheThrustRiseOfTheRealImageIsMeasuredOverCan) {
  constexpr std::int64_t kAhead_ns = 1'000'000'000'000'000'000;  // 30 years
  CommonClock clock(kAhead_ns);
  const ScratchFolder folder;
  io::MemoryCan bus([&] { return clock.now_ns(); });
  Metal metal(folder, 0.5, bus.join(), &clock);
  const auto can = [&](const bench::CanBusLink&) -> Result<std::unique_ptr<io::CanPort>> {
    return bus.join();
  };
  const ComposedRun run =
      run_on_bench(folder, metal, R"(bus = "can1", interface = "memory")", {nullptr, can, &clock});
  EXPECT_EQ((*metal.stand_in)->lateness().slipped_ns, 0);
  expect_a_rise(run);
}

}  // namespace
}  // namespace whirl
