// The pod's lines to GPS and radio, by the times of their characters. The rate changes when all before it has left the line,
// however much its host has sent ahead.
#include <gtest/gtest.h>

#include "base/near.hpp"
#include "harness/target/virtual_board.hpp"
#include "io_bridges/board_description/board_text.hpp"
#include "io_bridges/protocols/dronecan/pod_link.hpp"

namespace whirl::board_test {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::uint16_t kHost = 1, kGps = 6;
using Bytes = std::vector<std::uint8_t>;

// The pod between a host, on its UART, and a line on that one.
Result<BoardStart> pod_with(const std::string& bus, int baud) {
  return read_board_text(
      R"({"board":"pod","mcu":"stm32f405rg","hse_Hz":8000000,"image":")" +
      std::string(WHIRL_FIRMWARE) +
      R"(/pod.elf","devices":[{"name":"host","type":"serial","bus":"usart1","baud":3000000},)"
      R"({"name":"line","type":"serial","bus":")" +
      bus + R"(","baud":)" + std::to_string(baud) + "}]}");
}

// The ends of the characters on the GPS's line. A line's end is told at once, whatever the rate of the one that listens.
std::vector<std::int64_t> characters_of(const Bytes& from_host, int milliseconds) {
  VirtualBoardOptions options;
  const auto start = pod_with("usart6", 9600);
  EXPECT_TRUE(start);
  std::vector<std::int64_t> ends_ns;
  if (!start) return ends_ns;
  options.board = start.value();
  VirtualBoard board(options);
  EXPECT_TRUE(board.start());
  io::Batch happened;
  for (int k = 1; k <= milliseconds; ++k) {
    io::Batch sensed;
    if (k == 10) {
      sensed.add(io::Kind::uart_frame, kHost, (k - 1) * kMs, from_host.data(),
                 static_cast<std::uint32_t>(from_host.size()));
    }
    board.run(k * kMs, sensed);
    EXPECT_TRUE(board.arrive(happened));
    for (io::Reader r(happened.bytes()); r.next();) {
      const bool its = r.header().kind == io::Kind::uart_received && r.header().port == kGps;
      if (its) ends_ns.push_back(r.header().t_ns);
    }
  }
  board.stop(happened);
  return ends_ns;
}

TEST(PodGpsRate, WhatWaitsLeavesAtTheRateOfItsTime) {
  constexpr std::size_t kBefore = 2 * io::kPodLineBytes, kAfter = 20;
  const Bytes lines(io::kPodLineBytes, '\n');
  Bytes all;
  const auto add = [&](const Bytes& frame) { all.insert(all.end(), frame.begin(), frame.end()); };
  add(io::pack_pod_baud(io::PodEnd::gps, 0, 9600));
  add(io::pack_pod_bytes(io::PodEnd::gps, 1, 0, lines));
  add(io::pack_pod_bytes(io::PodEnd::gps, 2, 0, lines));
  add(io::pack_pod_baud(io::PodEnd::gps, 3, 57'600));
  add(io::pack_pod_bytes(io::PodEnd::gps, 4, 0, std::span(lines).first(kAfter)));
  const auto ends_ns = characters_of(all, 120);
  ASSERT_EQ(ends_ns.size(), kBefore + kAfter);
  const auto slow = stated(2'000, "ns: the divider of the pod's clock"), fast = stated(1'000, "ns");
  for (std::size_t i = 1; i < ends_ns.size(); ++i) {
    const std::int64_t apart_ns = ends_ns[i] - ends_ns[i - 1];
    if (i == kBefore) {
      EXPECT_GT(apart_ns, 173'000) << "the line was empty between";
    } else if (i < kBefore) {
      EXPECT_TRUE(near(apart_ns, 1'041'667, slow)) << i;
    } else {
      EXPECT_TRUE(near(apart_ns, 173'611, fast)) << i;
    }
  }
}

// At the rate that it has from the start; what the flight controller tells it reaches the host.
TEST(PodRadioLine, CarriesBothWays) {
  constexpr std::uint16_t kRadio = 3;
  constexpr std::size_t kLength = 60;
  VirtualBoardOptions options;
  const auto start = pod_with("usart3", 57600);
  ASSERT_TRUE(start);
  options.board = start.value();
  VirtualBoard board(options);
  ASSERT_TRUE(board.start());
  const Bytes line(io::kPodLineBytes, '\n');
  Bytes said;
  for (const auto& frame :
       {io::pack_pod_bytes(io::PodEnd::radio, 0, 0, line),
        io::pack_pod_bytes(io::PodEnd::radio, 1, 0, std::span(line).first(kLength - line.size()))})
    said.insert(said.end(), frame.begin(), frame.end());
  const Bytes told(50, 'x');
  Bytes heard;
  io::PodLinkReader reader([](const io::PodStatus&) {});
  reader.on_written(io::PodEnd::radio, [&](const io::PodWritten& w) {
    heard.insert(heard.end(), w.bytes.begin(), w.bytes.end());
  });
  std::vector<std::int64_t> ends_ns;
  io::Batch happened;
  for (int k = 1; k <= 60; ++k) {
    io::Batch sensed;
    const auto give = [&](std::uint16_t port, const Bytes& bytes) {
      sensed.add(io::Kind::uart_frame, port, (k - 1) * kMs, bytes.data(),
                 static_cast<std::uint32_t>(bytes.size()));
    };
    if (k == 10) give(kHost, said);
    if (k == 12) give(kRadio, told);
    board.run(k * kMs, sensed);
    ASSERT_TRUE(board.arrive(happened));
    for (io::Reader r(happened.bytes()); r.next();) {
      if (r.header().kind != io::Kind::uart_received) continue;
      if (r.header().port == kRadio) ends_ns.push_back(r.header().t_ns);
      if (r.header().port != kHost) continue;
      for (const std::uint8_t byte : r.payload()) reader.add(byte);
    }
  }
  board.stop(happened);
  EXPECT_EQ(heard, told);
  ASSERT_EQ(ends_ns.size(), kLength);
  const auto divider = stated(1'000, "ns: the divider of the pod's clock");
  for (std::size_t i = 1; i < ends_ns.size(); ++i) {
    EXPECT_TRUE(near(ends_ns[i] - ends_ns[i - 1], 173'611, divider)) << i;
  }
}

}  // namespace
}  // namespace whirl::board_test
