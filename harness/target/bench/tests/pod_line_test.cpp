// A pod's host on a serial line that the test plays the pod's end of: samples go out in time, set-points come back, and
// what the pod counts is told.
#include "harness/target/bench/pod_line.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "base/near.hpp"
#include "io_bridges/protocols/crc.hpp"
#include "io_bridges/protocols/dronecan/pod_link.hpp"
#include "io_bridges/rack/devices/pod_faults.hpp"
#include "io_bridges/rack/devices/table.hpp"
#include "io_bridges/serial/pseudo_terminal.hpp"

namespace whirl::bench {
namespace {

constexpr std::int64_t kMs = 1'000'000;

BoardDescription pod_board(double can = 0.0) {
  BoardDescription board;
  board.name = "pod";
  board.devices.push_back({.name = "host", .type = "pod_parts"});
  board.devices.back().set("params.can", can);
  return board;
}

struct Rig {
  explicit Rig(BoardDescription board = pod_board())
      : link({.link = {.name = "pod", .board = "pod", .path = pod.path(), .can = {}},
              .board = std::move(board),
              .types = rack::device_types(),
              .places = {{{1, 0}, {rack::kPodBus, rack::kPodImu}}}}) {
    link.keep_time(
        {[](std::int64_t host_ns) { return host_ns; }, [](std::int64_t t_ns) { return t_ns; }});
  }
  void serve_until(std::int64_t host_ns) {
    std::vector<std::uint8_t> piece(4096);
    while (now_ns < host_ns) {
      now_ns += kMs / 4;
      ASSERT_TRUE(link.serve(now_ns, arrivals).ok());
      const std::size_t size = pod.read(piece);
      heard.insert(heard.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(size));
    }
  }
  void tell(const std::vector<std::uint8_t>& bytes) { pod.write(bytes); }
  std::size_t frames_of(std::uint8_t kind) const {
    std::size_t count = 0;
    for (std::size_t i = 0; i + 4 <= heard.size(); i += 6u + heard[i + 3]) {
      EXPECT_EQ(heard[i], 0xA5);
      if (heard[i + 1] == kind) ++count;
    }
    return count;
  }

  // Of the part that the flight controller's board has as device 0 on its bus 1.
  void spoil(io::FaultKind kind, double value, std::int64_t end_ns, int address = 0) {
    io::FaultCommand fault;
    fault.number = 1;
    fault.kind = static_cast<std::uint32_t>(kind);
    fault.start_ns = now_ns;
    fault.end_ns = end_ns;
    fault.bus = 1;
    fault.address = address;
    fault.value = value;
    io::Batch batch;
    batch.add(io::Kind::fault, 1, now_ns, fault);
    io::Reader order(batch.bytes());
    ASSERT_TRUE(order.next());
    link.take(order, 0);
  }
  // Payloads of the frames of a kind, in order.
  std::vector<std::vector<std::uint8_t>> payloads_of(std::uint8_t kind) const {
    std::vector<std::vector<std::uint8_t>> all;
    for (std::size_t i = 0; i + 4 <= heard.size(); i += 6u + heard[i + 3]) {
      const auto begin = heard.begin() + static_cast<std::ptrdiff_t>(i + 4);
      if (heard[i + 1] == kind) all.emplace_back(begin, begin + heard[i + 3]);
    }
    return all;
  }
  std::size_t applied() const {
    return static_cast<std::size_t>(std::count_if(
        arrivals.begin(), arrivals.end(),
        [](const Arrival& arrival) { return arrival.kind == io::Kind::fault_applied; }));
  }

