// Receivers on a whole STM32F405, read by an image in the manner of other people's drivers. What is expected
// follows from the messages that go in, the data sheets' rates and the protocols' scales.
#include <gtest/gtest.h>

#include <string>

#include "base/near.hpp"
#include "io_bridges/qemu/tests/image_report.hpp"

namespace whirl::board_test {
namespace {

ImageBoard radios(const std::string& sbus_keys) {
  return {"radio_style",
          std::string(R"(,{"name":"gps","type":"ublox_6","bus":"usart6",)") +
              R"("params.first_fix":7,"params.latitude":0.5,"params.longitude":1,)" +
              R"("params.height":0,"params.wander_level":0,"params.wander_down":0,)" +
              R"("params.velocity_noise":0},)" +
              R"({"name":"sum","type":"cppm","bus":"PA10","params.jitter":0},)" +
              R"({"name":"sbus","type":"sbus","bus":"uart4")" + sbus_keys + "}"};
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

ImageRun run_radios(const std::string& sbus_keys) {
  return run_image(radios(sbus_keys), 20'000, send_world);
}

TEST(RadioImages, GpsSumSignalAndSbusAreReadByInterrupts) {
  ImageRun run = run_radios(R"(,"inverter":true)");
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
  ImageRun run = run_radios("");
  ASSERT_EQ(run.error, "");
  EXPECT_EQ(run.report["sbus_frames"], Values{0});
  EXPECT_GT(run.report["line_errors"].at(0), 100u);
}

}  // namespace
}  // namespace whirl::board_test
