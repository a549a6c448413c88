// Receivers on a whole STM32F405, read by an image in the manner of other people's drivers. What is expected
// follows from the messages that go in, the data sheets' rates and the protocols' scales.
#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "base/near.hpp"
#include "harness/target/virtual_board.hpp"
#include "io_bridges/board_description/board_text.hpp"

namespace whirl::board_test {
namespace {

using Values = std::vector<std::uint32_t>;

struct RadioRun {
  std::map<std::string, Values> report;
  std::string findings, text, error;
};

std::string description(const std::string& sbus_keys) {
  return std::string(R"({"board":"radios","mcu":"stm32f405rg","hse_Hz":8000000,"image":")") +
         WHIRL_IMAGES + R"(/radio_style.elf","devices":[)" +
         R"({"name":"terminal","type":"serial","bus":"usart2","baud":115200},)" +
         R"({"name":"gps","type":"ublox_6","bus":"usart6","params.first_fix":7,)" +
         R"("params.latitude":0.5,"params.longitude":1,"params.height":0,)" +
         R"("params.wander_level":0,"params.wander_down":0,"params.velocity_noise":0},)" +
         R"({"name":"sum","type":"cppm","bus":"PA10","params.jitter":0},)" +
         R"({"name":"sbus","type":"sbus","bus":"uart4")" + sbus_keys + "}]}";
}

// 100 m east of the origin, 2 m/s north; sticks at 50 Hz.
void send_world(int millisecond, io::Batch& sensed) {
  io::BodyMotion motion;
  motion.p_WB_W_m[1] = 100.0;
  motion.v_WB_W_mps[0] = 2.0;
  sensed.add(io::Kind::body_motion, 0, millisecond * 1'000'000LL, motion);
  if (millisecond % 20 != 0) return;
  io::RcChannels sticks{{-1.0, 0.0, 1.0, 0.5, -0.5}};
  sensed.add(io::Kind::rc_channels, 0, millisecond * 1'000'000LL, sticks);
}

RadioRun run_radios(const std::string& sbus_keys) {
  RadioRun run;
  VirtualBoardOptions options;
  const auto start = read_board_text(description(sbus_keys));
  EXPECT_TRUE(start) << sbus_keys;
  if (start) options.board = start.value();
  VirtualBoard board(options);
  if (const auto started = board.start(); !started) {
    run.error = started.error().message();
    return run;
  }
  io::Batch happened, sensed;
  for (int k = 1; k <= 20'000 && run.text.find("\ndone 1\n") == std::string::npos; ++k) {
    sensed.clear();
    send_world(k - 1, sensed);
    board.run(k * 1'000'000LL, sensed);
    const auto state = board.arrive(happened);
    for (io::Reader r(happened.bytes()); r.next();) {
      const std::string payload(r.payload().begin(), r.payload().end());
      if (r.header().kind == io::Kind::uart_received) run.text += payload;
      if (r.header().kind == io::Kind::finding) run.findings += payload + "\n";
    }
    if (!state || state.value() != TargetState::running) break;
  }
  board.stop(happened);
  std::istringstream lines(run.text);
  std::string name;
  std::uint32_t value = 0;
  while (lines >> name >> value) run.report[name].push_back(value);
  if (run.report.count("done") == 0)
    run.error += "never done; it said:\n" + run.text + run.findings;
  return run;
}

TEST(RadioImages, GpsSumSignalAndSbusAreReadByInterrupts) {
  RadioRun run = run_radios(R"(,"inverter":true)");
  ASSERT_EQ(run.error, "");
  auto& got = run.report;
  EXPECT_EQ(got["gps_baud"], Values{9600});
  EXPECT_EQ(got["gps_hardware"], Values{40007});
  EXPECT_EQ(got["gps_pvt"], Values{0});  // refused by a 6
  EXPECT_EQ(got["gps_messages"], Values{111});
  EXPECT_EQ(got["gps_rate_200"], Values{1});
  EXPECT_EQ(got["gps_rate_100"], Values{0});
  EXPECT_EQ(got["gps_solutions"], Values{10});
  EXPECT_EQ(got["gps_span_ms"], Values{1800});
  EXPECT_EQ(got["gps_fix"], Values{3});
  EXPECT_EQ(got["gps_bad"], Values{0});
  // 0.5 rad; 1 rad and 100 m over N cos(0.5) = 5605.7 km, in 1e-7 deg, within the white noise of 5 cm.
  EXPECT_TRUE(near(got["gps_latitude"].at(0), 286478898, stated(100, "5 cm, twenty times over")));
  EXPECT_TRUE(
      near(got["gps_longitude"].at(0), 572957795 + 10221, stated(100, "5 cm, twenty times over")));
  EXPECT_EQ(got["gps_north_cmps"], Values{200});
  EXPECT_EQ(got["cppm_frames"], Values{40});  // of 22.5 ms in 900
  EXPECT_EQ(got["cppm_count"], Values{8});
  EXPECT_EQ(got["cppm"], (Values{1000, 1500, 2000, 1750, 1250}));
  EXPECT_TRUE(near(got["sbus_frames"].at(0), 64, stated(1, "a frame of 14 ms at either end")));
  EXPECT_EQ(got["sbus"], (Values{172, 992, 1811, 1401, 582}));
  EXPECT_EQ(got["sbus_flags"], Values{0});
  EXPECT_EQ(got["line_errors"], Values{0});
  // The rates that it tried before 9600, and what it asked for that is too fast.
  EXPECT_NE(run.findings.find("it reads garbage"), std::string::npos) << run.findings;
  EXPECT_NE(run.findings.find("faster than the part navigates"), std::string::npos);
}

TEST(RadioImages, WithoutAnInverterSbusIsGarbage) {
  RadioRun run = run_radios("");
  ASSERT_EQ(run.error, "");
  EXPECT_EQ(run.report["sbus_frames"], Values{0});
  EXPECT_GT(run.report["line_errors"].at(0), 100u);
}

}  // namespace
}  // namespace whirl::board_test
