// A GPS receiver on a bench, without the copper: the flight controller's real image on a virtual board stands in for metal, its
// radio and its GPS on pseudo-terminals, its ESCs' CAN in memory. It sets the receiver up, has a fix, loses it and finds it
// again, by its own telemetry. What copper makes of two rates that differ is harness/target/bench/tests/gps_driver_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"
#include "harness/catalogue/board_file.hpp"
#include "harness/composition/boards.hpp"
#include "harness/standin/bare_board.hpp"
#include "harness/standin/no_world.hpp"
#include "harness/tests/common_clock.hpp"
#include "harness/tests/composed_run.hpp"
#include "harness/tests/running_stand_in.hpp"
#include "io_bridges/protocols/mavlink.hpp"
#include "io_bridges/socketcan/tests/memory_can.hpp"

namespace whirl {
namespace {

const std::string kRoot = WHIRL_ROOT;
constexpr double kPace = 0.5;  // of a clock that nobody is late by

// As px4fmu_v1_can.lua, without its IMU, barometer, magnetometer and card: the image's tasks run without them.
constexpr const char* kBoard = R"(return {
  board = "gps_on_a_line", mcu = "stm32f405rg", hse = "24 MHz",
  devices = {
    { name = "esc1", type = "esc_dronecan", bus = "can2", motor = 1 },
    { name = "esc2", type = "esc_dronecan", bus = "can2", motor = 2 },
    { name = "esc3", type = "esc_dronecan", bus = "can2", motor = 3 },
    { name = "esc4", type = "esc_dronecan", bus = "can2", motor = 4 },
    { name = "radio", type = "mavlink_link", bus = "usart2", baud = "57600 baud" },
    { name = "gps", type = "ublox_6", bus = "usart6", params = { first_fix = "3 s", latitude = "47.4 deg", longitude = "8.5 deg" } },
  },
})";

// The real image, alone: nothing around it but its wires.
struct Metal {
  Metal(const ScratchFolder& folder, std::unique_ptr<io::CanPort> can, CommonClock& clock)
      : board(folder.file("gps_on_a_line.lua")),
        radio(folder.file("radio")),
        gps(folder.file("gps")) {
    std::ofstream(board) << kBoard;
    StandInOptions wires;
    wires.pace = kPace;
    wires.can_bus = 2;
    wires.can = std::move(can);
    wires.lines.push_back({2, std::move(io::PseudoTerminal::open(radio).value())});
    wires.lines.push_back({6, std::move(io::PseudoTerminal::open(gps).value())});
    VirtualBoardOptions options;
    options.board = {bare_board(read_board(board).value()),
                     {.image = kRoot + "/build/firmware/flight.elf", .seed = 1}};
    stand_in.emplace(world, std::make_unique<VirtualBoard>(std::move(options)), std::move(wires),
                     &clock);
  }
  std::string bench() const {
    return "return { bench = \"stand_in\", board = \"gps_on_a_line\", pace = " +
           std::to_string(kPace) + R"(, late = "5 ms", late_share = "2 %",
  links = { { name = "bus", bus = "can2", interface = "memory" },
            { name = "radio", bus = "usart2", path = ")" +
           radio + R"(", baud = "57600 baud" },
            { name = "gps", bus = "usart6", path = ")" +
           gps + R"(" } },
  safety = { phrase = "clear", longest = "60 s", heartbeat = "1 s" } })";
  }
  std::string plan(const std::string& steps) const {
    return "plan \"gps\" { image = \"flight\", board = \"" + board +
           "\", vehicle = \"hp_quad\", outdoors = true, timeout = \"60 s\",\n"
           "  run = function(t)\n" +
           steps + "  end }\n";
  }

  std::string board, radio, gps;
  NoWorld world;
  std::optional<RunningStandIn> stand_in;
};

struct Told {  // of GPS_RAW_INT
  int fix_type, satellites;
  double latitude_deg, longitude_deg;
};

// The times between the frames are no frames, and are passed over.
std::vector<Told> told_by_gps(const std::string& said) {
  std::ifstream file(said, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  std::vector<Told> all;
  io::MavlinkParser parser([&](const io::MavlinkFrame& frame, std::span<const std::uint8_t>) {
    const auto degrees = [&](std::size_t at) {
      std::int32_t e7 = 0;
      std::memcpy(&e7, frame.payload.data() + at, sizeof e7);
      return 1e-7 * e7;
    };
    constexpr std::uint32_t kGpsRawInt = 24;
    if (frame.msgid != kGpsRawInt) return;
    all.push_back({frame.payload[28], frame.payload[29], degrees(8), degrees(12)});
  });
  for (const char byte : bytes) parser.add(static_cast<std::uint8_t>(byte));
  return all;
}

// Without what is told again and again.
std::vector<int> fixes(const std::vector<Told>& all) {
  std::vector<int> changes;
  for (const Told& told : all) {
    if (changes.empty() || changes.back() != told.fix_type) changes.push_back(told.fix_type);
  }
  return changes;
}

bool same_place(const Told& a, const Told& b) {
  return a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg;
}

constexpr const char* kSteps = R"(
    t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
    t:wait "6 s"
    t:fault { kind = "gnss_jammed", device = "gps", duration = "2 s" }
    t:wait "5 s"
    t:fault { kind = "gnss_brown_out", device = "gps", duration = "10 ms" }
    t:wait "8 s"
)";

