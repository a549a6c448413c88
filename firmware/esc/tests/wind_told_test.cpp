// When power is held to tell the wind, and what of it is believed.
#include "base/near.hpp"
#include "firmware/esc/tests/air_bench.hpp"

namespace fw::esc {
namespace {

using whirl::near;
using whirl::stated;

TEST(ThrustByPower, DoesNotWaverWhereItJustBeginsToTell) {
  Calibration cautious = calibrated(Mode::thrust_by_power);
  cautious.shared_power = 0.96f;
  AirBench bench(cautious);
  bench.start(3.2);
  const auto turns = [&](bool wanted, double step_mps) {
    for (int i = 0; i < 200 && bench.core.estimator().observable() != wanted; ++i) {
      bench.down_mps += step_mps;
      bench.hold(3.2, 300);
    }
    return bench.down_mps;
  };
  const double on_mps = turns(true, 0.05), off_mps = turns(false, -0.05);
  EXPECT_GT(on_mps, 1.0);
  EXPECT_GT(off_mps, 1.0);
  EXPECT_LT(off_mps, on_mps - 0.1);
}

// What it is told makes it turn faster, and a faster rotor loses a smaller share of its power to the same wind.
TEST(ThrustByPower, IsNotTalkedOutOfAWindByItsOwnAnswerToIt) {
  for (float shared : {0.93f, 0.95f, 0.97f}) {
    for (double down = 1.5; down < 4.5; down += 0.05) {
      Calibration cautious = calibrated(Mode::thrust_by_power);
      cautious.shared_power = shared;
      AirBench bench(cautious);
      bench.start(2.8);
      bench.down_mps = down;
      bench.hold(2.8, 1000);
      const bool told = bench.core.estimator().observable();
      for (int k = 0; k < 20; ++k) {
        bench.hold(2.8, 100);
        ASSERT_EQ(bench.core.estimator().observable(), told)
            << shared << ", " << down << " m/s, " << k;
      }
    }
  }
}

// Its bearings drag by a fifth more than when it was calibrated: in still air that looks like power that no air takes.
TEST(ThrustByPower, TakesOffWhatNoAirCanTake) {
  Calibration warm = calibrated(Mode::thrust_by_power);
  warm.losses.drag_Nm *= 0.8f;
  AirBench bench(warm);
  bench.start(3.2);
  bench.down_mps = 3.5;
  bench.hold(3.2, 1500);
  EXPECT_TRUE(
      near(bench.mean_thrust_N(500), 3.2, stated(0.03 * 3.2, "4 % of power are 10 % of thrust")));
}

}  // namespace
}  // namespace fw::esc
