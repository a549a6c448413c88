// The firmware's DroneCAN against the golden vectors (PYD over the published DSDL) and against the
// host's codec, which another pen wrote.
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "firmware/drivers/esc_can.hpp"
#include "io_bridges/protocols/dronecan/assembler.hpp"
#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/esc_extended.hpp"
#include "io_bridges/protocols/dronecan/node.hpp"
#include "io_bridges/protocols/dronecan/param.hpp"

namespace fw {
namespace {

namespace host = whirl::io::dronecan;

std::string hex(const hal::CanFrame& frame) {
  std::string text;
  for (unsigned i = 0; i < frame.length; ++i) {
    char byte[3];
    std::snprintf(byte, sizeof byte, "%02x", frame.data[i]);
    text += byte;
  }
  return text;
}

struct FakeCan {
  std::vector<hal::CanFrame> sent;
  std::deque<hal::CanFrame> coming;
  std::size_t stuck = 0;
  int cancelled = 0;

  Status send(const hal::CanFrame& frame) {
    sent.push_back(frame);
    return Status::ok;
  }
  bool read(hal::CanFrame& frame) {
    if (coming.empty()) return false;
    frame = coming.front();
    coming.pop_front();
    return true;
  }
  std::size_t waiting() const { return stuck; }
  void cancel() {
    ++cancelled;
    stuck = 0;
  }
};

struct Access {
  std::vector<std::pair<std::string, float>> rows{{"ESC_BUS", 1.0f}, {"BAT_LOW", 14.4f}};
  std::size_t count() const { return rows.size(); }
  std::string_view name(std::size_t i) const { return rows[i].first; }
  bool is_whole(std::size_t i) const { return i == 0; }
  float value(std::size_t i) const { return rows[i].second; }
  float start(std::size_t) const { return 0.0f; }
  float low(std::size_t) const { return -3.0f; }
  float high(std::size_t) const { return 60.0f; }
  bool set(std::size_t i, float value) {
    if (!(value >= -3.0f && value <= 60.0f)) return false;
    rows[i].second = value;
    return true;
  }
};

whirl::io::CanFrame to_host(const hal::CanFrame& frame) {
  whirl::io::CanFrame out;
  out.id = frame.id;
  out.extended = true;
  out.length = frame.length;
  out.data = frame.data;
  return out;
}
hal::CanFrame to_firmware(const whirl::io::CanFrame& frame) {
  return {frame.id, frame.length, frame.data};
}

struct Rig {
  FakeCan can;
  Access access;
  dronecan::Node<FakeCan, Access> node{can, access};
  EscCan<FakeCan, Access> escs{can, node};
  host::TransferIds ids;

  Rig() { node.be({10, "org.whirlstand.flight", {1, 2, 3}}); }
  template <typename Message>
  void hear(const Message& message, std::uint8_t source, host::Kind kind = host::Kind::message,
            int drop = -1) {
    const host::Payload payload = host::encode(message);
    host::Header header{kind,
                        Message::kType.id,
                        16,
                        source,
                        static_cast<std::uint8_t>(kind == host::Kind::message ? 0 : 10),
                        0};
    header.transfer_id = ids.next(kind, Message::kType.id, source);
    int n = 0;
    for (const auto& frame : host::frames_of(header, Message::kType.signature, payload.bytes())) {
      if (n++ != drop) can.coming.push_back(to_firmware(frame));
    }
    deliver();
  }
  void deliver() {
    for (hal::CanFrame frame; can.read(frame);) {
      if (!escs.on_frame(frame)) node.on_frame(frame);
    }
  }
  // What the host makes of all that was sent.
  template <typename Message>
  std::optional<Message> said() {
    host::Assembler assembler([](host::Kind, std::uint16_t) { return &Message::kType; }, 99);
    std::optional<Message> last;
    for (const hal::CanFrame& frame : can.sent) {
      if (const auto* t = assembler.take(to_host(frame), 0))
        last = host::decode<Message>(t->payload);
    }
    return last;
  }
};

TEST(DroneCan, BitsAreThoseOfTheGoldenVectors) {
  std::array<std::uint8_t, 7> bytes{};
  dronecan::BitsOut out(bytes);
  for (const std::uint32_t v : {1000u, 2000u, 3000u, 4000u}) out.put(v, 14);
  std::vector<hal::CanFrame> sent;
  const auto keep = [&sent](const hal::CanFrame& f) {
    sent.push_back(f);
    return Status::ok;
  };
  EXPECT_EQ(dronecan::send_transfer(dronecan::message_id(8, 1030, 10), 0, dronecan::kRawCommand,
                                    bytes, keep),
            Status::ok);
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0].id, 0x0804060Au);
  EXPECT_EQ(hex(sent[0]), "e80f407b82e80fc0");

