// The pod's lines to GPS and radio, by the times of their characters. The rate changes when all before it has left the line,
// however much its host has sent ahead.
#include <gtest/gtest.h>

#include "base/near.hpp"
#include "harness/target/virtual_board.hpp"
#include "io_bridges/board_description/board_text.hpp"
#include "io_bridges/board_description/bus_name.hpp"
#include "io_bridges/protocols/dronecan/pod_link.hpp"

namespace whirl::board_test {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::uint16_t kHost = 1;
using Bytes = std::vector<std::uint8_t>;

struct Heard {
  std::vector<std::int64_t> ends_ns;  // of the characters on the line
  Bytes by_host;
};

// The pod between a host, on its UART, and a line on that one. A line's end is told at once, whatever the rate of the one that
// listens.
Heard between(const std::string& usart, int baud, const Bytes& from_host, const Bytes& from_line,
              int milliseconds) {
  VirtualBoardOptions options;
  const auto start = read_board_text(
      R"({"board":"pod","mcu":"stm32f405rg","hse_Hz":8000000,"image":")" +
      std::string(WHIRL_FIRMWARE) +
      R"(/pod.elf","devices":[{"name":"host","type":"serial","bus":"usart1","baud":3000000},)"
      R"({"name":"line","type":"serial","bus":")" +
      usart + R"(","baud":)" + std::to_string(baud) + "}]}");
  EXPECT_TRUE(start);
  Heard heard;
  if (!start) return heard;
  options.board = start.value();
  const auto line = static_cast<std::uint16_t>(bus_number(usart).value());
  VirtualBoard board(options);
  EXPECT_TRUE(board.start());
  io::Batch happened;
  for (int k = 1; k <= milliseconds; ++k) {
    io::Batch sensed;
    const auto give = [&](std::uint16_t port, const Bytes& bytes) {
      sensed.add(io::Kind::uart_frame, port, (k - 1) * kMs, bytes.data(),
                 static_cast<std::uint32_t>(bytes.size()));
    };
    if (k == 10) give(kHost, from_host);
    if (k == 12 && !from_line.empty()) give(line, from_line);
    board.run(k * kMs, sensed);
    EXPECT_TRUE(board.arrive(happened));
    for (io::Reader r(happened.bytes()); r.next();) {
      if (r.header().kind != io::Kind::uart_received) continue;
      if (r.header().port == line) heard.ends_ns.push_back(r.header().t_ns);
      if (r.header().port != kHost) continue;
      heard.by_host.insert(heard.by_host.end(), r.payload().begin(), r.payload().end());
    }
  }
  board.stop(happened);
  return heard;
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
  const auto ends_ns = between("usart6", 9600, all, {}, 120).ends_ns;
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
  constexpr std::size_t kLength = 60;
  const Bytes line(io::kPodLineBytes, '\n');
  Bytes said;
  for (const auto& frame :
       {io::pack_pod_bytes(io::PodEnd::radio, 0, 0, line),
        io::pack_pod_bytes(io::PodEnd::radio, 1, 0, std::span(line).first(kLength - line.size()))})
    said.insert(said.end(), frame.begin(), frame.end());
  const Bytes told(50, 'x');
  const auto [ends_ns, by_host] = between("usart3", 57600, said, told, 60);
  Bytes heard;
  io::PodLinkReader reader([](const io::PodStatus&) {});
  reader.on_written(io::PodEnd::radio, [&](const io::PodWritten& w) {
    heard.insert(heard.end(), w.bytes.begin(), w.bytes.end());
  });
  for (const std::uint8_t byte : by_host) reader.add(byte);
  EXPECT_EQ(heard, told);
  ASSERT_EQ(ends_ns.size(), kLength);
  const auto divider = stated(1'000, "ns: the divider of the pod's clock");
  for (std::size_t i = 1; i < ends_ns.size(); ++i) {
    EXPECT_TRUE(near(ends_ns[i] - ends_ns[i - 1], 173'611, divider)) << i;
  }
}

}  // namespace
}  // namespace whirl::board_test
