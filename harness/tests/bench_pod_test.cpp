// A flight controller with SPI and I2C on a bench, without the copper: its real image and the pod's on two virtual boards
// stand in for metal, the radio and the pod's host line on pseudo-terminals, or the host's CAN on a bus in memory; the bench
// plays vehicle, sensors and ESCs behind the pod.
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
#include "harness/tests/flight_steps.hpp"
#include "harness/tests/pin_periods.hpp"
#include "harness/tests/running_stand_in.hpp"
#include "io_bridges/socketcan/tests/memory_can.hpp"

namespace whirl {
namespace {

const std::string kRoot = WHIRL_ROOT;
constexpr std::int64_t kSettled_ns =
    3'000'000'000;  // the image has set its IMU up, the pod has seen samples for a second
constexpr double kPace = 0.5;  // of a clock that nobody is late by

BoardDescription board_named(const std::string& name) {
  return read_board(kRoot + "/test_plans/boards/" + name + ".lua").value();
}

enum class PodPlays { receivers, all };  // all: the radio and the battery too

// The pod's host on its line, or on a bus.
struct Metal {
  Metal(const ScratchFolder& folder, CommonClock& clock, std::unique_ptr<io::CanPort> can = {},
        PodPlays plays = PodPlays::receivers)
      : radio(plays == PodPlays::all ? "" : folder.file("radio")),
        pod(folder.file("pod")),
        on_can(can != nullptr) {
    StandInOptions wires;
    wires.pace = kPace;
    if (!radio.empty()) {
      wires.lines.push_back({2, std::move(io::PseudoTerminal::open(radio).value())});
    }
    if (on_can) {
      wires.can = std::move(can);
      wires.can_bus = 2;
      wires.can_board = 1;
    } else {
      wires.lines.push_back({1, std::move(io::PseudoTerminal::open(pod).value()), 1});
    }
    BoardDescription flight = board_named("px4fmu_v1_sbus");
    const auto ready = static_cast<std::uint16_t>(flight.pins.size());
    flight.pins.push_back({.name = "imu_ready", .pin = "PC3"});
    auto boards =
        with_pod({std::move(flight), board_named(pods_board()),
                  kRoot + "/build/firmware/flight.elf", kRoot + "/build/firmware/pod.elf"});
    auto seen =
        std::make_unique<PinPeriods>(std::move(boards.value()), ready, kSettled_ns, periods);
    stand_in.emplace(world, std::move(seen), std::move(wires), &clock);
  }
  std::string pods_board() const {
    if (radio.empty()) return "pod_with_all";
    return on_can ? "pod_with_receivers_can" : "pod_with_receivers";
  }
  std::string link() const {
    return "{ name = \"pod\", pod = \"" + pods_board() + "\", " +
           (on_can ? "interface = \"memory" : "path = \"" + pod) + "\" }";
  }

  std::string radio, pod;  // no radio: the pod's
  bool on_can;
  Periods periods;  // of data-ready, as the flight controller sees it
  NoWorld world{16.0};
  std::optional<RunningStandIn> stand_in;
};

std::string bench_file(const Metal& metal) {
  return "return { bench = \"stand_in\", board = \"px4fmu_v1_sbus\", pace = " +
         std::to_string(kPace) + R"(, late = "5 ms", late_share = "5 %",
  links = { )" +
         metal.link() +
         (metal.radio.empty() ? std::string()
                              : R"(, { name = "radio", bus = "usart2", path = ")" + metal.radio +
                                    R"(", baud = "57600 baud" })") +
         R"( },
  safety = { phrase = "clear", longest = "120 s", heartbeat = "1 s" } })";
}

// As short as a flight can be: the hover is test_plans/flight/bench_hover_pod.lua, in the place of this one by
// WHIRL_BENCH_POD_PLAN.
std::string up_and(const std::string& more) {
  return R"(plan "up" {
  image = "flight", board = "px4fmu_v1_sbus", vehicle = "hp_quad", timeout = "20 s",
  run = function(t)
    t:within("8 s", function(s) return s.told_ready == 1 end, "it says that it can be armed")
    up_by_the_sticks(t)
    local up = t:record({ "tilt", "attitude_error" }, "0.5 s")
    t:expect(up:max "tilt", "tilt"):at_most "5 deg"
    t:expect(up:max "attitude_error", "and its own word of it"):at_most "3 deg"
)" + more +
         "  end,\n}";
}

// With its battery by the pod: two resistors of 1 %, and the telemetry's age (test_plans/chain/pod_radio.lua).
constexpr const char* kTold = R"(
    t:expect(math.abs(t:value("told_voltage").value - t:value("bus_voltage").value), "its word of its battery is off by, V"):at_most(0.35)
)";

// Samples fall into the stand-in's milliseconds, two into one and none into the next: the flight controller's IMU is to be
// even all the same, and what the pod counts of them little: a pseudo-terminal delivers one in some hundred a millisecond later
// than usual, which the flight controller sees in two periods.
void expect_even(const ComposedRun& run, const Periods& periods) {
  std::printf("data-ready: %lld periods of %lld to %lld ns, %lld over 20 us off\n",
              static_cast<long long>(periods.count), static_cast<long long>(periods.least_ns),
              static_cast<long long>(periods.most_ns), static_cast<long long>(periods.far));
  EXPECT_GT(periods.count, 2000);
  EXPECT_LT(periods.far, periods.count / 50);
  for (const auto& f : run.file["findings"]) {
    const std::string text = f["text"];
    if (!text.ends_with("late to it")) continue;
    EXPECT_LT(std::stoi(text), periods.count / 100);
  }
}

