#include "plant/power_bus.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "harness/base/near.hpp"
#include "harness/base/random.hpp"

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

// Four held shafts behind one resistance: V = V0 / (1 + 4 D^2 r / R), by hand.
TEST(PowerBus, FourStalledMotorsShareOnePack) {
  Rig rig;
  Battery pack(lab_supply(16.0, 0.05));
  for (auto& motor : rig.motors) motor.block();
  for (auto& drive : rig.drives) drive.duty = 0.5;
  BusDraw draw;
  for (int k = 0; k < 400; ++k) draw = rig.step(pack, 0.0);
  EXPECT_TRUE(near(draw.bus_V, 16.0 / (1.0 + 4.0 * 0.25 * 0.05 / 0.16), stated(1e-8, "settled")));
}

TEST(PowerBus, BusCurrentIsDutyTimesWindingCurrent) {
  Rig rig;
  Battery pack(lab_supply(16.4, 0.0));
  for (auto& drive : rig.drives) drive.duty = 0.3;
  for (auto& load : rig.loads) load.quadratic_Nm_s2 = 1.9e-7;
  for (int k = 0; k < 40000; ++k) rig.step(pack, 0.0);
  const double winding = rig.books[0].winding_charge_C / 1.25e-4;
  EXPECT_GT(winding, 3.0);
  EXPECT_TRUE(near(rig.books[0].bus_charge_C / 1.25e-4, 0.3 * winding, round_off(8, winding)));
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