  std::int64_t now_ns = 0;
  io::PseudoTerminal pod = std::move(io::PseudoTerminal::open().value());
  PodLine link;
  Arrivals arrivals;
  std::vector<std::uint8_t> heard;
};

// Lost and late, and the clock; the rest is zero.
std::vector<std::uint8_t> status(std::uint16_t lost, std::uint16_t late, std::uint32_t now_us) {
  constexpr std::uint8_t kLength = 56;
  std::vector<std::uint8_t> frame{0xA5, 0x81, 0x01, kLength};
  frame.resize(4 + kLength);
  const std::uint8_t settings[] = {1, 1, 0, 0x18, 0x18, 1, 0x10, 0};  // awake, 1 kHz
  std::copy(std::begin(settings), std::end(settings), frame.begin() + 4);
  const auto half = [&](std::size_t at, std::uint32_t value) {
    frame[at] = static_cast<std::uint8_t>(value);
    frame[at + 1] = static_cast<std::uint8_t>(value >> 8);
  };
  half(20, lost);
  half(22, late);
  half(48, now_us);
  half(50, now_us >> 16);
  std::uint16_t crc = 0xFFFF;
  for (std::size_t i = 1; i < frame.size(); ++i) crc = io::crc16_add(crc, frame[i]);
  frame.push_back(static_cast<std::uint8_t>(crc));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8));
  return frame;
}

TEST(PodLine, SamplesGoOutAtTheRateThatThePodsSettingsSay) {
  Rig rig;
  ASSERT_TRUE(rig.link.open().ok());
  rig.serve_until(100 * kMs);  // the parts have powered up
  rig.tell(status(0, 0, 10));
  rig.serve_until(200 * kMs);
  rig.heard.clear();
  rig.serve_until(1200 * kMs);
  const std::size_t samples = rig.frames_of(0x01);
  EXPECT_GE(samples, 985u);  // the part's own clock is within 1 %
  EXPECT_LE(samples, 1015u);
  EXPECT_GE(rig.frames_of(0x03), 95u);  // pressure and temperature by turns
  EXPECT_GE(rig.frames_of(0x05), 73u);  // 75 Hz
}

TEST(PodLine, ASetPointOfThePodIsTheMotorsAndItsStateGoesOut) {
  Rig rig;
  ASSERT_TRUE(rig.link.open().ok());
  rig.serve_until(20 * kMs);
  rig.tell({0xA5, 0x82, 0x05, 0x04, 0x02, 0x01, 0xFF, 0x07, 0x6B, 0x13});
  io::Batch batch;
  batch.add(io::Kind::esc_state, 3, rig.now_ns, io::EscState{.speed_rpm = 4000});
  io::Reader order(batch.bytes());
  ASSERT_TRUE(order.next());
  EXPECT_FALSE(rig.link.take(order, 0));
  rig.serve_until(120 * kMs);
  ASSERT_EQ(rig.arrivals.size(), 1u);
  EXPECT_EQ(rig.arrivals[0].kind, io::Kind::esc_setpoint);
  EXPECT_EQ(rig.arrivals[0].port, 3);
  EXPECT_EQ(rig.arrivals[0].host_ns, 20 * kMs + kMs / 4);
  io::EscSetpoint setpoint;
  std::memcpy(&setpoint, rig.arrivals[0].payload.data(), sizeof setpoint);
  EXPECT_EQ(setpoint.value, 2047);
  EXPECT_GE(rig.frames_of(0x06), 4u);
}

TEST(PodLine, WhatThePodCountsIsToldFromTheFirstSecondOn) {
  Rig rig;
  ASSERT_TRUE(rig.link.open().ok());
  rig.tell(status(40, 7, 10));
  rig.serve_until(1100 * kMs);
  rig.tell(status(42, 7, 1'100'000));
  rig.serve_until(1200 * kMs);
  io::Batch happened;
  rig.link.finish([](std::int64_t t_ns) { return t_ns; }, rig.now_ns, happened);
  rig.link.close();
  EXPECT_EQ(rig.link.findings(), std::vector<std::string>{"2 samples never reached the pod"});
  for (const Arrival& arrival : rig.arrivals) EXPECT_NE(arrival.kind, io::Kind::uart_received);
}