  std::array<std::uint8_t, 14> status{};
  dronecan::BitsOut of_esc(status);
  of_esc.put(0, 32).put(dronecan::to_half(16.0f), 16).put(dronecan::to_half(10.0f), 16);
  of_esc.put(dronecan::to_half(300.0f), 16).put(5000, 18).put(50, 7).put(2, 5);
  sent.clear();
  std::ignore = dronecan::send_transfer(dronecan::message_id(16, 1034, 20), 7, dronecan::kEscStatus,
                                        status, keep);
  ASSERT_EQ(sent.size(), 3u);
  EXPECT_EQ(sent[0].id, 0x10040A14u);
  EXPECT_EQ(hex(sent[0]), "33a5000000000087");
  EXPECT_EQ(hex(sent[1]), "4c0049b05c881327");
  EXPECT_EQ(hex(sent[2]), "190847");
}

TEST(DroneCan, EveryHalfIsReadAndWrittenAsTheHostDoes) {
  for (std::uint32_t half = 0; half < 0x10000; ++half) {
    const float value = dronecan::from_half(half);
    const float want = host::from_float16(static_cast<std::uint16_t>(half));
    if (std::isnan(want)) {
      EXPECT_TRUE(std::isnan(value));
      continue;
    }
    EXPECT_EQ(value, want) << half;
    if (std::isfinite(value)) {
      EXPECT_EQ(dronecan::to_half(value), half);
    }
  }
  EXPECT_EQ(dronecan::to_half(1e9f), 0x7BFFu);
}

TEST(EscCan, FourStepsOfTheCommandAreOneOfI2cs) {
  Rig rig;
  EXPECT_EQ(rig.escs.write({0, 1, 1024, 2047}), Status::ok);
  ASSERT_EQ(rig.can.sent.size(), 1u);
  EXPECT_EQ(rig.can.sent[0].id, 0x0504060Au);  // priority 5
  const auto command = rig.said<host::RawCommand>();
  ASSERT_TRUE(command);
  ASSERT_EQ(command->commands.size, 4u);
  EXPECT_EQ(command->commands.items[0], 0);
  EXPECT_EQ(command->commands.items[1], 4);
  EXPECT_EQ(command->commands.items[2], 4096);
  EXPECT_EQ(command->commands.items[3], 8188);
}

TEST(EscCan, StatusAndFlagsMakeOneStatusOfTheMotorTheyName) {
  Rig rig;
  host::EscStatus status;
  status.current_A = -0.125f;
  status.speed_rpm = 4321;
  status.index = 2;
  status.temperature_K = std::nanf("");
  host::EscStatusExtended extended;
  extended.flags = 0x03;
  extended.index = 2;
  esc::protocol::Status got;
  rig.hear(status, 77);
  EXPECT_FALSE(rig.escs.take_status(2, got));
  rig.hear(extended, 77);
  ASSERT_TRUE(rig.escs.take_status(2, got));
  EXPECT_EQ(got.current_mA, -125);
  EXPECT_EQ(got.speed_rpm, 4321);
  EXPECT_EQ(got.flags, 0x03);
  EXPECT_TRUE(rig.escs.take_answered(2));
  EXPECT_FALSE(rig.escs.take_answered(1));
}

