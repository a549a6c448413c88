// A flight controller on a bench, without the copper: its real image on a virtual board stands in for metal, its radio
// on a pseudo-terminal, its CAN on a bus in memory; the bench plays vehicle, sensors and ESCs to it.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"
#include "harness/catalogue/board_file.hpp"
#include "harness/catalogue/vehicle_file.hpp"
#include "harness/composition/boards.hpp"
#include "harness/flight/vehicle_parts.hpp"
#include "harness/live/udp_port.hpp"
#include "harness/standin/bare_board.hpp"
#include "harness/standin/no_world.hpp"
#include "harness/target/bench/mavlink_check.hpp"
#include "harness/tests/common_clock.hpp"
#include "harness/tests/composed_run.hpp"
#include "harness/tests/flight_steps.hpp"
#include "harness/tests/running_stand_in.hpp"
#include "io_bridges/protocols/mavlink_messages.hpp"
#include "io_bridges/socketcan/tests/memory_can.hpp"

namespace whirl {
namespace {

const std::string kRoot = WHIRL_ROOT;
constexpr double kPace = 0.5;  // of a clock that nobody is late by

constexpr const char *kBoard = "px4fmu_v1_all_can", *kBoardWithSticks = "px4fmu_v1_all_can_sbus";

// What lockstep's plans fly by their seed. Of it, the crystal is on the stand-in's board.
flight::FlightParams copy_of_seed(std::uint64_t seed) {
  auto params = catalogue::read_vehicle(kRoot + "/test_plans/vehicles/hp_quad.lua", {});
  flight::draw_parts(params.value(), seed);
  return params.value();
}

// The real image, alone: nothing around it but its wires.
struct Metal {
  Metal(const ScratchFolder& folder, std::unique_ptr<io::CanPort> can, CommonClock& clock,
        const std::string& name, std::uint64_t seed = 1)
      : radio(folder.file("radio")), sticks(folder.file("sticks")) {
    auto board = read_board(kRoot + "/test_plans/boards/" + name + ".lua");
    flight::set_parts(board.value(), copy_of_seed(seed));
    StandInOptions wires;
    wires.pace = kPace;
    wires.can_bus = 2;
    wires.lines.push_back({2, std::move(io::PseudoTerminal::open(radio).value())});
    if (name == kBoardWithSticks) {
      wires.lines.push_back({1, std::move(io::PseudoTerminal::open(sticks).value())});
    }
    wires.can = std::move(can);
    VirtualBoardOptions options;
    options.board = {bare_board(board.value()),
                     {.image = kRoot + "/build/firmware/flight.elf", .seed = 1}};
    stand_in.emplace(world, std::make_unique<VirtualBoard>(std::move(options)), std::move(wires),
                     &clock);
  }
  void stop() { stand_in->stop(); }

  std::string radio, sticks;
  NoWorld world;
  std::optional<RunningStandIn> stand_in;
};

std::string bench_file(const Metal& metal, const std::string& board) {
  const std::string sticks =
      "{ name = \"sticks\", bus = \"usart1\", path = \"" + metal.sticks + "\" },";
  return "return { bench = \"stand_in\", board = \"" + board +
         "\", pace = " + std::to_string(kPace) + R"(, late = "5 ms", late_share = "2 %",
  links = { { name = "bus", bus = "can2", interface = "memory" }, )" +
         (board == kBoardWithSticks ? sticks : "") + R"(
            { name = "radio", kind = "mavlink", bus = "usart2", path = ")" +
         metal.radio + R"(", baud = "57600 baud" } },
  safety = { phrase = "clear", longest = "60 s", heartbeat = "1 s" } })";
}

