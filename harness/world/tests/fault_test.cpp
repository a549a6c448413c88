#include "harness/world/fault.hpp"

#include <gtest/gtest.h>

namespace whirl {
namespace {

FaultSpec dip(std::uint32_t number, std::int64_t start_ns, std::int64_t end_ns) {
  FaultSpec fault;
  fault.number = number;
  fault.kind = "supply_dip";
  fault.start_ns = start_ns;
  fault.end_ns = end_ns;
  fault.value = static_cast<double>(number);
  return fault;
}

TEST(TimedFaults, ActFromTheirStartUntilBeforeTheirEndAndOnlyThenCount) {
  TimedFaults faults;
  faults.add(dip(1, 10, 20));
  faults.add(dip(2, 15, INT64_MAX));
  const auto sum_at = [&](std::int64_t t_ns) {
    double sum = 0.0;
    faults.apply("supply_dip", t_ns, [&](const FaultSpec& fault) { sum += fault.value; });
    return sum;
  };
  EXPECT_EQ(sum_at(9), 0.0);
  EXPECT_TRUE(faults.acted().empty());
  EXPECT_EQ(sum_at(10), 1.0);
  EXPECT_EQ(faults.acted(), std::vector<std::uint32_t>{1});
  EXPECT_EQ(sum_at(19), 3.0);
  EXPECT_EQ(sum_at(20), 2.0);
  EXPECT_EQ(faults.acted(), (std::vector<std::uint32_t>{1, 2}));
  EXPECT_FALSE(faults.any("capture_lost", 15));
}

TEST(FaultPlace, TheMotorOfADeviceIsWhoseEscItIsWhateverItsName) {
  FaultSpec fault;
  fault.place = fault_at::Device{"esc2", 3, 0x2A, 7};
  EXPECT_EQ(motor_of(fault), 7);
  EXPECT_EQ(target_of(fault), "esc2");
  fault.place = fault_at::Motor{3};
  EXPECT_EQ(motor_of(fault), 3);
  EXPECT_EQ(target_of(fault), "motor 3");
  fault.place = fault_at::Wire{"i2c3", 3, -1};
  EXPECT_EQ(motor_of(fault), 0);
  EXPECT_EQ(target_of(fault), "i2c3");
  fault.place = fault_at::Anywhere{};
  EXPECT_EQ(target_of(fault), "");
}

}  // namespace
}  // namespace whirl
