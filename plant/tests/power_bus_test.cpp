#include "plant/power_bus.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "base/random.hpp"

namespace whirl::plant {
namespace {

struct Rig {
  std::array<AveragedMotor, 4> motors{AveragedMotor(MotorParams{}), AveragedMotor(MotorParams{}),
                                      AveragedMotor(MotorParams{}), AveragedMotor(MotorParams{})};
  std::array<Drive, 4> drives;
  std::array<ShaftLoad, 4> loads;
  std::array<MotorBooks, 4> books;
  BusDraw step(Battery& pack, double avionics_A) {
    return step_bus(motors, drives, loads, avionics_A, pack, 1.25e-4, books);
  }
};

TEST(PowerBus, VoltageAndCurrentsAgreeWithOhmAtEveryStep) {
  Rig rig;
  Battery pack(lipo_4s_2200());
  RandomStream random(3, "bus");
  for (int k = 0; k < 20000; ++k) {
    for (int i = 0; i < 4; ++i) {
      if (k % 40 == 10 * i)
        rig.drives[i] = {.duty = random.uniform(), .diode = random.bits() % 2 == 0};
      rig.loads[i].quadratic_Nm_s2 = 2e-7;
    }
    const double source = pack.source_V();
    const BusDraw draw = rig.step(pack, 0.25);
    double charge = 0.25 * 1.25e-4;
    for (const MotorBooks& b : rig.books) charge += b.electrical_in_J / draw.bus_V;
    ASSERT_TRUE(
        near(draw.bus_V, source - 0.030 * charge / 1.25e-4, stated(1.1e-8, "agreed to 10 nV")))
        << k;
  }
}

// Four held shafts behind one resistance: each takes D^2 / R and the heat of its ripple, by hand.
TEST(PowerBus, FourStalledMotorsShareOnePack) {
  Rig rig;
  Battery pack(lab_supply(16.0, 0.05));
  for (auto& motor : rig.motors) motor.block();
  for (auto& drive : rig.drives) drive.duty = 0.5;
  BusDraw draw;
  for (int k = 0; k < 400; ++k) draw = rig.step(pack, 0.0);
  const double R = 0.12, ripple_ApV = 0.25 / (2.0e-5 * 20e3);  // peak to peak
  const double per_volt = 0.25 / R + R * ripple_ApV * ripple_ApV / 12.0;
  EXPECT_TRUE(near(draw.bus_V, 16.0 / (1.0 + 4.0 * 0.05 * per_volt),
                   stated(2e-4, "a turn per second counts as standing")));
}

TEST(PowerBus, BusCurrentIsDutyTimesWindingCurrentLessWhatCommutationGivesBack) {
  Rig rig;
  Battery pack(lab_supply(16.4, 0.0));
  for (auto& drive : rig.drives) drive.duty = 0.3;
  for (auto& load : rig.loads) load.quadratic_Nm_s2 = 1.9e-7;
  for (int k = 0; k < 40000; ++k) rig.step(pack, 0.0);
  const double winding = rig.books[0].winding_charge_C / 1.25e-4;
  EXPECT_GT(winding, 3.0);
  const double bus = rig.books[0].bus_charge_C / 1.25e-4;
  EXPECT_LT(bus, 0.3 * winding);
  EXPECT_GT(bus, 0.95 * 0.3 * winding);
}

TEST(PowerBus, BrakingFeedsThePack) {
  Rig rig;
  Battery pack(lipo_4s_2200());
  for (auto& motor : rig.motors) motor.set_speed(600.0);
  for (auto& drive : rig.drives) drive.duty = 0.2;
  rig.step(pack, 0.0);
  const BusDraw draw = rig.step(pack, 0.0);
  EXPECT_LT(draw.charge_C, 0.0);
  EXPECT_GT(draw.bus_V, pack.source_V());
}

}  // namespace
}  // namespace whirl::plant