// words: of whirl, behind which come those of the bench.
int on_bench(std::vector<std::string> words, const ScratchFolder& folder,
             const std::string& board = kBoard, std::uint64_t seed = 1) {
  CommonClock clock;
  io::MemoryCan bus([&] { return clock.now_ns(); });
  Metal metal(folder, bus.join(), clock, board, seed);
  const std::string file = folder.file("bench.lua");
  std::ofstream(file) << bench_file(metal, board);
  const auto composition = boards_and_worlds(
      kRoot, folder.file("bench"), nullptr,
      [&](const bench::CanBusLink&) -> Result<std::unique_ptr<io::CanPort>> { return bus.join(); },
      &clock);
  words.insert(words.end(), {"--target", "bench/" + file, "--arm", "clear"});
  const int code = run_words(composition, std::move(words));
  clock.leave();
  metal.stop();
  return code;
}

ComposedRun fly_on_bench(const std::string& plan, const ScratchFolder& folder,
                         const std::string& board = kBoard, std::uint64_t seed = 1) {
  const int code =
      on_bench({"whirl", "run", plan, "--seed", std::to_string(seed)}, folder, board, seed);
  return {code, run_file(folder.file("bench"))};
}

// With a cable in the radio's place, as the bench has.
ComposedRun fly_in_lockstep(const std::string& plan, const ScratchFolder& folder,
                            std::uint64_t seed = 1) {
  return run_composed(
      boards_and_worlds(kRoot, folder.file("lockstep"), nullptr),
      {plan, "--set", "plan.board=px4fmu_v1_all_can_cable", "--seed", std::to_string(seed)});
}

// How often each message is in a log of telemetry: framed by eight bytes of time each.
std::map<std::uint32_t, int> messages_in(const std::string& tlog) {
  std::ifstream file(tlog, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  std::map<std::uint32_t, int> count;
  constexpr std::size_t kTime = 8, kHeader = 10, kCrc = 2;
  for (std::size_t at = 0; at + kTime + kHeader <= bytes.size();) {
    const auto byte = [&](std::size_t i) {
      return static_cast<std::uint32_t>(static_cast<std::uint8_t>(bytes[at + kTime + i]));
    };
    EXPECT_EQ(byte(0), 0xFDu) << tlog << " at " << at;
    if (byte(0) != 0xFD) break;
    ++count[byte(7) | byte(8) << 8 | byte(9) << 16];
    at += kTime + kHeader + byte(1) + kCrc;
  }
  return count;
}

// Its parameters were asked for and set, it was armed and flown over the line: what it has said is there as in lockstep.
void expect_telemetry_of_lockstep(const std::string& bench, const std::string& lockstep) {
  EXPECT_FALSE(std::filesystem::exists(bench + "/serial.txt"));
  const auto got = messages_in(bench + "/telemetry.tlog");
  const auto want = messages_in(lockstep + "/telemetry.tlog");
  ASSERT_GT(want.size(), 5u);
  for (const auto& [id, count] : want) {
    const auto found = got.find(id);
    ASSERT_NE(found, got.end()) << id;
    // The flight ends up to 0.2 s earlier or later, of some 20 s, for a step waits for what it is told.
    EXPECT_TRUE(near(found->second, count, stated(2.0 + 0.03 * count, "rates of one image"))) << id;
  }
  EXPECT_EQ(got.size(), want.size());
}

// Bench over lockstep of ten copies, seeds 1 to 10 (docs/bench.md): mean, and what of a single one is chance. What is compared here
// is not among them. Of one alone they are too narrow where its error is small: seed 13, 0.19 cm, is off by 30 %.
struct Parity {
  const char* figure;
  double mean, sigma;
};
constexpr Parity kParity[] = {{"height RMS error", -0.002, 0.043},
                              {"sideways RMS error", 0.005, 0.055},
                              {"tilt RMS", 0.12, 0.19}};

struct Seeds {
  std::uint64_t first = 11, last = 11;
  double count() const { return static_cast<double>(last - first + 1); }
};

// WHIRL_BENCH_SEEDS=1..10: the table of docs/bench.md.
Seeds compared_seeds() {
  Seeds seeds;
  const char* given = std::getenv("WHIRL_BENCH_SEEDS");
  if (given == nullptr) return seeds;
  EXPECT_EQ(std::sscanf(given, "%lu..%lu", &seeds.first, &seeds.last), 2) << given;
  EXPECT_LE(seeds.first, seeds.last);
  return seeds;
}

TEST(BenchFlight, TheRealImageHoversOverItsWiresAsItDoesInLockstep) {
  const std::string plan = kRoot + "/test_plans/flight/bench_hover.lua";
  std::map<std::string, double> sum;
  const Seeds seeds = compared_seeds();
  for (std::uint64_t seed = seeds.first; seed <= seeds.last; ++seed) {
    const ScratchFolder folder;
    const ComposedRun flown = fly_on_bench(plan, folder, kBoard, seed);
    ASSERT_EQ(flown.code, 0) << std::string(flown.file["reason"]);
    const ComposedRun lockstep = fly_in_lockstep(plan, folder, seed);
    ASSERT_EQ(lockstep.code, 0) << std::string(lockstep.file["reason"]);
    expect_telemetry_of_lockstep(folder.file("bench/runs/latest"),
                                 folder.file("lockstep/runs/latest"));
    const auto want = lockstep.figures();
    for (const auto& [name, got] : flown.figures()) {
      std::printf("%s: bench %.4g, lockstep %.4g\n", name.c_str(), got, want.at(name));
      sum[name] += got / want.at(name) - 1.0;
      if (name.find("current") == std::string::npos) continue;
      EXPECT_TRUE(near(got, want.at(name), stated(0.01 * want.at(name), "the same weight flies")))
          << name;
    }
  }
  for (const Parity& parity : kParity) {
    const double mean = sum.at(parity.figure) / seeds.count();
    std::printf("%s: bench over lockstep %+.1f %%\n", parity.figure, 100.0 * mean);
    const auto chance =
        stated(3.0 * parity.sigma / std::sqrt(seeds.count()), "three sigma of so many copies");
    EXPECT_TRUE(near(mean, parity.mean, chance)) << parity.figure;
  }
}

constexpr const char* kAtRest = R"(plan "at rest" {
  image = "flight", board = "px4fmu_v1_all_can", vehicle = "hp_quad", timeout = "30 s",
  run = function(t)
    ready_on_can(t)
    t:wait "1 s"
    local axes = { "accel_error_x", "accel_error_y", "accel_error_z" }
    local still = t:record(axes, "10 s")
    for _, axis in ipairs(axes) do t:expect(still:mean(axis), axis):within("-5 m/s2", "5 m/s2") end
  end,
})";

