// A GPS receiver on a serial line that the test plays the flight controller's end of: a pseudo-terminal, which carries bytes
// whole and tells to what rate the line is set.
#include "harness/target/bench/gps_line.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "io_bridges/rack/devices/table.hpp"
#include "io_bridges/serial/pseudo_terminal.hpp"

namespace whirl::bench {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::int64_t kMs = 1'000'000, kTurn_ns = kMs / 4;

// As the receiver's protocol has it: two sums over what is between the marks and them.
Bytes ubx(std::uint8_t message_class, std::uint8_t id, const Bytes& payload) {
  Bytes frame{0xB5, 0x62, message_class, id, static_cast<std::uint8_t>(payload.size()), 0};
  for (const std::uint8_t byte : payload) frame.push_back(byte);
  std::uint8_t a = 0, b = 0;
  for (std::size_t i = 2; i < frame.size(); ++i) {
    a = static_cast<std::uint8_t>(a + frame[i]);
    b = static_cast<std::uint8_t>(b + a);
  }
  frame.push_back(a);
  frame.push_back(b);
  return frame;
}

// UART1, 8N1, 57600 baud, UBX alone.
const Bytes kPort =
    ubx(0x06, 0x00, {1, 0, 0, 0, 0xD0, 0x08, 0, 0, 0x00, 0xE1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0});
const Bytes kPort_acknowledged = ubx(0x05, 0x01, {0x06, 0x00});
const Bytes kAsk_rate = ubx(0x06, 0x08, {}), kRate_acknowledged = ubx(0x05, 0x01, {0x06, 0x08});
const Bytes kTenth = ubx(0x06, 0x08, {100, 0, 1, 0, 1, 0}),
            kRate_refused = ubx(0x05, 0x00, {0x06, 0x08});

struct Rig {
  explicit Rig(const char* type = "ublox_6") {
    BoardDescription board;
    board.name = "flying";
    board.devices.push_back({.name = "gps", .type = type, .bus = "usart6"});
    board.devices.back().set("params.first_fix", 1.0);
    link.emplace(LinePartOptions{{"gps", far->path(), 6}, board, rack::device_types()});
    link->keep_time(
        {[](std::int64_t host_ns) { return host_ns; }, [](std::int64_t t_ns) { return t_ns; }});
  }
  void turn() {
    now_ns += kTurn_ns;
    ASSERT_TRUE(link->serve(now_ns, arrivals).ok());
    Bytes piece(4096);
    piece.resize(far->read(piece));
    if (!piece.empty()) heard_ns = now_ns;
    heard.insert(heard.end(), piece.begin(), piece.end());
  }
  void serve_for(std::int64_t ns) {
    for (const std::int64_t end_ns = now_ns + ns; now_ns < end_ns;) turn();
  }
  // False: not within a second.
  bool serve_until(const std::function<bool()>& done) {
    for (int i = 0; i < 4000 && !done(); ++i) turn();
    return done();
  }
  bool heard_that(const Bytes& frame) const {
    return std::search(heard.begin(), heard.end(), frame.begin(), frame.end()) != heard.end();
  }
  void set_port() {
    serve_for(400 * kMs);  // deaf at first
    far->write(kPort);
    ASSERT_TRUE(serve_until([&] { return far->baud() == 57600.0; }));
  }
  void spoil(io::FaultKind kind) {
    io::FaultCommand fault;
    fault.number = 1;
    fault.kind = static_cast<std::uint32_t>(kind);
    fault.start_ns = now_ns;
    fault.end_ns = now_ns + 3000 * kMs;
    fault.bus = 6;
    io::Batch batch;
    batch.add(io::Kind::fault, 1, now_ns, fault);
    io::Reader order(batch.bytes());
    ASSERT_TRUE(order.next());
    EXPECT_FALSE(link->take(order, 0));
  }

