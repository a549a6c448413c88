// SocketCAN of a real kernel: virtual buses, and two Kvaser controllers on one wire as QEMU plays them.
#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "io_bridges/socketcan/can_monitor.hpp"
#include "io_bridges/socketcan/socket_can.hpp"

namespace whirl::io {
namespace {

std::int64_t now_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

void shell(const std::string& command) {
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

SocketCan open_good(const std::string& name, std::uint32_t bps = 0) {
  auto port = SocketCan::open(name, bps);
  EXPECT_TRUE(port.ok()) << port.error().message();
  return std::move(port.value());
}

std::optional<CanArrival> next(SocketCan& port, int timeout_ms = 2000) {
  pollfd file{port.file(), POLLIN, 0};
  poll(&file, 1, timeout_ms);
  const auto got = port.receive();
  EXPECT_TRUE(got.ok());
  return got.value();
}

std::string why_not(const std::string& name, std::uint32_t bps = 0) {
  const auto port = SocketCan::open(name, bps);
  if (port.ok()) return "";
  EXPECT_EQ(port.error().kind, ErrorKind::bad_input);
  return port.error().message();
}

TEST(SocketCan, FramesOfEveryKindCrossAVirtualBus) {
  SocketCan a = open_good("vcan0", 1'000'000), b = open_good("vcan0");
  const CanFrame frames[] = {{.id = 0x1801552A,
                              .extended = true,
                              .length = 8,
                              .data = {4, 3, 2, 1, 0x58, 0xCD, 0xAB, 0xC5}},
                             {.id = 0x123, .length = 0},
                             {.id = 0x7FF, .remote = true, .length = 3}};
  for (const CanFrame& frame : frames) {
    const std::int64_t before_ns = now_ns();
    ASSERT_TRUE(a.send(frame).value());
    const auto got = next(b);
    ASSERT_TRUE(got);
    EXPECT_EQ(got->frame, frame);
    EXPECT_FALSE(got->own);
    const auto back = next(a);  // it has passed
    ASSERT_TRUE(back);
    EXPECT_TRUE(back->own);
    EXPECT_EQ(back->frame, frame);
    EXPECT_GE(got->host_ns, before_ns - 1'000'000);
    EXPECT_LE(got->host_ns, now_ns());
  }
}

TEST(SocketCan, WhatIsLostForWantOfReadingIsTold) {
  SocketCan a = open_good("vcan0"), b = open_good("vcan0");
  constexpr std::uint32_t kSent = 4000;
  for (std::uint32_t n = 0; n < kSent; ++n) {
    ASSERT_TRUE(a.send({.id = n, .extended = true, .length = 8}).value());
  }
  std::uint32_t got = 0, dropped = 0;
  while (const auto arrival = next(b, 50)) {
    ++got;
    dropped += arrival->dropped;
  }
  ASSERT_LT(got, kSent);
  // The kernel tells with the next frame: one more shows how many were lost before it.
  ASSERT_TRUE(a.send({.id = 1}).value());
  dropped += next(b)->dropped;
  EXPECT_EQ(got + dropped, kSent);
}

TEST(SocketCan, EachRefusalIsSaidByARealKernel) {
  EXPECT_NE(why_not("can77").find("no such CAN interface"), std::string::npos);
  EXPECT_NE(why_not("lo").find("is no CAN interface"), std::string::npos);
  shell("ip link set vcan1 down");
  EXPECT_NE(why_not("vcan1").find("is down"), std::string::npos);
  shell("ip link set vcan1 up");
  EXPECT_EQ(why_not("vcan1"), "");
}

TEST(SocketCan, AnInterfaceThatGoesDownIsAnErrorOfTheHost) {
  SocketCan port = open_good("vcan1");
  shell("ip link set vcan1 down");
  const auto sent = port.send({.id = 1});
  ASSERT_FALSE(sent.ok());
  EXPECT_EQ(sent.error().kind, ErrorKind::host);
  EXPECT_NE(sent.error().message().find("went down"), std::string::npos);
  shell("ip link set vcan1 up");
}

TEST(SocketCan, ControllersOnOneWireHaveARateAndAState) {
  EXPECT_NE(why_not("can0").find("is down"), std::string::npos);
  shell("ip link set can0 up type can bitrate 1000000 restart-ms 100");
  shell("ip link set can1 up type can bitrate 500000");
  EXPECT_EQ(why_not("can0", 1'000'000), "");
  EXPECT_NE(why_not("can1", 1'000'000).find("runs at 500000 bit/s"), std::string::npos);
  shell("ip link set can1 down");
  shell("ip link set can1 up type can bitrate 1000000");
  SocketCan a = open_good("can0", 1'000'000), b = open_good("can1", 1'000'000);
  EXPECT_EQ(a.interface().state, CanBusState::active);
  EXPECT_EQ(a.interface().restart_ms, 100u);
  std::printf("%s\n%s\n", a.version().c_str(), b.version().c_str());
  const CanFrame frame{
      .id = 0x1004051E, .extended = true, .length = 5, .data = {0xA9, 0x5C, 0, 0, 0xC0}};
  for (int n = 0; n < 50; ++n) {
    ASSERT_TRUE(a.send(frame).value());
    const auto got = next(b);
    ASSERT_TRUE(got && !got->trouble);
    EXPECT_EQ(got->frame, frame);
  }
}

TEST(SocketCan, AContainerWithoutTheHostsNetworkHasNoSuchInterface) {
  const pid_t child = fork();
  if (child == 0) {
    // A name space of its own has no interface of ours.
    if (unshare(CLONE_NEWNET) != 0) _exit(3);
    const auto port = SocketCan::open("vcan0", 0);
    _exit(!port.ok() && port.error().message().find("no such CAN interface") != std::string::npos
              ? 0
              : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace whirl::io