// Of 20 samples, told twice a second, each with 0.08 m/s2 of noise (400 ug/sqrt(Hz), PS-MPU-6000A 6.2, up to 260 Hz), the mean
// of bench and lockstep differ by 0.025 (1 sigma). The zero of an axis may be off by 0.5 m/s2 and more.
TEST(BenchFlight, ItsImuIsTheCopyThatTheSeedDraws) {
  const auto noise = stated(0.075, "three sigma of what two means of 20 samples differ by");
  for (const std::uint64_t seed : {1, 3}) {
    const ScratchFolder folder;
    const std::string plan = folder.file("rest.lua");
    std::ofstream(plan) << kFlightSteps << kAtRest;
    const ComposedRun stood = fly_on_bench(plan, folder, kBoard, seed);
    ASSERT_EQ(stood.code, 0) << std::string(stood.file["reason"]);
    const ComposedRun lockstep = fly_in_lockstep(plan, folder, seed);
    ASSERT_EQ(lockstep.code, 0) << std::string(lockstep.file["reason"]);
    double off_mps2 = 0.0;
    for (const char* axis : {"accel_error_x", "accel_error_y", "accel_error_z"}) {
      const double got = stood.figures().at(axis), want = lockstep.figures().at(axis);
      std::printf("seed %d, %s: bench %.4f, lockstep %.4f m/s2\n", static_cast<int>(seed), axis,
                  got, want);
      EXPECT_TRUE(near(got, want, noise)) << axis;
      off_mps2 = std::hypot(off_mps2, want);
    }
    EXPECT_GT(off_mps2, 0.15) << "a copy without errors would not be told from none";
  }
}