  std::int64_t now_ns = 0, heard_ns = 0;
  std::optional<io::PseudoTerminal> far = std::move(io::PseudoTerminal::open().value());
  std::optional<GpsLine> link;
  Arrivals arrivals;
  Bytes heard;
};

TEST(GpsLine, SpeaksAtTheReceiversRateUntilItIsToldAnother) {
  Rig rig;
  ASSERT_TRUE(rig.link->open().ok());
  EXPECT_EQ(rig.far->baud(), 9600.0);
  rig.serve_for(1200 * kMs);
  EXPECT_TRUE(rig.heard_that({'$', 'G', 'P', 'G', 'G', 'A'}));
  rig.far->write(kPort);
  ASSERT_TRUE(rig.serve_until([&] { return rig.heard_that(kPort_acknowledged); }));
  EXPECT_EQ(rig.far->baud(), 9600.0);  // it acknowledges at the old one
  ASSERT_TRUE(rig.serve_until([&] { return rig.far->baud() != 9600.0; }));
  EXPECT_EQ(rig.far->baud(), 57600.0);
  // The last character is over on copper 1.04 ms after it has left, and 5 ms later an adapter is empty.
  EXPECT_GE(rig.now_ns - rig.heard_ns, 6'000'000);
  EXPECT_LE(rig.now_ns - rig.heard_ns, 6'600'000);
}

TEST(GpsLine, WhatIsSaidWhileTheTwoRatesDifferIsNotUnderstood) {
  Rig rig;
  ASSERT_TRUE(rig.link->open().ok());
  rig.serve_for(400 * kMs);
  rig.far->write(kPort);
  ASSERT_TRUE(rig.serve_until([&] { return rig.heard_that(kPort_acknowledged); }));
  rig.far->write(kAsk_rate);  // the receiver is at 57600 baud, the line not yet
  ASSERT_TRUE(rig.serve_until([&] { return rig.far->baud() == 57600.0; }));
  rig.serve_for(100 * kMs);
  EXPECT_FALSE(rig.heard_that(kRate_acknowledged));
  rig.far->write(kAsk_rate);
  rig.serve_for(100 * kMs);
  EXPECT_TRUE(rig.heard_that(kRate_acknowledged));
}

// The host is late by half a second: the acknowledge at the old rate and a solution at the new one are due in one turn.
TEST(GpsLine, ALateTurnKeepsTheTwoRatesApart) {
  Rig rig;
  ASSERT_TRUE(rig.link->open().ok());
  rig.serve_for(400 * kMs);
  rig.far->write(ubx(0x06, 0x08, {200, 0, 1, 0, 1, 0}));  // five solutions a second
  rig.serve_for(100 * kMs);
  rig.far->write(ubx(0x06, 0x01, {0x01, 0x06, 1}));  // NAV-SOL with each
  rig.serve_for(100 * kMs);
  rig.far->write(kPort);
  rig.turn();
  rig.now_ns += 500 * kMs;
  rig.turn();
  ASSERT_TRUE(rig.heard_that(kPort_acknowledged));
  EXPECT_TRUE(
      std::equal(kPort_acknowledged.rbegin(), kPort_acknowledged.rend(), rig.heard.rbegin()));
  rig.heard.clear();
  ASSERT_TRUE(rig.serve_until([&] { return rig.far->baud() == 57600.0; }));
  rig.serve_for(10 * kMs);
  EXPECT_TRUE(rig.heard_that({0xB5, 0x62, 0x01, 0x06}));
}

TEST(GpsLine, ALea6RefusesWhatAnM8Takes) {
  for (const auto& [type, answer] :
       {std::pair{"ublox_6", kRate_refused}, std::pair{"ublox_m8", kRate_acknowledged}}) {
    Rig rig(type);
    ASSERT_TRUE(rig.link->open().ok());
    rig.set_port();
    rig.far->write(kTenth);
    rig.serve_for(100 * kMs);
    EXPECT_TRUE(rig.heard_that(answer)) << type;
  }
}

TEST(GpsLine, AfterALossOfItsSupplyTheLineIsAtTheSavedRateAgain) {
  Rig rig;
  ASSERT_TRUE(rig.link->open().ok());
  rig.set_port();
  rig.spoil(io::FaultKind::gnss_brown_out);
  EXPECT_TRUE(rig.serve_until([&] { return rig.far->baud() == 9600.0; }));
  ASSERT_EQ(rig.arrivals.size(), 1u);
  EXPECT_EQ(rig.arrivals[0].kind, io::Kind::fault_applied);
}

// gpsFix of NAV-STATUS, which is asked for; -1: no answer.
int fix_of(Rig& rig) {
  rig.heard.clear();
  rig.far->write(ubx(0x01, 0x03, {}));
  rig.serve_for(100 * kMs);
  const Bytes head{0xB5, 0x62, 0x01, 0x03};
  const auto at = std::search(rig.heard.begin(), rig.heard.end(), head.begin(), head.end());
  return rig.heard.end() - at < 24 ? -1 : at[10];
}

TEST(GpsLine, AFaultOfTheReceiverIsInWhatItSays) {
  Rig rig;
  ASSERT_TRUE(rig.link->open().ok());
  rig.set_port();
  rig.serve_for(2100 * kMs);
  EXPECT_EQ(fix_of(rig), 3);
  rig.spoil(io::FaultKind::gnss_jammed);
  rig.serve_for(1100 * kMs);
  EXPECT_EQ(fix_of(rig), 0);
}

TEST(GpsLine, OneThatIsMadeSafeFallsSilent) {
  Rig rig;
  ASSERT_TRUE(rig.link->open().ok());
  rig.serve_for(1000 * kMs);
  ASSERT_TRUE(
      rig.serve_until([&] { return rig.heard.size() > 40; }));  // in the midst of a solution
  rig.link->make_safe();
  rig.heard.clear();
  rig.serve_for(1500 * kMs);
  EXPECT_TRUE(rig.heard.empty());
}

TEST(GpsLine, AnUnpluggedLineAndABoardWithoutReceiverAreSaid) {
  Rig rig;
  ASSERT_TRUE(rig.link->open().ok());
  rig.far.reset();
  const auto served = rig.link->serve(kMs, rig.arrivals);
  ASSERT_FALSE(served.ok());
  EXPECT_EQ(served.error().kind, ErrorKind::host);
  BoardDescription none;
  none.name = "none";
  const auto opened =
      GpsLine(LinePartOptions{{"gps", "/nowhere", 6}, none, rack::device_types()}).open();
  ASSERT_FALSE(opened.ok());
  EXPECT_NE(opened.error().what.find("no device on usart6"), std::string::npos);
}

}  // namespace
}  // namespace whirl::bench