TEST(EscCan, ATransferThatLostAFrameIsCountedAndTheNextIsGood) {
  Rig rig;
  host::EscStatus status;
  status.speed_rpm = 1000;
  rig.hear(status, 41, host::Kind::message, 1);
  EXPECT_FALSE(rig.escs.take_answered(0));
  rig.hear(status, 41);
  EXPECT_TRUE(rig.escs.take_answered(0));
  EXPECT_EQ(rig.escs.bad_status(), 1u);
}

// An error in the last bit of a frame's end makes its sender repeat what its receivers have.
TEST(EscCan, AFrameThatComesTwiceIsPassedOver) {
  Rig rig;
  host::EscStatus status;
  status.index = 3;
  const host::Payload payload = host::encode(status);
  const host::Header header{host::Kind::message, 1034, 16, 41, 0, 9};
  for (const auto& frame :
       host::frames_of(header, host::EscStatus::kType.signature, payload.bytes())) {
    for (int i = 0; i < 2; ++i) rig.can.coming.push_back(to_firmware(frame));
  }
  rig.deliver();
  EXPECT_TRUE(rig.escs.take_answered(3));
}

TEST(EscCan, WhatHasNotGoneOutByTheNextSetPointIsGivenUp) {
  Rig rig;
  rig.can.stuck = 1;
  EXPECT_EQ(rig.escs.write({1, 1, 1, 1}), Status::ok);
  EXPECT_EQ(rig.can.cancelled, 1);
  EXPECT_EQ(rig.escs.failures(), 1u);
}

TEST(DroneCanNode, SaysItsStatusAndWhoItIs) {
  Rig rig;
  rig.node.publish_status(0x01020304, dronecan::Health::warning);
  ASSERT_EQ(rig.can.sent.size(), 1u);
  EXPECT_EQ(rig.can.sent[0].id, 0x1801550Au);
  EXPECT_EQ(hex(rig.can.sent[0]), "04030201400000c0");
  rig.can.sent.clear();
  rig.hear(host::GetNodeInfoRequest{}, 99, host::Kind::request);
  const auto info = rig.said<host::GetNodeInfoResponse>();
  ASSERT_TRUE(info);
  EXPECT_EQ(info->name_text(), "org.whirlstand.flight");
  EXPECT_EQ(info->status.uptime_s, 0x01020304u);
  EXPECT_EQ(info->unique_id[2], 3);
}

TEST(DroneCanNode, ReadsAndSetsParametersByNameAndByPlace) {
  Rig rig;
  host::GetSetRequest request;
  for (const char c : std::string("BAT_LOW")) request.name.add(c);
  request.value.tag = host::ParamValue::real;
  request.value.as_real = 15.5f;
  rig.hear(request, 99, host::Kind::request);
  auto got = rig.said<host::GetSetResponse>();
  ASSERT_TRUE(got);
  EXPECT_EQ(got->value.tag, host::ParamValue::real);
  EXPECT_EQ(got->value.as_real, 15.5f);
  EXPECT_EQ(got->most.as_real, 60.0f);
  EXPECT_EQ(got->name.size, 7u);
  rig.can.sent.clear();
  host::GetSetRequest by_place;
  by_place.value.tag = host::ParamValue::integer;
  by_place.value.as_integer = -2;
  rig.hear(by_place, 99, host::Kind::request);
  got = rig.said<host::GetSetResponse>();
  ASSERT_TRUE(got);
  EXPECT_EQ(got->value.tag, host::ParamValue::integer);
  EXPECT_EQ(got->value.as_integer, -2);
  rig.can.sent.clear();
  host::GetSetRequest unknown;
  unknown.index = 7;
  rig.hear(unknown, 99, host::Kind::request);
  got = rig.said<host::GetSetResponse>();
  ASSERT_TRUE(got);
  EXPECT_EQ(got->value.tag, host::ParamValue::empty);
  EXPECT_EQ(got->name.size, 0u);
}

TEST(DroneCanNode, RequestsToOthersArePassedOver) {
  Rig rig;
  rig.node.be({11, "another", {}});
  rig.hear(host::GetNodeInfoRequest{}, 99, host::Kind::request);  // to 10
  EXPECT_TRUE(rig.can.sent.empty());
}

}  // namespace
}  // namespace fw
