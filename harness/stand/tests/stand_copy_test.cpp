// What a stand shows and allows of its own copy of the hardware.
#include <gtest/gtest.h>

#include <vector>

#include "base/near.hpp"
#include "harness/catalogue/stand_table.hpp"
#include "harness/plan/requests.hpp"
#include "harness/stand/stand_world.hpp"

namespace whirl::stand {
namespace {

lua::Table table(const std::string& text) {
  return lua::read_text("return " + text, "plan.lua").value();
}

StandWorld stand_with(const StageParams& stage) {
  auto params = catalogue::read_stand(table(R"({ prop = "hk_10x4.5", supply = "16 V" })"),
                                      std::string(WHIRL_SOURCE_FOLDER) + "/test_plans/propellers");
  params.value().stage = stage;
  return StandWorld(params.value(), 1);
}

// Two steps with 16 V on the bus of a turning motor.
void run(StandWorld& world) {
  for (std::int64_t t_ns : {0, 1'000'000, 2'000'000}) {
    io::Batch happened, sensed;
    io::ShaftState shaft;
    shaft.speed_radps = 400.0;
    shaft.bus_voltage_V = 16.0;
    happened.add(io::Kind::shaft_state, 1, t_ns, shaft);
    world.step(t_ns, happened, sensed);
  }
}

double sensed_V(StandWorld world) {
  run(world);
  std::vector<double> values(world.signals().size());
  world.read(values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (world.signals()[i].name == "sensed_voltage") return values[i];
  }
  return 0.0;
}

// Divider 2 % high, converter 1 % low and 3 mV off: 16 V look like 16 x 1.02 x 0.99 + 3 mV x 11.5 / 1.5.
TEST(StandCopy, ShowsTheBusAsItsOwnDividerAndConverterDo) {
  EXPECT_EQ(sensed_V(stand_with({})), 16.0);
  const double off_V = sensed_V(
      stand_with({{"divider.bus", 0.02}, {"adc.gain.bus", -0.01}, {"adc.offset.bus", 0.003}}));
  EXPECT_TRUE(near(off_V, 16.1798, printed_to(1e-4)));
}

TEST(StandCopy, ItsShortestRiseIsThatOfItsOwnMotorInTheAirThatThereIs) {
  const StandWorld drawn = stand_with({});
  const StandWorld heavy = stand_with({{"inertia", 2.0 * plant::MotorParams{}.inertia_kgm2}});
  StandWorld windy = stand_with({});
  ASSERT_TRUE(plan::disturb(windy, table(R"({ down = "4 m/s", edge = "1 ms" })"), 0).ok());
  run(windy);
  const double usual_s = drawn.shortest_rise_s(2.0, 3.2, 20.0).value();
  EXPECT_TRUE(near(heavy.shortest_rise_s(2.0, 3.2, 20.0).value(), 2.0 * usual_s,
                   stated(0.15 * usual_s, "the inflow follows meanwhile and takes thrust away")));
  EXPECT_LT(windy.shortest_rise_s(2.0, 3.2, 20.0).value(), 0.99 * usual_s);
}

}  // namespace
}  // namespace whirl::stand
