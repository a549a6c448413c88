// What the pod puts out for a GPS and a receiver, read by the flight image's own parsers, character by character and
// edge by edge with their times; and its link over CAN. The host, and the GPS that it plays, is the device pod_host.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <sstream>

#include "base/near.hpp"
#include "firmware/drivers/cppm_receiver.hpp"
#include "firmware/drivers/sbus_receiver.hpp"
#include "firmware/drivers/ublox_gps.hpp"
#include "harness/target/virtual_board.hpp"
#include "io_bridges/board_description/board_text.hpp"
#include "io_bridges/protocols/esc_codec.hpp"

namespace whirl::board_test {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::uint32_t kSetpointType = 20112;
constexpr std::uint16_t kAsk = 1, kSbus = 2, kGps = 6;

std::uint32_t us(std::int64_t ns) {
  return static_cast<std::uint32_t>(ns / 1000);
}

struct Outputs {
  // Hands each character and rising edge to whoever reads them.
  std::function<void(std::uint8_t byte, std::int64_t t_ns)> sbus, gps;
  std::function<void(std::int64_t t_ns)> edge;
  std::function<void(std::int64_t now_ns)> each_ms;
  std::vector<std::uint8_t> to_gps;  // the flight controller says it in the next millisecond
};

struct OutputRun {
  std::map<std::string, std::int64_t> figures;
  std::int64_t can_busy_ns = 0, can_frames = 0, can_errors = 0;
  std::int64_t told_ns = -1, heard_ns = -1;  // the set-point: STOP on I2C, end of its frame on CAN
  std::string findings, error;
};

const char* const kFigures[] = {"sbus_frames",
                                "sbus_wrong",
                                "sbus_period_least_ns",
                                "sbus_period_most_ns",
                                "gps_bytes",
                                "gps_wrong",
                                "sbus_character_least_ns",
                                "sbus_character_most_ns",
                                "cppm_frames",
                                "cppm_wrong",
                                "cppm_off_ns",
                                "cppm_pulse_least_ns",
                                "gps_missing",
                                "cppm_frame_most_ns",
                                "cppm_frame_least_ns",
                                "gps_off_rate",
                                "gps_delay_most_ns",
                                "samples",
                                "setpoints",
                                "setpoint_esc",
                                "setpoint_value",
                                "pod_lost",
                                "pod_late",
                                "pod_damaged",
                                "pod_unsent",
                                "pod_gps_dropped",
                                "pod_turn_us",
                                "pod_now_us"};

void keep(const io::Reader& message, OutputRun& run, Outputs& out, std::string& text) {
  const io::Header& head = message.header();
  const auto payload = message.payload();
  if (head.kind == io::Kind::finding)
    run.findings += std::string(payload.begin(), payload.end()) + "\n";
  if (head.kind == io::Kind::cpu_fault) run.error += "the core faulted\n";
  if (head.kind == io::Kind::pin_edge && message.as<io::PinEdge>().level != 0 && out.edge) {
    out.edge(head.t_ns);
  }
  if (head.kind == io::Kind::can_transfer) {
    const auto t = message.as<io::CanRecord>();
    run.can_busy_ns += t.busy_ns;
    ++run.can_frames;
    run.can_errors += t.error != 0 ? 1 : 0;
    if ((t.frame.id >> 8 & 0xFFFF) == kSetpointType) run.heard_ns = head.t_ns;
  }
  if (head.kind == io::Kind::i2c_reply) run.told_ns = head.t_ns;
  if (head.kind != io::Kind::uart_received) return;
  if (head.port == kAsk) text.append(payload.begin(), payload.end());
  for (const std::uint8_t byte : payload) {
    if (head.port == kSbus && out.sbus) out.sbus(byte, head.t_ns);
    if (head.port == kGps && out.gps) out.gps(byte, head.t_ns);
  }
}

OutputRun run_outputs(Outputs& out, const std::string& params, int milliseconds) {
  VirtualBoardOptions options;
  const auto start = read_board_text(
      R"({"board":"pod","mcu":"stm32f405rg","hse_Hz":8000000,"image":")" +
      std::string(WHIRL_FIRMWARE) +
      R"(/pod.elf","pins":[{"name":"cppm","pin":"PB6"}],"devices":[{"name":"host","type":"pod_host","cppm":"PB6")" +
      params + R"(},{"name":"flight","type":"i2c_master","bus":"i2c2"}]})");
  OutputRun run;
  if (!start) {
    run.error = start.error().message();
    return run;
  }
  options.board = start.value();
  VirtualBoard board(options);
  if (const auto started = board.start(); !started) {
    run.error = started.error().message();
    return run;
  }
  std::string text;
  io::Batch happened;
  for (int k = 1; k <= milliseconds; ++k) {
    io::Batch sensed;
    if (out.each_ms) out.each_ms((k - 1) * kMs);
    if (!out.to_gps.empty()) {
      sensed.add(io::Kind::uart_frame, kGps, (k - 1) * kMs, out.to_gps.data(),
                 static_cast<std::uint32_t>(out.to_gps.size()));
      out.to_gps.clear();
    }
    if (k == 150) {  // the flight controller commands its second ESC
      const auto bytes = io::pack_setpoint(0x2A, 1234);
      io::I2cOrder order;
      order.address = 0x2A;
      sensed.add(io::Kind::i2c_order, 2, (k - 1) * kMs + 300'000, order, bytes.data(),
                 static_cast<std::uint32_t>(bytes.size()));
    }
    if (k == milliseconds - 1) {
      for (const std::string name : kFigures) {
        sensed.add(io::Kind::uart_frame, kAsk, (k - 1) * kMs, name.data(),
                   static_cast<std::uint32_t>(name.size()));
      }
    }
    board.run(k * kMs, sensed);
    const auto state = board.arrive(happened);
    for (io::Reader r(happened.bytes()); r.next();) keep(r, run, out, text);
    if (!state) run.error += state.error().message();
    if (!state || state.value() != TargetState::running) break;
  }
  board.stop(happened);
  std::istringstream lines(text);
  std::string name;
  for (std::int64_t value = 0; lines >> name >> value;) run.figures[name] = value;
  for (const auto& [known, value] : run.figures) {
    std::printf("%s %lld\n", known.c_str(), static_cast<long long>(value));
  }
  return run;
}

// Nothing of the link or the lines went wrong.
void expect_clean(OutputRun& run) {
  ASSERT_EQ(run.error, "");
  EXPECT_EQ(run.findings, "");
  for (const char* name : {"sbus_wrong", "cppm_wrong", "gps_wrong", "gps_off_rate", "pod_lost",
                           "pod_late", "pod_damaged", "pod_unsent", "pod_gps_dropped"}) {
    ASSERT_EQ(run.figures.count(name), 1u) << name;
    EXPECT_EQ(run.figures[name], 0) << name;
  }
}

// ---- The receiver

struct Radio {
  fw::SbusReceiver sbus;
  fw::CppmReceiver cppm;
  int sbus_frames = 0, cppm_frames = 0, lost = 0, failsafe = 0;
  std::int64_t sbus_last_ns = -1, cppm_last_ns = -1, first_lost_ns = -1, first_failsafe_ns = -1;