TEST(BenchGps, TheRealImageSetsTheReceiverUpAndSaysThatItHasAFix) {
  const ScratchFolder folder;
  CommonClock clock;
  io::MemoryCan bus([&] { return clock.now_ns(); });
  Metal metal(folder, bus.join(), clock);
  const std::string file = folder.file("bench.lua"), plan = folder.file("gps.lua");
  std::ofstream(file) << metal.bench();
  std::ofstream(plan) << metal.plan(kSteps);
  const auto composition = boards_and_worlds(
      kRoot, folder.file("out"), nullptr,
      [&](const bench::CanBusLink&) -> Result<std::unique_ptr<io::CanPort>> { return bus.join(); },
      &clock);
  const ComposedRun run =
      run_composed(composition, {plan, "--target", "bench/" + file, "--arm", "clear"});
  clock.leave();
  metal.stand_in->stop();
  EXPECT_EQ(run.code, 0) << run.file["reason"];
  const auto told = told_by_gps(folder.file("out") + "/runs/latest/telemetry.tlog");
  ASSERT_EQ(fixes(told), (std::vector<int>{0, 3, 0, 3}));
  const auto place = stated(20e-5, "20 m: the fix is seconds old");
  EXPECT_TRUE(near(told.back().latitude_deg, 47.4, place));
  EXPECT_TRUE(near(told.back().longitude_deg, 8.5, place));
  // Without supply it is silent, and so is a search: the image tells its last place, to the last digit. Then there are new ones.
  const auto lost = std::adjacent_find(told.rbegin(), told.rend(), same_place);
  ASSERT_NE(lost, told.rend());
  EXPECT_EQ(lost->fix_type, 3);
  EXPECT_GE(lost - told.rbegin(), 2);
}

struct Refusal {
  const char *links, *fault, *place, *words;
};
constexpr const char* kPod = R"({ name = "pod", pod = "pod_with_parts", path = "/nowhere" },)";
constexpr const char* kPodWithGps =
    R"({ name = "pod", pod = "pod_with_receivers", path = "/nowhere" },)";
constexpr const char* kPodWithRadio =
    R"({ name = "pod", pod = "pod_with_radio", path = "/nowhere" },)";
constexpr const char* kGps = R"({ name = "gps", bus = "usart6", path = "/nowhere/gps" },)";
constexpr const char* kGpsAgain = R"({ name = "more", bus = "usart6", path = "/nowhere/more" },)";

// Nobody is at the wires: it is refused before they are looked for.
TEST(BenchGps, WhatNoBareLineCanBeIsRefusedInOneLineWithItsPlace) {
  const Refusal cases[] = {
      {kPodWithGps, "gnss_jammed", "bench.lua", "both a pod and a line play gps"},
      {kPodWithRadio, "gnss_jammed", "bench.lua", "both a pod and a line play radio"},
      {kPod, "uart_loss", "gps.lua:4", "uart_loss"},
      {kPod, "i2c_nack", "gps.lua:4", "i2c_nack"},
  };
  const ScratchFolder folder;
  const auto reason_of = [&](const std::string& links, const std::string& kind) {
    const std::string bench = folder.file("bench.lua"), plan = folder.file("gps.lua");
    std::ofstream(bench) << "return { bench = \"none\", board = \"px4fmu_v1\", links = { " << links
                         << R"({ name = "radio", bus = "usart2", path = "/nowhere/else" } },
      safety = { phrase = "clear", longest = "20 s" } })";
    std::ofstream(plan) << "plan \"gps\" { image = \"flight\", board = \"px4fmu_v1\",\n"
                           "  vehicle = \"hp_quad\", run = function(t)\n    t:wait \"1 s\"\n"
                           "    t:fault { kind = \""
                        << kind << "\", device = \"gps\" }\n  end }\n";
    const ComposedRun run =
        run_composed(boards_and_worlds(kRoot, folder.file("out"), nullptr, nullptr),
                     {plan, "--target", "bench/" + bench, "--arm", "clear"});
    EXPECT_EQ(run.code, 2);
    return std::string(run.file["reason"]);
  };
  for (const Refusal& c : cases) {
    const std::string reason = reason_of(std::string(c.links) + kGps, c.fault);
    EXPECT_NE(reason.find(c.place), std::string::npos) << reason;
    EXPECT_NE(reason.find(c.words), std::string::npos) << reason;
  }
  EXPECT_NE(reason_of(kPod, "gnss_jammed").find("nothing plays gps"), std::string::npos);
  EXPECT_NE(reason_of(std::string(kGps) + kGpsAgain, "gnss_jammed").find("'usart6' is there twice"),
            std::string::npos);
  const std::string elsewhere = reason_of(
      R"({ name = "tm", kind = "mavlink", bus = "usart6", path = "/nowhere/tm" },)", "gnss_jammed");
  EXPECT_NE(elsewhere.find("px4fmu_v1 has no telemetry radio on usart6"), std::string::npos)
      << elsewhere;
  // What a receiver's line can have goes on, to the wires that are not there.
  EXPECT_NE(reason_of(std::string(kPod) + kGps, "gnss_jammed").find("no such serial line"),
            std::string::npos);
}

}  // namespace
}  // namespace whirl