// At half of the host's time: HEARTBEAT each 2 s.
TEST(BenchFlight, ACheckOfItsLineHearsTheImageAndIsAnswered) {
  const ScratchFolder folder;
  CommonClock clock;
  io::MemoryCan bus([&] { return clock.now_ns(); });
  Metal metal(folder, bus.join(), clock, kBoard);
  const auto told = bench::check_mavlink(
      {.link = {"radio", metal.radio, 2, 57600}, .seconds = 5.0 / kPace}, clock);
  clock.leave();
  metal.stop();
  ASSERT_TRUE(told.ok()) << told.error().message();
  for (const std::string& line : told.value()) std::printf("%s\n", line.c_str());
  ASSERT_EQ(told.value().size(), 3u);
  EXPECT_EQ(told.value()[0].rfind("MAVLink of 1/1 at 57600 baud: ", 0), 0u);
  EXPECT_NE(told.value()[0].find("; 0 missing by their numbers, 0 B outside of frames"),
            std::string::npos);
  EXPECT_NE(told.value()[1].find("heard 5 times, period 2000.0 ms"), std::string::npos);
  EXPECT_NE(told.value()[2].find("answered 20 of 20 times"), std::string::npos);
}

TEST(BenchFlight, ACheckRefusesMavlinkWhereTheBoardHasNoRadioAndABoardThatIsNone) {
  const ScratchFolder folder;
  const auto said = [&](const std::string& board, const std::string& uart) {
    const std::string file = folder.file("bench.lua");
    std::ofstream(file) << R"(return { bench = "none", board = ")" << board << R"(",
  links = { { name = "radio", kind = "mavlink", bus = ")"
                        << uart << R"(", path = "/nowhere" } },
  safety = { phrase = "clear", longest = "1 s" } })";
    ::testing::internal::CaptureStderr();
    EXPECT_EQ(run_words(boards_and_worlds(kRoot, folder.file("out"), nullptr),
                        {"whirl", "bench", "check", file}),
              2);
    return ::testing::internal::GetCapturedStderr();
  };
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(said("px4fmu_v1", "usart1"), "bench.lua: radio: kind = \"mavlink\", and px4fmu_v1 has no");
  has(said("no_such_board", "usart2"), "no_such_board");
  has(said("esc32v2", "usart1"), "a board with a mavlink_link");
}

constexpr const char* kCut = R"(plan "cut" {
  image = "flight", board = "px4fmu_v1_all_can", vehicle = "hp_quad", timeout = "30 s",
  run = function(t)
    ready_on_can(t)
    t:command { arm = true }
    t:within("4 s", function(s) return s.told_armed == 1 end, "armed")
    t:command { takeoff = "0.6 m" }
    t:within("4 s", function(s) return s.height_m > 0.5 end, "up")
    t:fault { kind = "sensor_offset", device = "baro", axis = "pressure", value = "50 Pa" }
    t:wait "200 ms"
    t:expect(t:value "told_armed", "flies on"):equal(1)
    t:fault { kind = "can_cut", device = "imu" }
    t:within("2 s", function(s) return s.told_armed == 0 end, "motors off")
  end,
})";

TEST(BenchFlight, FaultsOfItsPartsDoWhatTheyDoInLockstep) {
  const ScratchFolder folder;
  const std::string plan = folder.file("cut.lua");
  std::ofstream(plan) << kFlightSteps << kCut;
  const ComposedRun flown = fly_on_bench(plan, folder);
  ASSERT_EQ(flown.code, 0) << std::string(flown.file["reason"]);
  const ComposedRun lockstep = fly_in_lockstep(plan, folder);
  ASSERT_EQ(lockstep.code, 0) << std::string(lockstep.file["reason"]);
  // Told 10 times a second.
  EXPECT_TRUE(near(flown.figures().at("motors off"), lockstep.figures().at("motors off"),
                   stated(0.1, "how often it is told")));
}

