#include <gtest/gtest.h>

#include <algorithm>

#include "io_bridges/copper/bus_decoders.hpp"
#include "io_bridges/copper/channel_name.hpp"
#include "io_bridges/copper/decoding.hpp"
#include "io_bridges/copper/wire_drawing.hpp"

namespace whirl::copper {
namespace {

constexpr std::uint16_t kScl = 0, kSda = 1;

// I2C as NXP's UM10204 draws it (figures 9 and 10), a clock of 10 us: data set in the low quarter, read while SCL is high.
struct Master {
  std::vector<Edge> edges;
  std::int64_t t = 100'000;
  void start() {
    edges.push_back({t, kSda, false});
    edges.push_back({t += 5'000, kScl, false});
  }
  void bit(bool high) {
    edges.push_back({t + 2'500, kSda, high});
    edges.push_back({t + 5'000, kScl, true});
    edges.push_back({t += 10'000, kScl, false});
  }
  void byte(std::uint8_t value, bool nack = false) {
    for (int i = 7; i >= 0; --i) bit((value >> i & 1) != 0);
    bit(nack);
  }
  void again() {  // repeated START
    edges.push_back({t + 2'500, kSda, true});
    edges.push_back({t + 5'000, kScl, true});
    t += 10'000;
    start();
  }
  void stop() {
    edges.push_back({t + 2'500, kSda, false});
    edges.push_back({t + 5'000, kScl, true});
    edges.push_back({t += 10'000, kSda, true});
    t += 50'000;
  }
};

struct Seen {
  std::vector<I2cFrame> frames;
  std::vector<Unread> unread;
};

Seen read(const std::vector<Edge>& edges) {
  Seen seen;
  I2cDecoder decoder([&](const I2cFrame& f) { seen.frames.push_back(f); },
                     [&](const Unread& u) { seen.unread.push_back(u); });
  for (const Edge& e : edges) {
    e.wire == kScl ? decoder.scl(e.level, e.t_ns) : decoder.sda(e.level, e.t_ns);
  }
  return seen;
}

TEST(I2cDecoder, AWriteAndAReadBehindARepeatedStart) {
  Master m;
  m.start();
  m.byte(0xD0);
  m.byte(0x75);
  m.again();
  m.byte(0xD1);
  m.byte(0x68, true);
  m.stop();
  const Seen seen = read(m.edges);
  EXPECT_TRUE(seen.unread.empty());
  ASSERT_EQ(seen.frames.size(), 2u);
  EXPECT_EQ(seen.frames[0].address, 0x68);
  EXPECT_FALSE(seen.frames[0].read);
  EXPECT_EQ(seen.frames[0].bytes, std::vector<std::uint8_t>{0x75});
  EXPECT_EQ(seen.frames[0].start_ns, 100'000);
  EXPECT_EQ(seen.frames[0].stop_ns, seen.frames[1].start_ns);
  EXPECT_TRUE(seen.frames[1].read);
  EXPECT_TRUE(seen.frames[1].acked);  // the controller's own NACK ends a read
  EXPECT_EQ(seen.frames[1].bytes, std::vector<std::uint8_t>{0x68});
  EXPECT_EQ(seen.frames[0].passed_ns, std::vector<std::int64_t>{105'000 + 18 * 10'000});
}

TEST(I2cDecoder, NobodyAnswers) {
  Master m;
  m.start();
  m.byte(0x52, true);
  m.stop();
  const Seen seen = read(m.edges);
  ASSERT_EQ(seen.frames.size(), 1u);
  EXPECT_FALSE(seen.frames[0].acked);
  EXPECT_TRUE(seen.frames[0].bytes.empty());
}

TEST(I2cDecoder, EachClockThatIsLostIsReportedAndNoByteGiven) {
  Master whole;
  whole.start();
  whole.byte(0x52);
  whole.byte(0x0F);
  whole.byte(0xA0);
  whole.stop();
  int clocks = 0;
  for (std::size_t i = 0; i < whole.edges.size(); ++i) {
    if (whole.edges[i].wire != kScl || !whole.edges[i].level) continue;
    if (i + 2 >= whole.edges.size()) continue;  // the rise before STOP carries no bit
    ++clocks;
    std::vector<Edge> less = whole.edges;
    less.erase(less.begin() + static_cast<std::ptrdiff_t>(i),
               less.begin() + static_cast<std::ptrdiff_t>(i) + 2);
    Master next;  // and what follows is read as ever
    next.t = 10'000'000;
    next.start();
    next.byte(0x52);
    next.byte(0x11);
    next.stop();
    less.insert(less.end(), next.edges.begin(), next.edges.end());
    const Seen seen = read(less);
    EXPECT_EQ(seen.unread.size(), 1u) << i;
    ASSERT_EQ(seen.frames.size(), 1u) << i;
    EXPECT_EQ(seen.frames[0].bytes, std::vector<std::uint8_t>{0x11}) << i;
  }
  EXPECT_EQ(clocks, 27);
}

TEST(SpiDecoder, BothWaysAtOnceAndALostClockIsReported) {
  for (const int lost : {-1, 0, 7, 11}) {
    std::vector<SpiFrame> frames;
    std::vector<Unread> unread;
    SpiDecoder decoder([&](const SpiFrame& f) { frames.push_back(f); },
                       [&](const Unread& u) { unread.push_back(u); });
    decoder.select(false, 1000);
    std::int64_t t = 2000;
    for (int i = 0; i < 16; ++i, t += 100) {
      decoder.mosi((0xF50Fu >> (15 - i) & 1) != 0);
      decoder.miso((0x1234u >> (15 - i) & 1) != 0);
      if (i == lost) continue;
      decoder.sck(true, t);
      decoder.sck(false, t + 50);
    }
    decoder.select(true, 5000);
    EXPECT_EQ(unread.size(), lost < 0 ? 0u : 1u);
    ASSERT_EQ(frames.size(), lost < 0 ? 1u : 0u);
    if (lost >= 0) continue;
    EXPECT_EQ(frames[0].pairs, (std::vector<std::uint8_t>{0xF5, 0x12, 0x0F, 0x34}));
    EXPECT_EQ(frames[0].start_ns, 1000);
    EXPECT_EQ(frames[0].stop_ns, 5000);
  }
}

TEST(UartDecoder, BytesBackToBackAndAWrongRateIsNoByte) {
  std::vector<Edge> edges;
  const std::uint8_t text[] = {'U', 0x00, 0xFF, 'k'};
  draw_uart(text, 40 * 8681, 115200.0, 0, 0, edges);
  for (const double baud : {115200.0, 113000.0, 57600.0}) {
    std::vector<std::uint8_t> bytes;
    int unread = 0;
    UartDecoder decoder(
        baud, [&](const UartByte& b) { bytes.push_back(b.byte); },
        [&](const Unread&) { ++unread; });
    for (const Edge& e : edges) decoder.line(e.level, e.t_ns);
    decoder.advance_to(10'000'000);
    if (baud > 100e3) {
      EXPECT_EQ(bytes, std::vector<std::uint8_t>(std::begin(text), std::end(text)));
      EXPECT_EQ(unread, 0);
    } else {
      EXPECT_GT(unread, 0);
    }
  }
}

TEST(ChannelName, SaysItsBusAndRole) {
  EXPECT_EQ(channel_name("i2c3_scl"), (ChannelName{Role::scl, 3, ""}));
  EXPECT_EQ(channel_name("spi1_cs_imu"), (ChannelName{Role::chip_select, 1, "imu"}));
  EXPECT_EQ(channel_name("usart6_rx"), (ChannelName{Role::rx, 6, ""}));
  EXPECT_EQ(channel_name("pin_led_blue"), (ChannelName{Role::pin, 0, "led_blue"}));
  for (const char* other :
       {"", "D0", "i2c_scl", "i2c3_sck", "spi1_cs_", "pin_", "i2c100_scl", "i2cx_scl"}) {
    EXPECT_FALSE(channel_name(other)) << other;
  }
}

TEST(BusDecoders, HalfABusIsRefused) {
  const auto half = BusDecoders::make({"i2c3_scl"}, {});
  ASSERT_FALSE(half);
  EXPECT_NE(half.error().message().find("i2c3: has one wire of two"), std::string::npos);
  EXPECT_FALSE(BusDecoders::make({"spi1_sck", "spi1_mosi", "spi1_miso"}, {}));
  EXPECT_FALSE(BusDecoders::make({"pin_nowhere"}, {}));
}

// What is drawn of a transfer is read back as the same transfer: bytes, START and STOP to the nanosecond.
TEST(WireDrawing, WhatIsDrawnOfI2cIsReadBack) {
  I2cDrawing drawing(kScl, kSda);
  std::vector<Edge> edges;
  const std::vector<Transfer> all = {
      {1'000'000, 1'094'000, 0x29, false, true, {0x0F, 0xA0}, {1'047'500, 1'070'000}},
      {2'000'000, 2'030'000, 0x2A, true, false, {}, {}},  // nobody there
      {3'000'000, 3'060'000, 0x76, false, true, {0xA2}, {3'047'000}},
      {3'060'000,
       3'160'000,
       0x76,
       true,
       true,
       {0x12, 0x34},
       {3'107'000, 3'150'000}},  // repeated START
  };
  for (const Transfer& t : all) drawing.add(t, edges);
  drawing.settle(edges);
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Edge& a, const Edge& b) { return a.t_ns < b.t_ns; });
  const Seen seen = read(edges);
  EXPECT_TRUE(seen.unread.empty());
  ASSERT_EQ(seen.frames.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(seen.frames[i].start_ns, all[i].start_ns);
    EXPECT_EQ(seen.frames[i].stop_ns, all[i].stop_ns);
    EXPECT_EQ(seen.frames[i].address, all[i].address);
    EXPECT_EQ(seen.frames[i].read, all[i].read);
    EXPECT_EQ(seen.frames[i].acked, all[i].acked);
    EXPECT_EQ(seen.frames[i].bytes, all[i].bytes);
    EXPECT_EQ(seen.frames[i].passed_ns, all[i].passed_ns);
  }
}

TEST(Decoding, MessagesOfABoardAreThoseOfItsWires) {
  Decoding decoding({{"imu"}, {"led"}, {{2, 115200.0}}});
  decoding.begin({"spi1_sck", "spi1_mosi", "spi1_miso", "spi1_cs_imu", "ready_imu", "pin_led",
                  "usart2_tx", "spare"},
                 50e6);
  ASSERT_FALSE(decoding.error());
  std::vector<Edge> edges = {
      {0, 3, true}, {0, 5, false}, {0, 6, true}, {500, 4, true}, {900, 7, true}};
  draw_spi({1000, 4000, 0, false, true, {0xF5, 0x00, 0x00, 0x68}, {2000, 3000}}, {0, 1, 2, 3},
           edges);
  edges.push_back({5000, 5, true});
  const std::uint8_t text[] = {'x'};
  draw_uart(text, 200'000, 115200.0, 6, 0, edges);
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Edge& a, const Edge& b) { return a.t_ns < b.t_ns; });
  for (const Edge& e : edges) decoding.on_edge(e);
  decoding.advance_to(1'000'000);
  const io::Batch all = decoding.in_order();
  std::vector<io::Kind> kinds;
  for (io::Reader r(all.bytes()); r.next();) {
    kinds.push_back(r.header().kind);
    if (r.header().kind != io::Kind::spi_transaction) continue;
    EXPECT_EQ(r.header().port, 1);
    EXPECT_EQ(r.header().t_ns, 4000);
    const Transfer back = transfer_of(r);
    EXPECT_EQ(back.bytes, (std::vector<std::uint8_t>{0xF5, 0x00, 0x00, 0x68}));
    EXPECT_EQ(r.as<io::BusTransaction>().length, 2u);
  }
  EXPECT_EQ(kinds, (std::vector<io::Kind>{io::Kind::pin_edge, io::Kind::data_ready,
                                          io::Kind::spi_transaction, io::Kind::pin_edge,
                                          io::Kind::uart_received}));
  EXPECT_EQ(decoding.buses(), std::vector<std::string>{"spi1"});
}

}  // namespace
}  // namespace whirl::copper