TEST(PodLine, APodThatSaysNothingIsToldOf) {
  Rig rig;
  ASSERT_TRUE(rig.link.open().ok());
  rig.serve_until(1100 * kMs);
  io::Batch happened;
  rig.link.finish([](std::int64_t t_ns) { return t_ns; }, rig.now_ns, happened);
  EXPECT_EQ(rig.link.findings(), std::vector<std::string>{"the pod said nothing"});
}

TEST(PodLine, OneThatIsMadeSafeFallsSilent) {
  Rig rig;
  ASSERT_TRUE(rig.link.open().ok());
  rig.serve_until(200 * kMs);
  EXPECT_FALSE(rig.heard.empty());
  rig.link.make_safe();
  rig.serve_until(201 * kMs);
  rig.heard.clear();
  rig.serve_until(400 * kMs);
  EXPECT_TRUE(rig.heard.empty());
}

const auto kZero_g = stated(400, "counts: zero-g output, scale and noise");

// Accelerometer x of a sample's payload, behind its time.
int first_axis(const std::vector<std::uint8_t>& sample) {
  return static_cast<std::int16_t>(sample.at(2) | sample.at(3) << 8);
}

TEST(PodLine, AFaultOfAPartThatThePodPlaysIsInItsData) {
  Rig rig;
  ASSERT_TRUE(rig.link.open().ok());
  rig.serve_until(100 * kMs);
  rig.tell(status(0, 0, 10));
  rig.serve_until(200 * kMs);
  rig.spoil(io::FaultKind::sensor_offset, 49.03325, 300 * kMs);  // 5 g of 16, in 2048 counts each
  rig.heard.clear();
  rig.serve_until(250 * kMs);
  const auto spoilt = rig.payloads_of(0x01);
  ASSERT_GT(spoilt.size(), 40u);
  EXPECT_TRUE(near(first_axis(spoilt.back()), 5 * 2048, kZero_g));
  EXPECT_EQ(rig.applied(), 1u);
  rig.serve_until(310 * kMs);
  rig.heard.clear();
  rig.serve_until(350 * kMs);
  EXPECT_TRUE(near(first_axis(rig.payloads_of(0x01).back()), 0, kZero_g));
}

TEST(PodLine, AFaultOfAnotherPlaceFindsNothingHere) {
  Rig rig;
  ASSERT_TRUE(rig.link.open().ok());
  rig.serve_until(100 * kMs);
  rig.tell(status(0, 0, 10));
  rig.spoil(io::FaultKind::sensor_offset, 49.03325, 900 * kMs, 3);
  rig.serve_until(250 * kMs);
  EXPECT_EQ(rig.applied(), 0u);
  EXPECT_TRUE(near(first_axis(rig.payloads_of(0x01).back()), 0, kZero_g));
}

// What only the pod can play is told to it, as it begins and ends.
TEST(PodLine, AnotherIdentityAndALossOfSupplyAreThePods) {
  Rig rig;
  ASSERT_TRUE(rig.link.open().ok());
  rig.serve_until(100 * kMs);
  rig.tell(status(0, 0, 10));
  rig.serve_until(200 * kMs);
  EXPECT_TRUE(rig.payloads_of(0x02).empty());
  rig.spoil(io::FaultKind::sensor_wrong_identity, 0x70, 300 * kMs);
  rig.serve_until(400 * kMs);
  rig.spoil(io::FaultKind::sensor_brown_out, 0.0, 500 * kMs);
  rig.serve_until(600 * kMs);
  const std::vector<std::vector<std::uint8_t>> want{{0, 0x70}, {0, 0}, {2, 0}, {0, 0}};
  EXPECT_EQ(rig.payloads_of(0x02), want);
}

TEST(PodLine, AHostOnCanIsNoneOfALine) {
  Rig rig(pod_board(2.0));
  const auto opened = rig.link.open();
  ASSERT_FALSE(opened.ok());
  EXPECT_EQ(opened.error().kind, ErrorKind::bad_input);
  EXPECT_NE(opened.error().what.find("no device on its host's line"), std::string::npos);
}

}  // namespace
}  // namespace whirl::bench