// By a receiver on a line of the bench, which then loses its transmitter.
constexpr const char* kBySticks = R"(plan "by its sticks" {
  image = "flight", board = "px4fmu_v1_all_can_sbus", vehicle = "hp_quad", timeout = "40 s",
  run = function(t)
    ready_on_can(t)
    up_by_the_sticks(t)
    t:fault { kind = "rc_link_lost", device = "sbus" }
    t:told("3 s", "radio control lost")
  end,
})";

TEST(BenchFlight, FliesByTheSticksOfAReceiverOnALine) {
  const ScratchFolder folder;
  const std::string plan = folder.file("sticks.lua");
  std::ofstream(plan) << kFlightSteps << kBySticks;
  const ComposedRun flown = fly_on_bench(plan, folder, kBoardWithSticks);
  EXPECT_EQ(flown.code, 0) << std::string(flown.file["reason"]);
}

constexpr const char* kWatched = R"(plan "watched" {
  image = "flight", board = "px4fmu_v1_all_can", vehicle = "hp_quad", timeout = "30 s",
  run = function(t)
    t:within("8 s", function(s) return s.heartbeat_age_s < 1.5 end, "the first heartbeat")
  end,
})";

// A ground station on UDP beside it: each tenth of a second of the host it reads a parameter.
class Client {
 public:
  Client() : port_(std::move(live::UdpPort::open("127.0.0.1:9", 0).value())) {}
  std::string place() const { return "127.0.0.1:" + std::to_string(port_.own_port()); }
  void ask(std::uint16_t flight) {
    auto to_flight = live::UdpPort::open("127.0.0.1:" + std::to_string(flight), 0);
    io::MavlinkSender sender{254, 190, 0};
    const io::ParamRequestRead read{
        .target_system = 1, .target_component = 1, .param_id = io::to_param_id("ESC_BUS")};
    for (; !done_; std::this_thread::sleep_for(std::chrono::milliseconds(100))) {
      to_flight.value().send(io::encode(io::pack(read, sender)));
    }
  }
  void end() { done_ = true; }
  // What has come for it: how often each message, and each in a datagram of its own.
  std::map<std::uint32_t, int> heard() {
    std::map<std::uint32_t, int> count;
    io::MavlinkParser parser([&](const io::MavlinkFrame& frame, std::span<const std::uint8_t>) {
      const auto value = io::unpack<io::ParamValue>(frame);
      if (!value || io::param_name(value->param_id) == "ESC_BUS") ++count[frame.msgid];
    });
    while (const auto datagram = port_.receive()) {
      for (const std::uint8_t byte : *datagram) parser.add(byte);
      EXPECT_FALSE(parser.in_frame());
    }
    EXPECT_EQ(parser.counts().stray, 0u);
    return count;
  }

 private:
  live::UdpPort port_;
  std::atomic<bool> done_ = false;
};

TEST(BenchFlight, AMavlinkClientOnUdpIsOnTheBoardsLine) {
  const ScratchFolder folder;
  const std::string plan = folder.file("watched.lua");
  std::ofstream(plan) << kWatched;
  Client client;
  const std::uint16_t free_port = live::UdpPort::open("127.0.0.1:9", 0).value().own_port();
  std::thread asking([&] { client.ask(free_port); });
  const int code = on_bench({"whirl", "fly", plan, "--udp", client.place(), "--listen",
                             std::to_string(free_port), "--seconds", "6"},
                            folder);
  client.end();
  asking.join();
  const auto file = run_file(folder.file("bench"));
  EXPECT_EQ(code, 0) << file["reason"];
  EXPECT_EQ(file["verdict"], "none");
  auto heard = client.heard();
  EXPECT_GE(heard[io::Heartbeat::kId], 3);
  EXPECT_GE(heard[io::ParamValue::kId], 1);
}

}  // namespace
}  // namespace whirl
