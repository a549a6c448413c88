// An ESC's real image as a stand-in for metal, and the bench's plan run against it.
#pragma once
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/scratch_folder.hpp"
#include "harness/catalogue/board_file.hpp"
#include "harness/catalogue/stand_table.hpp"
#include "harness/composition/boards.hpp"
#include "harness/stand/stand_world.hpp"
#include "harness/tests/common_clock.hpp"
#include "harness/tests/composed_run.hpp"
#include "harness/tests/running_stand_in.hpp"

namespace whirl {

inline const std::string kRoot = WHIRL_ROOT;

inline stand::StandParams stand_params() {
  const auto table =
      lua::read_text(R"(return { prop = "hk_10x4.5", battery = "4s_2200" })", "test");
  auto params = catalogue::read_stand(table.value(), kRoot + "/test_plans/propellers");
  params.value().commands = false;
  return params.value();
}

struct Metal {  // what the bench hangs on
  // can: none, the board commanded over I2C; else that commanded over CAN, joined to it. clock: null: the host's.
  Metal(const ScratchFolder& folder, double at_pace, std::unique_ptr<io::CanPort> can = {},
        CommonClock* clock = nullptr)
      : pace(at_pace),
        board_name(can ? "esc32v2_can" : "esc32v2"),
        serial(folder.file("terminal")),
        cell(folder.file("cell")) {
    auto board = read_board(kRoot + "/test_plans/boards/" + board_name + ".lua");
    StandInOptions wires;
    wires.pace = pace;
    wires.lines.push_back({1, std::move(io::PseudoTerminal::open(serial).value())});
    wires.instruments.emplace(std::move(io::PseudoTerminal::open(cell).value()));
    wires.can = std::move(can);
    wires.told = {"thrust", "bus_voltage", "supply_current"};
    VirtualBoardOptions options;
    options.board = {std::move(board.value()),
                     {.image = kRoot + "/build/firmware/esc.elf", .seed = 1}};
    stand_in.emplace(world, std::make_unique<VirtualBoard>(std::move(options)), std::move(wires),
                     clock);
  }
  void stop() { stand_in->stop(); }

  double pace;
  std::string board_name, serial, cell;
  stand::StandWorld world{stand_params(), 1};
  std::optional<RunningStandIn> stand_in;
};

// link: the keys of the one that commands.
inline std::string bench_file(const Metal& metal, const std::string& link) {
  return "return { bench = \"stand_in\", board = \"" + metal.board_name +
         "\", pace = " + std::to_string(metal.pace) + R"(, late = "5 ms", late_share = "2 %",
  links = { { name = "throttle", )" +
         link + R"( },
            { name = "terminal", bus = "usart1", path = ")" +
         metal.serial + R"(", baud = "921600 baud" } },
  instruments = { { name = "cell", path = ")" +
         metal.cell + R"(", readings = { { signal = "thrust", column = 1, scale = "1 N" },
    { signal = "bus_voltage", column = 2, scale = "1 V" },
    { signal = "supply_current", column = 3, scale = "1 A" } } } },
  signals = { speed = "told_speed" },
  safety = { phrase = "clear", longest = "30 s", heartbeat = "1 s",
             limits = { { signal = "supply_current", low = "-5 A", high = "22 A" } } } })";
}

struct BenchMakers {
  bench::BridgeMaker bridge;
  bench::CanMaker can = bench::socket_can_port;
  CommonClock* clock = nullptr;
};

inline ComposedRun run_on_bench(const ScratchFolder& folder, Metal& metal, const std::string& link,
                                const BenchMakers& makers) {
  const std::string bench = folder.file("bench.lua"), out = folder.file("out");
  std::ofstream(bench) << bench_file(metal, link);
  const auto composition = boards_and_worlds(kRoot, out, makers.bridge, makers.can, makers.clock);
  const std::string plan = metal.board_name == "esc32v2" ? "rise.lua" : "rise_can.lua";
  ComposedRun run = run_composed(composition, {kRoot + "/test_plans/bench/" + plan, "--target",
                                               "bench/" + bench, "--arm", "clear"});
  if (makers.clock != nullptr) makers.clock->leave();
  metal.stop();
  return run;
}

// Why a run is not judged: its host was late, or its metal, which no metal is. Empty: it is.
inline std::string why_not_judged(const ComposedRun& run, Metal& metal) {
  const std::string reason = run.file["reason"];
  if (run.code != 0 && (*metal.stand_in)->lateness().slipped_ns > 0) {
    return "the stand-in was late: " + reason;
  }
  const bool late = reason.find("the host was late") != std::string::npos ||
                    reason.find("heard nothing of this program") != std::string::npos;
  return run.code == 3 && late ? reason : "";
}

inline void expect_a_rise(const ComposedRun& run) {
  ASSERT_EQ(run.code, 0) << std::string(run.file["reason"]);
  for (const auto& e : run.file["expectations"]) {
    if (e["name"] != "thrust rise, 10 to 90 %") continue;
    std::printf("rise on the bench %.2f ms\n", e["measured"].get<double>());
    EXPECT_GT(e["measured"].get<double>(), 10.0);
    return;
  }
  ADD_FAILURE() << "no rise was measured";
}

}  // namespace whirl
