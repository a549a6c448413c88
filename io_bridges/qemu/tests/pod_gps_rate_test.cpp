// The rate of the GPS's line that the pod plays changes when all before it has left the line, however much its host has sent
// ahead: each character is told with its time.
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

// The ends of the characters on the GPS's line. A line's end is told at once, whatever the rate of the one that listens.
std::vector<std::int64_t> characters_of(const Bytes& from_host, int milliseconds) {
  VirtualBoardOptions options;
  const auto start = read_board_text(
      R"({"board":"pod","mcu":"stm32f405rg","hse_Hz":8000000,"image":")" +
      std::string(WHIRL_FIRMWARE) +
      R"(/pod.elf","devices":[{"name":"host","type":"serial","bus":"usart1","baud":3000000},)"
      R"({"name":"gps","type":"serial","bus":"usart6","baud":9600}]})");
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
  constexpr std::size_t kBefore = 2 * io::kPodGpsBytes, kAfter = 20;
  const Bytes lines(io::kPodGpsBytes, '\n');
  Bytes all;
  const auto add = [&](const Bytes& frame) { all.insert(all.end(), frame.begin(), frame.end()); };
  add(io::pack_pod_gps_baud(0, 9600));
  add(io::pack_pod_gps(1, 0, lines));
  add(io::pack_pod_gps(2, 0, lines));
  add(io::pack_pod_gps_baud(3, 57'600));
  add(io::pack_pod_gps(4, 0, std::span(lines).first(kAfter)));
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

}  // namespace
}  // namespace whirl::board_test
