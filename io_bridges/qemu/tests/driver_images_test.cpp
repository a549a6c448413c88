// Images in the manner of other people's drivers, run on the whole STM32F405: each reports what it
// measured as "name value" lines on USART2. What is expected follows from the settings in the image
// (dividers, volts on pins, ISO 11898) and the data sheet, never from the models.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "io_bridges/qemu/tests/image_report.hpp"

namespace whirl::board_test {
namespace {

std::string bytes_at(const std::string& path, std::streamoff at, std::size_t count) {
  std::ifstream in(path, std::ios::binary);
  in.seekg(at);
  std::string bytes(count, '?');
  in.read(bytes.data(), static_cast<std::streamsize>(count));
  return bytes;
}

TEST(DriverImages, HalStyle) {
  ImageRun run =
      run_image({"hal_style", R"(,{"name":"v1","type":"volts","bus":"PA1","params.volts":1.65})"
                              R"(,{"name":"wire","type":"jumper","cs":"PB6","int":"PA8"})"},
                8000);
  ASSERT_EQ(run.error, "") << run.findings;
  EXPECT_EQ(run.faults, 0) << run.findings;
  Report& got = run.report;
  EXPECT_EQ(got["failures"], (Values{0, 0}));
  expect_between(99, got["tim3_updates"], 101);  // 1 kHz for 99 to 100 ms
  EXPECT_EQ(got["pwm_period_us"], Values{2000});
  EXPECT_EQ(got["pwm_high_us"], Values{500});
  EXPECT_EQ(got["adc_poll"], Values{2048});  // half of 3.3 V
  EXPECT_EQ(got["adc_dma_done"], Values{1});
  // Half scale, 0.76 V at 25 degrees, 1.21 V reference, half scale: data sheet typical values.
  EXPECT_EQ(got["adc_dma"], (Values{2048, 943, 1502, 2048}));
  EXPECT_EQ(got["crc"], Values{0xC704DD7B});
  EXPECT_EQ(got["rng_differs"], Values{1});
  EXPECT_EQ(got["rtc_hms"], (Values{0x123458, 0x123500}));  // two seconds later
  EXPECT_EQ(got["rtc_date"], Values{0x26B121});
  EXPECT_EQ(run.findings, "");
}

TEST(DriverImages, SplStyle) {
  ImageRun run =
      run_image({"spl_style", R"(,{"name":"v1","type":"volts","bus":"PA1","params.volts":0.825})"
                              R"(,{"name":"v4","type":"volts","bus":"PA4","params.volts":2.475})"
                              R"(,{"name":"wire","type":"jumper","cs":"PC0","int":"PA0"})"},
                1000);
  ASSERT_EQ(run.error, "") << run.findings;
  EXPECT_EQ(run.faults, 0) << run.findings;
  Report& got = run.report;
  EXPECT_EQ(got["dma_words"], Values{64});
  expect_between(800, got["adc_eight_us"], 803);  // eight triggers, 100 us apart
  EXPECT_EQ(got["adc1"], Values{1024});
  EXPECT_EQ(got["adc2"], Values{3072});
  // Half of 100 us less a dead time of 400 clocks of 168 MHz: 47.62 %.
  expect_between(466, got["main_permille"], 486);
  expect_between(466, got["complement_permille"], 486);
  EXPECT_EQ(got["shoot_through"], Values{0});
  EXPECT_EQ(got["moe_after_break"], Values{0});
  EXPECT_EQ(got["burst_ccr"], (Values{100, 200, 300}));
  EXPECT_EQ(got["exti_edges"], Values{5});
  EXPECT_EQ(got["exti_prompt"], Values{1});
  EXPECT_EQ(got["i2c_af"], Values{1});
  EXPECT_EQ(got["i2c_free"], Values{1});
  EXPECT_EQ(got["dac_before"], Values{0});
  EXPECT_EQ(got["dac_after"], Values{1234});
}

TEST(DriverImages, Libopencm3StyleLivesThroughBothWatchdogs) {
  ImageRun run = run_image({"libopencm3_style", ""}, 3000);
  ASSERT_EQ(run.error, "") << run.findings;
  EXPECT_EQ(run.faults, 0) << run.findings;
  Report& got = run.report;
  EXPECT_EQ(got["power_on"], Values{1});
  expect_between(100, got["one_shot_ms"], 101);
  EXPECT_EQ(got["can_init"], Values{1});
  EXPECT_EQ(got["can_pending"], Values{2});  // 0x120 and 0x121 pass the filter
  EXPECT_EQ(got["can_sum"], Values{2 * 0x120 * 1000 + 2 * 0x121});
  EXPECT_EQ(got["iwdg_flag"], Values{1});
  EXPECT_EQ(got["power_on_again"], Values{0});
  // 50 ms of LSI, after the report (about 6 ms), the pulse and the CAN frames: 100 + 2 ms.
  expect_between(150, got["iwdg_alive_ms"], 170);
  EXPECT_EQ(got["wwdg_flag"], Values{1});
  EXPECT_EQ(got["wwdg_warnings"], Values{4});
  // Four runs of 63 counts of 780 us and one count more, after the report.
  expect_between(197, got["wwdg_alive_ms"], 210);
}

TEST(DriverImages, ChibiosStyle) {
  ImageRun run =
      run_image({"chibios_style", R"(,{"name":"v1","type":"volts","bus":"PA1","params.volts":1.1})"
                                  R"(,{"name":"wire","type":"jumper","cs":"PB0","int":"PB6"})"},
                8000);
  ASSERT_EQ(run.error, "") << run.findings;
  EXPECT_EQ(run.faults, 0) << run.findings;
  Report& got = run.report;
  EXPECT_EQ(got["alarms"], Values{200});
  EXPECT_EQ(got["alarms_us"], Values{100 + 199 * 137 + 199 * 200 / 2});
  EXPECT_EQ(got["alarm_prompt"], Values{1});
  // 16 conversions of 492 clocks at 21 MHz: 374.9 us, so 26 buffers in 10 ms.
  EXPECT_EQ(got["adc_fulls"], Values{26});
  EXPECT_EQ(got["adc_last_full"], Values{1});  // RM0090: EN cleared by software sets TCIF
  EXPECT_EQ(got["adc_pin"], Values{1365});     // a third of the scale
  EXPECT_EQ(got["adc_vref"], Values{1502});
  EXPECT_EQ(got["adc_overrun"], Values{0});
  EXPECT_EQ(got["icu_period"], Values{2500});
  EXPECT_EQ(got["icu_width"], Values{1500});
  EXPECT_EQ(got["icu_count_right"], Values{1});
  EXPECT_EQ(got["rtc_alarms"], Values{3});  // in 3.5 s
}

// The wiring of the PX4FMU v1; parts without the spread of real ones.
TEST(DriverImages, StorageStyle) {
  const std::string folder = testing::TempDir() + "storage_style." + std::to_string(getpid());
  std::filesystem::create_directories(folder);
  ImageRun run = run_image(
      {"storage_style",
       R"(,{"name":"card","type":"sd_card","bus":"spi3","cs":"PA4","size":268435456})"
       R"(,{"name":"params","type":"eeprom_24xx","bus":"i2c2","address":80})"
       R"(,{"name":"imu","type":"mpu6000","bus":"spi1","cs":"PB0"})"
       R"(,{"name":"battery","type":"battery_sense","bus":"PC0","params.tolerance":0,"params.noise":0})",
       kF405, folder},
      2000);
  ASSERT_EQ(run.error, "") << run.findings;
  EXPECT_EQ(run.faults, 0) << run.findings;
  Report& got = run.report;
  EXPECT_EQ(got["cmd0"], Values{1});
  EXPECT_EQ(got["cmd8"], Values{1});
  EXPECT_EQ(got["echo"], Values{0x1AA});
  EXPECT_EQ(got["acmd41"], Values{0});
  EXPECT_EQ(got["waited"], Values{1});
  EXPECT_EQ(got["ocr"], Values{0xC0FF8000});
  EXPECT_EQ(got["csd_token"], Values{0xFE});
  EXPECT_EQ(got["mebibytes"], Values{256});
  EXPECT_EQ(got["cmd25"], Values{0});
  EXPECT_EQ(got["accepted"], Values{4});
  EXPECT_EQ(got["right_bytes"], Values{4 * 512});
  expect_between(0, got["blank_bytes"], 8);  // zeros: the pattern has few
  EXPECT_EQ(got["ee_found"], Values{1});
  expect_between(4900, got["ee_cycle_us"], 5100);  // from the STOP on
  EXPECT_EQ(got["ee_refused"], Values{1});
  EXPECT_EQ(got["ee_first"], Values{0x40});
  EXPECT_EQ(got["ee_last"], Values{0x5F});
  EXPECT_EQ(got["ee_beyond"], Values{0xFF});
  expect_between(9 * 6, got["fifo_bytes"], 11 * 6);  // 10.2 ms at 1 kHz
  EXPECT_EQ(got["fifo_samples_near_g"], Values{got["fifo_bytes"].at(0) / 6});
  EXPECT_EQ(got["fifo_rest"], Values{1});
  // 16.4 V (nothing was told) by 10 / 57 of 3.3 V.
  expect_between(3570, got["battery"], 3572);
  EXPECT_EQ(run.findings, "");
  // What the parts held is left behind: block 5001's pattern, the page.
  const std::string card = bytes_at(folder + "/card.img", 5001 * 512, 2);
  EXPECT_EQ(card, std::string({static_cast<char>(5001 * 31 & 0xFF),
                               static_cast<char>((5001 * 31 + 7) & 0xFF)}));
  EXPECT_EQ(bytes_at(folder + "/params.img", 0x0120, 3), "\x40\x41\x42");
  std::filesystem::remove_all(folder);
}

TEST(DriverImages, EscStyleOnTheF103) {
  ImageRun run = run_image({"esc_style",
                            R"(,{"name":"v1","type":"volts","bus":"PA1","params.volts":0.55})"
                            R"(,{"name":"v2","type":"volts","bus":"PA2","params.volts":1.1})"
                            R"(,{"name":"v3","type":"volts","bus":"PA3","params.volts":1.65})"
                            R"(,{"name":"v4","type":"volts","bus":"PA4","params.volts":2.2})"
                            R"(,{"name":"a","type":"jumper","cs":"PB6","int":"PA8"})"
                            R"(,{"name":"b","type":"jumper","cs":"PB12","int":"PB13"})",
                            kF103},
                           1000);
  ASSERT_EQ(run.error, "") << run.findings;
  EXPECT_EQ(run.faults, 2);  // its two reads beyond the memories
  Report& got = run.report;
  EXPECT_EQ(got["bit_band_set"], Values{1});
  EXPECT_EQ(got["bit_band_read"], Values{1});
  EXPECT_EQ(got["bit_band_clear"], Values{0});
  EXPECT_EQ(got["pwm_period"], Values{3600});  // 20 kHz of 72 MHz
  EXPECT_EQ(got["pwm_high"], Values{900});
  EXPECT_EQ(got["forced_low"], Values{0});
  EXPECT_EQ(got["forced_high"], Values{1});
  EXPECT_EQ(got["calibration_right"], Values{1});
  // Ten buffers of 32 conversions of 41 clocks of 12 MHz: 78720 cycles of 72 MHz.
  expect_between(786, got["ten_buffers_cycles"], 788);
  EXPECT_EQ(got["half_before_full"], Values{1});
  EXPECT_EQ(got["adc1_first"], Values{683});    // 1/6 of 4096, rounded
  EXPECT_EQ(got["adc2_first"], Values{1365});   // 1/3
  EXPECT_EQ(got["adc1_second"], Values{2048});  // 1/2
  EXPECT_EQ(got["adc2_second"], Values{2731});  // 2/3
  EXPECT_EQ(got["injected"], Values{10});       // every 100 us
  EXPECT_EQ(got["injected_mean"], Values{683});
  EXPECT_EQ(got["injected_partner"], Values{1365});
  EXPECT_EQ(got["exti_prompt"], Values{1});
  EXPECT_EQ(got["exti_edges"], Values{2});
  EXPECT_EQ(got["flash_erased"], Values{1});
  EXPECT_EQ(got["flash_word"], Values{0x56781234});
  EXPECT_EQ(got["inside_flash"], Values{0});
  EXPECT_EQ(got["beyond_flash"], Values{1});
  EXPECT_EQ(got["inside_sram"], Values{0});
  EXPECT_EQ(got["beyond_sram"], Values{1});
  EXPECT_EQ(got["backup"], Values{0x5AA5});
  EXPECT_EQ(got["flash_KiB"], Values{128});
  EXPECT_EQ(got["device_id"], Values{0x410});
  EXPECT_EQ(got["can_init"], Values{1});
}

}  // namespace
}  // namespace whirl::board_test
