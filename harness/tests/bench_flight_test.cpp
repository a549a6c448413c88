// A flight controller on a bench, without the copper: its real image on a virtual board stands in for metal, its radio
// on a pseudo-terminal, its CAN on a bus in memory; the bench plays vehicle, sensors and ESCs to it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"
#include "harness/catalogue/board_file.hpp"
#include "harness/composition/boards.hpp"
#include "harness/standin/bare_board.hpp"
#include "harness/standin/no_world.hpp"
#include "harness/tests/common_clock.hpp"
#include "harness/tests/running_stand_in.hpp"
#include "io_bridges/socketcan/tests/memory_can.hpp"

namespace whirl {
namespace {

const std::string kRoot = WHIRL_ROOT;
constexpr double kPace = 0.5;  // of a clock that nobody is late by

// The real image, alone: nothing around it but its wires.
struct Metal {
  Metal(const ScratchFolder& folder, std::unique_ptr<io::CanPort> can, CommonClock& clock)
      : radio(folder.file("radio")) {
    const auto board = read_board(kRoot + "/test_plans/boards/px4fmu_v1_all_can.lua");
    StandInOptions wires;
    wires.pace = kPace;
    wires.can_bus = 2;
    wires.lines.push_back({2, std::move(io::PseudoTerminal::open(radio).value())});
    wires.can = std::move(can);
    VirtualBoardOptions options;
    options.board = {bare_board(board.value()),
                     {.image = kRoot + "/build/firmware/flight.elf", .seed = 1}};
    stand_in.emplace(world, std::make_unique<VirtualBoard>(std::move(options)), std::move(wires),
                     &clock);
  }
  void stop() { stand_in->stop(); }

  std::string radio;
  NoWorld world;
  std::optional<RunningStandIn> stand_in;
};

std::string bench_file(const std::string& radio) {
  return "return { bench = \"stand_in\", board = \"px4fmu_v1_all_can\", pace = " +
         std::to_string(kPace) + R"(, late = "5 ms", late_share = "2 %",
  links = { { name = "bus", bus = "can2", interface = "memory" },
            { name = "radio", bus = "usart2", path = ")" +
         radio + R"(", baud = "57600 baud" } },
  safety = { phrase = "clear", longest = "60 s", heartbeat = "1 s" } })";
}

struct Flown {
  int code = -1;
  nlohmann::json file;  // run.json
  std::map<std::string, double> figures() const {
    std::map<std::string, double> all;
    for (const auto& e : file["expectations"]) all[e["name"]] = e["measured"];
    return all;
  }
};

Flown fly(std::vector<std::string> words, const std::string& out, const bench::CanMaker& can,
          pacing::HostClock* clock) {
  const auto composition = boards_and_worlds(kRoot, out, nullptr, can, clock);
  words.insert(words.begin(), {"whirl", "run", kRoot + "/test_plans/flight/bench_hover.lua"});
  std::vector<char*> argv;
  argv.reserve(words.size());
  for (std::string& word : words) argv.push_back(word.data());
  Flown run;
  run.code = cli::run_program(static_cast<int>(argv.size()), argv.data(), composition);
  std::ifstream file(out + "/runs/latest/run.json");
  run.file = nlohmann::json::parse(file);
  return run;
}

TEST(BenchFlight, TheRealImageHoversOverItsWiresAsItDoesInLockstep) {
  const ScratchFolder folder;
  CommonClock clock;
  io::MemoryCan bus([&] { return clock.now_ns(); });
  Metal metal(folder, bus.join(), clock);
  const std::string file = folder.file("bench.lua");
  std::ofstream(file) << bench_file(metal.radio);
  const Flown flown = fly(
      {"--target", "bench/" + file, "--arm", "clear"}, folder.file("bench"),
      [&](const bench::CanBusLink&) -> Result<std::unique_ptr<io::CanPort>> { return bus.join(); },
      &clock);
  clock.leave();
  metal.stop();
  ASSERT_EQ(flown.code, 0) << std::string(flown.file["reason"]);
  const Flown lockstep = fly({}, folder.file("lockstep"), nullptr, nullptr);
  ASSERT_EQ(lockstep.code, 0) << std::string(lockstep.file["reason"]);
  const auto want = lockstep.figures();
  // Which of two that wake at one time is first is the machine's choice: five runs differed by up to 7 % in what is small.
  for (const auto& [name, got] : flown.figures()) {
    std::printf("%s: bench %.4g, lockstep %.4g\n", name.c_str(), got, want.at(name));
    const bool current = name.find("current") != std::string::npos;
    const bool error = name.find("RMS") != std::string::npos;
    if (!current && !error) continue;
    const auto parity = stated((current ? 0.01 : 0.15) * want.at(name), "parity");
    EXPECT_TRUE(near(got, want.at(name), parity)) << name;
  }
}

}  // namespace
}  // namespace whirl
