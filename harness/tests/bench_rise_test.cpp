// The way of a bench from end to end, without its copper: the ESC's real image runs as a stand-in at a pace, its
// serial line and load cell on pseudo-terminals, its I2C behind a bridge that takes its time; the plan of the bench
// is run against it as against metal.
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

TEST(Bench, TheThrustRiseOfTheRealImageIsMeasuredOverItsWires) {
  const ScratchFolder folder;
  Metal metal(folder, 0.15);
  const auto wire = [&](const bench::BridgeLink&) -> Result<std::unique_ptr<bench::I2cPort>> {
    return std::unique_ptr<bench::I2cPort>(std::make_unique<WireOfStandIn>(**metal.stand_in));
  };
  expect_a_rise(run_on_bench(folder, metal, R"(bus = "i2c2", bridge = "cp2112")", {wire}), metal);
}

// The same over DroneCAN: the board's CAN and the bench's on one bus in memory, in place of an interface.
TEST(Bench, TheThrustRiseOfTheRealImageIsMeasuredOverCan) {
  const ScratchFolder folder;
  io::MemoryCan bus([] { return pacing::MonotonicClock().now_ns(); });
  Metal metal(folder, 0.15, bus.join());
  const auto can = [&](const bench::CanBusLink&) -> Result<std::unique_ptr<io::CanPort>> {
    return bus.join();
  };
  expect_a_rise(
      run_on_bench(folder, metal, R"(bus = "can1", interface = "memory")", {nullptr, can}), metal);
}

}  // namespace
}  // namespace whirl