  void listen(Outputs& out) {
    out.sbus = [this](std::uint8_t byte, std::int64_t t_ns) {
      if (!sbus.push(byte, us(t_ns))) return;
      ++sbus_frames;
      sbus_last_ns = t_ns;
      if (sbus.frame().frame_lost && ++lost == 1) first_lost_ns = t_ns;
      if (sbus.frame().failsafe && ++failsafe == 1) first_failsafe_ns = t_ns;
    };
    out.edge = [this](std::int64_t t_ns) {
      if (!cppm.edge(us(t_ns))) return;
      ++cppm_frames;
      cppm_last_ns = t_ns;
    };
  }
};

TEST(PodOutputs, TheFlightImagesReceiversReadWhatTheHostTold) {
  Outputs out;
  Radio radio;
  radio.listen(out);
  OutputRun run = run_outputs(out, "", 1000);
  expect_clean(run);
  EXPECT_GE(radio.sbus_frames, 56);  // of 800 ms by 14
  EXPECT_EQ(radio.sbus.bad_frames(), 0u);
  EXPECT_EQ(radio.lost + radio.failsafe, 0);
  EXPECT_GE(radio.cppm_frames, 36);  // of 980 ms by 22.5; the first four lock the decoder
  EXPECT_EQ(radio.cppm.bad_intervals(), 0u);
  EXPECT_EQ(radio.cppm.frame().count, 8);
  // 12 bits a character; the period is kept by the main loop.
  EXPECT_EQ(run.figures["sbus_character_least_ns"], 120'000);
  EXPECT_EQ(run.figures["sbus_character_most_ns"], 120'000);
  EXPECT_GT(run.figures["sbus_period_least_ns"], 14 * kMs - 100'000);
  EXPECT_LT(run.figures["sbus_period_most_ns"], 14 * kMs + 100'000);
  // A timer makes the edges: nothing but the rounding of its clock, which divides evenly.
  EXPECT_LE(run.figures["cppm_off_ns"], 1);
  const auto rounding = stated(1, "ns, of the clock's edges");
  EXPECT_TRUE(near(run.figures["cppm_pulse_least_ns"], 300'000, rounding));
  EXPECT_TRUE(near(run.figures["cppm_frame_most_ns"], 22'500'000, rounding));
}

// As a receiver does that hears its transmitter no more (radio_link.hpp): lost after 60 ms, failsafe after 500.
TEST(PodOutputs, ASilentHostIsFrameLostThenFailsafeAndNoPulses) {
  Outputs out;
  Radio radio;
  radio.listen(out);
  constexpr std::int64_t kSilent_ns = 400 * kMs, kPeriod_ns = 14 * kMs;
  OutputRun run = run_outputs(out, R"(,"params.silent":0.4)", 1200);
  ASSERT_EQ(run.error, "");
  EXPECT_GT(radio.first_lost_ns, kSilent_ns + 60 * kMs - kPeriod_ns);
  EXPECT_LT(radio.first_lost_ns, kSilent_ns + 60 * kMs + 2 * kPeriod_ns);
  EXPECT_GT(radio.first_failsafe_ns, kSilent_ns + 500 * kMs - kPeriod_ns);
  EXPECT_LT(radio.first_failsafe_ns, kSilent_ns + 500 * kMs + 2 * kPeriod_ns);
  EXPECT_GT(radio.sbus_last_ns, 1180 * kMs);
  EXPECT_GT(radio.cppm_last_ns, kSilent_ns + 500 * kMs - 50 * kMs);
  EXPECT_LT(radio.cppm_last_ns, kSilent_ns + 500 * kMs + 50 * kMs);
  EXPECT_EQ(radio.cppm.status(us(1200 * kMs)), fw::Status::no_answer);
}

// ---- GPS

// The UART of the flight controller: what it sends goes to the pod's line, at that line's rate, which changes with the
// GPS; what it would send at another rate does not arrive.
struct FlightUart {
  std::vector<std::uint8_t>* out = nullptr;
  std::uint32_t line_baud = 0, baud = 0;
  bool told = false;
  void set_baud(std::uint32_t to) {
    if (told && to == 57600) line_baud = to;
    baud = to;
  }
  fw::Status send(std::span<const std::uint8_t> bytes) {
    if (baud != line_baud) return fw::Status::ok;
    out->insert(out->end(), bytes.begin(), bytes.end());
    told = true;
    return fw::Status::ok;
  }
};

struct GpsClient {
  FlightUart uart;
  fw::UbloxGps<FlightUart> driver{uart};
  std::vector<fw::GpsFix> fixes;
  std::int64_t running_ns = -1;

  void join(Outputs& out, std::uint32_t line_baud) {
    uart.out = &out.to_gps;
    uart.line_baud = line_baud;
    out.gps = [this](std::uint8_t byte, std::int64_t t_ns) { driver.push(byte, us(t_ns)); };
    out.each_ms = [this](std::int64_t now_ns) {
      driver.tick(us(now_ns));
      if (driver.running() && running_ns < 0) running_ns = now_ns;
      fw::GpsFix fix;
      if (driver.take(fix)) fixes.push_back(fix);
    };
  }
};

void expect_fixes(const GpsClient& gps) {
  EXPECT_GT(gps.running_ns, 0);
  EXPECT_EQ(gps.driver.refused(), 0u);
  EXPECT_EQ(gps.driver.bad_frames(), 0u);
  ASSERT_GE(gps.fixes.size(), 3u);
  for (std::size_t i = 1; i < gps.fixes.size(); ++i) {
    const auto apart_us = static_cast<std::int64_t>(gps.fixes[i].received_us) -
                          static_cast<std::int64_t>(gps.fixes[i - 1].received_us);
    EXPECT_TRUE(near(apart_us, 200'000, stated(1'999, "us: the host's millisecond, and one more")))
        << i;
  }
  const fw::GpsFix& fix = gps.fixes.back();
  EXPECT_TRUE(fix.usable());
  EXPECT_EQ(fix.latitude_e7_deg, 473'977'000);
  EXPECT_EQ(fix.longitude_e7_deg, 85'456'000);
  EXPECT_EQ(fix.height_mm, 488'000);
  EXPECT_EQ(fix.v_north_mmps, 1250);
  EXPECT_EQ(fix.v_east_mmps, -500);
  EXPECT_EQ(fix.v_down_mmps, 250);
}

TEST(PodOutputs, TheFlightImagesDriverSetsUpTheGpsAndReadsItsSolutions) {
  Outputs out;
  GpsClient gps;
  gps.join(out, 57600);
  OutputRun run = run_outputs(out, R"(,"baud":57600)", 2600);
  expect_clean(run);
  expect_fixes(gps);
  // A piece of 44 bytes is gathered for 7.6 ms at that rate, waits for the host's millisecond, and passes in 7.6.
  EXPECT_LT(run.figures["gps_delay_most_ns"], 20 * kMs);
}

// As it is delivered: at 9600 the driver finds it, and tells it 57600; from then on the pod's line has that rate.
TEST(PodOutputs, TheLineChangesItsRateWithTheGps) {
  Outputs out;
  GpsClient gps;
  gps.join(out, 9600);
  OutputRun run = run_outputs(out, R"(,"baud":9600)", 3200);
  expect_clean(run);
  expect_fixes(gps);
}

// ---- The link over CAN

void print_load(const OutputRun& run, double seconds) {
  std::printf("load %.1f %%, %lld frames\n",
              100e-9 * static_cast<double>(run.can_busy_ns) / seconds,
              static_cast<long long>(run.can_frames));
}

void expect_linked_by_can(const std::string& sample, double least_load, double most_load) {
  Outputs out;
  Radio radio;
  radio.listen(out);
  GpsClient gps;
  gps.join(out, 57600);
  OutputRun run =
      run_outputs(out, R"(,"baud":57600,"params.can":2,"params.sample":")" + sample + "\"", 2600);
  expect_clean(run);
  expect_fixes(gps);
  EXPECT_EQ(run.figures["setpoints"], 1);
  EXPECT_EQ(run.figures["setpoint_esc"], 1);
  EXPECT_EQ(run.figures["setpoint_value"], 1234);
  // A turn of the main loop, one frame that is on the wire, its own: nothing else goes before it.
  std::printf("set-point after %lld ns\n", static_cast<long long>(run.heard_ns - run.told_ns));
  EXPECT_GT(run.heard_ns, run.told_ns);
  EXPECT_LT(run.heard_ns - run.told_ns, 100'000 + 160'000 + 160'000);
  EXPECT_GE(radio.sbus_frames, 170);
  EXPECT_GE(radio.cppm_frames, 105);
  EXPECT_EQ(run.can_errors, 0);
  print_load(run, 2.58);
  const double load = static_cast<double>(run.can_busy_ns) / 2.58e9;
  EXPECT_GT(load, least_load);
  EXPECT_LT(load, most_load);
}

// By bits: 1000 samples of three frames (8, 8 and 6 or 4 bytes) or two, without and with every stuff bit; beside them
// 71 SBUS, 44 CPPM and some 30 GPS frames and the pod's own.
TEST(PodOutputs, OverCanWithExactSamplesOfThreeFrames) {
  expect_linked_by_can("counts", 0.37, 0.60);
}
TEST(PodOutputs, OverCanWithTheImusMessageOfThreeFrames) {
  expect_linked_by_can("imu16", 0.35, 0.57);
}
TEST(PodOutputs, OverCanWithTheImusMessageOfTwoFrames) {
  expect_linked_by_can("imu14", 0.26, 0.46);
}

}  // namespace
}  // namespace whirl::board_test
