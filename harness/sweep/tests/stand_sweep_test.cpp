#include "harness/sweep/stand_sweep.hpp"

#include <fstream>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"
#include "harness/catalogue/motor_file.hpp"
#include "harness/catalogue/stand_drive.hpp"
#include "harness/sweep/motor_sweep.hpp"

namespace whirl::sweep {
namespace {

const std::string kPlans = std::string(WHIRL_ROOT) + "/test_plans";

Result<DriveFile> rows(const std::string& text) {
  const ScratchFolder folder;
  const std::string path = folder.file("bench.txt");
  std::ofstream(path) << text;
  return read_drive_rows(path);
}

TEST(DriveRows, FaultsAreToldWithTheirLine) {
  const auto message = [](const char* text) {
    const auto read = rows(text);
    return read.ok() ? std::string("accepted") : read.error().message();
  };
  EXPECT_NE(message("V rpm\n11 4000\n").find(":1: no columns rpm and A"), std::string::npos);
  EXPECT_NE(message("V rpm A\n11 4000 x\n").find(":2: a number is missing"), std::string::npos);
  EXPECT_NE(message("V rpm A\n11 4000 3\n\n11 -4000 3\n").find(":4: rpm"), std::string::npos);
  EXPECT_NE(message("V rpm A duty\n11 4000 3 50\n").find(":2: duty"), std::string::npos);
  EXPECT_NE(message("V rpm A prop\n11 4000 3\n").find(":2: the propeller's"), std::string::npos);
  EXPECT_NE(message("V rpm A\n").find("no rows"), std::string::npos);
}

// The stand's own answer as measured, the current a fifth less and the torque a quarter more.
TEST(StandSweep, ARowThatIsTheModelsOwnHasNoErrorAndAShiftedOneItsShift) {
  const auto stand =
      catalogue::read_stand_drive(kPlans + "/calibrations/hk_10x4.5.lua", kPlans + "/propellers");
  ASSERT_TRUE(stand.ok()) << stand.error().message();
  constexpr double kSpeed_radps = 450.0, kFeed_V = 16.4, kLeads_ohm = 0.01;
  const auto free = drive_at_speed(stand.value(), kSpeed_radps, kFeed_V);
  ASSERT_TRUE(free.ok());
  const auto own =
      drive_at_speed(stand.value(), kSpeed_radps, kFeed_V - kLeads_ohm * free.value().bus_A);
  ASSERT_TRUE(own.ok());
  DriveFile file{"own", false, false, true, true, false, {}};
  const DrivePoint& p = own.value();
  file.rows.push_back({0.0, kSpeed_radps, 0.8 * p.bus_A, 1.0, 1.25 * p.torque_Nm, p.thrust_N, ""});
  const auto sweep = stand_rows(stand.value(), {}, {file});
  ASSERT_TRUE(sweep.ok()) << sweep.error().message();
  const auto off = [&](const char* what) { return sweep.value().off_percent.at(what); };
  EXPECT_TRUE(near(off("thrust"), 0.0, stated(1e-9, "the same rotor at the same speed")));
  EXPECT_TRUE(near(off("current"), 25.0, stated(0.05, "0.2 of 0.8; the feed gives way alike")));
  EXPECT_TRUE(near(off("torque"), 20.0, stated(1e-9, "0.25 of 1.25")));
  EXPECT_EQ(sweep.value().off_percent.count("speed"), 0u);
}

TEST(MotorSweep, AMotorOfAnotherKvIsContradictedByTheRows) {
  const auto motor = catalogue::read_motor_file(kPlans + "/motors/d2836_9.lua");
  ASSERT_TRUE(motor.ok()) << motor.error().message();
  const std::string text =
      "V rpm A prop\n7 5417.3 7.625 p\n8 6005.0 9.4995 p\n9 6544.7 11.533 p\n"
      "10 7033.6 13.742 p\n11.1 7503.3 16.422 p\n";  // the stock stand's
  const auto file = rows(text);
  ASSERT_TRUE(file.ok()) << file.error().message();
  const auto right = motor_sweep(motor.value().params, 11.1, {file.value()});
  ASSERT_TRUE(right.ok()) << right.error().message();
  EXPECT_LT(right.value().speed_percent, 0.1);
  EXPECT_TRUE(right.value().wrong.empty());
  plant::MotorParams other = motor.value().params;
  other.torque_constant_NmpA *= 950.0 / 1000.0;
  const auto wrong = motor_sweep(other, 11.1, {file.value()});
  ASSERT_TRUE(wrong.ok());
  EXPECT_GT(wrong.value().speed_percent, kMost_speed_percent);
  ASSERT_FALSE(wrong.value().wrong.empty());
  EXPECT_NE(wrong.value().wrong[0].find("Kv"), std::string::npos);
}

}  // namespace
}  // namespace whirl::sweep