ComposedRun fly(const ScratchFolder& folder, CommonClock& clock, Metal& metal,
                const bench::CanMaker& can, const std::string& text = up_and("")) {
  const std::string file = folder.file("bench.lua"), up = folder.file("up.lua");
  std::ofstream(file) << bench_file(metal);
  std::ofstream(up) << kFlightSteps << text;
  const auto composition = boards_and_worlds(kRoot, folder.file("out"), nullptr, can, &clock);
  const char* plan = std::getenv("WHIRL_BENCH_POD_PLAN");
  ComposedRun run = run_composed(
      composition, {plan != nullptr ? plan : up, "--target", "bench/" + file, "--arm", "clear"});
  clock.leave();
  metal.stand_in->stop();
  for (const auto& e : run.file["expectations"]) {
    std::printf("%s: %s\n", std::string(e["name"]).c_str(), e["measured"].dump().c_str());
  }
  for (const auto& f : run.file["findings"]) {
    std::printf("%s\n", std::string(f["text"]).c_str());
  }
  return run;
}

TEST(BenchPod, TheRealImageFliesOnSensorsAndControllersThatThePodPlays) {
  const ScratchFolder folder;
  CommonClock clock;
  Metal metal(folder, clock, nullptr, PodPlays::all);
  const ComposedRun run = fly(folder, clock, metal, nullptr, up_and(kTold));
  EXPECT_EQ(run.code, 0) << run.file["reason"];
  expect_even(run, metal.periods);
}

TEST(BenchPod, AndWithThePodsHostOnCan) {
  const ScratchFolder folder;
  CommonClock clock;
  io::MemoryCan bus([&] { return clock.now_ns(); });
  Metal metal(folder, clock, bus.join());
  const ComposedRun run = fly(
      folder, clock, metal,
      [&](const bench::CanBusLink&) -> Result<std::unique_ptr<io::CanPort>> { return bus.join(); });
  EXPECT_EQ(run.code, 0) << run.file["reason"];
  expect_even(run, metal.periods);
  EXPECT_EQ(metal.periods.far, 0);
  EXPECT_GT(bus.seen().size(), 15'000u);  // 3 frames for each of 5000 samples at the least
}

// On the ground, by what the image itself tells of its IMU; of the others it learns the offset away there, and a fault that
// nothing has applied ends the run with an error.
constexpr const char* kSpoilt = R"(plan "spoilt" {
  image = "flight", board = "px4fmu_v1_sbus", vehicle = "hp_quad", timeout = "30 s",
  run = function(t)
    t:within("8 s", function(s) return s.told_ready == 1 end, "it says that it can be armed")
    t:wait "2 s"
    t:command { rc = { mode = 2 } }
    local function told(name) return t:record({ name }, "1 s"):mean(name) end
    t:expect(told "accel_error_x", "accelerometer"):within("-1.2 m/s2", "1.2 m/s2")
    t:fault { kind = "sensor_offset", device = "imu", axis = "accel_x", value = "5 m/s2" }
    t:fault { kind = "sensor_offset", device = "mag", axis = "field_x", value = "30 uT" }
    t:fault { kind = "sensor_offset", device = "baro", axis = "pressure", value = "-200 Pa" }
    t:wait "2 s"
    t:expect(told "accel_error_x", "accelerometer, 5 m/s2 off"):within("3.8 m/s2", "6.2 m/s2")
    t:fault { kind = "sensor_late", device = "mag", value = "20 ms", duration = "500 ms" }
    t:fault { kind = "rc_link_lost", device = "sbus", duration = "500 ms" }
    t:fault { kind = "gnss_jammed", device = "gps" }
    t:wait "1 s"
  end,
})";

TEST(BenchPod, FaultsOfWhatThePodPlaysAreWhatTheFlightControllerReads) {
  const ScratchFolder folder;
  CommonClock clock;
  Metal metal(folder, clock);
  const ComposedRun run = fly(folder, clock, metal, nullptr, kSpoilt);
  EXPECT_EQ(run.code, 0) << run.file["reason"];
}

// Nobody is at the wires: it is refused before they are looked for.
TEST(BenchPod, AFaultThatThePodCannotPlayIsRefusedWithItsLine) {
  for (const char* kind : {"i2c_nack", "uart_loss", "memory_removed"}) {
    const ScratchFolder folder;
    const std::string bench = folder.file("bench.lua"), plan = folder.file("nack.lua");
    std::ofstream(bench) << R"(return { bench = "none", board = "px4fmu_v1_sbus",
      links = { { name = "pod", pod = "pod_with_receivers", path = "/nowhere" },
                { name = "radio", bus = "usart2", path = "/nowhere/else" } },
      safety = { phrase = "clear", longest = "20 s" } })";
    std::ofstream(plan) << "plan \"nack\" { image = \"flight\", board = \"px4fmu_v1_sbus\",\n"
                           "  vehicle = \"hp_quad\", run = function(t)\n    t:wait \"1 s\"\n"
                           "    t:fault { kind = \""
                        << kind << "\", device = \"baro\" }\n  end }\n";
    const auto composition = boards_and_worlds(kRoot, folder.file("out"), nullptr, nullptr);
    const ComposedRun run =
        run_composed(composition, {plan, "--target", "bench/" + bench, "--arm", "clear"});
    EXPECT_EQ(run.code, 2);
    const std::string reason = run.file["reason"];
    EXPECT_NE(reason.find("nack.lua:4"), std::string::npos) << reason;
    EXPECT_NE(reason.find(kind), std::string::npos) << reason;
  }
}

}  // namespace
}  // namespace whirl
