// The drivers against the parts of the virtual board, which share no header with them.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "base/near.hpp"
#include "firmware/drivers/cppm_receiver.hpp"
#include "firmware/drivers/sbus_receiver.hpp"
#include "firmware/drivers/ublox_gps.hpp"
#include "io_bridges/devices/cppm.hpp"
#include "io_bridges/devices/sbus.hpp"
#include "io_bridges/devices/uart_sampling.hpp"
#include "io_bridges/devices/ublox.hpp"

namespace fw {
namespace {

using Bytes = std::vector<std::uint8_t>;
using whirl::io::EventQueue, whirl::io::FaultBook, whirl::io::Nanoseconds;

std::uint32_t us_of(Nanoseconds ns) {
  return static_cast<std::uint32_t>(ns / 1000);
}

// The MCU's UART: sends and reads at its own rate, 8N1.
struct Uart {
  explicit Uart(EventQueue& events) : queue(events) {}
  void join(whirl::io::UartPeer& far) {
    to_far = [this, &far](const whirl::io::UartByte& byte, const whirl::io::UartFormat& format) {
      far.receive(byte, format, queue.now());
    };
  }
  void set_baud(std::uint32_t wanted) { baud = wanted; }
  Status send(std::span<const std::uint8_t> bytes) {
    if (out && out->waiting() > 0) return Status::busy;
    out = std::make_unique<whirl::io::UartTransmitter>(
        queue, whirl::io::UartFormat{.baud = static_cast<double>(baud)}, to_far);
    out->add(bytes);
    return Status::ok;
  }
  EventQueue& queue;
  whirl::io::UartPeer::Sink to_far;
  std::unique_ptr<whirl::io::UartTransmitter> out;
  std::uint32_t baud = 0;
};

struct GpsLoop {
  explicit GpsLoop(std::uint32_t saved_baud, whirl::io::UbloxModel model) {
    whirl::io::Ublox::Params params;
    params.model = model;
    params.baud = saved_baud;
    params.first_fix_ns = 4'000'000'000;
    params.bus = 6;
    part = std::make_unique<whirl::io::Ublox>(
        queue, params,
        [](const whirl::io::Ublox::Query&) {
          return whirl::io::GnssFix{
              .place = {0.5, -1.0, 250.0}, .v_NED_mps = {3.0, -4.0, 0.5}, .level_accuracy_m = 3.0};
        },
        &book, nullptr);
    uart.join(*part);
    part->join([this](const whirl::io::UartByte& byte, const whirl::io::UartFormat& format) {
      const auto sample = whirl::io::sample_uart(byte, format, 8, uart.baud);
      if (sample.stop_missing) return;
      gps.push(static_cast<std::uint8_t>(sample.bits), us_of(queue.now()));
      parser.add(static_cast<std::uint8_t>(sample.bits));
    });
  }
  void run_s(double s) {
    const Nanoseconds end = queue.now() + static_cast<Nanoseconds>(s * 1e9);
    for (; queue.now() < end; queue.run_until(queue.now() + 5'000'000)) {
      gps.tick(us_of(queue.now()));
      GpsFix fix;
      if (gps.take(fix)) fixes.push_back(fix);
    }
  }
  EventQueue queue;
  FaultBook book;
  Uart uart{queue};
  UbloxGps<Uart> gps{uart};
  std::unique_ptr<whirl::io::Ublox> part;
  std::vector<GpsFix> fixes;
  std::function<void(const whirl::io::UbxFrame&)> spy;  // on what the part sends
  whirl::io::UbxParser parser{[this](const whirl::io::UbxFrame& frame) {
    if (spy) spy(frame);
  }};
};

TEST(GpsLoop, FromAnySavedRateFixesComeFiveTimesASecond) {
  using whirl::io::UbloxModel;
  for (const UbloxModel model : {UbloxModel::six, UbloxModel::m8}) {
    for (const std::uint32_t baud : {4800u, 9600u, 19200u, 38400u, 57600u, 115200u}) {
      GpsLoop loop(baud, model);
      loop.run_s(12.0);
      ASSERT_TRUE(loop.gps.running()) << baud;
      EXPECT_EQ(loop.gps.refused(), 0u);
      loop.fixes.clear();
      loop.run_s(2.0);
      ASSERT_EQ(loop.fixes.size(), 10u) << baud;
      const GpsFix& fix = loop.fixes.back();
      EXPECT_TRUE(fix.usable());
      EXPECT_EQ(fix.latitude_e7_deg, 286478898);  // half a radian
      EXPECT_EQ(fix.v_east_mmps, -4000);
      EXPECT_EQ(loop.gps.takes_pvt(), model == UbloxModel::m8);
      EXPECT_EQ(fix.itow_ms - loop.fixes.front().itow_ms, 1800u);
    }
  }
}

TEST(GpsLoop, AReceiverThatForgotItsSettingsIsSetUpAgain) {
  GpsLoop loop(9600, whirl::io::UbloxModel::six);
  loop.run_s(10.0);
  ASSERT_TRUE(loop.gps.running());
  const std::uint8_t reset[] = {0xB5, 0x62, 0x06, 0x04, 0x04, 0x00,
                                0x00, 0x00, 0x00, 0x00, 0x0E, 0x64};
  for (const std::uint8_t byte : reset) {
    loop.part->receive({.value = byte}, {.baud = 57600.0}, loop.queue.now());
  }
  EXPECT_EQ(loop.part->baud(), 9600.0);
  const std::uint32_t searches = loop.gps.searches();
  loop.run_s(1.7);
  EXPECT_EQ(loop.gps.searches(), searches);  // no solution for 2 s
  loop.run_s(3.0);
  EXPECT_EQ(loop.gps.searches(), searches + 1);
  EXPECT_EQ(loop.part->baud(), 57600.0);
  EXPECT_TRUE(loop.gps.running());
  EXPECT_TRUE(loop.fixes.back().usable());
}

// It goes on at 1 Hz with the model of a hand-held one: seen by what is polled, not by silence. A poll is every 2 s, five
// of a 6's settings and three of an M8's, and two polls later they are told again.
TEST(GpsLoop, AReceiverThatForgetsRateAndModelIsToldThemAgainWithoutASearch) {
  using whirl::io::UbloxModel;
  for (const UbloxModel model : {UbloxModel::six, UbloxModel::m8}) {
    GpsLoop loop(57600, model);
    Bytes nav5;
    loop.spy = [&](const whirl::io::UbxFrame& frame) {
      if (frame.message_class == 0x06 && frame.id == 0x24) nav5 = frame.payload;
    };
    loop.run_s(20.0);
    ASSERT_TRUE(loop.gps.running());
    EXPECT_EQ(loop.gps.restored(), 0u);
    ASSERT_EQ(nav5.size(), 36u);  // it was polled
    EXPECT_EQ(nav5[2], 6);
    loop.book.add({.number = 1,
                   .kind = whirl::io::FaultKind::gnss_forgets,
                   .start_ns = loop.queue.now() + 1,
                   .bus = 6});
    loop.fixes.clear();
    loop.run_s(14.0);
    EXPECT_LE(loop.fixes.size(), 66u);  // of 70: for a second at least they came at 1 Hz
    EXPECT_EQ(loop.gps.restored(), 1u);
    EXPECT_EQ(loop.gps.searches(), 0u);
    loop.fixes.clear();
    nav5.clear();
    loop.run_s(11.0);
    EXPECT_EQ(loop.fixes.size(), 55u);
    ASSERT_EQ(nav5.size(), 36u);
    EXPECT_EQ(nav5[2], 6);
    EXPECT_EQ(nav5[3], 2);
    EXPECT_EQ(loop.gps.restored(), 1u);
  }
}

TEST(CppmLoop, SticksBecomePulseWidthsAndALostLinkIsSeen) {
  EventQueue queue;
  FaultBook book;
  whirl::io::Wire wire("PA10", false);
  whirl::io::CppmReceiver::Params params;
  params.link.failsafe = whirl::io::Failsafe::stop;
  whirl::io::CppmReceiver part(queue, wire, params, &book);
  CppmReceiver driver;
  wire.watch([&driver](bool level, Nanoseconds now) {
    if (level) driver.edge(us_of(now));
  });
  whirl::io::StickPositions sticks{-1.0, 0.5, 1.0};
  const auto run = [&](int ms, bool on) {
    for (int k = 0; k < ms; k += 20, queue.run_until(queue.now() + 20'000'000)) {
      if (on) part.on_sticks(sticks);
    }
  };
  run(1000, true);
  ASSERT_EQ(driver.status(us_of(queue.now())), Status::ok);
  const int want_us[] = {1000, 1750, 2000, 1500, 1500, 1500, 1500, 1500};
  EXPECT_EQ(driver.frame().count, 8);
  for (unsigned i = 0; i < 8; ++i) {
    EXPECT_TRUE(whirl::near(driver.frame().channels_us[i], want_us[i],
                            whirl::stated(21, "jitter of 10 us at both edges, and a count")))
        << i;  // two edges of 10 us of jitter
  }
  EXPECT_EQ(driver.bad_intervals(), 0u);
  run(1000, false);
  EXPECT_EQ(driver.status(us_of(queue.now())), Status::no_answer);
}

TEST(SbusLoop, SticksBecomeCountsAndFailsafeIsSeen) {
  EventQueue queue;
  FaultBook book;
  whirl::io::SbusReceiver part(queue, {.inverter = true}, &book);
  SbusReceiver driver;
  part.join([&](const whirl::io::UartByte& byte, const whirl::io::UartFormat& format) {
    const auto sample = whirl::io::sample_uart(byte, format, 9, 100000.0);
    const bool error = sample.stop_missing || whirl::io::odd_number_of_ones(sample.bits);
    driver.push(static_cast<std::uint8_t>(sample.bits), us_of(queue.now()), error);
  });
  for (int k = 0; k < 50; ++k, queue.run_until(queue.now() + 20'000'000)) {
    part.on_sticks({-1.0, 0.0, 1.0});
  }
  ASSERT_EQ(driver.status(us_of(queue.now())), Status::ok);
  EXPECT_EQ(driver.frame().channels[0], 172);
  EXPECT_EQ(driver.frame().channels[2], 1811);
  EXPECT_FALSE(driver.frame().failsafe);
  EXPECT_EQ(driver.bad_frames(), 0u);
  queue.run_until(queue.now() + 1'000'000'000);
  EXPECT_TRUE(driver.frame().failsafe);
}

}  // namespace
}  // namespace fw
