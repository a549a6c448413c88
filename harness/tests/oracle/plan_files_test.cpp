// What a plan's file declares: its keys and their defaults, and what is refused.
#include <gtest/gtest.h>

#include <fstream>

#include "base/scratch_folder.hpp"
#include "harness/plan/plan_file.hpp"

namespace whirl::plan {
namespace {

struct Loaded {
  std::vector<Plan> plans;
  std::string error;
};

Loaded load(const std::string& text) {
  const ScratchFolder folder;
  const std::string path = folder.file("p.lua");
  std::ofstream(path, std::ios::binary) << text;
  const auto file = PlanFile::load(path);
  return file ? Loaded{file.value()->plans(), ""} : Loaded{{}, file.error().message()};
}

std::string with(const std::string& keys, const std::string& name = "p") {
  return "plan '" + name + "' { image = 'i', run = function(t) end, " + keys + " }";
}

TEST(PlanFile, WhatIsNotSaidHasItsDefault) {
  const Loaded loaded = load("\n" + with("vehicle = 'v'"));
  ASSERT_EQ(loaded.plans.size(), 1u) << loaded.error;
  const Plan& plan = loaded.plans[0];
  EXPECT_EQ(plan.name, "p");
  EXPECT_EQ(plan.nodes.at(0).image, "i");
  EXPECT_EQ(plan.nodes.at(0).board, "px4fmu_v1");
  EXPECT_EQ(plan.vehicle, "v");
  EXPECT_FALSE(plan.stand);
  EXPECT_EQ(plan.seed, 1u);
  EXPECT_EQ(plan.timeout_ns, 120'000'000'000);
  EXPECT_FALSE(plan.nodes.at(0).may_reset);
  EXPECT_TRUE(plan.tags.empty());
  EXPECT_TRUE(plan.nodes.at(0).watch.empty());
  EXPECT_NE(plan.file.find("p.lua"), std::string::npos);
  EXPECT_EQ(plan.place, "p.lua:2");
  EXPECT_FALSE(plan.has_tag("quick"));
}

TEST(PlanFile, WhatItsVehicleHasOtherThanItsFileAreSettings) {
  const Loaded loaded =
      load(with("vehicle = 'v', vehicle_with = { rotor_drag_s_per_m = 0.03, ['motor.resistance'] = "
                "'90 mohm' }"));
  ASSERT_EQ(loaded.plans.size(), 1u) << loaded.error;
  const Settings& settings = loaded.plans[0].vehicle_settings;
  ASSERT_EQ(settings.size(), 2u);
  EXPECT_EQ(settings[0].key, "vehicle.motor.resistance");
  EXPECT_EQ(settings[0].value, "90 mohm");
  EXPECT_EQ(settings[1].key, "vehicle.rotor_drag_s_per_m");
  EXPECT_EQ(std::stod(settings[1].value), 0.03);
  EXPECT_NE(load(with("stand = {}, vehicle_with = {}")).error.find("belongs to a vehicle"),
            std::string::npos);
}

TEST(PlanFile, WhatIsSaidIsTaken) {
  const Loaded loaded = load(with("stand = { prop = 'x' }, board = 'b', seed = 0, "
                                  "timeout = '1500 ms', may_reset "
                                  "= true, tags = { 'quick', 'slow' }, watch = { 'f', 'g' }") +
                             "\n" + with("vehicle = 'v', seed = 7", "q"));
  ASSERT_EQ(loaded.plans.size(), 2u) << loaded.error;
  const Plan& plan = loaded.plans[0];
  EXPECT_TRUE(plan.stand);
  EXPECT_EQ(plan.nodes.at(0).board, "b");
  EXPECT_EQ(plan.seed, 0u);
  EXPECT_EQ(plan.timeout_ns, 1'500'000'000);
  EXPECT_TRUE(plan.nodes.at(0).may_reset);
  EXPECT_TRUE(plan.has_tag("quick"));
  EXPECT_TRUE(plan.has_tag("slow"));
  EXPECT_FALSE(plan.has_tag("slower"));
  EXPECT_EQ(plan.nodes.at(0).watch, (std::vector<std::string>{"f", "g"}));
  EXPECT_EQ(loaded.plans[1].name, "q");
  EXPECT_EQ(loaded.plans[1].seed, 7u);
  EXPECT_EQ(loaded.plans[1].place, "p.lua:2");
  EXPECT_NE(loaded.plans[0].run_ref, loaded.plans[1].run_ref);
}

std::string nodes(const std::string& wires) {
  return "plan 'p' { vehicle = 'v', nodes = { { name = 'a', image = 'i', may_reset = true },"
         " { name = 'b', image = 'j', board = 'c', watch = { 'f' } } }, " +
         wires + " run = function(t) end }";
}

TEST(PlanFile, NodesAndTheirWiresAreTaken) {
  const Loaded loaded = load(nodes("wires = { { from = 'b.usart1', to = 'a.uart12' } },"));
  ASSERT_EQ(loaded.plans.size(), 1u) << loaded.error;
  const Plan& plan = loaded.plans[0];
  ASSERT_EQ(plan.nodes.size(), 2u);
  EXPECT_EQ(plan.nodes[0].name, "a");
  EXPECT_EQ(plan.nodes[1].image, "j");
  EXPECT_EQ(plan.nodes[1].board, "c");
  EXPECT_EQ(plan.nodes[1].watch, std::vector<std::string>{"f"});
  EXPECT_TRUE(plan.nodes[0].may_reset);
  EXPECT_FALSE(plan.nodes[1].may_reset);
  ASSERT_EQ(plan.wires.size(), 1u);
  EXPECT_EQ(plan.wires[0].a.node, 1u);
  EXPECT_EQ(plan.wires[0].a.uart, 1);
  EXPECT_EQ(plan.wires[0].b.node, 0u);
  EXPECT_EQ(plan.wires[0].b.uart, 12);
}

TEST(PlanFile, ABoardInTheDevicesPlaceAndWhatIsFlashedBesideItsImageAreTaken) {
  std::string text = nodes("wires = { { from = 'a.esc1', to = 'b.i2c2' } },");
  text.replace(text.find("board = 'c'"), 11, "board = 'c', flash = { 'cells' }");
  const Loaded loaded = load(text);
  ASSERT_EQ(loaded.plans.size(), 1u) << loaded.error;
  const Plan& plan = loaded.plans[0];
  EXPECT_TRUE(plan.wires.empty());
  ASSERT_EQ(plan.board_wires.size(), 1u);
  EXPECT_EQ(plan.board_wires[0].leader, 0u);
  EXPECT_EQ(plan.board_wires[0].device, "esc1");
  EXPECT_EQ(plan.board_wires[0].follower, 1u);
  EXPECT_EQ(plan.board_wires[0].bus, "i2c2");
  EXPECT_EQ(plan.nodes[1].flash, std::vector<std::string>{"cells"});
  const auto refused = [](const std::string& from, const std::string& to) {
    return load(nodes("wires = { { from = '" + from + "', to = '" + to + "' } },")).error;
  };
  EXPECT_NE(refused("c.esc1", "b.i2c2").find("wires[1].from: 'c.esc1' is on no node"),
            std::string::npos);
  EXPECT_NE(refused("b.esc1", "b.i2c2").find("a wire joins two boards"), std::string::npos);
}

TEST(PlanFile, TwoBoardsMayBeJoinedByTheirCans) {
  const Loaded loaded = load(nodes("wires = { { from = 'a.can1', to = 'b.can2' } },"));
  ASSERT_EQ(loaded.plans.size(), 1u) << loaded.error;
  const PlanBoardWire& taken = loaded.plans[0].board_wires.at(0);
  EXPECT_EQ(taken.device, "can1");
  EXPECT_EQ(taken.bus, "can2");
}

TEST(PlanFile, ABoardInTheDevicesPlaceOnSpiHasItsPinsAndTheLatencyOfItsLine) {
  const auto wire = [](const std::string& more) {
    return load(nodes("wires = { { from = 'a.imu', to = 'b.spi1'" + more + " } },"));
  };
  const Loaded loaded = wire(", select = 'PA15', ready = 'PC4', latency = '20 us'");
  ASSERT_EQ(loaded.plans.size(), 1u) << loaded.error;
  const PlanBoardWire& taken = loaded.plans[0].board_wires.at(0);
  EXPECT_EQ(taken.select, "PA15");
  EXPECT_EQ(taken.ready, "PC4");
  EXPECT_EQ(taken.latency_ns, 20'000);
  EXPECT_EQ(wire(", select = 'PA15'").plans.at(0).board_wires.at(0).latency_ns, 100'000);
  EXPECT_NE(wire("").error.find("wires[1].select"), std::string::npos) << wire("").error;
  EXPECT_NE(wire(", select = 'PA15', ready = 'PA15'").error.find("ready: is the pin of select"),
            std::string::npos);
  for (const char* latency : {"1 us", "2 ms"}) {
    const std::string error =
        wire(std::string(", select = 'PA15', latency = '") + latency + "'").error;
    EXPECT_NE(error.find("a line's latency is 2 us to 1 ms"), std::string::npos) << error;
  }
}

// 9.7 bits of it: no rate is exact. From UART to UART it is a line at the grain of the exchange, as ever.
TEST(PlanFile, ABoardInTheDevicesPlaceOnAUartHasTheShortestCharacterThatItMaySend) {
  const auto wire = [](const std::string& more) {
    return load(nodes("wires = { { from = 'a.gps', to = 'b.usart6'" + more + " } },"));
  };
  const Loaded loaded = wire(", fastest = '57600 baud'");
  ASSERT_EQ(loaded.plans.size(), 1u) << loaded.error;
  const PlanBoardWire& taken = loaded.plans[0].board_wires.at(0);
  EXPECT_EQ(taken.device, "gps");
  EXPECT_EQ(taken.bus, "usart6");
  EXPECT_EQ(taken.latency_ns, 168'403);
  EXPECT_EQ(wire("").plans.at(0).board_wires.at(0).latency_ns, 84'201);
  EXPECT_NE(wire(", fastest = '100 baud'").error.find("fastest"), std::string::npos);
  EXPECT_NE(wire(", select = 'PA15'").error.find("select"), std::string::npos);
  const Loaded line = load(nodes("wires = { { from = 'a.usart1', to = 'b.usart2' } },"));
  ASSERT_EQ(line.plans.size(), 1u) << line.error;
  EXPECT_TRUE(line.plans[0].board_wires.empty());
  EXPECT_EQ(line.plans[0].wires.size(), 1u);
}

TEST(PlanFile, ALevelFromAnotherBoardsDacHasALinesLatency) {
  const auto wire = [](const std::string& more) {
    return load(nodes("wires = { { from = 'a.battery', to = 'b.dac1'" + more + " } },"));
  };
  EXPECT_EQ(wire("").plans.at(0).board_wires.at(0).latency_ns, 100'000);
  EXPECT_EQ(wire(", latency = '20 us'").plans.at(0).board_wires.at(0).latency_ns, 20'000);
  EXPECT_NE(wire(", latency = '1 us'").error.find("a line's latency is 2 us to 1 ms"),
            std::string::npos);
  EXPECT_NE(wire(", fastest = '9600 baud'").error.find("fastest"), std::string::npos);
}

TEST(PlanFile, RefusesNodesAndWiresThatLeadNowhere) {
  const auto refused = [](const std::string& from, const std::string& to) {
    return load(nodes("wires = { { from = '" + from + "', to = '" + to + "' } },")).error;
  };
  EXPECT_NE(refused("a.usart1", "a.usart2").find("wires[1].to: a wire joins two boards"),
            std::string::npos);
  for (const char* end : {"b.dac", "b.dac0", "b.dac01", "b.", "b.imu"}) {  // dac01: dac1 twice
    EXPECT_NE(
        refused("a.battery", end).find("wires[1].to: '" + std::string(end + 2) + "' names no bus"),
        std::string::npos)
        << end << refused("a.battery", end);
  }
  for (const char* end : {"c.usart1", "a.can1", "a", "a.usart"}) {
    EXPECT_NE(refused("b.usart1", end).find("is no UART of a node"), std::string::npos) << end;
  }
}

TEST(PlanFile, NamesHaveUpToTwoHundredBytes) {
  const std::string longest(200, 'x');
  ASSERT_EQ(load(with("vehicle = 'v'", longest)).plans.size(), 1u);
  EXPECT_EQ(load(with("vehicle = 'v'", longest)).plans[0].name, longest);
  EXPECT_NE(load(with("vehicle = 'v'", longest + "x")).error.find("is longer than 200 bytes"),
            std::string::npos);
}

TEST(PlanFile, RefusesWhatIsNoPlan) {
  const std::pair<std::string, const char*> kAll[] = {
      {"plan(5)", "p.lua:1: write it as: plan \"name\" { ... }"},
      {"plan('a', {})", "p.lua:1: write it as: plan \"name\" { ... }"},
      {"plan()", "p.lua:1: write it as: plan \"name\" { ... }"},
      {"plan 'a' (5)", "p.lua:1: plan \"a\": a table { ... } is wanted"},
      {"plan 'a' {}", "p.lua:1: plan \"a\": run = function(t) ... end is missing"},
      {"plan 'a' { run = 5 }", "p.lua:1: plan \"a\": run = function(t) ... end is missing"},
      {"plan 'a'", "declares no plan"},
      {"", "declares no plan (write: plan \"name\" { ... })"},
      {with("vehicle = 'v'") + with("vehicle = 'v'"), "p.lua:1: two plans are called \"p\""},
      {with("stand = {}, vehicle = 'v'"), "a plan has a vehicle or a stand, one of the two"},
      {with(""), "a plan has a vehicle or a stand, one of the two"},
      {with("vehicle = 'v', seed = -1"), "seed"},
      {with("vehicle = 'v', timeout = '0 s'"), "timeout: is 0"},
      {with("vehicle = 'v', timeout = '5 N'"), "'5 N' is a force, not a time"},
      {with("vehicle = 'v', colour = 1"), "unknown key 'colour'"},
      {with("vehicle = 'v', world = { wind = '2 m/s' }"), "unknown key 'world'"},
      {"local x = {} x.x = x " + with("vehicle = 'v', x = x"), "nested too deep"},
      {"plan 'a' { vehicle = 'v', run = function(t) end }", "image"},
      {"plan 'a' { vehicle = 'v', may_reset = true, nodes = { { name = 'n', image = 'i' } },"
       " run = function(t) end }",
       "may_reset: stands in each of the nodes"},
  };
  for (const auto& [text, words] : kAll) {
    const Loaded loaded = load(text);
    EXPECT_TRUE(loaded.plans.empty()) << text;
    EXPECT_NE(loaded.error.find(words), std::string::npos) << text << ": " << loaded.error;
    EXPECT_NE(loaded.error.find("p.lua"), std::string::npos) << loaded.error;
  }
}

}  // namespace
}  // namespace whirl::plan
