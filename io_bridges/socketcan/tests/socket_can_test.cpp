// The system calls of a CAN socket and what a kernel may answer to them, played call by call.
#include "io_bridges/socketcan/socket_can.hpp"

#include <gtest/gtest.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/net_tstamp.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>

#include "io_bridges/socketcan/can_monitor.hpp"
#include "io_bridges/socketcan/tests/played_kernel.hpp"

namespace whirl::io {
namespace {

constexpr std::int64_t kMs = 1'000'000;

class SocketCalls : public testing::Test {
 protected:
  SocketCan open() {
    auto port = SocketCan::open("can0", 1'000'000);
    EXPECT_TRUE(port.ok()) << port.error().message();
    return std::move(port.value());
  }
  std::uint32_t option(int level, int name) const {
    for (const auto& o : kernel_.options) {
      if (o.level == level && o.name == name) return o.value;
    }
    return 0;
  }
  // What the port makes of it; an error frame's four first bits are the kernel's flags.
  std::optional<CanArrival> take(SocketCan& port, const PlayedKernel::Incoming& in) {
    kernel_.incoming.push_back(in);
    const auto got = port.receive();
    EXPECT_TRUE(got.ok());
    return got.value();
  }

  PlayedKernel kernel_;
};

can_frame kernels(std::uint32_t id, std::uint8_t length, std::uint8_t first = 0) {
  can_frame frame{};
  frame.can_id = id;
  frame.can_dlc = length;
  frame.data[0] = first;
  return frame;
}

TEST_F(SocketCalls, ItAsksForErrorsItsOwnFramesLossesAndStamps) {
  const SocketCan port = open();
  EXPECT_EQ(kernel_.bound_to, 7);
  EXPECT_EQ(option(SOL_CAN_RAW, CAN_RAW_ERR_FILTER), CAN_ERR_MASK);
  EXPECT_EQ(option(SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS), 1u);
  EXPECT_EQ(option(SOL_SOCKET, SO_RXQ_OVFL), 1u);
  const std::uint32_t stamps = option(SOL_SOCKET, SO_TIMESTAMPING);
  for (const std::uint32_t flag : {SOF_TIMESTAMPING_RX_HARDWARE, SOF_TIMESTAMPING_RAW_HARDWARE,
                                   SOF_TIMESTAMPING_RX_SOFTWARE, SOF_TIMESTAMPING_SOFTWARE}) {
    EXPECT_EQ(stamps & flag, flag);
  }
}

TEST_F(SocketCalls, WithoutASocketOrAPlaceOnTheBusNothingStaysOpen) {
  kernel_.socket_error = EAFNOSUPPORT;
  EXPECT_NE(SocketCan::open("can0", 0).error().message().find("no CAN (AF_CAN)"),
            std::string::npos);
  kernel_.socket_error = 0;
  kernel_.bind_error = ENODEV;
  EXPECT_NE(SocketCan::open("can0", 0).error().message().find("no such CAN interface"),
            std::string::npos);
  kernel_.bind_error = 0;
  EXPECT_NE(SocketCan::open("can0", 500'000).error().message().find("runs at 1000000"),
            std::string::npos);
  EXPECT_EQ(kernel_.opened, kernel_.closed);
}

TEST_F(SocketCalls, APortThatIsMovedIsClosedOnceAndCountsOn) {
  {
    SocketCan first = open();
    EXPECT_EQ(take(first, {.frame = kernels(1, 0), .lost = 3})->dropped, 3u);
    SocketCan second(std::move(first));
    EXPECT_EQ(take(second, {.frame = kernels(1, 0), .lost = 5})->dropped, 2u);
  }
  EXPECT_EQ(kernel_.opened, kernel_.closed);
}

TEST_F(SocketCalls, AFullQueueTakesNothingAndIsNoError) {
  SocketCan port = open();
  kernel_.send_errors = {ENOBUFS, EAGAIN, EINTR, 0};
  for (int n = 0; n < 3; ++n) {
    const auto sent = port.send({.id = 1});
    ASSERT_TRUE(sent.ok());
    EXPECT_FALSE(sent.value());
  }
  EXPECT_TRUE(kernel_.sent.empty());
  EXPECT_TRUE(port.send({.id = 1}).value());
  EXPECT_EQ(kernel_.sent.size(), 1u);
}

TEST_F(SocketCalls, AFrameGoesOutWithItsKind) {
  SocketCan port = open();
  ASSERT_TRUE(port.send({.id = 0x1801552A, .extended = true, .length = 2, .data = {4, 3}}).value());
  ASSERT_TRUE(port.send({.id = 0x7FF, .remote = true, .length = 3}).value());
  EXPECT_EQ(kernel_.sent[0].can_id, 0x1801552A | CAN_EFF_FLAG);
  EXPECT_EQ(kernel_.sent[0].can_dlc, 2);
  EXPECT_EQ(kernel_.sent[0].data[1], 3);
  EXPECT_EQ(kernel_.sent[1].can_id, 0x7FF | CAN_RTR_FLAG);
  EXPECT_EQ(kernel_.sent[1].can_dlc, 3);
}

TEST_F(SocketCalls, WhatEndsAPortIsSaidAsTheHosts) {
  const std::pair<int, const char*> all[] = {{ENODEV, "unplugged"},
                                             {ENXIO, "unplugged"},
                                             {ENETDOWN, "went down"},
                                             {EIO, "Input/output error"}};
  for (const auto& [error, says] : all) {
    SocketCan port = open();
    kernel_.send_errors = {error};
    kernel_.incoming = {{.error = error}};
    const auto sent = port.send({.id = 1});
    const auto got = port.receive();
    ASSERT_FALSE(sent.ok() || got.ok()) << says;
    for (const Error& told : {sent.error(), got.error()}) {
      EXPECT_EQ(told.kind, ErrorKind::host);
      EXPECT_NE(told.message().find(says), std::string::npos) << told.message();
    }
  }
}

TEST_F(SocketCalls, NothingOrHalfAFrameIsNothing) {
  SocketCan port = open();
  EXPECT_FALSE(take(port, {.error = EAGAIN}));
  EXPECT_FALSE(take(port, {.error = EINTR}));
  EXPECT_FALSE(take(port, {.frame = kernels(0x123, 8), .size = 8}));
  EXPECT_TRUE(take(port, {.frame = kernels(0x123, 8)}));
}

TEST_F(SocketCalls, AFrameComesInWithItsKind) {
  SocketCan port = open();
  const auto wide = take(port, {.frame = kernels(0x1801552A | CAN_EFF_FLAG, 1, 9)});
  EXPECT_EQ(wide->frame, (CanFrame{.id = 0x1801552A, .extended = true, .length = 1, .data = {9}}));
  // A base frame's identifier has eleven bits, whatever the word holds; a remote one has no data.
  const auto narrow = take(port, {.frame = kernels(0x1234'5723 & CAN_EFF_MASK, 0)});
  EXPECT_EQ(narrow->frame, (CanFrame{.id = 0x723}));
  const auto asked = take(port, {.frame = kernels(0x7FF | CAN_RTR_FLAG, 3, 9)});
  EXPECT_EQ(asked->frame, (CanFrame{.id = 0x7FF, .remote = true, .length = 3}));
  EXPECT_EQ(take(port, {.frame = kernels(1, 15)})->frame.length, 8);
}

TEST_F(SocketCalls, ItsOwnFramesAreMarked) {
  SocketCan port = open();
  EXPECT_TRUE(take(port, {.frame = kernels(1, 0), .flags = MSG_CONFIRM})->own);
  EXPECT_FALSE(take(port, {.frame = kernels(1, 0)})->own);
}

TEST_F(SocketCalls, LossesAreToldOnceEach) {
  SocketCan port = open();
  EXPECT_EQ(take(port, {.frame = kernels(1, 0)})->dropped, 0u);
  EXPECT_EQ(take(port, {.frame = kernels(1, 0), .lost = 5})->dropped, 5u);
  EXPECT_EQ(take(port, {.frame = kernels(1, 0), .lost = 5})->dropped, 0u);
  EXPECT_EQ(take(port, {.frame = kernels(1, 0), .lost = 0xFFFF'FFFF})->dropped, 0xFFFF'FFFAu);
  EXPECT_EQ(take(port, {.frame = kernels(1, 0), .lost = 1})->dropped, 2u);  // it counts on beyond
}

// Nobody acknowledges until the controller is off; it restarts, and the bus goes on.
TEST_F(SocketCalls, BusOffAndRestartAreSeenAsTheyPass) {
  SocketCan port = open();
  CanMonitor monitor(1'000'000);
  const auto show = [&](std::uint32_t what, std::uint8_t controller = 0) {
    can_frame frame = kernels(what | CAN_ERR_FLAG, 8);
    frame.data[1] = controller;
    const auto got = take(port, {.frame = frame});
    EXPECT_TRUE(got && got->trouble);
    monitor.on_arrival(*got);
    return monitor.counts();
  };
  EXPECT_EQ(show(CAN_ERR_ACK).no_acknowledge, 1u);
  EXPECT_EQ(show(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING).state, CanBusState::warning);
  EXPECT_EQ(show(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE).state, CanBusState::passive);
  EXPECT_EQ(show(CAN_ERR_BUSOFF).state, CanBusState::bus_off);
  EXPECT_EQ(show(CAN_ERR_RESTARTED).state, CanBusState::active);
  EXPECT_EQ(show(CAN_ERR_LOSTARB).lost_arbitration, 1u);
  EXPECT_EQ(show(CAN_ERR_PROT).bus_errors, 1u);
  EXPECT_EQ(show(CAN_ERR_BUSERROR).bus_errors, 2u);
  EXPECT_EQ(show(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW).overflows, 1u);
  EXPECT_EQ(show(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_OVERFLOW).overflows, 2u);
  const CanCounts counts = show(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE);
  EXPECT_EQ(counts.state, CanBusState::active);
  EXPECT_EQ(counts.bus_off, 1u);
  EXPECT_EQ(counts.restarted, 1u);
  EXPECT_EQ(counts.error_frames, 11u);
  EXPECT_EQ(counts.received, 0u);  // none of them is a frame
}

// Of the realtime clock only the age counts, and none where that clock was set meanwhile.
TEST_F(SocketCalls, TheKernelsStampIsTheTimeOfAFrame) {
  SocketCan port = open();
  const auto told_ns = [&](std::optional<std::int64_t> stamp_ns) {
    return take(port, {.frame = kernels(1, 0), .software_ns = stamp_ns})->host_ns;
  };
  EXPECT_EQ(told_ns({}), kernel_.monotonic_ns);
  EXPECT_EQ(told_ns(kernel_.realtime_ns - 3 * kMs), kernel_.monotonic_ns - 3 * kMs);
  EXPECT_EQ(told_ns(kernel_.realtime_ns - 999 * kMs), kernel_.monotonic_ns - 999 * kMs);
  EXPECT_EQ(told_ns(kernel_.realtime_ns + 1), kernel_.monotonic_ns);
  EXPECT_EQ(told_ns(kernel_.realtime_ns - 1000 * kMs), kernel_.monotonic_ns);
}

// Its clock begins anywhere; the kernel's stamp of the same frame is what it is set against.
TEST_F(SocketCalls, AControllersStampGoesBeforeTheKernels) {
  SocketCan port = open();
  const auto take_at = [&](std::int64_t hardware_ns, std::int64_t seen_ago_ns) {
    return take(port, {.frame = kernels(1, 0),
                       .software_ns = kernel_.realtime_ns - seen_ago_ns,
                       .hardware_ns = hardware_ns});
  };
  const auto first = take_at(7000 * kMs, 2 * kMs);
  EXPECT_TRUE(first->hardware_stamp);
  EXPECT_EQ(first->host_ns, kernel_.monotonic_ns - 2 * kMs);
  kernel_.monotonic_ns += 10 * kMs;
  kernel_.realtime_ns += 10 * kMs;
  // 10 ms after the first, and seen 1.5 ms later than that one was.
  EXPECT_EQ(take_at(7010 * kMs, kMs / 2)->host_ns, kernel_.monotonic_ns - 2 * kMs);
  EXPECT_FALSE(
      take(port, {.frame = kernels(1, 0), .software_ns = kernel_.realtime_ns})->hardware_stamp);
}

}  // namespace
}  // namespace whirl::io
