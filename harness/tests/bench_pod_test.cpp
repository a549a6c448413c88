// A flight controller with SPI and I2C on a bench, without the copper: its real image and the pod's on two virtual boards
// stand in for metal, the radio and the pod's host line on pseudo-terminals; the bench plays vehicle, sensors and ESCs
// behind the pod.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "base/scratch_folder.hpp"
#include "harness/catalogue/board_file.hpp"
#include "harness/composition/boards.hpp"
#include "harness/standin/no_world.hpp"
#include "harness/standin/pod_beside.hpp"
#include "harness/tests/common_clock.hpp"
#include "harness/tests/composed_run.hpp"
#include "harness/tests/running_stand_in.hpp"

namespace whirl {
namespace {

const std::string kRoot = WHIRL_ROOT;
constexpr double kPace = 0.5;  // of a clock that nobody is late by

BoardDescription board_named(const std::string& name) {
  return read_board(kRoot + "/test_plans/boards/" + name + ".lua").value();
}

struct Metal {
  Metal(const ScratchFolder& folder, CommonClock& clock)
      : radio(folder.file("radio")), pod(folder.file("pod")) {
    StandInOptions wires;
    wires.pace = kPace;
    wires.lines.push_back({2, std::move(io::PseudoTerminal::open(radio).value())});
    wires.lines.push_back({1, std::move(io::PseudoTerminal::open(pod).value()), 1});
    auto boards =
        with_pod({board_named("px4fmu_v1_sbus"), board_named("pod_with_receivers"),
                  kRoot + "/build/firmware/flight.elf", kRoot + "/build/firmware/pod.elf"});
    stand_in.emplace(world, std::move(boards.value()), std::move(wires), &clock);
  }

  std::string radio, pod;
  NoWorld world{16.0};
  std::optional<RunningStandIn> stand_in;
};

std::string bench_file(const Metal& metal) {
  return "return { bench = \"stand_in\", board = \"px4fmu_v1_sbus\", pace = " +
         std::to_string(kPace) + R"(, late = "5 ms", late_share = "5 %",
  links = { { name = "pod", pod = "pod_with_receivers", path = ")" +
         metal.pod + R"(" },
            { name = "radio", bus = "usart2", path = ")" +
         metal.radio + R"(", baud = "57600 baud" } },
  safety = { phrase = "clear", longest = "120 s", heartbeat = "1 s" } })";
}

// As short as a flight can be: the hover is test_plans/flight/bench_hover_pod.lua, in the place of this one by
// WHIRL_BENCH_POD_PLAN.
constexpr const char* kUp = R"(plan "up" {
  image = "flight", board = "px4fmu_v1_sbus", vehicle = "hp_quad", timeout = "20 s",
  run = function(t)
    t:within("8 s", function(s) return s.told_ready == 1 end, "it says that it can be armed")
    t:command { rc = { mode = 2 } }
    t:wait "1 s"
    t:command { rc = { arm = true } }
    t:within("2 s", function(s) return s.told_armed == 1 end, "armed by the switch")
    t:wait "1 s"
    t:command { rc = { thrust = "100 %" } }
    t:within("8 s", function(s) return s.height_m > 0.5 end, "up")
    local up = t:record({ "tilt", "attitude_error" }, "0.5 s")
    t:expect(up:max "tilt", "tilt"):at_most "5 deg"
    t:expect(up:max "attitude_error", "and its own word of it"):at_most "3 deg"
  end,
})";

TEST(BenchPod, TheRealImageFliesOnSensorsAndControllersThatThePodPlays) {
  const ScratchFolder folder;
  CommonClock clock;
  Metal metal(folder, clock);
  const std::string file = folder.file("bench.lua"), up = folder.file("up.lua");
  std::ofstream(file) << bench_file(metal);
  std::ofstream(up) << kUp;
  const auto composition = boards_and_worlds(kRoot, folder.file("out"), nullptr, nullptr, &clock);
  const char* plan = std::getenv("WHIRL_BENCH_POD_PLAN");
  const ComposedRun run = run_composed(
      composition, {plan != nullptr ? plan : up, "--target", "bench/" + file, "--arm", "clear"});
  clock.leave();
  metal.stand_in->stop();
  const nlohmann::json& told = run.file;
  for (const auto& e : told["expectations"]) {
    std::printf("%s: %s\n", std::string(e["name"]).c_str(), e["measured"].dump().c_str());
  }
  for (const auto& f : told["findings"]) std::printf("%s\n", std::string(f["text"]).c_str());
  EXPECT_EQ(run.code, 0) << told["reason"];
  for (const auto& f : told["findings"]) {
    const std::string text = f["text"];
    // Two samples may fall into one of the stand-in's milliseconds, and none into the next.
    if (plan != nullptr || !text.ends_with("late to it")) continue;
    EXPECT_LT(std::stoi(text), 200) << "of 6000";
  }
}

}  // namespace
}  // namespace whirl
