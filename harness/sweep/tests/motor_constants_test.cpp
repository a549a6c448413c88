// Oracle: motors that were drawn, run by the plant's averaged motor, with noise of a bench's meters; and a
// motor that others measured.
#include "harness/sweep/motor_constants.hpp"

#include <string>

#include "base/near.hpp"
#include "base/random.hpp"
#include "base/rpm.hpp"
#include "harness/sweep/steady_motor.hpp"
#include "plant/validation/motor_faces.hpp"

namespace whirl::sweep {
namespace {

plant::MotorParams drawn_motor(RandomStream& chance) {
  const auto between = [&](double low, double high) {
    return low * std::pow(high / low, chance.uniform());
  };
  plant::MotorParams m;
  m.torque_constant_NmpA = torque_constant_NmpA_of(between(300.0, 2500.0));
  const double stall_A = between(150.0, 400.0);  // at 12 V
  m.resistance_ohm = 12.0 / stall_A;
  m.winding_resistance_ohm = 0.7 * m.resistance_ohm;
  m.inductance_H = between(0.5e-4, 2e-4) * m.resistance_ohm;
  m.no_load_current_A = between(0.005, 0.02) * stall_A;
  m.pole_pairs = 7;
  return m;
}

// At full throttle, with a propeller that takes that share of the current at which it would stand.
DriveRow run(const plant::MotorParams& m, double bus_V, double share, const std::string& prop) {
  plant::AveragedMotor motor(m);
  const double top_radps = 12.0 / m.torque_constant_NmpA;
  const double torque_Nm = share * m.torque_constant_NmpA * 12.0 / m.resistance_ohm;
  const plant::ShaftLoad load{torque_Nm / (top_radps * top_radps), 0.0};
  motor.set_speed(0.9 * bus_V / m.torque_constant_NmpA);
  const auto books =
      run_until_steady(motor, {.bus_V = bus_V, .duty = 1.0}, [&](double) { return load; });
  return {bus_V, motor.speed_radps(), books.bus_charge_C / (kSubSteps * kSubStep_s), 1.0, 0.0, 0.0,
          prop};
}

DriveFile bench_of(const plant::MotorParams& m) {
  DriveFile file{"drawn", true, false, false, false, true, {}};
  for (const double bus_V : {7.4, 9.0, 11.1}) {
    file.rows.push_back(run(m, bus_V, 0.0, kNothing_on_the_shaft));
    file.rows.push_back(run(m, bus_V, 0.06, "small"));
    file.rows.push_back(run(m, bus_V, 0.12, "middle"));
    file.rows.push_back(run(m, bus_V, 0.20, "large"));
  }
  return file;
}

void add_noise(RandomStream& noise, DriveFile& file) {
  for (DriveRow& row : file.rows) {
    row.bus_V *= 1.0 + 0.002 * noise.normal();
    row.speed_radps *= 1.0 + 0.003 * noise.normal();
    row.bus_A *= 1.0 + 0.01 * noise.normal();
  }
}

struct Coverage {
  int told = 0, inside = 0;
  void count(const std::optional<regression::Coefficient>& c, double truth) {
    told += c ? 1 : 0;
    inside += c && std::abs(c->value - truth) <= c->half_width ? 1 : 0;
  }
};

// Of 200 draws at 95 %, 180 or fewer come once in a thousand times.
TEST(MotorConstants, IntervalsHoldTheTruthOfTwoHundredDrawnMotorsNineteenTimesInTwenty) {
  RandomStream chance(4711, "two hundred motors");
  Coverage kv, ohm, idle;
  for (int i = 0; i < 200; ++i) {
    const plant::MotorParams m = drawn_motor(chance);
    DriveFile file = bench_of(m);
    add_noise(chance, file);
    plant::MotorParams believed = m;  // what a file knows of it: not the constants that are sought
    believed.torque_constant_NmpA *= 1.3;
    believed.resistance_ohm *= 0.8;
    const auto found = motor_constants({file}, believed);
    ASSERT_TRUE(found.ok()) << found.error().message();
    kv.count(found.value().kv_rpm_per_V, rpm_of(1.0 / m.torque_constant_NmpA));
    ohm.count(found.value().ohmmeter_ohm, m.resistance_ohm);
    idle.count(found.value().no_load_A, m.no_load_current_A);
  }
  for (const Coverage& c : {kv, ohm, idle}) {
    EXPECT_GT(c.inside, 180);
    EXPECT_EQ(c.told, 200);
  }
}

// The switched motor shares no line with what takes commutation out.
TEST(MotorConstants, ASwitchedMotorShowsMoreThanItsOwnResistanceAndGivesItBack) {
  const plant::MotorParams m;
  DriveFile file{"switched", true, false, false, false, true, {}};
  for (const double bus_V : {6.0, 8.0, 10.0}) {
    for (const double load : {0.6e-7, 1.6e-7, 3.2e-7}) {
      const plant::FaceCase at{m, bus_V, load};
      const double near_radps = plant::averaged_face(at, 1.0, false).speed_radps;
      const plant::MotorFace face = plant::switched_face(at, 1.0, false, near_radps);
      file.rows.push_back({bus_V, face.speed_radps, face.bus_A, 1.0, face.shaft_Nm, 0.0, "some"});
    }
  }
  const auto found = motor_constants({file}, m);
  ASSERT_TRUE(found.ok()) << found.error().message();
  EXPECT_GT(found.value().seen_ohm->value, 1.2 * m.resistance_ohm);
  EXPECT_TRUE(near(found.value().ohmmeter_ohm->value, m.resistance_ohm,
                   stated(0.03 * m.resistance_ohm, "faces agree within 1 % of the current")));
  EXPECT_TRUE(near(found.value().kv_rpm_per_V->value, 950.0, stated(3.0, "the same")));
}

// One propeller: current goes as speed squared, commutation's share of V as speed cubed, which over a narrow
// range is twice the slope: R + 2 k w; and the faster it turns the more current returns to the bus.
TEST(MotorConstants, OnePropellerCountsCommutationMoreThanTwice) {
  plant::MotorParams m;
  m.resistance_ohm = 0.2;
  m.inductance_H = 1e-5;
  DriveFile file{"one", true, false, false, false, false, {}};
  double mean_radps = 0.0;
  for (const double bus_V : {9.0, 9.3, 9.6, 9.9, 10.2}) {
    file.rows.push_back(run(m, bus_V, 0.15, ""));
    mean_radps += file.rows.back().speed_radps / 5.0;
  }
  const auto found = motor_constants({file}, m);
  ASSERT_TRUE(found.ok());
  const double once_ohm = commutation_ohm_per_radps(m) * mean_radps;
  EXPECT_GT(found.value().seen_ohm->value - m.resistance_ohm, 2.0 * once_ohm);
  EXPECT_LT(found.value().seen_ohm->value - m.resistance_ohm, 4.0 * once_ohm);
  EXPECT_TRUE(near(found.value().ohmmeter_ohm->value, m.resistance_ohm,
                   stated(0.01 * m.resistance_ohm, "no noise")));
}

TEST(MotorConstants, OneVoltageWithOneLoadTellsNeitherRNorI0) {
  RandomStream noise(5, "one point");
  DriveFile file{"one", true, false, false, false, false, {}};
  for (int i = 0; i < 8; ++i) file.rows.push_back({11.1, 900.0, 8.0, 1.0, 0.0, 0.0, ""});
  add_noise(noise, file);
  const auto found = motor_constants({file}, plant::MotorParams{});
  ASSERT_TRUE(found.ok());
  EXPECT_FALSE(found.value().ohmmeter_ohm);
  EXPECT_FALSE(found.value().no_load_A);
  ASSERT_EQ(found.value().untold.size(), 2u);
  EXPECT_NE(found.value().untold[0].find("R: these rows do not tell"), std::string::npos);
  EXPECT_NE(found.value().untold[1].find("I0: these rows do not tell"), std::string::npos);
}

TEST(MotorConstants, NoVoltageAndTooFewRowsAreRefused) {
  DriveFile file{"kde", false, true, false, false, false, {{0.0, 400.0, 3.0, 0.5, 0, 0, ""}}};
  EXPECT_NE(motor_constants({file}, {}).error().message().find("no column V"), std::string::npos);
  file.volts = true;
  EXPECT_NE(motor_constants({file}, {}).error().message().find("0 rows at full throttle"),
            std::string::npos);
}

// 16 rows of one motor with eight propellers [Strawson]: from half of them, where the others turn.
TEST(MotorConstants, AMeasuredMotorsConstantsTellItsSpeedWithOtherPropellers) {
  const auto all = read_drive_rows(std::string(WHIRL_ROOT) + "/plant/data/motors/strawson_a.txt");
  ASSERT_TRUE(all.ok()) << all.error().message();
  DriveFile known = all.value(), others = all.value();
  known.rows.clear(), others.rows.clear();
  for (const DriveRow& row : all.value().rows) {
    (row.prop <= "4" ? known : others).rows.push_back(row);
  }
  ASSERT_EQ(known.rows.size(), 8u);
  plant::MotorParams motor;
  motor.inductance_H = 1e-7;  // not known: nothing is taken out of what the input shows
  const auto found = motor_constants({known}, motor);
  ASSERT_TRUE(found.ok()) << found.error().message();
  ASSERT_TRUE(found.value().ohmmeter_ohm);
  motor.torque_constant_NmpA = torque_constant_NmpA_of(found.value().kv_rpm_per_V->value);
  motor.resistance_ohm = found.value().ohmmeter_ohm->value;
  for (const DriveRow& row : others.rows) {
    const double told = speed_at(row, motor);
    EXPECT_TRUE(
        near(told, row.speed_radps, stated(0.01 * row.speed_radps, "set before it was seen")));
  }
}

}  // namespace
}  // namespace whirl::sweep
